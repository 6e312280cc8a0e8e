//! The mean gap under a given pressure: the stiffness of the contacts, and the lift of the nodes that follow it.

use super::Method;
use super::passes::{self, Follows};
use super::state::State;

use crate::problem::Control;
use crate::real::Real;

/// The least stiffness of the contacts, as a share of the stiffness of the softest wave.
const SOFTEST: f64 = 0.1;

/// The stiffness of the lift over that of the contacts: above one, as its shape is an estimate.
const STIFFER: f64 = 1.5;

/// The gap g₀ at which v = 1/√2, in rms heights, and the least gap that counts, in units of g₀.
const HALF: f64 = 0.3;
const LEAST: f64 = 1e-3;

impl<T: Real> State<'_, T> {
    /// The stiffness of the contacts against a change of the mean gap, about λ̄/h_rms for rough surfaces.
    fn contact_stiffness(&self) -> f64 {
        let external = match self.control {
            Control::MeanGap(_) => -self.multiplier(),
            Control::MeanPressure(pressure) => pressure,
        };
        (external + self.tally.traction / self.nodes()).abs() / self.flat.rms_height
    }

    /// The stiffness of the foundation in the preconditioner: that of the contacts, which long waves meet beside their
    /// own. On the way from a far start under a given pressure it is not known yet, and the softest wave's stiffness
    /// takes its place.
    pub(super) fn foundation(&self) -> f64 {
        let (softest, stiffest) = self.operator.stiffness_range();
        if stiffest <= 0.0 {
            return self.operator.modulus() / self.operator.grid().lengths().0;
        }
        let contact = self.contact_stiffness();
        let near = self.near || self.is_gap_controlled();
        if near && contact.is_finite() { contact.clamp(SOFTEST * softest, stiffest) } else { softest }
    }

    /// Whether the mean gap follows the load by [`Self::lift`].
    fn lifts(&self) -> bool {
        let stiffest = self.operator.stiffness_range().1;
        let preconditioned = self.settings.method == Method::Preconditioned;
        self.near && !self.is_gap_controlled() && preconditioned && self.projects() && stiffest > 0.0
    }

    /// The stiffness of the mean gap in the preconditioner; infinite where the lift moves the mean.
    ///
    /// On the way from a far start, the geometric mean of the stiffness of the contacts, far too small for light
    /// loads, and that of the softest wave.
    pub(super) fn mean_stiffness(&self) -> f64 {
        if self.lifts() {
            return f64::INFINITY;
        }
        let (softest, stiffest) = self.operator.stiffness_range();
        if stiffest <= 0.0 {
            // nothing resists the load of a node alone before it touches: a step is as long as the gap
            let gap = self.tally.sum_gap / self.nodes();
            let falls = gap > 0.0 && self.law.is_zero() && self.given() > 0.0;
            return if falls { self.foundation().min(self.given() / gap) } else { self.foundation() };
        }
        let mean = (softest * self.contact_stiffness()).sqrt();
        if mean.is_finite() { mean.clamp(0.01 * softest, stiffest) } else { softest }
    }

    /// Lets the mean gap follow the load, under a given pressure and near the solution.
    ///
    /// Nodes that are far apart follow the mean, and those near the edge of a contact hardly move. A uniform lift
    /// would tear all edges open. In its place z gains v⟨v r'⟩/(⟨v⟩²k), with v = √(g/(g + g₀)) and k the stiffness of
    /// the contacts.
    pub(super) fn lift(&mut self, foundation: f64) {
        if !self.lifts() {
            return;
        }
        let half = HALF * self.flat.rms_height;
        let follows = Follows { half: T::lit(half), least: T::lit(LEAST * half) };
        let [v, product] = passes::lift_sums(&mut self.fields, follows);
        let scale = product / v / (v / self.nodes()) / (STIFFER * foundation);
        if scale.is_finite() {
            passes::lift(&mut self.fields, follows, T::lit(scale));
            self.preconditioned.descent += scale * product;
        }
    }
}
