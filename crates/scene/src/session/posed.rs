//! A contact problem with its solver.

use std::mem;
use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::accuracy::{Accuracy, Plan, Quantity};
use asperity::contact::Original;
use asperity::solver::Iteration;
use asperity::stability::{ContactStiffness, StabilityTest};
use asperity::{
    AdhesionLaw, Branch, Control, Error, Grid, Problem, PullOff, Real, Result, Solution, Solver, Start, Status, Surface,
};
use ndarray::{Array2, ArrayView2};

mod solves;

use crate::account::Inputs;
use crate::account::entries::Steadiness;
use crate::account::found::{Found, check_finite};
use crate::account::pulled_off::PulledOff;
use crate::account::slopes::Slopes;
use crate::clock::Instant;
use crate::key::accuracy::Goal;
use crate::key::after::After;
use crate::key::asked::Asked;
use crate::key::boundary::Boundary;
use crate::key::elastic::Elastic;
use crate::key::load::Load;
use crate::key::scene::Scene;
use crate::key::wall::Constraint;
use crate::session::plan::{planned, seconds_of};
use crate::table::identity::{Fields, Identity, identity};

/// The observer of a solve: it sees each iteration with the grid and the tolerance of the solve on it, and may end the
/// solve.
pub type Observe<'a> = &'a mut (dyn FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> + Send);

/// The surface, of which a problem is made on each of nested grids, or the problem on its grid alone: never both.
enum Body<T: Real> {
    Surface(Arc<Surface>),
    Problem(Box<Problem<T>>),
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

impl Scene {
    /// The problem of a surface with the law of the scene, and a `hardness` at its nodes where that varies, whose
    /// results are of the `original` of a mirrored surface, or of the whole.
    ///
    /// # Errors
    /// Those of [`Adhesion::constraint`].
    pub fn posed<T: Real>(
        &self,
        surface: impl Into<Arc<Surface>>,
        law: Arc<dyn AdhesionLaw<T>>,
        hardness: Option<ArrayView2<'_, f64>>,
        original: Option<Original>,
    ) -> Result<Posed<T>> {
        let solver = Solver { settings: self.settings(), constraint: self.adhesion.constraint(hardness)? };
        Ok(Posed::new(surface, law, self.elastic.clone(), solver, original))
    }
}

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
    /// Those of [`Elastic::operator`] and [`Problem::new`]; [`Error::Unsuited`] for a problem that was refused before.
    pub fn parts(&mut self) -> Result<(&mut Solver<Constraint<T>>, &mut Problem<T>)> {
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
        goal.map_or(Ok(settings.tolerance_in::<T>()), |goal| goal.wanted(false).tolerance(&settings))
    }

    /// The surface, before the first solve.
    ///
    /// # Errors
    /// [`Error::Unsuited`] after it.
    pub fn surface(&self) -> Result<&Arc<Surface>> {
        if let Body::Surface(surface) = &self.body { Ok(surface) } else { Err(spent()) }
    }

    /// The slopes of the surface, before the first solve; of the whole of a shared one, and all processes ask.
    ///
    /// # Errors
    /// [`Error::Unsuited`] after it.
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
    /// Those of [`Elastic::operator`] and of the operator; [`Error::Unsuited`] after the first solve.
    pub fn seconds_of_application(&self) -> Result<f64> {
        seconds_of(&mut self.elastic.operator::<T>(*self.surface()?.grid())?)
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
        planned(&goal.wanted(false), &self.solver, self.surface()?, &self.elastic, &self.law, control)
    }

    /// The equilibrium under a load, from a gap or the default start, with all that is asked for beside it.
    ///
    /// # Errors
    /// Those of the solvers of the library.
    pub fn solve(&mut self, asked: &Asked, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
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
        let after = found.after(&asked.after, &self.elastic)?;
        Ok(Found { other_branch, after, ..found })
    }

    /// [`Posed::solve`] for the last time: heights that nothing else holds leave before the solve on the finest grid.
    ///
    /// # Errors
    /// Those of [`Posed::solve`].
    pub fn solve_last(mut self, asked: &Asked, start: Option<Array2<T>>, observe: Observe<'_>) -> Result<Found<T>> {
        self.last = !asked.other_branch;
        self.solve(asked, start, observe)
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
        if solution.report.status == Status::Stopped {
            return Ok(None);
        }
        let (solver, problem) = self.parts()?;
        let (wall, tolerance) = (&solver.constraint, ContactStiffness::TOLERANCE);
        ContactStiffness::of_constrained(problem, wall, solution, tolerance).map(Some)
    }

    /// The stability of a gap under a load, of which the certified error is known, and its softest mode.
    ///
    /// # Errors
    /// Those of [`StabilityTest::of_gap`].
    pub fn stability(&mut self, control: Control, gap: &Array2<T>, error: f64) -> Result<(Steadiness, Array2<T>)> {
        let (solver, problem) = self.parts()?;
        let found = StabilityTest::default().of_gap(problem, &solver.constraint, control, gap, error)?;
        Ok((Steadiness::of(&found), found.mode))
    }

    /// The pull-off, to an accuracy if one is asked for, from a gap or the default start, with the last state that holds.
    /// With a law that has the range of the grid a coarser grid tells the error, unless a start is given.
    ///
    /// # Errors
    /// Those of [`PullOff::find_from`] and [`Accuracy::pull_off`](asperity::accuracy::Accuracy::pull_off).
    pub fn pull_off(
        &mut self,
        asked: PullOff,
        goal: Option<Goal>,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Result<(Found<T>, PulledOff)> {
        let clock = Instant::now();
        if goal.is_some() || start.is_none() && self.law.hints().of_grid {
            let tolerance = self.solver.settings.tolerance_in::<T>();
            let wanted = goal.map_or(Accuracy::new(f64::INFINITY, Quantity::Area), |goal| goal.wanted(false));
            let surface = Arc::clone(self.surface()?);
            let observe = |grid: &Grid, state: &Iteration| observe(grid, state, tolerance);
            let elastic = |grid| self.elastic.operator(grid);
            let law = Arc::clone(&self.law);
            let found = wanted.pull_off_observed(&mut self.solver, &surface, elastic, law, &asked, observe)?;
            let last = self.found(found.found.solution.clone(), clock)?;
            let pulled_off = PulledOff::of(asked, &found.found, &last)?.to_accuracy(&found, goal, &last)?;
            return Ok((Found { refined: goal.map(|_| found.surface), ..last }, pulled_off));
        }
        let (solver, problem) = self.parts()?;
        let (grid, tolerance) = (*problem.grid(), solver.settings.tolerance_in::<T>());
        let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let found = asked.find_from(solver, problem, start, |state| observe(&grid, state, tolerance))?;
        let last = self.found(found.solution.clone(), clock)?;
        let pulled_off = PulledOff::of(asked, &found, &last)?;
        Ok((last, pulled_off))
    }
}

/// A problem that could not be made the first time cannot be made the second time.
fn spent() -> Error {
    Error::Unsuited { what: "problem", reason: "it was refused before: make it anew" }
}
