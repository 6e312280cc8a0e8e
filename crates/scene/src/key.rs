//! The keys of a scene: what a run may be asked, by the names that options, keywords and reports share.
//!
//! A key stands once, in the list of its noun, with its help, the kind of its values, its default, and the keys that it
//! excludes or needs. From there come the options of the program, the keywords of the Python package, the fields of the
//! page in the browser, and the table in the documents.

mod accuracy;
mod adhesion;
mod after;
pub mod allowed;
mod asked;
mod body;
mod boundary;
mod elastic;
mod formula;
mod given;
mod laws;
mod leak;
pub mod list;
mod load;
mod macros;
#[cfg(feature = "options")]
mod options;
mod pair;
mod preparation;
pub mod quantity;
mod scalar;
mod scene;
mod symbol;
pub mod synonyms;
mod told;
pub mod units;
mod wall;
mod words;

use std::ops::RangeInclusive;

pub use self::accuracy::{AccuracyKeys, GIB, Goal, PullOffKeys};
pub use self::adhesion::{Adhesion, AdhesionKeys};
pub use self::after::{After, ConductorKeys, Conductors, FindingsKeys, LeakageKeys, PercolationKeys, StiffnessKeys};
pub use self::asked::{Asked, NestedKeys, PathKeys};
pub use self::body::{Body, BodyForm, FormKeys, FourierKeys, GridKeys, Roughness, RoughnessKeys};
pub use self::boundary::Boundary;
pub use self::elastic::{Elastic, LengthsKeys, SurfaceKeys};
pub use self::formula::{AnyLaw, Formula, tabulated};
pub use self::given::{Given, Measured, Quantities, Typed};
pub use self::laws::{LAWS, Law};
pub use self::leak::{LeakAsked, LeakKeys};
pub use self::load::{FractionsKeys, Load, LoadKeys, LoadsKeys};
#[cfg(feature = "options")]
pub use self::options::Chosen;
pub use self::pair::between;
pub use self::preparation::{CutOffKeys, Log, NewLengthsKeys, Preparation, StepKeys, in_unit};
pub use self::scalar::Scalar;
pub use self::scene::{Branches, Files, Precision, Scene, SolverKeys};
pub use self::symbol::{Stiffness, Symbol};
pub use self::told::Told;
pub use self::units::UnitKeys;
pub use self::wall::{Constraint, Wall};
pub use self::words::{Skin, worded};

pub(crate) use self::after::{ERROR, LEAKAGE};
pub(crate) use self::allowed::{Range, THREADS, unit};
pub(crate) use self::boundary::peak;
pub(crate) use self::given::Read;
pub(crate) use self::laws::WORK;
pub(crate) use self::macros::{choice, keys, record};
pub(crate) use self::quantity::*;
pub(crate) use self::units::{Units, is_unit};
use crate::key::list::{Loads, parsed};

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
    /// The keys, in the order of the help.
    const KEYS: &'static [Key];
}

/// A list of keys, or several in the order of the help.
pub trait Lists {
    /// The lists.
    const LISTS: &'static [&'static [Key]];

    /// The keys of all lists.
    fn keys() -> impl Iterator<Item = &'static Key> {
        Self::LISTS.iter().copied().flatten()
    }
}

impl<L: Keys> Lists for L {
    const LISTS: &'static [&'static [Key]] = &[L::KEYS];
}

macro_rules! lists {
    ($($list:ident)+) => {
        impl<$($list: Keys),+> Lists for ($($list,)+) {
            const LISTS: &'static [&'static [Key]] = &[$($list::KEYS),+];
        }
    };
}
lists!(A B);
lists!(A B C);
lists!(A B C D);
lists!(A B C D E);
lists!(A B C D E F);

/// The keys of lists, but for those of files, in whose place Python has arrays and objects, and a page nothing.
pub fn without_files<L: Lists>() -> impl Iterator<Item = &'static Key> {
    L::keys().filter(|key| !matches!(key.kind.values, Values::File))
}

/// The kind of the values of a key: what each is, how many there are, and what they exclude.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// What a value is.
    pub values: Values,
    /// The symbols of the values in the help.
    pub symbols: &'static [&'static str],
    /// The least and the greatest number of values.
    pub count: (usize, usize),
    /// The value if none is given.
    pub default: Option<&'static str>,
    /// The value if the key stands alone.
    pub alone: Option<&'static str>,
    /// The keys beside which it may not stand.
    pub excludes: &'static [&'static str],
    /// The keys without which it may not stand.
    pub needs: &'static [&'static str],
    /// The key whose value it replaces, if it stands behind that.
    pub replaces: Option<&'static str>,
    /// Whether values stand with commas between.
    pub commas: bool,
    /// Whether it has to be given.
    pub required: bool,
}

/// What a value of a key is.
#[derive(Clone, Copy, Debug)]
pub enum Values {
    /// A number with a unit or without one.
    Quantity(Dimension, Range),
    /// A number without a dimension.
    Number(Range),
    /// A whole number from the first to the second, with what it must be in words.
    Whole(u64, u64, &'static str),
    /// True, or left out.
    Switch,
    /// One of some words.
    Word(fn() -> Vec<Word>),
    /// A text in a form of its own, which is checked by a function.
    Text(fn(&str) -> Result<(), String>),
    /// The name of a file.
    File,
    /// Quantities, and ranges of them, with commas between.
    Quantities(Dimension, Range),
    /// Numbers, and ranges of them, with commas between.
    Numbers(Range),
}

/// A word that a key may have.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    /// What it stands for; nothing if that goes without saying.
    pub help: &'static str,
}

