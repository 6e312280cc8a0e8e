//! Adhesion laws: those of the library as classes, and any object of Python with the three functions of a law.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use asperity::adhesion::{Values, check_functions};
use asperity::{AdhesionLaw, adhesion};
use asperity_scene::{Adhesion, Formula};
use numpy::ndarray::ArrayD;
use numpy::{PyArray1, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::functions::Functions;
use crate::given::{Given, Measure};
use crate::numbers::{Field, Numbers, mapped, returned};
use crate::refusal::{refusal, refusal_of_works};

/// An adhesion law of the library: functions of the gap between the surfaces, a length.
#[pyclass(frozen, eq, subclass, module = "asperity")]
#[derive(Clone)]
pub struct Law {
    pub formula: Formula,
    /// Its part of a report; of the wall it says no more than whether the law is made for one
    pub adhesion: Adhesion,
    pub given: Given,
}

impl PartialEq for Law {
    fn eq(&self, other: &Self) -> bool {
        *self.formula == *other.formula
    }
}

#[pymethods]
impl Law {
    /// Adhesive energy φ(g) per area, of the shape of the gaps.
    fn energy<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 0)
    }
    /// Adhesive traction φ'(g), positive attracts, of the shape of the gaps.
    fn traction<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 1)
    }
    /// Slope of the traction φ''(g), of the shape of the gaps.
    fn slope<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.at(py, &gap, 2)
    }
    /// The numbers that were given with a unit, as texts by their names in reports, and the first one that has none.
    #[getter]
    fn given(&self) -> (HashMap<String, String>, Option<(String, f64)>) {
        (self.given.texts.iter().cloned().collect(), self.given.bare.clone())
    }
    /// The constructor's call, with its parameters by name.
    fn __repr__(law: &Bound<'_, Self>) -> PyResult<String> {
        let names: Vec<String> = law.getattr("__match_args__")?.extract()?;
        let values: Vec<Bound<'_, PyAny>> = law.call_method0("__getnewargs__")?.extract()?;
        let parameters = names.iter().zip(values).map(|(name, value)| Ok(format!("{name}={}", value.repr()?)));
        Ok(format!("{}({})", law.get_type().name()?, parameters.collect::<PyResult<Vec<_>>>()?.join(", ")))
    }
}

impl Law {
    /// The law of an object: one of the library, a table of the functions that it has, or no adhesion for `None`.
    pub fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if object.is_none() {
            return Self::of_library(Adhesion::of("none"));
        }
        Self::some(object)
    }

    /// The law of an object that is one.
    fn some(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(law) = object.cast::<Self>() {
            return Ok(law.get().clone());
        }
        let functions = Functions::of(object)?;
        let Functions { work_of_adhesion, range, .. } = functions;
        let formula: Formula = Arc::new(asperity::Tabulated::of(functions).map_err(refusal)?);
        let name = object.get_type().name()?.to_string();
        let adhesion = Adhesion { work_of_adhesion, range, ..Adhesion::of(name) };
        Ok(Self { formula, adhesion, given: Given::default() })
    }

    /// The law of the library that a description has.
    pub fn of_library(adhesion: Adhesion) -> PyResult<Self> {
        Ok(Self { formula: adhesion.formula(None).map_err(refusal)?, adhesion, given: Given::default() })
    }

    /// Energies (0), tractions (1) or slopes (2) at gaps of any shape; where the work of adhesion varies, at one for each
    /// of its nodes or one for all.
    fn at<'py>(&self, py: Python<'py>, gap: &Numbers<'py>, order: usize) -> PyResult<Bound<'py, PyAny>> {
        let law = self.formula.clone().law::<f64>();
        let Some((nx, ny)) = law.hints().shape else {
            return mapped(py, gap, |gap| [law.energy(gap), law.traction(gap), law.slope(gap)][order]);
        };
        let gap = gap.as_array();
        let gap = if gap.len() == 1 { ArrayD::from_elem(vec![nx, ny], gap.sum()) } else { gap.to_owned() };
        if gap.len() != nx * ny {
            return Err(PyValueError::new_err(format!(
                "gap has shape {:?}: the work of adhesion varies, so that it must be [{nx}, {ny}], or one number",
                gap.shape()
            )));
        }
        let mut values = ArrayD::zeros(gap.shape());
        let gaps: Vec<f64> = gap.iter().copied().collect();
        law.evaluate(0, &gaps, Values::one(order, values.as_slice_mut().unwrap_or_default()));
        returned(py, values)
    }
}

