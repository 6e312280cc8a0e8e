//! The program `asperity`, in a process of Python.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the program with the arguments of a process, of which the first is its name; the exit code.
#[pyfunction]
pub fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| asperity_tool::run(arguments))
}
