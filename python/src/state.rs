//! The session of a problem as Python drives it: without the interpreter's lock, and open to Ctrl-C.

use std::path::{Path, PathBuf};

use asperity::{Control, PullOff};
use asperity_scene::output::{check_apart, check_free, with_suffix};
use asperity_scene::warnings::check_beside;
use asperity_scene::{After, Asked, Goal, Next, Session, Skin, TableFile, Way};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use serde_pyobject::to_pyobject;

use crate::answer::answer;
use crate::inputs::Begin;
use crate::numbers::{Field, Scalar};
use crate::pools::Pool;
use crate::refusal::{refusal, refusal_of_session};
use crate::report::reported;
use crate::running::{Observe, run};

/// The file of a table as Python passes it: its path, the folder for fields, whether to start over, the gaps and
/// tractions and the works of adhesion of the law, and whether it is another law than those of its name.
pub type File<'py> = (PathBuf, Option<PathBuf>, bool, Option<Field<'py>>, Option<Field<'py>>, bool);

/// The names of the columns of a table, and the cells of its rows.
pub type Columns<'py> = (Vec<&'static str>, Bound<'py, PyAny>);

/// The seconds that are left of a cycle, as far as they are known, and its pace in words.
pub type Pace = Option<(Option<f64>, String)>;

/// The threads and the observer of a solve.
pub struct At<'a> {
    pub pool: &'a Pool,
    pub threads: Option<usize>,
    pub observer: Option<&'a Py<PyAny>>,
}

/// The nodes in the shortest wave, tolerance, shape, bytes and seconds of a plan.
type Planned = (f64, f64, (usize, usize), f64, f64);

/// The gap from which a solve under a load starts, if it is given.
fn start<T: Scalar>(
    session: &mut Session<T>,
    given: Option<Begin<'_>>,
    load: Option<Control>,
) -> PyResult<Option<Array2<f64>>> {
    session.inputs.initial_gap = given.as_ref().map(Begin::word).map(str::to_owned);
    match (given, load) {
        (Some(Begin::Gap(gap)), _) => Ok(Some(gap.as_array().to_owned())),
        (Some(Begin::Word(word)), Some(load)) if word == "apart" => {
            session.apart(load).map(Some).map_err(refusal_of_session)
        }
        (Some(Begin::Word(word)), _) => {
            let remedy = "it must be 'apart', with a load that is given, an array of gaps, or a solution";
            Err(PyValueError::new_err(format!("start is '{word}': {remedy}")))
        }
        (None, _) => Ok(None),
    }
}

/// The plan of a solve to an accuracy, which the logger `asperity` says.
fn plan<T: Scalar>(
    session: &mut Session<T>,
    py: Python<'_>,
    pool: &Pool,
    control: Control,
    goal: Goal,
) -> PyResult<Planned> {
    let (plan, seconds) = py.detach(|| pool.get().install(move || session.plan(control, goal))).map_err(refusal)?;
    let log = py.import("logging")?.call_method1("getLogger", ("asperity",))?;
    log.call_method1("info", (goal.announced(&plan, seconds),))?;
    Ok((plan.nodes_per_wave, plan.tolerance, plan.shape, plan.bytes, seconds))
}

/// The equilibrium under a load.
pub fn solve<'py, T: Scalar>(
    session: &mut Session<T>,
    py: Python<'py>,
    at: At<'_>,
    asked: &Asked,
    begin: Option<Begin<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let start = start(session, begin, Some(asked.control))?.map(T::field);
    let plan = asked.goal.map(|goal| plan(session, py, at.pool, asked.control, goal)).transpose()?;
    let (solved, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| {
        session.solve(asked, start, &mut |_, state, _| observe(state))
    })?;
    let found = answer(py, at.threads, solved.map(|solved| (solved.found, solved.account)), raised)?;
    found.set_item("plan", plan)?;
    Ok(found)
}

