//! A law that differs from node to node: each node has one of several laws.

use std::sync::Arc;

use asperity::adhesion::{Discretisation, Hints, Values};
use asperity::{AdhesionLaw, Real};

/// One of several laws at each node, with works of adhesion and ranges of their own.
pub struct Patches<L> {
    pub laws: Vec<L>,
    pub shape: (usize, usize),
    /// The law of every node, in row-major order.
    pub of: Vec<usize>,
}

impl<L> Patches<L> {
    /// The law of the largest work of adhesion, which answers for one gap.
    fn strongest<T: Real>(&self) -> &L
    where
        L: AdhesionLaw<T>,
    {
        let works = self.laws.iter().map(|law| law.hints().work_of_adhesion);
        let of = works.enumerate().fold((0, T::zero()), |a, b| if b.1 > a.1 { b } else { a }).0;
        &self.laws[of]
    }
}

impl<T: Real, L: AdhesionLaw<T> + Clone + 'static> AdhesionLaw<T> for Patches<L> {
    fn energy(&self, gap: T) -> T {
        self.strongest().energy(gap)
    }
    fn traction(&self, gap: T) -> T {
        self.strongest().traction(gap)
    }
    fn slope(&self, gap: T) -> T {
        self.strongest().slope(gap)
    }
    fn hints(&self) -> Hints<T> {
        let (mut hints, all) = (self.strongest().hints().with_shape(self.shape), || self.laws.iter().map(L::hints));
        hints.concave = all().all(|one| one.concave);
        hints.zero = all().all(|one| one.zero);
        // they keep the surfaces apart together, or not at all
        hints.rest = hints.rest.filter(|_| all().all(|one| one.rest == hints.rest));
        hints
    }
    fn evaluate(&self, first: usize, gaps: &[T], mut values: Values<'_, T>) {
        let mut start = 0;
        for patch in self.of[first..first + gaps.len()].chunk_by(|a, b| a == b) {
            let nodes = start..start + patch.len();
            self.laws[patch[0]].evaluate(first + start, &gaps[nodes.clone()], values.part(nodes.clone()));
            start = nodes.end;
        }
    }
    fn adapted(&self, to: Discretisation<T>) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let (mut shape, mut of) = (self.shape, self.of.clone());
        let adapted: Vec<_> = self.laws.iter().map(|law| law.adapted(to)).collect();
        match to {
            Discretisation::Coarse(nx, ny) => {
                of = of.chunks(shape.1).step_by(nx).flat_map(|row| row.iter().step_by(ny).copied()).collect();
                shape = (shape.0.div_ceil(nx), shape.1.div_ceil(ny));
            }
            _ if adapted.iter().all(Option::is_none) => return None,
            _ => {}
        }
        // a law that stays the same
        let laws = adapted.into_iter().zip(&self.laws).map(|(law, same)| law.unwrap_or_else(|| Arc::new(same.clone())));
        Some(Arc::new(Patches { laws: laws.collect(), shape, of }))
    }
}
