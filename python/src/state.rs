//! The state of a contact problem, with all that a sequence of solves carries on.

use std::time::Instant;

use asperity::accuracy::Plan;
use asperity::contact::Original;
use asperity::path::{Event, Path, PathCheckpoint, PathSettings};
use asperity::{ContactSearch, Control, Error, Settings, Solution, Solver, Status, Surface, Sweep};
use asperity_maps::warning::Warning;
use asperity_scene::{Account, Asked, Found, Goal, HalfSpace, Inputs, Posed, Search};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::answer::{Scalar, answer, told};
use crate::law::{law, strongest};
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::refusal;
use crate::running::{Observe, run};

/// A problem in one precision, with all that a sequence of solves carries on.
struct State<T: Scalar> {
    posed: Posed<T>,
    threads: Option<usize>,
    strongest: Option<(usize, usize)>,
    /// of the input
    warnings: Vec<Warning>,
    history: Vec<(Control, Array2<T>)>,
    /// the numbers and the gap of a search for contact fractions
    search: (Vec<f64>, Option<Array2<T>>),
    place: Option<PathCheckpoint<T>>,
    /// whether the present leg of the path ends at that place
    leg_ends: bool,
}

/// The gap from which a solve starts, if one is given.
pub type Begin<'py> = Option<Field<'py>>;

/// The dictionary of what a solve found.
type Answered<'py> = PyResult<Bound<'py, PyDict>>;

/// What a problem does in either precision.
pub trait Solves: Send {
    fn solve<'py>(&mut self, py: Python<'py>, run: Run<'_>, asked: Asked, start: Begin<'py>) -> Answered<'py>;
    fn next_load<'py>(&mut self, py: Python<'py>, run: Run<'_>, asked: Asked, start: Begin<'py>) -> Answered<'py>;
    fn next_step<'py>(
        &mut self,
        py: Python<'py>,
        run: Run<'_>,
        path: (Vec<Control>, PathSettings),
        start: Begin<'py>,
    ) -> PyResult<Option<Bound<'py, PyDict>>>;
    fn end_leg(&mut self);
    fn full_pressure(&self) -> Result<f64, String>;
    fn plan(&mut self, py: Python<'_>, pool: &Pool, control: Control, goal: Goal) -> PyResult<(Plan, f64)>;
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        pool: &Pool,
        control: Control,
        found: (Field<'py>, f64),
    ) -> PyResult<Bound<'py, PyAny>>;
}

/// The threads and the observer of a solve, and the inputs that its report has.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    pub pool: &'a Pool,
    pub observer: Option<&'a Py<PyAny>>,
    pub inputs: &'a Inputs,
}

/// A gap from numpy in the precision of a solve.
fn field<T: Scalar>(gap: Field<'_>) -> Array2<T> {
    gap.as_array().mapv(T::lit)
}

impl<T: Scalar> State<T> {
    /// The account of what a command found.
    fn account(
        &self,
        command: &'static str,
        inputs: &Inputs,
        found: Found<T>,
    ) -> asperity::Result<(Found<T>, Account)> {
        let mut warnings = self.warnings.clone();
        warnings.extend(found.warnings()?);
        let warnings = warnings.iter().map(|found| told(found, inputs.length_unit.as_deref())).collect();
        let account = found.account(command, inputs, self.strongest, warnings)?;
        Ok((found, account))
    }
}

