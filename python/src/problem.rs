//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Mutex, PoisonError};

use asperity::path::PathSettings;
use asperity::{Grid, PullOff, Surface};
use asperity_maps::surface_with_absent;
use asperity_scene::processes::Processes;
use asperity_scene::quantity::PRESSURE;
use asperity_scene::{
    Adhesion, AnySession, Asked, Boundary, Branches, Either, Elastic, Input, Inputs, Load, Precision, Scene, Session,
    Skin, Way, either,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::inputs::{Accuracy, Begin, Following, Given, Hardness, after, goal, keys, load, named};
use crate::law::Law;
use crate::numbers::{Field, Scalar};
use crate::pools::Pool;
use crate::refusal::{reason, refusal, refusal_of_heights, refusal_of_session};
use crate::state::{self, At, Columns, File, Pace};

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    session: Mutex<AnySession>,
    threads: Option<usize>,
    nested: Option<bool>,
    other_branch: bool,
}

impl Problem {
    /// The pool of a solve, and the session.
    fn parts(&mut self) -> PyResult<(Pool, &mut AnySession)> {
        Ok((Pool::of(self.threads)?, self.session.get_mut().unwrap_or_else(PoisonError::into_inner)))
    }

    /// The scene.
    fn scene(&mut self) -> &Scene {
        let session = self.session.get_mut().unwrap_or_else(PoisonError::into_inner);
        either!(session = session => session.scene())
    }

    /// The pressure of which a reduced pressure is a part, if one is among loads that the problem has.
    fn full_pressure(&mut self, py: Python<'_>, loads: &[Load]) -> PyResult<f64> {
        let (pool, session) = self.parts()?;
        let find = || either!(session = session => session.full_pressure(loads));
        py.detach(|| pool.get().install(find)).map_err(refusal_of_session)
    }
}

