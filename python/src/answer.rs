//! The answer to a solve: the dictionary in which Python gets an account.

use asperity::Solution;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::{Account, Reached, Scalar};
use crate::look::Look;
use crate::refusal::refusal;
use crate::report;

/// The dictionary of an account, and the exception that ended its solve early.
pub fn answer<'py, T: Scalar>(
    py: Python<'py>,
    found: (asperity::Result<Account<T>>, Option<PyErr>),
) -> PyResult<Bound<'py, PyDict>> {
    let (account, raised) = match found {
        (Ok(account), raised) => (account, raised),
        (Err(_), Some(raised)) => return Err(raised),
        (Err(error), None) => return Err(refusal(error)),
    };
    let found = PyDict::new(py);
    found.set_item("report", report::of(py, &account)?)?;
    let Account { solution, sight, stability, reached, .. } = account;
    let Solution { gap, pressure, contact_pressure, grid, report, .. } = solution;
    found.set_item("tolerance", report.tolerance)?;
    let fields = [gap, pressure, contact_pressure].map(|field| field.into_pyarray(py));
    for (name, field) in ["gap", "pressure", "contact_pressure"].into_iter().zip(&fields) {
        // what is found of them later is about what they are now
        field.readwrite().make_nonwriteable();
        found.set_item(name, field)?;
    }
    found.set_item("look", Look::at(sight, (grid, report), [&fields[0], &fields[1], &fields[2]]))?;
    found.set_item("mode", stability.map(|stability| stability.mode.into_pyarray(py)))?;
    // the grid of an accuracy, and what keeps it from being finer
    if let Some(Reached { heights, refinable, unaffordable, .. }) = reached {
        found.set_item("heights", heights.into_pyarray(py))?;
        found.set_item("refinable", refinable)?;
        found.set_item("unaffordable", unaffordable)?;
    }
    found.set_item("raised", raised)?;
    Ok(found)
}
