//! Projection: a rigid wall at g = 0, kept by clipping every step.

use super::{ContactConstraint, Wall};
use crate::real::Real;

/// A rigid wall, g ≥ 0: steps that would pass are clipped, and contact nodes under tension are released. Where the
/// contact pressure is positive the gap is exactly zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Projection;

impl<T: Real> ContactConstraint<T> for Projection {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Rigid
    }
}
