//! What a user has typed, by its keys: numbers in the SI where they have units, switches, and words.

use asperity_scene::outcome::Outcome;
use asperity_scene::quantity::Quantity;
use asperity_scene::synonyms::similar;
use asperity_scene::units::dimension_of_key;
use asperity_scene::{Skin, list, worded};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The keys of words.
const WORDS: [&str; 13] = [
    "law",
    "wall",
    "boundary",
    "base",
    "precision",
    "method",
    "branch",
    "form",
    "unit",
    "align_rows",
    "scan_axis",
    "remove_form",
    "detrend",
];

/// The keys of lists of loads, each with that of one of them.
const LISTS: [(&str, &str); 6] = [
    ("mean_pressures", "mean_pressure"),
    ("mean_gaps", "mean_gap"),
    ("normal_forces", "normal_force"),
    ("approaches", "approach"),
    ("spring_positions", "spring_position"),
    ("reduced_pressures", "reduced_pressure"),
];

/// What was typed, by its keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Given {
    /// As it was typed: texts, lists of texts, and `true`.
    typed: Map<String, Value>,
    /// As the library takes it.
    values: Map<String, Value>,
    /// The keys of quantities with a unit, and the first one without.
    with_units: Vec<String>,
    bare: Option<String>,
}

impl Given {
    /// Reads an object of `known` keys and values, of which those that are empty count as not given.
    ///
    /// # Errors
    /// The key and the remedy, if it is not known or a value is none for it, and if some quantities have units and others
    /// have none.
    pub fn read(json: &str, known: &[&str]) -> Outcome<Self> {
        let all: Map<String, Value> = serde_json::from_str(json)?;
        let mut given = Self::default();
        for (key, value) in all {
            if !known.contains(&key.as_str()) {
                let names: Vec<_> = known.iter().map(|key| key.replace('_', "-")).collect();
                let meant = similar(&key, names.iter().map(String::as_str)).map(|meant| meant.replace('-', "_"));
                let remedy = meant.map_or("leave it out".to_owned(), |meant| format!("{meant} is"));
                return Err(format!("{key} is no key that is known here: {remedy}").into());
            }
            let typed = match value {
                Value::Array(items) => Value::Array(items.iter().map(|item| text(item).into()).collect()),
                Value::Bool(true) => Value::Bool(true),
                Value::Bool(false) | Value::Null => continue,
                other => text(&other).into(),
            };
            if [Value::from(""), Value::Array(Vec::new())].contains(&typed) {
                continue;
            }
            let value = match &typed {
                Value::Array(items) => {
                    let items = items.iter().map(|item| given.value(&key, item.as_str().unwrap_or_default()));
                    // collected first, as each item may be the first with a unit
                    Value::Array(items.collect::<Vec<_>>().into_iter().collect::<Outcome<_>>()?)
                }
                Value::String(text) => given.value(&key, text)?,
                other => other.clone(),
            };
            given.values.insert(key.clone(), value);
            given.typed.insert(key, typed);
        }
        match (given.with_units.first(), &given.bare) {
            (Some(with), Some(bare)) => Err(format!(
                "{bare} is {}, without a unit, but {with} {} has one: give both units, or neither",
                given.words(bare),
                given.words(with)
            )
            .into()),
            _ => Ok(given),
        }
    }

    /// The value of a text for a key.
    fn value(&mut self, key: &str, text: &str) -> Outcome<Value> {
        if let Some((_, one)) = LISTS.iter().find(|(list, _)| *list == key) {
            let number = |text: &str| quantity(one, text);
            let found = list::parsed(text, &number).map_err(|reason| format!("{key}: {reason}"))?;
            found.given.iter().for_each(|quantity| self.note(key, *quantity));
            return Ok(found.values.into());
        }
        if WORDS.contains(&key) {
            return Ok(text.into());
        }
        if let Ok(whole) = text.parse::<u64>()
            && dimension_of_key(key).is_none()
        {
            return Ok(whole.into());
        }
        let found = quantity(key, text).map_err(|reason| format!("{key} is {text}: {reason}"))?;
        self.note(key, found);
        Ok(found.value.into())
    }

