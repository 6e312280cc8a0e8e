//! The energy of a state, the elastic work in it, and their rounding.

use super::Iterate;
use crate::degrees::{FAR, ROUNDINGS};
use crate::error::Result;
use crate::real::Real;
use crate::solver::Aim;
use crate::solver::passes::Fields;
use crate::solver::work::Work;

/// The residual, in units of the rounding of its updates, below which the pressure is computed anew.
const STALE: f64 = 200.0;

impl<T: Real, Lo: Real> Iterate<'_, T, Lo> {
    /// The mean of u·p, twice the elastic energy per area.
    pub(in crate::solver) fn mean_work(&self) -> f64 {
        (self.work.sum / self.posed.nodes()).max(0.0)
    }

    /// The rounding of a sum over the nodes, with `size` the sum of the magnitudes of its terms.
    fn sum_noise(&self, size: f64) -> f64 {
        ROUNDINGS * (T::epsilon().widen() / self.posed.nodes().sqrt() + f64::EPSILON) * size
    }

    /// The rounding of the corrections, beyond the rounding of the state.
    pub(in crate::solver) fn rounding_of_corrections(&self) -> f64 {
        Lo::epsilon().widen() - T::epsilon().widen()
    }

    /// The rounding of the work that a correction does, as a share of this work, beyond the rounding of the state.
    pub(in crate::solver) fn update_noise(&self) -> f64 {
        ROUNDINGS * self.rounding_of_corrections() / self.posed.nodes().sqrt()
    }

    /// Whether the rounding that corrections leave in the pressure is comparable to the residual. A transform spreads
    /// the rounding of a change c evenly over all waves: in the certificate's norm it is ε √(k⟨c, c⟩), with k the
    /// stiffness of the shortest.
    pub(in crate::solver) fn has_lost_its_pressure(&self, certificate: f64) -> bool {
        // the pressure of a trial ends with it
        let share = if self.posed.aim == Aim::Trial { FAR } else { STALE };
        let rounding = share * self.rounding_of_corrections();
        certificate < rounding * rounding * self.posed.stiffness_range().1 * self.updates
    }

    /// The work from the sums of a tally: Σ g·p and Σ g·K⁻¹h.
    pub(in crate::solver) fn summed_work(&self, sum_gp: f64, gap_surface: f64) -> Work {
        let surface = self.posed.nodes() * self.posed.flat.work;
        Work { sum: sum_gp + gap_surface + surface, noise: self.sum_noise(surface) }
    }

    /// Computes the work as ⟨p, K p⟩ if rounding may exceed `share` of it, over the corrections and the last step.
    pub(in crate::solver) fn trust_work(&mut self, share: f64) -> Result<()> {
        if !self.work.is_doubtful(share) {
            return Ok(());
        }
        self.momentum = None;
        let stiffness = self.foundation();
        let Fields { pressure, residual, preconditioned, change, .. } = &mut self.fields;
        let work = self.posed.operators.work(pressure, stiffness, [preconditioned, residual, change])?;
        self.applications += 1;
        if work.is_finite() {
            let sum = self.posed.nodes() * work.max(0.0);
            self.work = Work { sum, noise: self.sum_noise(sum) };
        }
        Ok(())
    }

    pub(in crate::solver) fn energy(&self) -> f64 {
        let (load, tally, nodes) = (self.posed.load, &self.tally, self.posed.nodes());
        let of_load = match self.posed.detached {
            Some(load) => load * tally.sum_gap,
            None => load.share() * self.given * (tally.sum_gap - nodes * load.rest()),
        };
        0.5 * self.mean_work() + (tally.adhesive + tally.penalty + of_load) / nodes
    }

    pub(in crate::solver) fn energy_noise(&self) -> f64 {
        let (tally, nodes) = (&self.tally, self.posed.nodes());
        let of_load = self.given.abs() * (tally.sum_gap.abs() + nodes * self.posed.load.rest().abs());
        let local = tally.adhesive.abs() + tally.penalty.abs() + of_load;
        2.0 * T::epsilon().widen() * (0.5 * self.mean_work() + local / nodes)
    }
}
