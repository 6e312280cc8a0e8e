//! The certificate: the distance of the state from the solution, and the tests that end a solve.

use super::minimisation::Goal;
use super::report::Status;
use super::state::State;
use super::{Criterion, Method};
use crate::constraint::Wall;
use crate::error::Result;
use crate::problem::Load;
use crate::real::Real;

/// The tolerance on the way to a start: the edge of the adhesive zone has to be right to a node.
const START: f64 = 1e-4;

/// The tolerance of the wall alone as a start: adhesion changes the gap by more.
const WALL: f64 = 1e-2;

/// The tolerance at which a state shows how much tension it holds.
const HOLD: f64 = 1e-3;

/// The share of the best error below which an error is progress.
const PROGRESS: f64 = 0.95;

/// Iterations without progress after which the direction is dropped, and after which the solve has stalled.
const STALL: (usize, usize) = (10, 30);

/// The same numbers at the floor: where the error is at most [`NEAR_FLOOR`] times that of rounding.
const STALL_AT_FLOOR: (usize, usize) = (3, 6);
const NEAR_FLOOR: f64 = 2.0;

/// The same numbers for [`Method::Rey2017`], whose energy and residual need not fall.
const STALL_REY2017: (usize, usize) = (400, 800);

/// The roundings that the length of a spring may have.
const SPRING_ROUNDINGS: f64 = 8.0;

