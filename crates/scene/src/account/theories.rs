//! Theories of rough surfaces on an elastic half-space, without adhesion: approximations by a few statistics, which
//! stand next to solves in a chart.

use std::f64::consts::PI;
use std::sync::LazyLock;

use asperity::surface::{Psd, SurfaceStatistics};
use asperity::{Error, Surface};

use crate::key::{Boundary, Scene};

/// Persson's factor γ of the elastic energy; Almqvist, Campañá, Prodanov and Persson (2011).
const ENERGY: f64 = 0.45;
/// The logarithms of the reduced pressures from which and up to which the separation is tabulated, and their steps.
const REDUCED: (f64, f64) = (-13.815510557964274, 2.0794415416798357);
const STEPS: usize = 8000;
/// The points of a curve.
const POINTS: usize = 100;

/// The integrals of (γ + 3(1 − γ) erf²y) e^(−y²)/y from each reduced pressure on, by the trapezoidal rule.
static SEPARATIONS: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let step = (REDUCED.1 - REDUCED.0) / STEPS as f64;
    let slope = |k: usize| {
        let x = (REDUCED.0 + step * k as f64).exp();
        (ENERGY + 3.0 * (1.0 - ENERGY) * libm::erf(x).powi(2)) * (-x * x).exp()
    };
    let mut integrals = vec![0.0; STEPS + 1];
    for k in (0..STEPS).rev() {
        integrals[k] = integrals[k + 1] + 0.5 * step * (slope(k) + slope(k + 1));
    }
    integrals
});

/// The integral of (γ + 3(1 − γ) erf²y) e^(−y²)/y from x on; below the table the integrand is γ/y.
fn separation(x: f64) -> f64 {
    let step = (REDUCED.1 - REDUCED.0) / STEPS as f64;
    let place = (x.ln() - REDUCED.0) / step;
    let within = place.clamp(0.0, STEPS as f64);
    let k = (within as usize).min(STEPS - 1);
    let (here, next) = (SEPARATIONS[k], SEPARATIONS[k + 1]);
    here + (within - k as f64) * (next - here) + ENERGY * step * (-place).max(0.0)
}

/// The logarithms of F₃⸝₂ and F₁ of a standard normal distribution, Fₙ(x) = ∫ (s − x)ⁿ φ(s) ds from x on, at separations
/// from far to near.
static OF_NORMAL_HEIGHTS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    // with s = x + u² the integrands are smooth, and the trapezoidal rule has the integrals to rounding
    let at = |x: f64| {
        let (load, area) = (0..840).map(|k| 0.01 * f64::from(k)).fold((0.0, 0.0), |(load, area), u| {
            let weight = u.powi(3) * (-0.5 * (x + u * u).powi(2)).exp();
            (load + u * weight, area + weight)
        });
        let factor = 0.02 / (2.0 * PI).sqrt();
        ((factor * load).ln(), (factor * area).ln())
    };
    (0..=1440).map(|k| at(12.0 - 0.05 * f64::from(k))).collect()
});

/// A mean pressure that is no tension.
fn pressed(value: f64) -> asperity::Result<f64> {
    let (name, requirement) = ("mean_pressure", "zero or more, as there is no adhesion");
    if value >= 0.0 { Ok(value) } else { Err(Error::Value { name, value, requirement }) }
}

/// Persson's theory of the contact area (2001), and of the mean gap by the spectrum of a surface; Yang and Persson
/// (2008).
#[derive(Clone, Debug)]
pub struct Persson {
    /// The pressure E*h'
    full: f64,
    /// Of each wave the weight of its separation, and its reduced pressure over the pressure
    waves: Vec<(f64, f64)>,
}

impl Persson {
    /// The theory of a surface by its rms slope, and its spectrum for the mean gap: ascending wave numbers, each with
    /// its part of ⟨h²⟩.
    ///
    /// # Errors
    /// [`Error::Value`] if the slope or the modulus is not positive and finite.
    pub fn new(rms_slope: f64, modulus: f64, spectrum: impl IntoIterator<Item = (f64, f64)>) -> asperity::Result<Self> {
        let full = Error::positive("rms_slope", rms_slope)? * Error::positive("modulus", modulus)?;
        let mut slopes = 0.0;
        let kept = spectrum.into_iter().filter(|(q, part)| q * part > 0.0);
        let wave = |(q, part): (f64, f64)| {
            // the waves of an entry are, in the mean, on top of half of themselves and of all that are longer
            slopes += q * q * part;
            let inverse = (2.0 / (slopes - 0.5 * q * q * part)).sqrt();
            (0.5 * q * part * inverse / PI.sqrt(), inverse / modulus)
        };
        Ok(Self { full, waves: kept.map(wave).collect() })
    }

