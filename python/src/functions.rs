//! The functions of a law that is an object of Python.

use std::sync::{Mutex, PoisonError};

use asperity::{AdhesionLaw, Error};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::numbers::Numbers;
use crate::refusal::refusal;

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
        let method = function.method();
        let found: Numbers<'_> =
            self.object.call_method1(method, (PyArray1::from_slice(self.object.py(), gaps),))?.extract()?;
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
    raised: Mutex<Option<PyErr>>,
}

/// Tells whether the functions of an object of Python agree with one another.
///
/// # Errors
/// What they raise; `ValueError` with the function that is wrong.
pub fn check(object: &Bound<'_, PyAny>, largest_gap: f64) -> PyResult<()> {
    Functions::of(object)?;
    let called = Called { object: object.clone().unbind(), raised: Mutex::new(None) };
    let checked = asperity::check_law(&called, largest_gap);
    match called.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        // of which the table of the law has a smoothed one
        None if matches!(checked, Err(Error::Jump { .. })) => Ok(()),
        None => checked.map_err(refusal),
    }
}

impl Called {
    fn at(&self, function: Function, gap: f64) -> f64 {
        let found = Python::attach(|py| Functions { object: self.object.bind(py).clone() }.at(function, &[gap]));
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
}
