//! The law without adhesion.

use super::AdhesionLaw;
use crate::real::Real;

/// No adhesion: φ = 0. The solver does not evaluate it at all.
///
/// ```
/// use asperity::{AdhesionLaw, NoAdhesion};
/// assert!(AdhesionLaw::<f64>::is_zero(&NoAdhesion));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoAdhesion;

impl<T: Real> AdhesionLaw<T> for NoAdhesion {
    fn energy(&self, _: T) -> T {
        T::zero()
    }
    fn traction(&self, _: T) -> T {
        T::zero()
    }
    fn slope(&self, _: T) -> T {
        T::zero()
    }
    fn is_zero(&self) -> bool {
        true
    }
}
