//! The problem of a session: the surface that makes it, and its solver.

use std::mem;
use std::sync::Arc;

use asperity::accuracy::{Accuracy, NoEstimate, Plan, Quantity};
use asperity::solver::Iteration;
use asperity::stability::{ContactStiffness, StabilityTest};
use asperity::{
    Branch, Control, ElasticOperator, Error, Grid, Problem, PullOff, Real, Result, Solution, Solver, Start,
};
use asperity::{Status, Surface};
use asperity_maps::io::available_memory;
use asperity_maps::warning::Warning;
use ndarray::Array2;

use crate::account::{Found, PulledOff, Steadiness, check_finite};
use crate::clock::Instant;
use crate::key::{After, Constraint, Goal, Load, Request, Scalar};
use crate::outcome::Outcome;
use crate::session::fall::time;
use crate::session::{Observe, Session};

/// The operator applications of a search for the pull-off, with those on coarser grids; of rough surfaces 200 to 1200.
const PULL_OFF: f64 = 600.0;

/// The surface, to make a problem on each of nested grids, or the problem on its grid alone: never both.
pub(super) enum Body<T: Real> {
    Surface(Arc<Surface>),
    Problem(Box<Problem<T>>),
    /// While a problem is made of a surface, and after that has failed.
    Spent,
}

impl<T: Scalar> Session<T> {
    /// The solver, and the problem on the grid of the surface, which is made with its first use in the place of the
    /// surface.
    ///
    /// # Errors
    /// Those of the body, the operator and [`Problem::new`]; [`Error::Unsuited`] for a problem that was refused before.
    pub(super) fn parts(&mut self) -> Result<(&mut Solver<Constraint<T>>, &mut Problem<T>)> {
        if let Body::Surface(surface) = &self.body {
            let operator = self.facts.scene.elastic.operator(*surface.grid())?;
            if let Body::Surface(surface) = mem::replace(&mut self.body, Body::Spent) {
                self.body = Body::Problem(Box::new(Problem::new(&surface, operator, self.law.clone())?));
            }
        }
        match &mut self.body {
            Body::Problem(problem) => Ok((&mut self.solver, problem)),
            _ => Err(spent()),
        }
    }

    /// The tolerance to which a solve is held, to an accuracy, if one is asked for.
    ///
    /// # Errors
    /// As [`Accuracy::tolerance`](asperity::accuracy::Accuracy::tolerance).
    pub fn tolerance(&self, goal: Option<Goal>) -> Result<f64> {
        let settings = self.solver.settings;
        goal.map_or(Ok(settings.tolerance_in::<T>()), |goal| goal.wanted(false).tolerance(&settings))
    }

    /// The surface: before the first solve, and as long as something else holds it.
    ///
    /// # Errors
    /// [`Error::Unsuited`] after that.
    pub(super) fn surface(&self) -> Result<Arc<Surface>> {
        self.surface.upgrade().ok_or_else(spent)
    }

    /// Whether the surfaces attract each other.
    pub fn adheres(&self) -> bool {
        !self.law.hints().zero
    }

    /// The load on the whole map that is a load on the part of it that results are of.
    pub(super) fn on_whole(&self, load: Control) -> Control {
        self.facts.part.wanted().map_or(load, |original| original.load(load))
    }

    /// The seconds that an operator application takes here and now, before the first solve.
    ///
    /// # Errors
    /// Those of the body and the operator; [`Error::Unsuited`] after the first solve.
    pub(super) fn seconds_of_application(&self) -> Result<f64> {
        seconds_of(&mut self.facts.scene.elastic.operator::<T>(*self.surface()?.grid())?)
    }

    /// The unit of a reduced pressure, if one is among `loads`, before the first solve.
    ///
    /// # Errors
    /// Those of [`Load::check`], and absent nodes next to a reduced pressure.
    pub fn full_pressure(&self, loads: &[Load]) -> Outcome<f64> {
        let elastic = &self.facts.scene.elastic;
        let check = |load: &Load| load.check(elastic.boundary, elastic.has_approach(), self.adheres());
        self.worded(loads.iter().try_for_each(check))?;
        let reduced = loads.iter().any(|load| matches!(load, Load::Reduced(_)));
        if reduced { self.worded(elastic.full_pressure(&*self.surface()?)) } else { Ok(1.0) }
    }

