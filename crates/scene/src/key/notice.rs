//! Warnings in words.

use std::fmt;

use asperity_maps::warning::Warning;
use serde::{Deserialize, Serialize};

/// A warning in the units of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Notice {
    /// The code.
    pub code: String,
    /// The message.
    pub message: String,
    /// How bad it is, among the warnings of its code.
    #[serde(skip)]
    pub(crate) severity: f64,
}

impl Notice {
    /// Takes the place of another one of its code, if it is worse; whether it is.
    pub fn replace_if_worse(self, known: &mut Self) -> bool {
        let worse = self.severity > known.severity;
        if worse {
            *known = self;
        }
        worse
    }

    /// The warning as a file has it on a line, with how bad it is behind its code.
    pub fn line(&self) -> String {
        format!("{} [{}]: {}\n", self.code, Warning::figure(self.severity), self.message)
    }

    /// The warning of such a line.
    pub fn parse(line: &str) -> Option<Self> {
        let (code, message) = line.split_once(": ")?;
        let (code, severity) = match code.strip_suffix(']').and_then(|code| code.split_once(" [")) {
            Some((code, severity)) => (code, severity.parse().ok()?),
            None => (code, 0.0),
        };
        Some(Self { code: code.to_owned(), message: message.to_owned(), severity })
    }
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code, self.message)
    }
}
