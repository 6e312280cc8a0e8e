//! The program `asperity`, in a process of Python.

use std::ffi::OsString;
use std::path::PathBuf;

use asperity_tool::figures;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Runs the program with the arguments of a process, its name first; the exit code.
#[pyfunction]
pub fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| asperity_tool::run(arguments))
}

/// Puts results of the program on a page in a file.
#[pyfunction]
pub fn page(py: Python<'_>, results: PathBuf, out: PathBuf, force: bool) -> PyResult<()> {
    let written = py.detach(|| asperity_tool::page(&results, &out, force));
    written.map_err(|error| PyValueError::new_err(error.replace("--force", "force=True").replace("--out", "out")))
}

/// The figures of the text of a report by their names.
#[pyfunction]
pub fn figures_of(report: &str) -> PyResult<Vec<(String, String)>> {
    let report = serde_json::from_str(report).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(figures(&report))
}