    /// Notes whether a quantity has a unit.
    fn note(&mut self, key: &str, quantity: Quantity) {
        if quantity.has_unit {
            self.with_units.push(key.to_owned());
        } else if quantity.is_bare() {
            self.bare.get_or_insert_with(|| key.to_owned());
        }
    }

    /// What was typed for a key, on one line.
    fn words(&self, key: &str) -> String {
        match &self.typed[key] {
            Value::Array(items) => items.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" "),
            other => text(other),
        }
    }

    /// Whether quantities have units; then all numbers are in the SI.
    pub fn is_si(&self) -> bool {
        !self.with_units.is_empty()
    }

    /// The quantities as they were typed, if they have units.
    pub fn quantities(&self) -> Option<Value> {
        let of_dimension = |(key, _): &(&String, &Value)| {
            let one = LISTS.iter().find(|(list, _)| list == key).map_or(key.as_str(), |(_, one)| one);
            dimension_of_key(one).is_some()
        };
        let typed = || self.typed.iter().filter(of_dimension).map(|(key, value)| (key.clone(), value.clone()));
        self.is_si().then(|| typed().collect::<Map<_, _>>().into())
    }

    /// All that was typed.
    pub fn typed(&self) -> &Map<String, Value> {
        &self.typed
    }

    /// Whether a key is given.
    pub fn has(&self, key: &str) -> bool {
        self.values.contains_key(key)
    }

    /// Takes the number of a key.
    pub fn number(&mut self, key: &str) -> Option<f64> {
        self.values.remove(key)?.as_f64()
    }

    /// Takes the numbers of a key: of a list, or one.
    pub fn numbers(&mut self, key: &str) -> Option<Vec<f64>> {
        Some(match self.values.remove(key)? {
            Value::Array(all) => all.iter().filter_map(Value::as_f64).collect(),
            one => one.as_f64().into_iter().collect(),
        })
    }

    /// Takes a switch.
    pub fn switch(&mut self, key: &str) -> bool {
        self.values.remove(key).is_some_and(|value| value == Value::Bool(true))
    }

    /// Takes the side lengths of a map of a shape by one of them, which means square cells, or two.
    pub fn lengths(&mut self, (nx, ny): (usize, usize)) -> Option<(f64, f64)> {
        match self.numbers("lengths")?[..] {
            [lx, ly, ..] => Some((lx, ly)),
            [lx] => Some((lx, lx / nx as f64 * ny as f64)),
            [] => None,
        }
    }

    /// The object of some keys, which are taken, with `defaults` for those that are not given.
    ///
    /// # Errors
    /// The value that is none for its key.
    pub fn take<T: DeserializeOwned>(&mut self, keys: &[&str], defaults: Value) -> Outcome<T> {
        let mut object = defaults.as_object().cloned().unwrap_or_default();
        object.extend(keys.iter().filter_map(|key| Some(((*key).to_owned(), self.values.remove(*key)?))));
        let words: Vec<_> =
            object.iter().filter_map(|(key, value)| Some((key.clone(), value.as_str()?.to_owned()))).collect();
        serde_json::from_value(object.into()).map_err(|error| {
            // of a word that is none of its key, serde tells the word alone
            let told = error.to_string();
            let Some(expected) = told.strip_prefix("unknown variant ") else { return told.into() };
            let wrong = words.iter().find(|(_, word)| expected.starts_with(&format!("`{word}`")));
            let Some((key, word)) = wrong else { return told.into() };
            let names = expected.split_once("expected ").map_or("", |(_, names)| names).replace('`', "");
            format!("{key} is {word}: it must be {}", names.trim_start_matches("one of ")).into()
        })
    }
}

/// A number with or without a unit.
fn quantity(key: &str, text: &str) -> Result<Quantity, String> {
    match dimension_of_key(key) {
        Some(dimension) => dimension.finite()(text),
        None => {
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            number.map(Quantity::number).ok_or_else(|| "it must be a number, finite and without a unit".to_owned())
        }
    }
}

/// A value as a text.
fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), |text| text.trim().to_owned())
}

/// A reason in the words of the page, which are those of Python.
pub fn reason(text: impl AsRef<str>) -> String {
    worded(text.as_ref(), Skin::Keywords)
}
