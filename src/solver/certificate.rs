//! How far the state is from the solution, and whether the solve has to end.

use super::report::Status;
use super::state::{Goal, State};
use super::{Criterion, Method};
use crate::error::Result;
use crate::field::{Partial, write};
use crate::problem::Control;
use crate::real::Real;

/// How well the smoothed law is solved, for the start: the edge of the adhesive zone has to be right to a node.
const START: f64 = 1e-4;

/// Iterations without progress after which the direction is dropped, and after which the solve has stalled.
const STALL: (usize, usize) = (10, 30);

/// The same where the error is no more than so many times that of rounding.
const STALL_AT_FLOOR: (usize, usize) = (3, 6);
const NEAR_FLOOR: f64 = 2.0;

/// The same for [`Method::Rey2017`], whose energy and residual need not fall.
const STALL_REY2017: (usize, usize) = (400, 800);

impl<T: Real> State<'_, T> {
    /// The mean of u·p, twice the elastic energy.
    pub(super) fn mean_work(&self) -> f64 {
        (self.work / self.nodes()).max(0.0)
    }

    pub(super) fn relative_error(&self) -> f64 {
        if self.certificate == 0.0 {
            return 0.0;
        }
        let (scale, rounding) = self.error_scale();
        let error = (self.certificate.max(rounding) / scale).sqrt();
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// What a certificate is related to, the mean of u·p; and the least certificate that rounding leaves of any worth.
    ///
    /// The pressure is the sum of K⁻¹h and K⁻¹g, each rounded in the precision of the fields, and carries that rounding
    /// where these nearly cancel each other. In the energy norm that is about ε²(⟨h, K⁻¹h⟩ + ½kḡ(ḡ + h_rms)), with k the
    /// stiffness of the shortest wave, as a transform spreads the rounding of a gap evenly over all waves.
    fn error_scale(&self) -> (f64, f64) {
        let epsilon = T::epsilon().widen();
        // u·p is the small difference of large sums for light loads: what may be their rounding does not count
        let rounding = 8.0 * (epsilon / self.nodes().sqrt() + f64::EPSILON) * self.flat.work;
        let touching = (self.mean_work() - rounding).max(0.0);
        let apart = if self.tally.contact > 0.0 { 0.0 } else { self.flat.work };
        // flats that attract each other have no waves but those of rounding
        let traction = self.tally.traction / self.nodes();
        let (softest, stiffest) = self.operator.stiffness_range();
        // and so have flats that are held apart
        let lifted = if self.tally.contact > 0.0 { 0.0 } else { self.tally.sum_gap / self.nodes() };
        let flat =
            if softest > 0.0 { epsilon * (traction * traction / softest + softest * lifted * lifted) } else { 0.0 };
        let waves = touching.max(apart);
        let mean = (self.tally.sum_gap / self.nodes()).abs();
        let carried = self.flat.work + 0.5 * stiffest * mean * (mean + self.flat.rms_height);
        (waves.max(flat), if waves >= flat { epsilon * epsilon * carried } else { 0.0 })
    }

    /// Whether rounding is all that is left of the residual: further iterations would only shuffle it.
    pub(super) fn is_at_floor(&self) -> bool {
        let (scale, rounding) = self.error_scale();
        let floor = (rounding / scale).sqrt();
        self.certificate <= NEAR_FLOOR * NEAR_FLOOR * rounding && self.load_error() <= NEAR_FLOOR * floor
    }

    pub(super) fn load_error(&self) -> f64 {
        let Control::MeanPressure(pressure) = self.control else { return 0.0 };
        let residual = match self.tally.free {
            // contact everywhere: in balance, unless it is under tension somewhere
            0.0 => (-self.tally.min_r).max(0.0),
            free => (self.tally.sum_r / free).abs(),
        };
        let contact = pressure + self.tally.traction / self.nodes();
        // the pressure that presses the surface flat, as far as loads matter beside it
        let floor = 1e-6 * (self.flat.work * self.operator.stiffness_range().0).sqrt();
        let scale = pressure.abs().max(contact.abs()).max(floor);
        if residual == 0.0 { 0.0 } else { residual / scale }
    }

    pub(super) fn scaled_orthogonality(&self) -> f64 {
        let (lx, ly) = self.operator.grid().lengths();
        self.residual.orthogonality / (self.operator.modulus() * (lx * ly).sqrt())
    }

    pub(super) fn converged(&self) -> bool {
        if self.goal == Goal::Start {
            let tolerance = self.settings.tolerance.max(START);
            return self.relative_error() <= tolerance && self.load_error() <= tolerance;
        }
        let criterion = match self.settings.criterion {
            Criterion::EnergyNorm => self.relative_error(),
            Criterion::Orthogonality if self.residual.working > self.tally.free => f64::INFINITY,
            Criterion::Orthogonality => self.scaled_orthogonality(),
        };
        criterion <= self.settings.tolerance && self.load_error() <= self.settings.tolerance
    }

    /// Whether the state is converged with the pressure of its own gap, computed anew if it was only updated.
    pub(super) fn confirm(&mut self) -> Result<bool> {
        // a start needs no proof
        if self.age == 0 || self.goal == Goal::Start {
            return Ok(true);
        }
        let before = self.certificate;
        // K's largest value bounds what the difference of the two residuals can add to the certificate
        self.momentum = None;
        self.refresh()?;
        self.residual();
        let softest = self.operator.stiffness_range().0;
        let change = self.residual.difference;
        let difference = if change == 0.0 { 0.0 } else { change / self.nodes() / softest };
        self.certificate = (before.sqrt() + difference.sqrt()).powi(2);
        if self.converged() {
            return Ok(true);
        }
        self.certify()?;
        Ok(self.converged())
    }

    /// The energy that is minimised, per area.
    pub(super) fn energy(&self) -> f64 {
        let load = self.detached.unwrap_or(self.offset());
        0.5 * self.mean_work() + (self.tally.adhesive + self.tally.penalty + load * self.tally.sum_gap) / self.nodes()
    }

    /// What rounding of the fields can do to the energy, per area.
    pub(super) fn energy_noise(&self) -> f64 {
        let local = self.tally.adhesive.abs() + self.tally.penalty.abs() + (self.offset() * self.tally.sum_gap).abs();
        2.0 * T::epsilon().widen() * (0.5 * self.mean_work() + local / self.nodes())
    }

    /// Whether the solve has to end without having converged.
    pub(super) fn verdict(&mut self) -> Option<Status> {
        if self.iterations >= self.settings.max_iterations {
            return Some(Status::IterationLimit);
        }
        let energy = self.energy();
        let error = match self.settings.method {
            Method::Preconditioned => self.relative_error().max(self.load_error()),
            Method::Rey2017 => self.scaled_orthogonality(),
        };
        if !energy.is_finite() {
            return Some(Status::Stalled);
        }
        if error < 0.95 * self.progress.best_error || energy < self.progress.lowest_energy - self.energy_noise() {
            self.progress.idle = 0;
        } else {
            self.progress.idle += 1;
        }
        self.progress.best_error = self.progress.best_error.min(error);
        self.progress.lowest_energy = self.progress.lowest_energy.min(energy);
        let (restart, stall) = match self.settings.method {
            Method::Preconditioned if self.is_at_floor() => STALL_AT_FLOOR,
            Method::Preconditioned => STALL,
            Method::Rey2017 => STALL_REY2017,
        };
        if self.progress.idle == restart {
            (self.momentum, self.residual_norm) = (None, None);
        }
        (self.progress.idle >= stall).then_some(Status::Stalled)
    }

    /// Computes the pressure anew, once, where a solve would stall with one that it has only updated for long: what that has
    /// gathered of rounding may be most of what is left; `false` if it has not.
    pub(super) fn renew(&mut self) -> Result<bool> {
        let due =
            self.age > STALL_AT_FLOOR.1 && !self.progress.renewed && self.settings.method == Method::Preconditioned;
        if due {
            self.refresh()?;
            self.restart();
            self.progress.renewed = true;
        }
        Ok(due)
    }

    /// Whether a tensile load has pulled the surfaces apart: no contact, and hardly any traction left to hold them.
    pub(super) fn is_adrift(&self) -> bool {
        let Control::MeanPressure(pressure) = self.control else { return false };
        let held = self.tally.traction / self.nodes();
        pressure < 0.0 && self.tally.contact == 0.0 && held <= 1e-3 * -pressure
    }

    /// Holds surfaces that drift apart at a mean gap at which they do not reach each other, to let them come to rest.
    pub(super) fn hold_apart(&mut self) {
        let far = 2.0 * (self.flat.height_span + 10.0 * self.law.range().widen());
        let mean = self.tally.sum_gap / self.nodes();
        let target = mean.max(far);
        let lift = T::lit(target - mean);
        self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
            gap.iter_mut().for_each(|gap| *gap += lift);
            Partial::NONE
        });
        self.detached = Some(self.offset());
        self.control = Control::MeanGap(target);
        self.restart();
    }
}
