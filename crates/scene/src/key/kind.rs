//! The kind of the values of a key.

use crate::key::allowed::THREADS;
use crate::key::{Dimension, Range};

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
    /// The keys with which it may not stand.
    pub excludes: &'static [&'static str],
    /// The keys without which it may not stand.
    pub needs: &'static [&'static str],
    /// The key that it replaces, if it stands behind that key.
    pub replaces: Option<&'static str>,
    /// Whether values stand with commas between.
    pub commas: bool,
    /// Whether it has to be given.
    pub required: bool,
    /// Whether its value stands without the name.
    pub positional: bool,
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

/// The form of what is given for a key, which its field has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A number, or none.
    Number,
    /// Numbers.
    Numbers,
    /// A whole number, or none.
    Count,
    /// Whole numbers.
    Counts,
    /// A word or a text, or none.
    Word,
    /// Words.
    Words,
    /// Whether a switch is set.
    Switch,
    /// Whether a switch is set or denied, or neither.
    Denial,
    /// The name of a file, or none.
    File,
}

impl Form {
    /// Whether it is another one.
    pub const fn is(self, other: Self) -> bool {
        self as u8 == other as u8
    }
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
    pub fn all(names: &[&'static str]) -> Vec<Self> {
        names.iter().map(|name| Self { name, help: "" }).collect()
    }
}

impl Kind {
    const fn new(values: Values, symbols: &'static [&'static str]) -> Self {
        let (default, alone, replaces, commas, required, positional) = (None, None, None, false, false, false);
        let (count, excludes, needs): (_, &[&str], &[&str]) = ((1, 1), &[], &[]);
        Self { values, symbols, count, default, alone, excludes, needs, replaces, commas, required, positional }
    }

    /// A quantity.
    pub const fn quantity(dimension: Dimension, range: Range, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Quantity(dimension, range), symbol)
    }

    /// A number.
    pub const fn number(range: Range, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Number(range), symbol)
    }

    /// A whole number.
    pub const fn whole(symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Whole(0, u64::MAX, "a whole number from 0"), symbol)
    }

    /// A number of nodes along a side; more than 2²⁴ are taken for a slip of the pen.
    pub const fn nodes(symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Whole(1, 1 << 24, "a whole number from 1 to 16777216"), symbol)
    }

    /// A number of threads; more than 1024 are taken for a slip of the pen.
    pub const fn threads() -> Self {
        Self::new(Values::Whole(1, 1024, THREADS), &["N"])
    }

    /// A number of bins; more than a million are taken for a slip of the pen.
    pub const fn bins(symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Whole(1, 1_000_000, "a whole number from 1 to 1000000"), symbol)
    }

    /// A list of quantities, and of ranges of them.
    pub const fn quantities(dimension: Dimension, range: Range) -> Self {
        Self::new(Values::Quantities(dimension, range), &["LIST"])
    }

    /// A list of numbers, and of ranges of them.
    pub const fn numbers(range: Range) -> Self {
        Self::new(Values::Numbers(range), &["LIST"])
    }

    /// One of some words.
    pub const fn word(words: fn() -> Vec<Word>, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Word(words), symbol)
    }

    /// A text.
    pub const fn text(check: fn(&str) -> Result<(), String>, symbol: &'static [&'static str]) -> Self {
        Self::new(Values::Text(check), symbol)
    }

    /// A truth value.
    pub const fn switch() -> Self {
        Self::new(Values::Switch, &[])
    }

    /// The name of a file.
    pub const fn file() -> Self {
        Self::new(Values::File, &["FILE"])
    }

    /// The name of a folder.
    pub const fn folder() -> Self {
        Self::new(Values::File, &["DIR"])
    }

    /// The key again and again.
    pub const fn again(self) -> Self {
        Self { count: (1, usize::MAX), ..self }
    }

    /// Several values, from so many on.
    pub const fn from(self, least: usize) -> Self {
        Self { count: (least, self.symbols.len()), ..self }
    }

    /// As many values as symbols.
    pub const fn each(self) -> Self {
        self.from(self.symbols.len())
    }

    /// Values with commas between, or the key again.
    pub const fn commas(self) -> Self {
        Self { commas: true, ..self }
    }

    /// The value if none is given.
    pub const fn or(self, default: &'static str) -> Self {
        Self { default: Some(default), ..self }
    }

    /// The value if the key stands alone.
    pub const fn alone(self, value: &'static str) -> Self {
        Self { alone: Some(value), count: (0, 1), ..self }
    }

    /// The keys with which it may not stand.
    pub const fn excludes(self, excludes: &'static [&'static str]) -> Self {
        Self { excludes, ..self }
    }

    /// The keys without which it may not stand.
    pub const fn needs(self, needs: &'static [&'static str]) -> Self {
        Self { needs, ..self }
    }

    /// The key that it replaces, if it stands behind that key.
    pub const fn replaces(self, key: &'static str) -> Self {
        Self { replaces: Some(key), ..self }
    }

    /// A key that has to be given.
    pub const fn required(self) -> Self {
        Self { required: true, ..self }
    }

    /// A value without the name of the key, of this symbol in the help.
    pub const fn positional(self, symbols: &'static [&'static str]) -> Self {
        Self { positional: true, symbols, ..self }
    }

    /// The form of what is given.
    pub const fn form(&self) -> Form {
        let is_several = self.count.1 > 1 || self.commas;
        match self.values {
            Values::Switch if self.replaces.is_some() => Form::Denial,
            Values::Switch => Form::Switch,
            Values::File => Form::File,
            Values::Quantities(..) | Values::Numbers(_) => Form::Numbers,
            Values::Quantity(..) | Values::Number(_) if is_several => Form::Numbers,
            Values::Quantity(..) | Values::Number(_) => Form::Number,
            Values::Whole(..) if is_several => Form::Counts,
            Values::Whole(..) => Form::Count,
            Values::Word(_) | Values::Text(_) if is_several => Form::Words,
            Values::Word(_) | Values::Text(_) => Form::Word,
        }
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
