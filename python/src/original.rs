//! The original of a mirrored map, for the numbers and fields that Python reports of it.

use asperity::Grid;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;

use crate::numbers::Field;
use crate::refusal::refusal;

/// The original of a mirrored map of some shape and side lengths: its first nodes along both axes.
#[pyclass(frozen, module = "asperity._asperity")]
pub struct Original(pub asperity::contact::Original);

#[pymethods]
impl Original {
    #[new]
    #[pyo3(signature = (shape, lengths, nodes))]
    fn new(shape: (usize, usize), lengths: (f64, f64), nodes: (usize, usize)) -> PyResult<Self> {
        let found = Grid::new(shape, lengths).and_then(|whole| asperity::contact::Original::new(&whole, nodes));
        found.map(Self).map_err(refusal)
    }

    /// Its numbers of nodes.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        self.0.grid().shape()
    }

    /// Its side lengths.
    #[getter]
    fn lengths(&self) -> (f64, f64) {
        self.0.grid().lengths()
    }

    /// The same part of the map with another number of nodes.
    fn on(&self, shape: (usize, usize)) -> PyResult<Self> {
        let found = Grid::new(shape, self.0.whole().lengths()).and_then(|whole| self.0.on(&whole));
        found.map(Self).map_err(refusal)
    }

    /// A field of the original, continued by its mirror images.
    fn mirrored<'py>(&self, py: Python<'py>, field: Field<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let whole = self.0.mirrored(&field.to_array()?).map_err(refusal)?;
        Ok(whole.into_pyarray(py))
    }
}
