//! Functions of one number as functions of arrays.

use numpy::ndarray::{ArrayD, ArrayViewD};
use numpy::{AllowTypeChange, IntoPyArray, PyArrayLikeDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Numbers of any shape: a number, a list, or an array of any float type, order and stride.
pub type Numbers<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// The numbers of an array, as Python takes them: those without a shape as a `float`.
pub fn returned(py: Python<'_>, numbers: ArrayD<f64>) -> PyResult<Bound<'_, PyAny>> {
    match numbers.ndim() {
        0 => Ok(numbers.sum().into_pyobject(py)?.into_any()),
        _ => Ok(numbers.into_pyarray(py).into_any()),
    }
}

/// A function at each of some numbers.
pub fn mapped<'py>(py: Python<'py>, numbers: &Numbers<'py>, of: impl Fn(f64) -> f64) -> PyResult<Bound<'py, PyAny>> {
    returned(py, numbers.as_array().mapv(of))
}

/// A function that may refuse a number, at each of some.
pub fn tried<S>(numbers: ArrayViewD<'_, f64>, of: impl Fn(f64) -> PyResult<S>) -> PyResult<ArrayD<S>> {
    let values = numbers.iter().map(|&number| of(number)).collect::<PyResult<Vec<S>>>()?;
    ArrayD::from_shape_vec(numbers.raw_dim(), values).map_err(|error| PyValueError::new_err(error.to_string()))
}
