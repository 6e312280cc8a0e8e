//! Reports as Python reads them.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyList, PyTuple};
use serde::Serialize;
use serde_pyobject::to_pyobject;

/// A report as Python reads it from its file: what is not finite is None there, and a pair a list.
pub fn reported<'py>(py: Python<'py>, report: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    as_read(to_pyobject(py, report)?)
}

/// A value as Python reads it from a file.
fn as_read(value: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    let py = value.py();
    let number = value.cast::<PyFloat>().ok().map(|number| number.value());
    // a null of data is an empty tuple
    let is_null = value.cast::<PyTuple>().is_ok_and(|items| items.is_empty());
    if is_null || number.is_some_and(|number| !number.is_finite()) {
        return Ok(py.None().into_bound(py));
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        let read = dict.iter().map(|(key, one)| Ok((key, as_read(one)?))).collect::<PyResult<Vec<_>>>()?;
        read.into_iter().try_for_each(|(key, one)| dict.set_item(key, one))?;
        return Ok(value);
    }
    if !value.is_instance_of::<PyTuple>() && !value.is_instance_of::<PyList>() {
        return Ok(value);
    }
    let items = value.try_iter()?.map(|item| as_read(item?)).collect::<PyResult<Vec<_>>>()?;
    Ok(PyList::new(py, items)?.into_any())
}
