//! What follows a solve: percolation and leakage of a gap, and conductance of a contact.

use asperity::Grid;
use asperity_flow::{Axis, Conductance, Gap, Leakage, Percolation};
use asperity_scene::{Boundary, Choice, LeakAsked, Skin};
use numpy::ndarray::{Array2, ArrayView2};
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::numbers::Field;
use crate::pools::apart;
use crate::refusal::refusal;
use crate::report::reported;
use crate::running::{GoesOn, until_interrupted};

/// The gap at a constriction, its node, and the nodes of the widest passage, in rows of two.
type Narrowest<'py> = (f64, (usize, usize), Bound<'py, PyArray2<i64>>);

/// The constriction along an axis, if the gap is open along it.
fn narrowest<'py>(py: Python<'py>, found: &Percolation, axis: Axis) -> Option<Narrowest<'py>> {
    let found = found.along(axis)?;
    let path: Vec<_> = found.path.iter().map(|&(i, j)| [i as i64, j as i64]).collect();
    Some((found.gap, found.node, Array2::from(path).into_pyarray(py)))
}

/// A gap on its grid, of a solution or of an array.
fn gap_on(values: ArrayView2<'_, f64>, lengths: (f64, f64), solved: bool) -> asperity::Result<Gap<'_>> {
    let grid = Grid::new(values.dim(), lengths)?;
    if solved { Gap::of_solution(values, grid) } else { Gap::new(values, grid) }
}

/// The constrictions of the gap of a solution along x and along y.
#[pyfunction]
pub fn percolation<'py>(
    py: Python<'py>,
    gap: Field<'_>,
    lengths: (f64, f64),
    boundary: &str,
) -> PyResult<(Option<Narrowest<'py>>, Option<Narrowest<'py>>)> {
    let (values, periodic) = (gap.as_array(), boundary != "free");
    let find = || gap_on(values, lengths, true).map(|gap| if periodic { gap } else { gap.free() }.percolation());
    let found = py.detach(find).map_err(refusal)?;
    Ok((narrowest(py, &found, Axis::X), narrowest(py, &found, Axis::Y)))
}

/// The leakage through a gap: what its report has, what falls short, and for each axis pressure, flow and constriction.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "called by the Python layer alone, by position")]
pub fn leakage<'py>(
    py: Python<'py>,
    gap: Field<'_>,
    solved: bool,
    lengths: (f64, f64),
    boundary: &str,
    absent_gap: Option<f64>,
    viscosity: Option<f64>,
    tolerance: f64,
    max_iterations: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let unknown = || PyValueError::new_err(format!("boundary is {boundary:?}: it must be 'periodic' or 'free'"));
    let boundary = Boundary::named(boundary).ok_or_else(unknown)?;
    if let Some(given) = viscosity.filter(|viscosity| !(*viscosity > 0.0 && viscosity.is_finite())) {
        return Err(PyValueError::new_err(format!("viscosity is {given}: it must be positive and finite")));
    }
    let settings = Leakage::default().tolerance(tolerance).max_iterations(max_iterations);
    let asked = LeakAsked { boundary, absent_gap, settings, viscosity, grid_error: true };
    // the thread may outlive this call
    let values = gap.as_array().to_owned();
    let find = move |goes_on: GoesOn<'_>| asked.find_while(gap_on(values.view(), lengths, solved)?, goes_on);
    let (leak, leaked) = until_interrupted(py, find)?.map_err(refusal)?;
    let found = PyDict::new(py);
    found.set_item("report", reported(py, &leaked)?)?;
    found.set_item("shortfall", leaked.shortfall(Skin::Keywords))?;
    for axis in Axis::BOTH {
        let flow = leak.along(axis);
        let [x, y] = flow.flow.clone();
        let fields = (flow.pressure.clone().into_pyarray(py), x.into_pyarray(py), y.into_pyarray(py));
        found.set_item(axis.name(), (fields, narrowest(py, &leak.percolation, axis)))?;
    }
    Ok(found)
}

/// The conductance of spots of contact per area and of the whole map, and its relative error.
#[pyfunction]
pub fn conductance(
    py: Python<'_>,
    contact: PyReadonlyArray2<'_, bool>,
    lengths: (f64, f64),
    boundary: &str,
    resistivities: (f64, f64),
) -> PyResult<(f64, f64, f64)> {
    let (contact, periodic) = (contact.as_array(), boundary != "free");
    let find = || Conductance::of_spots(contact, Grid::new(contact.dim(), lengths)?, periodic, resistivities);
    let found = apart(py, find)?;
    Ok((found.per_area, found.whole, found.relative_error))
}
