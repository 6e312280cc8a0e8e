//! A contact problem, solved once, along loads, or along a path of equilibria.

use std::sync::{Mutex, PoisonError};

use asperity::path::PathSettings;
use asperity::{Control, Grid, Surface};
use asperity_scene::quantity::PRESSURE;
use asperity_scene::{Adhesion, Asked, Branches, Inputs, Skin, Way, check_part, settings};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::inputs::{Accuracy, Load, contact_fraction, control, goal, keys, named};
use crate::law::Law;
use crate::numbers::Field;
use crate::pools::Pool;
use crate::refusal::refusal_of_heights;
use crate::state::{Run, Solves, state};

/// The nodes in the shortest wave, tolerance, shape, bytes and seconds of a plan, and the plan in words.
type Planned = ((f64, f64, (usize, usize), f64, f64), String);

/// The words of Python for a key.
fn word(key: &str) -> String {
    if key == "wall_stiffness" { "a stiffness, as of asperity.Penalty(stiffness)" } else { key }.to_owned()
}

/// A contact problem.
#[pyclass(module = "asperity._asperity")]
pub struct Problem {
    solves: Mutex<Box<dyn Solves>>,
    threads: Option<usize>,
    nested: Option<bool>,
    other_branch: bool,
    inputs: Inputs,
}

impl Problem {
    /// The pool of a solve, the inputs, and the problem.
    fn parts(&mut self) -> PyResult<(Pool, &Inputs, &mut dyn Solves)> {
        let pool = Pool::of(self.threads)?;
        Ok((pool, &self.inputs, self.solves.get_mut().unwrap_or_else(PoisonError::into_inner).as_mut()))
    }

    /// The solution that a load asks for.
    fn asked(&self, load: &Load) -> PyResult<Asked> {
        let (nested, other_branch) = (self.nested, self.other_branch);
        Ok(Asked { fraction: contact_fraction(load), nested, other_branch, ..Asked::under(self.control(load)?) })
    }

