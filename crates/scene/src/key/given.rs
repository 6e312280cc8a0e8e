//! What was given for the keys of a scene: as it was typed, and as it is taken.

use std::ffi::OsString;
use std::path::PathBuf;

use serde::de::value::{Error, MapDeserializer, SeqDeserializer, StringDeserializer};
use serde::de::{DeserializeOwned, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;
use serde_json::Map;

use crate::key::list::Loads;
use crate::key::quantity::Quantity;
use crate::key::synonyms::similar;
use crate::key::words::{Skin, worded};
use crate::key::{Key, Values};

/// A value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, in the SI if it was typed with a unit.
    Number(Quantity),
    /// A whole number.
    Whole(u64),
    /// A truth value.
    Switch(bool),
    /// A word, a text, or the name of a file.
    Text(String),
    /// A list of numbers.
    Loads(Loads),
    /// Several.
    Several(Vec<Self>),
}

/// What was given for one key.
#[derive(Clone, Debug)]
struct Entry {
    key: &'static Key,
    value: Value,
    typed: Vec<OsString>,
    /// Whether nobody typed it
    is_default: bool,
}

/// What was given for some keys.
#[derive(Clone, Debug, Default)]
pub struct Given(Vec<Entry>);

/// A value as keywords and forms have it.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
#[serde(untagged)]
pub enum Typed {
    /// A truth value.
    Switch(bool),
    /// A whole number.
    Whole(u64),
    /// A number.
    Number(f64),
    /// A text, of a quantity with its unit.
    Text(String),
    /// Several.
    Several(Vec<Self>),
}

impl Typed {
    /// The value as it was typed.
    fn text(&self) -> String {
        match self {
            Self::Switch(value) => value.to_string(),
            Self::Whole(value) => value.to_string(),
            Self::Number(value) => format!("{value:?}"),
            Self::Text(text) => text.trim().to_owned(),
            Self::Several(all) => all.iter().map(Self::text).collect::<Vec<_>>().join(" "),
        }
    }

    /// The value for a key, whose range is left to whoever takes it.
    fn value(&self, key: &Key) -> Result<Value, String> {
        match (self, key.kind.values) {
            (Self::Switch(value), Values::Switch) => Ok(Value::Switch(*value)),
            (Self::Number(number), Values::Quantity(..)) => Ok(Value::Number(Quantity::bare(*number))),
            (Self::Number(number), Values::Number(_)) => Ok(Value::Number(Quantity::number(*number))),
            (Self::Whole(number), Values::Quantity(..)) => Ok(Value::Number(Quantity::bare(*number as f64))),
            (Self::Whole(number), Values::Number(_)) => Ok(Value::Number(Quantity::number(*number as f64))),
            _ => key.any_value(&self.text()),
        }
    }
}

impl Given {
    /// What a map of keys and values gives for some of the `known` keys; a value that is empty or false gives nothing.
    ///
    /// # Errors
    /// The key and the remedy, if it is not known, or a value is none for it.
    pub fn read(known: &[&'static Key], typed: impl IntoIterator<Item = (String, Typed)>) -> Result<Self, String> {
        let mut given = Self::default();
        for (name, typed) in typed {
            let Some(key) = known.iter().find(|key| key.name == name) else {
                let names: Vec<_> = known.iter().map(|key| key.dashed()).collect();
                let meant = similar(&name, names.iter().map(String::as_str)).map(|meant| meant.replace('-', "_"));
                let remedy = meant.map_or("leave it out".to_owned(), |meant| format!("{meant} is"));
                return Err(format!("{name} is no key that is known here: {remedy}"));
            };
            let all = match typed {
                Typed::Several(all) => all,
                Typed::Switch(false) if key.name != "nested" => continue,
                one => vec![one],
            };
            let all: Vec<_> = all.into_iter().filter(|one| !one.text().is_empty()).collect();
            let values =
                all.iter().map(|one| one.value(key).map_err(|reason| format!("{name} is {}: {reason}", one.text())));
            let values = values.collect::<Result<Vec<_>, _>>()?;
            if !values.is_empty() {
                given.insert(key, values, all.iter().map(|one| one.text().into()).collect(), false);
            }
        }
        Ok(given)
    }

    /// Adds what was given for a key.
    pub(crate) fn insert(&mut self, key: &'static Key, mut values: Vec<Value>, typed: Vec<OsString>, is_default: bool) {
        let last = if key.kind.is_several() { Some(Value::Several(values)) } else { values.pop() };
        self.0.extend(last.map(|value| Entry { key, value, typed, is_default }));
    }

    /// What was given for several lists of keys.
    pub fn all<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Self {
        Self(parts.into_iter().flat_map(|part| part.0.iter().cloned()).collect())
    }

    fn get(&self, name: &str) -> Option<&Entry> {
        self.0.iter().find(|entry| entry.key.name == name)
    }

    /// Whether a key is given, and not by default.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.get(name).is_some_and(|entry| !entry.is_default)
    }

