//! The inputs of a problem by the names of their keywords. The law has a file of its own.

use asperity::Control;
use asperity_scene::Goal;
use asperity_scene::units::dimension_of_key;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Deserialize;
use serde::de::value::Error;
use serde::de::{DeserializeOwned, IntoDeserializer};
use serde_pyobject::from_pyobject;

/// The value of a keyword by its name, which is one of `names`.
pub fn named<'a, V: Deserialize<'a>>(keyword: &str, name: &'a str, names: &str) -> PyResult<V> {
    let found: Result<V, Error> = V::deserialize(name.into_deserializer());
    found.map_err(|_| PyValueError::new_err(format!("{keyword} is {name}: it must be {names}")))
}

/// What a dictionary of keys and values describes.
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

/// The number in the SI of a text with a unit.
#[pyfunction]
pub fn quantity(key: &str, text: &str) -> PyResult<f64> {
    let refused = |expected| PyValueError::new_err(format!("{key} is {text}: {expected}"));
    let dimension =
        dimension_of_key(key).ok_or_else(|| refused("it must be a number, which has no unit".to_owned()))?;
    let found = dimension.finite()(text).map_err(refused)?;
    let number = || refused(format!("give a number, or a text with a unit of {}", dimension.what));
    if found.has_unit { Ok(found.value) } else { Err(number()) }
}

/// A load as Python passes it: the name of the keyword and its numbers.
pub type Load = (String, Vec<f64>);

/// The control of a load.
pub fn control((name, numbers): &Load) -> PyResult<Control> {
    match (name.as_str(), numbers.as_slice()) {
        ("mean_gap", &[gap]) => Ok(Control::MeanGap(gap)),
        ("mean_pressure", &[pressure]) => Ok(Control::MeanPressure(pressure)),
        ("normal_force", &[force]) => Ok(Control::Force(force)),
        ("approach", &[approach]) => Ok(Control::Approach(approach)),
        ("spring", &[stiffness, rest]) => Ok(Control::Spring { stiffness, rest }),
        // of no meaning before it is found
        ("contact_fraction", &[_]) => Ok(Control::MeanPressure(0.0)),
        (name, numbers) => Err(PyValueError::new_err(format!("{name} is no load with {} numbers", numbers.len()))),
    }
}

/// The contact fraction of a load, if its load is to be found.
pub fn contact_fraction((name, numbers): &Load) -> Option<f64> {
    if let ("contact_fraction", &[fraction]) = (name.as_str(), numbers.as_slice()) { Some(fraction) } else { None }
}

/// An accuracy as Python passes it: the relative error, the name of the quantity, and the memory in GiB.
pub type Accuracy = (f64, String, Option<f64>);

/// The accuracy that is asked for.
pub fn goal((accuracy, of, memory): Accuracy) -> PyResult<Goal> {
    let of = named("accuracy_of", &of, "one of area, gap, pressure, stiffness")?;
    match memory.filter(|&memory| memory <= 0.0 || memory.is_nan()) {
        None => Ok(Goal { accuracy, of, memory }),
        Some(memory) => Err(PyValueError::new_err(format!("memory is {memory}: it must be positive, in GiB"))),
    }
}