    /// The control of a load, unless it would act on mirror images as well.
    fn control(&self, load: &Load) -> PyResult<Control> {
        let control = control(load)?;
        let is_original = self.inputs.part.as_deref() == Some("original");
        check_part(is_original, control, Skin::Keywords).map_err(PyValueError::new_err)?;
        Ok(control)
    }
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (
        heights, lengths, absent_missing, boundary, modulus, law, wall, wall_stiffness, precision, tolerance, max_iterations,
        method, branch, nested, threads, original, part, unit, source, given
    ))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn new(
        py: Python<'_>,
        heights: Field<'_>,
        lengths: (f64, f64),
        absent_missing: bool,
        boundary: &str,
        modulus: f64,
        law: &Bound<'_, PyAny>,
        wall: &str,
        wall_stiffness: Option<f64>,
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
        given: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let method = named("method", method, "default or rey2017")?;
        let branches = branch.map(|name| named("branch", name, "loading, unloading or both")).transpose()?;
        let (settings, other_branch) =
            (settings(method, tolerance, max_iterations, branches), branches == Some(Branches::Both));
        let pool = Pool::of(threads)?;
        let heights = heights.to_array()?;
        let boundary = named("boundary", boundary, "periodic or free")?;
        let wall = named("wall", wall, "hard or none, or of springs, as asperity.Penalty(stiffness)")?;
        let original = original.map(|original| original.0);
        let make = if absent_missing { Surface::with_absent } else { Surface::new };
        let surface = Grid::new(heights.dim(), lengths).and_then(|grid| make(grid, heights));
        let surface = surface.map_err(refusal_of_heights)?;
        let Law { formula, adhesion, .. } = Law::of(law)?;
        let adhesion = Adhesion { wall, wall_stiffness, ..adhesion };
        adhesion.check_wall(word).map_err(PyValueError::new_err)?;
        let mut inputs = Inputs {
            heights: source,
            initial_gap: None,
            part,
            solved_shape: None,
            shape: surface.grid().shape(),
            lengths,
            length_unit: unit,
            pressure_unit: given.as_ref().map(|_| PRESSURE.si.to_owned()),
            given: given.map(keys).transpose()?,
            boundary,
            modulus,
            adhesion,
            method,
            precision: "f64",
            tolerance: settings.tolerance_in::<f64>(),
            max_iterations: settings.max_iterations,
            threads: pool.threads(),
            version: env!("CARGO_PKG_VERSION"),
        };
        let problem = (surface, formula);
        let solves = match precision {
            "f64" => state::<f64>(py, &pool, problem, (&inputs, settings, original), threads)?,
            "f32" => {
                inputs.precision = "f32";
                state::<f32>(py, &pool, problem, (&inputs, settings, original), threads)?
            }
            other => return Err(PyValueError::new_err(format!("precision is {other}: it must be f64 or f32"))),
        };
        Ok(Self { solves: Mutex::new(solves), threads, nested, other_branch, inputs })
    }

    /// The word of reports for the gap from which solves start.
    #[setter]
    fn set_initial_gap(&mut self, word: String) {
        self.inputs.initial_gap = Some(word);
    }

    /// The pressure of which a reduced pressure is a part.
    fn full_pressure(&mut self, py: Python<'_>) -> PyResult<f64> {
        let (pool, _, solves) = self.parts()?;
        py.detach(move || pool.get().install(move || solves.full_pressure())).map_err(PyValueError::new_err)
    }

    /// The plan of a solve to an accuracy.
    #[pyo3(signature = (load, accuracy))]
    fn plan(&mut self, py: Python<'_>, load: Load, accuracy: Accuracy) -> PyResult<Planned> {
        let (pool, _, solves) = self.parts()?;
        let goal = goal(accuracy)?;
        let (plan, seconds) = solves.plan(py, &pool, control(&load)?, goal)?;
        let text = goal.announced(&plan, seconds);
        Ok(((plan.nodes_per_wave, plan.tolerance, plan.shape, plan.bytes, seconds), text))
    }

    /// The equilibrium at a load.
    #[pyo3(signature = (load, start, observe, stability, leave, stiffness, accuracy))]
    #[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by name")]
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        load: Load,
        start: Option<Field<'py>>,
        observe: Option<Py<PyAny>>,
        stability: bool,
        leave: bool,
        stiffness: bool,
        accuracy: Option<Accuracy>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let goal = accuracy.map(goal).transpose()?;
        let asked = Asked { stability, leave, stiffness, goal, ..self.asked(&load)? };
        let (pool, inputs, solves) = self.parts()?;
        let sensible = asked.check_branches(&inputs.adhesion.law, inputs.method, Skin::Keywords);
        sensible.map_err(PyValueError::new_err)?;
        solves.solve(py, Run { pool: &pool, observer: observe.as_ref(), inputs }, asked, start)
    }

    /// Begins a sweep of loads, or with the settings of a path a cycle through them, and returns the names of its
    /// columns.
    #[pyo3(signature = (loads, start, stiffness, path))]
    fn begin(
        &mut self,
        loads: Vec<Load>,
        start: Option<Field<'_>>,
        stiffness: bool,
        path: Option<(usize, f64, f64, bool)>,
    ) -> PyResult<Vec<&'static str>> {
        let controls = loads.iter().map(|load| self.control(load)).collect::<PyResult<_>>()?;
        let fractions: Vec<_> = loads.iter().filter_map(contact_fraction).collect();
        let way = match path {
            Some((steps, smallest_step, imbalance, smooth)) => {
                let settings = PathSettings::default().steps(steps).smallest_step(smallest_step);
                Way::Cycle(controls, settings.imbalance(imbalance).smooth(smooth))
            }
            None if fractions.is_empty() => Way::Sweep(controls),
            None => Way::Search(fractions),
        };
        Ok(self.solves.get_mut().unwrap_or_else(PoisonError::into_inner).begin(way, stiffness, start))
    }

    /// The next state of the sweep or the cycle that was begun last; none at its end.
    #[pyo3(signature = (observe))]
    fn next<'py>(&mut self, py: Python<'py>, observe: Option<Py<PyAny>>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let (pool, inputs, solves) = self.parts()?;
        solves.next(py, Run { pool: &pool, observer: observe.as_ref(), inputs })
    }

    /// The stability of a gap under a load, of which the certified error is known.
    #[pyo3(signature = (load, gap, relative_error))]
    fn stability<'py>(
        &mut self,
        py: Python<'py>,
        load: Load,
        gap: Field<'py>,
        relative_error: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (pool, _, solves) = self.parts()?;
        solves.stability(py, &pool, control(&load)?, (gap, relative_error))
    }
}
