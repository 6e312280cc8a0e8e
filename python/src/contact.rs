//! The contact of a solution: the clusters of a map, the distribution of its pressure, and the colours of both.

use asperity::Grid;
use asperity::contact::{Clusters, PressureDistribution};
use asperity_plot::{Colouring, DPI, LoadScale, Map};
use asperity_scene::Boundary;
use asperity_scene::contact::ContactTables;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::numbers::{Field, whole};
use crate::refusal::refusal;
use crate::report::reported;

/// Sizes and labels of clusters.
type Labels<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<i64>>);

/// The clusters of a map; opposite sides meet if it is periodic.
#[pyfunction]
pub fn clusters<'py>(py: Python<'py>, map: PyReadonlyArray2<'_, bool>, periodic: bool) -> Labels<'py> {
    let map = map.as_array();
    let found = py.detach(|| if periodic { Clusters::of(map) } else { Clusters::of_part(map) });
    (whole(py, found.sizes), found.labels.mapv(|label| label as i64).into_pyarray(py))
}

/// The colours of maps, as [`Colouring::steps`] has them: red, green and blue in a row each.
#[pyfunction]
pub fn palette<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let colouring = match name {
        "sequential" => Colouring::Sequential,
        "diverging" => Colouring::Diverging,
        "contact" => Colouring::Contact,
        "clusters" => Colouring::Clusters,
        _ => return Err(PyValueError::new_err(format!("there is no palette {name:?}"))),
    };
    Ok(Array2::from(colouring.steps()).into_pyarray(py))
}

/// The picture of a contact map, as the text of an SVG file.
#[pyfunction]
pub fn contact_picture(
    contact: PyReadonlyArray2<'_, bool>,
    lengths: (f64, f64),
    unit: Option<&str>,
) -> PyResult<String> {
    let values = contact.as_array().mapv(f64::from);
    let grid = Grid::new(values.dim(), lengths).map_err(refusal)?;
    let map = Map { length_unit: unit, ..Map::new(values.view(), grid, Colouring::Contact) };
    map.draw(DPI).and_then(|picture| picture.svg()).map_err(refusal)
}

/// The end of the scale of the positive pressures, the greatest of them, and the share of their load beyond the end.
#[pyfunction]
pub fn load_scale(pressure: Field<'_>, end: Option<f64>) -> (f64, f64, f64) {
    let LoadScale { end, greatest, beyond, .. } = LoadScale::from_values(&pressure.as_array(), end);
    (end, greatest, beyond)
}

/// Density and edges of a distribution.
type Density<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// The distribution of a contact pressure next to its gap.
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

/// The tables of a contact: its figures, for gap and pressure density and edges, the autocorrelation by rows of distance
/// and value, and the clusters by rows of nodes, area, perimeter and force.
#[pyfunction]
pub fn contact_tables<'py>(
    py: Python<'py>,
    gap: Field<'_>,
    contact_pressure: Field<'_>,
    lengths: (f64, f64),
    boundary: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let (gap, pressure) = (gap.as_array(), contact_pressure.as_array());
    let is_original = boundary == "original";
    let boundary = if boundary == "periodic" { Boundary::Periodic } else { Boundary::Free };
    let find = || ContactTables::measure(gap, pressure, Grid::new(gap.dim(), lengths)?, boundary, is_original);
    let tables = py.detach(find).map_err(refusal)?;
    let found = PyDict::new(py);
    found.set_item("figures", reported(py, &tables.figures())?)?;
    let ContactTables { gap, pressure, autocorrelation, spots, .. } = tables;
    for (name, of) in [("gap", gap), ("pressure", pressure)] {
        found.set_item(name, (of.density.into_pyarray(py), of.edges.into_pyarray(py)))?;
    }
    let rows: Vec<[f64; 2]> = autocorrelation.into_iter().map(Into::into).collect();
    found.set_item("autocorrelation", Array2::from(rows).into_pyarray(py))?;
    let rows: Vec<_> = spots.iter().map(|spot| [spot.nodes as f64, spot.area, spot.perimeter, spot.force]).collect();
    found.set_item("clusters", Array2::from(rows).into_pyarray(py))?;
    Ok(found)
}
