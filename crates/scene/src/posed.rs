//! A contact problem, and its solve.

use std::mem;
use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::accuracy::{AccurateSolution, GridError, Plan};
use asperity::contact::Original;
use asperity::nested::NestedSolution;
use asperity::stability::{ContactStiffness, StabilityTest, Verdict};
use asperity::{
    AdhesionLaw, Branch, ContactSearch, Control, ElasticOperator, Error, Grid, Iteration, Nested, Problem, PullOff,
    Real, Result, Solution, Solver, Start, Status, Surface,
};
use ndarray::Array2;

use crate::account::Inputs;
use crate::accuracy::{Goal, planned, seconds_of};
use crate::after::After;
use crate::asked::Asked;
use crate::boundary::Boundary;
use crate::clock::Instant;
use crate::compiled::compiled;
use crate::elastic::Elastic;
use crate::entries::{Left, OtherBranch, Reached, Search, Steadiness};
use crate::found::{Found, Waves, check_finite};
use crate::identity::{Fields, Identity, identity};
use crate::load::Load;
use crate::pulled_off::PulledOff;
use crate::slopes::Slopes;
use crate::wall::Constraint;

/// The largest number of departures from unstable equilibria; a sane problem takes a few.
const MOST_DEPARTURES: usize = 10;

/// A contact problem on one grid, of an elastic body and a law of whatever kind they are.
pub type AnyProblem<T> = Problem<T, Box<dyn ElasticOperator<T>>, Arc<dyn AdhesionLaw<T>>>;

/// The observer of a solve: it sees each iteration with the grid and the tolerance of the solve on it, and may end the
/// solve.
pub type Observe<'a> = &'a mut (dyn FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> + Send);

/// The surface, of which a problem is made on each of nested grids, or the problem on its grid alone: never both.
enum Body<T: Real> {
    Surface(Arc<Surface>),
    Problem(Box<AnyProblem<T>>),
    /// While a problem is made of a surface, and after that has failed.
    Spent,
}

/// A contact problem with its solver.
pub struct Posed<T: Real> {
    body: Body<T>,
    law: Arc<dyn AdhesionLaw<T>>,
    elastic: Elastic,
    solver: Solver<Constraint<T>>,
    original: Option<Original>,
    /// Those of the surface, once they were asked for.
    slopes: Slopes,
    /// Whether no solve follows the next one.
    last: bool,
}

