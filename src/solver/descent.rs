//! The descent to the least energy of a stage: its loop, its steps, and its end.

use super::Method;
use super::coarse::Coarse;
use super::driver::{Aim, Observer};
use super::iterate::Iterate;
use super::minimisation::{Nearness, Preconditioned};
use super::plan::StageLaw;
use super::posed::Posed;
use super::proof::Proof;
use super::report::{Iteration, Status};
use super::rescue::Rescue;
use super::start::Begin;
use super::touch::touches_more;
use crate::error::Result;
use crate::real::Real;

mod preconditioner;
mod progress;
pub(super) mod rey2017;
mod step;

use progress::{Progress, STALL, STALL_AT_FLOOR};

/// The first trial length near the solution: r' then has short waves at contact edges, too stiff for a whole step.
const NEAR: f64 = 0.5;

/// The end of a descent.
pub(super) enum End {
    Converged,
    /// A tensile load has pulled the surfaces apart.
    Adrift,
    /// Progress ceased.
    Stalled,
    /// The iterations ran out, or the observer stopped the solve.
    Cut(Status),
}

pub(super) struct Descent<'a, T: Real, Lo> {
    pub(super) iterate: Iterate<'a, T, Lo>,
    /// the mean of r'·K r'; infinite as long as it is not known
    certificate: f64,
    preconditioned: Preconditioned,
    step_length: f64,
    /// the contacts in the preconditioner
    coarse: Option<Coarse>,
    /// Σ r'² of the step before, if the next one of Algorithm 3 may be conjugate to it
    norm: Option<f64>,
    iterations: usize,
    /// how often the function to be minimised has changed
    rounds: usize,
    progress: Progress,
}

impl<'a, T: Real, Lo: Real> Descent<'a, T, Lo> {
    pub(super) fn new(posed: Posed<'a, T, Lo>, begin: Begin<'_, T>, touches: bool) -> Result<Self> {
        let nearness = begin.nearness();
        let iterate = Iterate::new(posed, begin, touches)?;
        let mut descent = Self {
            coarse: Coarse::of(iterate.posed.operators.corrections()),
            iterate,
            certificate: f64::INFINITY,
            preconditioned: Preconditioned::default(),
            step_length: 1.0,
            norm: None,
            iterations: 0,
            rounds: 0,
            progress: Progress::default(),
        };
        descent.begin(nearness);
        Ok(descent)
    }

    pub(super) fn begin(&mut self, nearness: Nearness) {
        self.iterate.posed.nearness = nearness;
        if nearness == Nearness::Near {
            self.step_length = NEAR;
        }
    }

    pub(super) fn proof(&self) -> Proof<'_, 'a, T, Lo> {
        Proof::of(&self.iterate, self.certificate)
    }

    pub(super) fn iterations(&self) -> usize {
        self.iterations
    }

    /// Minimises the energy of the present stage by the method of the settings.
    pub(super) fn minimise(&mut self, observe: Observer<'_>) -> Result<End> {
        match self.iterate.posed.settings.method {
            Method::Preconditioned => self.descend(observe),
            Method::Rey2017 => rey2017::descend(self, observe),
        }
    }

    fn descend(&mut self, observe: Observer<'_>) -> Result<End> {
        self.iterate.residual();
        loop {
            self.certify()?;
            if let Some(end) = self.check_end(observe)? {
                return Ok(end);
            }
            self.note_progress();
            let contact = self.iterate.tally().contact;
            let end = match self.verdict(self.patience().1) {
                None if self.proof().is_adrift() => Some(End::Adrift),
                None if !self.step()? => Some(End::Stalled),
                end => end,
            };
            let Some(end) = end else {
                self.follow_contacts(contact);
                continue;
            };
            let Some(rescue) = Rescue::of_stall(self, &end) else { return Ok(end) };
            rescue.apply(self, &mut *observe)?;
        }
    }

    /// Confirms convergence, and tells the observer of the iteration; the end, if it is one.
    fn check_end(&mut self, observe: Observer<'_>) -> Result<Option<End>> {
        if self.proof().converged() {
            self.confirm()?;
        }
        let converged = self.proof().converged();
        if observe(&self.iteration()).is_break() {
            return Ok(Some(End::Cut(Status::Stopped)));
        }
        Ok((converged && !self.spreads_on()?).then_some(End::Converged))
    }

    /// Goes on where a state is good enough to tell whether surfaces touch at further nodes: with these nodes, or to the
    /// tolerance itself. Whether there is more to do.
    fn spreads_on(&mut self) -> Result<bool> {
        if !self.iterate.posed.spreads {
            return Ok(false);
        }
        if touches_more(self) {
            self.iterate.residual();
            self.certify()?;
            return Ok(true);
        }
        self.iterate.posed.spreads = false;
        self.restart();
        if self.proof().converged() {
            self.confirm()?;
        }
        Ok(!self.proof().converged())
    }