/// A law of which the traction is a monotone cubic through the points of a table.
///
/// Parameters
/// ----------
/// gaps : array_like, shape (N,)
///     Gaps, lengths that rise from zero.
/// tractions : array_like, shape (N,)
///     Tractions, attraction positive; the last one is zero.
/// source : str, optional
///     File that they come from, as `read` sets it.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> law = asperity.Tabulated([0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0])
/// >>> f"{-law.energy(0.0):.3f}"
/// '0.050'
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct Tabulated {
    gaps: Vec<f64>,
    tractions: Vec<f64>,
    #[pyo3(get)]
    source: Option<String>,
}

#[pymethods]
impl Tabulated {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str, &str) = ("gaps", "tractions", "source");
    #[new]
    #[pyo3(signature = (gaps, tractions, source = None))]
    fn new(gaps: Numbers<'_>, tractions: Numbers<'_>, source: Option<String>) -> PyResult<PyClassInitializer<Self>> {
        let [gaps, tractions]: [Vec<f64>; 2] =
            [gaps, tractions].map(|values| values.as_array().iter().copied().collect());
        let law = asperity::Tabulated::new(&gaps, &tractions).map_err(refusal)?;
        Ok(Self { gaps, tractions, source }.of_law(law))
    }
    /// The law of a file with a gap and a traction on each line.
    ///
    /// Parameters
    /// ----------
    /// path : str or path
    ///     A text of two columns, or ``.npy``.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Py<Self>> {
        Py::new(py, Self::of_file(&path).map_err(refusal)?)
    }
    #[getter]
    fn gaps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.gaps.to_pyarray(py)
    }
    #[getter]
    fn tractions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.tractions.to_pyarray(py)
    }
    fn __getnewargs__<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<String>) {
        (self.gaps(py), self.tractions(py), self.source.clone())
    }
}

impl Tabulated {
    fn of_file(path: &Path) -> asperity::Result<PyClassInitializer<Self>> {
        let table = asperity_maps::io::read_field(path)?;
        let law = asperity_scene::tabulated(path, &table)?;
        let [gaps, tractions] = [0, 1].map(|column| table.column(column).to_vec());
        let source = Some(path.to_string_lossy().into_owned());
        Ok(Self { gaps, tractions, source }.of_law(law))
    }

    fn of_law(self, law: asperity::Tabulated) -> PyClassInitializer<Self> {
        let law_table = self.source.clone().or_else(|| Some("array".to_owned()));
        let adhesion = Adhesion { law_table, ..Adhesion::of("table") };
        let law = Law { formula: Arc::new(law), adhesion, given: Given::default() };
        PyClassInitializer::from(law).add_subclass(self)
    }
}

/// A law that ends at a gap, smoothly: zero from there on, with energy, traction and slope continuous.
///
/// It keeps its work of adhesion, its equilibrium separation, and its traction in contact; the energy that the tail had
/// is given back before the end.
///
/// Parameters
/// ----------
/// law : Law or an object of your own
///     Law that reaches further.
/// distance : float
///     Gap at which it ends, a length: at least a range of the law beyond contact, or beyond its equilibrium
///     separation.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> law = asperity.CutOff(asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9), distance=5e-9)
/// >>> law.traction(5e-9)
/// 0.0
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct CutOff {
    #[pyo3(get)]
    law: Py<PyAny>,
    #[pyo3(get)]
    distance: f64,
}

#[pymethods]
impl CutOff {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str) = ("law", "distance");
    #[new]
    fn new(law: &Bound<'_, PyAny>, distance: Measure) -> PyResult<PyClassInitializer<Self>> {
        let Law { formula, adhesion, mut given } = Law::some(law)?;
        let distance = given.read("cut_off", distance)?;
        if formula.is_cut_off() {
            return Err(PyValueError::new_err("the law is cut off already: give the law that it is made of"));
        }
        let formula = formula.cut_off(distance).map_err(refusal)?;
        // the innermost of several
        let adhesion = Adhesion { cut_off: adhesion.cut_off.or(Some(distance)), ..adhesion };
        let own = Self { law: law.clone().unbind(), distance };
        Ok(PyClassInitializer::from(Law { formula, adhesion, given }).add_subclass(own))
    }
    fn __getnewargs__<'py>(slf: PyRef<'py, Self>) -> PyResult<(Py<PyAny>, Bound<'py, PyAny>)> {
        let py = slf.py();
        Ok((slf.law.clone_ref(py), slf.as_super().given.typed(py, "cut_off", slf.distance)?))
    }
}