impl Word {
    /// Words that go without saying.
    pub(crate) fn all(names: &[&'static str]) -> Vec<Self> {
        names.iter().map(|name| Self { name, help: "" }).collect()
    }
}

impl Kind {
    const fn new(values: Values, symbols: &'static [&'static str]) -> Self {
        let (default, alone, replaces, commas, required) = (None, None, None, false, false);
        Self { values, symbols, count: (1, 1), default, alone, excludes: &[], needs: &[], replaces, commas, required }
    }

    /// A quantity.
    pub(crate) const fn quantity(dimension: Dimension, range: Range, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Quantity(dimension, range), symbol)
    }

    /// A number.
    pub(crate) const fn number(range: Range, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Number(range), symbol)
    }

    /// A whole number.
    pub(crate) const fn whole(symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Whole(0, u64::MAX, "a whole number from 0"), symbol)
    }

    /// A number of nodes along a side; more than 2²⁴ are taken for a slip of the pen.
    pub(crate) const fn nodes(symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Whole(1, 1 << 24, "a whole number from 1 to 16777216"), symbol)
    }

    /// A number of threads; more than 1024 are taken for a slip of the pen.
    pub(crate) const fn threads() -> Self {
        Self::new(Values::Whole(1, 1024, THREADS), &["N"])
    }

    /// A list of quantities, and of ranges of them.
    pub(crate) const fn quantities(dimension: Dimension, range: Range) -> Self {
        Self::new(Values::Quantities(dimension, range), &["LIST"])
    }

    /// A list of numbers, and of ranges of them.
    pub(crate) const fn numbers(range: Range) -> Self {
        Self::new(Values::Numbers(range), &["LIST"])
    }

    /// One of some words.
    pub(crate) const fn word(words: fn() -> Vec<Word>, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Word(words), symbol)
    }

    /// A text.
    pub(crate) const fn text(check: fn(&str) -> Result<(), String>, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Text(check), symbol)
    }

    /// A truth value.
    pub(crate) const fn switch() -> Self {
        Self::new(Values::Switch, &[])
    }

    /// The name of a file.
    pub(crate) const fn file() -> Self {
        Self::new(Values::File, &["FILE"])
    }

    /// Several values, from so many on.
    pub(crate) const fn from(self, least: usize) -> Self {
        Self { count: (least, self.symbols.len()), ..self }
    }

    /// As many values as symbols.
    pub(crate) const fn each(self) -> Self {
        self.from(self.symbols.len())
    }

    /// Values with commas between, or the key again.
    pub(crate) const fn commas(self) -> Self {
        Self { commas: true, ..self }
    }

    /// The value if none is given.
    pub(crate) const fn or(self, default: &'static str) -> Self {
        Self { default: Some(default), ..self }
    }

    /// The value if the key stands alone.
    pub(crate) const fn alone(self, value: &'static str) -> Self {
        Self { alone: Some(value), count: (0, 1), ..self }
    }

    /// The keys beside which it may not stand.
    pub(crate) const fn excludes(self, excludes: &'static [&'static str]) -> Self {
        Self { excludes, ..self }
    }

    /// The keys without which it may not stand.
    pub(crate) const fn needs(self, needs: &'static [&'static str]) -> Self {
        Self { needs, ..self }
    }

    /// The key whose value it replaces, if it stands behind that.
    pub(crate) const fn replaces(self, key: &'static str) -> Self {
        Self { replaces: Some(key), ..self }
    }

    /// A key that has to be given.
    pub(crate) const fn required(self) -> Self {
        Self { required: true, ..self }
    }

    /// Whether there may be several values.
    pub fn is_several(&self) -> bool {
        self.count.1 > 1 || self.commas
    }

    /// The dimension of the numbers, if they have one.
    pub fn dimension(&self) -> Option<Dimension> {
        match self.values {
            Values::Quantity(dimension, _) | Values::Quantities(dimension, _) => Some(dimension),
            _ => None,
        }
    }
}

/// All lists of keys.
static LISTS: [&[Key]; 22] = [
    SurfaceKeys::KEYS,
    LoadKeys::KEYS,
    LoadsKeys::KEYS,
    FractionsKeys::KEYS,
    AdhesionKeys::KEYS,
    SolverKeys::KEYS,
    NestedKeys::KEYS,
    AccuracyKeys::KEYS,
    PullOffKeys::KEYS,
    PathKeys::KEYS,
    FindingsKeys::KEYS,
    StiffnessKeys::KEYS,
    ConductorKeys::KEYS,
    PercolationKeys::KEYS,
    LeakageKeys::KEYS,
    UnitKeys::KEYS,
    LeakKeys::KEYS,
    GridKeys::KEYS,
    FormKeys::KEYS,
    RoughnessKeys::KEYS,
    StepKeys::KEYS,
    CutOffKeys::KEYS,
];

impl Key {
    /// All keys.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        LISTS.iter().copied().flatten()
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
            Values::Whole(from, to, words) => Read::of(whole(text, from..=to, words)?),
            Values::Switch => Read::of(text.parse::<bool>().map_err(|_| "it must be true or false")?),
            Values::Word(words) => Read::of(self.word(words, text)?),
            Values::Text(check) => check(text).map(|()| Read::of(text))?,
            Values::File => Read::of(text),
            Values::Quantities(dimension, of) => list(parsed(text, &dimension.within(range(of)))?),
            Values::Numbers(of) => list(parsed(text, &|text| range(of).number(text).map(Quantity::number))?),
        })
    }

    fn word(&self, words: fn() -> Vec<Word>, text: &str) -> Result<String, String> {
        let names: Vec<_> = words().iter().map(|word| word.name).collect();
        if names.contains(&text) {
            return Ok(text.to_owned());
        }
        let (last, others) = names.split_last().ok_or("there are no words for it")?;
        Err(format!("it must be {} or {last}", others.join(", ")))
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
