//! What stands at the places of a message.

/// A quantity or a word of a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    Length(f64),
    Pressure(f64),
    /// A number without a unit.
    Figure(f64),
    Word(String),
}
