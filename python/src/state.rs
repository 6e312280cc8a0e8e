//! The state of a contact problem, with all that a sequence of solves carries on.

use asperity::contact::Original;
use asperity::{Control, Settings, Solver, Status, Surface};
use asperity_scene::units::Units;
use asperity_scene::{
    Account, Asked, Course, Formula, Found, Goal, HalfSpace, Inputs, Load, Posed, Told, Way, warnings_of_input,
};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::answer::{Scalar, answer};
use crate::inputs::Begin;
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::{reason, refusal};
use crate::running::{Observe, run};

/// A problem in one precision, with all that a sequence of solves carries on.
struct State<T: Scalar> {
    posed: Posed<T>,
    threads: Option<usize>,
    strongest: Option<(usize, usize)>,
    units: Units,
    /// of the input
    warnings: Vec<Told>,
    course: Option<Course<T>>,
}

/// The dictionary of what a solve found.
type Answered<'py> = PyResult<Bound<'py, PyDict>>;

/// What a problem does in either precision.
pub trait Solves: Send {
    fn solve<'py>(&mut self, py: Python<'py>, run: Run<'_>, asked: Asked, start: Option<Begin<'py>>) -> Answered<'py>;
    fn begin(&mut self, way: Way, stiffness: bool, start: Option<Begin<'_>>) -> PyResult<Vec<&'static str>>;
    fn next<'py>(&mut self, py: Python<'py>, run: Run<'_>) -> PyResult<Option<Bound<'py, PyDict>>>;
    fn full_pressure(&self, loads: &[Load]) -> Result<f64, String>;
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

/// The nodes in the shortest wave, tolerance, shape, bytes and seconds of a plan.
type Planned = (f64, f64, (usize, usize), f64, f64);

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
        warnings.extend(found.warnings()?.iter().map(|warning| self.units.told(warning)));
        let account = found.account(command, inputs, self.strongest, warnings)?;
        Ok((found, account))
    }

    /// The gap from which solves under loads start, if it is not the default.
    fn start(&self, given: Option<Begin<'_>>, loads: &[Control]) -> PyResult<Option<Array2<T>>> {
        let gap = match (given, loads) {
            (Some(Begin::Gap(gap)), _) => return Ok(Some(field(gap))),
            (Some(Begin::Word(word)), &[load, ..]) if word == "apart" => Some(self.posed.apart(load).map_err(reason)?),
            (Some(Begin::Word(word)), _) => {
                let remedy = "it must be 'apart', with a load that is given, an array of gaps, or a solution";
                return Err(PyValueError::new_err(format!("start is '{word}': {remedy}")));
            }
            (None, loads) => self.posed.start_afar(loads),
        };
        Ok(gap.map(|gap| gap.mapv_into_any(T::lit)))
    }

    /// The plan of a solve to an accuracy, which the logger `asperity` says.
    fn plan(&mut self, py: Python<'_>, pool: &Pool, control: Control, goal: Goal) -> PyResult<Planned> {
        let posed = &mut self.posed;
        let (plan, seconds) = py.detach(|| pool.get().install(move || posed.plan(control, goal))).map_err(refusal)?;
        let log = py.import("logging")?.call_method1("getLogger", ("asperity",))?;
        log.call_method1("info", (goal.announced(&plan, seconds),))?;
        Ok((plan.nodes_per_wave, plan.tolerance, plan.shape, plan.bytes, seconds))
    }
}

impl<T: Scalar> Solves for State<T> {
    fn solve<'py>(&mut self, py: Python<'py>, at: Run<'_>, asked: Asked, start: Option<Begin<'py>>) -> Answered<'py> {
        let start = self.start(start, &[asked.control])?;
        let plan = asked.goal.map(|goal| self.plan(py, at.pool, asked.control, goal)).transpose()?;
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let found = self.posed.solve(&asked, start, &mut |_, state, _| observe(state))?;
            self.account("solve", at.inputs, found)
        })?;
        let found = answer(py, self.threads, found)?;
        found.set_item("plan", plan)?;
        Ok(found)
    }

    fn begin(&mut self, way: Way, stiffness: bool, start: Option<Begin<'_>>) -> PyResult<Vec<&'static str>> {
        let start = match &way {
            Way::Sweep(loads) | Way::Cycle(loads, _) => self.start(start, loads)?,
            Way::Search(_) => self.start(start, &[])?,
        };
        let course = Course::new(way, stiffness).starting_from(start);
        Ok(self.course.insert(course).columns())
    }

    fn next<'py>(&mut self, py: Python<'py>, at: Run<'_>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(mut course) = self.course.clone() else { return Ok(None) };
        let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| -> asperity::Result<_> {
            let Some(found) = course.next(&mut self.posed, observe)? else { return Ok(None) };
            let (mut found, account) = self.account(course.command(), at.inputs, found)?;
            let row = course.row(&mut found, account, None)?;
            Ok(Some((found, row)))
        })?;
        let Some(found) = found.transpose() else { return raised.map_or(Ok(None), Err) };
        let mut entries = None;
        let found = found.map(|(found, row)| {
            // a state that was not reached is looked for again from where the ones before lead
            if raised.is_none() && found.solution.report.status != Status::Stopped {
                self.course = Some(course);
            }
            (found, entries.insert(row).account.clone())
        });
        let found = answer(py, self.threads, (found, raised))?;
        found.set_item("row", entries.map(|row| to_pyobject(py, &row)).transpose()?)?;
        Ok(Some(found))
    }

    fn full_pressure(&self, loads: &[Load]) -> Result<f64, String> {
        self.posed.full_pressure(loads)
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
    (surface, formula): (Surface, Formula),
    (inputs, settings, original): (&Inputs, Settings, Option<Original>),
    threads: Option<usize>,
) -> PyResult<Box<dyn Solves>> {
    let (strongest, law) = (formula.strongest(), formula.law::<T>());
    let &Inputs { boundary, modulus, ref adhesion, .. } = inputs;
    let units = inputs.units();
    let constraint = adhesion.constraint::<T>().map_err(refusal)?;
    let (half_space, solver) = (HalfSpace { boundary, modulus }, Solver { settings, constraint });
    let make = || {
        let warnings = warnings_of_input((&surface, None), half_space, &*law, &units);
        let posed = Posed::new(surface, law, half_space, solver, original);
        State { posed, threads, strongest, units, warnings, course: None }
    };
    Ok(Box::new(py.detach(|| pool.get().install(make))))
}
