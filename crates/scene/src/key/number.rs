//! A number of an answer: its name, its meaning, and its measure.

use crate::key::Dimension;

/// A number of an answer, or a word or a table: a key of a report, and a column of tables.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// The name.
    pub name: &'static str,
    /// The meaning.
    pub help: &'static str,
    /// The type in Rust.
    pub kind: &'static str,
    /// The measure.
    pub measure: Measure,
    /// Whether a report has the number under its name: neither within others nor left out.
    pub is_reported: bool,
}

/// The measure of a number: how people read it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// In the unit of a dimension.
    Of(Dimension),
    /// In percent.
    Share,
    /// To two digits.
    Error,
    /// In seconds.
    Seconds,
    /// To four digits.
    Plain,
}

/// Whether a report has a field that is in this place, which is none for a number of its own.
pub(crate) const fn is_reported(place: &[&str]) -> bool {
    place.is_empty()
}
