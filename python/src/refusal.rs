//! The refusal of input: errors of the library as exceptions of Python.

use asperity::Error;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyValueError};

/// The exception of an error: `ValueError` with the library's message, its remedies in the words of Python, and
/// `FileNotFoundError` for a file that does not exist.
pub fn refusal(error: Error) -> PyErr {
    let message = error
        .to_string()
        .replace("as by Topography::fill", "as by asperity.prepare(heights, lengths, fill=True)")
        .replace("set Topography::lengths", "give lengths=(Lx, Ly)");
    match error {
        Error::File { path, .. } if !path.exists() => PyFileNotFoundError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}
