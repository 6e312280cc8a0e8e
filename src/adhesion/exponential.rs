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
/// let law = Exponential::new(0.05_f64, 2e-9)?; // 50 mJ/m² over 2 nm
/// assert_eq!(law.energy(0.0), -0.05);
/// assert_eq!(law.traction(0.0), 0.05 / 2e-9);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential<T> {
    work_of_adhesion: T,
    range: T,
}

impl<T: Real> Exponential<T> {
    /// The law with work of adhesion w (energy per area) and range ρ (length).
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ not positive, or either not finite.
    pub fn new(work_of_adhesion: T, range: T) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion.widen())?;
        Error::positive("range of adhesion", range.widen())?;
        Ok(Self { work_of_adhesion, range })
    }
}

impl<T: Real> AdhesionLaw<T> for Exponential<T> {
    fn energy(&self, gap: T) -> T {
        -self.work_of_adhesion * (-gap / self.range).exp()
    }
    fn traction(&self, gap: T) -> T {
        self.work_of_adhesion / self.range * (-gap / self.range).exp()
    }
    fn slope(&self, gap: T) -> T {
        -self.work_of_adhesion / self.range / self.range * (-gap / self.range).exp()
    }
    fn energies(&self, _: usize, gaps: &[T], energies: &mut [T]) {
        exponentials(-self.work_of_adhesion, -self.range.recip(), gaps, energies);
    }
    fn tractions(&self, _: usize, gaps: &[T], tractions: &mut [T]) {
        exponentials(self.work_of_adhesion / self.range, -self.range.recip(), gaps, tractions);
    }
    fn slopes(&self, _: usize, gaps: &[T], slopes: &mut [T]) {
        exponentials(-self.work_of_adhesion / self.range / self.range, -self.range.recip(), gaps, slopes);
    }
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]) {
        self.tractions(first, gaps, tractions);
        let rate = -self.range.recip();
        slopes.iter_mut().zip(tractions).for_each(|(s, t)| *s = *t * rate);
    }
    fn range(&self) -> T {
        self.range
    }
    fn is_zero(&self) -> bool {
        self.work_of_adhesion == T::zero()
    }
}
