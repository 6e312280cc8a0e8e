use super::{AdhesionLaw, Hints};
use crate::real::Real;

/// No adhesion: φ = 0, which the solver does not evaluate.
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
    fn hints(&self) -> Hints<T> {
        Hints { zero: true, ..Hints::of(self).with_name("none") }
    }
}
