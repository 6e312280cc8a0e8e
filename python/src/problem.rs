//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Arc, Mutex, PoisonError};

use asperity::Surface;
use asperity::contact::Original;
use asperity_scene::processes::Processes;
use asperity_scene::quantity::PRESSURE;
use asperity_scene::theories::Theories;
use asperity_scene::{
    Adhesion, After, AnySession, Boundary, Either, Given, Input, Inputs, Load, Precision, Quantities, Scene, Session,
    Skin, Way, either, worded,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::functions::symbol_of;
use crate::inputs::{Begin, Map, surface};
use crate::keywords::{Keywords, known, quantities_of, read};
use crate::law::Law;
use crate::numbers::{Field, Scalar};
use crate::pools::Pool;
use crate::refusal::{reason, refusal, refusal_of_session};
use crate::running::At;
use crate::state::{self, Answer, Columns, File, Pace};

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    session: Mutex<AnySession>,
    given: Given,
    quantities: Quantities,
    numbers_are_si: bool,
    /// The surface, if further solves are to follow the first
    surface: Option<Arc<Surface>>,
    is_used: bool,
    /// Why theories do not know of it
    #[pyo3(get)]
    beyond_theory: Option<String>,
}

impl Problem {
    /// The place of its solves.
    fn at<'py>(&self, py: Python<'py>, observer: Option<Py<PyAny>>) -> PyResult<At<'py>> {
        Ok(At { py, pool: Pool::of(self.given.threads())?, observer })
    }

    /// The session.
    fn session(&mut self) -> &mut AnySession {
        self.session.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// The scene.
    fn scene(&mut self) -> &Scene {
        either!(session = self.session() => session.scene())
    }

    /// What was given for the problem and for several parts of a call: all quantities have units, or none has.
    fn given(&mut self, parts: &[Given]) -> PyResult<Given> {
        let of_call = parts.iter().map(|part| quantities_of(part, self.numbers_are_si));
        let quantities = Quantities::all(std::iter::once(self.quantities.clone()).chain(of_call));
        if !self.numbers_are_si {
            quantities.check(Skin::Keywords).map_err(reason)?;
        }
        either!(session = self.session() => session.inputs.given = quantities.given());
        Ok(Given::all(std::iter::once(&self.given).chain(parts)))
    }

    /// Poses the problem anew where it has been solved.
    fn renew(&mut self) -> PyResult<()> {
        if std::mem::replace(&mut self.is_used, true) && self.surface.is_some() {
            either!(session = self.session() => session.renew()).map_err(refusal)?;
        }
        Ok(())
    }

    /// The findings that are asked for after a state, of an interface with its stiffness.
    fn after(&mut self, given: &Given, is_interface: bool) -> PyResult<After> {
        let (after, scene) = (given.after().map_err(reason)?, self.scene());
        let after = After { stiffness: after.stiffness || is_interface, ..after };
        after.check(&scene.elastic, &scene.adhesion).map_err(reason)?;
        Ok(after)
    }

    /// The pressure of which a reduced pressure is a part, if one is among loads that the problem has.
    fn full_pressure(&mut self, at: &At<'_>, loads: &[Load]) -> PyResult<f64> {
        let find = || either!(session = self.session() => session.full_pressure(loads));
        at.pool.install(at.py, find).map_err(refusal_of_session)
    }
}

/// The session of a scene, with the slopes of its surface.
fn session<T: Scalar>(at: &At<'_>, scene: &Scene, input: Input, inputs: Inputs) -> PyResult<Session<T>> {
    let units = inputs.units();
    let make = || Ok(Session::new(scene, input, inputs, units, &Processes::start()?)?.with_slopes()?);
    at.pool.install(at.py, make).map_err(refusal_of_session)
}