    /// Computes p = K⁻¹(g + h) anew, and the certificate of its residual: a solve ends only if that meets the
    /// tolerance. A start and a trial need no such proof.
    fn confirm(&mut self) -> Result<()> {
        let is_exempt = self.iterate.posed.aim == Aim::Trial || self.proof().start_tolerance().is_some();
        if self.iterate.age() == 0 || is_exempt {
            return Ok(());
        }
        let before = self.certificate;
        // the difference δ of the two residuals adds at most ⟨δ, δ⟩/(softest stiffness) to the certificate
        self.iterate.refresh()?;
        self.iterate.residual();
        let softest = self.iterate.posed.stiffness_range().0;
        let change = self.iterate.sums_of_residual().difference;
        let difference = if change == 0.0 { 0.0 } else { change / self.iterate.posed.nodes() / softest };
        self.certificate = (before.sqrt() + difference.sqrt()).powi(2);
        if !self.iterate.posed.has_no_wall() && self.proof().converged() {
            return Ok(());
        }
        self.certify()?;
        if !self.proof().converged() {
            self.progress.refute(self.proof().relative_error());
        }
        Ok(())
    }

    /// Notes whether the last iteration has made progress, and drops the last step after several without.
    fn note_progress(&mut self) {
        let proof = self.proof();
        self.note_error(proof.relative_error().max(proof.load_error()));
        if self.progress.idle() == self.patience().0 {
            self.iterate.take_momentum();
        }
    }

    fn note_error(&mut self, error: f64) {
        self.progress.note(error, self.iterate.energy(), self.iterate.energy_noise());
    }

    /// The iterations without progress until the direction is dropped, and until the solve has stalled.
    fn patience(&self) -> (usize, usize) {
        if self.proof().is_at_floor() { STALL_AT_FLOOR } else { STALL }
    }

    /// The end, if the iterations ran out or so many made no progress that the solve has stalled.
    fn verdict(&self, patience: usize) -> Option<End> {
        if self.iterations >= self.iterate.posed.settings.max_iterations {
            return Some(End::Cut(Status::IterationLimit));
        }
        (!self.iterate.energy().is_finite() || self.progress.lacks(patience)).then_some(End::Stalled)
    }

    /// Whether the solve has iterations left after an end.
    pub(super) fn goes_on(&self, end: &End) -> bool {
        !matches!(end, End::Cut(_)) && self.iterations < self.iterate.posed.settings.max_iterations
    }

    /// Whether a solve that would stall may renew its pressure, once: many updates may leave mostly rounding.
    pub(super) fn may_renew(&self) -> bool {
        self.iterate.age() > STALL_AT_FLOOR.1 && !self.progress.renewed()
    }

    pub(super) fn renew(&mut self) -> Result<()> {
        self.iterate.refresh()?;
        self.restart();
        self.progress.renew();
        self.iterate.residual();
        Ok(())
    }

    /// A step; `false` if none is possible.
    fn step(&mut self) -> Result<bool> {
        let Some(next) = self.preconditioned_step()? else { return Ok(false) };
        self.iterations += 1;
        self.iterate.follow(next, self.certificate)?;
        Ok(true)
    }

    /// Follows contacts that have spread in a step.
    fn follow_contacts(&mut self, before: f64) {
        if self.iterate.tally().contact != before && self.iterate.take_in(false) {
            self.progress = Progress::default();
            self.iterate.count();
            self.iterate.compute_residual();
        }
    }

    fn iteration(&self) -> Iteration {
        Iteration {
            iteration: self.iterations,
            operator_applications: self.iterate.applications(),
            relative_error: self.proof().relative_error(),
            load_error: self.proof().load_error(),
            energy: self.iterate.energy(),
            mean_gap: self.iterate.mean_gap(),
            contact_nodes: self.iterate.tally().contact as usize,
            round: self.rounds,
            smoothed: self.iterate.posed.stage.law == StageLaw::Smoothed,
            control: self.iterate.posed.control,
        }
    }

    pub(super) fn restart(&mut self) {
        self.iterate.take_momentum();
        self.norm = None;
        self.progress = Progress::default();
        self.rounds += 1;
        self.iterate.count();
    }

    /// Continues from another gap, or with another energy, from its pressure on.
    pub(super) fn forget_certificate(&mut self) {
        self.certificate = f64::INFINITY;
    }

    /// Forgets contacts that are not those of the next stage.
    pub(super) fn forget_contacts(&mut self) {
        self.step_length = 1.0;
        self.coarse.iter_mut().for_each(Coarse::forget);
    }

    /// The certificate and the work of the fields as they are.
    pub(super) fn certify_as_returned(&mut self) -> Result<()> {
        if self.iterate.age() > 0 {
            self.iterate.refresh()?;
            self.certificate = f64::INFINITY;
        }
        if self.certificate.is_infinite() {
            self.iterate.residual();
            self.certify()?;
        }
        self.iterate.trust_work(T::epsilon().widen().sqrt())
    }
}
