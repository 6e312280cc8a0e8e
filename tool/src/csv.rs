//! Rows of comma-separated values.

use serde_json::{Map, Value};

/// A row as a line: words without quotation marks where they can be read so, and nothing for a number that is not
/// finite.
pub fn line(row: &Map<String, Value>) -> String {
    row.values().map(cell).collect::<Vec<_>>().join(",")
}

/// The names of columns as a line.
pub fn header(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    names.into_iter().map(|name| word(name.as_ref())).collect::<Vec<_>>().join(",")
}

pub fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => word(text),
        number => number.to_string(),
    }
}

/// A word, in quotation marks where it would be several cells, a number, or a formula of a spreadsheet.
fn word(text: &str) -> String {
    let apart = text.contains(['"', ',']) || text.contains(char::is_control);
    let other =
        text.is_empty() || text.starts_with(['=', '+', '-', '@']) || serde_json::from_str::<Value>(text).is_ok();
    if !apart && !other {
        return text.to_owned();
    }
    // on one line, whatever the name of a file is
    format!("\"{}\"", text.replace('"', "\"\"").replace(char::is_control, " "))
}

/// The names of columns that [`header()`] made a line of.
pub fn names(line: &str) -> Vec<String> {
    cells(line).into_iter().map(|(name, _)| name).collect()
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
        // nothing that a spreadsheet computes, and no word that becomes a number or nothing
        for text in ["=1+1", "+5", "-x", "@a", "7", "true", "null", "", "a,b", "\"", "1e-3", "none", "a = b"] {
            let row = json!({ "a": text, "b": 1 });
            let line = super::line(row.as_object().unwrap());
            assert_eq!(parsed(&["a", "b"], &line), row);
            assert_eq!(line.starts_with('"'), !["none", "a = b"].contains(&text), "{line}");
        }
    }

    #[test]
    fn a_header_says_what_its_names_were() {
        let all = ["case", "mean_gap [m, or so]", "say \"nm\""];
        let line = header(all);
        assert_eq!(line, "case,\"mean_gap [m, or so]\",\"say \"\"nm\"\"\"");
        assert_eq!(names(&line), all);
    }
}
