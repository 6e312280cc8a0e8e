//! Heights from files, with the side lengths and units that those may have.

use std::ops::Range;
use std::path::Path;

use asperity::{Error, Grid, Surface};
use asperity_maps::io::{read_rows, read_topography};
use asperity_maps::{Topography, surface_with_absent};
use asperity_scene::{Given, Skin, in_unit, worded};
use ndarray::Array2;

use crate::outcome::Outcome;
use crate::printing::Warn;
use crate::processes::Processes;
use crate::quantity::LENGTH;
use crate::units::Units;

/// The relative difference that `--lengths` may have from the side lengths of the file, whose header rounds.
const ROUNDING: f64 = 1e-2;
/// The largest number of names of arrays in a message.
const MOST_NAMES: usize = 10;

/// The entries of the file of a surface besides its heights.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// The unit of length.
    pub unit: Option<String>,
    /// The nodes of the original of a mirrored map.
    pub original: Option<(usize, usize)>,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    /// The threshold of the scars that were removed.
    pub scars_removed: Option<f64>,
    /// The unit of the file, if its heights were converted from it.
    pub converted_from: Option<String>,
}

impl Origin {
    /// That of a map which was converted from the unit of its file, or was not.
    fn of(map: &Topography, converted_from: Option<String>) -> Self {
        let &Topography { original, seed, scars_removed, .. } = map;
        Self { unit: map.unit.clone(), original, seed, scars_removed, converted_from }
    }
}

/// The map of a file with the given `--lengths`, of which one means square cells, or those of the file, or none.
/// Lengths that contradict the file are refused. In SI units all is in metres, and side lengths have to be known.
pub fn map(path: &Path, given: &Given, si: bool) -> Outcome<(Topography, Origin)> {
    with_sides(path, read_topography(path)?, given, si)
}

/// The same of a map that was read or made.
pub fn with_sides(path: &Path, map: Topography, given: &Given, si: bool) -> Outcome<(Topography, Origin)> {
    let (mut map, unit) = in_metres_if(si, path, map)?;
    map.lengths = sides_of(path, &map, map.heights.dim(), given, si)?;
    let origin = Origin::of(&map, unit);
    Ok((map, origin))
}

