//! Rows of comma-separated values.

use serde_json::{Map, Value};

/// A row as a line: words without quotation marks unless a comma is in them, and nothing for a number that is not
/// finite.
pub fn line(row: &Map<String, Value>) -> String {
    row.values().map(cell).collect::<Vec<_>>().join(",")
}

pub fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(word) if word.contains(['"', ',']) || word.contains(char::is_control) => {
            // on one line, whatever the name of a file is
            format!("\"{}\"", word.replace('"', "\"\"").replace(char::is_control, " "))
        }
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
    let cells = cells(line);
    let cells = cells.iter().map(|(cell, quoted)| if *quoted { cell.as_str().into() } else { value(cell) });
    columns.iter().map(|name| name.as_ref().to_owned()).zip(cells).collect::<Map<_, _>>().into()
}

/// The cells of a line, and whether they stood in quotation marks, which are doubled in them.
fn cells(line: &str) -> Vec<(String, bool)> {
    let mut cells = vec![(String::new(), false)];
    let (mut inside, mut rest) = (false, line.chars().peekable());
    while let Some(c) = rest.next() {
        let count = cells.len();
        let (cell, quoted) = &mut cells[count - 1];
        match c {
            '"' if inside && rest.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' => (inside, *quoted) = (!inside, true),
            ',' if !inside => cells.push((String::new(), false)),
            c => cell.push(c),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_line_says_what_its_row_was() {
        let row = json!({ "a": 1.5, "b": "none", "c": null, "d": "one, \"two\".npy", "e": true, "f": "7, 8" });
        let line = line(row.as_object().unwrap());
        assert_eq!(line, "1.5,none,,\"one, \"\"two\"\".npy\",true,\"7, 8\"");
        assert_eq!(parsed(&["a", "b", "c", "d", "e", "f"], &line), row);
        assert_eq!(parsed(&["a", "b", "c"], "1"), json!({ "a": 1 }));
    }
}
