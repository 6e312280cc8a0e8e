//! The phases of a solve, each with an energy and a goal of its own: their beginnings.

use super::coarse::Coarse;
use super::minimisation::{Goal, Progress};
use super::start::uniform_start;
use super::state::{State, prepare};
use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Update};
use crate::error::{Error, Result};
use crate::field::flat;
use crate::problem::Load;
use crate::real::Real;

/// The first trial length from a start near the solution. The residual r' then has short waves at the edges of
/// contacts, for which a whole step is too long.
const NEAR: f64 = 0.5;

impl<'a, T: Real, L: Real> State<'a, T, L> {
    /// Treats the start as near the solution.
    pub(super) fn stays_near(&mut self) {
        (self.near, self.step_length) = (true, NEAR);
    }

    /// Refuses a law that is not finite at the gaps of the start.
    pub(super) fn check_start(&self) -> Result<()> {
        if self.energy().is_finite() && self.tally.sum_r.is_finite() {
            return Ok(());
        }
        Error::agreed(self.operators.state().grid().slab(), self.check_gaps())
    }

    fn check_gaps(&self) -> Result<()> {
        let law = self.law;
        let mut value = [T::zero()];
        let first = self.operators.state().grid().slab().first_node();
        for (node, gap) in (first..).zip(flat(&self.fields.gap)) {
            let node = match &self.flat.window {
                None => node,
                Some(window) => match window.pieces(node..node + 1).next() {
                    Some((_, Some(node))) => node,
                    _ => continue,
                },
            };
            let gap = gap.max(T::zero());
            for function in ["adhesive energy", "adhesive traction"] {
                match function {
                    "adhesive energy" => law.energies(node, &[gap], &mut value),
                    _ => law.tractions(node, &[gap], &mut value),
                }
                if !value[0].is_finite() {
                    return Err(Error::Law { function, gap: gap.widen(), value: value[0].widen(), expected: None });
                }
            }
        }
        Ok(())
    }

    /// Goes on from the gap that the wall alone leaves with adhesion, under the load itself; with the constraint that
    /// is no wall, if there is one, from as much above its equilibrium separation.
    pub(super) fn adhere(
        &mut self,
        law: &'a dyn AdhesionLaw<T>,
        load: Load,
        repelled: Option<(&'a mut dyn ContactConstraint<T>, f64)>,
    ) -> Result<()> {
        (self.law, self.load, self.step_length) = (law, load, 1.0);
        if let Some((constraint, separation)) = repelled {
            prepare(constraint, &*self.operators, self.flat, self.settings)?;
            self.constraint = constraint;
            let lift = T::lit(separation);
            self.fields.gap.mapv_inplace(|gap| gap + lift);
        }
        // the contacts of the wall alone are not those that adhesion makes
        self.coarse.iter_mut().for_each(Coarse::forget);
        self.change_law(law, Goal::Solution);
        self.certificate = f64::INFINITY;
        self.check_start()
    }

    /// Goes on with another law, whose equilibrium is the goal.
    pub(super) fn change_law(&mut self, law: &'a dyn AdhesionLaw<T>, goal: Goal) {
        (self.law, self.goal) = (law, goal);
        self.restart();
    }

    /// Goes on with the law itself from an equilibrium of the smoothed one.
    pub(super) fn sharpen(&mut self, law: &'a dyn AdhesionLaw<T>) -> Result<()> {
        self.law = law;
        if self.is_adrift() {
            // the law itself may hold a tension that the smoothed one does not
            self.fields.gap.fill(T::lit(uniform_start(law, self.flat, self.load)));
            self.refresh()?;
        }
        self.change_law(law, Goal::Solution);
        // this certificate was of the smoothed law
        self.certificate = f64::INFINITY;
        Ok(())
    }

    pub(super) fn update_constraint(&mut self) -> Update {
        // nothing is where no surface faces the half-space
        let gap = self.flat.window.as_ref().map(|window| window.cut(&self.fields.gap, T::infinity()));
        let outer = self.constraint.update(gap.as_ref().unwrap_or(&self.fields.gap).view());
        if outer == Update::Again {
            self.restart();
        }
        outer
    }

    /// Drops momentum, progress and certificate after a change of the energy or of the gap.
    pub(super) fn restart(&mut self) {
        (self.momentum, self.residual_norm) = (None, None);
        self.progress = Progress::NONE;
        self.rounds += 1;
        self.count();
    }
}
