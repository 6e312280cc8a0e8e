//! Adhesion laws from files.

use std::path::Path;

use asperity::{Error, Result, Tabulated};
use ndarray::ArrayRef2;

/// The law of a table of gaps and tractions, which was read from a file.
///
/// # Errors
/// [`Error::File`] unless the table has two columns that make a law.
pub fn tabulated(path: &Path, table: &ArrayRef2<f64>) -> Result<Tabulated> {
    if table.ncols() != 2 {
        let columns = table.ncols();
        return Err(Error::file(
            path,
            format!("has {columns} columns, not two: put a gap and a traction on each line"),
        ));
    }
    let [gaps, tractions] = [0, 1].map(|column| table.column(column).to_vec());
    Tabulated::new(&gaps, &tractions).map_err(|error| Error::file(path, format!("is no law: {error}")))
}