    /// The gap from which solves under `loads` begin, before the first of them, if it is not the default; see
    /// [`Boundary::start_afar`](crate::Boundary::start_afar). On the branch of unloading it is.
    pub(super) fn start_afar(&self, loads: &[Control]) -> Option<Array2<f64>> {
        let comes = self.solver.settings.branch != Some(Branch::Unloading);
        self.surface()
            .ok()
            .filter(|_| comes)
            .and_then(|surface| self.facts.scene.elastic.boundary.start_afar(&surface, loads))
    }

    /// The gap of undeformed bodies under a load that says how far they are, before the first solve.
    ///
    /// # Errors
    /// As [`Boundary::apart`](crate::Boundary::apart).
    pub fn apart(&self, load: Control) -> Outcome<Array2<f64>> {
        self.worded(self.facts.scene.elastic.boundary.apart(&*self.surface()?, load))
    }

    /// The gap from which to start, of the whole surface or of the original of a mirrored one, before the first solve.
    ///
    /// # Errors
    /// The remedy for another shape, and for nodes with a height that have no gap.
    pub fn start(&self, gap: Array2<f64>) -> Outcome<Array2<f64>> {
        let (grid, gap) = (&self.grid, self.facts.part.whole_of(gap)?);
        let (found, expected) = (gap.dim(), grid.field_shape());
        if found != expected {
            let ((nx, ny), (of_x, of_y)) = (found, grid.shape());
            return self.worded(Err(format!(
                "{{initial_gap}} has {nx} x {ny} nodes, but the heights have {of_x} x {of_y}: give a gap at each node"
            )));
        }
        let surface = self.surface()?;
        // the library refuses what is not finite, but for nodes without a gap
        let is_absent = |node: (usize, usize)| surface.absent().is_some_and(|absent| absent[node]);
        let unknown = |(node, gap): &((usize, usize), &f64)| !gap.is_finite() && !is_absent(*node);
        if let Some(((i, j), unknown)) = gap.indexed_iter().find(unknown) {
            let i = grid.rows().start + i;
            return self.worded(Err(format!(
                "{{initial_gap}} is {unknown} at index [{i}, {j}], where the surface has a height: only absent nodes may \
                 have no gap"
            )));
        }
        Ok(gap)
    }

    /// The plan of a solve to an accuracy, and the seconds that it is likely to take, by the seconds of an operator
    /// application.
    ///
    /// # Errors
    /// Those of the operator and of [`Accuracy::plan`](asperity::accuracy::Accuracy::plan).
    pub fn plan(&self, control: Control, goal: Goal) -> Result<(Plan, f64)> {
        let surface = self.surface()?;
        let mut operator = self.facts.scene.elastic.operator::<T>(*surface.grid())?;
        let plan = goal.wanted(false).plan(&self.solver, &surface, &mut operator, &self.law, self.on_whole(control))?;
        Ok((plan, plan.applications * seconds_of(&mut operator)?))
    }

    /// The solves of a search for the pull-off, and the time that they are likely to take, before the first of them.
    ///
    /// # Errors
    /// Those of the body and the operator.
    pub fn announce_pull_off(&self, refines: bool) -> Result<String> {
        let ((nx, ny), of_grid) = (self.grid.shape(), self.law.hints().of_grid);
        let seconds = self.seconds_of_application()? * PULL_OFF;
        let (solves, coarse) = if of_grid { (9, ", after as many on each coarser grid") } else { (12, "") };
        let finer = if refines { ", and four times as long on each finer grid" } else { "" };
        Ok(format!("some {solves} solves on {nx} x {ny} nodes{coarse}: about {}{finer}", time(seconds)))
    }

    /// The grid of the operator, on which the next state follows.
    pub(super) fn nodes(&mut self) -> Result<Grid> {
        Ok(*self.parts()?.1.operator().grid())
    }

    /// The equilibrium under a load, from a gap or the default start, with all that is asked for with it.
    ///
    /// # Errors
    /// Errors of the solvers of the library.
    pub(super) fn find(&mut self, asked: &Request, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
        let found = match asked.goal {
            Some(goal) => self.by_accuracy(goal, asked, &mut *observe)?,
            None => match self.on_nested_grids(asked, start.is_some(), &mut *observe)? {
                Some(found) => found,
                None => self.on_one_grid(asked, start, &mut *observe)?,
            },
        };
        let other_branch = match asked.other_branch {
            true => self.other_branch(&found.solution, observe)?,
            false => None,
        };
        let after = found.after(&asked.after, &self.facts.scene.elastic)?;
        Ok(Found { other_branch, after, ..found })
    }

    /// The solution and its sight, by a solve that began at a time.
    ///
    /// # Errors
    /// [`Error::Shape`] if the solution is not one of the surface.
    pub(super) fn examine(&self, solution: Solution<T>, clock: Instant) -> Result<Found<T>> {
        Found::new(solution, self.law.clone(), self.facts.part.wanted(), clock)
    }

