//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use asperity::accuracy::{AccurateSolution, GridError, Plan};
use asperity::contact::Original;
use asperity::nested::NestedSolution;
use asperity::path::{Event, Path, PathCheckpoint, PathSettings};
use asperity::stability::{ContactStiffness, StabilityTest, Verdict};
use asperity::warning::Warning;
use asperity::{
    AdhesionLaw, ContactSearch, Control, ElasticOperator, Error, Grid, Nested, Real, Settings, Solution, Solver, Start,
    Status, Surface, Sweep, Topography,
};
use asperity_scene::{Branches, Goal, HalfSpace, Wall, planned, settings};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::{Account, Grids, Other, Reached, Scalar, Search};
use crate::answer::answer;
use crate::inputs::{Accuracy, Load, contact_fraction, control, goal, named};
use crate::law::{law, strongest};
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::{refusal, refusal_of_heights};
use crate::report;
use crate::running::{Observe, run};
use crate::sight::{Estimate, Sight};

/// The largest number of departures from unstable equilibria, as in the tool.
const MOST_DEPARTURES: usize = 10;

/// A surface on its half-space with its law, of whatever kind they are.
type Boxed<T> = asperity::Problem<T, Box<dyn ElasticOperator<T>>, Arc<dyn AdhesionLaw<T>>>;

/// The surface, of which a problem is made on each of nested grids, and the problem.
enum Body<T: Real> {
    Surface(Arc<Surface>),
    Problem(Box<Boxed<T>>),
    /// While a problem is made of a surface, and if that has failed.
    Spent,
}

/// A problem in one precision, with all that a sequence of solves carries on.
struct State<T: Real> {
    body: Body<T>,
    law: Arc<dyn AdhesionLaw<T>>,
    threads: Option<usize>,
    both: bool,
    nested: Option<bool>,
    solver: Solver<Wall>,
    half_space: HalfSpace,
    strongest: Option<(usize, usize)>,
    /// the part of a mirrored surface that numbers are of, if they are not of the whole
    original: Option<Original>,
    /// of lengths
    unit: Option<String>,
    /// of the input
    warnings: Vec<Warning>,
    history: Vec<(Control, Array2<T>)>,
    /// the numbers and the gap of a search for contact fractions
    search: (Vec<f64>, Option<Array2<T>>),
    place: Option<PathCheckpoint<T>>,
    /// whether the present leg of the path ends at that place
    leg_ends: bool,
}

/// What a problem is made of beside its surface and its law.
struct Made {
    half_space: HalfSpace,
    wall: Wall,
    settings: Settings,
    /// Whether to solve on the other branch of equilibria, too.
    both: bool,
    /// Whether to solve on nested grids; the library chooses if it is not said.
    nested: Option<bool>,
    threads: Option<usize>,
    /// The original of a mirrored surface, if numbers are to be of that.
    original: Option<Original>,
    /// The unit of lengths, if it is known.
    unit: Option<String>,
}

/// The request for one solve.
struct Request<'py> {
    control: Control,
    /// The contact fraction whose load is to be found, if that is asked for.
    fraction: Option<f64>,
    start: Option<Field<'py>>,
    stability: bool,
    leave: bool,
    stiffness: bool,
    accuracy: Option<Goal>,
}

/// What a problem does in either precision.
trait Solves: Send {
    fn solve<'py>(&mut self, py: Python<'py>, run: Run<'_>, request: Request<'py>) -> PyResult<Bound<'py, PyDict>>;
    fn next_load<'py>(&mut self, py: Python<'py>, run: Run<'_>, request: Request<'py>) -> PyResult<Bound<'py, PyDict>>;
    fn next_step<'py>(
        &mut self,
        py: Python<'py>,
        run: Run<'_>,
        loads: Vec<Control>,
        settings: PathSettings,
        start: Option<Field<'py>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>>;
    fn end_leg(&mut self);
    fn plan(&self, py: Python<'_>, pool: &Pool, control: Control, goal: Goal) -> PyResult<(Plan, f64)>;
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        pool: &Pool,
        control: Control,
        found: (Field<'py>, f64),
    ) -> PyResult<Bound<'py, PyDict>>;
}

