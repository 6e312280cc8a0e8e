//! The law of a table, from its file.

use std::path::Path;

use asperity::Tabulated;
use asperity_maps::io::read_field;
use asperity_scene::tabulated;
use ndarray::Array2;

/// The law of a table, and its numbers.
pub fn table_of(path: &Path) -> asperity::Result<(Tabulated, Array2<f64>)> {
    let table = read_field(path)?;
    Ok((tabulated(path, &table)?, table))
}
