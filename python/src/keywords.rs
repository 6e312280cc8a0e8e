//! What was given for the keys of a scene, as keywords.

use asperity_scene::{
    Adhesion, AdhesionKeys, Entries, Input, Key, Keys, Quantities, Skin, SolverKeys, SurfaceKeys, key,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyFloat};

use crate::law::Law;
use crate::refusal::reason;

/// What a dictionary of keywords gives for the keys of `lists`.
pub fn read(lists: &[&'static [Key]], keywords: &Bound<'_, PyDict>) -> PyResult<Entries> {
    let of = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key: String = key.extract()?;
        let typed = typed(&key, &value)?;
        Ok((key, typed))
    };
    let typed = keywords.iter().map(of).collect::<PyResult<Vec<_>>>()?;
    Entries::read(lists, typed).map_err(reason)
}

/// The value of a keyword: a truth value, a text, a number, or several.
fn typed(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Input> {
    // at once what most values are: each of the other ways that fails makes an exception
    if let Ok(value) = value.cast::<PyFloat>() {
        return Ok(Input::Number(value.value()));
    }
    if let Ok(value) = value.extract() {
        return Ok(Input::Switch(value));
    }
    if let Ok(text) = value.extract() {
        return Ok(Input::Text(text));
    }
    if let (Ok(items), false) = (value.try_iter(), value.is_instance_of::<PyBytes>()) {
        let items = items.map(|item| typed(key, &item?)).collect::<PyResult<Vec<_>>>()?;
        if items.iter().any(|item| matches!(item, Input::Several(_))) {
            let shape = value
                .getattr("shape")
                .map_or_else(|_| "a list of lists".to_owned(), |shape| format!("an array of shape {shape}"));
            let map = if key == key!(Adhesion, work_of_adhesion) {
                "; for a map give law=asperity.Varying(law, works)"
            } else {
                ""
            };
            return Err(PyTypeError::new_err(format!(
                "{key} is {shape}: it must be one value, or a list of them{map}"
            )));
        }
        return Ok(Input::Several(items));
    }
    if let Ok(value) = value.extract() {
        return Ok(Input::Whole(value));
    }
    if let Ok(value) = value.extract::<i64>() {
        return Ok(Input::Text(value.to_string()));
    }
    value.extract().map(Input::Number).or_else(|_| {
        let value = value.repr()?;
        let message =
            "it must be a number, in units that fit the others, such as 70e9 for 70 GPa in Pa, or a string with a unit";
        Err(PyTypeError::new_err(format!("{key} is {value}: {message}")))
    })
}

/// What was given for the keys of a problem.
#[pyclass(frozen, module = "asperity._asperity")]
pub struct Keywords {
    pub given: Entries,
    pub law: Option<Law>,
    pub quantities: Quantities,
    /// Whether numbers without a unit are in SI units
    pub numbers_are_si: bool,
}

/// The quantities of keywords, whose numbers without a unit may be in SI units.
pub fn quantities_of(given: &Entries, numbers_are_si: bool) -> Quantities {
    if numbers_are_si { given.quantities().in_si() } else { given.quantities() }
}

#[pymethods]
impl Keywords {
    #[new]
    #[pyo3(signature = (keywords, law, numbers_are_si=false))]
    fn new(keywords: &Bound<'_, PyDict>, law: Option<&Bound<'_, PyAny>>, numbers_are_si: bool) -> PyResult<Self> {
        let given = read(&[SurfaceKeys::KEYS, AdhesionKeys::KEYS, SolverKeys::KEYS], keywords)?;
        let law = law.map(Law::from_object).transpose()?;
        let of_law = law.as_ref().map(|law| law.given.quantities()).unwrap_or_default();
        let quantities = Quantities::all([quantities_of(&given, numbers_are_si), of_law]);
        // the numbers of a law in SI units say nothing of units
        if !numbers_are_si {
            quantities.check(Skin::Keywords).map_err(reason)?;
        }
        Ok(Self { given, law, quantities, numbers_are_si })
    }

    /// The numbers of a key, in SI units if they have units.
    fn numbers(&self, key: &str) -> Option<Vec<f64>> {
        self.given.numbers(key)
    }

    /// Whether quantities have units.
    #[getter]
    fn is_si(&self) -> bool {
        self.quantities.is_si()
    }
}
