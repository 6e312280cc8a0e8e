//! The contact of a solution: the clusters of a map.

use asperity::contact::{Clusters, Connectivity};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

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
