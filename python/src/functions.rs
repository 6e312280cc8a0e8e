//! The functions of a law that is an object of Python.

use std::sync::{Mutex, PoisonError};

use asperity::adhesion::Hints;
use asperity::{AdhesionLaw, Error};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use crate::numbers::Numbers;
use crate::refusal::refusal;
use crate::scales::Scales;

/// The three functions of a law, in the order in which each is the derivative of the one before.
#[derive(Clone, Copy)]
pub enum Function {
    Energy,
    Traction,
    Slope,
}

impl Function {
    pub const ALL: [Self; 3] = [Self::Energy, Self::Traction, Self::Slope];

    /// The name of the method.
    fn method(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::Traction => "traction",
            Self::Slope => "slope",
        }
    }

    /// The name in messages, as the library has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Energy => "adhesive energy",
            Self::Traction => "adhesive traction",
            Self::Slope => "slope of the adhesive traction",
        }
    }
}

/// An object of Python with the methods `energy`, `traction` and `slope` of an array of gaps.
pub struct Functions<'py> {
    object: Bound<'py, PyAny>,
}

impl<'py> Functions<'py> {
    /// The functions of an object.
    ///
    /// # Errors
    /// `TypeError` if it lacks one.
    pub fn of(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        for method in Function::ALL.map(Function::method) {
            if !object.getattr(method).is_ok_and(|method| method.is_callable()) {
                let class = object.get_type().name()?;
                return Err(PyTypeError::new_err(format!(
                    "law is a {class} without a method {method}(gap): it must have energy, traction and slope, each of \
                     an array of gaps, or be a law of asperity, as asperity.Exponential(work_of_adhesion, range), or None"
                )));
            }
        }
        Ok(Self { object: object.clone() })
    }

    /// A function at many gaps, in one call.
    ///
    /// # Errors
    /// What the method raises, and `ValueError` if it returns another number of values.
    pub fn at(&self, function: Function, gaps: &[f64]) -> PyResult<Vec<f64>> {
        let (py, method) = (self.object.py(), function.method());
        // what is not finite is refused by its gap
        let quiet = py.import("numpy")?.call_method("errstate", (), Some(&[("all", "ignore")].into_py_dict(py)?))?;
        quiet.call_method0("__enter__")?;
        let found = self.object.call_method1(method, (PyArray1::from_slice(py, gaps),));
        quiet.call_method1("__exit__", (py.None(), py.None(), py.None()))?;
        let found: Numbers<'_> = found.map_err(|error| self.hinted(method, gaps, error))?.extract()?;
        let found = found.as_array();
        match found.len() {
            1 => Ok(vec![found.sum(); gaps.len()]),
            count if count == gaps.len() => Ok(found.iter().copied().collect()),
            _ => Err(PyValueError::new_err(format!(
                "law.{method} returned an array of shape {:?} for gaps of shape [{}]: it must return one value for \
                 each gap",
                found.shape(),
                gaps.len()
            ))),
        }
    }

    /// All functions at one gap.
    pub fn all_at(&self, gap: f64) -> PyResult<[f64; 3]> {
        let [energy, traction, slope] = Function::ALL.map(|function| self.at(function, &[gap; 2]));
        Ok([energy?[0], traction?[0], slope?[0]])
    }

    /// What a method has raised at gaps, or that it takes one gap alone, if it does.
    fn hinted(&self, method: &str, gaps: &[f64], raised: PyErr) -> PyErr {
        let py = self.object.py();
        let about_arrays = raised.is_instance_of::<PyValueError>(py) || raised.is_instance_of::<PyTypeError>(py);
        if !about_arrays || gaps.first().is_none_or(|&gap| self.object.call_method1(method, (gap,)).is_err()) {
            return raised;
        }
        let hint = PyTypeError::new_err(format!(
            "law.{method} takes one gap alone, and is given arrays of gaps: write numpy.where(...) in the place of if, and \
             functions of numpy in the place of those of math ({raised})"
        ));
        hint.set_cause(py, Some(raised));
        hint
    }

    /// A number that the object may have as an attribute.
    pub fn number(&self, name: &str) -> PyResult<Option<f64>> {
        match self.object.getattr_opt(name)? {
            Some(value) if !value.is_none() => value.extract().map(Some),
            _ => Ok(None),
        }
    }
}

/// A law of Python, called for each gap; keeps the first exception.
struct Called {
    object: Py<PyAny>,
    scales: Scales,
    raised: Mutex<Option<PyErr>>,
}

/// Tells whether the functions of an object of Python agree with one another, up to a gap or that of most laws.
///
/// # Errors
/// What they raise; `ValueError` with the function that is wrong.
pub fn check(object: &Bound<'_, PyAny>, largest_gap: Option<f64>) -> PyResult<()> {
    let scales = Scales::of(&Functions::of(object)?)?;
    let called = Called { object: object.clone().unbind(), scales, raised: Mutex::new(None) };
    let checked = asperity::adhesion::check_law(&called, largest_gap.unwrap_or_else(|| far(&called)));
    match called.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        // of which the table of the law has a smoothed one
        None if matches!(checked, Err(Error::Jump { .. })) => Ok(()),
        None => checked.map_err(refusal),
    }
}

/// A gap at which most laws have decayed: ten ranges, from the equilibrium separation on.
pub fn far(law: &dyn AdhesionLaw<f64>) -> f64 {
    let hints = law.hints();
    hints.rest.unwrap_or(0.0) + 10.0 * hints.range
}

impl Called {
    fn at(&self, function: Function, gap: f64) -> f64 {
        let found = Python::attach(|py| Functions { object: self.object.bind(py).clone() }.at(function, &[gap; 2]));
        found.map(|values| values[0]).unwrap_or_else(|error| {
            self.raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            f64::NAN
        })
    }
}

impl AdhesionLaw<f64> for Called {
    fn energy(&self, gap: f64) -> f64 {
        self.at(Function::Energy, gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.at(Function::Traction, gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.at(Function::Slope, gap)
    }
    fn hints(&self) -> Hints<f64> {
        let mut hints = Hints::new(self.scales.work_of_adhesion, self.scales.range);
        hints.rest = self.scales.rest;
        hints
    }
}
