//! The fields of the rows of a table, kept in a folder: gap-0001.npy, pressure-0001.npy, contact_pressure-0001.npy,
//! and where the surface yields plastic_depth-0001.npy.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::Solution;
use asperity_maps::io::OutputFolder;

use crate::key::Scalar;
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::table::fields::{gap_to_write, write_fields};
use crate::table::output::check_free;

const FIELDS: [&str; 4] = ["gap", "pressure", "contact_pressure", "plastic_depth"];

/// The folder of the fields, if they are kept.
#[derive(Clone, Copy)]
pub struct FieldFolder<'a>(pub Option<&'a Path>);

impl FieldFolder<'_> {
    /// Refuses to replace fields, unless they may be, or belong to the rows of a table that is there.
    pub fn check(self, force: bool, table: &Path) -> Outcome<()> {
        let Some(folder) = self.0 else { return Ok(()) };
        // only a trial
        drop(OutputFolder::create(folder, &[], true)?);
        // the fields first: a run that starts at the same time makes its table before them
        let first = present(folder).into_iter().next();
        first.map_or(Ok(()), |path| check_free(&path, force || table.exists(), "--fields"))
    }

    /// Removes the fields of all rows, of a run that starts over.
    pub fn clear(self) {
        self.0.map(present).into_iter().flatten().for_each(remove);
    }

    /// Writes the fields of a row, counted from 1; each process its rows.
    pub fn write<T: Scalar>(self, row: usize, solution: &Solution<T>, processes: &Processes) -> Outcome<()> {
        let Some(out) = self.0 else { return Ok(()) };
        let create = || Ok(OutputFolder::create(out, &[], true)?);
        let folder = processes.agree(processes.is_first().then(create).transpose())?;
        let gap = gap_to_write(solution);
        let fields = [&*gap, &solution.pressure, &solution.contact_pressure].into_iter().chain(&solution.plastic_depth);
        let named: Vec<_> = FIELDS.iter().zip(fields).map(|(name, field)| (file(name, row), field)).collect();
        write_fields(processes, folder.as_ref(), out, solution.grid, &named)?;
        processes.first(|| folder.map_or(Ok(()), |folder| Ok(folder.commit()?)))
    }

    /// Removes the fields of a row.
    pub fn forget(self, row: usize) {
        self.0.into_iter().flat_map(|folder| FIELDS.map(|name| folder.join(file(name, row)))).for_each(remove);
    }
}

fn file(name: &str, row: usize) -> String {
    format!("{name}-{row:04}.npy")
}

/// The fields of rows in a folder, in the order of the rows.
fn present(folder: &Path) -> Vec<PathBuf> {
    let row_and_field = |path: &Path| {
        let (name, row) = path.file_name()?.to_str()?.strip_suffix(".npy")?.rsplit_once('-')?;
        Some((row.parse::<usize>().ok()?, FIELDS.iter().position(|field| *field == name)?))
    };
    let paths = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<_> = paths.filter_map(|path| Some((row_and_field(&path)?, path))).collect();
    found.sort();
    found.into_iter().map(|(_, path)| path).collect()
}

fn remove(path: PathBuf) {
    let _ = fs::remove_file(path);
}
