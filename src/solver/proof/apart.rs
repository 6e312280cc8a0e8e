//! Whether a load has pulled surfaces apart.

use super::Proof;
use crate::degrees::{HALF, HARDLY, LITTLE};
use crate::problem::Load;
use crate::real::Real;

impl<T: Real, Lo: Real> Proof<'_, '_, T, Lo> {
    /// Whether a load that does not press has left the surfaces apart: no contact, and hardly any traction.
    pub(in crate::solver) fn is_apart(&self) -> bool {
        let bears =
            self.iterate.posed.is_gap_controlled() || self.iterate.given() > 0.0 || self.iterate.tally().contact > 0.0;
        self.iterate.posed.adheres() && !bears && (self.has_let_go() || self.flies_apart())
    }

    /// The tension of the load in all.
    fn pulled(&self) -> f64 {
        -self.iterate.given() * self.iterate.posed.nodes()
    }

    /// Whether the law holds hardly any of the tension, or of the traction of one node that touches. A traction that rises
    /// with the gap is none at rest: then the energy of adhesion tells.
    fn has_let_go(&self) -> bool {
        let hints = self.iterate.posed.law().hints();
        let (range, work) = (hints.range.widen(), hints.work_of_adhesion.widen());
        let one = if range > 0.0 { work / range } else { 0.0 };
        let hardly = HARDLY * self.pulled().max(one);
        let is_spent = hints.concave || range == 0.0 || self.stored() <= hardly * range;
        self.iterate.tally().traction <= hardly && is_spent
    }

    /// Whether surfaces under a pressure fly apart, once their waves are at rest: they store less energy of adhesion than one
    /// node has at the strongest traction of the law, or at all if the traction is strongest in contact. Where the law varies
    /// one node may have less than another.
    fn flies_apart(&self) -> bool {
        let hints = self.iterate.posed.law().hints();
        let least = if hints.concave { 1.0 - HARDLY } else { HALF };
        let exceeds = self.iterate.tally().traction < self.pulled() && (hints.concave || hints.shape.is_none());
        let flies = self.stored() < least * hints.work_of_adhesion.widen()
            && (exceeds || self.pulled() == 0.0 && self.iterate.posed.from_full_contact);
        flies && matches!(self.iterate.posed.load, Load::Pressure(_)) && self.relative_error() <= LITTLE
    }

    /// The energy of adhesion in all.
    fn stored(&self) -> f64 {
        -self.iterate.tally().adhesive
    }

    /// Whether surfaces under a pressure have come apart and would drift for ever.
    pub(in crate::solver) fn is_adrift(&self) -> bool {
        let thrown = self.iterate.posed.from_full_contact;
        let drifts = matches!(self.iterate.posed.load, Load::Pressure(pressure) if pressure < 0.0 || thrown);
        drifts && self.is_apart()
    }
}
