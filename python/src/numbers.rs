//! Arrays of numpy as arrays of the library, and functions of one number as functions of arrays.

use std::ops::Deref;

use asperity::Error;
use numpy::ndarray::{Array2, ArrayD, ArrayViewD, Dimension, Ix2, IxDyn};
use numpy::{
    AllowTypeChange, Element, IntoPyArray, PyArray, PyArray1, PyArrayLike, PyArrayMethods, PyReadonlyArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::refusal::refusal;

/// A scalar in which one can solve, and that numpy has.
pub trait Scalar: asperity_scene::Scalar + Element {}
impl<T: asperity_scene::Scalar + Element> Scalar for T {}

/// The numbers of an array: of any float type, order and stride; masked ones are NaN.
///
/// The strides of ndarray count items, and its items are aligned. An array with items that do not lie a whole number of
/// items from the next, as the column of a packed record, is copied first.
pub struct Items<'py, D: Dimension>(PyReadonlyArray<'py, f64, D>);

/// Numbers of any shape: a number, a list, or an array.
pub type Numbers<'py> = Items<'py, IxDyn>;

/// The numbers of a matrix.
pub type Field<'py> = Items<'py, Ix2>;

impl<'a, 'py, D: Dimension + 'py> FromPyObject<'a, 'py> for Items<'py, D> {
    type Error = PyErr;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        let given: PyArrayLike<'py, f64, D, AllowTypeChange> = match object.getattr_opt("filled")? {
            Some(_) => object.call_method1("astype", ("f8",))?.call_method1("filled", (f64::NAN,))?.extract()?,
            None => object.extract()?,
        };
        let whole = |stride: &isize| stride.unsigned_abs().is_multiple_of(size_of::<f64>());
        if given.data().is_aligned() && given.strides().iter().all(whole) {
            return Ok(Self(given.clone()));
        }
        Ok(Self(given.call_method0("copy")?.cast_into::<PyArray<f64, D>>()?.readonly()))
    }
}

impl<'py, D: Dimension> Deref for Items<'py, D> {
    type Target = PyReadonlyArray<'py, f64, D>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl Field<'_> {
    /// A copy of the numbers.
    ///
    /// # Errors
    /// `MemoryError` if there is no room for it: an allocation that fails would end the interpreter.
    pub fn to_array(&self) -> PyResult<Array2<f64>> {
        let numbers = self.as_array();
        if Vec::<f64>::new().try_reserve_exact(numbers.len()).is_ok() {
            return Ok(numbers.to_owned());
        }
        let what = format!("a copy of a map of {} x {} nodes", numbers.nrows(), numbers.ncols());
        Err(refusal(Error::Memory { what, bytes: numbers.len() as f64 * size_of::<f64>() as f64 }))
    }
}

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
pub fn tried<S>(numbers: ArrayViewD<'_, f64>, of: impl Fn(f64) -> asperity::Result<S>) -> PyResult<ArrayD<S>> {
    let values = numbers.iter().map(|&number| of(number).map_err(refusal)).collect::<PyResult<Vec<S>>>()?;
    ArrayD::from_shape_vec(numbers.raw_dim(), values).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Whole numbers as an array of int64.
pub fn whole(py: Python<'_>, numbers: impl IntoIterator<Item = usize>) -> Bound<'_, PyArray1<i64>> {
    PyArray1::from_iter(py, numbers.into_iter().map(|number| number as i64))
}
