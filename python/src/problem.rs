//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Mutex, PoisonError};

use asperity_maps::Topography;
use asperity_scene::theories::Theories;
use asperity_scene::{
    AccuracyKeys, AnyRows, AnySession, Case, ConductorKeys, CycleAccuracyKeys, Entries, FindingsKeys, FractionsKeys,
    Keys, LENGTH, LeakageKeys, Load, LoadKeys, LoadsKeys, Maps, NestedKeys, Objects, PathKeys, Processes, PullOffKeys,
    Skin, StiffnessKeys, Way, either, worded,
};
use numpy::IntoPyArray;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::functions::symbol_of;
use crate::inputs::{Begin, Map};
use crate::keywords::{Keywords, read};
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::{reason, refusal_of_session};
use crate::running::At;
use crate::state::{self, Answer, Columns, File, Pace};

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    /// The session, until its one solve takes it along, if no further solves are to follow
    session: Option<AnySession>,
    is_kept: bool,
    /// The rows that were begun last
    rows: Mutex<Option<AnyRows>>,
    case: Case,
    /// Why theories do not know of it
    #[pyo3(get)]
    beyond_theory: Option<String>,
    /// What posing has changed of the map: its side lengths and its unit, and its heights where they are others
    #[pyo3(get)]
    posed: Py<PyDict>,
    /// The name of the surface on the other side in reports
    #[pyo3(get)]
    facing: Option<String>,
}

impl Problem {
    /// The place of its solves.
    fn at<'py>(&self, py: Python<'py>, observer: Option<Py<PyAny>>) -> PyResult<At<'py>> {
        Ok(At { py, pool: Pool::new(self.case.given().threads())?, observer })
    }

    /// The case and the session of a call, with what is given for several parts of it.
    fn called(&mut self, parts: &[Entries]) -> PyResult<(Case, AnySession)> {
        let case = self.case.with(parts).map_err(refusal_of_session)?;
        let session = if self.is_kept { self.session.clone() } else { self.session.take() };
        let mut session =
            session.ok_or_else(|| PyValueError::new_err("the problem was solved before: make it anew"))?;
        either!(session = &mut session => session.facts.inputs.given = case.quantities().texts());
        Ok((case, session))
    }

    /// The rows that were begun last.
    fn rows(&mut self) -> PyResult<&mut AnyRows> {
        let rows = self.rows.get_mut().unwrap_or_else(PoisonError::into_inner);
        rows.as_mut().ok_or_else(|| PyValueError::new_err("there are no loads to follow: begin first"))
    }
}

/// The unit of a reduced pressure, if one is among loads that the problem has.
fn full_pressure(session: &AnySession, at: &At<'_>, loads: &[Load]) -> PyResult<f64> {
    let find = || either!(session = session => session.full_pressure(loads));
    // a reduced pressure alone needs the slopes of the surface
    let is_reduced = loads.iter().any(|load| matches!(load, Load::Reduced(_)));
    if is_reduced { at.pool.install(at.py, find) } else { find() }.map_err(refusal_of_session)
}

