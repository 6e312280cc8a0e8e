//! The ways of a solve: to an accuracy, on nested grids, or on one.

use std::sync::Arc;

use asperity::accuracy::{AccurateSolution, GridError};
use asperity::constraint::Wall;
use asperity::nested::NestedSolution;
use asperity::solver::Iteration;
use asperity::stability::{ContactStiffness, Departure, StabilityTest, Verdict};
use asperity::{ContactConstraint, ContactSearch, Grid, Nested, Result, Solution, Start, Status};
use ndarray::Array2;

use crate::account::{Found, Left, OtherBranch, Refinement, Search, Steadiness, Waves};
use crate::clock::Instant;
use crate::key::{Goal, Request, Scalar};
use crate::session::posed::Body;
use crate::session::{Observe, Session};

/// The largest number of departures from unstable equilibria; a sane problem takes a few.
const MOST_DEPARTURES: usize = 10;

impl<T: Scalar> Session<T> {
    pub(super) fn by_accuracy(&mut self, goal: Goal, asked: &Request, observe: Observe<'_>) -> Result<Found<T>> {
        let (clock, surface) = (Instant::now(), self.surface()?);
        let (wanted, tolerance) = (goal.wanted(asked.after.stiffness), self.tolerance(Some(goal))?);
        let elastic = |grid| self.facts.scene.elastic.operator(grid);
        let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
        let found = wanted.solve_observed(
            &mut self.solver,
            &surface,
            elastic,
            Arc::clone(&self.law),
            asked.control,
            observe,
        )?;
        let applications = found.equivalent_applications();
        let AccurateSolution { solution, surface, levels, reached, refinable, unaffordable, .. } = found;
        let reached = Refinement::of(goal.accuracy, goal.of, reached, refinable, unaffordable);
        let mut found = self.examine(solution, clock)?;
        let nodes_per_wave = surface.nodes_per_wave(found.solution.report.boundary);
        found.sight.estimate(&levels, nodes_per_wave);
        Ok(Found { refined: Some(surface), accuracy: Some(reached), ..found.by(levels, applications) })
    }

    pub(super) fn on_nested_grids(
        &mut self,
        asked: &Request,
        started: bool,
        observe: Observe<'_>,
    ) -> Result<Option<Found<T>>> {
        let Body::Surface(surface) = &self.body else { return Ok(None) };
        let (control, settings, grid) = (asked.control, self.solver.settings, *surface.grid());
        let rigid = matches!(self.solver.constraint.wall(), Wall::Rigid | Wall::Capped(_));
        let may = !started && !asked.stability && rigid;
        let pays = || may && Nested::default().pays(&settings, surface, &self.law, control);
        if asked.fraction.is_some() || !asked.nested.unwrap_or_else(pays) {
            return Ok(None);
        }
        let clock = Instant::now();
        let (finest, tolerance) = (grid.nodes(), settings.tolerance_in::<T>());
        let waves = match self.inputs.slopes.nodes_per_wave {
            Some(nodes_per_wave) => Waves::Known(nodes_per_wave),
            _ => Waves::Of(surface.clone()),
        };
        let surface = surface.clone();
        if self.last && !asked.other_branch {
            self.body = Body::Spent;
        }
        let found = Nested::default()
            .coarse_tolerance(GridError::COARSE_TOLERANCE)
            .stiffness(asked.after.stiffness.then_some(ContactStiffness::TOLERANCE))
            .solve_observed(
                &mut self.solver,
                surface,
                |grid| self.facts.scene.elastic.operator(grid),
                Arc::clone(&self.law),
                control,
                |grid: &Grid, state: &Iteration| {
                    let coarse = if grid.nodes() == finest { 0.0 } else { GridError::COARSE_TOLERANCE };
                    observe(grid, state, tolerance.max(coarse))
                },
            )?;
        let applications = found.equivalent_applications();
        let NestedSolution { solution, levels, .. } = found;
        let mut found = self.examine(solution, clock)?;
        // the error of the grid is known for elastic contact alone
        found.sight.open = found.solution.report.plastic.is_none().then(|| (waves, levels.clone()));
        Ok(Some(found.by(levels, applications)))
    }

    pub(super) fn on_one_grid(
        &mut self,
        asked: &Request,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Result<Found<T>> {
        let clock = Instant::now();
        let presses_again = self.facts.scene.adhesion.yields() && matches!(self.body, Body::Problem(_));
        let (solver, problem) = self.parts()?;
        if presses_again {
            problem.flatten(Array2::zeros(problem.grid().field_shape()).view())?;
        }
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let mut observe = |state: &Iteration| observe(&grid, state, tolerance);
        let (mut solution, search) = match asked.fraction {
            Some(fraction) => {
                let mut search = start.map_or_else(ContactSearch::default, ContactSearch::starting_from);
                let found = search.at_observed(solver, problem, fraction, &mut observe)?;
                let search = Search::of(fraction, &found);
                (found.solution, Some(search))
            }
            None => {
                let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
                (solver.solve_with(problem, asked.control, start, &mut observe)?, None)
            }
        };
        let (mut departures, mut verdict) = (Vec::new(), None);
        while asked.stability && solution.report.status != Status::Stopped {
            let found = StabilityTest::default().run_with(problem, &solver.constraint, &solution)?;
            let leaves = asked.leave && found.verdict == Verdict::Unstable && departures.len() < MOST_DEPARTURES;
            let left = if leaves { found.leave(solver, problem, &solution, &mut observe)? } else { None };
            let ends = |left: &Departure<T>| left.energy_drop > 0.0 || left.solution.report.status == Status::Stopped;
            let Some(left) = left.filter(ends) else {
                verdict = Some(found);
                break;
            };
            departures.push(Left::of(found.eigenvalue, &left));
            solution = left.solution;
        }
        let stiffness = if asked.after.stiffness { self.stiffness(&solution)? } else { None };
        let found = self.examine(solution, clock)?;
        let stability = verdict.as_ref().map(Steadiness::of);
        let (mode, departures) = (verdict.map(|verdict| verdict.mode), asked.leave.then_some(departures));
        Ok(Found { search, stability, mode, departures, stiffness, ..found })
    }

    /// The solution on the other branch of equilibria, if the solution has a branch.
    pub(super) fn other_branch(&mut self, solution: &Solution<T>, observe: Observe<'_>) -> Result<Option<OtherBranch>> {
        let Some(branch) = solution.report.branch else { return Ok(None) };
        let original = self.facts.part.wanted();
        let (solver, problem) = self.parts()?;
        let settings = solver.settings;
        let (grid, tolerance) = (*problem.grid(), settings.tolerance_in::<T>());
        let observe = |state: &Iteration| observe(&grid, state, tolerance);
        solver.settings = settings.branch(branch.other());
        let found = solver.solve_with(problem, solution.report.control, Start::Default, observe);
        solver.settings = settings;
        let found = found?;
        let part = original.map(|original| original.of_solution(&found)).transpose()?;
        let report = part.as_ref().map_or(&found.report, |part| &part.report);
        Ok(Some(OtherBranch::of(report, found.distance(solution), found.agrees_with(solution))))
    }
}
