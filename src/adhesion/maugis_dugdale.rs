use super::{AdhesionLaw, Discretisation, Hints};
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::real::Real;

/// The law of Maugis and Dugdale: a constant traction σ₀ = w/ρ up to the range ρ, none beyond.
///
/// ```math
/// φ(g) = −w max(0, 1 − g/ρ) ,   φ'(g) = w/ρ  for g < ρ,  0 beyond
/// ```
///
/// Maugis (1992); equations (26), which is misprinted, and (27) of Rey, Anciaux and Molinari (2017). As the traction
/// jumps at ρ, there are many equilibria at one mean gap. In the [smoothed](Discretisation::Smooth) law it falls evenly
/// between ρ − d/2 and ρ + d/2, d = σ₀·compliance, at most 2ρ.
///
/// ```
/// use asperity::{AdhesionLaw, MaugisDugdale};
/// let law = MaugisDugdale::new(1e-4, 2e-3)?;
/// assert_eq!((law.traction(1e-3), law.traction(3e-3)), (1e-4 / 2e-3, 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale {
    work_of_adhesion: f64,
    range: f64,
    /// the width d over which the traction falls; zero for the law itself
    smoothing: f64,
}

impl MaugisDugdale {
    /// The law with work of adhesion w (energy per area) and range ρ (length), in either precision.
    ///
    /// # Errors
    /// [`Error::Value`] if w is negative, ρ not positive, or either not finite.
    pub fn new(work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::non_negative("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Ok(Self { work_of_adhesion, range, smoothing: 0.0 })
    }

    /// The work of adhesion w.
    pub fn work_of_adhesion(&self) -> f64 {
        self.work_of_adhesion
    }

    /// The range ρ.
    pub fn range(&self) -> f64 {
        self.range
    }

    fn rounded<T: Real>(&self) -> (T, T, T) {
        (T::lit(self.work_of_adhesion), T::lit(self.range), T::lit(self.smoothing))
    }
}

/// Whether the traction falls at a gap, over the width `smoothing` about `range`.
fn is_falling<T: Real>(gap: T, range: T, smoothing: T) -> bool {
    (gap - range).abs() < T::lit(0.5) * smoothing
}

impl<T: Real> AdhesionLaw<T> for MaugisDugdale {
    fn energy(&self, gap: T) -> T {
        let (w, range, width) = self.rounded::<T>();
        let x = range - gap;
        let inside = if is_falling(gap, range, width) {
            let left = x + T::lit(0.5) * width;
            T::lit(0.5) * left * (left / width)
        } else {
            x.max(T::zero())
        };
        -w * (inside / range)
    }
    fn traction(&self, gap: T) -> T {
        let (w, range, width) = self.rounded::<T>();
        let largest = w / range;
        if is_falling(gap, range, width) {
            largest * ((range - gap) / width + T::lit(0.5))
        } else if gap < range {
            largest
        } else {
            T::zero()
        }
    }
    fn slope(&self, gap: T) -> T {
        let (w, range, width) = self.rounded::<T>();
        if is_falling(gap, range, width) { -w / range / width } else { T::zero() }
    }
    fn hints(&self) -> Hints<T> {
        let (w, range, _) = self.rounded::<T>();
        Hints { zero: w == T::zero(), ..Hints::new(w, range).with_name("maugis-dugdale").concave() }
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let Discretisation::Smooth(compliance) = to else { return None };
        let (w, range, _) = self.rounded::<T>();
        let smoothing = (w / range * compliance).min(T::lit(2.0) * range).widen();
        (smoothing > self.smoothing).then(|| Arc::new(Self { smoothing, ..*self }) as Arc<dyn AdhesionLaw<T>>)
    }
}