    /// The contact fraction erf(√2 p̄/(E*h')) at a mean pressure.
    ///
    /// # Errors
    /// [`Error::Value`] for a tension.
    pub fn contact_fraction(&self, mean_pressure: f64) -> asperity::Result<f64> {
        Ok(libm::erf(2f64.sqrt() * (pressed(mean_pressure)? / self.full)))
    }

    /// The mean gap ∫ (dU/dp) dp/p from a mean pressure on, with the elastic energy U of the spectrum.
    ///
    /// # Errors
    /// [`Error::Value`] for a tension.
    pub fn mean_gap(&self, mean_pressure: f64) -> asperity::Result<f64> {
        let pressure = pressed(mean_pressure)?;
        Ok(self.waves.iter().map(|(weight, reduced)| weight * separation(reduced * pressure)).sum())
    }
}

/// The theory of Greenwood and Williamson (1966), with the asperities of McCool (1986), which do not feel each other: for
/// light loads.
#[derive(Clone, Copy, Debug)]
pub struct GreenwoodWilliamson {
    /// The number η of asperities per area, m₄/(6π√3 m₂).
    pub density: f64,
    /// The radius R of their curvature, 3√π/(8√m₄).
    pub radius: f64,
    /// The root mean square σ of their heights, √((1 − 0.8968/α) m₀) with Nayak's parameter α.
    pub height: f64,
    modulus: f64,
}

impl GreenwoodWilliamson {
    /// The theory of a surface by its rms height, slope and curvature.
    ///
    /// # Errors
    /// [`Error::Value`] if one of them or the modulus is not positive and finite, or Nayak's parameter is too small.
    pub fn new(rms_height: f64, rms_slope: f64, rms_curvature: f64, modulus: f64) -> asperity::Result<Self> {
        let m0 = Error::positive("rms_height", rms_height)?.powi(2);
        let m2 = 0.5 * Error::positive("rms_slope", rms_slope)?.powi(2);
        let m4 = 1.5 * Error::positive("rms_curvature", rms_curvature)?.powi(2);
        let (modulus, nayak) = (Error::positive("modulus", modulus)?, m0 * m4 / (m2 * m2));
        if nayak.is_nan() || nayak <= 0.8968 {
            let name = "Nayak's parameter by rms_height, rms_slope and rms_curvature";
            let requirement = "more than 0.8968, and of a random surface it is 1.5 at least";
            return Err(Error::Value { name, value: (1e3 * nayak).round() / 1e3, requirement });
        }
        Ok(Self {
            modulus,
            density: m4 / (6.0 * PI * 3f64.sqrt() * m2),
            radius: 3.0 * (PI / m4).sqrt() / 8.0,
            height: ((1.0 - 0.8968 / nayak) * m0).sqrt(),
        })
    }

    /// The contact fraction at a mean pressure; NaN where it would be larger than one.
    ///
    /// # Errors
    /// [`Error::Value`] for a tension.
    pub fn contact_fraction(&self, mean_pressure: f64) -> asperity::Result<f64> {
        let Self { modulus, density, radius, height } = *self;
        let scale = 4.0 / 3.0 * modulus * density * radius.sqrt() * height.powf(1.5);
        let load = (pressed(mean_pressure)? / scale).ln();
        let table = &*OF_NORMAL_HEIGHTS;
        let after = table.partition_point(|(entry, _)| *entry <= load);
        if after == 0 || after == table.len() {
            return Ok(if after == 0 { 0.0 } else { f64::NAN });
        }
        let ((from, here), (to, next)) = (table[after - 1], table[after]);
        let area = here + (next - here) / (to - from) * (load - from);
        let found = PI * density * radius * height * area.exp();
        Ok(if found <= 1.0 { found } else { f64::NAN })
    }
}

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
    pub fn of(surface: &Surface, scene: &Scene) -> Result<Self, String> {
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
        let force = if x == "normal_force" { self.area } else { 1.0 };
        let curve = |found: &dyn Fn(f64) -> asperity::Result<f64>| -> Vec<(f64, f64)> {
            let pressures = (0..=POINTS).map(|k| low * (high / low).powf(k as f64 / POINTS as f64));
            let points = pressures.filter_map(|pressure| Some((force * pressure, found(pressure).ok()?)));
            points.filter(|(_, found)| *found > 0.0).collect()
        };
        match (x, y) {
            ("mean_gap", "mean_pressure") => {
                let points = curve(&|pressure| self.persson.mean_gap(pressure));
                vec![("Persson", points.into_iter().map(|(pressure, gap)| (gap, pressure)).collect())]
            }
            ("mean_pressure" | "normal_force", "contact_fraction") => vec![
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