    /// The first key that is given with another value than its default.
    pub fn first(&self) -> Option<&'static str> {
        let usual = |entry: &Entry| {
            let default = entry.key.kind.default.and_then(|default| entry.key.value(default).ok());
            default.is_some_and(|default| default == entry.value)
        };
        self.0.iter().find(|entry| !usual(entry)).map(|entry| entry.key.name)
    }

    /// The numbers of a key.
    pub(crate) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.get(name)?.value.numbers())
    }

    /// The number of a key.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        self.numbers(name)?.first().copied()
    }

    /// The two numbers of a key.
    pub(crate) fn pair(&self, name: &str) -> Option<(f64, f64)> {
        if let [first, second] = self.numbers(name)?[..] { Some((first, second)) } else { None }
    }

    /// The word of a key.
    pub(crate) fn word(&self, name: &str) -> Option<&str> {
        if let Value::Text(text) = &self.get(name)?.value { Some(text) } else { None }
    }

    /// Whether a switch is set to false, which says something else than leaving it out.
    pub(crate) fn is_denied(&self, name: &str) -> bool {
        self.get(name).is_some_and(|entry| entry.value == Value::Switch(false))
    }

    /// Whether a switch is set.
    pub(crate) fn switch(&self, name: &str) -> bool {
        self.get(name).is_some_and(|entry| entry.value == Value::Switch(true))
    }

    /// The file of a key.
    pub(crate) fn file(&self, name: &str) -> Option<PathBuf> {
        self.get(name)?.typed.first().map(PathBuf::from)
    }

    /// The side lengths of a map of a shape, by one of them, which means square cells, or two.
    pub fn lengths(&self, (nx, ny): (usize, usize)) -> Option<(f64, f64)> {
        match self.numbers("lengths")?[..] {
            [lx, ly, ..] => Some((lx, ly)),
            [lx] => Some((lx, lx / nx as f64 * ny as f64)),
            [] => None,
        }
    }

    /// The object whose fields have the names of keys; keys that it does not have are left out.
    ///
    /// # Errors
    /// The value that is none for its key.
    pub fn object<T: DeserializeOwned>(&self) -> Result<T, String> {
        let entries = self.0.iter().map(|entry| (entry.key.name, entry.value.clone()));
        T::deserialize(MapDeserializer::<_, Error>::new(entries)).map_err(|error| error.to_string())
    }

    /// The quantities, for their units.
    pub fn quantities(&self) -> Quantities {
        let of = |entry: &Entry| {
            let quantities = entry.value.quantities();
            let texts = entry.typed.iter().map(|text| text.to_string_lossy().trim().to_owned()).collect();
            entry.key.kind.dimension().map(|_| Measured::of(entry.key.name, texts, &quantities, entry.is_default))
        };
        Quantities(self.0.iter().filter_map(of).collect())
    }

    /// All that was typed, by its keys: texts, lists of texts, and `true`.
    pub fn typed(&self) -> Map<String, serde_json::Value> {
        let text = |text: &OsString| serde_json::Value::from(text.to_string_lossy());
        let of = |entry: &Entry| match (&entry.value, &entry.typed[..]) {
            (Value::Switch(value), _) => (*value).into(),
            (Value::Several(_), all) => all.iter().map(text).collect(),
            (_, all) => all.first().map(text).unwrap_or_default(),
        };
        self.0.iter().map(|entry| (entry.key.name.to_owned(), of(entry))).collect()
    }
}

