//! The law of Maugis and Dugdale: a constant traction up to a range.

use super::AdhesionLaw;
use crate::error::{Error, Result};
use crate::real::Real;

/// The law of Maugis and Dugdale: a constant traction σ₀ = w/ρ up to the range ρ, none beyond.
///
/// ```math
/// φ(g) = −w max(0, 1 − g/ρ) ,   φ'(g) = w/ρ  for g < ρ,  0 beyond
/// ```
///
/// Maugis (1992); equations (26) and (27) of Rey, Anciaux and Molinari (2017), of which (26) is misprinted.
/// The traction jumps at g = ρ: there are many equilibria at one mean gap, and which of them a solve finds depends on
/// its start. In the law [`smoothed`](AdhesionLaw::smoothed) the traction falls evenly between ρ − d/2 and ρ + d/2
/// instead, over d = σ₀·compliance, at most 2ρ.
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
    /// the width d over which the traction falls; zero for the law itself
    smoothing: T,
}

impl<T: Real> MaugisDugdale<T> {
    /// The law with work of adhesion w (energy per area) and range ρ (length).
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ not positive, or either not finite.
    pub fn new(work_of_adhesion: T, range: T) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion.widen())?;
        Error::positive("range of adhesion", range.widen())?;
        Ok(Self { work_of_adhesion, range, smoothing: T::zero() })
    }

    fn is_falling(&self, gap: T) -> bool {
        (gap - self.range).abs() < T::lit(0.5) * self.smoothing
    }
}

impl<T: Real> AdhesionLaw<T> for MaugisDugdale<T> {
    fn energy(&self, gap: T) -> T {
        let (width, x) = (self.smoothing, self.range - gap);
        let inside = if self.is_falling(gap) {
            let left = x + T::lit(0.5) * width;
            T::lit(0.5) * left * (left / width)
        } else {
            x.max(T::zero())
        };
        -self.work_of_adhesion * (inside / self.range)
    }
    fn traction(&self, gap: T) -> T {
        let largest = self.work_of_adhesion / self.range;
        if self.is_falling(gap) {
            largest * ((self.range - gap) / self.smoothing + T::lit(0.5))
        } else if gap < self.range {
            largest
        } else {
            T::zero()
        }
    }
    fn slope(&self, gap: T) -> T {
        if self.is_falling(gap) { -self.work_of_adhesion / self.range / self.smoothing } else { T::zero() }
    }
    fn range(&self) -> T {
        self.range
    }
    fn smoothed(&self, compliance: T) -> Option<Box<dyn AdhesionLaw<T> + '_>> {
        let width = self.work_of_adhesion / self.range * compliance;
        let smoothing = width.min(T::lit(2.0) * self.range);
        (smoothing > T::zero()).then(|| Box::new(Self { smoothing, ..*self }) as Box<dyn AdhesionLaw<T>>)
    }
    fn is_zero(&self) -> bool {
        self.work_of_adhesion == T::zero()
    }
}
