//! The functions of a law that is an object of Python.

use std::sync::{Mutex, PoisonError};

use asperity::adhesion::Hints;
use asperity::error::Breach;
use asperity::{AdhesionLaw, Error};
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyFloat, PyTuple};

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
    /// The exception of the method, and `ValueError` if it returns another number of values.
    pub fn at(&self, function: Function, gaps: &[f64]) -> PyResult<Vec<f64>> {
        let method = function.method();
        at_arrays(&self.object.getattr(method)?, &format!("law.{method}"), "gap", &[gaps], true)
    }

    /// All functions at one gap.
    pub fn all_at(&self, gap: f64) -> PyResult<[f64; 3]> {
        let [energy, traction, slope] = Function::ALL.map(|function| self.at(function, &[gap; 2]));
        Ok([energy?[0], traction?[0], slope?[0]])
    }

    /// A number that the object may have as an attribute.
    pub fn number(&self, name: &str) -> PyResult<Option<f64>> {
        match self.object.getattr_opt(name)? {
            Some(value) if !value.is_none() => value.extract().map(Some),
            _ => Ok(None),
        }
    }
}

/// A function of arrays, by its name, at many of what it is a function `of`, in one call; `one_of_all` if one value may
/// stand for all.
///
/// # Errors
/// The exception of the function, `TypeError` if it returns complex values, and `ValueError` if it returns another number
/// of them.
pub fn at_arrays<'py>(
    function: &Bound<'py, PyAny>,
    name: &str,
    of: &str,
    arrays: &[&[f64]],
    one_of_all: bool,
) -> PyResult<Vec<f64>> {
    let (py, count) = (function.py(), arrays.first().map_or(0, |array| array.len()));
    let call = |arguments: Vec<Bound<'py, PyAny>>| function.call1(PyTuple::new(py, arguments)?);
    // what is not finite is refused by its place
    let quiet = py.import("numpy")?.call_method("errstate", (), Some(&[("all", "ignore")].into_py_dict(py)?))?;
    quiet.call_method0("__enter__")?;
    let found = call(arrays.iter().map(|array| PyArray1::from_slice(py, array).into_any()).collect());
    quiet.call_method1("__exit__", (py.None(), py.None(), py.None()))?;
    let hinted = |raised: PyErr| {
        let about_arrays = raised.is_instance_of::<PyValueError>(py) || raised.is_instance_of::<PyTypeError>(py);
        let one = || arrays.iter().filter_map(|array| array.first()).map(|&value| PyFloat::new(py, value).into_any());
        if !about_arrays || count == 0 || call(one().collect()).is_err() {
            return raised;
        }
        let hint = PyTypeError::new_err(format!(
            "{name} takes one {of} alone, and is given arrays of {of}s: write numpy.where(...) in the place of if, and \
             functions of numpy in the place of those of math ({raised})"
        ));
        hint.set_cause(py, Some(raised));
        hint
    };
    let found = found.map_err(hinted)?;
    if py.import("numpy")?.call_method1("iscomplexobj", (&found,))?.extract()? {
        return Err(PyTypeError::new_err(format!("{name} returned complex numbers: it must return real ones")));
    }
    let found: Numbers<'_> = found.extract()?;
    let found = found.as_array();
    match found.len() {
        1 if one_of_all => Ok(vec![found.sum(); count]),
        values if values == count => Ok(found.iter().copied().collect()),
        _ => Err(PyValueError::new_err(format!(
            "{name} returned an array of shape {:?} for {of}s of shape [{count}]: it must return one value for each {of}",
            found.shape(),
        ))),
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
/// An exception of the functions, or `ValueError` with the function that is wrong.
pub fn check(object: &Bound<'_, PyAny>, largest_gap: Option<f64>) -> PyResult<()> {
    let scales = Scales::of(&Functions::of(object)?)?;
    let called = Called { object: object.clone().unbind(), scales, raised: Mutex::new(None) };
    let checked = asperity::adhesion::check_law(&called, largest_gap.unwrap_or_else(|| far(&called)));
    match called.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        // of which the table of the law has a smoothed one
        None if matches!(checked, Err(Error::Contract { breach: Breach::Jump(_), .. })) => Ok(()),
        None => checked.map_err(refusal),
    }
}

/// A gap at which most laws have decayed: ten ranges, from the equilibrium separation on.
pub fn far(law: &dyn AdhesionLaw<f64>) -> f64 {
    let hints = law.hints();
    // a law that has the range of the grid is looked at with any
    if hints.of_grid { 1.0 } else { hints.rest.unwrap_or(0.0) + 10.0 * hints.range }
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
