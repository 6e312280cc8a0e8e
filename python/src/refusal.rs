//! The refusal of input: errors of the library as exceptions of Python.

use std::error::Error as _;
use std::io;

use asperity::{Error, ErrorKind};
use asperity_scene::synonyms::similar;
use asperity_scene::{Skin, worded};
use pyo3::exceptions::{PyFileNotFoundError, PyMemoryError, PyValueError};
use pyo3::prelude::*;

/// The exception of an error: `ValueError` with the library's message, its remedies in the words of Python,
/// `FileNotFoundError` for a file that does not exist, and `MemoryError` for memory that there is not.
pub fn refusal(error: Error) -> PyErr {
    if let Some(raised) = error.source().and_then(|cause| cause.downcast_ref::<PyErr>()) {
        return Python::attach(|py| raised.clone_ref(py));
    }
    let message = match &error {
        Error::Unsuited { what, reason } => format!("{}: {reason}", what.replace('-', "_")),
        error => error.to_string(),
    };
    let message = message
        .replace(
            "solve it without a wall (NoWall), or cut it at its equilibrium separation",
            "give wall='none', or LennardJones(..., cut=True)",
        )
        .replace("or take a free half-space", "or boundary='free'")
        .replace("asperity_maps::fill", "asperity.prepare(heights, lengths, fill=True)")
        .replace(
            "choose one, by asperity prepare --channel NUMBER",
            "choose one, by asperity.read(path, channel=NUMBER)",
        )
        .replace("read it in Python by asperity.read, after pip install", "pip install")
        .replace("by asperity prepare --skip-lines ", "by asperity.read(path, skip_lines=...), here ")
        .replace("by asperity prepare --missing-word ", "by asperity.read(path, missing_words=...), here ")
        .replace("set Topography::lengths", "give lengths=(Lx, Ly)")
        .replace("the traction of the law is", "law.traction is")
        .replace("the energy of the law", "law.energy")
        .replace("a range, the length over", "an attribute range, the length over")
        .replace("check_functions says", "asperity.check_law(law) says");
    match error {
        Error::File { path, .. } if !path.exists() => PyFileNotFoundError::new_err(message),
        Error::Memory { .. } => PyMemoryError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}

/// The one of the keywords of a function that another word means.
#[pyfunction]
pub fn meant(word: &str, known: Vec<String>) -> Option<String> {
    let known: Vec<_> = known.iter().map(|name| name.replace('_', "-")).collect();
    similar(&word.replace('_', "-"), known.iter().map(String::as_str)).map(|name| name.replace('-', "_"))
}

/// The exception of an error in a map of works of adhesion, in which no point can be missing.
pub fn refusal_of_works(error: Error) -> PyErr {
    match error {
        Error::NotFinite { count, nodes, first, value, .. } => PyValueError::new_err(format!(
            "work_of_adhesion: {count} of {nodes} nodes are not finite, the first ({value}) at index [{}, {}]: give each node \
             a work of adhesion, 0 where nothing attracts",
            first.0, first.1
        )),
        error => refusal(error),
    }
}

/// The exception of a reason with the names of keys in braces.
pub fn reason(text: String) -> PyErr {
    PyValueError::new_err(worded(&text, Skin::Keywords))
}

/// The exception of an error of a session: `OSError` for what the system refuses of the file of its table.
pub fn refusal_of_session(error: Box<dyn std::error::Error + Send + Sync>) -> PyErr {
    let message = error.to_string().replace("choose another --", "choose another ").replace("--force", "force=True");
    match error.downcast::<Error>() {
        Ok(error) if error.kind() != ErrorKind::File => refusal(*error),
        Ok(error) => match error.source().and_then(|cause| cause.downcast_ref::<io::Error>()) {
            Some(cause) => io::Error::new(cause.kind(), message).into(),
            None => PyValueError::new_err(message),
        },
        Err(_) => PyValueError::new_err(message),
    }
}
