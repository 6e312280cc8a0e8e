//! The numbers of a law as they were typed, with a unit or without one.

use asperity_scene::dimension_of_key;
use asperity_scene::numbers::plain;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::inputs::quantity;

/// A number as it is typed: as one, or as a text with a unit.
#[derive(FromPyObject)]
pub enum Measure {
    #[pyo3(transparent, annotation = "float")]
    Number(f64),
    #[pyo3(transparent, annotation = "str")]
    Text(String),
}

/// The numbers of a law as they were typed, by their names in reports: all with units, or none.
#[derive(Clone, Default)]
pub struct Given {
    /// Those with a unit
    pub texts: Vec<(String, String)>,
    /// The first one without, if it has a dimension
    pub bare: Option<(String, f64)>,
}

impl Given {
    /// The number that was typed, in the SI if it has a unit.
    pub fn read(&mut self, key: &str, typed: Measure) -> PyResult<f64> {
        let value = match typed {
            Measure::Number(value) => {
                // zero is zero in all units
                if value != 0.0 && dimension_of_key(key).is_some() {
                    self.bare.get_or_insert_with(|| (key.to_owned(), value));
                }
                value
            }
            Measure::Text(text) => {
                let value = quantity(key, &text)?;
                self.texts.push((key.to_owned(), text));
                value
            }
        };
        match (&self.bare, self.texts.first()) {
            (Some((key, value)), Some((with, text))) => Err(PyValueError::new_err(format!(
                "{key} is {}, without a unit, but {with} {text} has one: give both units, or neither",
                plain(*value)
            ))),
            _ => Ok(value),
        }
    }
}
