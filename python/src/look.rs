//! The look at a solution: what is found of its fields once it is asked for.

use std::sync::{Mutex, PoisonError};

use asperity::contact::ContactStatistics;
use asperity::{Grid, Real, Report};
use numpy::ndarray::ArrayView2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::Scalar;
use crate::pools::Pool;
use crate::refusal::refusal;
use crate::report;
use crate::sight::{Estimate, Sight};

/// A sight in either precision, with the fields.
trait Looks: Send + Sync {
    fn look<'py>(&self, py: Python<'py>) -> PyResult<(Statistics<'py>, Bound<'py, PyDict>)>;
}

struct Seen<T: Scalar> {
    sight: Sight<T>,
    grid: Grid,
    report: Report,
    estimate: Mutex<Option<Estimate>>,
    gap: Py<PyArray2<T>>,
    pressure: Py<PyArray2<T>>,
    contact_pressure: Py<PyArray2<T>>,
}

/// The look at a solution, whose fields it holds.
#[pyclass(frozen, module = "asperity._asperity")]
pub struct Look(Box<dyn Looks>);

impl Look {
    /// The look at gap, pressure and contact pressure, with the grid and the report of the solution.
    pub fn at<T: Scalar>(
        mut sight: Sight<T>,
        (grid, report): (Grid, Report),
        fields: [&Bound<'_, PyArray2<T>>; 3],
    ) -> Self {
        let estimate = Mutex::new(sight.estimate.take());
        let [gap, pressure, contact_pressure] = fields.map(|field| field.clone().unbind());
        Self(Box::new(Seen { sight, grid, report, estimate, gap, pressure, contact_pressure }))
    }
}

#[pymethods]
impl Look {
    /// The statistics of the contact, and the entries of the report that the fields have.
    fn found<'py>(&self, py: Python<'py>) -> PyResult<(Statistics<'py>, Bound<'py, PyDict>)> {
        self.0.look(py)
    }
}

impl<T: Scalar> Looks for Seen<T> {
    fn look<'py>(&self, py: Python<'py>) -> PyResult<(Statistics<'py>, Bound<'py, PyDict>)> {
        let (Sight { law, original, threads, .. }, report) = (&self.sight, &self.report);
        let [gap, pressure, contact_pressure] =
            [&self.gap, &self.pressure, &self.contact_pressure].map(|field| field.bind(py).readonly());
        let [gap, pressure, contact_pressure] = [&gap, &pressure, &contact_pressure].map(|field| field.as_array());
        let statistics = || match original {
            Some(original) => original.statistics_of_fields(gap, contact_pressure, report.modulus, law),
            None => {
                let body = (report.boundary, report.modulus);
                ContactStatistics::of_fields(gap, contact_pressure, &self.grid, body, law)
            }
        };
        let errors = || {
            let mut estimate = self.estimate.lock().unwrap_or_else(PoisonError::into_inner);
            estimate.as_mut().map(|estimate| estimate.errors(report))
        };
        let all = || rayon::join(statistics, || rayon::join(|| extremes(pressure), errors));
        let pool = Pool::of(*threads)?;
        let (found, (pressures, errors)) = py.detach(|| pool.get().install(all));
        let found = found.map_err(refusal)?;
        let entries = report::of_fields(py, &found, pressures, errors.as_ref())?;
        Ok((statistics_of(py, found), entries))
    }
}

/// The least and the greatest value of a field.
fn extremes<T: Real>(field: ArrayView2<'_, T>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    field.iter().fold(none, |(low, high), value| (low.min(value.widen()), high.max(value.widen())))
}

/// Nodes in contact, their share, its corrected value, the perimeter, sizes of clusters, and the shares of the nodes
/// that repel, attract and do not notice each other.
type Statistics<'py> = (usize, f64, f64, f64, Bound<'py, PyArray1<i64>>, f64, f64, f64);

/// The statistics of a contact, in the order of those of Python.
fn statistics_of(py: Python<'_>, found: ContactStatistics) -> Statistics<'_> {
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
