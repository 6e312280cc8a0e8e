//! Reading height maps and gaps, and writing results.
//!
//! [`read_topography`] takes what measuring instruments, Gwyddion and numpy write: `.npy`, `.npz`, `.gwy`, `.gsf`,
//! `.xyz` and texts, with side lengths and units where they are known; [`read_field`] takes the numbers alone, a
//! [`Reading`] one of several [`channels()`], or what is in memory, and [`read_fourier`] Fourier coefficients.
//! [`write_topography`] writes maps, [`write_npz`] and [`write_vti`] all fields of a solution into one file, for numpy and
//! for ParaView.

mod blocks;
mod channels;
mod columns;
mod commas;
mod foreign;
mod fourier;
mod gsf;
mod gwy;
mod heading;
mod lines;
mod memory;
mod npy;
mod npy_writer;
mod npz;
mod output;
mod reading;
mod refusal;
mod sdf;
mod text;
mod units;
mod vti;
mod xyz;

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::ops::Range;
use std::path::Path;

use ndarray::{Array2, Axis, Slice};

use crate::Topography;
use asperity::{Error, Result};
pub use channels::Channel;
pub use fourier::read_fourier;
use gsf::{GSF, read_gsf, write_gsf};
use gwy::{GWY, read_gwy};
pub use memory::{available_memory, check_memory};
use npy::{NPY, read_npy, read_npy_rows};
pub use npy_writer::{create_npy, write_npy, write_npy_rows};
use npz::{ZIP, read_npz};
pub use npz::{map_as_npz, npz, write_npz};
pub use output::OutputFolder;
pub use reading::Reading;
use refusal::{DAMAGED, Parsed, Refusal, TRUNCATED, check_room, quoted, refuse, reserve, unreadable};
use sdf::{SDF, read_sdf};
use text::Text;
pub use vti::write_vti;
pub(crate) use xyz::coordinates;

/// The largest number of characters of a unit in a file that is written; far more than any has.
pub const LONGEST_UNIT: usize = 64;

/// Reads a field, a height map or a gap, from a file of any of the formats of [`read_topography`]: its numbers alone.
///
/// # Errors
///
/// As for [`read_topography`].
///
/// ```
/// use asperity_maps::io::read_field;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("heights.txt");
/// std::fs::write(&path, "# heights in micrometres\n0.1 0.3 0.2\n0.4 nan 0.1\n")?;
///
/// let heights = read_field(&path)?;
/// assert_eq!(heights.dim(), (2, 3));
/// assert_eq!(heights[[0, 1]], 0.3);
/// assert!(heights[[1, 1]].is_nan());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_field(path: impl AsRef<Path>) -> Result<Array2<f64>> {
    read_topography(path).map(|map| map.heights)
}

