//! The answer to a solve: the dictionary in which Python gets an account.

use asperity::contact::ContactStatistics;
use numpy::IntoPyArray;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::{Account, Reached, Scalar};
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
    let Account { solution, contact, statistics: counted, stability, reached, .. } = account;
    found.set_item("tolerance", solution.report.tolerance)?;
    found.set_item("gap", solution.gap.into_pyarray(py))?;
    found.set_item("pressure", solution.pressure.into_pyarray(py))?;
    found.set_item("contact_pressure", solution.contact_pressure.into_pyarray(py))?;
    found.set_item("contact", contact.into_pyarray(py))?;
    found.set_item("mode", stability.map(|stability| stability.mode.into_pyarray(py)))?;
    found.set_item("statistics", counted.map(|counted| statistics(py, counted)))?;
    // the grid of an accuracy, and what keeps it from being finer
    if let Some(Reached { heights, refinable, unaffordable, .. }) = reached {
        found.set_item("heights", heights.into_pyarray(py))?;
        found.set_item("refinable", refinable)?;
        found.set_item("unaffordable", unaffordable)?;
    }
    found.set_item("raised", raised)?;
    Ok(found)
}

/// Nodes in contact, their share, its corrected value, the perimeter, sizes of clusters, and the shares of the nodes
/// that repel, attract and do not notice each other.
pub type Statistics<'py> = (usize, f64, f64, f64, Bound<'py, PyArray1<i64>>, f64, f64, f64);

/// The statistics of a contact, in the order of those of Python.
pub fn statistics(py: Python<'_>, found: ContactStatistics) -> Statistics<'_> {
    let sizes: Vec<i64> = found.cluster_sizes.iter().map(|&size| size as i64).collect();
    (
        found.contact_nodes,
        found.contact_fraction,
        found.corrected_contact_fraction,
        found.perimeter,
        sizes.into_pyarray(py),
        found.repulsive_fraction,
        found.attractive_fraction,
        found.apart_fraction,
    )
}
