//! Where surfaces attract each other without a range: at the nodes within four nodes of a contact, and at nodes that
//! were and have not parted since. In the limit of no range surfaces do not feel each other before they touch.
//!
//! A minimisation begins with the neighbourhood of the contacts of its start. It takes in the neighbourhood of contacts
//! as they spread, and of other contacts once it has come to rest, until nothing is added.

use ndarray::Array2;

use super::descent::Descent;
use super::posed::Posed;
use crate::adhesion::{Neighbourhood, Touched};
use crate::field::{Field, ordered};
use crate::real::Real;

impl<T: Real, Lo: Real> Posed<'_, T, Lo> {
    /// Lets surfaces attract each other in the neighbourhood of the contacts of a gap alone, and where they still did
    /// `before`; both are on the grid of the operator.
    pub(super) fn touch(&mut self, gap: &Array2<T>, before: Option<&Array2<bool>>) {
        let (flat, whole) = (self.flat, *self.operators.state().grid());
        let mut neighbourhood = Neighbourhood::none(flat.held(&whole), flat.boundary.is_periodic());
        self.mark_contacts(gap, &mut neighbourhood);
        neighbourhood.grow();
        if let Some(before) = before {
            neighbourhood.add(&flat.cut(before, false));
        }
        (self.touched, self.spreads) = (Some(Touched { law: self.adhesion, neighbourhood }), true);
    }

    /// Marks the contacts of a gap on the operator's grid.
    fn mark_contacts(&self, gap: &Array2<T>, neighbourhood: &mut Neighbourhood) {
        let (wall, first) = (self.constraint.wall(), neighbourhood.first_node());
        let mark = |gaps: &[T], contacts: &mut [bool], first: usize| {
            for ((contact, &gap), node) in contacts.iter_mut().zip(gaps).zip(first..) {
                let press = || wall.springs().is_some_and(|springs| springs.traction(node, gap) < T::zero());
                *contact = gap <= T::zero() || press();
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

    /// Takes in the neighbourhood of contacts of a gap where surfaces attract each other already, or `everywhere`; whether
    /// it is larger than before.
    pub(super) fn take_in(&mut self, gap: &Array2<T>, everywhere: bool) -> bool {
        let Some(mut touched) = self.touched.take() else { return false };
        let neighbourhood = &mut touched.neighbourhood;
        self.mark_contacts(gap, neighbourhood);
        if everywhere {
            self.touches |= neighbourhood.has_others();
        } else {
            neighbourhood.confine();
        }
        let grows = neighbourhood.grow();
        self.touched = Some(touched);
        grows
    }

    /// Where surfaces without a range of adhesion attract each other; none where they do so everywhere.
    pub(super) fn near(&self) -> Option<Field<bool>> {
        Some(self.touched.as_ref()?.neighbourhood.near().clone())
    }

    /// The nodes of the operator's grid at which surfaces without a range of adhesion attract each other and have not
    /// parted by the range of the grid.
    pub(super) fn not_parted(&self, gap: &Array2<T>) -> Option<Array2<bool>> {
        let hints = self.adhesion.hints();
        if !hints.touches() {
            return None;
        }
        let touched = self.near().map(|near| self.flat.place(near, false));
        let mut touched = touched.iter().flat_map(|touched| touched.nodes());
        Some(gap.map(|&gap| *touched.next().unwrap_or(&true) && gap < hints.range))
    }
}

/// Takes in the neighbourhood of all contacts of a state at rest, to continue from there; whether it has grown.
pub(super) fn touches_more<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) -> bool {
    let grows = descent.iterate.take_in(true);
    if grows {
        descent.restart();
        descent.forget_certificate();
    }
    grows
}