/// Reads a height map from a file, with side lengths and unit where it has them. The content and not the ending of the
/// file decides on the format, but for `.xyz`.
///
/// - `.npy`: floating-point numbers of 4 or 8 bytes or integers of 1 to 8 bytes, in either byte order and
///   either memory order. Integers beyond 2^53 are rounded.
/// - `.npz`: as `.npy`, compressed or not, with exactly one array in it, or with one named `heights`. Arrays
///   `lengths`, two numbers, `unit` or `units`, a text, and what [`write_topography`] says of mirrors and seeds are
///   read, too; [`Topography::unread`] names all others.
/// - Gwyddion's own files (`.gwy`): their only channel, or the only one with heights in a unit of length; a [`Reading`]
///   takes any. [`Topography::unread`] names the other channels, and a mask. Shown corrections are left where they are.
/// - Gwyddion Simple Field (`.gsf`): with the side lengths XReal and YReal, and units.
/// - Texts of ISO 25178-71 (`.sdf`): in metres.
/// - text: one row per line; numbers separated by white space, or by tabs, or by commas, or by semicolons. A line ends
///   with LF, CR or both. Numbers may be in quotes, and have Fortran's exponent D. Decimal commas are refused.
///   - Missing points are words, as nan, `1.#QNAN`, `#N/A`, NA, Bad or null, or nothing between separators.
///   - `#`, `%`, `!` and `//` start a comment at the start of a line or behind a blank, `;` at the start of a line.
///   - Comments and headings of the form `name: number unit` or `name = number unit` tell sizes, pixels and units, as
///     texts of Gwyddion in any language, SPIP, Attocube, Nova, Keyence and ESRI do. The lines are lines of an image
///     then. A comment such as `heights in nm` tells the unit of the map. What may tell a size and is not understood is
///     in [`Topography::unread`].
///   - Blocks of numbers with blank lines or headings between are channels; a [`Reading`] takes one.
///   - Three columns x, y and z of a whole grid are points, as in `.xyz`. A line with the names of the columns gives
///     their order, and may name others. Without names, coordinates in other columns are refused. So are lines where
///     each comma may be within a number, such as `1,5,2,5`, unless there are so many different numbers that decimal
///     places would begin with a zero now and then.
/// - text with a name that ends in `.xyz`: points x y z, one per line, of a regular grid parallel to the axes, in any
///   order. Nodes without a point are missing. Rounded or noisy coordinates may be off the grid by a tenth of its
///   spacing. A heading may tell units, as `X[um] Y[um] Z[nm]`, or a line below it. Nx and Ny follow from the spacings,
///   and the side lengths are Nx Δx and Ny Δy.
///
/// **Orientation.** Arrays and plain texts have shape (Nx, Ny): the first index, in a text the line, runs along x.
/// Images have lines along x, from the top to the bottom: line r of Ny in Gwyddion's three formats becomes column Ny −
/// 1 − r of the map, so that y runs upwards and pictures of the map show what Gwyddion shows.
///
/// **Units.** Where the file gives units of length for both side lengths and heights, the map is in metres, whatever
/// their prefixes. Where both are the same other unit it stays. All else that has units is refused, as are values that
/// are no heights.
///
/// A one-dimensional array of n values, and a text file with a single column, give shape `(n, 1)`. NaN and
/// infinities are read as they stand: they mark missing points, which a surface refuses later. The array is
/// in standard layout.
///
/// # Errors
///
/// [`Error::File`] if the file cannot be read, is truncated or damaged, or holds anything but one array of
/// real numbers with one or two dimensions and at least one value; for `.xyz`, if its points are scattered. Files of
/// instruments, images, and other binary files are named, with a way to convert them. [`Error::Memory`] if the heights
/// take more than there is.
///
/// ```
/// use asperity_maps::io::read_topography;
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("exported.txt");
/// std::fs::write(&path, "# Channel: Height\n# Width: 3 µm\n# Height: 2 µm\n# Value units: nm\n1 2 3\n4 5 6\n")?;
///
/// let map = read_topography(&path)?;
/// assert_eq!(map.heights.dim(), (3, 2));
/// assert_eq!(map.heights[[0, 1]], 1e-9); // at the left, on top
/// assert_eq!((map.lengths, map.unit.as_deref()), (Some((3e-6, 2e-6)), Some("m")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_topography(path: impl AsRef<Path>) -> Result<Topography> {
    Reading::default().read(path)
}

/// The channels in the bytes of a file of a name: of a `.gwy` file, or of a text with several blocks of numbers; none if
/// it has one map.
///
/// # Errors
///
/// [`Error::File`] if the file is truncated or damaged.
pub fn channels(name: &str, bytes: &[u8]) -> Result<Vec<Channel>> {
    let found = match format_of(bytes, &ending(Path::new(name))) {
        Ok(Format::Gwy) => gwy::channels(bytes),
        Ok(Format::Text { binary: None }) => Text::read(bytes, &Reading::default()).and_then(|text| text.several()),
        _ => Ok(Vec::new()),
    };
    found.map_err(|refusal| refusal.in_file(Path::new(name)))
}

