//! Theories of rough surfaces without adhesion, which stand next to solves in a chart.

use std::f64::consts::PI;

use asperity::Surface;
use asperity::surface::{Psd, SurfaceStatistics};

use crate::key::{Boundary, Scene};

/// Persson's factor γ of the elastic energy; Almqvist, Campañá, Prodanov and Persson (2011).
const ENERGY: f64 = 0.45;
/// The reduced pressures from which and up to which the separation is integrated, and the steps of their logarithm.
const REDUCED: (f64, f64) = (1e-9, 8.0);
const STEPS: usize = 10_000;
/// The points of a curve.
const POINTS: usize = 100;

/// The name of a theory, and its points.
pub type Curve = (&'static str, Vec<(f64, f64)>);

/// The theories of a rough elastic half-space at a hard wall: of Persson (2001), with the mean gap of Yang and Persson
/// (2008), and of Greenwood and Williamson (1966), with the asperities of McCool (1986).
///
/// Greenwood and Williamson's asperities do not feel each other, which holds for light loads.
#[derive(Clone, Debug)]
pub struct Theories {
    found: SurfaceStatistics,
    spectrum: Psd,
    modulus: f64,
    area: f64,
}

impl Theories {
    /// The theories of a surface in a scene.
    ///
    /// # Errors
    /// What the scene has that they do not know of, and the remedy, for [`worded`](crate::worded).
    pub fn of(surface: &Surface, scene: &Scene) -> Result<Self, String> {
        let Scene { elastic, adhesion, .. } = scene;
        let (lx, ly) = surface.grid().lengths();
        let beyond = [
            (adhesion.adheres(), "{law}"),
            (adhesion.wall.has_springs(), "{wall}"),
            (adhesion.yields(), "a hardness"),
            (elastic.boundary == Boundary::Free, "{boundary=free}"),
            (elastic.no_half_space().is_some(), "a body of another kind"),
            (surface.absent_nodes() > 0, "absent nodes"),
            (surface.grid().is_line(), "a line"),
        ];
        if let Some((_, beyond)) = beyond.into_iter().find(|(is_beyond, _)| *is_beyond) {
            return Err(format!(
                "{{theory}}: theories are of a rough half-space without adhesion at a hard wall, with a periodic \
                 boundary, and this run has {beyond}: leave {{theory}} out"
            ));
        }
        let (found, spectrum) = (surface.statistics(), surface.spectrum().radial_psd());
        Ok(Self { found, spectrum, modulus: elastic.with_other(elastic.modulus), area: lx * ly })
    }

    /// The curves of column `y` of a sweep over column `x`, between two mean pressures; none where no theory has both.
    pub fn curves(&self, (x, y): (&str, &str), low: f64, high: f64) -> Vec<Curve> {
        let pressures = (0..=POINTS).map(|k| low * (high / low).powf(k as f64 / POINTS as f64));
        let force = if x == "normal_force" { self.area } else { 1.0 };
        match (x, y) {
            ("mean_gap", "mean_pressure") => {
                let gap = self.mean_gap();
                vec![("Persson", pressures.map(|pressure| (gap(pressure), pressure)).collect())]
            }
            ("mean_pressure" | "normal_force", "contact_fraction") => {
                let full = self.modulus * self.found.rms_slope;
                let area = |pressure: f64| (force * pressure, libm::erf(2f64.sqrt() * pressure / full));
                let of_asperities = self.greenwood_williamson().into_iter();
                let light = of_asperities.filter(|(pressure, area)| (low..=high).contains(pressure) && *area <= 1.0);
                let light = light.map(|(pressure, area)| (force * pressure, area)).collect();
                vec![("Persson", pressures.map(area).collect()), ("Greenwood and Williamson, for light loads", light)]
            }
            _ => Vec::new(),
        }
    }

    /// The mean gap over the mean pressure, ∫ (dU/dp) dp/p from it on, with the elastic energy U of the spectrum.
    fn mean_gap(&self) -> impl Fn(f64) -> f64 {
        let step = (REDUCED.1 / REDUCED.0).ln() / STEPS as f64;
        // ∫ (γ + 3(1 − γ) erf²y) e^(−y²) dy/y from each step on
        let mut separations = vec![0.0; STEPS + 1];
        for k in (0..STEPS).rev() {
            let x = REDUCED.0 * (step * (k as f64 + 0.5)).exp();
            let slope = (ENERGY + 3.0 * (1.0 - ENERGY) * libm::erf(x).powi(2)) * (-x * x).exp();
            separations[k] = separations[k + 1] + step * slope;
        }
        let separation = move |x: f64| {
            let place = ((x / REDUCED.0).ln() / step).clamp(0.0, STEPS as f64 - 1e-6);
            let (here, next) = (separations[place as usize], separations[place as usize + 1]);
            here + place.fract() * (next - here)
        };
        let Psd { wave_numbers, densities, waves, cell, .. } = &self.spectrum;
        let (mut slopes, mut terms) = (0.0, Vec::new());
        for ((q, density), waves) in wave_numbers.iter().zip(densities).zip(waves) {
            let share = density * *waves as f64 * cell;
            // the waves of a ring are, in the mean, on top of half of themselves and of all that are longer
            let inverse = (2.0 / (slopes + 0.5 * q * q * share)).sqrt();
            slopes += q * q * share;
            if share > 0.0 {
                terms.push((q * share * inverse, inverse / self.modulus));
            }
        }
        move |pressure| {
            let sum: f64 = terms.iter().map(|(factor, reduced)| factor * separation(reduced * pressure)).sum();
            sum / (2.0 * PI.sqrt())
        }
    }

    /// The mean pressures and contact fractions of asperities as their plane approaches, from far to near.
    fn greenwood_williamson(&self) -> Vec<(f64, f64)> {
        let SurfaceStatistics { rms_height, rms_slope, rms_curvature, nayak, .. } = self.found;
        let (m2, m4) = (0.5 * rms_slope * rms_slope, 1.5 * rms_curvature * rms_curvature);
        let (density, radius) = (m4 / (6.0 * PI * 3f64.sqrt() * m2), 3.0 * (PI / m4).sqrt() / 8.0);
        let height = (1.0 - 0.8968 / nayak).sqrt() * rms_height;
        // ∫ (s − x)ⁿ φ(s) ds from x on, of n = 3/2 and 1, with s = x + u²
        let integrals = |x: f64| {
            (0..420).map(|k| 0.02 * f64::from(k)).fold((0.0, 0.0), |(load, area), u| {
                let weight = 0.04 * u.powi(3) * (-0.5 * (x + u * u).powi(2)).exp() / (2.0 * PI).sqrt();
                (load + u * weight, area + weight)
            })
        };
        let scale = 4.0 / 3.0 * self.modulus * density * radius.sqrt() * height.powf(1.5);
        let at = |(load, area): (f64, f64)| (scale * load, PI * density * radius * height * area);
        (0..1000).map(|k| at(integrals(8.0 - 0.02 * f64::from(k)))).collect()
    }
}