/// The map of a file, in metres if numbers are in SI units, and the unit from which it was converted.
pub fn map_in(si: bool, path: &Path) -> Outcome<(Topography, Option<String>)> {
    in_metres_if(si, path, read_topography(path)?)
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

/// A map, in metres if numbers are in SI units, and the unit from which it was converted.
fn in_metres_if(si: bool, path: &Path, map: Topography) -> Outcome<(Topography, Option<String>)> {
    let unit = map.unit.clone().filter(|unit| si && unit != LENGTH.si);
    Ok((if si { converted(path, map, LENGTH.si)? } else { map }, unit))
}

/// The rows of the field of a file, which an option names, that this process holds of a grid.
pub fn rows_on(option: &'static str, path: &Path, grid: &Grid) -> Outcome<Array2<f64>> {
    let Range { start, end } = grid.rows();
    let (map, found) = read_rows(path, |(nx, _)| start.min(nx)..end.min(nx))?;
    let expected = grid.shape();
    if found == expected { Ok(map.heights) } else { Err(Error::Shape { name: option, found, expected }.into()) }
}

/// The surface of a file, of which every process reads its rows, and its origin. Its missing points become absent
/// nodes, or are refused.
pub fn shared(
    path: &Path,
    given: &Given,
    (si, absent): (bool, bool),
    processes: &Processes,
    warn: Warn<'_>,
) -> Outcome<(Surface, Origin)> {
    let mut read = || {
        let mut refused = None;
        let (map, shape) = read_rows(path, |shape| {
            let grid = Grid::new(shape, (1.0, 1.0)).and_then(|grid| processes.share(grid));
            grid.map(|grid| grid.rows()).unwrap_or_else(|error| {
                refused = Some(error);
                0..0
            })
        })?;
        if let Some(error) = refused {
            return Err(error.into());
        }
        let (map, unit) = in_metres_if(si, path, map)?;
        let sides = or_unit_square(path, &map, sides_of(path, &map, shape, given, si)?, warn);
        Ok((Grid::new(shape, sides)?, map, unit))
    };
    let (grid, map, unit) = processes.agree(read())?;
    let (grid, origin) = (processes.share(grid)?, Origin::of(&map, unit));
    let heights = map.heights;
    let surface = if absent { surface_with_absent(grid, heights) } else { Surface::new(grid, heights) };
    match surface {
        Ok(surface) => Ok((surface, origin)),
        Err(error @ Error::Elsewhere { .. }) => Err(error.into()),
        Err(error) => Err(format!("{}: {error}", path.display()).into()),
    }
}

/// The side lengths of a map of this shape with the given `--lengths`, if they are known. In SI units they have to be.
fn sides_of(
    path: &Path,
    map: &Topography,
    shape: (usize, usize),
    given: &Given,
    si: bool,
) -> Outcome<Option<(f64, f64)>> {
    let given = given.lengths(shape);
    if si && map.lengths.is_none() && given.is_none() {
        let text = "the numbers have units, but nothing says how large the map is: give --lengths, such as 20um";
        return Err(format!("{}: {text}", path.display()).into());
    }
    let mut known = map.lengths;
    if let Some(given) = given {
        if let Some(found) = known {
            let near = |a: f64, b: f64| (a / b - 1.0).abs() <= ROUNDING;
            // a line has no width
            let agree = near(given.0, found.0) && (shape.1 == 1 || near(given.1, found.1));
            if !agree {
                let found = sides(found, map.unit.as_deref());
                return Err(format!(
                    "--lengths gives sides of {}, but {} has {found}: leave --lengths out, or change the file's by \
                     asperity prepare --lengths",
                    sides(given, None),
                    path.display()
                )
                .into());
            }
        }
        known = Some(given);
    }
    Ok(known)
}

/// Side lengths that are known, or those of the unit square.
fn or_unit_square(path: &Path, map: &Topography, known: Option<(f64, f64)>, warn: Warn<'_>) -> (f64, f64) {
    if let Some(mask) = map.unread.iter().find(|beside| beside.starts_with("a mask")) {
        warn(format!("{} has {mask}: asperity prepare takes that option", path.display()));
    }
    known.unwrap_or_else(|| {
        warn_of_unread(path, map, "are taken as 1 x 1", warn);
        (1.0, 1.0)
    })
}

/// Warns of what stands next to the heights in a file, if its side lengths are unknown and may be among them; `are`
/// says which values are taken for these.
pub fn warn_of_unread(path: &Path, map: &Topography, are: &str, warn: Warn<'_>) {
    if map.lengths.is_none() && !map.unread.is_empty() {
        let names: Vec<_> = map.unread.iter().take(MOST_NAMES).map(|name| format!("{name:?}")).collect();
        let more = if map.unread.len() > MOST_NAMES { ", ..." } else { "" };
        let text = format!(
            "{} has no side lengths that are understood, and besides its heights {}{more}: the side lengths {are}; give \
             --lengths, or name their array lengths",
            path.display(),
            names.join(", ")
        );
        warn(text);
    }
}

/// The map of a file in a unit of length. One without a unit is in it already.
pub fn converted(path: &Path, map: Topography, unit: &str) -> Outcome<Topography> {
    Ok(in_unit(map, unit).map_err(|text| format!("{}: {}", path.display(), worded(&text, Skin::Options)))?)
}

/// The surface of a map, on the unit square if its side lengths are unknown. Its missing points become absent nodes, or
/// are refused.
pub fn surface_or_absent(path: &Path, mut map: Topography, absent: bool, warn: Warn<'_>) -> Outcome<Surface> {
    map.lengths = Some(or_unit_square(path, &map, map.lengths, warn));
    let infinite = map.heights.iter().any(|h| h.is_infinite());
    let missing = !infinite && map.missing() > 0;
    if !missing || !absent {
        let remedy = if missing { ", or treat them as absent nodes by --absent-missing" } else { "" };
        check_complete(path, &map).map_err(|error| format!("{error}{remedy}"))?;
    }
    let surface = if missing { map.surface_with_absent() } else { map.surface() };
    Ok(surface.map_err(|error| format!("{}: {error}", path.display()))?)
}

/// Refuses a map with missing points.
pub fn check_complete(path: &Path, map: &Topography) -> Outcome<()> {
    let ((nx, ny), path) = (map.heights.dim(), path.display());
    let of = |is: fn(f64) -> bool| map.heights.indexed_iter().filter(move |(_, height)| is(**height));
    if let Some(((i, j), height)) = of(f64::is_infinite).next() {
        return Err(format!(
            "{path}: {nx} x {ny} heights, {} infinite, the first ({height}) at index [{i}, {j}]: correct them where they \
             come from; if they stand for missing points, asperity prepare {path} --fill --out filled.npz gives them \
             values",
            of(f64::is_infinite).count(),
        )
        .into());
    }
    if let Some(((i, j), _)) = of(f64::is_nan).next() {
        return Err(format!(
            "{path}: {nx} x {ny} heights, {} missing, the first at index [{i}, {j}]: fill missing points first, with \
             asperity prepare {path} --fill --out filled.npz",
            map.missing(),
        )
        .into());
    }
    Ok(())
}

/// Side lengths with their unit.
pub fn sides(sides: (f64, f64), unit: Option<&str>) -> String {
    Units::of_map(unit).sides(sides)
}
