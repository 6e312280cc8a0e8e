//! Where surfaces attract each other without a range: at the nodes within four nodes of a contact, and at nodes that
//! were and have not parted since. In the limit of no range surfaces do not feel each other before they touch.
//!
//! A minimisation begins with the neighbourhood of the contacts of its start. It takes in the neighbourhood of contacts
//! as they spread, and of other contacts once it has come to rest, until nothing is added.

use ndarray::Array2;

use super::passes::Fields;
use super::posed::Posed;
use super::state::State;
use crate::adhesion::{Neighbourhood, Touched};
use crate::constraint::Wall;
use crate::elastic::Boundary;
use crate::field::{Field, Minimum, ordered, read};
use crate::real::Real;

/// The error at which surfaces may touch at nodes where they do not attract each other.
pub(super) const TOUCHING: f64 = 1e-3;

impl<T: Real, Lo: Real> Posed<'_, T, Lo> {
    /// Lets surfaces attract each other in the neighbourhood of the contacts of a gap alone, and where they still did
    /// `before`; both are on the grid of the operator.
    pub(super) fn touch(&mut self, gap: &Array2<T>, before: Option<&Array2<bool>>) {
        let (grid, slab) = match &self.flat.window {
            Some(window) => (*window.grid(), window.held()),
            None => (*self.operators.state().grid(), self.operators.state().grid().slab()),
        };
        let mut neighbourhood = Neighbourhood::none((&grid, slab), self.flat.boundary == Boundary::Periodic);
        self.mark_contacts(gap, &mut neighbourhood);
        neighbourhood.grow();
        if let Some(before) = before {
            neighbourhood.add(&match &self.flat.window {
                Some(window) => window.cut(before, false),
                None => Field::of(before),
            });
        }
        (self.touched, self.spreads) = (Some(Touched { law: self.adhesion, neighbourhood }), true);
    }

    /// Marks the contacts of a gap on the operator's grid.
    fn mark_contacts(&self, gap: &Array2<T>, neighbourhood: &mut Neighbourhood) {
        let (wall, first) = (self.constraint.wall(), neighbourhood.first_node());
        let mark = |gaps: &[T], contacts: &mut [bool], first: usize| {
            for ((contact, &gap), node) in contacts.iter_mut().zip(gaps).zip(first..) {
                let springs = || matches!(wall, Wall::Springs(springs) if springs.traction(node, gap) < T::zero());
                *contact = gap <= T::zero() || springs();
            }
        };
        let (gaps, contacts) = (ordered(gap.view()), neighbourhood.contact.nodes_mut());
        match &self.flat.window {
            None => mark(&gaps, contacts, first),
            Some(window) => {
                window
                    .places()
                    .for_each(|(nodes, own)| mark(&gaps[nodes], &mut contacts[own.clone()], first + own.start));
            }
        }
    }
}

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    /// Lets surfaces touch that a load brings together and hardly presses, as rounding may leave a gap between them.
    pub(super) fn close_up(&mut self) {
        let local = self.posed.potential();
        let Fields { reducer, gap, .. } = &mut self.fields;
        let least = local.run(reducer, read(gap), |local, _, gap| {
            let least = gap.iter().fold(T::infinity(), |least, &gap| least.min(gap));
            Minimum(if local.is_surface() { least.widen() } else { f64::INFINITY })
        });
        let least = T::lit(least.0);
        if least > T::zero() {
            self.each_gap(|gap| gap - least);
        }
    }

    /// Takes in the neighbourhood of contacts where surfaces attract each other already, or `everywhere`; whether it is
    /// larger than before.
    fn take_in(&mut self, everywhere: bool) -> bool {
        let Some(mut touched) = self.posed.touched.take() else { return false };
        let neighbourhood = &mut touched.neighbourhood;
        self.posed.mark_contacts(&self.fields.gap, neighbourhood);
        if everywhere {
            self.counters.touches |= neighbourhood.has_others();
        } else {
            neighbourhood.confine();
        }
        let grows = neighbourhood.grow();
        self.posed.touched = Some(touched);
        grows
    }

    /// Follows contacts that have spread in a step.
    pub(super) fn follow_contacts(&mut self, before: f64) {
        if self.sums.tally.contact != before && self.take_in(false) {
            self.counters.progress = Default::default();
            self.count();
            self.compute_residual();
        }
    }

    /// Takes in the neighbourhood of all contacts of a state at rest, to continue from there; whether it has grown.
    pub(super) fn touches_more(&mut self) -> bool {
        let grows = self.take_in(true);
        if grows {
            self.restart();
            self.sums.certificate = f64::INFINITY;
        }
        grows
    }

    /// Where surfaces without a range of adhesion attract each other; none where they do so everywhere.
    pub(super) fn touched(&self) -> Option<Field<bool>> {
        Some(self.posed.touched.as_ref()?.neighbourhood.near().clone())
    }

    /// The nodes of the operator's grid at which surfaces without a range of adhesion attract each other and have not
    /// parted by the range of the grid.
    pub(super) fn not_parted(&self) -> Option<Array2<bool>> {
        let hints = self.posed.adhesion.hints();
        if !hints.touches() {
            return None;
        }
        let touched = self.touched().map(|near| match &self.posed.flat.window {
            Some(window) => window.place(&near, false),
            None => near,
        });
        let mut touched = touched.iter().flat_map(|touched| touched.nodes());
        Some(self.fields.gap.map(|&gap| *touched.next().unwrap_or(&true) && gap < hints.range))
    }
}
