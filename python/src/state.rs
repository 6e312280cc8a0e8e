//! The state of a contact problem, with all that a sequence of solves carries on.

use std::path::{Path, PathBuf};

use asperity::contact::Original;
use asperity::{Control, PullOff, Status, Surface};
use asperity_scene::interface::touch;
use asperity_scene::output::{check_apart, check_free, with_suffix};
use asperity_scene::processes::Processes;
use asperity_scene::units::Units;
use asperity_scene::{
    Account, After, Asked, Course, Fields, Format, Formula, Found, Goal, Inputs, Load, Opening, Posed, Scene, Skin,
    Slopes, Table, Told, Way, check_finite, warnings_of_input,
};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::Value;
use serde_pyobject::to_pyobject;

use crate::answer::{answer, reported};
use crate::inputs::Begin;
use crate::numbers::{Field, Scalar};
use crate::pools::Pool;
use crate::refusal::{reason, refusal, refusal_of_table};
use crate::running::{Observe, run};

/// A problem in one precision, with all that a sequence of solves carries on.
struct State<T: Scalar> {
    posed: Posed<T>,
    threads: Option<usize>,
    strongest: Option<(usize, usize)>,
    units: Units,
    /// where it varies
    hardness: Option<Array2<f64>>,
    /// of the input, with the threshold of the scars that were removed from its heights
    warnings: Vec<Told>,
    scars_removed: Option<f64>,
    course: Option<Course<T>>,
    /// of the surface
    seed: Option<u64>,
    table: Option<(Table, Processes)>,
}

/// The file of a table as Python passes it: its path, the folder for fields, whether to start over, the gaps and
/// tractions and the works of adhesion of the law, and whether it is another law than those of its name.
pub type File<'py> = (PathBuf, Option<PathBuf>, bool, Option<Field<'py>>, Option<Field<'py>>, bool);

/// The names of the columns of a table, and the cells of its rows.
type Columns<'py> = PyResult<(Vec<&'static str>, Bound<'py, PyAny>)>;

/// The seconds that are left of a cycle, as far as they are known, and its pace in words.
pub type Pace = Option<(Option<f64>, String)>;

/// The dictionary of what a solve found.
type Answered<'py> = PyResult<Bound<'py, PyDict>>;

