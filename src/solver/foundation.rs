//! The foundation of the preconditioner: the stiffness of the contacts, for long waves and for the mean gap.

use super::passes::idles;
use super::state::State;
use crate::real::Real;

/// The least stiffness of the contacts, as a share of the stiffness of the softest wave.
const SOFTEST: f64 = 0.1;

/// The least stiffness of the mean gap, as a share of the stiffness of the softest wave.
const LEAST_MEAN: f64 = 0.01;

/// The iterations from a far start under a given pressure before the space is used, and the error of the load above
/// which the contact map is not yet that of the solution.
const UNSETTLED: usize = 3;
const LOADED: f64 = 0.3;

/// The relative error above which the contact map is not yet that of the solution with adhesion.
const SETTLED: f64 = 0.1;

impl<T: Real, L: Real> State<'_, T, L> {
    /// The stiffness of the contacts against a change of the mean gap, about λ̄/h_rms for rough surfaces.
    fn contact_stiffness(&self) -> f64 {
        let external = if self.is_gap_controlled() { -self.multiplier() } else { self.given };
        (external + self.tally.traction / self.nodes()).abs() / self.flat.rms_height
    }

    /// The stiffness of the foundation in the preconditioner: that of the contacts, which long waves meet beside their
    /// own. On the way from a far start under a given pressure it is not known yet, and the softest wave's stiffness
    /// takes its place.
    pub(super) fn foundation(&self) -> f64 {
        let (softest, stiffest) = self.operators.state().stiffness_range();
        if stiffest <= 0.0 {
            return self.operators.state().modulus() / self.operators.state().grid().lengths().0;
        }
        let contact = self.contact_stiffness();
        let near = self.near || self.is_gap_controlled();
        if near && contact.is_finite() { contact.clamp(SOFTEST * softest, stiffest) } else { softest }
    }

    /// The stiffness of the mean gap in the preconditioner: that of the contacts, and of the spring if there is one.
    ///
    /// On the way from a far start, the geometric mean of the stiffness of the contacts, far too small for light
    /// loads, and that of the softest wave.
    pub(super) fn mean_stiffness(&self) -> f64 {
        let (softest, stiffest) = self.operators.state().stiffness_range();
        if stiffest <= 0.0 {
            // nothing resists the load of a node alone before it touches: a step is as long as the gap
            let gap = self.tally.sum_gap / self.nodes();
            let falls = gap > 0.0 && self.law.hints().zero && self.given > 0.0;
            let contact = if falls { self.foundation().min(self.given / gap) } else { self.foundation() };
            return contact + self.load.stiffness();
        }
        let mean = (softest * self.contact_stiffness()).sqrt();
        let contact = if mean.is_finite() { mean.clamp(LEAST_MEAN * softest, stiffest) } else { softest };
        contact + self.load.stiffness()
    }

    /// Whether the bodies are apart on a spring that is softer than the preconditioner takes the mean gap to be.
    pub(super) fn hangs_on_spring(&self) -> bool {
        let spring = self.load.stiffness();
        let soft = spring > 0.0 && spring < LEAST_MEAN * self.operators.state().stiffness_range().0;
        soft && self.tally.contact == 0.0
    }

    /// The mean of r over the nodes that are apart. That of p has no part in it where all are; of its rounding little is
    /// much to a soft spring.
    pub(super) fn imbalance(&self) -> f64 {
        let balance = || self.given + self.tally.traction / self.nodes();
        if self.hangs_on_spring() { balance() } else { self.tally.sum_r / self.tally.free }
    }

    /// Whether the contacts are where they will be, but for some nodes.
    fn is_settled(&self) -> bool {
        let loaded =
            self.near || self.is_gap_controlled() || (self.iterations >= UNSETTLED && self.load_error() <= LOADED);
        loaded && (self.law.hints().zero || self.relative_error() <= SETTLED)
    }

    /// Tells the coarse space where the contacts are, now and then: the nodes outside of the working set, or those that
    /// springs hold.
    pub(super) fn renew_coarse(&mut self) {
        let (settled, projects, held) = (self.is_settled(), self.projects(), self.is_gap_controlled());
        let (stiffness, range) = (self.flat.stiffness, self.operators.state().stiffness_range());
        let (spring, window) = (self.load.stiffness(), self.flat.window.as_ref());
        let iteration = self.iterations;
        let Some(coarse) = self.coarse.as_mut().filter(|coarse| coarse.is_due(iteration, settled)) else { return };
        if projects {
            let touches = |_, residual| idles(residual);
            coarse.renew(iteration, &self.fields.residual, touches, (stiffness, spring), range, held);
        } else {
            let rest = self.law.hints().rest.unwrap_or_else(T::zero);
            let touches = |node, gap| gap <= rest && window.is_none_or(|window| window.faces(node));
            coarse.renew(iteration, &self.fields.gap, touches, (stiffness, spring), range, held);
        }
    }
}
