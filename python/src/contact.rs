//! The contact of a solution: the clusters of a map, and the distribution of its pressure.

use asperity::contact::{Clusters, PressureDistribution};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::numbers::Field;
use crate::refusal::refusal;

/// Sizes and labels of clusters.
type Found<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<i64>>);

/// The clusters of a map.
#[pyfunction]
pub fn clusters<'py>(py: Python<'py>, map: PyReadonlyArray2<'_, bool>) -> PyResult<Found<'py>> {
    let map = map.as_array();
    let Clusters { sizes, labels, .. } = py.detach(|| Clusters::of(map));
    let sizes: Vec<i64> = sizes.into_iter().map(|size| size as i64).collect();
    Ok((sizes.into_pyarray(py), labels.mapv(|label| label as i64).into_pyarray(py)))
}

/// Density and edges of a distribution.
type Density<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// The distribution of a contact pressure beside its gap.
#[pyfunction]
pub fn pressure_distribution<'py>(
    py: Python<'py>,
    gap: Field<'_>,
    contact_pressure: Field<'_>,
    bins: i64,
) -> PyResult<Density<'py>> {
    let (gap, pressure) = (gap.as_array(), contact_pressure.as_array());
    // what is negative is refused as no bins are
    let bins = usize::try_from(bins).unwrap_or(0);
    let found = py.detach(|| PressureDistribution::of_fields(gap, pressure, bins)).map_err(refusal)?;
    Ok((found.density.into_pyarray(py), found.edges.into_pyarray(py)))
}
