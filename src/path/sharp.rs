//! A law that keeps its jumps.

use std::sync::Arc;

use crate::adhesion::{AdhesionLaw, Discretisation, Hints, Values};
use crate::real::Real;

/// A law with jumps that no solve smooths.
pub(super) struct Sharp<'a, T>(pub(super) &'a dyn AdhesionLaw<T>);

impl<T: Real> AdhesionLaw<T> for Sharp<'_, T> {
    fn energy(&self, gap: T) -> T {
        self.0.energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.0.traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.0.slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        self.0.hints()
    }
    fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) {
        self.0.evaluate(first, gaps, values);
    }
    fn contact_shares(&self, first: usize, gaps: &[T], shares: &mut [T]) {
        self.0.contact_shares(first, gaps, shares);
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        self.0.on_nodes(compliance)
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        if let Discretisation::Smooth(_) = to { None } else { self.0.adapted(to) }
    }
}