impl Value {
    /// The numbers of which it is made.
    fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Number(quantity) => vec![quantity.value],
            Self::Whole(number) => vec![*number as f64],
            Self::Loads(loads) => loads.values.clone(),
            Self::Several(all) => all.iter().flat_map(Self::numbers).collect(),
            Self::Switch(_) | Self::Text(_) => Vec::new(),
        }
    }

    /// The quantities of which it is made, with units or without.
    fn quantities(&self) -> Vec<Quantity> {
        match self {
            Self::Number(quantity) => vec![*quantity],
            Self::Loads(loads) => loads.given.clone(),
            Self::Several(all) => all.iter().flat_map(Self::quantities).collect(),
            Self::Whole(_) | Self::Switch(_) | Self::Text(_) => Vec::new(),
        }
    }
}

/// The quantities of a command or a call, which all have units, or none has.
#[derive(Clone, Debug, Default)]
pub struct Quantities(Vec<Measured>);

/// A quantity as it was typed.
#[derive(Clone, Debug)]
pub struct Measured {
    key: String,
    texts: Vec<String>,
    has_unit: bool,
    is_bare: bool,
    /// Whether nobody typed it
    is_default: bool,
}

impl Measured {
    /// The numbers of a key, of a list all that stand in it.
    pub fn of(key: &str, texts: Vec<String>, numbers: &[Quantity], is_default: bool) -> Self {
        let has_unit = numbers.iter().any(|number| number.has_unit);
        let is_bare = numbers.iter().any(|number| number.is_bare());
        Self { key: key.to_owned(), texts, has_unit, is_bare, is_default }
    }
}

impl FromIterator<Measured> for Quantities {
    fn from_iter<I: IntoIterator<Item = Measured>>(all: I) -> Self {
        Self(all.into_iter().collect())
    }
}

impl Quantities {
    /// Whether quantities have units; then all numbers are in the SI.
    pub fn is_si(&self) -> bool {
        self.0.iter().any(|given| given.has_unit)
    }

    /// Refuses numbers without units beside quantities with units, in the words of a skin.
    ///
    /// # Errors
    /// Two of them, and the remedy.
    pub fn check(&self, skin: Skin) -> Result<(), String> {
        let with = self.0.iter().find(|given| given.has_unit);
        let without = self.0.iter().find(|given| given.is_bare);
        let (Some(with), Some(without)) = (with, without) else { return Ok(()) };
        let (key, text) = (&without.key, without.texts.join(" "));
        let (by, remedy) = match without.is_default {
            true => (" by default", format!("give {{{key}}} with a unit")),
            false => ("", "give both units, or neither".to_owned()),
        };
        let (other, has) = (&with.key, with.texts.join(" "));
        let told = |text: &str| worded(text, skin);
        let (key, other, remedy) = (told(&format!("{{{key}}}")), told(&format!("{{{other}}}")), told(&remedy));
        Err(format!("{key} is {text}{by}, without a unit, but {other} {has} has one: {remedy}"))
    }

    /// The quantities as they were typed, by the names of reports; nothing if none has a unit.
    pub fn given(&self) -> Option<serde_json::Value> {
        let entry = |given: &Measured| {
            let texts = match &given.texts[..] {
                [one] => one.as_str().into(),
                all => serde_json::Value::from(all),
            };
            (given.key.clone(), texts)
        };
        self.is_si().then(|| self.0.iter().map(entry).collect::<Map<_, _>>().into())
    }
}

impl<'de> IntoDeserializer<'de> for Value {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Value {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Self::Number(quantity) => visitor.visit_f64(quantity.value),
            Self::Whole(number) => visitor.visit_u64(number),
            Self::Switch(value) => visitor.visit_bool(value),
            Self::Text(text) => visitor.visit_string(text),
            Self::Loads(loads) => visitor.visit_seq(SeqDeserializer::new(loads.values.into_iter())),
            Self::Several(all) => visitor.visit_seq(SeqDeserializer::new(all.into_iter())),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let text = if let Self::Text(text) = self { text } else { String::new() };
        StringDeserializer::new(text).deserialize_enum(name, variants, visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct newtype_struct seq
        tuple tuple_struct map struct identifier ignored_any
    }
}