compiled!(Parts: &'a mut Posed<T> => Result<(&'a mut Solver<Constraint<T>>, &'a mut AnyProblem<T>)> = Posed::parts_of);
compiled!(Planned: (&'a Posed<T>, Control, Goal) => Result<(Plan, f64)> = Posed::planned);
compiled!(Timed: &'a Posed<T> => Result<f64> = Posed::timed);
compiled!(Solved: (&'a mut Posed<T>, &'a Asked, Option<Array2<T>>, Observe<'a>) => Result<Found<T>> = Posed::solved);
compiled!(Pulled: (&'a mut Posed<T>, PullOff, Option<Array2<T>>, Observe<'a>) => Result<(Found<T>, PulledOff)> =
    Posed::pulled);
compiled!(Stiff: (&'a mut Posed<T>, &'a Solution<T>) => Result<Option<ContactStiffness>> = Posed::stiff);
compiled!(Stable: (&'a mut Posed<T>, Control, &'a Array2<T>, f64) => Result<(Steadiness, Array2<T>)> = Posed::stable);

impl<T: Real> Posed<T> {
    /// The problem of a surface with an adhesion law on a half-space, whose results are of the `original` of a mirrored
    /// surface, or of the whole.
    pub fn new(
        surface: impl Into<Arc<Surface>>,
        law: Arc<dyn AdhesionLaw<T>>,
        elastic: Elastic,
        solver: Solver<Constraint<T>>,
        original: Option<Original>,
    ) -> Self {
        let (slopes, last) = (Slopes::default(), false);
        Self { body: Body::Surface(surface.into()), law, elastic, solver, original, slopes, last }
    }

    /// The solver, and the problem on the grid of the surface, which is made with its first use in the place of the
    /// surface.
    ///
    /// # Errors
    /// Those of [`Elastic::operator`] and [`Problem::new`]; [`Error::Control`] for a problem that was refused before.
    pub fn parts(&mut self) -> Result<(&mut Solver<Constraint<T>>, &mut AnyProblem<T>)> {
        T::call::<Parts<'_>>(self)
    }

    fn parts_of(&mut self) -> Result<(&mut Solver<Constraint<T>>, &mut AnyProblem<T>)> {
        if let Body::Surface(surface) = &self.body {
            let operator = self.elastic.operator(*surface.grid())?;
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
    /// Those of [`Accuracy::tolerance`](asperity::accuracy::Accuracy::tolerance).
    pub fn tolerance(&self, goal: Option<Goal>) -> Result<f64> {
        let settings = self.solver.settings;
        goal.map_or(Ok(settings.tolerance_in::<T>()), |goal| goal.by(self.solver.clone(), false).tolerance())
    }

    /// The surface, before the first solve.
    ///
    /// # Errors
    /// [`Error::Control`] after it.
    pub fn surface(&self) -> Result<&Arc<Surface>> {
        if let Body::Surface(surface) = &self.body { Ok(surface) } else { Err(spent()) }
    }

    /// The slopes of the surface, before the first solve; those of a shared one are the first process's, and all ask.
    ///
    /// # Errors
    /// [`Error::Control`] after it.
    pub fn slopes(&mut self) -> Result<Slopes> {
        self.slopes = Slopes::of(self.surface()?, self.elastic.boundary);
        Ok(self.slopes)
    }

    /// The identity of the problem, with the units of a table: all that its solutions depend on beside the loads.
    pub fn identity(&self, inputs: &Inputs, units: &str, given: Fields<'_>) -> Identity {
        identity(inputs, self.solver.settings.branch, units, given, &*self.law)
    }

    /// Whether the surfaces attract each other.
    pub fn adheres(&self) -> bool {
        !self.law.hints().zero
    }

    /// The seconds that an operator application takes here and now, before the first solve.
    ///
    /// # Errors
    /// Those of [`Elastic::operator`] and of the operator; [`Error::Control`] after the first solve.
    pub fn seconds_of_application(&self) -> Result<f64> {
        T::call::<Timed<'_>>(self)
    }

    fn timed(this: &Self) -> Result<f64> {
        seconds_of(&mut this.elastic.operator::<T>(*this.surface()?.grid())?)
    }

    /// The boundary of the half-space.
    pub fn boundary(&self) -> Boundary {
        self.elastic.boundary
    }

    /// The pressure of which a reduced pressure is a part, if one is among `loads`, before the first solve.
    ///
    /// # Errors
    /// Those of [`Load::check`] and [`Elastic::full_pressure`], for [`worded`](crate::worded).
    pub fn full_pressure(&self, loads: &[Load]) -> std::result::Result<f64, String> {
        loads.iter().try_for_each(|load| load.check(self.boundary(), self.original.is_some()))?;
        let reduced = loads.iter().any(|load| matches!(load, Load::Reduced(_)));
        if reduced { self.elastic.full_pressure(self.surface().map_err(|error| error.to_string())?) } else { Ok(1.0) }
    }

    /// The gap from which solves under `loads` begin, before the first of them, if it is not the default; see
    /// [`Boundary::start_afar`]. On the branch of unloading it is.
    pub fn start_afar(&self, loads: &[Control]) -> Option<Array2<f64>> {
        let comes = self.solver.settings.branch != Some(Branch::Unloading);
        self.surface().ok().filter(|_| comes).and_then(|surface| self.boundary().start_afar(surface, loads))
    }

    /// The gap of undeformed bodies under a load that says how far they are, before the first solve.
    ///
    /// # Errors
    /// Those of [`Boundary::apart`], for [`worded`](crate::worded).
    pub fn apart(&self, load: Control) -> std::result::Result<Array2<f64>, String> {
        self.boundary().apart(self.surface().map_err(|error| error.to_string())?, load)
    }

    /// The plan of a solve to an accuracy, and the seconds that it is likely to take.
    ///
    /// # Errors
    /// Those of [`Elastic::operator`] and [`Accuracy::plan`](asperity::accuracy::Accuracy::plan).
    pub fn plan(&self, control: Control, goal: Goal) -> Result<(Plan, f64)> {
        T::call::<Planned<'_>>((self, control, goal))
    }

    fn planned((this, control, goal): (&Self, Control, Goal)) -> Result<(Plan, f64)> {
        planned(&goal.by(this.solver.clone(), false), this.surface()?, &this.elastic, &this.law, control)
    }

    /// The equilibrium under a load, from a gap or the default start, with all that is asked for beside it.
    ///
    /// # Errors
    /// Those of the solvers of the library.
    pub fn solve(&mut self, asked: &Asked, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
        T::call::<Solved<'_>>((self, asked, start, observe))
    }

    /// [`Posed::solve`] for the last time: heights that nothing else holds leave before the solve on the finest grid.
    ///
    /// # Errors
    /// Those of [`Posed::solve`].
    pub fn solve_last(mut self, asked: &Asked, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
        self.last = !asked.other_branch;
        self.solve(asked, start, observe)
    }

    fn solved((this, asked, start, observe): (&mut Self, &Asked, Option<Array2<T>>, Observe<'_>)) -> Result<Found<T>> {
        let found = match asked.goal {
            Some(goal) => this.to_accuracy(goal, asked, &mut *observe)?,
            None => match this.on_nested_grids(asked, start.is_some(), &mut *observe)? {
                Some(found) => found,
                None => this.on_one_grid(asked, start, &mut *observe)?,
            },
        };
        let other_branch = match asked.other_branch {
            true => this.other_branch(&found.solution, observe)?,
            false => None,
        };
        let after = found.after(&asked.after, &this.elastic)?;
        Ok(Found { other_branch, after, ..found })
    }

    /// The solution and its sight, by a solve that began at a time.
    ///
    /// # Errors
    /// [`Error::Shape`] if the solution is not one of the surface.
    pub fn found(&self, solution: Solution<T>, clock: Instant) -> Result<Found<T>> {
        Found::new(solution, self.law.clone(), self.original, clock)
    }

    /// A state on a course with the findings that are asked for after it.
    pub(crate) fn followed(&mut self, found: Found<T>, after: &After) -> Result<Found<T>> {
        let wanted = after.stiffness && check_finite(&found.solution).is_ok();
        let stiffness = if wanted { self.stiffness(&found.solution)? } else { None };
        let found = Found { stiffness, ..found };
        let after = found.after(after, &self.elastic)?;
        Ok(Found { after, ..found })
    }

    /// The contact stiffness of a solution, unless its solve was stopped.
    ///
    /// # Errors
    /// Those of [`ContactStiffness::of_constrained`].
    pub fn stiffness(&mut self, solution: &Solution<T>) -> Result<Option<ContactStiffness>> {
        T::call::<Stiff<'_>>((self, solution))
    }

    fn stiff((this, solution): (&mut Self, &Solution<T>)) -> Result<Option<ContactStiffness>> {
        if solution.report.status == Status::Stopped {
            return Ok(None);
        }
        let (solver, problem) = this.parts()?;
        let (wall, tolerance) = (&solver.constraint, ContactStiffness::TOLERANCE);
        ContactStiffness::of_constrained(problem, wall, solution, tolerance).map(Some)
    }

    /// The stability of a gap under a load, of which the certified error is known, and its softest mode.
    ///
    /// # Errors
    /// Those of [`StabilityTest::of_gap`].
    pub fn stability(&mut self, control: Control, gap: &Array2<T>, error: f64) -> Result<(Steadiness, Array2<T>)> {
        T::call::<Stable<'_>>((self, control, gap, error))
    }

    fn stable((this, control, gap, error): (&mut Self, Control, &Array2<T>, f64)) -> Result<(Steadiness, Array2<T>)> {
        let (solver, problem) = this.parts()?;
        let found = StabilityTest::default().of_gap(problem, &solver.constraint, control, gap, error)?;
        Ok((Steadiness::of(&found), found.mode))
    }

    /// The pull-off, from a gap or the default start, with the last state that holds.
    ///
    /// # Errors
    /// Those of [`PullOff::find_from`].
    pub fn pull_off(
        &mut self,
        asked: PullOff,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Result<(Found<T>, PulledOff)> {
        T::call::<Pulled<'_>>((self, asked, start, observe))
    }

    fn pulled(
        (this, asked, start, observe): (&mut Self, PullOff, Option<Array2<T>>, Observe<'_>),
    ) -> Result<(Found<T>, PulledOff)> {
        let clock = Instant::now();
        let (solver, problem) = this.parts()?;
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let found = asked.find_from(solver, problem, start, |state| observe(&grid, state, tolerance))?;
        let last = this.found(found.solution.clone(), clock)?;
        let pulled_off = PulledOff::of(asked, &found, &last)?;
        Ok((last, pulled_off))
    }

    fn to_accuracy(&self, goal: Goal, asked: &Asked, observe: Observe<'_>) -> Result<Found<T>> {
        let (clock, surface) = (Instant::now(), self.surface()?);
        let (mut wanted, tolerance) =
            (goal.by(self.solver.clone(), asked.after.stiffness), self.tolerance(Some(goal))?);
        let elastic = |grid| self.elastic.operator(grid);
        let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
        let found = wanted.solve_observed(surface, elastic, &self.law, asked.control, observe)?;
        let applications = found.equivalent_applications();
        let AccurateSolution { solution, surface, levels, reached, refinable, unaffordable, .. } = found;
        let reached = Reached { wanted: goal.accuracy, of: goal.of, reached, refinable, unaffordable };
        let mut found = self.found(solution, clock)?;
        let nodes_per_wave = surface.nodes_per_wave(found.solution.report.boundary);
        found.sight.estimate(&levels, nodes_per_wave);
        Ok(Found { refined: Some(surface), accuracy: Some(reached), ..found.by(levels, applications) })
    }

    fn on_nested_grids(&mut self, asked: &Asked, started: bool, observe: Observe<'_>) -> Result<Option<Found<T>>> {
        let Body::Surface(surface) = &self.body else { return Ok(None) };
        let (control, settings, grid) = (asked.control, self.solver.settings, *surface.grid());
        let may =
            !started && !asked.stability && matches!(self.solver.constraint, Constraint::Hard | Constraint::Capped(_));
        let pays = || may && Nested::new(settings).pays(surface, &self.law, control);
        if asked.fraction.is_some() || !asked.nested.unwrap_or_else(pays) {
            return Ok(None);
        }
        let clock = Instant::now();
        let (finest, tolerance) = (grid.nodes(), settings.tolerance_in::<T>());
        let waves = match self.slopes.nodes_per_wave {
            Some(nodes_per_wave) if !grid.is_shared() => Waves::Known(nodes_per_wave),
            _ => Waves::Of(surface.clone()),
        };
        let surface = surface.clone();
        if self.last {
            self.body = Body::Spent;
        }
        let found = Nested::with_solver(self.solver.clone())
            .coarse_tolerance(GridError::COARSE_TOLERANCE)
            .stiffness(asked.after.stiffness.then_some(ContactStiffness::TOLERANCE))
            .solve_observed(
                surface,
                |grid| self.elastic.operator(grid),
                &self.law,
                control,
                |grid, state| {
                    let coarse = if grid.nodes() == finest { 0.0 } else { GridError::COARSE_TOLERANCE };
                    observe(grid, state, tolerance.max(coarse))
                },
            )?;
        let applications = found.equivalent_applications();
        let NestedSolution { solution, levels, .. } = found;
        let mut found = self.found(solution, clock)?;
        // the error of the grid is known of elastic contact alone
        found.sight.open = found.solution.report.plastic.is_none().then(|| (waves, levels.clone()));
        Ok(Some(found.by(levels, applications)))
    }

    fn on_one_grid(&mut self, asked: &Asked, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
        let clock = Instant::now();
        let (solver, problem) = self.parts()?;
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let observe = |state: &Iteration| observe(&grid, state, tolerance);
        let (mut solution, search) = match asked.fraction {
            Some(fraction) => {
                let mut search = ContactSearch::new(solver, problem)?;
                if let Some(start) = start {
                    search = search.starting_from(start);
                }
                let found = search.at_observed(fraction, observe)?;
                let search = Search::of(fraction, &found);
                (found.solution, Some(search))
            }
            None => {
                let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
                (solver.solve_with(problem, asked.control, start, observe)?, None)
            }
        };
        let (mut departures, mut verdict) = (Vec::new(), None);
        while asked.stability && solution.report.status != Status::Stopped {
            let found = StabilityTest::default().run_with(problem, &solver.constraint, &solution)?;
            let leaves = asked.leave && found.verdict == Verdict::Unstable && departures.len() < MOST_DEPARTURES;
            let left = if leaves { found.leave(solver, problem, &solution)? } else { None };
            let Some(left) = left.filter(|left| left.energy_drop > 0.0) else {
                verdict = Some(found);
                break;
            };
            let (energy_drop, distance) = (left.energy_drop, left.distance);
            departures.push(Left { eigenvalue: found.eigenvalue, energy_drop, distance });
            solution = left.solution;
        }
        let stiffness = if asked.after.stiffness { self.stiffness(&solution)? } else { None };
        let found = self.found(solution, clock)?;
        let stability = verdict.as_ref().map(Steadiness::of);
        let (mode, departures) = (verdict.map(|verdict| verdict.mode), asked.leave.then_some(departures));
        Ok(Found { search, stability, mode, departures, stiffness, ..found })
    }

    /// The solution on the other branch of equilibria, if the solution has a branch.
    fn other_branch(&mut self, solution: &Solution<T>, observe: Observe<'_>) -> Result<Option<OtherBranch>> {
        let Some(branch) = solution.report.branch else { return Ok(None) };
        let original = self.original;
        let (solver, problem) = self.parts()?;
        let settings = solver.settings.branch(branch.other());
        let (grid, tolerance) = (*problem.grid(), settings.tolerance_in::<T>());
        let mut solver = Solver { settings, ..solver.clone() };
        let observe = |state: &Iteration| observe(&grid, state, tolerance);
        let found = solver.solve_with(problem, solution.report.control, Start::Default, observe)?;
        let part = original.map(|original| original.of_solution(&found)).transpose()?;
        let report = part.as_ref().map_or(&found.report, |part| &part.report);
        Ok(Some(OtherBranch::of(report, found.distance(solution), found.agrees_with(solution))))
    }
}

/// A problem that could not be made the first time cannot be made the second time.
fn spent() -> Error {
    Error::Control { control: "problem", reason: "it was refused before: make it anew" }
}
