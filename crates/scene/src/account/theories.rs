//! Theories of rough surfaces next to solves in a chart.

use crate::account::column::{CONTACT_FRACTION, MEAN_GAP, MEAN_PRESSURE, NORMAL_FORCE};
use asperity::Surface;
use asperity::exact::{GreenwoodWilliamson, Persson};
use asperity::surface::{Psd, SurfaceStatistics};

use crate::key::{Boundary, Scene};

/// The points of a curve.
const POINTS: usize = 100;

/// The name of a theory, and its points.
pub type Curve = (&'static str, Vec<(f64, f64)>);

/// The theories of a rough elastic half-space at a hard wall.
#[derive(Clone, Debug)]
pub struct Theories {
    persson: Persson,
    asperities: GreenwoodWilliamson,
    area: f64,
}

impl Theories {
    /// Refuses a surface in a scene that has more than they know of.
    ///
    /// # Errors
    /// What it has, and the remedy, for [`worded`](crate::worded).
    pub fn check(surface: &Surface, scene: &Scene) -> Result<(), String> {
        let Scene { elastic, adhesion, .. } = scene;
        let beyond = [
            (adhesion.adheres(), "{law}"),
            (adhesion.wall.has_springs(), "{wall}"),
            (adhesion.yields(), "a hardness"),
            (elastic.boundary == Boundary::Free, "{boundary=free}"),
            (elastic.no_half_space().is_some(), "a body of another kind"),
            (surface.absent_nodes() > 0, "absent nodes"),
            (surface.grid().is_line(), "a line"),
        ];
        let Some((_, beyond)) = beyond.into_iter().find(|(is_beyond, _)| *is_beyond) else { return Ok(()) };
        Err(format!(
            "{{theory}}: theories are of a rough half-space without adhesion at a hard wall, with a periodic boundary, \
             and this run has {beyond}: leave {{theory}} out"
        ))
    }

    /// The theories of a surface in a scene.
    ///
    /// # Errors
    /// What the scene has that they do not know of, or that the surface is flat, for [`worded`](crate::worded).
    pub fn new(surface: &Surface, scene: &Scene) -> Result<Self, String> {
        Self::check(surface, scene)?;
        let SurfaceStatistics { rms_height, rms_slope, rms_curvature, .. } = surface.statistics();
        let Psd { wave_numbers, densities, waves, cell, .. } = surface.spectrum().radial_psd();
        let parts = densities.iter().zip(&waves).map(|(density, waves)| density * *waves as f64 * cell);
        let modulus = scene.elastic.with_other(scene.elastic.modulus);
        let (lx, ly) = surface.grid().lengths();
        let persson = Persson::new(rms_slope, modulus, wave_numbers.into_iter().zip(parts));
        let asperities = GreenwoodWilliamson::new(rms_height, rms_slope, rms_curvature, modulus);
        persson
            .and_then(|persson| Ok(Self { persson, asperities: asperities?, area: lx * ly }))
            .map_err(|error| format!("{{theory}}: {error}"))
    }

    /// The curves of column `y` of a sweep over column `x`, between two mean pressures; none where no theory has both.
    pub fn curves(&self, (x, y): (&str, &str), low: f64, high: f64) -> Vec<Curve> {
        let force = if x == NORMAL_FORCE { self.area } else { 1.0 };
        let curve = |found: &dyn Fn(f64) -> asperity::Result<f64>| -> Vec<(f64, f64)> {
            let pressures = (0..=POINTS).map(|k| low * (high / low).powf(k as f64 / POINTS as f64));
            let points = pressures.filter_map(|pressure| Some((force * pressure, found(pressure).ok()?)));
            points.filter(|(_, found)| *found > 0.0).collect()
        };
        match (x, y) {
            (MEAN_GAP, MEAN_PRESSURE) => {
                let points = curve(&|pressure| self.persson.mean_gap(pressure));
                vec![("Persson", points.into_iter().map(|(pressure, gap)| (gap, pressure)).collect())]
            }
            (MEAN_PRESSURE | NORMAL_FORCE, CONTACT_FRACTION) => vec![
                ("Persson", curve(&|pressure| self.persson.contact_fraction(pressure))),
                (
                    "Greenwood and Williamson, for light loads",
                    curve(&|pressure| self.asperities.contact_fraction(pressure)),
                ),
            ],
            _ => Vec::new(),
        }
    }
}
