//! The preconditioner, and the certificate that comes with it.

use super::Descent;
use crate::degrees::PARTLY;
use crate::elastic::Foundation;
use crate::error::Result;
use crate::real::Real;
use crate::solver::coarse::Coarse;
use crate::solver::minimisation::{Nearness, Preconditioned};
use crate::solver::passes::{self, Fields, idles};

/// The iterations from a far start under a pressure, and the load error, before the contact map is settled.
const UNSETTLED: usize = 3;
const LOADED: f64 = 0.3;

/// The stiffness of one node over the stiffness of the stiffest wave: the reciprocal of a square grid's mean
/// compliance.
const ALONE: f64 = 0.4;

impl<T: Real, Lo: Real> Descent<'_, T, Lo> {
    /// z = M r' and the certificate, from one application.
    pub(super) fn certify(&mut self) -> Result<()> {
        self.renew_coarse();
        let (stiffness, mean_stiffness) = (self.iterate.foundation(), self.iterate.mean_stiffness());
        let centred = self.iterate.posed.is_gap_controlled();
        let coarse = self.coarse.as_mut().and_then(Coarse::ready);
        let foundation = Foundation { stiffness, mean_stiffness, coarse };
        let stiffest = self.iterate.posed.stiffness_range().1;
        let holds = self.iterate.posed.potential().is_soft() && stiffest > 0.0;
        let held = holds.then(|| {
            passes::hold(&mut self.iterate.fields, &self.iterate.posed.potential(), ALONE * stiffest, centred)
        });
        let Fields { residual, preconditioned, .. } = &mut self.iterate.fields;
        let found = self.iterate.posed.operators.corrections().precondition(
            residual.view(),
            foundation,
            preconditioned.view_mut(),
        )?;
        let [mut sum, mut descent] = [found.mean, found.descent].map(|mean| mean * self.iterate.posed.nodes());
        let mut certificate = found.error.max(0.0);
        if let Some(held) = held {
            sum = passes::release_held(&mut self.iterate.fields, &self.iterate.posed.potential(), held);
            descent += held.descent;
            // loads that add up to the residual: responses add up in the energy norm
            certificate = (certificate.sqrt() + (held.beside / self.iterate.posed.nodes()).sqrt()).powi(2);
        }
        self.certificate = if found.error.is_nan() { f64::INFINITY } else { certificate };
        self.preconditioned = Preconditioned { descent, sum };
        self.iterate.applied();
        Ok(())
    }

    fn is_settled(&self) -> bool {
        let loaded = self.iterate.posed.nearness > Nearness::Afar
            || self.iterate.posed.is_gap_controlled()
            || (self.iterations >= UNSETTLED && self.proof().load_error() <= LOADED);
        loaded && (!self.iterate.posed.adheres() || self.proof().relative_error() <= PARTLY)
    }

    /// Renews the contact map now and then, from the nodes outside of the working set or those that springs hold.
    pub(super) fn renew_coarse(&mut self) {
        let (settled, projects, held) =
            (self.is_settled(), self.iterate.posed.projects(), self.iterate.posed.is_gap_controlled());
        let (stiffness, range) = (self.iterate.posed.flat.stiffness, self.iterate.posed.stiffness_range());
        let (spring, flat) = (self.iterate.posed.load.stiffness(), self.iterate.posed.flat);
        let iteration = self.iterations;
        let Some(coarse) = self.coarse.as_mut().filter(|coarse| coarse.is_due(iteration, settled)) else {
            return;
        };
        if projects {
            let touches = |_, residual| idles(residual);
            coarse.renew(iteration, &self.iterate.fields.residual, touches, (stiffness, spring), range, held);
        } else {
            let rest = self.iterate.posed.law().hints().rest.unwrap_or_else(T::zero);
            let touches = |node, gap| gap <= rest && flat.faces(node);
            coarse.renew(iteration, &self.iterate.fields.gap, touches, (stiffness, spring), range, held);
        }
    }
}
