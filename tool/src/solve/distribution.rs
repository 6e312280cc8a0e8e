//! The distribution of the contact pressure as a table.

use std::fmt::Write;

use asperity::contact::PressureDistribution;

use crate::csv;
use crate::units::Units;

const COLUMNS: [&str; 3] = ["from_pressure", "to_pressure", "density"];

/// The bins as comma-separated values, with their units where those are known.
pub fn table(found: &PressureDistribution, units: &Units) -> String {
    let mut text = csv::header(units.columns(&COLUMNS, "", false)) + "\n";
    for (edges, density) in found.edges.windows(2).zip(&found.density) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:e},{:e},{density:e}", edges[0], edges[1]);
    }
    text
}
