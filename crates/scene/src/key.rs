//! The keys of a scene: what a run may be asked, by the names that options, keywords and reports share.
//!
//! A key stands once, in the list of its noun, with its help, the kind of its values, its default, and the keys that it
//! excludes or needs. From there come the options of the program, the keywords of the Python package, the fields of the
//! page in the browser, and the table in the documents.

mod accuracy;
mod adhesion;
mod after;
pub mod allowed;
mod body;
mod boundary;
mod elastic;
mod entries;
mod keywords;
mod kind;
mod laws;
mod leak;
pub mod list;
mod load;
mod macros;
mod notice;
mod number;
#[cfg(feature = "options")]
mod options;
mod pair;
mod preparation;
mod quantities;
mod quantity;
mod request;
mod scalar;
mod scene;
mod symbol;
pub mod synonyms;
mod units;
mod wall;
mod words;

use std::ops::RangeInclusive;

pub use self::accuracy::{AccuracyKeys, CycleAccuracyKeys, GIB, Goal, PullOffKeys};
pub use self::adhesion::{Adhesion, AdhesionKeys};
pub use self::after::{After, ConductorKeys, Conductors, FindingsKeys, LeakageKeys, PercolationKeys, StiffnessKeys};
pub use self::body::{BodyForm, FormKeys, FourierKeys, GridKeys, RoughnessKeys};
pub use self::boundary::Boundary;
pub use self::elastic::{Elastic, LengthsKeys, SurfaceKeys};
pub use self::entries::{Choice, Entries, Input, Readable};
pub use self::keywords::KEYWORDS;
pub use self::kind::{Form, Kind, Values, Word};
pub use self::laws::{LAWS, Law, read_law};
pub use self::leak::{LeakAsked, LeakKeys};
pub use self::load::{FractionsKeys, Load, LoadKeys, LoadsKeys};
pub use self::notice::Notice;
pub use self::number::{Measure, Number};
#[cfg(feature = "options")]
pub use self::options::chosen;
pub use self::pair::between;
pub use self::preparation::{CutOffKeys, Log, NewLengthsKeys, Preparation, StepKeys, in_unit};
pub use self::quantities::{Quantities, QuantityEntry};
pub use self::quantity::*;
pub use self::request::{NestedKeys, PathKeys, Request};
pub use self::scalar::Scalar;
pub use self::scene::{Branches, Files, Precision, Scene, SolverKeys};
pub use self::symbol::{Stiffness, Symbol};
pub use self::units::{UnitKeys, Units};
pub use self::wall::{Constraint, Wall};
pub use self::words::{Skin, worded};

pub(crate) use self::after::{ERROR, LEAKAGE};
pub(crate) use self::allowed::{Range, unit};
pub(crate) use self::boundary::peak;
pub(crate) use self::entries::Read;
pub(crate) use self::laws::WORK;
pub(crate) use self::macros::{choice, keys, readable, record};
pub(crate) use self::number::is_reported;
pub(crate) use self::units::is_unit;
use crate::key::list::{Loads, parsed};

/// A parameter that a law or a body needs.
pub(crate) fn needed(parameter: Option<f64>) -> asperity::Result<f64> {
    let reason = "its law or its body lacks a parameter: give all that it needs";
    parameter.ok_or(asperity::Error::Unsuited { what: "scene", reason })
}

/// A key of a scene.
#[derive(Debug)]
pub struct Key {
    /// The name, as in reports and keywords.
    pub name: &'static str,
    /// The meaning, with other keys in braces, for [`worded`].
    pub help: &'static str,
    /// The heading under which it stands in the help, and the section in a scene file.
    pub section: &'static str,
    /// The values.
    pub kind: Kind,
}

/// A list of keys that belong together.
pub trait Keys {
    /// The meaning of the list.
    const ABOUT: &'static str;
    /// The keys, in the order of the help.
    const KEYS: &'static [Key];

