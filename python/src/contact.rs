//! The contact of a solution: its statistics, and the clusters of a map.

use asperity::Grid;
use asperity::contact::{Clusters, Connectivity, ContactStatistics};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::account::Scalar;
use crate::answer::{Statistics, statistics};
use crate::inputs::Beyond;
use crate::law::law;
use crate::refusal::refusal;

/// The statistics of a gap and a contact pressure, both in `f64` or both in `f32`.
#[pyfunction]
pub fn contact_statistics<'py>(
    gap: &Bound<'py, PyAny>,
    contact_pressure: &Bound<'py, PyAny>,
    lengths: (f64, f64),
    boundary: &str,
    given: &Bound<'py, PyAny>,
) -> PyResult<Statistics<'py>> {
    let scene = (lengths, Beyond::of(boundary)?);
    match gap.cast::<PyArray2<f32>>() {
        Ok(_) => of_fields::<f32>(gap, contact_pressure, scene, given),
        Err(_) => of_fields::<f64>(gap, contact_pressure, scene, given),
    }
}

fn of_fields<'py, T: Scalar>(
    gap: &Bound<'py, PyAny>,
    contact_pressure: &Bound<'py, PyAny>,
    (lengths, beyond): ((f64, f64), Beyond),
    given: &Bound<'py, PyAny>,
) -> PyResult<Statistics<'py>> {
    let (py, law) = (gap.py(), law::<T>(given)?);
    let gap = gap.extract::<PyReadonlyArray2<'_, T>>()?;
    let contact_pressure = contact_pressure.extract::<PyReadonlyArray2<'_, T>>()?;
    let (gap, contact_pressure) = (gap.as_array(), contact_pressure.as_array());
    let found = py.detach(|| {
        let grid = Grid::new(gap.dim(), lengths)?;
        ContactStatistics::of_fields(gap, contact_pressure, (&grid, beyond.boundary(grid)), &law)
    });
    Ok(statistics(py, found.map_err(refusal)?))
}

/// Sizes and labels of clusters.
type Found<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<i64>>);

/// The clusters of a map.
#[pyfunction]
pub fn clusters<'py>(py: Python<'py>, map: PyReadonlyArray2<'_, bool>, corners: bool) -> PyResult<Found<'py>> {
    let map = map.as_array();
    let connectivity = if corners { Connectivity::Corners } else { Connectivity::Sides };
    let Clusters { sizes, labels, .. } = py.detach(|| Clusters::of(map, connectivity));
    let sizes: Vec<i64> = sizes.into_iter().map(|size| size as i64).collect();
    Ok((sizes.into_pyarray(py), labels.mapv(|label| label as i64).into_pyarray(py)))
}