/// Reads the rows of a height map that `rows` chooses by its shape (Nx, Ny), and tells that shape; otherwise as
/// [`read_topography`]. Of a `.npy` in row-major order no more is read than these rows.
///
/// For a grid that several processes share: each holds the rows [`Grid::rows`](asperity::Grid::rows).
///
/// ```
/// use asperity_maps::io::{read_rows, write_npy};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("heights.npy");
/// write_npy(&path, &ndarray::array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])?;
/// let (map, shape) = read_rows(&path, |(nx, _)| 1..nx)?;
/// assert_eq!((map.heights, shape), (ndarray::array![[3.0, 4.0], [5.0, 6.0]], (3, 2)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// As for [`read_topography`].
pub fn read_rows(
    path: impl AsRef<Path>,
    rows: impl FnOnce((usize, usize)) -> Range<usize>,
) -> Result<(Topography, (usize, usize))> {
    let path = path.as_ref();
    let is_npy = || {
        let mut start = [0; NPY.len()];
        io::Result::Ok(File::open(path)?.read_exact(&mut start).is_ok() && start == NPY)
    };
    if !fs::metadata(path).is_ok_and(|metadata| metadata.is_file()) || !is_npy().is_ok_and(|is| is) {
        let mut map = read_topography(path)?;
        let shape = map.heights.dim();
        map.heights = map.heights.slice_axis(Axis(0), Slice::from(rows(shape))).to_owned();
        return Ok((map, shape));
    }
    let read = || {
        let file = File::open(path).map_err(unreadable)?;
        let size = file.metadata().map_err(unreadable)?.len();
        let (heights, shape) = read_npy_rows(&mut BufReader::new(file), size, rows)?;
        Ok((Topography::new(heights), shape))
    };
    read().map_err(|refusal: Refusal| refusal.in_file(path))
}

/// Writes a map, over a file that may be there; the ending of `path` decides on the format.
///
/// - `.npz`: `heights`, and if they are known `lengths`, `unit`, `original` (two numbers of nodes), `seed` (a text), and
///   `scars_removed` (a number). Nothing is lost.
/// - `.gsf`, for Gwyddion: the heights are rounded to `f32`.
/// - `.npy`: the heights alone.
///
/// ```
/// use asperity_maps::io::{read_topography, write_topography};
/// use asperity::{Grid, Surface};
/// use asperity_maps::{ScanAxis, Topography};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("wave.npz");
/// let mut wave = Topography::from(Surface::wave(Grid::new((8, 4), (2e-6, 1e-6))?, 1e-9, 1)?);
/// (wave.unit, wave.seed) = (Some("m".into()), Some(7));
/// let wave = wave.remove_scars(0.7, ScanAxis::X)?.mirror();
/// write_topography(&path, &wave)?;
/// assert_eq!(read_topography(&path)?, wave);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::File`] if the name has another ending, heights leave the range of the format, the unit is longer than
/// [`LONGEST_UNIT`], or the file cannot be written.
pub fn write_topography(path: impl AsRef<Path>, map: &Topography) -> Result<()> {
    let path = path.as_ref();
    let longest = map.unit.as_ref().map_or(0, |unit| unit.chars().count());
    match ending(path).as_str() {
        "npz" if longest > LONGEST_UNIT => {
            Err(Error::file(path, format!("has a unit of {longest} characters: give one of at most {LONGEST_UNIT}")))
        }
        "npy" => write_npy(path, &map.heights),
        "npz" => fs::write(path, map_as_npz(map)?).map_err(|e| Error::unwritable(path, e)),
        "gsf" if map.heights.iter().any(|h| h.is_finite() && !(*h as f32).is_finite()) => {
            Err(Error::file(path, "cannot hold such heights, its numbers are f32: choose .npz or .npy"))
        }
        "gsf" => write_gsf(path, map).map_err(|e| Error::unwritable(path, e)),
        _ => Err(Error::file(path, "has no ending of a format that is written: choose .npz, .npy or .gsf")),
    }
}

