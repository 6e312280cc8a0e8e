//! What was given for the keys of a scene: as it was typed, and as it is taken.

use std::ffi::OsString;
use std::path::PathBuf;

use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::key::synonyms::similar;
use crate::key::{Form, Key, Keys, LengthsKeys, Quantities, Quantity, QuantityEntry, Values, readable};

/// A value that was read: as data, and its numbers with what is known of their units.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// The value as data, in SI units if it was typed with a unit.
    pub value: Value,
    /// Its numbers.
    pub numbers: Vec<Quantity>,
}

impl Read {
    /// A number.
    pub(crate) fn number(number: Quantity) -> Self {
        Self { value: json!(number.value), numbers: vec![number] }
    }

    /// A value that is no quantity.
    pub(crate) fn new(value: impl Into<Value>) -> Self {
        Self { value: value.into(), numbers: Vec::new() }
    }
}

/// What was given for one key.
#[derive(Clone, Debug)]
struct Entry {
    key: &'static Key,
    read: Read,
    typed: Vec<OsString>,
    /// Whether nobody typed it
    is_default: bool,
}

/// What was given for some keys.
#[derive(Clone, Debug, Default)]
pub struct Entries(Vec<Entry>);

/// A value as keywords and forms have it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Input {
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

impl Input {
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
}

/// The start of a long text, such as an array's, with its number of characters.
fn shortened(text: &str) -> String {
    const MOST: usize = 100;
    let start: String = text.chars().take(MOST / 2).collect();
    let count = text.chars().count();
    if count > MOST { format!("{start}... ({count} characters)") } else { text.to_owned() }
}

