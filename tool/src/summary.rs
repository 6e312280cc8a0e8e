//! The summary of a solve for people: a table, and warnings where the answer is not to be trusted.

use std::iter::once;

use asperity::Status;
use asperity_scene::{Account, Skin, Units, rows, shortfalls};

use crate::printing::{bold, complain, green, yellow};

/// A table with a column for each of the solves, under their names if they have any.
pub fn table(names: &[&str], solves: &[&Account], units: &Units) -> String {
    let heading = (String::new(), names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
    let heading = once(heading).filter(|_| !names.is_empty());
    let rows: Vec<_> = heading.chain(rows(solves, units, Skin::Options)).collect();
    let length = |text: &str| text.chars().count();
    let first = rows.iter().map(|(name, _)| length(name)).max().unwrap_or(0);
    let widths: Vec<_> =
        (0..solves.len()).map(|k| rows.iter().map(|(_, cells)| length(&cells[k])).max().unwrap_or(0)).collect();
    let line = |(name, cells): &(String, Vec<String>)| {
        let cells = cells.iter().zip(&widths).map(|(cell, &width)| {
            // A single column reads better from the left.
            let cell = if solves.len() == 1 { cell.clone() } else { format!("{cell:>width$}") };
            let cell = match name.as_str() {
                "" => bold(&cell),
                "status" if cell.trim() == Status::Converged.name() => green(&cell),
                "status" => yellow(&cell),
                _ => cell,
            };
            format!("  {cell}")
        });
        format!("{name:first$}{}", cells.collect::<String>())
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Warns of what a solve has not reached; `name` belongs to the case.
pub fn warn(name: &str, account: &Account) {
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    for (_, text) in shortfalls(account, Skin::Options) {
        complain("warning", &format!("{name}{text}"));
    }
}
