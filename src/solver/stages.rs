//! The passage from stage to stage of a solve.

use super::coarse::Coarse;
use super::minimisation::{Nearness, Progress};
use super::passes::Fields;
use super::plan::{Stage, StageLaw};
use super::start::uniform_start;
use super::state::State;
use crate::adhesion::Values;
use crate::constraint::{Update, Wall};
use crate::error::{Error, Result};
use crate::field::{CHUNK, Field, read, write};
use crate::par::Parts;
use crate::problem::{Control, Load};
use crate::real::Real;

/// The first trial length near the solution: r' then has short waves at contact edges, too stiff for a whole step.
const NEAR: f64 = 0.5;

impl<T: Real, Lo: Real> State<'_, T, Lo> {
    pub(super) fn begins(&mut self, nearness: Nearness) {
        self.steps.nearness = nearness;
        if nearness == Nearness::Near {
            self.steps.step_length = NEAR;
        }
    }

    /// Continues with another stage, if it is another one.
    pub(super) fn enter(&mut self, stage: Stage) {
        if stage != self.posed.stage {
            self.posed.stage = stage;
            self.restart();
        }
    }

    /// Goes over from a stage to the problem itself.
    pub(super) fn leave(&mut self, stage: Stage) -> Result<()> {
        if stage.law == StageLaw::None {
            return self.leave_wall();
        }
        if stage.rigid {
            self.soften()?;
        }
        self.sharpen()
    }

    pub(super) fn check_start(&self) -> Result<()> {
        if self.energy().is_finite() && self.sums.tally.sum_r.is_finite() {
            return Ok(());
        }
        self.posed.operators.state().grid().slab().agreed(self.check_gaps())
    }

    fn check_gaps(&self) -> Result<()> {
        let law = self.posed.law();
        let mut value = [T::zero()];
        let first = self.posed.operators.state().grid().slab().first_node();
        let window = self.posed.flat.window.as_ref();
        let on_surface = |node| window.map_or(Some(node), |window| window.pieces(node..node + 1).next()?.1);
        for (node, gap) in (first..).zip(self.fields.gap.nodes()) {
            let Some(node) = on_surface(node) else { continue };
            let gap = gap.max(T::zero());
            for (order, function) in ["adhesive energy", "adhesive traction"].into_iter().enumerate() {
                law.evaluate(node, &[gap], Values::one(order, &mut value));
                if !value[0].is_finite() {
                    return Err(Error::not_finite(function, gap.widen(), value[0].widen()));
                }
            }
        }
        Ok(())
    }

    /// Continues with adhesion, under the load. A wall that stood for the repulsion of the law leaves the surfaces as
    /// far apart as the law's equilibrium separation, or a smaller mean gap that is held.
    fn leave_wall(&mut self) -> Result<()> {
        if let Some(separation) = self.posed.separation() {
            let lift = match self.posed.control {
                Control::MeanGap(held) => separation.min(T::lit(held)),
                _ => separation,
            };
            self.each_gap(|gap| gap + lift);
        }
        let load = self.posed.flat.load(self.posed.control, self.posed.constraint.wall())?;
        if self.posed.adhesion.hints().touches() {
            if matches!(load, Load::Pressure(_)) {
                self.close_up();
            }
            self.posed.touch(&self.fields.gap, None);
        }
        self.adhere(load, Stage::SOLUTION)
    }

    /// Continues with adhesion under a load, from a gap without it.
    pub(super) fn adhere(&mut self, load: Load, stage: Stage) -> Result<()> {
        (self.posed.load, self.posed.stage, self.steps.step_length) = (load, stage, 1.0);
        // the contacts before are not those that adhesion makes
        self.steps.coarse.iter_mut().for_each(Coarse::forget);
        self.restart();
        self.sums.certificate = f64::INFINITY;
        self.check_start()
    }

    /// Continues with springs from the state of a rigid wall: they take over its contact pressures, or yield to them.
    fn soften(&mut self) -> Result<()> {
        let (shift, below) = (T::lit(self.external_pressure() - self.sums.drift), self.posed.pressed());
        let local = self.posed.potential();
        let Fields { reducer, gap, pressure, .. } = &mut self.fields;
        let mut contact = Field::zeros(gap.dim());
        let fields = read(gap).zip(read(pressure)).zip(write(&mut contact));
        local.run(reducer, fields, |local, first, ((gap, pressure), contact)| {
            let mut borne = [T::zero(); CHUNK];
            borne.iter_mut().zip(pressure).for_each(|(borne, &p)| *borne = p + shift);
            local.contact_pressures(first, gap, &borne[..gap.len()], contact);
        });
        self.posed.stage = Stage::SOLUTION;
        let pressures = self.posed.on_surface(&contact, T::zero());
        if !self.posed.constraint.bear(pressures.view(), self.relative_error()) {
            let local = self.posed.potential();
            let Wall::Springs(springs) = self.posed.constraint.wall() else { return Ok(()) };
            let Fields { reducer, gap, .. } = &mut self.fields;
            local.run(reducer, write(gap).zip(read(&contact)), |_, first, (gap, contact)| {
                let nodes =
                    gap.iter_mut().zip(contact).zip(first..).filter(|((_, pressure), _)| **pressure > T::zero());
                for ((gap, &pressure), node) in nodes {
                    *gap = -(pressure + springs.traction(node, T::zero())) / springs.slope(node, below);
                }
            });
        }
        self.count();
        self.refresh()
    }

    /// Continues with the law itself after the smoothed one. A given start is on a branch, which ends where the
    /// smoothed law lets go.
    fn sharpen(&mut self) -> Result<()> {
        self.posed.stage = Stage::SOLUTION;
        if self.posed.branch.is_some() && self.is_adrift() {
            // the law itself may hold this tension
            let uniform = uniform_start(self.posed.adhesion, self.posed.flat, self.posed.load);
            self.fields.gap.nodes_mut().fill(T::lit(uniform));
            self.refresh()?;
        }
        self.restart();
        // this certificate was of the smoothed law
        self.sums.certificate = f64::INFINITY;
        Ok(())
    }

    pub(super) fn update_constraint(&mut self) -> Update {
        let whole = || self.posed.on_surface(&self.fields.gap, T::infinity());
        let gap = matches!(self.posed.constraint.wall(), Wall::Springs(_)).then(whole);
        let work = self.error_scale().energy * self.posed.nodes();
        let outer = gap.map_or(Update::Done, |gap| self.posed.constraint.update(gap.view(), work));
        // a constraint that is met where a round ended early has to be met by the solution
        self.posed.leads_on = outer != Update::Done || self.start_tolerance().is_none();
        if outer == Update::Again {
            self.restart();
        }
        if self.posed.leads_on { outer } else { Update::Again }
    }

    pub(super) fn restart(&mut self) {
        (self.steps.momentum, self.steps.norm) = (None, None);
        self.counters.progress = Progress::default();
        self.counters.rounds += 1;
        self.count();
    }
}
