//! The inputs of a problem by the names of their keywords. The law has a file of its own.

use asperity_scene::allowed::Range;
use asperity_scene::dimension_of_key;
use asperity_scene::{Adhesion, After, Conductors, Elastic, Goal, Keys, Load, LoadKeys, Typed};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde::Deserialize;
use serde::de::value::Error;
use serde::de::{DeserializeOwned, IntoDeserializer};
use serde_pyobject::from_pyobject;

use crate::numbers::Field;
use crate::refusal::reason;

/// The value of a keyword by its name, which is one of `names`.
pub fn named<'a, V: Deserialize<'a>>(keyword: &str, name: &'a str, names: &str) -> PyResult<V> {
    let found: Result<V, Error> = V::deserialize(name.into_deserializer());
    found.map_err(|_| PyValueError::new_err(format!("{keyword} is {name}: it must be {names}")))
}

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

/// The number in the SI of a text with a unit.
#[pyfunction]
pub fn quantity(key: &str, text: &str) -> PyResult<f64> {
    let refused = |expected| PyValueError::new_err(format!("{key} is {text}: {expected}"));
    let dimension =
        dimension_of_key(key).ok_or_else(|| refused("it must be a number, which has no unit".to_owned()))?;
    let found = dimension.within(Range::FINITE)(text).map_err(refused)?;
    let number = || refused(format!("give a number, or a text with a unit of {}", dimension.what));
    if found.has_unit { Ok(found.value) } else { Err(number()) }
}

/// A load as Python passes it: the name of the keyword and its numbers.
pub type Given = (String, Vec<f64>);

/// The load of a keyword.
pub fn load((name, numbers): &Given) -> PyResult<Load> {
    let keys = if name == "spring" { vec!["spring_stiffness", "spring_position"] } else { vec![name.as_str()] };
    let typed = keys.into_iter().zip(numbers).map(|(key, number)| (key.to_owned(), Typed::Number(*number)));
    let known: Vec<_> = LoadKeys::KEYS.iter().collect();
    asperity_scene::Given::read(&known, typed).and_then(|given| given.load()).map_err(reason)
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

/// A hardness as Python passes it: a number, or an array.
#[derive(FromPyObject)]
pub enum Hardness<'py> {
    Number(f64),
    Map(Field<'py>),
}

/// The findings after a solve as Python passes them: whether the stiffness is one, resistivities or conductivities of
/// both bodies, and the relative distance of the bounds of the transmissivity.
pub type Following = (bool, Option<(f64, f64)>, Option<(f64, f64)>, Option<f64>);

/// The findings that are asked for after a solve.
pub fn after(given: Following, elastic: &Elastic, adhesion: &Adhesion) -> PyResult<After> {
    let (stiffness, resistivities, conductivities, leakage) = given;
    if let Some(given) = leakage.filter(|share| !(*share > 0.0 && *share < 1.0)) {
        return Err(PyValueError::new_err(format!("leakage is {given}: it must be a share between 0 and 1")));
    }
    let conductors = Conductors::of(resistivities, conductivities).map_err(reason)?;
    let after = After { stiffness, conductors, percolation: false, leakage };
    after.check(elastic, adhesion).map_err(reason)?;
    Ok(after)
}

/// An accuracy as Python passes it: the relative error, the name of the quantity, and the memory in GiB.
pub type Accuracy = (Option<f64>, Option<String>, Option<f64>);

/// The accuracy, if one is asked for.
pub fn goal((accuracy, of, memory): Accuracy) -> PyResult<Option<Goal>> {
    let Some(accuracy) = accuracy else {
        return match (of, memory) {
            (None, None) => Ok(None),
            _ => {
                Err(PyValueError::new_err("accuracy_of and memory are of an accuracy: give accuracy, as 0.01 for 1 %"))
            }
        };
    };
    let of = of.as_deref().unwrap_or("area");
    let of = named("accuracy_of", of, "one of area, gap, approach, pressure, stiffness")?;
    match memory.filter(|&memory| memory <= 0.0 || memory.is_nan()) {
        None => Ok(Some(Goal { accuracy, of, memory })),
        Some(memory) => Err(PyValueError::new_err(format!("memory is {memory}: it must be positive, in GiB"))),
    }
}
