use std::f64::consts::PI;

use super::{AdhesionLaw, Hints, Values};
use crate::error::{Error, Result};
use crate::real::Real;

/// A power law: an energy that falls with the power n of the distance.
///
/// ```math
/// φ(g) = −w (1 + g/nρ)⁻ⁿ ,   φ'(g) = w/ρ (1 + g/nρ)⁻ⁿ⁻¹ ,   φ''(g) = −(n + 1)/n · w/ρ² (1 + g/nρ)⁻ⁿ⁻²
/// ```
///
/// Close to the [`Exponential`](super::Exponential) law of the same w and ρ for large n; the van der Waals attraction
/// of half-spaces for n = 2. [`CutOff`](super::CutOff) ends its long tail.
///
/// ```
/// use asperity::{AdhesionLaw, PowerLaw};
/// let law = PowerLaw::new(0.05, 2e-9, 3.0)?;
/// assert!((law.energy(6e-9_f64) + 0.05 / 8.0).abs() < 1e-17); // twice the distance at contact, 3ρ
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    work_of_adhesion: f64,
    range: f64,
    exponent: f64,
}

impl PowerLaw {
    /// The law with work of adhesion w (energy per area), range ρ (length) and exponent n of the energy.
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ or n not positive, or one of them not finite.
    pub fn new(work_of_adhesion: f64, range: f64, exponent: f64) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Error::positive("exponent of adhesion", exponent)?;
        Ok(Self { work_of_adhesion, range, exponent })
    }

    /// The van der Waals attraction of two half-spaces, φ = −A/12π(D₀ + g)², with Hamaker's constant A (energy) and the
    /// distance D₀ (length) in contact, often 0.165 nm: w = A/12πD₀², ρ = D₀/2, n = 2. Israelachvili, *Intermolecular
    /// and Surface Forces* (2011), section 13.
    ///
    /// # Errors
    /// [`Error::Value`] if A is negative, D₀ not positive, or one of them not finite.
    pub fn van_der_waals(hamaker: f64, contact_distance: f64) -> Result<Self> {
        Error::non_negative("Hamaker's constant", hamaker)?;
        Error::positive("distance in contact", contact_distance)?;
        Self::new(hamaker / contact_distance / contact_distance / (12.0 * PI), 0.5 * contact_distance, 2.0)
    }

    /// The work of adhesion w.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// The range ρ.
    pub fn range(&self) -> f64 {
        self.range
    }

    /// The exponent n of the energy.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    #[inline(always)]
    fn at<T: Real>(&self, gap: T) -> [T; 3] {
        let Self { work_of_adhesion: w, range, exponent: n } = *self;
        let inverse = (T::one() + gap / T::lit(n * range)).recip();
        let decay = if n == 2.0 { inverse * inverse } else { inverse.powf(T::lit(n)) };
        [
            -T::lit(w) * decay,
            T::lit(w / range) * decay * inverse,
            -T::lit((n + 1.0) / n * w / range / range) * decay * inverse * inverse,
        ]
    }
}

impl<T: Real> AdhesionLaw<T> for PowerLaw {
    fn energy(&self, gap: T) -> T {
        self.at(gap)[0]
    }
    fn traction(&self, gap: T) -> T {
        self.at(gap)[1]
    }
    fn slope(&self, gap: T) -> T {
        self.at(gap)[2]
    }
    fn hints(&self) -> Hints<T> {
        let w = T::lit(self.work_of_adhesion);
        Hints { zero: w == T::zero(), ..Hints::new(w, T::lit(self.range)).with_name("power").concave() }
    }
    fn evaluate(&self, _: usize, gaps: &[T], values: Values<'_, T>) {
        values.set(
            gaps,
            #[inline(always)]
            |gap| self.at(gap),
        );
    }
}