/// The threads and the observer of a solve.
#[derive(Clone, Copy)]
struct Run<'a> {
    pool: &'a Pool,
    observer: Option<&'a Py<PyAny>>,
}

/// A gap from numpy in the precision of a solve.
fn field<T: Real>(gap: Field<'_>) -> Array2<T> {
    gap.as_array().mapv(T::lit)
}

impl<T: Scalar> State<T> {
    fn new(
        surface: Surface,
        law: Box<dyn AdhesionLaw<T>>,
        strongest: Option<(usize, usize)>,
        Made { half_space, wall, settings, both, nested, threads, original, unit }: Made,
    ) -> Self {
        let HalfSpace { boundary, modulus } = half_space;
        let mut warnings = boundary.warnings(&surface);
        warnings.extend(Warning::of_modulus(modulus, surface.grid(), unit.as_deref()));
        warnings.extend(Warning::of_law(&law, &surface, modulus));
        Self {
            body: Body::Surface(Arc::new(surface)),
            law: law.into(),
            threads,
            both,
            nested,
            solver: Solver { settings, constraint: wall },
            half_space,
            strongest,
            original,
            unit,
            warnings,
            history: Vec::new(),
            search: (Vec::new(), None),
            place: None,
            leg_ends: false,
        }
    }

    /// The account of a solution on the grid of the surface, or on a finer one, by a solve that began at a time.
    fn account(&self, solution: Solution<T>, clock: Instant) -> asperity::Result<Account<T>> {
        let seconds = clock.elapsed().as_secs_f64();
        let mut warnings = self.warnings.clone();
        warnings.extend(Warning::of_solution(&solution));
        let original = self.original.map(|original| original.on(&solution.grid)).transpose()?;
        let images = original.map(|original| Warning::of_images(&original, &solution)).transpose()?;
        warnings.extend(images.flatten());
        let (law, threads) = (self.law.clone(), self.threads);
        Ok(Account {
            solution,
            grids: None,
            stability: None,
            stiffness: None,
            reached: None,
            other: None,
            departures: None,
            search: None,
            strongest: self.strongest,
            warnings,
            unit: self.unit.clone(),
            seconds,
            sight: Sight { law, original, threads, estimate: None },
        })
    }

    /// The contact stiffness of a solution, if it is asked for and the solve was not stopped.
    fn stiffness(&mut self, solution: &Solution<T>, asked: bool) -> asperity::Result<Option<ContactStiffness>> {
        if !asked || solution.report.status == Status::Stopped {
            return Ok(None);
        }
        let problem = single(&mut self.body, &self.law, self.half_space)?;
        let (wall, tolerance) = (&self.solver.constraint, ContactStiffness::TOLERANCE);
        ContactStiffness::of_constrained(problem, wall, solution, tolerance).map(Some)
    }

    /// The account of a solve to an accuracy.
    fn accurate(
        &self,
        mut wanted: asperity::accuracy::Accuracy<Wall>,
        control: Control,
        observe: Observe<'_>,
    ) -> asperity::Result<Account<T>> {
        let Body::Surface(surface) = &self.body else { return Err(spent()) };
        let clock = Instant::now();
        let half_space = |grid| self.half_space.operator(grid);
        let found = wanted.solve_observed(surface, half_space, &self.law, control, |_, state| observe(state))?;
        let applications = found.equivalent_applications();
        let AccurateSolution { solution, surface, levels, reached, refinable, unaffordable, .. } = found;
        let stiffness = levels.last().and_then(|finest| finest.stiffness);
        let account = self.account(solution, clock)?;
        let report = &account.solution.report;
        let nodes_per_wave = surface.nodes_per_wave(report.boundary);
        let estimate = Some(Estimate::Found(GridError::of_all(&levels, report, nodes_per_wave)));
        let grids = Some(Grids { levels, applications });
        let heights = Topography::from(surface).heights;
        let reached = Some(Reached { wanted: wanted.target, of: wanted.of, reached, refinable, unaffordable, heights });
        Ok(Account { grids, stiffness, reached, sight: Sight { estimate, ..account.sight }, ..account })
    }

