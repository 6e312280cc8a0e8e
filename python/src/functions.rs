//! Functions of Python that are asked for arrays: those of a law that is an object, and others by their names.

use asperity::Error;
use numpy::PyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::numbers::Numbers;

/// The methods of a law, in the order in which each is the derivative of the one before.
const METHODS: [&str; 3] = ["energy", "traction", "slope"];

/// An object of Python with the methods `energy`, `traction` and `slope` of an array of gaps.
pub struct Functions {
    object: Py<PyAny>,
    pub work_of_adhesion: Option<f64>,
    pub range: Option<f64>,
}

impl Functions {
    /// The functions of an object, with the scales that it has as attributes.
    ///
    /// # Errors
    /// `TypeError` if it lacks a function.
    pub fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        for method in METHODS {
            if !object.getattr(method).is_ok_and(|method| method.is_callable()) {
                let class = object.get_type().name()?;
                return Err(PyTypeError::new_err(format!(
                    "law is a {class} without a method {method}(gap): it must have energy, traction and slope, each of \
                     an array of gaps, or be a law of asperity, as asperity.Exponential(work_of_adhesion, range), or None"
                )));
            }
        }
        let number = |name| match object.getattr_opt(name)? {
            Some(value) if !value.is_none() => value.extract().map(Some),
            _ => Ok(None),
        };
        let [work_of_adhesion, range] = [number("work_of_adhesion")?, number("range")?];
        Ok(Self { object: object.clone().unbind(), work_of_adhesion, range })
    }
}

impl asperity::adhesion::Functions for Functions {
    fn set(&self, order: usize, gaps: &[f64], values: &mut [f64]) -> asperity::Result<()> {
        // a function of one gap alone also takes an array of one
        let gaps = if let &[gap] = gaps { &[gap; 2] } else { gaps };
        let method = METHODS[order];
        let at = |py: Python<'_>| {
            at_arrays(&self.object.bind(py).getattr(method)?, &format!("law.{method}"), "gap", &[gaps], true)
        };
        let found: Vec<f64> = Python::attach(at).map_err(Error::raised)?;
        values.iter_mut().zip(found).for_each(|(value, found)| *value = found);
        Ok(())
    }

    fn work_of_adhesion(&self) -> Option<f64> {
        self.work_of_adhesion
    }

    fn range(&self) -> Option<f64> {
        self.range
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
    let py = function.py();
    let count = arrays.first().map_or(0, |array| array.len());
    let arrays: Vec<_> = arrays.iter().map(|array| PyArray1::from_slice(py, array)).collect();
    let called = py.import("asperity._called")?;
    let found: Numbers<'_> = called.call_method1("called", (function, name, of, arrays))?.extract()?;
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
