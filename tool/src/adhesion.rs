//! The adhesion between the surfaces, with what its files hold.

use std::path::Path;

use asperity::adhesion::Formula;
use asperity::{Error, Grid, Tabulated};
use asperity_maps::io::read_field;
use asperity_scene::{Adhesion as Described, Files, tabulated};
use ndarray::Array2;

use crate::heights;
use crate::outcome::Outcome;
use crate::processes::Processes;

/// The law that options choose, with what their files hold.
pub struct Adhesion {
    /// The law
    pub formula: Formula,
    /// The numbers of the table of the law
    pub table: Option<Array2<f64>>,
    /// The works of adhesion of the map, at all nodes
    pub works: Option<Array2<f64>>,
    /// The hardness of the map, at all nodes
    pub hardness: Option<Array2<f64>>,
}

/// The law of a table, and its numbers.
type Table = (Tabulated, Array2<f64>);

/// The law, whose works of adhesion do not vary; reads its table.
pub fn uniform(described: &Described, table: Option<&Path>) -> Outcome<(Formula, Option<Table>)> {
    let read = |path: &Path| -> Outcome<_> {
        let table = read_field(path)?;
        Ok((tabulated(path, &table)?, table))
    };
    let table = table.map(read).transpose()?;
    Ok((described.formula(table.as_ref().map(|(law, _)| law))?, table))
}

impl Adhesion {
    /// Reads the files, with maps of all nodes of the grid in each process.
    pub fn read(described: &Described, files: &Files, grid: &Grid, processes: &Processes) -> Outcome<Self> {
        let read = || {
            let map = |option, path: Option<&Path>| {
                path.map(|path| heights::rows_on(option, path, &grid.alone())).transpose()
            };
            let works = map("--work-of-adhesion-map", files.work_of_adhesion_map.as_deref())?;
            let hardness = map("--hardness-map", files.hardness_map.as_deref())?;
            // whatever the law refuses with any work of adhesion
            Ok((uniform(described, files.law_table.as_deref())?, works, hardness))
        };
        let ((formula, table), works, hardness) = processes.agree(read())?;
        let (tabulated, table) = table.unzip();
        let formula = match (&works, &files.work_of_adhesion_map) {
            (Some(works), Some(path)) => {
                let law = described.formula_on(works.view(), tabulated.as_ref());
                law.map_err(|error| Error::file(path, format!("does not fit the law: {error}")))?
            }
            _ => formula,
        };
        Ok(Self { formula, table, works, hardness })
    }
}
