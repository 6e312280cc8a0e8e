//! Heights from files, with the side lengths and units that those may have.

use std::ops::Range;
use std::path::Path;

use asperity::Grid;
use asperity_maps::Topography;
use asperity_maps::io::{read_rows, read_topography};
use asperity_maps::warning::{Warning, WarningCode};
use asperity_scene::{Entries, Map, Outcome, Processes, Skin, complete, in_unit, sided, worded};
use ndarray::Array2;

/// The name of a file in messages and reports.
pub fn named(path: &Path) -> Option<String> {
    Some(path.to_string_lossy().into_owned())
}

/// The map of a file with the given `--lengths` (one alone means square cells), or the side lengths of the file, or none.
pub fn map(path: &Path, given: &Entries, si: bool) -> Outcome<Topography> {
    let map = Map::whole(named(path), read_topography(path)?);
    Ok(sided(map, given, si, Skin::Options)?.topography)
}

/// Refuses a map if its statistics, or a step of preparation, do not fit into memory: running out of it cannot be
/// caught later.
pub fn check_room((nx, ny): (usize, usize)) -> Outcome<()> {
    let numbers = nx.checked_mul(ny).and_then(|nodes| nodes.checked_mul(4));
    if numbers.is_none_or(|numbers| Vec::<f64>::new().try_reserve_exact(numbers).is_err()) {
        return Err(format!("{nx} x {ny} nodes do not fit into memory: use fewer").into());
    }
    Ok(())
}

/// The rows of the field of a file that this process holds of a grid.
pub fn rows_of(path: &Path, grid: &Grid) -> Outcome<Array2<f64>> {
    let Range { start, end } = grid.rows();
    let (map, (nx, ny)) = read_rows(path, |(nx, _)| start.min(nx)..end.min(nx))?;
    let (of_x, of_y) = grid.shape();
    match (nx, ny) == grid.shape() {
        true => Ok(map.heights),
        false => Err(format!("{} has {nx} x {ny} nodes, but the heights have {of_x} x {of_y}", path.display()).into()),
    }
}

/// The rows of a map that this process holds, and the shape of the map.
pub fn shared(path: &Path, processes: &Processes) -> Outcome<(Topography, (usize, usize))> {
    let mut refused = None;
    let found = read_rows(path, |shape| {
        let grid = Grid::new(shape, (1.0, 1.0)).and_then(|grid| processes.share(grid));
        grid.map(|grid| grid.rows()).unwrap_or_else(|error| {
            refused = Some(error);
            0..0
        })
    })?;
    refused.map_or(Ok(found), |error| Err(error.into()))
}

/// The warnings of what stands next to the heights in a file, if its side lengths are unknown and may be among them.
pub fn unread(map: &Topography) -> Vec<Warning> {
    Warning::of_source(map).into_iter().filter(|found| found.code == WarningCode::Sides).collect()
}

/// The map of a file in a unit of length. One without a unit is in it already.
pub fn converted(path: &Path, map: Topography, unit: &str) -> Outcome<Topography> {
    Ok(in_unit(map, unit).map_err(|text| format!("{}: {}", path.display(), worded(&text, Skin::Options)))?)
}

/// Refuses a map with missing points.
pub fn check_complete(path: &Path, map: &Topography) -> Outcome<()> {
    let heights = (&map.heights, map.heights.dim());
    Ok(complete(&path.to_string_lossy(), heights, false, Skin::Options)?)
}
