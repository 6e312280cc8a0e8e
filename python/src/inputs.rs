//! The inputs of a problem besides its keywords.

use asperity_maps::Topography;
use asperity_scene::allowed::Range;
use asperity_scene::{Quantities, Quantity, QuantityEntry, Skin, dimension_of_key, numbers};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::de::DeserializeOwned;
use serde_pyobject::from_pyobject;

use crate::numbers::Field;

/// The object that a dictionary of keys and values describes.
pub fn keys<V: DeserializeOwned>(given: Bound<'_, PyAny>) -> PyResult<V> {
    let py = given.py();
    from_pyobject(given).map_err(|error| match error.0 {
        // an error of a value, in words
        refused if refused.is_instance_of::<PyRuntimeError>(py) => PyValueError::new_err(refused.value(py).to_string()),
        error => error,
    })
}

/// Whether the numbers of a keyword have a dimension.
#[pyfunction]
pub fn has_dimension(key: &str) -> bool {
    dimension_of_key(key).is_some()
}

/// The number in SI units of a text with a unit.
#[pyfunction]
pub fn quantity(key: &str, text: &str) -> PyResult<f64> {
    Ok(measured(key, text)?.value)
}

/// A number with its unit, if that is known, and with a prefix in SI units.
#[pyfunction]
pub fn shown(value: f64, unit: Option<&str>) -> String {
    match unit {
        Some(unit @ ("m" | "Pa" | "N" | "m³")) => numbers::si(value, unit),
        unit => format!("{} {}", numbers::plain(value), unit.unwrap_or_default()).trim_end().to_owned(),
    }
}

/// The values of keywords, with numbers in SI units in the place of texts with units, which all quantities have or none
/// has, and whether they have.
#[pyfunction]
pub fn in_si<'py>(given: Vec<(String, Bound<'py, PyAny>)>) -> PyResult<(Vec<Bound<'py, PyAny>>, bool)> {
    let mut found = Vec::new();
    let values = given.iter().map(|(key, value)| read(key, value, &mut found)).collect::<PyResult<_>>()?;
    let quantities: Quantities = found.into_iter().collect();
    quantities.check(Skin::Keywords).map_err(PyValueError::new_err)?;
    Ok((values, quantities.is_si()))
}

/// The value of a keyword; its quantities are `found`.
fn read<'py>(key: &str, value: &Bound<'py, PyAny>, found: &mut Vec<QuantityEntry>) -> PyResult<Bound<'py, PyAny>> {
    if value.is_none() || value.is_instance_of::<PyBytes>() || !has_dimension(key) {
        return Ok(value.clone());
    }
    if let Ok(text) = value.extract::<String>() {
        let quantity = measured(key, &text)?;
        found.push(QuantityEntry::new(key, vec![text], &[quantity], false));
        return quantity.value.into_bound_py_any(value.py());
    }
    if let Ok(items) = value.try_iter() {
        let items = items.map(|item| read(key, &item?, found)).collect::<PyResult<Vec<_>>>()?;
        return items.into_bound_py_any(value.py());
    }
    // zero is zero in all units
    if value.ne(0)? {
        found.push(QuantityEntry::new(key, vec![value.repr()?.to_string()], &[Quantity::bare(f64::NAN)], false));
    }
    Ok(value.clone())
}

/// The quantity of a text with a unit.
pub fn measured(key: &str, text: &str) -> PyResult<Quantity> {
    let refused = |expected| PyValueError::new_err(format!("{key} is {text}: {expected}"));
    let dimension =
        dimension_of_key(key).ok_or_else(|| refused("it must be a number, which has no unit".to_owned()))?;
    let found = dimension.within(Range::FINITE)(text).map_err(refused)?;
    let number = || refused(format!("give a number, or a string with a unit of {}", dimension.what));
    if found.has_unit { Ok(found) } else { Err(number()) }
}

/// The map of a problem, by attributes of Python.
#[derive(FromPyObject)]
pub struct Map<'py> {
    heights: Field<'py>,
    pub lengths: Option<(f64, f64)>,
    pub unit: Option<String>,
    /// The nodes of the original of a mirrored one
    original: Option<(usize, usize)>,
    periodic: Option<bool>,
    seed: Option<u64>,
    scars_removed: Option<f64>,
    source: Option<String>,
    #[pyo3(attribute("_unread"))]
    unread: Vec<String>,
}

impl Map<'_> {
    /// The map of the library, without the names of what else is in its file.
    pub fn topography(&self) -> PyResult<Topography> {
        let mut map = Topography::new(self.heights.to_array()?);
        (map.lengths, map.unit, map.original) = (self.lengths, self.unit.clone(), self.original);
        (map.seed, map.scars_removed, map.periodic) = (self.seed, self.scars_removed, self.periodic);
        Ok(map)
    }

    /// The map with its name, as a case takes it.
    pub fn named(self) -> PyResult<asperity_scene::Map> {
        let mut map = self.topography()?;
        map.unread = self.unread;
        Ok(asperity_scene::Map::whole(self.source, map))
    }
}

/// The gap from which to start as Python passes it: a word for it, or an array.
#[derive(FromPyObject)]
pub enum Begin<'py> {
    Word(String),
    Gap(Field<'py>),
}

impl Begin<'_> {
    /// The word of reports.
    pub fn word(&self) -> &'static str {
        if let Self::Word(_) = self { "apart" } else { "array" }
    }
}