#[pymethods]
impl Problem {
    /// The problem of a map, with that of the surface on the other side, or its name where the heights are between both
    /// already, and the hardness at its nodes.
    #[new]
    fn new(
        py: Python<'_>,
        map: Map<'_>,
        other: (Option<Map<'_>>, Option<String>),
        hardness: Option<Field<'_>>,
        keywords: &Keywords,
        symbol: Option<(Py<PyAny>, String, bool)>,
        is_kept: bool,
    ) -> PyResult<Self> {
        let (Keywords { given, law, quantities, numbers_are_si }, (against, facing)) = (keywords, other);
        let at = At { py, pool: Pool::new(given.threads())?, observer: None };
        let law = law.as_ref().map(|law| (law.formula.clone(), law.adhesion.clone()));
        let (symbol, has_hardness, numbers_are_si) = (symbol.map(symbol_of), hardness.is_some(), *numbers_are_si);
        let objects = Objects { law, symbol, has_hardness, numbers_are_si };
        let case = Case::new(given.clone(), quantities.clone(), objects, Skin::Keywords).map_err(refusal_of_session)?;
        let hardness = hardness.map(|hardness| hardness.to_array()).transpose()?;
        let (unit_of_map, lengths_of_map) = (map.unit.clone(), map.lengths);
        let changes =
            against.is_some() || quantities.is_si() && unit_of_map.as_deref().is_some_and(|unit| unit != LENGTH.si);
        let maps = Maps { facing, hardness, ..Maps::new(map.named()?) };
        let maps = Maps { against: against.map(Map::named).transpose()?, ..maps };
        // at one go, as each way to the pool and back takes longer than many a check
        let pose = || {
            let processes = Processes::start()?;
            let posed = case.on(maps, at.pool.threads(), &processes)?;
            let (lengths, unit) = (posed.surface.grid().lengths(), posed.units.length.clone());
            let heights = changes.then(|| Topography::from((*posed.surface).clone()).heights);
            let (facing, theories) = (posed.inputs.against.clone(), Theories::check(&posed.surface, case.scene()));
            Ok((AnySession::new(posed, &processes)?, (lengths, unit, heights), facing, theories))
        };
        let (session, (lengths, unit, heights), facing, theories) =
            at.pool.install(py, pose).map_err(refusal_of_session)?;
        let posed = PyDict::new(py);
        if lengths_of_map != Some(lengths) {
            posed.set_item("lengths", lengths)?;
        }
        if unit.is_some() && unit != unit_of_map {
            posed.set_item("unit", unit)?;
        }
        if let Some(heights) = heights {
            posed.set_item("heights", heights.into_pyarray(py))?;
        }
        let beyond_theory = theories.err().map(|reason| worded(&reason, Skin::Keywords));
        let (session, rows, posed) = (Some(session), Mutex::new(None), posed.unbind());
        Ok(Self { session, is_kept, rows, case, beyond_theory, posed, facing })
    }

    /// The equilibrium at a load.
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
    ) -> Answer<'py> {
        let lists = [LoadKeys::KEYS, NestedKeys::KEYS, FindingsKeys::KEYS, ConductorKeys::KEYS, AccuracyKeys::KEYS];
        let ((case, session), started) = (self.called(&[read(&lists, keywords)?])?, start.is_some());
        let load = case.load().and_then(|load| case.request(1.0, started).map(|_| load)).map_err(refusal_of_session)?;
        let at = self.at(py, observe)?;
        let asked = case.request(full_pressure(&session, &at, &[load])?, started).map_err(refusal_of_session)?;
        either!(session = session => state::solve(session, &at, &asked, start))
    }

    /// The pull-off, with the last state that holds.
    fn pull_off<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
    ) -> Answer<'py> {
        let (case, session) = self.called(&[read(&[PullOffKeys::KEYS], keywords)?])?;
        let asked = (case.given().pull_off(), case.given().goal().map_err(reason)?);
        let at = self.at(py, observe)?;
        either!(session = session => state::pull_off(session, &at, asked, start))
    }

    /// Begins a sweep, the law of an interface or a cycle, through several lists of loads, or continues its table in a
    /// file. Returns the names of its columns, the rows that the table has, and the number of loads.
    fn begin<'py>(
        &mut self,
        py: Python<'py>,
        way: &str,
        keywords: Vec<Bound<'py, PyDict>>,
        start: Option<Begin<'py>>,
        table: (Option<u64>, Option<File<'py>>),
        observe: Option<Py<PyAny>>,
    ) -> PyResult<(Columns<'py>, usize)> {
        let lists = match way {
            "cycle" => &[LoadsKeys::KEYS, PathKeys::KEYS, CycleAccuracyKeys::KEYS][..],
            "interface" => &[LoadsKeys::KEYS, ConductorKeys::KEYS, LeakageKeys::KEYS],
            _ => &[LoadsKeys::KEYS, FractionsKeys::KEYS, StiffnessKeys::KEYS, ConductorKeys::KEYS, LeakageKeys::KEYS],
        };
        let parts = keywords.iter().map(|keywords| read(lists, keywords));
        let parts = parts.collect::<PyResult<Vec<_>>>()?;
        let (case, session) = self.called(&parts)?;
        let loads = parts.iter().map(|part| part.loads().map_err(reason)).collect::<PyResult<Vec<_>>>()?.concat();
        let is_interface = way == "interface";
        let after = case.after(is_interface).map_err(refusal_of_session)?;
        let at = self.at(py, observe)?;
        let (full, count) = (full_pressure(&session, &at, &loads)?, loads.len());
        let goal = case.given().cycle_goal().map_err(reason)?;
        let way = match way {
            "cycle" => Way::cycle(&loads, full, case.given().path()).map_err(reason)?,
            _ => Way::sweep(&loads, full),
        };
        // the rows before, if there are some, may have the same file
        self.rows = Mutex::new(None);
        let (seed, file) = table;
        let asked = state::Along { way, after, is_interface, goal, seed, file };
        let (rows, columns) = match session {
            AnySession::F32(session) => {
                let (rows, columns) = state::begin(session, &at, asked, start)?;
                (AnyRows::F32(rows), columns)
            }
            AnySession::F64(session) => {
                let (rows, columns) = state::begin(session, &at, asked, start)?;
                (AnyRows::F64(rows), columns)
            }
        };
        self.rows = Mutex::new(Some(rows));
        Ok((columns, count))
    }

    /// The seconds that are left of a cycle that was begun, as far as they are known, and its pace in words.
    fn pace(&mut self) -> PyResult<Pace> {
        Ok(either!(rows = self.rows()? => state::pace(rows)))
    }

    /// The next state of the sweep or the cycle that was begun last; none at its end.
    fn next<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let at = self.at(py, observe)?;
        either!(rows = self.rows()? => state::next(rows, &at))
    }

    /// The limits of no range of a cycle at its end, where a coarser grid tells them.
    fn cycle_limit<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let at = self.at(py, observe)?;
        either!(rows = self.rows()? => state::cycle_limit(rows, &at))
    }

    /// The stability of a gap under a load, with a known certified error.
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        gap: Field<'py>,
        relative_error: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ((_, session), at) = (self.called(&[])?, self.at(py, None)?);
        let load = read(&[LoadKeys::KEYS], keywords)?.load().map_err(reason)?;
        let control = load.control(full_pressure(&session, &at, &[load])?);
        either!(session = session => state::stability(session, &at, control, (gap, relative_error)))
    }
}
