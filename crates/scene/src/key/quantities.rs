//! The quantities that are given, and whether they have units.

use serde_json::{Map, Value, json};

use crate::key::{Key, Quantity, Skin, worded};

/// The quantities of a command or a call, which all have units, or none has.
#[derive(Clone, Debug, Default)]
pub struct Quantities(Vec<QuantityEntry>);

/// A quantity as it was typed.
#[derive(Clone, Debug)]
pub struct QuantityEntry {
    key: String,
    texts: Vec<String>,
    has_unit: bool,
    is_bare: bool,
    /// Whether nobody typed it
    is_default: bool,
}

impl QuantityEntry {
    /// The numbers of a key, of a list all that stand in it.
    pub fn new(key: &str, texts: Vec<String>, numbers: &[Quantity], is_default: bool) -> Self {
        let has_unit = numbers.iter().any(|number| number.has_unit);
        let is_bare = numbers.iter().any(|number| number.is_bare());
        Self { key: key.to_owned(), texts, has_unit, is_bare, is_default }
    }
}

impl FromIterator<QuantityEntry> for Quantities {
    fn from_iter<I: IntoIterator<Item = QuantityEntry>>(all: I) -> Self {
        Self(all.into_iter().collect())
    }
}

impl Quantities {
    /// The keys of several parts.
    pub fn all(parts: impl IntoIterator<Item = Self>) -> Self {
        Self(parts.into_iter().flat_map(|part| part.0).collect())
    }

    /// The quantities with their bare numbers in SI units.
    pub fn in_si(mut self) -> Self {
        for given in self.0.iter_mut().filter(|given| given.is_bare) {
            let unit = Key::named(&given.key).and_then(|key| key.kind.dimension()).map_or("", |dimension| dimension.si);
            given.texts.iter_mut().for_each(|text| text.push_str(unit));
            (given.has_unit, given.is_bare) = (true, false);
        }
        self
    }

    /// Whether quantities have units; then all numbers are in SI units.
    pub fn is_si(&self) -> bool {
        self.0.iter().any(|given| given.has_unit)
    }

    /// Refuses numbers without units next to quantities with units, in the words of a skin.
    ///
    /// # Errors
    /// Two of them, and the remedy.
    pub fn check(&self, skin: Skin) -> Result<(), String> {
        let with = self.0.iter().find(|given| given.has_unit);
        let without = self.0.iter().find(|given| given.is_bare);
        let (Some(with), Some(without)) = (with, without) else { return Ok(()) };
        let told = |key: &str| worded(&format!("{{{key}}}"), skin);
        let (key, other) = (told(&without.key), told(&with.key));
        let (by, remedy) = match without.is_default {
            true => (" by default", format!("give {key} with a unit")),
            false => ("", "give both units, or neither".to_owned()),
        };
        let (text, has) = (without.texts.join(" "), with.texts.join(" "));
        Err(format!("{key} is {text}{by}, without a unit, but {other} {has} has one: {remedy}"))
    }

    /// The quantities as they were typed, by the names of reports; nothing if none has a unit.
    pub fn texts(&self) -> Option<Value> {
        let entry = |given: &QuantityEntry| {
            let texts = if let [one] = &given.texts[..] { json!(one) } else { json!(given.texts) };
            (given.key.clone(), texts)
        };
        self.is_si().then(|| self.0.iter().map(entry).collect::<Map<_, _>>().into())
    }
}