/// The ending of a name, behind its last point, in small letters.
fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// A file and its size; `kinds` can be read.
fn opened(path: &Path, kinds: &str) -> Parsed<(BufReader<File>, u64)> {
    // Before opening, which would wait for ever on a named pipe.
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a folder" } else { "not a regular file" };
        return refuse(format!("is {kind}: name {kinds}"));
    }
    Ok((BufReader::new(File::open(path).map_err(unreadable)?), metadata.len()))
}

fn read_any(path: &Path, reading: &Reading) -> Parsed<Topography> {
    let (reader, size) = opened(path, "a .npy, .npz, .gwy, .gsf, .xyz or text file")?;
    read_from(reader, size, &ending(path), reading)
}

/// A format that is read.
enum Format {
    Gwy,
    Gsf,
    Npy,
    Npz,
    Sdf,
    Points,
    /// A text, or the reason why a binary file cannot be read as one.
    Text {
        binary: Option<String>,
    },
}

/// The format of a file with a start and an ending of its name; refused if it is known and not read.
fn format_of(start: &[u8], ending: &str) -> Parsed<Format> {
    Ok(match () {
        () if start.starts_with(GWY) => Format::Gwy,
        () if start.starts_with(NPY) => Format::Npy,
        () if ZIP.iter().any(|magic| start.starts_with(magic)) => Format::Npz,
        () if start.starts_with(GSF) => Format::Gsf,
        () if SDF.iter().any(|magic| start.starts_with(magic)) => Format::Sdf,
        () => match (foreign::by_start(start), foreign::by_ending(start, ending)) {
            (Some(reason), _) => return refuse(reason),
            (None, None) if ending == "xyz" => Format::Points,
            (None, binary) => Format::Text { binary },
        },
    })
}

/// Reads a map of `size` bytes from a file; `ending` belongs to its name.
fn read_from(mut reader: impl BufRead + Seek, size: u64, ending: &str, reading: &Reading) -> Parsed<Topography> {
    let format = format_of(reader.fill_buf().map_err(unreadable)?, ending)?;
    let is_text = matches!(format, Format::Text { .. } | Format::Points);
    let given = [
        (
            reading.channel.is_some() && !(matches!(format, Format::Gwy | Format::Text { .. })),
            "channels",
            "the channel",
        ),
        (reading.skip_lines > 0 && !is_text, "lines", "the number of lines"),
        (!reading.missing.is_empty() && !is_text, "words", "words for missing points"),
        (reading.masked && !matches!(format, Format::Gwy), "masks", "that masked points are missing"),
    ];
    if let Some((_, what, option)) = given.iter().find(|(is_useless, ..)| *is_useless) {
        return refuse(format!("has no {what}, like all files of this format: leave {option} out"));
    }
    let map = match format {
        Format::Gwy => read_gwy(&mut reader, size, reading),
        Format::Npy => read_npy(&mut reader, size).map(Topography::new),
        Format::Npz => read_npz(reader, size),
        Format::Gsf => read_gsf(&mut reader, size),
        Format::Sdf => read_sdf(&mut reader, size),
        Format::Points => Text::read(reader, reading).and_then(Text::points),
        Format::Text { binary } => Text::read(reader, reading)
            .and_then(|text| text.map(reading))
            .map_err(|refusal| binary.map_or(refusal, Refusal::Reason)),
    }?;
    // other units than the file's may have made them so
    if let Some((lx, ly)) = map.lengths.filter(|(lx, ly)| !(is_side(*lx) && is_side(*ly))) {
        return refuse(format!(
            "has side lengths of {lx} and {ly}, expected positive numbers: save it again with them"
        ));
    }
    match &map.unit {
        // it would reach terminals
        Some(unit) if unit.contains(char::is_control) => {
            refuse(format!("has the unit {}, expected a text without control characters: save it again", quoted(unit)))
        }
        _ => Ok(map),
    }
}

/// Whether a length can be a side length.
fn is_side(length: f64) -> bool {
    length > 0.0 && length.is_finite()
}

#[cfg(test)]
mod tests;
