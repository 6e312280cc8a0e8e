//! The session of a problem as Python drives it: without the interpreter's lock, and open to Ctrl-C.

use std::path::{Path, PathBuf};

use asperity::{Control, PullOff};
use asperity_scene::output::{check_apart, check_free, with_suffix};
use asperity_scene::warnings::check_beside;
use asperity_scene::{After, Goal, Next, Request, Rows, Session, Skin, TableFile, Way};
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::answer::answer;
use crate::inputs::Begin;
use crate::numbers::{Field, Scalar};
use crate::refusal::{refusal, refusal_of_session};
use crate::report::reported;
use crate::running::At;

/// The dictionary of what was found.
pub type Answer<'py> = PyResult<Bound<'py, PyDict>>;

/// The file of a table as Python passes it: its path, the folder for fields, whether to start over, the gaps and
/// tractions and the works of adhesion of the law, and whether it differs from the laws of its name.
pub type File<'py> = (PathBuf, Option<PathBuf>, bool, Option<Field<'py>>, Option<Field<'py>>, bool);

/// The names of the columns of a table, and its rows.
pub type Columns<'py> = (Vec<&'static str>, Bound<'py, PyAny>);

/// The seconds that are left of a cycle, as far as they are known, and its pace in words.
pub type Pace = Option<(Option<f64>, String)>;

/// The gap from which a solve under a load starts, if it is given.
fn start<T: Scalar>(
    session: &mut Session<T>,
    given: Option<Begin<'_>>,
    load: Option<Control>,
) -> PyResult<Option<Array2<f64>>> {
    session.facts.inputs.initial_gap = given.as_ref().map(Begin::word).map(str::to_owned);
    match (given, load) {
        (None, _) => Ok(None),
        (Some(Begin::Gap(gap)), _) => session.start(gap.to_array()?).map(Some).map_err(refusal_of_session),
        (Some(Begin::Word(word)), Some(load)) if word == "apart" => {
            session.apart(load).map(Some).map_err(refusal_of_session)
        }
        (Some(Begin::Word(word)), _) => Err(PyValueError::new_err(format!(
            "start is '{word}': it must be 'apart', with a load that is given, an array of gaps, or a solution"
        ))),
    }
}

/// The equilibrium under a load; of an accuracy with its plan, which the logger `asperity` says.
pub fn solve<'py, T: Scalar>(
    mut session: Session<T>,
    at: &At<'py>,
    asked: &Request,
    begin: Option<Begin<'py>>,
) -> Answer<'py> {
    let start = start(&mut session, begin, Some(asked.control))?.map(T::field);
    let mut planned = None;
    if let Some(goal) = asked.goal {
        let plan = at.pool.install(at.py, || session.plan(asked.control, goal)).map_err(refusal)?;
        let (plan, seconds) = planned.insert(plan);
        log(at, goal.announced(plan, *seconds))?;
    }
    let (solved, raised) = at.run(|observe, _| session.solve(asked, start, &mut |_, state, _| observe(state)))?;
    let found = answer(at, solved.map(|solved| (solved.found, solved.account)), raised)?;
    let of = planned.map(|(plan, seconds)| (plan.nodes_per_wave, plan.tolerance, plan.shape, plan.bytes, seconds));
    found.set_item("plan", of)?;
    Ok(found)
}

/// Says a plan by the logger `asperity`.
fn log(at: &At<'_>, plan: String) -> PyResult<()> {
    let log = at.py.import("logging")?.call_method1("getLogger", ("asperity",))?;
    log.call_method1("info", (plan,)).map(drop)
}

/// Puts a session on the grid on which a cycle is likely to have an accuracy, which the logger `asperity` says.
fn refine<T: Scalar>(
    session: &mut Session<T>,
    at: &At<'_>,
    (way, goal): (&Way, Goal),
    is_started: bool,
) -> PyResult<()> {
    let (chosen, raised) =
        at.run(|observe, _| session.refine(way, goal, is_started, &mut |_, state, _| observe(state)))?;
    raised.map_or(Ok(()), Err)?;
    log(at, chosen.map_err(refusal_of_session)?)
}

/// The pull-off, with the last state that holds.
pub fn pull_off<'py, T: Scalar>(
    mut session: Session<T>,
    at: &At<'py>,
    (asked, goal): (PullOff, Option<Goal>),
    begin: Option<Begin<'py>>,
) -> Answer<'py> {
    let start = start(&mut session, begin, None)?.map(T::field);
    let (found, raised) =
        at.run(|observe, _| session.pull_off(asked, goal, start, &mut |_, state, _| observe(state)))?;
    let mut of = None;
    let last = found.map(|(last, pulled_off)| {
        of = Some((pulled_off.shortfall(&last.account, Skin::Keywords), pulled_off));
        (last.found, last.account)
    });
    let answer = answer(at, last, raised)?;
    if let Some((shortfall, pulled_off)) = of {
        answer.set_item("pull_off", reported(at.py, &pulled_off)?)?;
        answer.set_item("shortfall", shortfall)?;
    }
    Ok(answer)
}

