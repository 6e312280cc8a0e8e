//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Arc, Mutex, PoisonError};

use asperity::Surface;
use asperity_maps::Topography;
use asperity_scene::processes::Processes;
use asperity_scene::quantity::LENGTH;
use asperity_scene::theories::Theories;
use asperity_scene::{AnySession, Boundary, Case, Given, Load, Maps, Objects, Skin, Way, either, worded};
use numpy::IntoPyArray;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::functions::symbol_of;
use crate::inputs::{Begin, Map};
use crate::keywords::{Keywords, known, read};
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::{reason, refusal, refusal_of_session};
use crate::running::At;
use crate::state::{self, Answer, Columns, File, Pace};

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    session: Mutex<AnySession>,
    case: Case,
    /// The surface, if further solves are to follow the first
    surface: Option<Arc<Surface>>,
    is_used: bool,
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
        Ok(At { py, pool: Pool::of(self.case.given().threads())?, observer })
    }

    /// The session.
    fn session(&mut self) -> &mut AnySession {
        self.session.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// The case with what is given for several parts of a call.
    fn case(&mut self, parts: &[Given]) -> PyResult<Case> {
        let case = self.case.with(parts).map_err(refusal_of_session)?;
        either!(session = self.session() => session.inputs.given = case.quantities().texts());
        Ok(case)
    }

    /// Poses the problem anew where it has been solved.
    fn renew(&mut self) -> PyResult<()> {
        if std::mem::replace(&mut self.is_used, true) && self.surface.is_some() {
            either!(session = self.session() => session.renew()).map_err(refusal)?;
        }
        Ok(())
    }

    /// The unit of a reduced pressure, if one is among loads that the problem has.
    fn full_pressure(&mut self, at: &At<'_>, loads: &[Load]) -> PyResult<f64> {
        let find = || either!(session = self.session() => session.full_pressure(loads));
        at.pool.install(at.py, find).map_err(refusal_of_session)
    }
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
        let at = At { py, pool: Pool::of(given.threads())?, observer: None };
        let law = law.as_ref().map(|law| (law.formula.clone(), law.adhesion.clone()));
        let (symbol, has_hardness, numbers_are_si) = (symbol.map(symbol_of), hardness.is_some(), *numbers_are_si);
        let objects = Objects { law, symbol, has_hardness, numbers_are_si };
        let case = Case::of(given.clone(), quantities.clone(), objects, Skin::Keywords).map_err(refusal_of_session)?;
        let hardness = hardness.map(|hardness| hardness.to_array()).transpose()?;
        let unit = map.unit.clone();
        let changes = against.is_some() || quantities.is_si() && unit.as_deref().is_some_and(|unit| unit != LENGTH.si);
        let maps = Maps { facing, hardness, ..Maps::of(map.named()?) };
        let maps = Maps { against: against.map(Map::named).transpose()?, ..maps };
        let pose = || case.on(maps, at.pool.threads(), &Processes::start()?);
        let on_maps = at.pool.install(py, pose).map_err(refusal_of_session)?;
        let surface = on_maps.surface.clone();
        let posed = PyDict::new(py);
        posed.set_item("lengths", surface.grid().lengths())?;
        posed.set_item("unit", on_maps.units.length.clone().or(unit))?;
        if changes {
            posed.set_item("heights", Topography::from((*surface).clone()).heights.into_pyarray(py))?;
        }
        let facing = on_maps.inputs.against.clone();
        let beyond_theory = Theories::check(&surface, case.scene()).err().map(|reason| worded(&reason, Skin::Keywords));
        let kept = is_kept.then_some(surface);
        let make = || AnySession::of(on_maps, &Processes::start()?);
        let session = Mutex::new(at.pool.install(py, make).map_err(refusal_of_session)?);
        Ok(Self { session, case, surface: kept, is_used: false, beyond_theory, posed: posed.unbind(), facing })
    }

    /// The equilibrium at a load.
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
    ) -> Answer<'py> {
        self.renew()?;
        let known = known!(LoadKeys, NestedKeys, FindingsKeys, ConductorKeys, AccuracyKeys);
        let (case, started) = (self.case(&[read(&known, keywords)?])?, start.is_some());
        let load = case.load().and_then(|load| case.request(1.0, started).map(|_| load)).map_err(refusal_of_session)?;
        let at = self.at(py, observe)?;
        let asked = case.request(self.full_pressure(&at, &[load])?, started).map_err(refusal_of_session)?;
        either!(session = self.session() => state::solve(session, &at, &asked, start))
    }

    /// The pull-off, with the last state that holds.
    fn pull_off<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
    ) -> Answer<'py> {
        self.renew()?;
        let case = self.case(&[read(&known!(PullOffKeys), keywords)?])?;
        let asked = (case.given().pull_off(), case.given().goal().map_err(reason)?);
        let at = self.at(py, observe)?;
        either!(session = self.session() => state::pull_off(session, &at, asked, start))
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
        let known = match way {
            "cycle" => known!(LoadsKeys, PathKeys, CycleAccuracyKeys),
            "interface" => known!(LoadsKeys, ConductorKeys, LeakageKeys),
            _ => known!(LoadsKeys, FractionsKeys, StiffnessKeys, ConductorKeys, LeakageKeys),
        };
        let parts = keywords.iter().map(|keywords| read(&known, keywords));
        let parts = parts.collect::<PyResult<Vec<_>>>()?;
        let case = self.case(&parts)?;
        let loads = parts.iter().map(|part| part.loads().map_err(reason)).collect::<PyResult<Vec<_>>>()?.concat();
        let is_interface = way == "interface";
        let after = case.after(is_interface).map_err(refusal_of_session)?;
        if is_interface && case.scene().elastic.boundary == Boundary::Free {
            return Err(PyValueError::new_err(
                "boundary is 'free': an interface has its law per area of a periodic cell",
            ));
        }
        let at = self.at(py, observe)?;
        let (full, count) = (self.full_pressure(&at, &loads)?, loads.len());
        let goal = case.given().cycle_goal().map_err(reason)?;
        let way = match way {
            "cycle" => Way::cycle(&loads, full, case.given().path()).map_err(reason)?,
            _ => Way::sweep(&loads, full),
        };
        either!(session = self.session() => {
            session.seed = table.0;
            if let Some(goal) = goal {
                state::refine(session, &at, (&way, goal), start.is_some())?;
            }
            Ok((state::begin(session, &at, (way, after, is_interface), start, table.1)?, count))
        })
    }

    /// The seconds that are left of a cycle that was begun, as far as they are known, and its pace in words.
    fn pace(&mut self) -> Pace {
        either!(session = self.session() => state::pace(session))
    }

    /// The next state of the sweep or the cycle that was begun last; none at its end.
    fn next<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let at = self.at(py, observe)?;
        either!(session = self.session() => state::next(session, &at))
    }

    /// The limits of no range of a cycle at its end, where a coarser grid tells them.
    fn cycle_limit<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let at = self.at(py, observe)?;
        either!(session = self.session() => state::cycle_limit(session, &at))
    }

    /// The stability of a gap under a load, with a known certified error.
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        keywords: &Bound<'py, PyDict>,
        gap: Field<'py>,
        relative_error: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.renew()?;
        let (load, at) = (read(&known!(LoadKeys), keywords)?.load().map_err(reason)?, self.at(py, None)?);
        let control = load.control(self.full_pressure(&at, &[load])?);
        either!(session = self.session() => state::stability(session, &at, control, (gap, relative_error)))
    }
}