impl<T: Scalar> Solves for State<T> {
    fn solve<'py>(&mut self, py: Python<'py>, at: Run<'_>, asked: Asked, start: Begin<'py>) -> Answered<'py> {
        let start = start.map(field::<T>);
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let found = self.posed.solve(&asked, start, &mut |_, state, _| observe(state))?;
            self.account("solve", at.inputs, found)
        })?;
        answer(py, self.threads, found)
    }

    fn next_load<'py>(&mut self, py: Python<'py>, at: Run<'_>, asked: Asked, start: Begin<'py>) -> Answered<'py> {
        let Asked { control, fraction, stiffness, .. } = asked;
        let start = start.map(field::<T>);
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let clock = Instant::now();
            let (solver, problem) = self.posed.parts()?;
            // a load that was not reached is tried again from where the ones before lead
            let stopped = |solution: &Solution<T>| solution.report.status == Status::Stopped;
            let (solution, search) = if let Some(fraction) = fraction {
                let (numbers, gap) = self.search.clone();
                let mut search = ContactSearch::new(solver, problem)?.continuing(&numbers, gap);
                if let Some(start) = start {
                    search = search.starting_from(start);
                }
                let found = search.at_observed(fraction, observe)?;
                let (numbers, gap) = search.checkpoint();
                if !stopped(&found.solution) {
                    self.search = (numbers, gap.cloned());
                }
                let search = Search::of(fraction, &found);
                (found.solution, Some(search))
            } else {
                let history = std::mem::take(&mut self.history);
                let kept = history.clone();
                let mut sweep = Sweep::new(solver, problem, [control]).continuing(history);
                if let Some(start) = start {
                    sweep = sweep.starting_from(start);
                }
                let next = sweep.next_observed(observe);
                let history = sweep.history().to_vec();
                let Some(next) = next else { return Err(no_load()) };
                let solution = next?;
                self.history = if stopped(&solution) { kept } else { history };
                (solution, None)
            };
            let stiffness = if stiffness { self.posed.stiffness(&solution)? } else { None };
            let found = Found { search, stiffness, ..self.posed.found(solution, clock)? };
            self.account("sweep", at.inputs, found)
        })?;
        answer(py, self.threads, found)
    }

    fn next_step<'py>(
        &mut self,
        py: Python<'py>,
        at: Run<'_>,
        (loads, settings): (Vec<Control>, PathSettings),
        start: Begin<'py>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let start = start.map(field::<T>);
        let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| -> asperity::Result<_> {
            let clock = Instant::now();
            let (solver, problem) = self.posed.parts()?;
            let mut path = Path::new(solver, problem, loads, settings)?;
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
            let found = self.account("cycle", at.inputs, self.posed.found(step.solution, clock)?)?;
            let balance = [("work", step.work), ("dissipated", step.dissipated), ("imbalance", step.imbalance)];
            Ok(Some((found, step.leg, balance, step.event)))
        })?;
        let (found, leg, balance, event) = match (found, raised) {
            (_, Some(raised)) => return Err(raised),
            (found, None) => match found.map_err(refusal)? {
                Some(found) => found,
                None => return Ok(None),
            },
        };
        let step = answer(py, self.threads, (Ok(found), None))?;
        step.set_item("leg", leg)?;
        balance.into_iter().try_for_each(|(name, value)| step.set_item(name, value))?;
        step.set_item("event", event.as_ref().map(Event::name))?;
        step.set_item("energy_drop", event.as_ref().and_then(Event::jump).map(|jump| jump.energy_drop))?;
        Ok(Some(step))
    }

    fn end_leg(&mut self) {
        self.leg_ends = true;
    }

    fn full_pressure(&self) -> Result<f64, String> {
        self.posed.full_pressure()
    }

    fn plan(&mut self, py: Python<'_>, pool: &Pool, control: Control, goal: Goal) -> PyResult<(Plan, f64)> {
        let posed = &mut self.posed;
        py.detach(|| pool.get().install(move || posed.plan(control, goal))).map_err(refusal)
    }

    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        pool: &Pool,
        control: Control,
        (gap, relative_error): (Field<'py>, f64),
    ) -> PyResult<Bound<'py, PyAny>> {
        let (gap, posed) = (field::<T>(gap), &mut self.posed);
        let test = || posed.stability(control, &gap, relative_error);
        let (found, mode) = py.detach(|| pool.get().install(test)).map_err(refusal)?;
        let entries = to_pyobject(py, &found)?;
        entries.set_item("mode", mode.into_pyarray(py))?;
        Ok(entries)
    }
}

/// The problem of a surface with its law in one precision.
pub fn state<T: Scalar>(
    py: Python<'_>,
    pool: &Pool,
    (surface, given): (Surface, &Bound<'_, PyAny>),
    (inputs, settings, original): (&Inputs, Settings, Option<Original>),
    threads: Option<usize>,
) -> PyResult<Box<dyn Solves>> {
    let (law, strongest) = (law::<T>(given)?, strongest(given));
    let &Inputs { boundary, modulus, ref adhesion, ref length_unit, .. } = inputs;
    let (half_space, solver) = (HalfSpace { boundary, modulus }, Solver { settings, constraint: adhesion.wall });
    let make = || {
        let mut warnings = boundary.warnings(&surface);
        warnings.extend(Warning::of_modulus(modulus, surface.grid(), length_unit.as_deref()));
        warnings.extend(Warning::of_law(&law, &surface, modulus));
        let posed = Posed::new(surface, law.into(), half_space, solver, original);
        let (history, search) = (Vec::new(), (Vec::new(), None));
        State { posed, threads, strongest, warnings, history, search, place: None, leg_ends: false }
    };
    Ok(Box::new(py.detach(|| pool.get().install(make))))
}

/// A sweep of one load always has a next one.
fn no_load() -> Error {
    Error::Value { name: "number of loads", value: 0.0, requirement: "at least 1" }
}