impl Entries {
    /// What a map of keys and values gives for the keys of `lists`; a value that is empty or false gives nothing. Keys of
    /// files are unknown: in their place Python has arrays and objects, and a page nothing.
    ///
    /// # Errors
    /// The key and the remedy, if it is not known, a value is none for it, or it needs another one, for
    /// [`worded`](crate::key::worded).
    pub fn read(lists: &[&'static [Key]], typed: impl IntoIterator<Item = (String, Input)>) -> Result<Self, String> {
        let is_file = |key: &&Key| matches!(key.kind.values, Values::File);
        let known: Vec<_> = lists.iter().copied().flatten().filter(|key| !is_file(key)).collect();
        let mut given = Self::default();
        for (name, typed) in typed {
            let Some(key) = known.iter().find(|key| key.name == name) else {
                let names: Vec<_> = known.iter().map(|key| key.dashed()).collect();
                let meant = similar(&name, names.iter().map(String::as_str)).map(|meant| meant.replace('-', "_"));
                let remedy = meant.map_or("leave it out".to_owned(), |meant| format!("did you mean {meant}?"));
                return Err(format!("unknown key {name}: {remedy}"));
            };
            let all = match typed {
                Input::Several(all) => all,
                // a switch that another one takes back says something when it is false
                Input::Switch(false) if key.kind.replaces.is_none() => continue,
                one => vec![one],
            };
            let mut texts: Vec<_> = all.iter().map(Input::text).filter(|text| !text.is_empty()).collect();
            let (least, most) = key.kind.count;
            match key.kind.values {
                Values::Quantities(..) | Values::Numbers(_) if !texts.is_empty() => texts = vec![texts.join(",")],
                _ if texts.is_empty() || (least..=most).contains(&texts.len()) || key.kind.commas && most == 1 => {}
                _ => {
                    let count = match (least, most) {
                        (_, 1) => "one value",
                        (2, _) => "two values",
                        (4, _) => "four values",
                        _ => "one value or two",
                    };
                    let symbols = key.kind.symbols.join(", ");
                    return Err(format!("{name} is {}: it must be {count}, {symbols}", shortened(&texts.join(", "))));
                }
            }
            let told = |(text, reason): (String, String)| format!("{name} is {}: {reason}", shortened(&text));
            given.add(key, texts.into_iter().map(Into::into).collect(), false).map_err(told)?;
        }
        known.iter().filter(|key| key.kind.dimension().is_some()).for_each(|key| given.add_default(key));
        let is_lacking = |need: &&&str| known.iter().any(|key| key.name == **need) && !given.has(need);
        for key in given.0.iter().map(|entry| entry.key) {
            if let Some(need) = key.kind.needs.iter().find(is_lacking) {
                return Err(format!("{{{}}} needs {{{need}}}: give both, or leave it out", key.name));
            }
        }
        Ok(given)
    }

    /// Adds what was typed for a key.
    ///
    /// # Errors
    /// The text that is no value of the key, and what it must be.
    pub fn add(&mut self, key: &'static Key, typed: Vec<OsString>, is_default: bool) -> Result<(), (String, String)> {
        let value = |text: &OsString| {
            let text = text.to_string_lossy();
            key.value(&text).map_err(|reason| (text.into_owned(), reason))
        };
        let mut read = typed.iter().map(value).collect::<Result<Vec<_>, _>>()?;
        let read = match (key.kind.is_several(), read.len()) {
            (_, 0) => return Ok(()),
            (false, _) => read.swap_remove(0),
            (true, _) => Read {
                numbers: read.iter().flat_map(|read| read.numbers.iter().copied()).collect(),
                value: read.into_iter().map(|read| read.value).collect(),
            },
        };
        self.0.push(Entry { key, read, typed, is_default });
        Ok(())
    }

    /// Adds the default of a key that is not given.
    fn add_default(&mut self, key: &'static Key) {
        if let (None, Some(default)) = (self.get(key.name), key.kind.default) {
            // a default is a value of its key
            let _ = self.add(key, vec![default.into()], true);
        }
    }

    /// The same in the order of all keys, with their defaults.
    pub fn complete(&self, keys: impl IntoIterator<Item = &'static Key>) -> Self {
        let mut all = Self::default();
        for key in keys {
            all.0.extend(self.get(key.name).cloned());
            all.add_default(key);
        }
        all
    }

    /// What is given, with the texts of each key.
    pub fn entries(&self) -> impl Iterator<Item = (&'static Key, &[OsString])> {
        self.0.iter().map(|entry| (entry.key, &entry.typed[..]))
    }

    /// What was given for several lists of keys.
    pub fn all<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Self {
        Self(parts.into_iter().flat_map(|part| part.0.iter().cloned()).collect())
    }

    fn get(&self, name: &str) -> Option<&Entry> {
        self.0.iter().find(|entry| entry.key.name == name)
    }

    /// The value of a key.
    pub(crate) fn value(&self, name: &str) -> Option<&Value> {
        self.get(name).map(|entry| &entry.read.value)
    }

    /// Whether a key is given, and not by default.
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some_and(|entry| !entry.is_default)
    }

