//! The beginnings of the phases of a solve, each with an energy and a goal.

use super::coarse::Coarse;
use super::minimisation::{Goal, Left, Nearness, Progress};
use super::start::uniform_start;
use super::state::State;
use crate::adhesion::{AdhesionLaw, Values};
use crate::constraint::{ContactConstraint, Update, Wall};
use crate::error::{Error, Result};
use crate::field::flat;
use crate::problem::{Control, Load};
use crate::real::Real;

/// The first trial length near the solution: r' then has short waves at contact edges, too stiff for a whole step.
const NEAR: f64 = 0.5;

impl<'a, T: Real, Lo: Real> State<'a, T, Lo> {
    pub(super) fn begins(&mut self, nearness: Nearness) {
        self.steps.nearness = nearness;
        if nearness == Nearness::Near {
            self.steps.step_length = NEAR;
        }
    }

    pub(super) fn check_start(&self) -> Result<()> {
        if self.energy().is_finite() && self.sums.tally.sum_r.is_finite() {
            return Ok(());
        }
        self.posed.operators.state().grid().slab().agreed(self.check_gaps())
    }

    fn check_gaps(&self) -> Result<()> {
        let law = self.posed.law;
        let mut value = [T::zero()];
        let first = self.posed.operators.state().grid().slab().first_node();
        for (node, gap) in (first..).zip(flat(&self.fields.gap)) {
            let node = match &self.posed.flat.window {
                None => node,
                Some(window) => match window.pieces(node..node + 1).next() {
                    Some((_, Some(node))) => node,
                    _ => continue,
                },
            };
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

    /// Puts the constraint of a law that repels in the place of its wall, moved by the law's equilibrium separation, or
    /// by a smaller mean gap that is held.
    pub(super) fn stand_on(&mut self, constraint: &'a mut dyn ContactConstraint<T>, separation: T) -> Result<()> {
        self.posed.constraint = constraint;
        self.posed.prepare()?;
        let lift = match self.posed.asked.0 {
            Control::MeanGap(held) => separation.min(T::lit(held)),
            _ => separation,
        };
        self.fields.gap.mapv_inplace(|gap| gap + lift);
        Ok(())
    }

    /// Goes on with adhesion, under the load, from a gap without it.
    pub(super) fn adhere(&mut self, law: &'a dyn AdhesionLaw<T>, load: Load) -> Result<()> {
        (self.posed.load, self.steps.step_length) = (load, 1.0);
        // the contacts before are not those that adhesion makes
        self.steps.coarse.iter_mut().for_each(Coarse::forget);
        self.change_law(law, Goal::Solution);
        self.sums.certificate = f64::INFINITY;
        self.check_start()
    }

    pub(super) fn change_law(&mut self, law: &'a dyn AdhesionLaw<T>, goal: Goal) {
        (self.posed.law, self.posed.goal) = (law, goal);
        self.restart();
    }

    /// Goes on with the law itself after the smoothed one. A given start is on a branch, which ends where the smoothed
    /// law lets go.
    pub(super) fn sharpen(&mut self, law: &'a dyn AdhesionLaw<T>, on_any_branch: bool) -> Result<()> {
        self.posed.law = law;
        if on_any_branch && self.is_adrift() {
            // the law itself may hold this tension
            self.fields.gap.fill(T::lit(uniform_start(law, self.posed.flat, self.posed.load)));
            self.refresh(Left::Nothing)?;
        }
        self.change_law(law, Goal::Solution);
        // this certificate was of the smoothed law
        self.sums.certificate = f64::INFINITY;
        Ok(())
    }

    pub(super) fn update_constraint(&mut self) -> Update {
        // no gap where no surface faces the half-space
        let whole = || match &self.posed.flat.window {
            Some(window) => window.held().whole_of(window.cut(&self.fields.gap, T::infinity())),
            None => self.posed.operators.state().grid().whole(&self.fields.gap),
        };
        let gap = matches!(self.posed.constraint.wall(), Wall::Springs(_)).then(whole);
        let work = self.error_scale().0 * self.posed.nodes();
        let outer = gap.map_or(Update::Done, |gap| self.posed.constraint.update(gap.view(), work));
        // a constraint that is met where a round ended early has to be met by the solution
        self.posed.leads_on = outer != Update::Done || self.start_tolerance().is_none();
        if outer == Update::Again {
            self.restart();
        }
        if self.posed.leads_on { outer } else { Update::Again }
    }

    pub(super) fn restart(&mut self) {
        (self.steps.momentum, self.steps.residual_norm) = (None, None);
        self.counters.progress = Progress::default();
        self.counters.rounds += 1;
        self.count();
    }
}
