//! The certificate: the distance of the state from the solution, and the tests that end a solve.

use super::driver::{End, Observer};
use super::report::Status;
use super::scale::Scale;
use super::state::{SCALED, State};
use super::touch::TOUCHING;
use crate::error::Result;
use crate::problem::Load;
use crate::real::Real;

/// The share of the best error below which an error is progress.
const PROGRESS: f64 = 0.95;

/// Iterations without progress until the direction is dropped, and until the solve has stalled.
const STALL: (usize, usize) = (10, 30);

/// The same numbers at the floor: where the error is at most [`NEAR_FLOOR`] times the error by rounding.
const STALL_AT_FLOOR: (usize, usize) = (3, 6);
pub(super) const NEAR_FLOOR: f64 = 2.0;

/// The roundings of a spring's length, and of K⁻¹h under no load, that count as no load, in units of ε.
const NO_LOAD: f64 = 8.0;

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    /// The certified relative error in the energy norm, √(certificate/⟨u, p⟩), and at least the error by rounding.
    pub(super) fn relative_error(&self) -> f64 {
        let scale = self.error_scale();
        // where every node is in contact no gap is wrong
        let exact = self.sums.certificate == 0.0 && self.sums.residual.working == 0.0;
        scale.error_of(if exact { 0.0 } else { self.sums.certificate.max(scale.rounding) })
    }

    /// The mean traction that has the energy of adhesion over its range; zero without adhesion.
    pub(super) fn attraction(&self) -> f64 {
        let range = self.posed.law().hints().range.widen();
        let stored = -self.sums.tally.adhesive / self.posed.nodes();
        if stored > 0.0 && range > 0.0 { stored / range } else { 0.0 }
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.posed.settings.tolerance_in::<T>()
    }

    pub(super) fn is_at_floor(&self) -> bool {
        let Scale { energy, rounding } = self.error_scale();
        let floor = (rounding / energy).sqrt();
        self.sums.certificate <= NEAR_FLOOR * NEAR_FLOOR * rounding && self.load_error() <= NEAR_FLOOR * floor
    }

    /// The error of the load. Without contact the mean of r is the load that adhesion lacks.
    pub(super) fn load_error(&self) -> f64 {
        match (self.posed.load, self.sums.tally.free) {
            (Load::Gap(gap), _) => self.gap_error(gap),
            // contact everywhere: in balance, unless it is under tension somewhere
            (_, 0.0) => self.share_of_load((-self.sums.tally.min_r.0).max(0.0)),
            _ => self.share_of_load(self.imbalance()),
        }
    }

    /// The distance of the mean gap from a held mean gap, beyond rounding, as a share of the held gap; where the law
    /// alone keeps the surfaces apart, and mean gaps may be nearly zero, as a share of the range.
    fn gap_error(&self, held: f64) -> f64 {
        let off = (self.mean_gap() - held).abs();
        let rounding = SCALED * T::epsilon().widen() * (held.abs() + self.posed.flat.rms_height);
        let range = if self.posed.has_no_wall() { self.posed.law().hints().range.widen() } else { 0.0 };
        if off <= rounding { 0.0 } else { off / held.abs().max(range) }
    }

    /// A pressure as a share of the larger of |p̄| and the mean contact pressure.
    pub(super) fn share_of_load(&self, pressure: f64) -> f64 {
        let contact = self.sums.given + self.mean_traction();
        // a relaxed spring carries only the rounding of its length, and surfaces apart under no load the rounding of
        // K⁻¹h
        let lengths = self.mean_gap().abs() + self.posed.load.rest().abs();
        let unloaded = self.sums.given == 0.0 && self.sums.tally.contact == 0.0;
        let of_surface = if unloaded { self.posed.flat.rms_pressure() } else { 0.0 };
        let rounding = NO_LOAD * T::epsilon().widen() * (self.posed.load.stiffness() * lengths + of_surface);
        // flats at rest have neither load nor traction
        let adhesion = if self.sums.given == 0.0 { self.attraction() } else { 0.0 };
        let scale = self.sums.given.abs().max(contact.abs()).max(adhesion);
        if pressure.abs() <= rounding { 0.0 } else { pressure.abs() / scale }
    }

    fn converged(&self) -> bool {
        self.meets(self.load_error())
    }

    /// Whether the goal is reached, given the relative error of the load.
    pub(super) fn meets(&self, load_error: f64) -> bool {
        if let Some(tolerance) = self.start_tolerance() {
            return self.relative_error() <= tolerance && load_error <= tolerance;
        }
        let tolerance = self.tolerance();
        self.measure() <= tolerance && load_error <= tolerance
    }

    /// The tolerance of a state from which a minimisation of another energy continues; none of the solution.
    pub(super) fn start_tolerance(&self) -> Option<f64> {
        let tolerance = self.tolerance();
        match self.posed.stage.tolerance {
            Some(start) => Some(start.max(tolerance)),
            None if self.posed.spreads => Some(TOUCHING.max(tolerance)),
            None if self.posed.leads_on => {
                Some(self.posed.constraint.round_tolerance()).filter(|&round| round > tolerance)
            }
            None => None,
        }
    }

    /// Confirms convergence, and tells the observer of the iteration; the end, if it is one.
    pub(super) fn check_end(&mut self, observe: Observer<'_>) -> Result<Option<End>> {
        if self.converged() {
            self.confirm()?;
        }
        let converged = self.converged();
        if observe(&self.iteration()).is_break() {
            return Ok(Some(End::Cut(Status::Stopped)));
        }
        Ok(converged.then_some(End::Converged))
    }

    /// Computes p = K⁻¹(g + h) anew, and the certificate of its residual: a solve ends only if that meets the
    /// tolerance. A start needs no such proof.
    fn confirm(&mut self) -> Result<()> {
        if self.steps.age == 0 || self.start_tolerance().is_some() {
            return Ok(());
        }
        let before = self.sums.certificate;
        // the difference δ of the two residuals adds at most ⟨δ, δ⟩/(softest stiffness) to the certificate
        self.refresh()?;
        self.residual();
        let softest = self.posed.stiffness_range().0;
        let change = self.sums.residual.difference;
        let difference = if change == 0.0 { 0.0 } else { change / self.posed.nodes() / softest };
        self.sums.certificate = (before.sqrt() + difference.sqrt()).powi(2);
        if !self.posed.has_no_wall() && self.converged() {
            return Ok(());
        }
        self.certify()?;
        if !self.converged() {
            self.note_refutation();
        }
        Ok(())
    }

    fn note_refutation(&mut self) {
        let error = self.relative_error();
        let progress = &mut self.counters.progress;
        progress.best_error = progress.best_error.max(error);
        if error < PROGRESS * progress.least_refuted {
            (progress.least_refuted, progress.refuted) = (error, 0);
        } else {
            progress.refuted += 1;
        }
    }

    /// Notes whether the last iteration has made progress, and drops the last step after several without.
    pub(super) fn note_progress(&mut self) {
        self.note_error(self.relative_error().max(self.load_error()));
        if self.counters.progress.idle == self.patience().0 {
            self.steps.momentum = None;
        }
    }

    /// Notes an error, and whether it or the energy is progress.
    pub(super) fn note_error(&mut self, error: f64) {
        let (energy, noise) = (self.energy(), self.energy_noise());
        let progress = &mut self.counters.progress;
        let better = error < PROGRESS * progress.best_error || energy < progress.lowest_energy - noise;
        progress.idle = if better { 0 } else { progress.idle + 1 };
        progress.best_error = progress.best_error.min(error);
        progress.lowest_energy = progress.lowest_energy.min(energy);
    }

    /// The iterations of [`STALL`] or [`STALL_AT_FLOOR`].
    pub(super) fn patience(&self) -> (usize, usize) {
        if self.is_at_floor() { STALL_AT_FLOOR } else { STALL }
    }

    /// The end, if the iterations ran out or so many made no progress that the solve has stalled.
    pub(super) fn verdict(&self, patience: usize) -> Option<End> {
        if self.counters.iterations >= self.posed.settings.max_iterations {
            return Some(End::Cut(Status::IterationLimit));
        }
        let idle = self.counters.progress.idle.max(self.counters.progress.refuted);
        (!self.energy().is_finite() || idle >= patience).then_some(End::Stalled)
    }

    /// Whether a solve that would stall may renew its pressure, once: many updates may leave mostly rounding.
    pub(super) fn may_renew(&self) -> bool {
        self.steps.age > STALL_AT_FLOOR.1 && !self.counters.progress.renewed
    }

    pub(super) fn renew(&mut self) -> Result<()> {
        self.refresh()?;
        self.restart();
        self.counters.progress.renewed = true;
        self.residual();
        Ok(())
    }
}
