//! A session on the grid of its surface: the problem with its solver.

use std::sync::Arc;

use asperity::solver::Iteration;
use asperity::stability::{ContactStiffness, Departure, StabilityTest, Verdict};
use asperity::{AdhesionLaw, ContactSearch, Control, Problem, Result, Solution, Solver, Start, Status};
use ndarray::Array2;

use crate::account::{Answer, Left, OtherBranch, Search, Steadiness, check_finite};
use crate::clock::Instant;
use crate::key::{After, Constraint, Request, Scalar};
use crate::session::{Facts, Observe, Session};

/// The largest number of departures from unstable equilibria; a sane problem takes a few.
const MOST_DEPARTURES: usize = 10;

/// A session on the grid of its surface: the problem with its solver.
pub struct OneGrid<T: Scalar> {
    /// The facts that its accounts have in common.
    pub facts: Facts,
    law: Arc<dyn AdhesionLaw<T>>,
    pub(super) solver: Solver<Constraint<T>>,
    pub(super) problem: Problem<T>,
}

impl<T: Scalar> Session<T> {
    /// The session on the grid of its surface.
    ///
    /// # Errors
    /// Those of the body, the operator and [`Problem::new`].
    pub fn on_one_grid(self) -> Result<OneGrid<T>> {
        let Self { facts, surface, law, .. } = self;
        let (operator, solver) = (facts.scene.elastic.operator(*surface.grid())?, facts.solver()?);
        let problem = Problem::new(&surface, operator, law.clone())?;
        Ok(OneGrid { facts, law, solver, problem })
    }
}

impl<T: Scalar> OneGrid<T> {
    /// The equilibrium under a load, from a gap or the default start, with its stability and its stiffness, if they are
    /// asked for, by a solve that began at a time.
    ///
    /// # Errors
    /// Errors of the solvers of the library.
    pub(super) fn solve(
        &mut self,
        asked: &Request,
        start: Option<Array2<T>>,
        clock: Instant,
        observe: Observe<'_>,
    ) -> Result<Answer<T>> {
        let Self { solver, problem, .. } = self;
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let mut observe = |state: &Iteration| observe(&grid, state, tolerance);
        let (mut solution, search) = match asked.fraction {
            Some(fraction) => {
                let mut search = start.map_or_else(ContactSearch::default, ContactSearch::starting_from);
                let found = search.at_observed(solver, problem, fraction, &mut observe)?;
                let search = Search::record(fraction, &found);
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
            departures.push(Left::record(found.eigenvalue, &left));
            solution = left.solution;
        }
        let stiffness = if asked.after.stiffness { self.stiffness(&solution)? } else { None };
        let found = self.examine(solution, clock)?;
        let stability = verdict.as_ref().map(Steadiness::record);
        let (mode, departures) = (verdict.map(|verdict| verdict.mode), asked.leave.then_some(departures));
        Ok(Answer { search, stability, mode, departures, stiffness, ..found })
    }

    /// The solution on the other branch of equilibria, if the solution has a branch.
    pub(super) fn other_branch(&mut self, solution: &Solution<T>, observe: Observe<'_>) -> Result<Option<OtherBranch>> {
        let Some(branch) = solution.report.branch else { return Ok(None) };
        let original = self.facts.part.wanted();
        let Self { solver, problem, .. } = self;
        let settings = solver.settings;
        let (grid, tolerance) = (*problem.grid(), settings.tolerance_in::<T>());
        let observe = |state: &Iteration| observe(&grid, state, tolerance);
        solver.settings = settings.branch(branch.other());
        let found = solver.solve_with(problem, solution.report.control, Start::Default, observe);
        solver.settings = settings;
        let found = found?;
        let part = original.map(|original| original.of_solution(&found)).transpose()?;
        let report = part.as_ref().map_or(&found.report, |part| &part.report);
        Ok(Some(OtherBranch::record(report, found.distance(solution), found.agrees_with(solution))))
    }

    /// The solution and its sight, by a solve that began at a time.
    ///
    /// # Errors
    /// As [`Facts::examine`].
    pub(super) fn examine(&self, solution: Solution<T>, clock: Instant) -> Result<Answer<T>> {
        self.facts.examine(solution, &self.law, clock)
    }

    /// A state on a course with the findings that are asked for after it.
    pub(super) fn followed(&mut self, found: Answer<T>, after: &After) -> Result<Answer<T>> {
        let wanted = after.stiffness && check_finite(&found.solution).is_ok();
        let stiffness = if wanted { self.stiffness(&found.solution)? } else { None };
        let found = Answer { stiffness, ..found };
        let after = found.after(after, &self.facts.scene.elastic)?;
        Ok(Answer { after, ..found })
    }

    /// The contact stiffness of a solution, unless its solve was stopped.
    ///
    /// # Errors
    /// As [`ContactStiffness::of_constrained`].
    pub(super) fn stiffness(&mut self, solution: &Solution<T>) -> Result<Option<ContactStiffness>> {
        if solution.report.status == Status::Stopped {
            return Ok(None);
        }
        let (wall, tolerance) = (&self.solver.constraint, ContactStiffness::TOLERANCE);
        ContactStiffness::of_constrained(&mut self.problem, wall, solution, tolerance).map(Some)
    }

    /// The stability of a gap under a load, with a known certified error, and its softest mode.
    ///
    /// # Errors
    /// As [`StabilityTest::of_gap`].
    pub fn stability(&mut self, control: Control, gap: &Array2<T>, error: f64) -> Result<(Steadiness, Array2<T>)> {
        let (control, wall) = (self.facts.on_whole(control), &self.solver.constraint);
        let found = StabilityTest::default().of_gap(&mut self.problem, wall, control, gap, error)?;
        Ok((Steadiness::record(&found), found.mode))
    }
}
