use super::AdhesionLaw;
use crate::error::{Error, Result};
use crate::real::Real;

/// The law of Maugis and Dugdale: a constant traction σ₀ = w/ρ up to the range ρ, none beyond.
///
/// ```math
/// \phi(g) = -w \max(0,\, 1 - g/\rho), \qquad \phi'(g) = \frac{w}{\rho}\,[g < \rho]
/// ```
///
/// Maugis (1992); equations (26) and (27) of Rey, Anciaux and Molinari (2017), of which (26) is misprinted.
/// The traction jumps at g = ρ: there are many equilibria at one mean gap, and which of them a solve
/// finds depends on its start.
///
/// ```
/// use asperity::{AdhesionLaw, MaugisDugdale};
/// let law = MaugisDugdale::new(1e-4, 2e-3)?;
/// assert_eq!((law.traction(1e-3), law.traction(3e-3)), (1e-4 / 2e-3, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale<T> {
    work_of_adhesion: T,
    range: T,
}

impl<T: Real> MaugisDugdale<T> {
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

impl<T: Real> AdhesionLaw<T> for MaugisDugdale<T> {
    fn energy(&self, gap: T) -> T {
        -self.work_of_adhesion * (T::one() - gap / self.range).max(T::zero())
    }
    fn traction(&self, gap: T) -> T {
        if gap < self.range { self.work_of_adhesion / self.range } else { T::zero() }
    }
    fn slope(&self, _: T) -> T {
        T::zero()
    }
    fn range(&self) -> T {
        self.range
    }
    fn is_zero(&self) -> bool {
        self.work_of_adhesion == T::zero()
    }
}