/// The pull-off, with the last state that holds.
pub fn pull_off<'py, T: Scalar>(
    session: &mut Session<T>,
    py: Python<'py>,
    at: At<'_>,
    (asked, goal): (PullOff, Option<Goal>),
    begin: Option<Begin<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let start = start(session, begin, None)?.map(T::field);
    let (found, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| {
        let (last, pulled_off) = session.pull_off(asked, goal, start, &mut |_, state, _| observe(state))?;
        let shortfall = pulled_off.shortfall(&last.account, Skin::Keywords);
        Ok(((last.found, last.account), (pulled_off, shortfall)))
    })?;
    let (last, pulled_off) = found.map_or_else(|error| (Err(error), None), |(last, of)| (Ok(last), Some(of)));
    let answer = answer(py, at.threads, last, raised)?;
    if let Some((pulled_off, shortfall)) = pulled_off {
        answer.set_item("pull_off", reported(py, &pulled_off)?)?;
        answer.set_item("shortfall", shortfall)?;
    }
    Ok(answer)
}

/// Begins a way through loads, or goes on with its table in a file.
pub fn begin<'py, T: Scalar>(
    session: &mut Session<T>,
    py: Python<'py>,
    pool: &Pool,
    (way, after, is_interface): (Way, After, bool),
    begin: Option<Begin<'py>>,
    file: Option<File<'py>>,
) -> PyResult<Columns<'py>> {
    let start = start(session, begin, way.loads().first().copied())?;
    let owned = |given: Option<Field<'_>>| given.map(|given| given.as_array().to_owned());
    let file = file.map(|(out, fields, force, law_table, works, law_differs)| {
        let (law_table, works) = (owned(law_table), owned(works));
        TableFile { out, fields, force, law_table, works, law_differs, ..TableFile::default() }
    });
    let open = || {
        if let Some(TableFile { out, force, .. }) = &file {
            check_apart(out, session.inputs.heights.as_deref().map(Path::new))?;
            let force = *force || out.exists();
            check_free(&with_suffix(out, ".scene.toml"), force, "--out")?;
            check_beside(out, force)?;
        }
        session.begin(way, after, is_interface, start, file)?;
        Ok((session.columns(), session.read()?))
    };
    let (names, rows) = py.detach(|| pool.get().install(open)).map_err(refusal_of_session)?;
    let rows: Vec<Vec<&Value>> = rows.iter().map(|row| names.iter().map(|&name| &row[name]).collect()).collect();
    let rows = reported(py, &rows)?;
    Ok((names, rows))
}

/// The next state; none at the end.
pub fn next<'py, T: Scalar>(
    session: &mut Session<T>,
    py: Python<'py>,
    at: At<'_>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let before = session.rows();
    let (sought, raised) = run(py, at.pool, at.observer, |observe: Observe<'_>| session.seek(observe))?;
    let goes_on = raised.is_none();
    // a state that was not reached is looked for again from where the ones before lead
    let keep = |next: Next<T>| if goes_on { session.keep(next) } else { Ok((next.found, next.row)) };
    let found = py.detach(|| sought.and_then(|next| next.map(keep).transpose()));
    if session.rows() == before {
        // for another call that goes on with it
        session.release();
    }
    let Some(found) = found.transpose() else { return raised.map_or(Ok(None), Err) };
    let mut entries = None;
    let found = found.map(|(found, row)| (found, entries.insert(row).account.clone()));
    let found = answer(py, at.threads, found, raised)?;
    found.set_item("row", entries.map(|row| reported(py, &row)).transpose()?)?;
    found.set_item("pace", pace(session))?;
    Ok(Some(found))
}

/// The seconds that are left of a cycle, and its pace in words.
pub fn pace<T: Scalar>(session: &Session<T>) -> Pace {
    session.pace().map(|pace| (pace.seconds_left(), pace.told()))
}

/// The stability of a gap under a load, of which the certified error is known.
pub fn stability<'py, T: Scalar>(
    session: &mut Session<T>,
    py: Python<'py>,
    pool: &Pool,
    control: Control,
    (gap, relative_error): (Field<'py>, f64),
) -> PyResult<Bound<'py, PyAny>> {
    let gap = gap.as_array().mapv(T::lit);
    let test = || session.stability(control, &gap, relative_error);
    let (found, mode) = py.detach(|| pool.get().install(test)).map_err(refusal)?;
    let entries = to_pyobject(py, &found)?;
    entries.set_item("mode", mode.into_pyarray(py))?;
    Ok(entries)
}
