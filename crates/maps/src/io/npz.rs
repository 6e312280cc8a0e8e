//! Height maps in NumPy archives (`.npz`).

use std::fs;
use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use std::path::Path;

use ndarray::{Array2, ArrayView2};
use zip::read::ZipFile;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::foreign::by_member;
use super::npy::{read_npy, read_npy_text};
use super::npy_writer::{header, text_as_npy, write_field};
use super::{DAMAGED, Parsed, is_side, quoted, refuse, unreadable};
use crate::Topography;
use asperity::{Error, Grid, Real, Result};

/// The first bytes of a zip file: of its first entry, or of its end if it has none.
pub(super) const ZIP: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];
/// Deflate cannot do better than this: a zip entry that claims more is damaged.
const MAX_COMPRESSION: u64 = 1032;
/// Room in bytes for what an archive has besides the numbers of an array.
const ENTRY: usize = 1024;

/// The arrays that an archive of a map may have.
const ARRAYS: [&str; 8] = ["heights", "lengths", "unit", "units", "original", "seed", "scars_removed", "periodic"];

/// Reads the array `heights`, or the only one, of an archive of `size` bytes; and the other arrays of a map.
pub(super) fn read_npz<R: Read + Seek>(mut reader: R, size: u64) -> Parsed<Topography> {
    check_counts(&mut reader, size).map_err(unreadable)?;
    let mut archive = ZipArchive::new(reader).map_err(damaged)?;
    let index = heights_of(&archive)?;
    let mut map = Topography::new(read_entry(&mut archive, index, size, |entry, size| read_npy(entry, size))?);
    if archive.len() == 1 {
        return Ok(map);
    }
    if let Some(lengths) = numbers(&mut archive, "lengths.npy", size)? {
        match lengths.as_slice() {
            Some(&[lx, ly]) if is_side(lx) && is_side(ly) => map.lengths = Some((lx, ly)),
            _ => return refuse("has an array lengths that is not two positive numbers: save it as [Lx, Ly]"),
        }
    }
    if let Some(index) = ["unit.npy", "units.npy"].iter().find_map(|name| archive.index_for_name(name)) {
        let unit = read_entry(&mut archive, index, size, |entry, size| read_npy_text(entry, size))?;
        map.unit = Some(unit).filter(|unit| !unit.is_empty());
    }
    if let Some(nodes) = numbers(&mut archive, "original.npy", size)? {
        let fits = |nodes: f64, of: usize| nodes >= 1.0 && nodes <= of as f64 && nodes.fract() == 0.0;
        map.original = match nodes.as_slice() {
            Some(&[x, y]) if fits(x, map.heights.nrows()) && fits(y, map.heights.ncols()) => {
                Some((x as usize, y as usize))
            }
            _ => {
                let text = "has an array original that is not two numbers of nodes of the map: prepare the map again";
                return refuse(text);
            }
        };
    }
    if let Some(index) = archive.index_for_name("seed.npy") {
        let seed = read_entry(&mut archive, index, size, |entry, size| read_npy_text(entry, size))?;
        let wrong = || format!("has the seed {}, expected a whole number: leave the array out", quoted(&seed));
        map.seed = Some(seed.parse().map_err(|_| wrong())?);
    }
    if let Some(threshold) = numbers(&mut archive, "scars_removed.npy", size)? {
        match threshold.as_slice() {
            Some(&[threshold]) if threshold > 0.0 && threshold.is_finite() => map.scars_removed = Some(threshold),
            _ => return refuse("has an array scars_removed that is not a positive number: leave the array out"),
        }
    }
    if let Some(periodic) = numbers(&mut archive, "periodic.npy", size)? {
        match periodic.as_slice() {
            Some(&[is @ (0.0 | 1.0)]) => map.periodic = Some(is > 0.0),
            _ => return refuse("has an array periodic that is neither 0 nor 1: leave the array out"),
        }
    }
    let unread = archive.file_names().map(array).filter(|name| !ARRAYS.contains(name));
    map.unread = unread.map(str::to_owned).collect();
    Ok(map)
}

/// The index of the heights: of the only array, or of the array with this name.
fn heights_of<R: Read + Seek>(archive: &ZipArchive<R>) -> Parsed<usize> {
    match (archive.len(), archive.index_for_name("heights.npy")) {
        (1, _) => Ok(0),
        (_, Some(index)) => Ok(index),
        (count, None) => {
            if let Some(reason) = by_member(archive.file_names()) {
                return refuse(reason);
            }
            let names = archive.file_names().take(10).map(|name| quoted(array(name)));
            let names = names.collect::<Vec<_>>().join(", ");
            refuse(format!(
                "holds {count} arrays ({names}), expected one, or one named heights: save the heights alone, as .npy or .npz"
            ))
        }
    }
}

