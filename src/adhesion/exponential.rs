//! The exponential law: an energy −w exp(−g/ρ).

use super::AdhesionLaw;
use super::exponentials::exponentials;
use crate::error::{Error, Result};
use crate::real::Real;

/// The exponential law, φ(g) = −w exp(−g/ρ).
///
/// ```math
/// φ(g) = −w exp(−g/ρ) ,   φ'(g) = w/ρ exp(−g/ρ) ,   φ''(g) = −w/ρ² exp(−g/ρ)
/// ```
///
/// Equations (37) and (38) of Rey, Anciaux and Molinari (2017), with w for their γ.
///
/// ```
/// use asperity::{AdhesionLaw, Exponential};
/// let law = Exponential::new(0.05, 2e-9)?; // 50 mJ/m² over 2 nm
/// assert_eq!(law.energy(0.0), -0.05);
/// assert_eq!(law.traction(0.0), law.work_of_adhesion() / law.range());
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    work_of_adhesion: f64,
    range: f64,
}

impl Exponential {
    /// The law with work of adhesion w (energy per area) and range ρ (length), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ not positive, or either not finite.
    pub fn new(work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Ok(Self { work_of_adhesion, range })
    }

    /// The work of adhesion w, as it was given.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// The range ρ, as it was given.
    pub fn range(&self) -> f64 {
        self.range
    }

    /// w and ρ, rounded to the precision of the fields.
    fn rounded<T: Real>(&self) -> (T, T) {
        (T::lit(self.work_of_adhesion), T::lit(self.range))
    }
}

impl<T: Real> AdhesionLaw<T> for Exponential {
    fn energy(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        -w * (-gap / range).exp()
    }
    fn traction(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        w / range * (-gap / range).exp()
    }
    fn slope(&self, gap: T) -> T {
        let (w, range) = self.rounded::<T>();
        -w / range / range * (-gap / range).exp()
    }
    fn energies(&self, _: usize, gaps: &[T], energies: &mut [T]) {
        let (w, range) = self.rounded::<T>();
        exponentials(-w, -range.recip(), gaps, energies);
    }
    fn tractions(&self, _: usize, gaps: &[T], tractions: &mut [T]) {
        let (w, range) = self.rounded::<T>();
        exponentials(w / range, -range.recip(), gaps, tractions);
    }
    fn slopes(&self, _: usize, gaps: &[T], slopes: &mut [T]) {
        let (w, range) = self.rounded::<T>();
        exponentials(-w / range / range, -range.recip(), gaps, slopes);
    }
    fn energies_and_tractions(&self, first: usize, gaps: &[T], energies: &mut [T], tractions: &mut [T]) {
        self.tractions(first, gaps, tractions);
        let range = T::lit(self.range);
        energies.iter_mut().zip(tractions).for_each(|(e, t)| *e = -*t * range);
    }
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.tractions(first, gaps, tractions);
        let rate = -T::lit(self.range).recip();
        slopes.iter_mut().zip(tractions).for_each(|(s, t)| *s = *t * rate);
    }
    fn range(&self) -> T {
        T::lit(self.range)
    }
    fn is_concave(&self) -> bool {
        true
    }
    fn is_zero(&self) -> bool {
        T::lit(self.work_of_adhesion) == T::zero()
    }
}