    /// The first key of a list that is given with another value than its default.
    pub fn first<L: Keys>(&self) -> Option<&'static str> {
        let usual = |entry: &Entry| {
            let default = entry.key.kind.default.and_then(|default| entry.key.value(default).ok());
            default.is_some_and(|default| default == entry.read)
        };
        let of_list = |entry: &&Entry| L::KEYS.iter().any(|key| key.name == entry.key.name);
        self.0.iter().filter(of_list).find(|entry| !usual(entry)).map(|entry| entry.key.name)
    }

    /// What was given for a list of keys.
    pub fn keys<L: Keys>(&self) -> L {
        L::read(self)
    }

    /// What was given for a key, in the form of a field.
    pub fn field<T: Readable>(&self, name: &str) -> T {
        T::read(self, name)
    }

    /// The numbers of a key.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        Some(match self.value(name)? {
            Value::Array(all) => all.iter().filter_map(Value::as_f64).collect(),
            one => one.as_f64().into_iter().collect(),
        })
    }

    /// The word of a key.
    pub fn word(&self, name: &str) -> Option<&str> {
        self.value(name)?.as_str()
    }

    /// The side lengths of a map of a shape, by two of them, or one, which means square cells; a line is as wide as long.
    pub fn lengths(&self, (nx, ny): (usize, usize)) -> Option<(f64, f64)> {
        match self.keys::<LengthsKeys>().lengths[..] {
            [lx, ly, ..] => Some((lx, ly)),
            [lx] if ny == 1 => Some((lx, lx)),
            [lx] => Some((lx, lx / nx as f64 * ny as f64)),
            [] => None,
        }
    }

    /// The quantities, for their units.
    pub fn quantities(&self) -> Quantities {
        let texts = |entry: &Entry| entry.typed.iter().map(|text| text.to_string_lossy().trim().to_owned()).collect();
        let quantities = self.0.iter().filter(|entry| entry.key.kind.dimension().is_some());
        let of =
            |entry: &Entry| QuantityEntry::new(entry.key.name, texts(entry), &entry.read.numbers, entry.is_default);
        quantities.map(of).collect()
    }

    /// All that was typed, by its keys: texts, lists of texts, and `true`.
    pub fn typed(&self) -> Map<String, Value> {
        let text = |text: &OsString| Value::from(text.to_string_lossy());
        let of = |entry: &Entry| match (&entry.read.value, &entry.typed[..]) {
            (Value::Bool(value), _) => (*value).into(),
            (_, all) if entry.key.kind.is_several() => all.iter().map(text).collect(),
            (_, all) => all.first().map(text).unwrap_or_default(),
        };
        let typed = self.0.iter().filter(|entry| !entry.is_default);
        typed.map(|entry| (entry.key.name.to_owned(), of(entry))).collect()
    }
}

/// The form in which a field of a list has what was given for its key.
pub trait Readable: Sized {
    /// The form of the values of the key.
    const FORM: Form;

    /// What was given for a key.
    fn read(given: &Entries, key: &str) -> Self;
}

readable! {
    Option<f64>: Number = |value| value?.as_f64();
    Vec<f64>: Numbers = |value| several(value, Value::as_f64);
    Option<u64>: Count = |value| value?.as_u64();
    Option<usize>: Count = |value| value?.as_u64().map(|count| count as usize);
    Vec<usize>: Counts = |value| several(value, |count| count.as_u64().map(|count| count as usize));
    Option<String>: Word = |value| value?.as_str().map(str::to_owned);
    Vec<String>: Words = |value| several(value, |word| word.as_str().map(str::to_owned));
    bool: Switch = |value| value == Some(&Value::Bool(true));
    Option<bool>: Denial = |value| value?.as_bool();
}

impl Readable for PathBuf {
    const FORM: Form = Form::File;

    fn read(given: &Entries, key: &str) -> Self {
        Option::read(given, key).unwrap_or_default()
    }
}

impl Readable for Option<PathBuf> {
    const FORM: Form = Form::File;

    fn read(given: &Entries, key: &str) -> Self {
        given.get(key)?.typed.first().map(PathBuf::from)
    }
}

/// An enumeration of words.
pub trait Choice: Default {
    /// The variant of a word.
    fn named(word: &str) -> Option<Self>;
}

impl<C: Choice> Readable for C {
    const FORM: Form = Form::Word;

    fn read(given: &Entries, key: &str) -> Self {
        Option::read(given, key).unwrap_or_default()
    }
}

impl<C: Choice> Readable for Option<C> {
    const FORM: Form = Form::Word;

    fn read(given: &Entries, key: &str) -> Self {
        C::named(given.word(key)?)
    }
}

impl<C: Choice> Readable for Vec<C> {
    const FORM: Form = Form::Words;

    fn read(given: &Entries, key: &str) -> Self {
        Vec::<String>::read(given, key).iter().filter_map(|word| C::named(word)).collect()
    }
}

/// The values of a key that may have several.
fn several<V>(value: Option<&Value>, of: impl Fn(&Value) -> Option<V>) -> Vec<V> {
    match value {
        Some(Value::Array(all)) => all.iter().filter_map(of).collect(),
        one => one.and_then(of).into_iter().collect(),
    }
}
