//! The lengths and pressures in a message.

/// A length or a pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    Length(f64),
    Pressure(f64),
}

/// A text with quantities in it, which can be written in several ways.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Text {
    /// with a mark in the place of each quantity
    text: String,
    quantities: Vec<Quantity>,
    /// how bad it is, among warnings of one code
    severity: f64,
}

/// The characters that stand for a quantity in a text. No message has another use for them.
const MARK: char = '\0';

impl Text {
    /// The mark of a length, for the text to come.
    pub fn length(&mut self, value: f64) -> char {
        self.quantities.push(Quantity::Length(value));
        MARK
    }

    /// The mark of a pressure, for the text to come.
    pub fn pressure(&mut self, value: f64) -> char {
        self.quantities.push(Quantity::Pressure(value));
        MARK
    }

    /// The text, with the marks in the order in which they were made.
    pub fn with(self, text: String) -> Self {
        debug_assert_eq!(text.matches(MARK).count(), self.quantities.len());
        Self { text, ..self }
    }

    /// The text, with how bad it is.
    pub fn of_severity(self, severity: f64) -> Self {
        Self { severity, ..self }
    }

    pub fn severity(&self) -> f64 {
        self.severity
    }

    /// The text, with lengths and pressures as they are to be.
    pub fn written(&self, length: impl Fn(f64) -> String, pressure: impl Fn(f64) -> String) -> String {
        let mut quantities = self.quantities.iter().map(|quantity| match *quantity {
            Quantity::Length(value) => length(value),
            Quantity::Pressure(value) => pressure(value),
        });
        let mut parts = self.text.split(MARK);
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |text, part| text + &quantities.next().unwrap_or_default() + part)
    }
}
