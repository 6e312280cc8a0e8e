//! Fields as files; each process writes its rows.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use asperity::{Grid, Solution};
use asperity_maps::io::{OutputFolder, create_npy, write_npy, write_npy_rows};
use ndarray::Array2;

use crate::key::Scalar;
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::table::output::at_destination;

/// Writes fields on a grid, under their names, into the folder that the first process has for the files in `out`.
pub fn write_fields<T: Scalar>(
    processes: &Processes,
    folder: Option<&OutputFolder>,
    out: &Path,
    grid: Grid,
    fields: &[(String, &Array2<T>)],
) -> Outcome<()> {
    let at_destination = |error| at_destination(error, out).into();
    let here = folder.map_or(PathBuf::new(), |folder| folder.path(""));
    if !grid.is_shared() {
        let mut named = fields.iter().map(|(name, field)| (here.join(name), *field));
        return named.try_for_each(|(path, field)| write_npy(&path, field)).map_err(at_destination);
    }
    let files = PathBuf::from(processes.broadcast(here.display().to_string()));
    let named = fields.iter().map(|(name, field)| (files.join(name), *field));
    let mut create = fields.iter().map(|(name, _)| create_npy::<T>(&files.join(name), grid.shape()));
    processes.first(|| create.try_for_each(|created| created).map_err(at_destination))?;
    let mut write = named.map(|(path, field)| write_npy_rows(&path, grid.shape(), grid.rows().start, field));
    processes.agree(write.try_for_each(|written| written).map_err(at_destination))
}

/// The gap as files have it: NaN at absent nodes, where there is none.
pub fn gap_to_write<T: Scalar>(solution: &Solution<T>) -> Cow<'_, Array2<T>> {
    if solution.report.absent_nodes == 0 {
        return Cow::Borrowed(&solution.gap);
    }
    Cow::Owned(solution.gap.mapv(|gap| if gap.is_finite() { gap } else { T::nan() }))
}