impl<T: Real, L: Real> State<'_, T, L> {
    /// The certified relative error in the energy norm, √(certificate/⟨u, p⟩), and at least that of rounding.
    pub(super) fn relative_error(&self) -> f64 {
        let (scale, rounding) = self.error_scale();
        // where every node is in contact no gap is wrong
        let rounding = if self.certificate == 0.0 && self.residual.working == 0.0 { 0.0 } else { rounding };
        let square = self.certificate.max(rounding);
        let error = if square == 0.0 { 0.0 } else { (square / scale).sqrt() };
        if error.is_nan() { f64::INFINITY } else { error }
    }

    /// The scale of a certificate, the mean of u·p, and the rounding floor: the certificate of a gap with rounding as
    /// its only error.
    ///
    /// The pressure is the sum of K⁻¹h and K⁻¹g, each rounded in the precision of the fields, and carries that
    /// rounding where these nearly cancel each other. In the energy norm that is about ε²(⟨h, K⁻¹h⟩ + ½kḡ(ḡ + h_rms)),
    /// with k the stiffness of the shortest wave, as a transform spreads the rounding of a gap evenly over all waves.
    fn error_scale(&self) -> (f64, f64) {
        let epsilon = T::epsilon().widen();
        let apart = if self.tally.contact > 0.0 { 0.0 } else { self.flat.work };
        // flats that attract each other have no waves but those of rounding
        let traction = self.tally.traction / self.nodes();
        let (softest, stiffest) = self.operators.state().stiffness_range();
        // and so have flats that are held apart, by their mean gap or by the law itself, whose range their gaps are
        // then of
        let lifted = match self.constraint.wall() {
            Wall::None => self.mean_gap().abs().max(self.law.range().widen()),
            _ if self.tally.contact > 0.0 => 0.0,
            _ => self.mean_gap(),
        };
        let flat =
            if softest > 0.0 { epsilon * (traction * traction / softest + softest * lifted * lifted) } else { 0.0 };
        let waves = self.mean_work().max(apart);
        let mean = (self.tally.sum_gap / self.nodes()).abs();
        let carried = self.flat.work + 0.5 * stiffest * mean * (mean + self.flat.rms_height);
        (waves.max(flat), if waves >= flat { epsilon * epsilon * carried } else { 0.0 })
    }

    /// Whether the residual r' is at the rounding floor, where further iterations do not reduce it.
    pub(super) fn is_at_floor(&self) -> bool {
        let (scale, rounding) = self.error_scale();
        let floor = (rounding / scale).sqrt();
        self.certificate <= NEAR_FLOOR * NEAR_FLOOR * rounding && self.load_error() <= NEAR_FLOOR * floor
    }

    /// The error of the load under pressure control, relative to the load.
    ///
    /// Without contact every node is apart, and the mean of r is the part of the load that adhesion does not hold.
    pub(super) fn load_error(&self) -> f64 {
        match (self.load, self.tally.free) {
            (Load::Gap(_), _) => 0.0,
            // contact everywhere: in balance, unless it is under tension somewhere
            (_, 0.0) => self.share_of_load((-self.tally.min_r).max(0.0)),
            _ => self.share_of_load(self.imbalance()),
        }
    }

    /// A pressure as a share of the larger of |p̄| and the mean contact pressure.
    pub(super) fn share_of_load(&self, pressure: f64) -> f64 {
        let contact = self.given + self.tally.traction / self.nodes();
        // a spring that is relaxed carries nothing but the rounding of its length
        let lengths = self.mean_gap().abs() + self.load.rest().abs();
        let rounding = SPRING_ROUNDINGS * T::epsilon().widen() * self.load.stiffness() * lengths;
        if pressure.abs() <= rounding { 0.0 } else { pressure.abs() / self.given.abs().max(contact.abs()) }
    }

    pub(super) fn scaled_orthogonality(&self) -> f64 {
        let (lx, ly) = self.operators.state().grid().lengths();
        self.residual.orthogonality / (self.operators.state().modulus() * (lx * ly).sqrt())
    }

    /// Whether the goal is reached.
    pub(super) fn converged(&self) -> bool {
        self.meets(self.load_error())
    }

    /// Whether the goal is reached, given the relative error of the load.
    pub(super) fn meets(&self, load_error: f64) -> bool {
        let tolerance = self.settings.tolerance_in::<T>();
        if self.goal != Goal::Solution {
            let tolerance = tolerance.max(match self.goal {
                Goal::Wall => WALL,
                Goal::Hold => HOLD,
                Goal::Start | Goal::Solution => START,
            });
            return self.relative_error() <= tolerance && load_error <= tolerance;
        }
        let criterion = match self.settings.criterion {
            Criterion::EnergyNorm => self.relative_error(),
            Criterion::Orthogonality if self.residual.working > self.tally.free => f64::INFINITY,
            Criterion::Orthogonality => self.scaled_orthogonality(),
        };
        criterion <= tolerance && load_error <= tolerance
    }

    /// Whether the state is converged with p = K⁻¹(g + h) computed from its gap, where steps had only updated p.
    pub(super) fn confirm(&mut self) -> Result<bool> {
        // a start needs no proof
        if self.age == 0 || self.goal != Goal::Solution {
            return Ok(true);
        }
        let before = self.certificate;
        // the difference δ of the two residuals adds at most ⟨δ, δ⟩/(softest stiffness) to the certificate
        self.momentum = None;
        self.refresh()?;
        self.residual();
        let softest = self.operators.state().stiffness_range().0;
        let change = self.residual.difference;
        let difference = if change == 0.0 { 0.0 } else { change / self.nodes() / softest };
        self.certificate = (before.sqrt() + difference.sqrt()).powi(2);
        if !matches!(self.constraint.wall(), Wall::None) && self.converged() {
            return Ok(true);
        }
        self.certify()?;
        if self.converged() {
            return Ok(true);
        }
        // what the updated pressure claimed was no progress
        let error = self.relative_error();
        let progress = &mut self.progress;
        progress.best_error = progress.best_error.max(error);
        if error < PROGRESS * progress.least_refuted {
            (progress.least_refuted, progress.refuted) = (error, 0);
        } else {
            progress.refuted += 1;
        }
        Ok(false)
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
        if error < PROGRESS * self.progress.best_error || energy < self.progress.lowest_energy - self.energy_noise() {
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
        (self.progress.idle.max(self.progress.refuted) >= stall).then_some(Status::Stalled)
    }

    /// Computes the pressure from the gap, once, where a solve would stall after many updates of the pressure, whose
    /// rounding may then be most of the residual. Returns whether it has done so.
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
}
