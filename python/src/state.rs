//! The state of a contact problem, with all that a sequence of solves carries on.

use asperity::accuracy::Plan;
use asperity::contact::Original;
use asperity::{Control, Settings, Solver, Status, Surface};
use asperity_scene::units::Units;
use asperity_scene::{
    Account, Asked, Course, Formula, Found, Goal, HalfSpace, Inputs, Posed, Told, Way, warnings_of_input,
};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::answer::{Scalar, answer};
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::refusal;
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

/// The gap from which a solve starts, if one is given.
pub type Begin<'py> = Option<Field<'py>>;

/// The dictionary of what a solve found.
type Answered<'py> = PyResult<Bound<'py, PyDict>>;

/// What a problem does in either precision.
pub trait Solves: Send {
    fn solve<'py>(&mut self, py: Python<'py>, run: Run<'_>, asked: Asked, start: Begin<'py>) -> Answered<'py>;
    fn begin(&mut self, way: Way, stiffness: bool, start: Begin<'_>) -> Vec<&'static str>;
    fn next<'py>(&mut self, py: Python<'py>, run: Run<'_>) -> PyResult<Option<Bound<'py, PyDict>>>;
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
        warnings.extend(found.warnings()?.iter().map(|warning| self.units.told(warning)));
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

    fn begin(&mut self, way: Way, stiffness: bool, start: Begin<'_>) -> Vec<&'static str> {
        let course = Course::new(way, stiffness).starting_from(start.map(field::<T>));
        self.course.insert(course).columns()
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
    (surface, formula): (Surface, Formula),
    (inputs, settings, original): (&Inputs, Settings, Option<Original>),
    threads: Option<usize>,
) -> PyResult<Box<dyn Solves>> {
    let (strongest, law) = (formula.strongest(), formula.law::<T>());
    let &Inputs { boundary, modulus, ref adhesion, .. } = inputs;
    let constraint = adhesion.constraint::<T>().map_err(refusal)?;
    let units = inputs.units();
    let (half_space, solver) = (HalfSpace { boundary, modulus }, Solver { settings, constraint });
    let make = || {
        let warnings = warnings_of_input((&surface, None), half_space, &*law, &units);
        let posed = Posed::new(surface, law, half_space, solver, original);
        State { posed, threads, strongest, units, warnings, course: None }
    };
    Ok(Box::new(py.detach(|| pool.get().install(make))))
}
