//! The law of an interface for codes of finite elements.

use asperity_scene::Units;
use asperity_scene::interface::Code;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::Value;

use crate::inputs::keys;
use crate::refusal::reason;

/// The files of the rows of a table for a code: the ends of their names, and their texts.
#[pyfunction]
pub fn interface_files(
    code: &str,
    rows: Vec<Bound<'_, PyAny>>,
    adhesive: bool,
    name: &str,
    units: (Option<String>, Option<String>),
) -> PyResult<Vec<(&'static str, String)>> {
    let refused = |_| PyValueError::new_err(format!("code is {code}: it must be 'abaqus', 'comsol' or 'moose'"));
    let code: Code = serde_json::from_value(code.into()).map_err(refused)?;
    let rows = rows.into_iter().map(keys).collect::<PyResult<Vec<Value>>>()?;
    let units = Units { length: units.0, pressure: units.1, force: None };
    code.files(&rows, adhesive, name, &units).map_err(reason)
}
