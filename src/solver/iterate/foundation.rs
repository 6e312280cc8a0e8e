//! The foundation of the preconditioner: the stiffness of the contacts.

use super::Iterate;
use crate::degrees::{LITTLE, PARTLY};
use crate::real::Real;
use crate::solver::minimisation::Nearness;

impl<T: Real, Lo: Real> Iterate<'_, T, Lo> {
    /// The stiffness of the contacts against a change of the mean gap, about λ̄/h_rms for rough surfaces.
    fn contact_stiffness(&self) -> f64 {
        (self.external_pressure() + self.mean_traction()).abs() / self.posed.flat.rms_height
    }

    /// The stiffness of the contacts in the preconditioner; from a far start under a pressure, the softest wave's.
    pub(in crate::solver) fn foundation(&self) -> f64 {
        let (softest, stiffest) = self.posed.stiffness_range();
        if stiffest <= 0.0 {
            return self.posed.operators.state().modulus() / self.posed.operators.state().grid().lengths().0;
        }
        let contact = self.contact_stiffness();
        let near = self.posed.nearness > Nearness::Afar || self.posed.is_gap_controlled();
        if near && contact.is_finite() { contact.clamp(PARTLY * softest, stiffest) } else { softest }
    }

    /// The stiffness of the mean gap in the preconditioner: of the contacts, and of a spring. On the way from a far
    /// start the geometric mean of the contacts' stiffness, too small for light loads, and the stiffness of the softest
    /// wave.
    pub(in crate::solver) fn mean_stiffness(&self) -> f64 {
        let (softest, stiffest) = self.posed.stiffness_range();
        if stiffest <= 0.0 {
            // nothing resists before a node touches: a step is as long as the gap
            let gap = self.mean_gap();
            let falls = gap > 0.0 && !self.posed.adheres() && self.given > 0.0;
            let contact = if falls { self.foundation().min(self.given / gap) } else { self.foundation() };
            return contact + self.posed.load.stiffness();
        }
        let mean = (softest * self.contact_stiffness()).sqrt();
        let contact = if mean.is_finite() { mean.clamp(LITTLE * softest, stiffest) } else { softest };
        contact + self.posed.load.stiffness()
    }

    /// Whether the bodies are apart on a spring softer than the preconditioner's mean gap.
    pub(in crate::solver) fn hangs_on_spring(&self) -> bool {
        let spring = self.posed.load.stiffness();
        let soft = spring > 0.0 && spring < LITTLE * self.posed.stiffness_range().0;
        soft && self.tally.contact == 0.0
    }

    /// The mean of r over the nodes apart; where all are apart, without the mean of p: a soft spring would feel its
    /// rounding.
    pub(in crate::solver) fn imbalance(&self) -> f64 {
        let balance = || self.given + self.mean_traction();
        if self.hangs_on_spring() { balance() } else { self.tally.sum_r / self.tally.free }
    }
}