    /// An account with the solution on the other branch of equilibria, if both are asked for and it has a branch.
    fn with_other(&mut self, account: Account<T>, observe: Observe<'_>) -> asperity::Result<Account<T>> {
        let Some(branch) = account.solution.report.branch.filter(|_| self.both) else { return Ok(account) };
        let settings = self.solver.settings.branch(branch.other());
        let mut solver = Solver { settings, ..self.solver.clone() };
        let problem = single(&mut self.body, &self.law, self.half_space)?;
        let found = solver.solve_with(problem, account.solution.report.control, Start::Default, observe)?;
        let (distance, same) = (found.distance(&account.solution), found.agrees_with(&account.solution));
        let original = self.original.map(|original| original.on(&found.grid)).transpose()?;
        let part = original.map(|original| original.of_solution(&found)).transpose()?;
        let report = part.as_ref().map_or(&found.report, |part| &part.report).clone();
        Ok(Account { other: Some(Other { report, distance, same }), ..account })
    }

    /// The account of a solve on nested grids, if these are asked for; or, with the default start, if they are faster.
    fn nested(
        &self,
        control: Control,
        begins: bool,
        stiffness: bool,
        observe: Observe<'_>,
    ) -> asperity::Result<Option<Account<T>>> {
        let Body::Surface(surface) = &self.body else { return Ok(None) };
        let law = &self.law;
        let settings = self.solver.settings;
        let half_space = |grid| self.half_space.operator(grid);
        let pays = || matches!(self.solver.constraint, Wall::Hard) && Nested::new(settings).pays(surface, law, control);
        if !self.nested.unwrap_or_else(|| begins && pays()) {
            return Ok(None);
        }
        let clock = Instant::now();
        let mut nested = Nested::with_solver(self.solver.clone())
            .coarse_tolerance(GridError::COARSE_TOLERANCE)
            .stiffness(stiffness.then_some(ContactStiffness::TOLERANCE));
        let found = nested.solve_observed(surface, half_space, law, control, |_, state| observe(state))?;
        let applications = found.equivalent_applications();
        let NestedSolution { solution, levels, .. } = found;
        let stiffness = levels.last().and_then(|finest| finest.stiffness);
        let account = self.account(solution, clock)?;
        let estimate = Some(Estimate::Open { surface: surface.clone(), levels: levels.clone() });
        let grids = Some(Grids { levels, applications });
        Ok(Some(Account { grids, stiffness, sight: Sight { estimate, ..account.sight }, ..account }))
    }
}

/// The problem on one grid, which all but a solve on nested grids needs; it is made with its first use.
fn single<'a, T: Scalar>(
    body: &'a mut Body<T>,
    law: &Arc<dyn AdhesionLaw<T>>,
    half_space: HalfSpace,
) -> asperity::Result<&'a mut Boxed<T>> {
    if let Body::Surface(surface) = body {
        let half_space = half_space.operator(*surface.grid())?;
        if let Body::Surface(surface) = std::mem::replace(body, Body::Spent) {
            *body = Body::Problem(Box::new(asperity::Problem::new(&surface, half_space, law.clone())?));
        }
    }
    if let Body::Problem(problem) = body { Ok(problem) } else { Err(spent()) }
}

/// A problem that could not be made the first time cannot be made the second time.
fn spent() -> Error {
    Error::Control { control: "problem", reason: "it was refused before: make it anew" }
}

