//! Adhesion laws: those of the library as classes, and any object of Python with the three functions of a law.

use std::sync::{Mutex, PoisonError};

use asperity::{AdhesionLaw, NoAdhesion, Real};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::numbers::{Numbers, mapped};
use crate::refusal::refusal;
use crate::table::Table;

/// A law of the library, which is given by work of adhesion and range, as a class.
macro_rules! class {
    ($name:ident) => {
        #[doc = concat!("The law `asperity::", stringify!($name), "`.")]
        #[pyclass(frozen, eq, module = "asperity")]
        #[derive(Clone, PartialEq)]
        pub struct $name(asperity::$name);

        #[pymethods]
        impl $name {
            #[new]
            fn new(work_of_adhesion: f64, range: f64) -> PyResult<Self> {
                asperity::$name::new(work_of_adhesion, range).map(Self).map_err(refusal)
            }
            #[getter]
            fn work_of_adhesion(&self) -> f64 {
                self.0.work_of_adhesion()
            }
            #[getter]
            fn range(&self) -> f64 {
                self.0.range()
            }
            fn energy<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.energy(gap))
            }
            fn traction<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.traction(gap))
            }
            fn slope<'py>(&self, py: Python<'py>, gap: Numbers<'py>) -> PyResult<Bound<'py, PyAny>> {
                mapped(py, &gap, |gap| self.0.slope(gap))
            }
            fn __repr__(&self) -> String {
                let (work, range) = (self.0.work_of_adhesion(), self.0.range());
                format!(concat!(stringify!($name), "(work_of_adhesion={:?}, range={:?})"), work, range)
            }
            fn __getnewargs__(&self) -> (f64, f64) {
                (self.0.work_of_adhesion(), self.0.range())
            }
        }
    };
}
class!(Exponential);
class!(MaugisDugdale);

/// The law of an object: none of `None`, a class of the library, or a table of the functions that the object has.
pub fn law<T: Real>(object: &Bound<'_, PyAny>) -> PyResult<Box<dyn AdhesionLaw<T>>> {
    if object.is_none() {
        return Ok(Box::new(NoAdhesion));
    }
    if let Ok(law) = object.cast::<Exponential>() {
        return Ok(Box::new(law.get().0));
    }
    if let Ok(law) = object.cast::<MaugisDugdale>() {
        return Ok(Box::new(law.get().0));
    }
    Ok(Box::new(Table::of(&Functions::of(object)?)?))
}

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
                     an array of gaps, or be asperity.Exponential, asperity.MaugisDugdale or None"
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

/// Tells whether the three functions of a law agree with one another, by [`asperity::check_law`].
#[pyfunction]
pub fn check_law(law: &Bound<'_, PyAny>, largest_gap: f64) -> PyResult<()> {
    Functions::of(law)?;
    let called = Called { object: law.clone().unbind(), raised: Mutex::new(None) };
    let checked = asperity::check_law(&called, largest_gap);
    match called.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => checked.map_err(refusal),
    }
}
