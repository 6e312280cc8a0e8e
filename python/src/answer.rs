//! The answer to a solve: the dictionary in which Python gets what was found.

use asperity::Solution;
use asperity_maps::Topography;
use asperity_scene::outcome::Outcome;
use asperity_scene::{Account, Found, Skin, shortfalls};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_pyobject::to_pyobject;

use crate::look::Look;
use crate::numbers::Scalar;
use crate::refusal::refusal_of_session;
use crate::running::At;

/// The dictionary of what a solve found, and the exception that ended it early.
pub fn answer<'py, T: Scalar>(
    at: &At<'py>,
    found: Outcome<(Found<T>, Account)>,
    raised: Option<PyErr>,
) -> PyResult<Bound<'py, PyDict>> {
    let (py, threads) = (at.py, at.pool.asked);
    let (Found { solution, sight, mode, refined, .. }, account) = match (found, raised.as_ref()) {
        (Ok(found), _) => found,
        (Err(_), Some(raised)) => return Err(raised.clone_ref(py)),
        (Err(error), None) => return Err(refusal_of_session(error)),
    };
    let found = PyDict::new(py);
    // the numbers of the solution, which may be infinite; its report comes with the look
    found.set_item("told", to_pyobject(py, &account)?)?;
    found.set_item("shortfalls", shortfalls(&account, Skin::Keywords))?;
    let Solution { gap, pressure, contact_pressure, plastic_depth, .. } = solution;
    let fields = [gap, pressure, contact_pressure].map(|field| field.into_pyarray(py));
    for (name, field) in ["gap", "pressure", "contact_pressure"].into_iter().zip(&fields) {
        // what is found of them later is about what they are now
        field.readwrite().make_nonwriteable();
        found.set_item(name, field)?;
    }
    let depth = plastic_depth.map(|depth| depth.into_pyarray(py));
    depth.iter().for_each(|depth| drop(depth.readwrite().make_nonwriteable()));
    found.set_item("plastic_depth", depth)?;
    found.set_item("look", Look::at(sight, account, threads, fields))?;
    found.set_item("mode", mode.map(|mode| mode.into_pyarray(py)))?;
    // those of an accuracy
    if let Some(surface) = refined {
        found.set_item("heights", Topography::from(surface).heights.into_pyarray(py))?;
    }
    found.set_item("raised", raised)?;
    Ok(found)
}