/// A law of which the work of adhesion differs from node to node: energy, traction and slope in proportion to it.
///
/// Parameters
/// ----------
/// law : Law or an object of your own
///     Law that varies; its own work of adhesion > 0 is replaced.
/// work_of_adhesion : array_like, shape (Nx, Ny) or (N,)
///     Works of adhesion ≥ 0 at the nodes of the heights, energies per area; x along the first axis, or that of the
///     dimensions x and y of a DataArray.
///
/// Examples
/// --------
/// >>> import numpy as np, asperity
/// >>> wetted = np.where(np.arange(64)[:, None] < 32, 0.07, 0.02) * np.ones((64, 64))
/// >>> law = asperity.Varying(asperity.Exponential(work_of_adhesion=0.07, range=2e-9), wetted)
/// >>> law.energy(0.0)[[0, 63], 0]
/// array([-0.07, -0.02])
#[pyclass(frozen, extends = Law, module = "asperity")]
pub struct Varying {
    #[pyo3(get)]
    law: Py<PyAny>,
    #[pyo3(get)]
    work_of_adhesion: Py<PyAny>,
}

#[pymethods]
impl Varying {
    #[classattr]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __match_args__: (&str, &str) = ("law", "work_of_adhesion");
    #[new]
    fn new(law: &Bound<'_, PyAny>, work_of_adhesion: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let Law { formula, adhesion, mut given } = Law::some(law)?;
        given.texts.retain(|(key, _)| key != "work_of_adhesion");
        if AdhesionLaw::<f64>::hints(&formula).shape.is_some() {
            return Err(PyValueError::new_err("the law varies already: give the law that it is made of"));
        }
        let maps = law.py().import("asperity._topography")?;
        let (works, is_line): (Field<'_>, bool) =
            maps.call_method1("array_of", (work_of_adhesion, "works of adhesion"))?.extract()?;
        let works = works.to_array()?;
        let formula = formula.varied(works.view()).map_err(refusal_of_works)?;
        let works = if is_line { works.column(0).to_owned().into_dyn() } else { works.into_dyn() };
        let own = Self { law: law.clone().unbind(), work_of_adhesion: returned(law.py(), works)?.unbind() };
        let work_of_adhesion_map = Some("array".to_owned());
        let adhesion = Adhesion { work_of_adhesion: None, work_of_adhesion_map, ..adhesion };
        Ok(PyClassInitializer::from(Law { formula, adhesion, given }).add_subclass(own))
    }
    fn __getnewargs__(&self, py: Python<'_>) -> (Py<PyAny>, Py<PyAny>) {
        (self.law.clone_ref(py), self.work_of_adhesion.clone_ref(py))
    }
}

/// Tells whether the three functions of a law agree with one another.
///
/// Compares the traction with differences of the energy, and the slope with differences of the traction, at 200 gaps.
///
/// Parameters
/// ----------
/// law : object
///     With the methods energy(gap), traction(gap) and slope(gap) of an array of gaps g ≥ 0, each of which returns an
///     array of the same shape: the energy per area φ(g), its derivative φ'(g), positive where the surfaces attract
///     each other, and the traction's derivative φ''(g). Attributes `work_of_adhesion`, −φ(0) by default, and `range`,
///     the length over which the traction decays, w/φ'(0) by default, say how far the grid has to resolve it. A law
///     that repels below some gap, at which it rests, keeps the surfaces apart with ``wall="none"``; by default it has
///     the work of adhesion −φ there, and the range w over its greatest attraction. It is asked for negative gaps, too,
///     unless its energy is infinite at zero gap.
/// largest_gap : float, optional
///     Largest gap, a length; ten ranges by default.
///
/// Raises
/// ------
/// ValueError
///     With the function that is wrong, the gap, and what it should be there.
///
/// Examples
/// --------
/// >>> import asperity
/// >>> class Linear:
/// ...     "A traction that falls linearly to zero at the range."
/// ...     work_of_adhesion, range = 1e-4, 2e-3
/// ...     def energy(self, gap):
/// ...         return -1e-4 * (1 - gap / 2e-3).clip(0) ** 2
/// ...     def traction(self, gap):
/// ...         return 0.1 * (1 - gap / 2e-3).clip(0)
/// ...     def slope(self, gap):
/// ...         return -50.0 * (gap < 2e-3)
/// >>> asperity.check_law(Linear())
#[pyfunction]
#[pyo3(signature = (law, largest_gap = None))]
pub fn check_law(law: &Bound<'_, PyAny>, largest_gap: Option<f64>) -> PyResult<()> {
    let checked = match law.cast::<Law>() {
        Ok(law) => {
            let law = law.get().formula.clone().law::<f64>();
            adhesion::check_law(&law, largest_gap.unwrap_or_else(|| law.hints().far()))
        }
        Err(_) => check_functions(Functions::of(law)?, largest_gap),
    };
    checked.map_err(refusal)
}