#[pymethods]
impl Problem {
    /// The problem of a map, with the name and the shift of the surface on the other side, and the hardness at its nodes.
    #[new]
    fn new(
        py: Python<'_>,
        map: Map<'_>,
        against: Option<(String, (f64, f64))>,
        hardness: Option<Field<'_>>,
        keywords: &Keywords,
        symbol: Option<(Py<PyAny>, String, bool)>,
        is_kept: bool,
    ) -> PyResult<Self> {
        let Keywords { given, law, quantities, numbers_are_si } = keywords;
        let (given, quantities, numbers_are_si) = (given.clone(), quantities.clone(), *numbers_are_si);
        let mut scene = given.scene().map_err(reason)?;
        let at = At { py, pool: Pool::of(given.threads())?, observer: None };
        let surface = surface(map.heights.to_array()?, map.lengths, given.absent_missing())?;
        let original = map.original.map(|nodes| Original::new(surface.grid(), nodes)).transpose().map_err(refusal)?;
        // with a free boundary the images belong to the body
        let is_whole = given.whole() || scene.elastic.boundary == Boundary::Free;
        let hardness = hardness.map(|hardness| hardness.to_array()).transpose()?;
        scene.adhesion.hardness_map = hardness.as_ref().map(|_| "array".to_owned());
        let formula = match law {
            Some(Law { formula, adhesion, .. }) => {
                let Adhesion { wall, wall_stiffness, hardness, hardness_map, .. } = scene.adhesion;
                scene.adhesion = Adhesion { wall, wall_stiffness, hardness, hardness_map, ..adhesion.clone() };
                scene.adhesion.check_wall().map_err(reason)?;
                formula.clone()
            }
            None => {
                scene.adhesion.check().map_err(reason)?;
                scene.adhesion.formula(None).map_err(refusal)?
            }
        };
        scene.elastic.symbol = symbol.map(symbol_of);
        scene.elastic.check().map_err(reason)?;
        scene.elastic.body().map_err(refusal)?;
        let inputs = Inputs {
            heights: map.source,
            shift: against.as_ref().map(|(_, shift)| *shift),
            against: against.map(|(name, _)| name),
            part: original.map(|_| if is_whole { "whole" } else { "original" }.to_owned()),
            length_unit: map.unit,
            pressure_unit: quantities.is_si().then(|| PRESSURE.si.to_owned()),
            given: quantities.given(),
            ..scene.inputs(surface.grid().shape(), map.lengths, at.pool.threads())
        };
        let surface = Arc::new(surface);
        let kept = is_kept.then(|| surface.clone());
        let beyond_theory = Theories::check(&surface, &scene).err().map(|reason| worded(&reason, Skin::Keywords));
        let input = Input {
            surface,
            formula,
            hardness,
            original: original.filter(|_| !is_whole),
            converted_from: None,
            scars_removed: map.scars_removed,
            is_strict: false,
            skin: Skin::Keywords,
        };
        let session = match scene.precision {
            Precision::F64 => Either::F64(session(&at, &scene, input, inputs)?),
            Precision::F32 => Either::F32(session(&at, &scene, input, inputs)?),
        };
        let session = Mutex::new(session);
        Ok(Self { session, given, quantities, numbers_are_si, surface: kept, is_used: false, beyond_theory })
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
        let given = self.given(&[read(&known, keywords)?])?;
        self.after(&given, false)?;
        let load = given.load().map_err(reason)?;
        let scene = self.scene();
        let asked = given.asked(load, 1.0).map_err(reason)?;
        asked.check(&scene.adhesion, scene.method, start.is_some()).map_err(reason)?;
        let at = self.at(py, observe)?;
        let asked = given.asked(load, self.full_pressure(&at, &[load])?).map_err(reason)?;
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
        let given = self.given(&[read(&known!(PullOffKeys), keywords)?])?;
        let asked = (given.pull_off(), given.goal().map_err(reason)?);
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
    ) -> PyResult<(Columns<'py>, usize)> {
        let known = match way {
            "cycle" => known!(LoadsKeys, PathKeys),
            "interface" => known!(LoadsKeys, ConductorKeys, LeakageKeys),
            _ => known!(LoadsKeys, FractionsKeys, StiffnessKeys, ConductorKeys, LeakageKeys),
        };
        let parts = keywords.iter().map(|keywords| read(&known, keywords));
        let parts = parts.collect::<PyResult<Vec<_>>>()?;
        let given = self.given(&parts)?;
        let loads = parts.iter().map(|part| part.loads().map_err(reason)).collect::<PyResult<Vec<_>>>()?.concat();
        let is_interface = way == "interface";
        let after = self.after(&given, is_interface)?;
        if is_interface && self.scene().elastic.boundary == Boundary::Free {
            return Err(PyValueError::new_err(
                "boundary is 'free': an interface has its law per area of a periodic cell",
            ));
        }
        let at = self.at(py, None)?;
        let (full, count) = (self.full_pressure(&at, &loads)?, loads.len());
        let way = match way {
            "cycle" => Way::cycle(&loads, full, given.path()).map_err(reason)?,
            _ => Way::sweep(&loads, full),
        };
        either!(session = self.session() => {
            session.seed = table.0;
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
