//! The end of a solve: its solution, and the report on it.

use ndarray::Array2;

use super::passes::Fields;
use super::potential::Potential;
use super::report::{Report, Solution, Status};
use super::state::State;
use crate::error::Result;
use crate::field::{Partial, read, write};
use crate::par::IndexedParallelIterator;
use crate::problem::{Control, mu_rho};
use crate::real::Real;

impl<T: Real, L: Real> State<'_, T, L> {
    /// The solution: the final fields, and the report on them.
    pub(super) fn finish(mut self, status: Status) -> Result<Solution<T>> {
        if self.age > 0 {
            self.refresh()?;
            self.certificate = f64::INFINITY;
        }
        if self.certificate.is_infinite() {
            self.residual();
            self.certify()?;
        }
        self.trust_work(T::epsilon().widen().sqrt())?;
        let mean = match self.control {
            Control::MeanGap(_) => -self.multiplier(),
            Control::MeanPressure(pressure) => pressure,
        };
        let shift = T::lit(mean - self.drift);
        let Self { fields, law, constraint, .. } = &mut self;
        let Fields { reducer, gap, pressure, residual, preconditioned, change, .. } = fields;
        for correction in [residual, preconditioned, change] {
            *correction = Array2::zeros((0, 0));
        }
        let mut contact_pressure = Array2::zeros(gap.dim());
        let local = Potential::new(*law, &**constraint);
        let fields = read(gap).zip(write(pressure)).zip(write(&mut contact_pressure));
        let total = reducer.run(fields, |first, ((gap, pressure), contact)| {
            let mut part = Partial::NONE;
            pressure.iter_mut().for_each(|p| *p += shift);
            local.contact_pressures(first, gap, pressure, contact);
            for (&gap, contact) in gap.iter().zip(contact) {
                part.sum[0] += contact.widen();
                part.min = part.min.min(gap.widen());
            }
            part
        });
        let mean_contact_pressure = total.sum[0] / self.nodes();
        let carried_pressure = mean_contact_pressure - self.tally.traction / self.nodes();
        let load_error = match self.control {
            _ if self.detached.is_some() => 1.0,
            Control::MeanGap(_) => 0.0,
            Control::MeanPressure(_) => self.load_error().max(self.share_of_load(carried_pressure - mean)),
        };
        let mu_rho = mu_rho(self.law, self.operators.state().grid(), self.operators.state().modulus());
        let report = Report {
            status: self.final_status(status, load_error),
            relative_error: self.relative_error(),
            load_error,
            orthogonality: self.scaled_orthogonality(),
            iterations: self.iterations,
            operator_applications: self.applications,
            mean_gap: self.tally.sum_gap / self.nodes(),
            mean_pressure: self.detached.unwrap_or(mean),
            carried_pressure,
            mean_contact_pressure,
            contact_fraction: self.tally.contact / self.nodes(),
            contact_nodes: self.tally.contact as usize,
            min_gap: total.min,
            elastic_energy: 0.5 * self.mean_work(),
            adhesive_energy: self.tally.adhesive / self.nodes(),
            mu_rho,
            under_resolved: mu_rho > 0.5,
            precision: T::NAME,
            method: self.settings.method,
            criterion: self.settings.criterion,
            tolerance: self.settings.tolerance_in::<T>(),
        };
        let Fields { gap, pressure, .. } = self.fields;
        Ok(Solution { gap, pressure, contact_pressure, report })
    }

    /// The status, corrected by the figures of the returned fields.
    fn final_status(&self, status: Status, load_error: f64) -> Status {
        let good = self.meets(load_error);
        match status {
            Status::Stopped => status,
            _ if self.detached.is_some() => Status::Detached,
            Status::Converged if !good => Status::Stalled,
            // the last computation of the pressure may have reached the tolerance; rounds of a constraint end by its
            // own word
            Status::Stalled if good && self.projects() => Status::Converged,
            _ => status,
        }
    }
}
