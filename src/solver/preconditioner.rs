//! The preconditioner, its certificate, and its foundation: the stiffness of the contacts.

use super::coarse::Coarse;
use super::minimisation::{Descent, Nearness};
use super::passes::{self, Fields, idles};
use super::state::State;
use crate::elastic::Foundation;
use crate::error::Result;
use crate::real::Real;

/// The least stiffness of the contacts, over the stiffness of the softest wave.
const SOFTEST: f64 = 0.1;

/// The least stiffness of the mean gap, in the same unit.
const LEAST_MEAN: f64 = 0.01;

/// The iterations from a far start under a pressure, and the load error, before the contact map is settled.
const UNSETTLED: usize = 3;
const LOADED: f64 = 0.3;

/// The same for the relative error with adhesion.
const SETTLED: f64 = 0.1;

/// The stiffness of one node over the stiffness of the stiffest wave: the reciprocal of a square grid's mean
/// compliance.
const ALONE: f64 = 0.4;

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    /// z = M r' and the certificate, from one application.
    pub(super) fn certify(&mut self) -> Result<()> {
        self.renew_coarse();
        let (stiffness, mean_stiffness) = (self.foundation(), self.mean_stiffness());
        let centred = self.posed.is_gap_controlled();
        let coarse = self.steps.coarse.as_mut().and_then(Coarse::ready);
        let foundation = Foundation { stiffness, mean_stiffness, coarse };
        let stiffest = self.posed.stiffness_range().1;
        let holds = self.posed.potential().is_soft() && stiffest > 0.0;
        let held = holds.then(|| passes::hold(&mut self.fields, &self.posed.potential(), ALONE * stiffest, centred));
        let Fields { residual, preconditioned, .. } = &mut self.fields;
        let found =
            self.posed.operators.corrections().precondition(residual.view(), foundation, preconditioned.view_mut())?;
        let [mut sum, mut descent] = [found.mean, found.descent].map(|mean| mean * self.posed.nodes());
        let mut certificate = found.error.max(0.0);
        if let Some(held) = held {
            sum = passes::release_held(&mut self.fields, &self.posed.potential(), held);
            descent += held.descent;
            // loads that add up to the residual: responses add up in the energy norm
            certificate = (certificate.sqrt() + (held.beside / self.posed.nodes()).sqrt()).powi(2);
        }
        self.sums.certificate = if found.error.is_nan() { f64::INFINITY } else { certificate };
        self.sums.preconditioned = Descent { descent, sum };
        self.counters.applications += 1;
        Ok(())
    }

    /// The stiffness of the contacts against a change of the mean gap, about λ̄/h_rms for rough surfaces.
    fn contact_stiffness(&self) -> f64 {
        (self.external_pressure() + self.mean_traction()).abs() / self.posed.flat.rms_height
    }

    /// The stiffness of the contacts in the preconditioner; from a far start under a pressure, the softest wave's.
    pub(super) fn foundation(&self) -> f64 {
        let (softest, stiffest) = self.posed.stiffness_range();
        if stiffest <= 0.0 {
            return self.posed.operators.state().modulus() / self.posed.operators.state().grid().lengths().0;
        }
        let contact = self.contact_stiffness();
        let near = self.steps.nearness > Nearness::Afar || self.posed.is_gap_controlled();
        if near && contact.is_finite() { contact.clamp(SOFTEST * softest, stiffest) } else { softest }
    }

    /// The stiffness of the mean gap in the preconditioner: of the contacts, and of a spring. On the way from a far
    /// start the geometric mean of the contacts' stiffness, too small for light loads, and the stiffness of the softest
    /// wave.
    pub(super) fn mean_stiffness(&self) -> f64 {
        let (softest, stiffest) = self.posed.stiffness_range();
        if stiffest <= 0.0 {
            // nothing resists before a node touches: a step is as long as the gap
            let gap = self.mean_gap();
            let falls = gap > 0.0 && self.posed.law().hints().zero && self.sums.given > 0.0;
            let contact = if falls { self.foundation().min(self.sums.given / gap) } else { self.foundation() };
            return contact + self.posed.load.stiffness();
        }
        let mean = (softest * self.contact_stiffness()).sqrt();
        let contact = if mean.is_finite() { mean.clamp(LEAST_MEAN * softest, stiffest) } else { softest };
        contact + self.posed.load.stiffness()
    }

    /// Whether the bodies are apart on a spring softer than the preconditioner's mean gap.
    pub(super) fn hangs_on_spring(&self) -> bool {
        let spring = self.posed.load.stiffness();
        let soft = spring > 0.0 && spring < LEAST_MEAN * self.posed.stiffness_range().0;
        soft && self.sums.tally.contact == 0.0
    }

    /// The mean of r over the nodes apart; where all are apart, without the mean of p: a soft spring would feel its
    /// rounding.
    pub(super) fn imbalance(&self) -> f64 {
        let balance = || self.sums.given + self.mean_traction();
        if self.hangs_on_spring() { balance() } else { self.sums.tally.sum_r / self.sums.tally.free }
    }

    fn is_settled(&self) -> bool {
        let loaded = self.steps.nearness > Nearness::Afar
            || self.posed.is_gap_controlled()
            || (self.counters.iterations >= UNSETTLED && self.load_error() <= LOADED);
        loaded && (self.posed.law().hints().zero || self.relative_error() <= SETTLED)
    }

    /// Renews the contact map now and then, from the nodes outside of the working set or those that springs hold.
    pub(super) fn renew_coarse(&mut self) {
        let (settled, projects, held) = (self.is_settled(), self.posed.projects(), self.posed.is_gap_controlled());
        let (stiffness, range) = (self.posed.flat.stiffness, self.posed.stiffness_range());
        let (spring, window) = (self.posed.load.stiffness(), self.posed.flat.window.as_ref());
        let iteration = self.counters.iterations;
        let Some(coarse) = self.steps.coarse.as_mut().filter(|coarse| coarse.is_due(iteration, settled)) else {
            return;
        };
        if projects {
            let touches = |_, residual| idles(residual);
            coarse.renew(iteration, &self.fields.residual, touches, (stiffness, spring), range, held);
        } else {
            let rest = self.posed.law().hints().rest.unwrap_or_else(T::zero);
            let touches = |node, gap| gap <= rest && window.is_none_or(|window| window.faces(node));
            coarse.renew(iteration, &self.fields.gap, touches, (stiffness, spring), range, held);
        }
    }
}
