//! The report on a command as JSON: its outcome, then its inputs.

use serde::Serialize;
use serde_json::{Map, Value, json};

/// The key of the last state of a pull-off, and of the last row of a table.
pub const LAST: &str = "last";

/// A report on a command: its outcome, then its inputs.
pub fn report(command: &str, outcome: Value, inputs: &impl Serialize) -> Value {
    let mut report = Map::new();
    report.insert("command".to_owned(), command.into());
    for part in [outcome, json!(inputs)] {
        report.extend(part.as_object().cloned().unwrap_or_default());
    }
    report.into()
}
