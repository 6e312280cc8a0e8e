//! The ways of a solve: to an accuracy, on nested grids, or on one.

use std::sync::Arc;

use asperity::accuracy::{AccurateSolution, GridError};
use asperity::constraint::Wall;
use asperity::nested::NestedSolution;
use asperity::solver::Iteration;
use asperity::stability::ContactStiffness;
use asperity::{AdhesionLaw, ContactConstraint, Grid, Nested, Result, Solution, Solver};
use ndarray::Array2;

use crate::account::{Answer, Refinement, Waves};
use crate::clock::Instant;
use crate::key::{Goal, Request, Scalar};
use crate::outcome::Outcome;
use crate::session::{Facts, Observe, Session, Solved};

impl Facts {
    /// The solution and its sight, by a solve that began at a time.
    ///
    /// # Errors
    /// [`Error::Shape`](asperity::Error::Shape) if the solution is not one of the surface.
    pub(super) fn examine<T: Scalar>(
        &self,
        solution: Solution<T>,
        law: &Arc<dyn AdhesionLaw<T>>,
        clock: Instant,
    ) -> Result<Answer<T>> {
        Answer::new(solution, Arc::clone(law), self.part.wanted(), clock)
    }
}

impl<T: Scalar> Session<T> {
    /// The equilibrium under a load, from a gap or the default start, with all that is asked for with it, and its
    /// account.
    ///
    /// # Errors
    /// Errors of the solvers of the library, a solve that ran away, and warnings, if they are errors.
    pub fn solve(self, asked: &Request, start: Option<Array2<T>>, observe: Observe<'_>) -> Outcome<Solved<T>> {
        let asked = &Request { control: self.facts.on_whole(asked.control), ..*asked };
        let (mut found, facts) = match asked.goal {
            Some(goal) => (self.by_accuracy(goal, asked, observe)?, self.facts),
            None if self.is_nested(asked, start.is_some())? => {
                let again = asked.other_branch.then(|| self.clone());
                let (mut found, facts) = self.on_nested_grids(asked, &mut *observe)?;
                if let Some(again) = again {
                    found.other_branch = again.on_one_grid()?.other_branch(&found.solution, observe)?;
                }
                (found, facts)
            }
            None => {
                let (clock, mut one) = (Instant::now(), self.on_one_grid()?);
                let mut found = one.solve(asked, start, clock, &mut *observe)?;
                if asked.other_branch {
                    found.other_branch = one.other_branch(&found.solution, observe)?;
                }
                (found, one.facts)
            }
        };
        found.after = found.after(&asked.after, &facts.scene.elastic)?;
        facts.solved("solve", found)
    }

    fn by_accuracy(&self, goal: Goal, asked: &Request, observe: Observe<'_>) -> Result<Answer<T>> {
        let (clock, mut solver) = (Instant::now(), self.facts.solver()?);
        let (wanted, tolerance) = (goal.wanted(asked.after.stiffness), self.tolerance(Some(goal))?);
        let elastic = |grid| self.facts.scene.elastic.operator(grid);
        let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
        let law = Arc::clone(&self.law);
        let found = wanted.solve_observed(&mut solver, &self.surface, elastic, law, asked.control, observe)?;
        let applications = found.equivalent_applications();
        let AccurateSolution { solution, surface, levels, reached, refinable, unaffordable, .. } = found;
        let reached = Refinement::record(goal.accuracy, goal.of, reached, refinable, unaffordable);
        let mut found = self.facts.examine(solution, &self.law, clock)?;
        let nodes_per_wave = surface.nodes_per_wave(found.solution.report.boundary);
        found.sight.estimate(&levels, nodes_per_wave);
        Ok(Answer { refined: Some(surface), accuracy: Some(reached), ..found.by(levels, applications) })
    }

    /// Whether a solve is on nested grids: where that is asked for, or pays.
    fn is_nested(&self, asked: &Request, started: bool) -> Result<bool> {
        let (Solver { settings, constraint }, surface) = (self.facts.solver::<T>()?, &*self.surface);
        let rigid = matches!(constraint.wall(), Wall::Rigid | Wall::Capped(_));
        let may = !started && !asked.stability && rigid;
        let pays = || may && Nested::default().pays(&settings, surface, &self.law, asked.control);
        Ok(asked.fraction.is_none() && asked.nested.unwrap_or_else(pays))
    }

    fn on_nested_grids(self, asked: &Request, observe: Observe<'_>) -> Result<(Answer<T>, Facts)> {
        let Self { facts, surface, law, .. } = self;
        let (clock, mut solver) = (Instant::now(), facts.solver()?);
        let (finest, tolerance) = (surface.grid().nodes(), solver.settings.tolerance_in::<T>());
        let waves = match facts.inputs.slopes.nodes_per_wave {
            Some(nodes_per_wave) => Waves::Known(nodes_per_wave),
            _ => Waves::Of(surface.clone()),
        };
        let found = Nested::default()
            .coarse_tolerance(GridError::COARSE_TOLERANCE)
            .stiffness(asked.after.stiffness.then_some(ContactStiffness::TOLERANCE))
            .solve_observed(
                &mut solver,
                surface,
                |grid| facts.scene.elastic.operator(grid),
                Arc::clone(&law),
                asked.control,
                |grid: &Grid, state: &Iteration| {
                    let coarse = if grid.nodes() == finest { 0.0 } else { GridError::COARSE_TOLERANCE };
                    observe(grid, state, tolerance.max(coarse))
                },
            )?;
        let applications = found.equivalent_applications();
        let NestedSolution { solution, levels, .. } = found;
        let mut found = facts.examine(solution, &law, clock)?;
        // the error of the grid is known for elastic contact alone
        found.sight.open = found.solution.report.plastic.is_none().then(|| (waves, levels.clone()));
        Ok((found.by(levels, applications), facts))
    }
}