    /// A state on a course with the findings that are asked for after it.
    pub(super) fn followed(&mut self, found: Found<T>, after: &After) -> Result<Found<T>> {
        let wanted = after.stiffness && check_finite(&found.solution).is_ok();
        let stiffness = if wanted { self.stiffness(&found.solution)? } else { None };
        let found = Found { stiffness, ..found };
        let after = found.after(after, &self.facts.scene.elastic)?;
        Ok(Found { after, ..found })
    }

    /// The contact stiffness of a solution, unless its solve was stopped.
    ///
    /// # Errors
    /// As [`ContactStiffness::of_constrained`].
    pub(super) fn stiffness(&mut self, solution: &Solution<T>) -> Result<Option<ContactStiffness>> {
        if solution.report.status == Status::Stopped {
            return Ok(None);
        }
        let (solver, problem) = self.parts()?;
        let (wall, tolerance) = (&solver.constraint, ContactStiffness::TOLERANCE);
        ContactStiffness::of_constrained(problem, wall, solution, tolerance).map(Some)
    }

    /// The stability of a gap under a load, with a known certified error, and its softest mode.
    ///
    /// # Errors
    /// As [`StabilityTest::of_gap`].
    pub fn stability(&mut self, control: Control, gap: &Array2<T>, error: f64) -> Result<(Steadiness, Array2<T>)> {
        let control = self.on_whole(control);
        let (solver, problem) = self.parts()?;
        let found = StabilityTest::default().of_gap(problem, &solver.constraint, control, gap, error)?;
        Ok((Steadiness::of(&found), found.mode))
    }

    /// The pull-off, to an accuracy if one is asked for, from a gap or the default start, with the last state that holds.
    /// With a law that has the range of the grid a coarser grid tells the error, unless a start is given.
    ///
    /// # Errors
    /// As [`PullOff::find_from`] and [`Accuracy::pull_off`](asperity::accuracy::Accuracy::pull_off).
    pub(super) fn find_pull_off(
        &mut self,
        asked: PullOff,
        goal: Option<Goal>,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Outcome<(Found<T>, PulledOff)> {
        let clock = Instant::now();
        let of_grid = self.law.hints().of_grid;
        if goal.is_some() || start.is_none() && of_grid {
            let tolerance = self.solver.settings.tolerance_in::<T>();
            let told = || Accuracy::new(f64::INFINITY, Quantity::Area).memory(available_memory());
            let wanted = goal.map_or_else(told, |goal| goal.wanted(false));
            let surface = self.surface()?;
            let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
            let elastic = |grid| self.facts.scene.elastic.operator(grid);
            let law = Arc::clone(&self.law);
            let found = wanted.pull_off_observed(&mut self.solver, &surface, elastic, law, &asked, observe)?;
            let last = self.examine(found.found.solution.clone(), clock)?;
            let pulled_off = PulledOff::of(asked, &found.found, &last.part()?.report, Ok(&found), goal);
            if let Err(NoEstimate::FewNodes { nodes, needed, bytes }) = found.error {
                let few = Warning::of_few_nodes(nodes, needed, bytes, wanted.memory);
                self.warnings.add_of_input(vec![self.facts.units.describe(&few)])?;
            }
            return Ok((Found { refined: goal.map(|_| found.surface), ..last }, pulled_off));
        }
        let (solver, problem) = self.parts()?;
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let found = asked.find_from(solver, problem, start, |state| observe(&grid, state, tolerance))?;
        let last = self.examine(found.solution.clone(), clock)?;
        let untold = if of_grid { "a coarser grid has no start: leave out the start" } else { PulledOff::OF_A_RANGE };
        let pulled_off = PulledOff::of(asked, &found, &last.part()?.report, Err(untold), None);
        Ok((last, pulled_off))
    }
}

/// The seconds of an application of an operator, after a trial.
fn seconds_of<T: Real>(operator: &mut impl ElasticOperator<T>) -> Result<f64> {
    let mut fields = [(); 2].map(|()| Array2::<T>::zeros(operator.grid().field_shape()));
    let [u, p] = &mut fields;
    operator.pressure(u.view(), p.view_mut())?;
    let clock = Instant::now();
    operator.pressure(u.view(), p.view_mut())?;
    Ok(clock.elapsed().as_secs_f64())
}

/// A problem that could not be made the first time cannot be made the second time.
fn spent() -> Error {
    Error::Unsuited { what: "problem", reason: "it was refused before: make it anew" }
}