    /// What was given for them.
    fn read(given: &Entries) -> Self;
}

/// The lists of keys that are no keywords of solves.
static OTHERS: [&[Key]; 8] = [
    PercolationKeys::KEYS,
    UnitKeys::KEYS,
    LeakKeys::KEYS,
    GridKeys::KEYS,
    FormKeys::KEYS,
    RoughnessKeys::KEYS,
    StepKeys::KEYS,
    CutOffKeys::KEYS,
];

impl Key {
    /// The name of the key of a field, which may be `r#for`.
    pub const fn name_of(field: &'static str) -> &'static str {
        match field.as_bytes() {
            [b'r', b'#', ..] => field.split_at(2).1,
            _ => field,
        }
    }

    /// All keys.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        KEYWORDS.iter().map(|(.., list)| *list).chain(OTHERS).flatten()
    }

    /// The key of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().find(|key| key.name == name)
    }

    /// The value of a text, within the range of the key.
    ///
    /// # Errors
    /// What it must be.
    pub fn value(&self, text: &str) -> Result<Read, String> {
        self.parsed(text, |range| range)
    }

    /// The value of a text as far as it can be told from that: whether a number lies in its range is left to whoever
    /// takes it.
    ///
    /// # Errors
    /// What it must be.
    pub fn any_value(&self, text: &str) -> Result<Read, String> {
        self.parsed(text, |_| Range::FINITE)
    }

    fn parsed(&self, text: &str, range: fn(Range) -> Range) -> Result<Read, String> {
        let list = |loads: Loads| Read { value: loads.values.into(), numbers: loads.given };
        Ok(match self.kind.values {
            Values::Quantity(dimension, of) => Read::number(dimension.within(range(of))(text)?),
            Values::Number(of) => Read::number(Quantity::number(range(of).number(text)?)),
            Values::Whole(from, to, words) => Read::new(whole(text, from..=to, words)?),
            Values::Switch => Read::new(text.parse::<bool>().map_err(|_| "it must be true or false")?),
            Values::Word(words) => Read::new(self.word(words, text)?),
            Values::Text(check) => check(text).map(|()| Read::new(text))?,
            Values::File => Read::new(text),
            Values::Quantities(dimension, of) => list(parsed(text, &dimension.within(range(of)))?),
            Values::Numbers(of) => list(parsed(text, &|text| range(of).number(text).map(Quantity::number))?),
        })
    }

    fn word(&self, words: fn() -> Vec<Word>, text: &str) -> Result<String, String> {
        let names: Vec<_> = words().iter().map(|word| word.name).collect();
        if let Some(name) = names.iter().find(|name| name.eq_ignore_ascii_case(text)) {
            return Ok((*name).to_owned());
        }
        let (last, others) = names.split_last().ok_or("there are no words for it")?;
        let others = if others.is_empty() { String::new() } else { format!("{} or ", others.join(", ")) };
        Err(format!("it must be {others}{last}"))
    }

    /// What a value is, with its article.
    pub(crate) fn what(&self) -> String {
        match self.kind.values {
            Values::Quantity(dimension, _) | Values::Quantities(dimension, _) => {
                let what = dimension.what.split(',').next().unwrap_or_default();
                format!("{} {what}", if what.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" })
            }
            Values::Number(_) | Values::Numbers(_) => "a number".to_owned(),
            Values::Whole(..) => "a whole number".to_owned(),
            Values::File => "a file".to_owned(),
            Values::Switch | Values::Word(_) | Values::Text(_) => "a word".to_owned(),
        }
    }

    /// The name of the option of the key, without hyphens in front.
    pub fn dashed(&self) -> String {
        self.name.replace('_', "-")
    }
}

/// A whole number of a text.
fn whole(text: &str, range: RangeInclusive<u64>, words: &str) -> Result<u64, String> {
    let found = text.trim().parse().ok().filter(|number| range.contains(number));
    found.ok_or_else(|| format!("it must be {words}"))
}