/// The methods of a problem in either precision.
pub trait Solves: Send {
    fn solve<'py>(&mut self, py: Python<'py>, run: Run<'_>, asked: Asked, start: Option<Begin<'py>>) -> Answered<'py>;
    fn pull_off<'py>(
        &mut self,
        py: Python<'py>,
        run: Run<'_>,
        asked: (PullOff, Option<Goal>),
        start: Option<Begin<'py>>,
    ) -> Answered<'py>;
    fn begin<'py>(
        &mut self,
        py: Python<'py>,
        run: Run<'_>,
        course: (Way, (After, bool), Option<u64>),
        start: Option<Begin<'py>>,
        file: Option<File<'py>>,
    ) -> Columns<'py>;
    fn next<'py>(&mut self, py: Python<'py>, run: Run<'_>) -> PyResult<Option<Bound<'py, PyDict>>>;
    fn pace(&self) -> Pace;
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
        warnings
            .extend(found.warnings(&self.warnings, self.scars_removed)?.iter().map(|warning| self.units.told(warning)));
        let account = found.account(command, inputs, self.strongest, warnings)?;
        Ok((found, account))
    }

    /// The gap from which solves under loads start, if it is not the default.
    fn start(&self, given: Option<Begin<'_>>, loads: &[Control]) -> PyResult<Option<Array2<f64>>> {
        match (given, loads) {
            (Some(Begin::Gap(gap)), _) => Ok(Some(gap.as_array().to_owned())),
            (Some(Begin::Word(word)), &[load, ..]) if word == "apart" => {
                self.posed.apart(load).map(Some).map_err(reason)
            }
            (Some(Begin::Word(word)), _) => {
                let remedy = "it must be 'apart', with a load that is given, an array of gaps, or a solution";
                Err(PyValueError::new_err(format!("start is '{word}': {remedy}")))
            }
            (None, loads) => Ok(self.posed.start_afar(loads)),
        }
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
        let start = self.start(start, &[asked.control])?.map(|gap| gap.mapv_into_any(T::lit));
        let plan = asked.goal.map(|goal| self.plan(py, at.pool, asked.control, goal)).transpose()?;
        let found = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let found = self.posed.solve(&asked, start, &mut |_, state, _| observe(state))?;
            self.account("solve", at.inputs, found)
        })?;
        let found = answer(py, self.threads, found)?;
        found.set_item("plan", plan)?;
        Ok(found)
    }

    fn pull_off<'py>(
        &mut self,
        py: Python<'py>,
        at: Run<'_>,
        (asked, goal): (PullOff, Option<Goal>),
        start: Option<Begin<'py>>,
    ) -> Answered<'py> {
        let start = self.start(start, &[])?.map(|gap| gap.mapv_into_any(T::lit));
        let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| {
            let (found, pulled_off) = self.posed.pull_off(asked, goal, start, &mut |_, state, _| observe(state))?;
            let (found, last) = self.account("pull-off", at.inputs, found)?;
            let shortfall = pulled_off.shortfall(&last, Skin::Keywords);
            Ok(((found, last), (pulled_off, shortfall)))
        })?;
        let (found, pulled_off) = found.map_or_else(|error| (Err(error), None), |(found, of)| (Ok(found), Some(of)));
        let answer = answer(py, self.threads, (found, raised))?;
        if let Some((pulled_off, shortfall)) = pulled_off {
            answer.set_item("pull_off", reported(py, &pulled_off)?)?;
            answer.set_item("shortfall", shortfall)?;
        }
        Ok(answer)
    }

    fn begin<'py>(
        &mut self,
        py: Python<'py>,
        at: Run<'_>,
        (way, (after, interface), seed): (Way, (After, bool), Option<u64>),
        start: Option<Begin<'py>>,
        file: Option<File<'py>>,
    ) -> Columns<'py> {
        let (loads, adhesive) = (way.loads(), at.inputs.adhesion.adheres());
        let control = loads.first().copied().unwrap_or_else(|| at.inputs.elastic.boundary.searched_by(adhesive));
        let start = self.start(start, loads)?;
        let course = Course::new(way, after).map_err(refusal)?.with(&at.inputs.adhesion);
        let course = match interface {
            true => course.of_interface(touch(self.posed.surface().map_err(refusal)?)),
            false => course,
        };
        let (posed, mut course) = (&mut self.posed, course);
        let expect = move || course.expect(posed).map(|()| course);
        let course = py.detach(|| at.pool.get().install(expect)).map_err(refusal)?;
        let names = course.columns();
        self.seed = seed;
        let Some((out, fields, force, law_table, works, law_differs)) = file else {
            self.course = Some(course.starting_from(start.map(|gap| gap.mapv_into_any(T::lit))));
            return Ok((names, PyList::empty(py).into_any()));
        };
        let [law_table, works] = [law_table, works].map(|given| given.map(|given| given.as_array().to_owned()));
        let open = || {
            let given = Fields {
                surface: self.posed.surface()?,
                law_table: law_table.as_deref(),
                works: works.as_deref(),
                hardness: self.hardness.as_deref(),
                start: start.as_deref().filter(|_| at.inputs.initial_gap.is_some()),
                law_differs,
            };
            let identity = self.posed.identity(at.inputs, &self.units.of_table(), given);
            course.check(&mut self.posed)?;
            let nodes = *self.posed.parts()?.1.operator().grid();
            let format = Format::of(&out).ok_or("out ends in neither .csv nor .jsonl: rename it")?;
            check_apart(&out, at.inputs.heights.as_deref().map(Path::new))?;
            let beside = [".scene.toml", ".warnings.txt"].map(|suffix| with_suffix(&out, suffix)).to_vec();
            beside.iter().try_for_each(|file| check_free(file, force || out.exists(), "--out"))?;
            let header = self.units.columns(&names, control.name(), nodes.is_line());
            let processes = Processes::start()?;
            let (is_case, names, loads) = (false, Vec::new(), None);
            let opening = Opening { out, format, names, header, identity, loads, fields, force, is_case, beside };
            let start = start.map(|gap| gap.mapv_into_any(T::lit));
            let (table, course) = course.open(opening, start, &nodes, &processes)?;
            let rows = table.read(&processes)?;
            Ok((course, table, processes, rows))
        };
        let (course, table, processes, rows) = py.detach(|| at.pool.get().install(open)).map_err(refusal_of_table)?;
        (self.course, self.table) = (Some(course), Some((table, processes)));
        let rows: Vec<Vec<&Value>> = rows.iter().map(|row| names.iter().map(|&name| &row[name]).collect()).collect();
        let rows = reported(py, &rows)?;
        Ok((names, rows))
    }

    fn next<'py>(&mut self, py: Python<'py>, at: Run<'_>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(mut course) = self.course.clone() else { return Ok(None) };
        if let Some((table, _)) = &mut self.table {
            py.detach(|| table.claim()).map_err(refusal_of_table)?;
        }
        let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| -> asperity::Result<_> {
            let Some(found) = course.next(&mut self.posed, observe)? else { return Ok(None) };
            let (mut found, account) = self.account(course.command(), at.inputs, found)?;
            let row = course.row(&mut found, account, self.seed)?;
            Ok(Some((found, row)))
        })?;
        // a state that was not reached is looked for again from where the ones before lead
        let reached = found.as_ref().ok().and_then(Option::as_ref).filter(|(found, _)| {
            let went_on = raised.is_none() && found.solution.report.status != Status::Stopped;
            went_on && check_finite(&found.solution).is_ok()
        });
        if let Some((table, processes)) = &mut self.table {
            let posed = &mut self.posed;
            let append = |(found, row): &(_, _)| {
                let nodes = *posed.parts()?.1.operator().grid();
                course.append(table, (found, row), &nodes, processes)
            };
            let appended = py.detach(|| reached.map(append).transpose());
            if !matches!(appended, Ok(Some(()))) {
                // for another call that goes on with it
                table.release();
            }
            appended.map_err(refusal_of_table)?;
        }
        if reached.is_some() {
            self.course = Some(course);
        }
        let Some(found) = found.transpose() else { return raised.map_or(Ok(None), Err) };
        let mut entries = None;
        let found = found.map(|(found, row)| (found, entries.insert(row).account.clone()));
        let found = answer(py, self.threads, (found, raised))?;
        found.set_item("row", entries.map(|row| reported(py, &row)).transpose()?)?;
        found.set_item("pace", self.pace())?;
        Ok(Some(found))
    }

    fn pace(&self) -> Pace {
        self.course.as_ref()?.pace().map(|pace| (pace.seconds_left(), pace.told()))
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

/// The problem of a surface with its law in one precision, and the slopes of the surface.
pub fn state<T: Scalar>(
    py: Python<'_>,
    pool: &Pool,
    (surface, formula, hardness, original): (Surface, Formula, Option<Array2<f64>>, Option<Original>),
    (scene, units, scars_removed): (&Scene, Units, Option<f64>),
    threads: Option<usize>,
) -> PyResult<(Box<dyn Solves>, Slopes)> {
    let (strongest, law) = (formula.strongest(), formula.law::<T>());
    let make = || {
        let warnings = warnings_of_input((&surface, None), &scene.elastic, &*law, &units);
        let varying = hardness.as_ref().map(|hardness| hardness.view());
        let mut posed = scene.posed(surface, law, varying, original)?;
        let slopes = posed.slopes()?;
        let (course, seed, table) = (None, None, None);
        let state = State { posed, threads, strongest, units, hardness, warnings, scars_removed, course, seed, table };
        Ok((state, slopes))
    };
    let (state, slopes) = py.detach(|| pool.get().install(make)).map_err(refusal)?;
    Ok((Box::new(state), slopes))
}
