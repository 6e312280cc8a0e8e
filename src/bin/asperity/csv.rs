//! Rows of comma-separated values.

use serde_json::{Map, Value};

/// A row as a line: words without quotation marks where they need none, and nothing for a number that is not finite.
pub fn line(row: &Map<String, Value>) -> String {
    row.values().map(cell).collect::<Vec<_>>().join(",")
}

pub fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(word) if word.contains([',', '"', '\n', '\r']) => format!("\"{}\"", word.replace('"', "\"\"")),
        Value::String(word) => word.clone(),
        number => number.to_string(),
    }
}

/// The row that [`line()`] made a line of, or as much of it as the line says.
pub fn parsed(columns: &[impl AsRef<str>], line: &str) -> Value {
    let value = |cell: &str| match cell {
        "" => Value::Null,
        cell => serde_json::from_str(cell).unwrap_or_else(|_| cell.into()),
    };
    columns.iter().map(|name| name.as_ref().to_owned()).zip(line.split(',').map(value)).collect::<Map<_, _>>().into()
}