/// The numbers of an array, if the archive has it.
fn numbers<R: Read + Seek>(archive: &mut ZipArchive<R>, name: &str, size: u64) -> Parsed<Option<Array2<f64>>> {
    let index = archive.index_for_name(name);
    index.map(|index| read_entry(archive, index, size, |entry, size| read_npy(entry, size))).transpose()
}

/// The name of an array, from the name of its entry in the archive.
fn array(entry: &str) -> &str {
    entry.strip_suffix(".npy").unwrap_or(entry)
}

/// Checks that the end of an archive without a comment gives its number of entries twice: one of them decides how many
/// are found, and no checksum covers it.
fn check_counts(reader: &mut (impl Read + Seek), size: u64) -> io::Result<()> {
    let mut end = [0; 22];
    if size >= end.len() as u64 {
        reader.seek(SeekFrom::End(-(end.len() as i64)))?;
        reader.read_exact(&mut end)?;
        reader.rewind()?;
    }
    if end.starts_with(ZIP[1]) && end[8..10] != end[10..12] {
        return Err(io::Error::other("its end is damaged: copy or save it again"));
    }
    Ok(())
}

fn damaged(error: zip::result::ZipError) -> String {
    format!("is not a .npz file that can be read ({error}): copy or save it again")
}

fn read_entry<R: Read + Seek, T>(
    archive: &mut ZipArchive<R>,
    index: usize,
    size: u64,
    read: impl FnOnce(&mut ZipFile<'_, R>, u64) -> Parsed<T>,
) -> Parsed<T> {
    let mut entry = archive.by_index(index).map_err(damaged)?;
    let entry_size = entry.size();
    if entry_size / MAX_COMPRESSION > size { refuse(DAMAGED) } else { read(&mut entry, entry_size) }
}

/// Writes fields on a grid into one `.npz` file, over one that may be there, and the side lengths with them as
/// `lengths`.
///
/// ```
/// use asperity::Grid;
/// use asperity_maps::io::write_npz;
/// let folder = tempfile::tempdir()?;
/// let grid = Grid::new((4, 3), (2.0, 3.0))?;
/// // numpy.load("fields.npz")["gap"] has the shape (4, 3)
/// write_npz(folder.path().join("fields.npz"), &grid, &[("gap", grid.sample(|x, y| x * y).view())])?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::Shape`] if a field does not fit the grid, [`Error::File`] if the file cannot be written.
pub fn write_npz<T: Real>(path: impl AsRef<Path>, grid: &Grid, fields: &[(&str, ArrayView2<'_, T>)]) -> Result<()> {
    let path = path.as_ref();
    fs::write(path, npz(grid, fields)?).map_err(|e| Error::unwritable(path, e))
}

/// The bytes of the file that [`write_npz`] writes.
///
/// # Errors
///
/// [`Error::Shape`] if a field does not fit the grid, [`Error::File`] if there is no memory for the bytes.
#[doc(hidden)]
pub fn npz<T: Real>(grid: &Grid, fields: &[(&str, ArrayView2<'_, T>)]) -> Result<Vec<u8>> {
    fields.iter().try_for_each(|(_, field)| Error::shape("field", field.dim(), grid.shape()))?;
    let known = Known { lengths: Some(grid.lengths()), ..Known::default() };
    archive(fields, &known).map_err(|e| Error::unwritable("fields.npz", e))
}

/// The bytes of a map as `.npz`, with all that the map knows; see [`write_topography`](super::write_topography).
///
/// # Errors
///
/// [`Error::File`] if there is no memory for the bytes.
#[doc(hidden)]
pub fn map_as_npz(map: &Topography) -> Result<Vec<u8>> {
    let heights = [("heights", map.heights.view())];
    let seed = map.seed.map(|seed| seed.to_string());
    let &Topography { lengths, original, scars_removed, .. } = map;
    let is_open = map.periodic == Some(false);
    let known = Known { lengths, unit: map.unit.as_deref(), original, seed: seed.as_deref(), scars_removed, is_open };
    archive(&heights, &known).map_err(|e| Error::unwritable("heights.npz", e))
}

/// The entries of an archive that describe its fields.
#[derive(Default)]
struct Known<'a> {
    lengths: Option<(f64, f64)>,
    unit: Option<&'a str>,
    original: Option<(usize, usize)>,
    seed: Option<&'a str>,
    scars_removed: Option<f64>,
    is_open: bool,
}

/// The bytes of an archive. Written straight into a file that cannot take them, the writer of the archive would say so
/// on standard error when it is dropped.
fn archive<T: Real>(fields: &[(&str, ArrayView2<'_, T>)], known: &Known<'_>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let size =
        fields.iter().map(|(_, field)| size_of::<T>() * field.len() + ENTRY).sum::<usize>() + ARRAYS.len() * ENTRY;
    bytes.try_reserve_exact(size)?;
    // in sizes of more than 32 bits, where one could need them
    let large = fields.iter().any(|(_, field)| field.len() >= 1 << 28);
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(large);
    let mut npz = ZipWriter::new(Cursor::new(bytes));
    for (name, field) in fields {
        npz.start_file(format!("{name}.npy"), options)?;
        write_field(&mut npz, *field)?;
    }
    let mut add = |name: &str, array: Vec<u8>| {
        npz.start_file(format!("{name}.npy"), options)?;
        npz.write_all(&array)
    };
    let numbers = |dtype: &str, values: &[[u8; 8]]| [header(dtype, false, &[values.len()]), values.concat()].concat();
    if let Some((lx, ly)) = known.lengths {
        add("lengths", numbers("<f8", &[lx, ly].map(f64::to_le_bytes)))?;
    }
    for (name, text) in [("unit", known.unit), ("seed", known.seed)] {
        text.map_or(Ok(()), |text| add(name, text_as_npy(text)))?;
    }
    if let Some((nx, ny)) = known.original {
        add("original", numbers("<u8", &[nx as u64, ny as u64].map(u64::to_le_bytes)))?;
    }
    if let Some(threshold) = known.scars_removed {
        add("scars_removed", numbers("<f8", &[threshold.to_le_bytes()]))?;
    }
    if known.is_open {
        add("periodic", numbers("<f8", &[0f64.to_le_bytes()]))?;
    }
    Ok(npz.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use ndarray::{Array2, array};
    use zip::ZipWriter;

    use super::super::npy::tests::{f8, npy};
    use super::super::tests::{assert_refused, read, read_map, reason};
    use super::*;

    fn npz(method: CompressionMethod, entries: &[(&str, &[u8])]) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in entries {
            zip.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
            zip.write_all(bytes).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    #[test]
    fn npz_with_one_array() {
        let heights = npy("'>i2'", "False", "(1, 2)", &[1, 0, 255, 255]);
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            assert_eq!(read(npz(method, &[("heights.npy", &heights)])).unwrap(), array![[256.0, -1.0]]);
            // All zeros compress as well as anything does.
            let zeros = npy("'<f8'", "False", "(1000, 1000)", &[0; 8_000_000]);
            assert_eq!(read(npz(method, &[("heights.npy", &zeros)])).unwrap(), Array2::<f64>::zeros((1000, 1000)));
        }
    }

    #[test]
    fn npz_with_another_content_is_refused() {
        let method = CompressionMethod::Stored;
        let heights = npy("'<f8'", "False", "(1,)", &f8(&[1.0]));
        let two = npz(method, &[("a.npy", &heights), ("x.npy", &heights)]);
        assert_refused(read(two), &["2 arrays", "\"a\"", "\"x\"", "save the heights alone"]);
        let names: Vec<_> = (0..50).map(|i| format!("array{i}.npy")).collect();
        let many: Vec<_> = names.iter().map(|name| (&name[..], &heights[..])).collect();
        assert!(reason(read(npz(method, &many))).len() < 300);
        assert_refused(read(npz(method, &[])), &["0 arrays", "expected one"]);
        assert_refused(read(npz(method, &[("notes.txt", b"no array")])), &["something else than a .npy array"]);
        assert_refused(read(npz(method, &[("empty.npy", b"")])), &["truncated"]);
        let complex = npy("'<c16'", "False", "(1,)", &[0; 16]);
        assert_refused(read(npz(method, &[("heights.npy", &complex)])), &["dtype \"<c16\""]);
        let bomb = npy("'<f8'", "False", "(1000000, 1000000)", &[]);
        assert_refused(read(npz(method, &[("heights.npy", &bomb)])), &["0 bytes of data", "truncated"]);
        assert_refused(read(b"PK\x03\x04 and then something else"), &["not a .npz file"]);
    }

    #[test]
    fn damaged_npz_is_refused_without_panic() {
        let heights = npy("'<f8'", "False", "(2,)", &f8(&[1.5, 2.5]));
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            let file = npz(method, &[("heights.npy", &heights)]);
            for length in 0..file.len() {
                assert!(read(&file[..length]).is_err(), "{length}");
            }
            for position in 0..file.len() {
                for flip in [1, 0x80, 0xff] {
                    let mut damaged = file.clone();
                    damaged[position] ^= flip;
                    // Some bytes, as the date, do not matter; the values never change unnoticed.
                    if let Ok(field) = read(damaged) {
                        assert_eq!(field, array![[1.5], [2.5]], "{position}");
                    }
                }
            }
        }
    }

    #[test]
    fn npz_that_claims_a_huge_entry_is_refused() {
        let bomb = npy("'<f8'", "False", "(100000000,)", &[0; 8]);
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            let mut file = npz(method, &[("heights.npy", &bomb)]);
            let claimed = (bomb.len() as u32 - 8 + 800_000_000).to_le_bytes();
            let local = 22;
            let central = file.windows(4).rposition(|w| w == b"PK\x01\x02").unwrap() + 24;
            for position in [local, central] {
                file[position..position + 4].copy_from_slice(&claimed);
            }
            assert_refused(read(file), &["is damaged"]);
        }
    }

    #[test]
    fn no_damage_to_lengths_and_unit_passes_in_silence() {
        let (heights, lengths) = (npy("'<f8'", "False", "(2,)", &f8(&[1.5, 2.5])), f8(&[3.0, 4.0]));
        let lengths = npy("'<f8'", "False", "(2,)", &lengths);
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            let entries = [("heights.npy", &heights[..]), ("lengths.npy", &lengths), ("unit.npy", &text_as_npy("nm"))];
            let file = npz(method, &entries);
            let whole = read_map(&file, "a.npz").unwrap();
            assert_eq!((whole.lengths, whole.unit.as_deref()), (Some((3.0, 4.0)), Some("nm")));
            let mut unnoticed = Vec::new();
            for position in 0..file.len() {
                for flip in [1, 0x80, 0xff] {
                    let mut damaged = file.clone();
                    damaged[position] ^= flip;
                    // a damaged name belongs to an array that is not read
                    if let Ok(map) = read_map(damaged, "a.npz")
                        && map != whole
                        && map.unread.is_empty()
                    {
                        unnoticed.push((position, flip, map));
                    }
                }
            }
            assert!(unnoticed.is_empty(), "of {} bytes: {unnoticed:?}", file.len());
        }
    }

    #[test]
    fn arrays_that_are_not_read_are_named() {
        let heights = npy("'<f8'", "False", "(2,)", &f8(&[1.5, 2.5]));
        let unread = |names: &[&str]| {
            let entries: Vec<_> = names.iter().map(|name| (*name, &heights[..])).collect();
            read_map(npz(CompressionMethod::Stored, &entries), "a.npz").unwrap().unread
        };
        assert_eq!(unread(&["heights.npy", "sides.npy", "notes.txt"]), ["sides", "notes.txt"]);
        assert_eq!(unread(&["heights.npy", "lengths.npy"]), [""; 0]);
        assert_eq!(unread(&["map.npy"]), [""; 0]);
        let surface = npz(CompressionMethod::Stored, &[("main.xml", b"<p:ISO5436_2/>"), ("bindata/data.bin", b"\0")]);
        assert_refused(read(surface), &[".x3p", "Gwyddion"]);
    }

    #[test]
    fn npz_with_lengths_and_unit() {
        let method = CompressionMethod::Stored;
        let heights = npy("'<f8'", "False", "(1, 2)", &f8(&[1.0, 2.0]));
        let lengths = npy("'<f8'", "False", "(2,)", &f8(&[3.0, 4.0]));
        let unit = text_as_npy("\u{b5}m");
        assert_eq!((unit.len() - 8) % 64, 0);
        for name in ["unit.npy", "units.npy"] {
            let entries =
                [(name, &unit), ("other.npy", &lengths), ("lengths.npy", &lengths), ("heights.npy", &heights)];
            let map = read_map(npz(method, &entries.map(|(name, entry)| (name, &entry[..]))), "heights.npz").unwrap();
            let expected = (array![[1.0, 2.0]], Some((3.0, 4.0)), Some("\u{b5}m"));
            assert_eq!((map.heights, map.lengths, map.unit.as_deref()), expected);
        }
        for (name, wrong, part) in [
            ("lengths.npy", npy("'<f8'", "False", "(3,)", &f8(&[1.0, 2.0, 3.0])), "lengths"),
            ("lengths.npy", npy("'<f8'", "False", "(2,)", &f8(&[1.0, f64::NAN])), "two positive numbers"),
            ("unit.npy", lengths, "a text"),
            ("original.npy", npy("'<f8'", "False", "(2,)", &f8(&[1.0, 3.0])), "numbers of nodes"),
            ("original.npy", npy("'<f8'", "False", "(2,)", &f8(&[0.5, 1.0])), "numbers of nodes"),
            ("seed.npy", text_as_npy("-1"), "a whole number"),
            ("scars_removed.npy", npy("'<f8'", "False", "(1,)", &f8(&[-1.0])), "a positive number"),
            ("unit.npy", npy("'<U1'", "False", "()", &[0, 0, 0xff, 0xff]), "damaged"),
            ("unit.npy", npy("'<U9999999999999999999'", "False", "()", &[0; 4]), "a text"),
            ("unit.npy", npy("'<U1'", "False", "(1,)", &[b'm', 0, 0, 0]), "a text"),
        ] {
            assert_refused(read(npz(method, &[("heights.npy", &heights), (name, &wrong)])), &[part]);
        }
    }
}