impl<T: Scalar> Solves for State<T> {
    fn solve<'py>(&mut self, py: Python<'py>, at: Run<'_>, request: Request<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Request { control, fraction, start, stability, leave, stiffness, accuracy: goal } = request;
        let start = start.map(field::<T>);
        let wanted = goal.map(|goal| goal.by(self.solver.clone(), stiffness));
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            if let Some(wanted) = wanted {
                return self.accurate(wanted, control, observe);
            }
            if fraction.is_none()
                && let Some(account) = self.nested(control, start.is_none() && !stability, stiffness, &mut *observe)?
            {
                return self.with_other(account, observe);
            }
            let clock = Instant::now();
            let problem = single(&mut self.body, &self.law, self.half_space)?;
            let (mut solution, search) = match fraction {
                Some(fraction) => {
                    let mut search = ContactSearch::new(&mut self.solver, problem)?;
                    if let Some(start) = start {
                        search = search.starting_from(start);
                    }
                    let found = search.at_observed(fraction, &mut *observe)?;
                    let search = Search::of(fraction, &found);
                    (found.solution, Some(search))
                }
                None => {
                    let from = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
                    (self.solver.solve_with(problem, control, from, &mut *observe)?, None)
                }
            };
            let (mut departures, mut verdict) = (Vec::new(), None);
            while stability && solution.report.status != Status::Stopped {
                let found = StabilityTest::default().run_with(problem, &self.solver.constraint, &solution)?;
                let leaves = leave && found.verdict == Verdict::Unstable && departures.len() < MOST_DEPARTURES;
                let left = match leaves {
                    true => found.leave(&mut self.solver, problem, &solution)?,
                    false => None,
                };
                let Some(left) = left.filter(|left| left.energy_drop > 0.0) else {
                    verdict = Some(found);
                    break;
                };
                departures.push((found.eigenvalue, left.energy_drop, left.distance));
                solution = left.solution;
            }
            let stiffness = self.stiffness(&solution, stiffness)?;
            let account = self.account(solution, clock)?;
            let departures = leave.then_some(departures);
            self.with_other(Account { search, stability: verdict, stiffness, departures, ..account }, observe)
        })?;
        answer(py, found)
    }

    fn next_load<'py>(&mut self, py: Python<'py>, at: Run<'_>, request: Request<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Request { control, fraction, start, stiffness, .. } = request;
        let start = start.map(field::<T>);
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let clock = Instant::now();
            if let Some(fraction) = fraction {
                let problem = single(&mut self.body, &self.law, self.half_space)?;
                let (numbers, gap) = self.search.clone();
                let mut search = ContactSearch::new(&mut self.solver, problem)?.continuing(&numbers, gap);
                if let Some(start) = start {
                    search = search.starting_from(start);
                }
                let found = search.at_observed(fraction, observe)?;
                let (numbers, gap) = search.checkpoint();
                if found.solution.report.status != Status::Stopped {
                    self.search = (numbers, gap.cloned());
                }
                let search = Some(Search::of(fraction, &found));
                let stiffness = self.stiffness(&found.solution, stiffness)?;
                let account = self.account(found.solution, clock)?;
                return Ok(Account { search, stiffness, ..account });
            }
            let history = std::mem::take(&mut self.history);
            let kept = history.clone();
            let problem = single(&mut self.body, &self.law, self.half_space)?;
            let mut sweep = Sweep::new(&mut self.solver, problem, [control]).continuing(history);
            if let Some(start) = start {
                sweep = sweep.starting_from(start);
            }
            let next = sweep.next_observed(observe);
            let history = sweep.history().to_vec();
            let Some(next) = next else { return Err(no_load()) };
            let solution = next?;
            // a load that was not reached is tried again from where the ones before lead
            let stopped = solution.report.status == Status::Stopped;
            self.history = if stopped { kept } else { history };
            let stiffness = self.stiffness(&solution, stiffness)?;
            Ok(Account { stiffness, ..self.account(solution, clock)? })
        })?;
        answer(py, found)
    }

    fn next_step<'py>(
        &mut self,
        py: Python<'py>,
        at: Run<'_>,
        loads: Vec<Control>,
        settings: PathSettings,
        start: Option<Field<'py>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let start = start.map(field::<T>);
        let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| -> asperity::Result<_> {
            let clock = Instant::now();
            let problem = single(&mut self.body, &self.law, self.half_space)?;
            let mut path = Path::new(&mut self.solver, problem, loads, settings)?;
            path = match (self.place.clone(), start) {
                (Some(place), _) => path.continuing(place)?,
                (None, Some(start)) => path.starting_from(start),
                (None, None) => path,
            };
            if std::mem::take(&mut self.leg_ends) {
                path.end_leg();
            }
            let Some(step) = path.next_observed(observe) else { return Ok(None) };
            let step = step?;
            self.place = Some(path.checkpoint());
            let account = self.account(step.solution, clock)?;
            let balance = [("work", step.work), ("dissipated", step.dissipated), ("imbalance", step.imbalance)];
            Ok(Some((account, step.leg, balance, step.event)))
        })?;
        let (account, leg, balance, event) = match (found, raised) {
            (_, Some(raised)) => return Err(raised),
            (found, None) => match found.map_err(refusal)? {
                Some(found) => found,
                None => return Ok(None),
            },
        };
        let step = answer(py, (Ok(account), None))?;
        step.set_item("leg", leg)?;
        balance.into_iter().try_for_each(|(name, value)| step.set_item(name, value))?;
        step.set_item("event", event.as_ref().map(Event::name))?;
        step.set_item("energy_drop", event.as_ref().and_then(Event::jump).map(|jump| jump.energy_drop))?;
        Ok(Some(step))
    }

    fn end_leg(&mut self) {
        self.leg_ends = true;
    }

    fn plan(&self, py: Python<'_>, pool: &Pool, control: Control, goal: Goal) -> PyResult<(Plan, f64)> {
        let Body::Surface(surface) = &self.body else { return Err(refusal(spent())) };
        let (wanted, half_space, law) = (goal.by(self.solver.clone(), false), self.half_space, &self.law);
        let plan = || planned(&wanted, surface, half_space, law, control);
        py.detach(|| pool.get().install(plan)).map_err(refusal)
    }

    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        pool: &Pool,
        control: Control,
        (gap, relative_error): (Field<'py>, f64),
    ) -> PyResult<Bound<'py, PyDict>> {
        let gap = field::<T>(gap);
        let problem = single(&mut self.body, &self.law, self.half_space).map_err(refusal)?;
        let wall = &self.solver.constraint;
        let test = || StabilityTest::default().of_gap(problem, wall, control, &gap, relative_error);
        let found = py.detach(|| pool.get().install(test)).map_err(refusal)?;
        let entries = report::stability(py, &found)?;
        entries.set_item("mode", found.mode.into_pyarray(py))?;
        Ok(entries)
    }
}