/// The session of a scene, with the slopes of its surface.
fn session<T: Scalar>(
    py: Python<'_>,
    pool: &Pool,
    scene: &Scene,
    input: Input,
    inputs: Inputs,
) -> PyResult<Session<T>> {
    let units = inputs.units();
    let make = || Ok(Session::new(scene, input, inputs, units, &Processes::start()?)?.with_slopes()?);
    py.detach(|| pool.get().install(make)).map_err(refusal_of_session)
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (
        heights, against, lengths, absent_missing, boundary, body, symbol, law, wall, wall_stiffness, hardness, precision,
        tolerance, max_iterations, method, branch, nested, threads, original, part, unit, source, scars_removed, given
    ))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn new(
        py: Python<'_>,
        heights: Field<'_>,
        against: Option<(String, (f64, f64))>,
        lengths: (f64, f64),
        absent_missing: bool,
        boundary: &str,
        body: Bound<'_, PyAny>,
        symbol: Option<(Py<PyAny>, String, bool)>,
        law: &Bound<'_, PyAny>,
        wall: &str,
        wall_stiffness: Option<f64>,
        hardness: Option<Hardness<'_>>,
        precision: &str,
        tolerance: Option<f64>,
        max_iterations: Option<usize>,
        method: &str,
        branch: Option<&str>,
        nested: Option<bool>,
        threads: Option<usize>,
        original: Option<PyRef<'_, crate::original::Original>>,
        part: Option<String>,
        unit: Option<String>,
        source: Option<String>,
        scars_removed: Option<f64>,
        given: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let method = named("method", method, "default or rey2017")?;
        let branch = branch.map(|name| named("branch", name, "loading, unloading or both")).transpose()?;
        let precision = named("precision", precision, "f64 or f32")?;
        let pool = Pool::of(threads)?;
        let heights = heights.to_array()?;
        let boundary = named("boundary", boundary, "periodic or free")?;
        let wall = named("wall", wall, "hard or none, or of springs, as asperity.Penalty(stiffness)")?;
        let original = original.map(|original| original.0);
        let make = if absent_missing { surface_with_absent } else { Surface::new };
        let surface = Grid::new(heights.dim(), lengths).and_then(|grid| make(grid, heights));
        let surface = surface.map_err(refusal_of_heights)?;
        let Law { formula, adhesion, .. } = Law::of(law)?;
        let (hardness, map) = match hardness {
            Some(Hardness::Map(map)) => (None, Some(map.to_array()?)),
            Some(Hardness::Number(hardness)) => (Some(hardness), None),
            None => (None, None),
        };
        let hardness_map = map.as_ref().map(|_| "array".to_owned());
        let adhesion = Adhesion { wall, wall_stiffness, hardness, hardness_map, ..adhesion };
        adhesion.check_wall().map_err(reason)?;
        let elastic = Elastic { boundary, symbol: symbol.map(crate::symbol::symbol), ..keys(body)? };
        elastic.check().map_err(reason)?;
        elastic.body().map_err(refusal)?;
        let scene = Scene { elastic, adhesion, method, precision, tolerance, max_iterations, branch };
        let inputs = Inputs {
            heights: source,
            shift: against.as_ref().map(|(_, shift)| *shift),
            against: against.map(|(name, _)| name),
            part,
            length_unit: unit,
            pressure_unit: given.as_ref().map(|_| PRESSURE.si.to_owned()),
            given: given.map(keys).transpose()?,
            ..scene.inputs(surface.grid().shape(), lengths, pool.threads())
        };
        let input = Input {
            surface: surface.into(),
            formula,
            hardness: map,
            original,
            converted_from: None,
            scars_removed,
            is_strict: false,
            skin: Skin::Keywords,
        };
        let session = match precision {
            Precision::F64 => Either::F64(session(py, &pool, &scene, input, inputs)?),
            Precision::F32 => Either::F32(session(py, &pool, &scene, input, inputs)?),
        };
        Ok(Self { session: Mutex::new(session), threads, nested, other_branch: branch == Some(Branches::Both) })
    }

    /// The equilibrium at a load.
    #[pyo3(signature = (load, start, observe, stability, leave, after, accuracy))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        load: Given,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
        stability: bool,
        leave: bool,
        after: Following,
        accuracy: Accuracy,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (load, goal, scene) = (self::load(&load)?, goal(accuracy)?, self.scene());
        let after = self::after(after, &scene.elastic, &scene.adhesion)?;
        let (fraction, stability, nested, other_branch) =
            (load.fraction(), stability || leave, self.nested, self.other_branch);
        let asked =
            Asked { fraction, nested, other_branch, stability, leave, after, goal, ..Asked::under(load.control(1.0)) };
        let scene = self.scene();
        asked.check(&scene.adhesion, scene.method, start.is_some()).map_err(reason)?;
        let asked = Asked { control: load.control(self.full_pressure(py, &[load])?), ..asked };
        let (threads, (pool, session)) = (self.threads, self.parts()?);
        let at = At { pool: &pool, threads, observer: observe.as_ref() };
        either!(session = session => state::solve(session, py, at, &asked, start))
    }

    /// The pull-off, with the last state that holds.
    #[pyo3(signature = (tolerance, preload, start, observe, accuracy))]
    fn pull_off<'py>(
        &mut self,
        py: Python<'py>,
        tolerance: f64,
        preload: Option<f64>,
        start: Option<Begin<'py>>,
        observe: Option<Py<PyAny>>,
        accuracy: Accuracy,
    ) -> PyResult<Bound<'py, PyDict>> {
        let goal = goal(accuracy)?;
        let asked = PullOff::default().tolerance(tolerance).preload(preload);
        let (threads, (pool, session)) = (self.threads, self.parts()?);
        let at = At { pool: &pool, threads, observer: observe.as_ref() };
        either!(session = session => state::pull_off(session, py, at, (asked, goal), start))
    }

    /// Begins a sweep of loads, or with the settings of a path a cycle through them, or goes on with its table in a file.
    /// Returns the names of its columns, and the cells of the rows that the table has.
    #[pyo3(signature = (loads, start, after, interface, path, seed, table))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn begin<'py>(
        &mut self,
        py: Python<'py>,
        loads: Vec<Given>,
        start: Option<Begin<'py>>,
        after: Following,
        interface: bool,
        path: Option<(usize, f64, f64, bool)>,
        seed: Option<u64>,
        table: Option<File<'py>>,
    ) -> PyResult<Columns<'py>> {
        let loads = loads.iter().map(load).collect::<PyResult<Vec<_>>>()?;
        let scene = self.scene();
        let after = self::after(after, &scene.elastic, &scene.adhesion)?;
        let is_free = scene.elastic.boundary == Boundary::Free;
        let full = self.full_pressure(py, &loads)?;
        let controls = loads.iter().map(|load| load.control(full)).collect();
        let fractions: Vec<_> = loads.iter().copied().filter_map(Load::fraction).collect();
        let way = match path {
            Some((steps, smallest_step, imbalance, smooth)) => {
                let settings = PathSettings::default().steps(steps).smallest_step(smallest_step);
                Way::Cycle(controls, settings.imbalance(imbalance).smooth(smooth))
            }
            None if fractions.is_empty() => Way::Sweep(controls),
            None => Way::Search(fractions),
        };
        if interface && is_free {
            return Err(PyValueError::new_err(
                "boundary is 'free': an interface has its law per area of a periodic cell",
            ));
        }
        let (pool, session) = self.parts()?;
        either!(session = session => {
            session.seed = seed;
            state::begin(session, py, &pool, (way, after, interface), start, table)
        })
    }

    /// The seconds that are left of a cycle that was begun, as far as they are known, and its pace in words.
    fn pace(&mut self) -> PyResult<Pace> {
        Ok(either!(session = self.parts()?.1 => state::pace(session)))
    }

    /// The next state of the sweep or the cycle that was begun last; none at its end.
    #[pyo3(signature = (observe))]
    fn next<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let (threads, (pool, session)) = (self.threads, self.parts()?);
        let at = At { pool: &pool, threads, observer: observe.as_ref() };
        either!(session = session => state::next(session, py, at))
    }

    /// The stability of a gap under a load, of which the certified error is known.
    #[pyo3(signature = (load, gap, relative_error))]
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        load: Given,
        gap: Field<'py>,
        relative_error: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let load = self::load(&load)?;
        let control = load.control(self.full_pressure(py, &[load])?);
        let (pool, session) = self.parts()?;
        either!(session = session => state::stability(session, py, &pool, control, (gap, relative_error)))
    }
}
