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

/// A table of lines under the names of its columns.
pub fn table(names: impl IntoIterator<Item = impl AsRef<str>>, lines: impl IntoIterator<Item = String>) -> String {
    [header(names)].into_iter().chain(lines).map(|line| line + "\n").collect()
}

/// A density in bins as such a table, by the edges of the bins.
pub fn density(names: impl IntoIterator<Item = impl AsRef<str>>, edges: &[f64], density: &[f64]) -> String {
    let bins = edges.windows(2).zip(density);
    table(names, bins.map(|(edges, density)| format!("{:e},{:e},{density:e}", edges[0], edges[1])))
}

/// A cell of a row.
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

/// The name of a column without its unit.
pub fn bare(column: &str) -> &str {
    column.split(" [").next().unwrap_or_default()
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