/// The problem of a surface in one precision.
fn state<T: Scalar>(
    py: Python<'_>,
    pool: &Pool,
    surface: Surface,
    given: &Bound<'_, PyAny>,
    made: Made,
) -> PyResult<Box<dyn Solves>> {
    let (law, strongest) = (law::<T>(given)?, strongest(given));
    Ok(Box::new(py.detach(|| pool.get().install(|| State::new(surface, law, strongest, made)))))
}

/// A sweep of one load always has a next one.
fn no_load() -> Error {
    Error::Value { name: "number of loads", value: 0.0, requirement: "at least 1" }
}

/// The nodes in the shortest wave, tolerance, shape, bytes and seconds of a plan.
type Planned = (f64, f64, (usize, usize), f64, f64);

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    solves: Mutex<Box<dyn Solves>>,
    threads: Option<usize>,
    max_iterations: usize,
}

impl Problem {
    /// The pool of a solve, and the problem.
    fn parts(&mut self) -> PyResult<(Pool, &mut dyn Solves)> {
        let pool = Pool::of(self.threads)?;
        Ok((pool, self.solves.get_mut().unwrap_or_else(PoisonError::into_inner).as_mut()))
    }
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (
        heights, lengths, absent_missing, boundary, modulus, law, wall, precision, tolerance, max_iterations, method,
        branch, nested, threads, original, unit
    ))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn new(
        py: Python<'_>,
        heights: Field<'_>,
        lengths: (f64, f64),
        absent_missing: bool,
        boundary: &str,
        modulus: f64,
        law: &Bound<'_, PyAny>,
        wall: &str,
        precision: &str,
        tolerance: Option<f64>,
        max_iterations: Option<usize>,
        method: &str,
        branch: Option<&str>,
        nested: Option<bool>,
        threads: Option<usize>,
        original: Option<PyRef<'_, crate::original::Original>>,
        unit: Option<String>,
    ) -> PyResult<Self> {
        let method = named("method", method, "default or rey2017")?;
        let branches = branch.map(|name| named("branch", name, "loading, unloading or both")).transpose()?;
        let (settings, both) =
            (settings(method, tolerance, max_iterations, branches), branches == Some(Branches::Both));
        let pool = Pool::of(threads)?;
        let heights = heights.to_array()?;
        let boundary = named("boundary", boundary, "periodic or free")?;
        let (half_space, wall) = (HalfSpace { boundary, modulus }, named("wall", wall, "hard or none")?);
        let original = original.map(|original| original.0);
        let made = Made { half_space, wall, settings, both, nested, threads, original, unit };
        let make = if absent_missing { Surface::with_absent } else { Surface::new };
        let surface = Grid::new(heights.dim(), lengths).and_then(|grid| make(grid, heights));
        let surface = surface.map_err(refusal_of_heights)?;
        let solves = match precision {
            "f64" => state::<f64>(py, &pool, surface, law, made)?,
            "f32" => state::<f32>(py, &pool, surface, law, made)?,
            other => return Err(PyValueError::new_err(format!("precision is {other}: it must be f64 or f32"))),
        };
        Ok(Self { solves: Mutex::new(solves), threads, max_iterations: settings.max_iterations })
    }

    /// The limit of the iterations and the number of threads, with their defaults.
    fn inputs(&self) -> PyResult<(usize, usize)> {
        Ok((self.max_iterations, Pool::of(self.threads)?.threads()))
    }

    /// The plan of a solve to an accuracy.
    #[pyo3(signature = (load, accuracy))]
    fn plan(&mut self, py: Python<'_>, load: Load, accuracy: Accuracy) -> PyResult<Planned> {
        let (pool, solves) = self.parts()?;
        let (Plan { nodes_per_wave, tolerance, shape, bytes, .. }, seconds) =
            solves.plan(py, &pool, control(&load)?, goal(accuracy)?)?;
        Ok((nodes_per_wave, tolerance, shape, bytes, seconds))
    }

    /// The equilibrium at a load.
    #[pyo3(signature = (load, start, observe, stability, leave, stiffness, accuracy))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        load: Load,
        start: Option<Field<'py>>,
        observe: Option<Py<PyAny>>,
        stability: bool,
        leave: bool,
        stiffness: bool,
        accuracy: Option<Accuracy>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (control, fraction) = (control(&load)?, contact_fraction(&load));
        let accuracy = accuracy.map(goal).transpose()?;
        let request = Request { control, fraction, start, stability, leave, stiffness, accuracy };
        let (pool, solves) = self.parts()?;
        solves.solve(py, Run { pool: &pool, observer: observe.as_ref() }, request)
    }

    /// The equilibrium at the next load of a sweep.
    #[pyo3(signature = (load, start, observe, stiffness))]
    fn next_load<'py>(
        &mut self,
        py: Python<'py>,
        load: Load,
        start: Option<Field<'py>>,
        observe: Option<Py<PyAny>>,
        stiffness: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (control, fraction, stability, leave, accuracy) =
            (control(&load)?, contact_fraction(&load), false, false, None);
        let request = Request { control, fraction, start, stability, leave, stiffness, accuracy };
        let (pool, solves) = self.parts()?;
        solves.next_load(py, Run { pool: &pool, observer: observe.as_ref() }, request)
    }

    /// The next state of a path through loads; none at its end.
    #[pyo3(signature = (loads, steps, smallest_step, imbalance, smooth, start, observe))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn next_step<'py>(
        &mut self,
        py: Python<'py>,
        loads: Vec<Load>,
        steps: usize,
        smallest_step: f64,
        imbalance: f64,
        smooth: bool,
        start: Option<Field<'py>>,
        observe: Option<Py<PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let loads = loads.iter().map(control).collect::<PyResult<_>>()?;
        let settings =
            PathSettings::default().steps(steps).smallest_step(smallest_step).imbalance(imbalance).smooth(smooth);
        let (pool, solves) = self.parts()?;
        solves.next_step(py, Run { pool: &pool, observer: observe.as_ref() }, loads, settings, start)
    }

    /// Ends the present leg of the path: the next step heads for the next load.
    fn end_leg(&mut self) {
        self.solves.get_mut().unwrap_or_else(PoisonError::into_inner).end_leg();
    }

    /// The stability of a gap under a load, of which the certified error is known.
    #[pyo3(signature = (load, gap, relative_error))]
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        load: Load,
        gap: Field<'py>,
        relative_error: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (pool, solves) = self.parts()?;
        solves.stability(py, &pool, control(&load)?, (gap, relative_error))
    }
}