/// What is asked for along loads.
pub struct Along<'py> {
    pub way: Way,
    pub after: After,
    pub is_interface: bool,
    pub goal: Option<Goal>,
    pub seed: Option<u64>,
    pub file: Option<File<'py>>,
}

/// Begins a way through loads, or continues its table in a file: the names of its columns, and the rows that it has.
pub fn begin<'py, T: Scalar>(
    mut session: Session<T>,
    at: &At<'py>,
    along: Along<'py>,
    begin: Option<Begin<'py>>,
) -> PyResult<(Rows<T>, Columns<'py>)> {
    let Along { way, after, is_interface, goal, seed, file } = along;
    session.facts.seed = seed;
    if let Some(goal) = goal {
        refine(&mut session, at, (&way, goal), begin.is_some())?;
    }
    let start = start(&mut session, begin, way.loads().first().copied())?;
    let owned = |given: Option<Field<'_>>| given.map(|given| given.as_array().to_owned());
    let file = file.map(|(out, fields, force, law_table, works, law_differs)| {
        let (law_table, works) = (owned(law_table), owned(works));
        TableFile { out, fields, force, law_table, works, law_differs, ..TableFile::default() }
    });
    let open = || {
        if let Some(TableFile { out, force, .. }) = &file {
            check_apart(out, session.facts.inputs.heights.as_deref().map(Path::new))?;
            let force = *force || out.exists();
            check_free(&with_suffix(out, ".scene.toml"), force, "--out")?;
            check_beside(out, force)?;
        }
        let rows = session.begin(way, after, is_interface, start, file)?;
        let known = rows.read()?;
        Ok((rows, known))
    };
    let (rows, known) = at.pool.install(at.py, open).map_err(refusal_of_session)?;
    let columns = (rows.columns(), reported(at.py, &known)?);
    Ok((rows, columns))
}

/// The next state; none at the end.
pub fn next<'py, T: Scalar>(rows: &mut Rows<T>, at: &At<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
    let before = rows.count();
    let (sought, raised) = at.run(|observe, _| rows.seek(observe))?;
    let goes_on = raised.is_none();
    // a state that was not reached is looked for again from where the ones before lead
    let keep = |next: Next<T>| if goes_on { rows.keep(next) } else { Ok((next.found, next.row)) };
    let found = at.py.detach(|| sought.and_then(|next| next.map(keep).transpose()));
    if rows.count() == before {
        // for another call that continues it
        rows.release();
    }
    let Some(found) = found.transpose() else { return raised.map_or(Ok(None), Err) };
    let mut entries = None;
    let found = answer(at, found.map(|(found, row)| (found, entries.insert(row).account.clone())), raised)?;
    found.set_item("row", entries.map(|row| reported(at.py, &row)).transpose()?)?;
    found.set_item("pace", pace(rows))?;
    Ok(Some(found))
}

/// The limits of no range of a cycle at its end, where a coarser grid tells them.
pub fn cycle_limit<'py, T: Scalar>(rows: &mut Rows<T>, at: &At<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
    let (found, raised) = at.run(|observe, _| rows.cycle_limit(observe))?;
    raised.map_or(Ok(()), Err)?;
    let Some(limit) = found.map_err(refusal_of_session)? else { return Ok(None) };
    Ok(Some(to_pyobject(at.py, &(limit.shortfall(Skin::Keywords), limit))?))
}

/// The seconds that are left of a cycle, and its pace in words.
pub fn pace<T: Scalar>(rows: &Rows<T>) -> Pace {
    rows.pace().map(|pace| (pace.seconds_left(), pace.describe()))
}

/// The stability of a gap under a load, with a known certified error.
pub fn stability<'py, T: Scalar>(
    session: Session<T>,
    at: &At<'py>,
    control: Control,
    (gap, relative_error): (Field<'py>, f64),
) -> PyResult<Bound<'py, PyAny>> {
    let gap = gap.as_array().mapv(T::lit);
    let test = || session.on_one_grid()?.stability(control, &gap, relative_error);
    let (found, mode) = at.pool.install(at.py, test).map_err(refusal)?;
    let entries = to_pyobject(at.py, &found)?;
    entries.set_item("mode", mode.into_pyarray(at.py))?;
    Ok(entries)
}
