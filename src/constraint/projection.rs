use super::ContactConstraint;
use crate::real::Real;

/// The gap is confined to g ≥ 0: steps that would pass are clipped, and contact nodes under tension are released.
///
/// Complementarity is exact: where the contact pressure is positive the gap is zero, to the last bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Projection;

impl<T: Real> ContactConstraint<T> for Projection {
    fn projects(&self) -> bool {
        true
    }
}
