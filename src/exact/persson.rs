//! Persson's theory of rough surfaces.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::numerics::pressed;
use crate::Error;

/// Persson's factor γ of the elastic energy; Almqvist, Campañá, Prodanov and Persson (2011).
const ENERGY: f64 = 0.45;
/// The logarithms of the reduced pressures from which and up to which the separation is tabulated, and their steps.
const REDUCED: (f64, f64) = (-13.815510557964274, 2.0794415416798357);
const STEPS: usize = 8000;

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

/// Persson's theory of the contact area of a rough surface without adhesion, and of its mean gap by the spectrum.
///
/// An approximation: Persson (2001), Yang and Persson (2008).
///
/// ```
/// use asperity::exact::Persson;
///
/// let theory = Persson::new(0.1, 1.0, [])?;
/// assert!((theory.contact_fraction(0.01)? - 0.1585).abs() < 1e-4);
/// # Ok::<(), asperity::Error>(())
/// ```
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
    pub fn new(rms_slope: f64, modulus: f64, spectrum: impl IntoIterator<Item = (f64, f64)>) -> crate::Result<Self> {
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
    pub fn contact_fraction(&self, mean_pressure: f64) -> crate::Result<f64> {
        Ok(libm::erf(2f64.sqrt() * (pressed(mean_pressure)? / self.full)))
    }

    /// The mean gap ∫ (dU/dp) dp/p from a mean pressure on, with the elastic energy U of the spectrum.
    ///
    /// # Errors
    /// [`Error::Value`] for a tension.
    pub fn mean_gap(&self, mean_pressure: f64) -> crate::Result<f64> {
        let pressure = pressed(mean_pressure)?;
        Ok(self.waves.iter().map(|(weight, reduced)| weight * separation(reduced * pressure)).sum())
    }
}
