//! Reading height maps and gaps, and writing results.
//!
//! [`read_field`] takes what measuring instruments and numpy write: `.npy`, `.npz` and text matrices.
//! [`OutputFolder`] collects the files of one run and shows them only once all of them are complete.

use crate::error::{Error, Result};
use ndarray::Array2;
use ndarray_npy::WritableElement;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use zip::ZipArchive;

const NPY: &[u8] = b"\x93NUMPY";
/// How a zip file starts: with its first entry, or with its end if it has none.
const ZIP: [&[u8]; 2] = [b"PK\x03\x04", b"PK\x05\x06"];
/// Deflate cannot do better than this: a zip entry that claims more is damaged.
const MAX_COMPRESSION: u64 = 1032;
/// Numbers converted at a time, so that a file and its array are never both in memory.
const CHUNK: usize = 8192;

const TRUNCATED: &str = "ends too early: it is truncated or damaged, copy or save it again";
const DAMAGED: &str = "is damaged: copy or save it again";
const NUMBERS: &str = "expected a .npy or .npz file, or rows of numbers with decimal points (comments behind # or %)";

/// The width in bytes of a stored value, and how to take one from its bytes in little-endian order.
type Decoder = (usize, fn(&[u8]) -> f64);

/// What the readers return: they know the reason, [`read_field`] adds the path.
type Parsed<T> = std::result::Result<T, String>;

/// Reads a height map or a gap from a file, whose content and not whose ending decides on the format.
///
/// - `.npy`: floating-point numbers of 4 or 8 bytes or integers of 1 to 8 bytes, in either byte order and
///   either memory order. Integers beyond 2^53 are rounded.
/// - `.npz`: as `.npy`, compressed or not, with exactly one array in it.
/// - text: one row per line; numbers separated by white space, or by commas, or by semicolons. `#` and `%`
///   start a comment, blank lines are skipped. Decimal commas are not understood.
///
/// A one-dimensional array of n values, and a text file with a single column, give shape `(n, 1)`. NaN and
/// infinities are read as they stand: they mark missing points, which a surface refuses later. The array is
/// in standard layout.
///
/// # Errors
///
/// [`Error::File`] if the file cannot be read, is truncated or damaged, or holds anything but one array of
/// real numbers with one or two dimensions and at least one value.
///
/// ```
/// use asperity::io::read_field;
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
pub fn read_field(path: &Path) -> Result<Array2<f64>> {
    read_any(path).map_err(|reason| Error::file(path, reason))
}

/// Writes a field as `.npy`, over a file that may be there.
///
/// # Errors
///
/// [`Error::File`] if the file cannot be written.
pub fn write_npy<T: WritableElement>(path: &Path, field: &Array2<T>) -> Result<()> {
    ndarray_npy::write_npy(path, field).map_err(|e| Error::file(path, format!("cannot be written: {e}")))
}

fn read_any(path: &Path) -> Parsed<Array2<f64>> {
    // Before opening, which would wait for ever on a named pipe.
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if !metadata.is_file() {
        let kind = if metadata.is_dir() { "a folder" } else { "not a regular file" };
        return Err(format!("is {kind}: name a .npy, .npz or text file"));
    }
    let mut reader = BufReader::new(File::open(path).map_err(unreadable)?);
    let start = reader.fill_buf().map_err(unreadable)?;
    if start.starts_with(NPY) {
        read_npy(&mut reader, metadata.len())
    } else if ZIP.iter().any(|magic| start.starts_with(magic)) {
        read_npz(reader, metadata.len())
    } else {
        read_text(reader)
    }
}

fn unreadable(error: io::Error) -> String {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => TRUNCATED.to_owned(),
        io::ErrorKind::NotFound => "does not exist: check the path".to_owned(),
        _ => format!("cannot be read: {error}"),
    }
}

/// A piece of a file for a message: on one line, of a length that can be read.
fn quoted(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    format!("{short:?}")
}

/// Reads the only array of an archive of `size` bytes.
fn read_npz(reader: BufReader<File>, size: u64) -> Parsed<Array2<f64>> {
    let damaged = |e| format!("is not a .npz file that can be read ({e}): copy or save it again");
    let mut archive = ZipArchive::new(reader).map_err(damaged)?;
    if archive.len() != 1 {
        let names = archive.file_names().take(10).map(|name| quoted(name.strip_suffix(".npy").unwrap_or(name)));
        let (count, names) = (archive.len(), names.collect::<Vec<_>>().join(", "));
        return Err(format!("holds {count} arrays ({names}), expected one: save the heights alone, as .npy or .npz"));
    }
    let mut entry = archive.by_index(0).map_err(damaged)?;
    let entry_size = entry.size();
    if entry_size / MAX_COMPRESSION > size { Err(DAMAGED.to_owned()) } else { read_npy(&mut entry, entry_size) }
}

/// Reads a `.npy` array that takes `size` bytes, which bounds what its header may make us allocate.
fn read_npy(reader: &mut impl Read, size: u64) -> Parsed<Array2<f64>> {
    let mut start = [0; 8];
    reader.read_exact(&mut start).map_err(unreadable)?;
    if !start.starts_with(NPY) {
        return Err("holds something else than a .npy array: save the heights with numpy.save or savez".to_owned());
    }
    let prefix = match start[6] {
        1 => 2,
        2 | 3 => 4,
        version => return Err(format!("is .npy of version {version}, expected 1 to 3: save it again with numpy.save")),
    };
    let mut length = [0; 4];
    reader.read_exact(&mut length[..prefix]).map_err(unreadable)?;
    let length = u32::from_le_bytes(length);
    let Some(data_size) = size.checked_sub(8 + prefix as u64 + u64::from(length)) else {
        return Err(TRUNCATED.to_owned());
    };
    let mut header = vec![0; length as usize];
    reader.read_exact(&mut header).map_err(unreadable)?;
    let header = String::from_utf8_lossy(&header);
    let (dtype, fortran, shape) =
        parse_header(&header).ok_or("has a .npy header that cannot be understood: save it again with numpy.save")?;
    let Some(decoder) = decoder(dtype) else {
        let dtype = quoted(dtype);
        return Err(format!(
            "has dtype {dtype}, expected real numbers (f4, f8 or integers): convert with .astype('f8')"
        ));
    };
    let (rows, columns) = match shape[..] {
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => return Err(format!("has shape {shape:?}, expected two dimensions [Nx, Ny], or one: save one height map")),
    };
    if rows == 0 || columns == 0 {
        return Err(format!("has shape {shape:?}, expected at least one value: save the heights again"));
    }
    let promised = rows.checked_mul(columns).and_then(|n| n.checked_mul(decoder.0));
    if promised.is_none_or(|bytes| bytes as u64 != data_size) {
        return Err(format!(
            "has shape {shape:?} of dtype {dtype} but {data_size} bytes of data: \
             it is truncated or damaged, save it again"
        ));
    }
    let values = read_values(reader, rows * columns, decoder, dtype.starts_with('>'))?;
    if fortran {
        let transposed = Array2::from_shape_vec((columns, rows), values).map_err(|e| e.to_string())?;
        Ok(transposed.t().as_standard_layout().into_owned())
    } else {
        Array2::from_shape_vec((rows, columns), values).map_err(|e| e.to_string())
    }
}

/// Reads the rest of `reader`, `count` values, each with its bytes `reversed` if they are big-endian.
fn read_values(reader: &mut impl Read, count: usize, (width, decode): Decoder, reversed: bool) -> Parsed<Vec<f64>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| format!("needs too much memory for its {count} values"))?;
    let mut buffer = vec![0; CHUNK * width];
    while values.len() < count {
        let chunk = &mut buffer[..(count - values.len()).min(CHUNK) * width];
        reader.read_exact(chunk).map_err(unreadable)?;
        for item in chunk.chunks_exact_mut(width) {
            if reversed {
                item.reverse();
            }
            values.push(decode(item));
        }
    }
    // A zip entry is checked against its checksum when its end is reached.
    if reader.read(&mut [0]).map_err(unreadable)? == 0 { Ok(values) } else { Err(DAMAGED.to_owned()) }
}

/// Takes the dtype, whether the order is Fortran's, and the shape from the dictionary in a `.npy` header.
/// The dtype of structured arrays, which are refused, comes as whatever text stands there.
fn parse_header(header: &str) -> Option<(&str, bool, Vec<usize>)> {
    let value = |key: &str| Some(header.split_once(key)?.1.trim_start().strip_prefix(':')?.trim_start());
    let descr = value("'descr'")?;
    let Some((dtype, _)) = descr.strip_prefix('\'').and_then(|d| d.split_once('\'')) else {
        let (dtype, _) = descr.split_once(", 'fortran_order'").unwrap_or((descr, ""));
        return Some((dtype, false, Vec::new()));
    };
    let order = value("'fortran_order'")?;
    let fortran = order.starts_with("True");
    if !fortran && !order.starts_with("False") {
        return None;
    }
    let (shape, _) = value("'shape'")?.strip_prefix('(')?.split_once(')')?;
    // Python 2 wrote `(3L, 4L)`.
    let lengths = shape.split(',').map(|n| n.trim().trim_end_matches('L')).filter(|n| !n.is_empty());
    Some((dtype, fortran, lengths.map(|n| n.parse().ok()).collect::<Option<_>>()?))
}

fn decoder(dtype: &str) -> Option<Decoder> {
    macro_rules! decoder {
        ($type:ty) => {{
            fn decode(bytes: &[u8]) -> f64 {
                let mut value = [0; size_of::<$type>()];
                value.copy_from_slice(bytes);
                <$type>::from_le_bytes(value) as f64
            }
            Some((size_of::<$type>(), decode))
        }};
    }
    match dtype.strip_prefix(['<', '>', '|'])? {
        "f4" => decoder!(f32),
        "f8" => decoder!(f64),
        "i1" => decoder!(i8),
        "i2" => decoder!(i16),
        "i4" => decoder!(i32),
        "i8" => decoder!(i64),
        "u1" => decoder!(u8),
        "u2" => decoder!(u16),
        "u4" => decoder!(u32),
        "u8" => decoder!(u64),
        _ => None,
    }
}

fn read_text(mut reader: impl BufRead) -> Parsed<Array2<f64>> {
    let (mut values, mut rows, mut columns) = (Vec::new(), 0, 0);
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        if reader.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
            break;
        }
        // Cut before decoding: instruments write their units in any encoding.
        let end = line.iter().position(|b| b"#%".contains(b)).unwrap_or(line.len());
        let text = String::from_utf8_lossy(&line[..end]);
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() {
            continue;
        }
        // One kind of separator per line: with "0,5; 0,7" or "0,5 0,7" the words are not numbers, whereas
        // splitting at all of them would turn decimal commas into twice as many columns.
        let words: Vec<_> = match [';', ','].into_iter().find(|&c| text.contains(c)) {
            Some(c) => text.strip_suffix(c).unwrap_or(text).split(c).map(str::trim).collect(),
            None => text.split_whitespace().collect(),
        };
        for word in &words {
            let value: f64 =
                word.parse().map_err(|_| format!("line {number}: {} is not a number: {NUMBERS}", quoted(word)))?;
            values.push(value);
        }
        if rows == 0 {
            columns = words.len();
        } else if words.len() != columns {
            return Err(format!(
                "line {number} has {} numbers, expected {columns} as in the first row: write nan for missing points",
                words.len()
            ));
        }
        rows += 1;
    }
    if rows == 0 {
        return Err(format!("holds no numbers: {NUMBERS}"));
    }
    Array2::from_shape_vec((rows, columns), values).map_err(|e| e.to_string())
}

/// A folder that receives the results of one run, all of them or none.
///
/// Files are written at [`path`](Self::path), in a hidden temporary folder on the file system of the
/// destination, and appear in the destination on [`commit`](Self::commit). Dropped without it, nothing stays
/// behind. A process that is killed leaves the temporary folder, `.asperity-` and a few letters.
#[derive(Debug)]
pub struct OutputFolder {
    destination: PathBuf,
    force: bool,
    /// In the destination, or in the nearest folder above it that exists.
    temporary: TempDir,
}

impl OutputFolder {
    /// Prepares a folder at `path`, existing or not, for files with these `names`, and creates nothing there
    /// yet. With `force` they may replace existing files; other files in the folder are left alone.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if one of the files exists and `force` is not given, if one of them is a folder, if
    /// `path` or something above it is a file, and if the folder cannot be written.
    pub fn create(path: &Path, names: &[&str], force: bool) -> Result<Self> {
        for name in names {
            refuse_existing(&path.join(name), force)?;
        }
        // Where the destination, or the first folder on the way to it, will be created.
        let existing = path.ancestors().find(|p| p.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
        if !existing.is_dir() {
            return Err(Error::file(existing, "is not a folder: choose another output folder"));
        }
        let unwritable = |e| Error::file(existing, format!("cannot be written ({e}): choose another output folder"));
        let temporary = tempfile::Builder::new().prefix(".asperity-").tempdir_in(existing).map_err(unwritable)?;
        let folder = Self { destination: path.to_owned(), force, temporary };
        // A temporary folder is private: the files go one level deeper, in a folder with the usual permissions.
        fs::create_dir(folder.files()).map_err(unwritable)?;
        Ok(folder)
    }

    /// Where to write the file called `name` until [`commit`](Self::commit).
    pub fn path(&self, name: &str) -> PathBuf {
        self.files().join(name)
    }

    /// Moves all files to the destination, which is created with its parents if needed.
    ///
    /// A destination that did not exist appears at once with all its files; in one that existed, each file
    /// appears or is replaced at once.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if the destination cannot be written, or if one of the files has been created there
    /// since [`create`](Self::create) and `force` was not given.
    pub fn commit(self) -> Result<()> {
        let destination = &self.destination;
        let unwritable = |e| Error::file(destination, format!("cannot be written: {e}"));
        if destination.symlink_metadata().is_err() {
            if let Some(parent) = destination.parent() {
                fs::create_dir_all(parent).map_err(unwritable)?;
            }
            return fs::rename(self.files(), destination).map_err(unwritable);
        }
        let entries: Vec<_> = fs::read_dir(self.files()).and_then(Iterator::collect).map_err(unwritable)?;
        // All checks come before the first change.
        for entry in &entries {
            refuse_existing(&destination.join(entry.file_name()), self.force)?;
        }
        for entry in &entries {
            fs::rename(entry.path(), destination.join(entry.file_name())).map_err(unwritable)?;
        }
        Ok(())
    }

    fn files(&self) -> PathBuf {
        self.temporary.path().join("files")
    }
}

fn refuse_existing(file: &Path, force: bool) -> Result<()> {
    match file.symlink_metadata() {
        Ok(found) if found.is_dir() => Err(Error::file(file, "is a folder: choose another output folder")),
        Ok(_) if !force => Err(Error::file(file, "exists: use --force to replace it, or choose another output folder")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{ShapeBuilder, array};
    use std::io::{Cursor, Write};
    use zip::write::SimpleFileOptions;
    use zip::{CompressionMethod, ZipWriter};

    fn npy(dtype: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        npy_from(&format!("{{'descr': {dtype}, 'fortran_order': {fortran}, 'shape': {shape}, }}"), data)
    }

    fn npy_from(header: &str, data: &[u8]) -> Vec<u8> {
        let header = format!("{header:117}\n");
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        [NPY, &[1, 0], &length, header.as_bytes(), data].concat()
    }

    fn npz(method: CompressionMethod, entries: &[(&str, &[u8])]) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in entries {
            zip.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
            zip.write_all(bytes).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    fn read(bytes: impl AsRef<[u8]>) -> Result<Array2<f64>> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("heights");
        fs::write(&path, bytes).unwrap();
        read_field(&path)
    }

    /// Why it was refused, after checking that the message names the file and is a single line.
    fn reason(result: Result<impl std::fmt::Debug>) -> String {
        let error = result.unwrap_err();
        assert_eq!(error.to_string().lines().count(), 1, "{error:?}");
        assert!(error.to_string().chars().all(|c| !c.is_control()), "{error:?}");
        match error {
            Error::File { reason, path } if !path.as_os_str().is_empty() => reason,
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    fn assert_refused(result: Result<impl std::fmt::Debug>, parts: &[&str]) {
        let reason = reason(result);
        for part in parts {
            assert!(reason.contains(part), "{part:?} not in {reason:?}");
        }
    }

    fn f8(values: &[f64]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_le_bytes()).collect()
    }

    #[test]
    fn npy_of_every_dtype() {
        macro_rules! check {
            ($type:ty, $code:expr, $values:expr) => {{
                let values: [$type; 6] = $values;
                let expected = Array2::from_shape_vec((2, 3), values.map(|v| v as f64).to_vec()).unwrap();
                let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
                let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
                let orders = if size_of::<$type>() == 1 { ["|", "|"] } else { ["<", ">"] };
                for (order, data) in orders.iter().zip([little, big]) {
                    let file = npy(&format!("'{order}{}'", $code), "False", "(2, 3)", &data);
                    assert_eq!(read(file).unwrap(), expected, "{order}{}", $code);
                }
            }};
        }
        check!(f32, "f4", [0.5, -1.25, 3e-30, 4e30, f32::INFINITY, 6.0]);
        check!(f64, "f8", [0.5, -1.25, 3e-300, 4e300, f64::NEG_INFINITY, 6.0]);
        check!(i8, "i1", [i8::MIN, -1, 0, 1, 2, i8::MAX]);
        check!(i16, "i2", [i16::MIN, -1, 0, 1, 2, i16::MAX]);
        check!(i32, "i4", [i32::MIN, -1, 0, 1, 2, i32::MAX]);
        check!(i64, "i8", [i64::MIN, -1, 0, 1, 2, i64::MAX]);
        check!(u8, "u1", [0, 1, 2, 3, 4, u8::MAX]);
        check!(u16, "u2", [0, 1, 2, 3, 4, u16::MAX]);
        check!(u32, "u4", [0, 1, 2, 3, 4, u32::MAX]);
        check!(u64, "u8", [0, 1, 2, 3, 4, u64::MAX]);
    }

    #[test]
    fn npy_orders_and_shapes() {
        let expected = array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        let fortran = read(npy("'<f8'", "True", "(2, 3)", &f8(&[1.0, 4.0, 2.0, 5.0, 3.0, 6.0]))).unwrap();
        assert_eq!(fortran, expected);
        assert!(fortran.is_standard_layout());
        for order in ["True", "False"] {
            for shape in ["(3,)", "(3, 1)", "(3L,)"] {
                let line = read(npy("'<f8'", order, shape, &f8(&[1.0, 2.0, 3.0]))).unwrap();
                assert_eq!(line, array![[1.0], [2.0], [3.0]]);
                assert!(line.is_standard_layout() && line.as_slice().is_some());
            }
            let row = read(npy("'<f8'", order, "(1, 3)", &f8(&[1.0, 2.0, 3.0]))).unwrap();
            assert_eq!(row, array![[1.0, 2.0, 3.0]]);
            assert!(row.is_standard_layout() && row.as_slice().is_some());
        }
        assert!(read(npy("'<f8'", "False", "(1, 1)", &f8(&[f64::NAN]))).unwrap()[[0, 0]].is_nan());
        let reordered = "{'shape': (1, 2), 'fortran_order': False, 'descr': '<f8'}";
        assert_eq!(read(npy_from(reordered, &f8(&[1.0, 2.0]))).unwrap(), array![[1.0, 2.0]]);
    }

    #[test]
    fn npy_longer_than_a_chunk() {
        let values: Vec<f64> = (0..3 * CHUNK + 17).map(|i| i as f64).collect();
        let shape = format!("({},)", values.len());
        let field = read(npy("'<f8'", "False", &shape, &f8(&values))).unwrap();
        assert_eq!(field.into_raw_vec_and_offset().0, values);
    }

    #[test]
    fn npy_versions() {
        for version in [2, 3] {
            let header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }\n";
            let length = (header.len() as u32).to_le_bytes();
            let file = [NPY, &[version, 0], &length, header, &f8(&[7.0])].concat();
            assert_eq!(read(file).unwrap(), array![[7.0]]);
        }
        let mut file = npy("'<f8'", "False", "(1,)", &f8(&[7.0]));
        file[6] = 9;
        assert_refused(read(file), &["version 9", "1 to 3"]);
    }

    #[test]
    fn npy_of_other_dimensions_is_refused() {
        let data = f8(&[0.0; 8]);
        assert_refused(read(npy("'<f8'", "False", "(2, 2, 2)", &data)), &["shape [2, 2, 2]", "two dimensions"]);
        assert_refused(read(npy("'<f8'", "False", "()", &data[..8])), &["shape []", "two dimensions"]);
        assert_refused(read(npy("'<f8'", "False", "(0, 5)", &[])), &["shape [0, 5]", "at least one value"]);
        assert_refused(read(npy("'<f8'", "False", "(0,)", &[])), &["shape [0]", "at least one value"]);
    }

    #[test]
    fn npy_of_other_dtypes_is_refused() {
        for dtype in ["<c8", "<c16", "|b1", "|O", "<f2", "<f16", "<U5", "|S5", "<M8[ns]", "|V8", "f8", "", "é"] {
            let file = npy(&format!("'{dtype}'"), "False", "(2,)", &[0; 16]);
            assert_refused(read(file), &[&format!("dtype \"{dtype}\""), "astype"]);
        }
        let fields = "[('shape', '<f8'), ('y', '<i4')]";
        assert_refused(read(npy(fields, "False", "(1,)", &[0; 12])), &[&format!("dtype \"{fields}\""), "astype"]);
    }

    #[test]
    fn npy_of_another_length_than_promised_is_refused() {
        let file = npy("'<f8'", "False", "(2, 2)", &f8(&[1.0, 2.0, 3.0, 4.0]));
        assert!(read(&file).is_ok());
        for length in 0..file.len() {
            assert!(read(&file[..length]).is_err(), "{length}");
        }
        assert_refused(read(&file[..file.len() - 1]), &["shape [2, 2]", "<f8", "31 bytes", "truncated"]);
        assert_refused(read([&file[..], &[0]].concat()), &["33 bytes", "damaged"]);
        // More than memory, more than usize, and more than usize only in bytes.
        for shape in ["(1000000, 1000000)", "(99999999999999999, 99999999999999999)", "(4611686018427387904, 1)"] {
            assert_refused(read(npy("'<f8'", "False", shape, &[0; 64])), &["64 bytes", "truncated"]);
        }
        // A header that claims 4 GB.
        assert_refused(read([NPY, &[2, 0, 255, 255, 255, 255, b'{']].concat()), &["truncated"]);
    }

    #[test]
    fn damaged_npy_header_is_refused() {
        for header in [
            "",
            "garbage",
            "{'descr'}",
            "{'descr': '<f8', 'fortran_order': False}",
            "{'descr': '<f8', 'fortran_order': 1, 'shape': (1,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1,",
            "{'descr': '<f8', 'fortran_order': False, 'shape': 1}",
        ] {
            assert_refused(read(npy_from(header, &[0; 8])), &["header", "numpy.save"]);
        }
        let nested = "(".repeat(60_000);
        assert_refused(read(npy_from(&nested, &[])), &["header"]);
        assert_refused(read(npy_from(&format!("{{'descr': {nested}"), &[])), &["dtype \"((", "...\""]);
        assert_refused(read(npy_from("{'descr': '\n\x1b[31m'", &[])), &["header"]);
        assert_refused(read(npy("'\n\x1b[31m'", "False", "(1,)", &[0; 8])), &["dtype \"\\n\\u{1b}[31m\""]);
    }

    #[test]
    fn npz_with_one_array() {
        let heights = npy("'>i2'", "False", "(1, 2)", &[1, 0, 255, 255]);
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            assert_eq!(read(npz(method, &[("heights.npy", &heights)])).unwrap(), array![[256.0, -1.0]]);
            // All zeros compress as well as anything does.
            let zeros = npy("'<f8'", "False", "(1000, 1000)", &[0; 8_000_000]);
            assert_eq!(read(npz(method, &[("heights.npy", &zeros)])).unwrap(), Array2::zeros((1000, 1000)));
        }
    }

    #[test]
    fn npz_with_another_content_is_refused() {
        let method = CompressionMethod::Stored;
        let heights = npy("'<f8'", "False", "(1,)", &f8(&[1.0]));
        let two = npz(method, &[("heights.npy", &heights), ("x.npy", &heights)]);
        assert_refused(read(two), &["2 arrays", "\"heights\"", "\"x\"", "save the heights alone"]);
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
    fn text_separators_comments_and_line_ends() {
        let expected = array![[1.0, -2.5, 3e-6], [4.0, 5.0, 6.0]];
        for text in [
            "1 -2.5 3e-6\n4 5 6\n",
            "1\t-2.5\t3E-6\r\n4\t5\t6\r\n",
            "  1   -2.5 3e-6  \n\n \t \n4 5 6",
            "1,-2.5,3e-6\n4,5,6\n",
            "1, -2.5, +3e-6,\n4 , 5 , 6,\n",
            "1;-2.5;3e-6\n4; 5; 6;\n",
            "# a, b; c\n% d\n1 -2.5 3e-6 # first\n  # between\n4 5 6% last\n#",
            "\u{feff}1 -2.5 3e-6\n4 5 6\n",
        ] {
            assert_eq!(read(text).unwrap(), expected, "{text:?}");
        }
        // A unit in Latin-1.
        assert_eq!(read(b"# heights in \xb5m\n1 2\n").unwrap(), array![[1.0, 2.0]]);
        assert_eq!(read("1\n2\n3").unwrap(), array![[1.0], [2.0], [3.0]]);
        assert_eq!(read("7").unwrap(), array![[7.0]]);
    }

    #[test]
    fn text_with_values_that_are_not_finite() {
        let field = read("nan NaN -inf\nInf 1 2\n").unwrap();
        assert!(field[[0, 0]].is_nan() && field[[0, 1]].is_nan());
        assert_eq!((field[[0, 2]], field[[1, 0]]), (f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn text_that_is_no_matrix_is_refused() {
        assert_refused(read("1 2 3\n# comment\n4 5\n"), &["line 3", "2 numbers", "expected 3"]);
        assert_refused(read("1\n2 3\n"), &["line 2", "2 numbers", "expected 1"]);
        assert_refused(read("1 2\n3 abc\n"), &["line 2", "\"abc\" is not a number", "rows of numbers"]);
        assert_refused(read("x y\n1 2\n"), &["line 1", "\"x\""]);
        assert_refused(read("1,,3\n"), &["line 1", "\"\" is not a number"]);
        assert_refused(read("1,5;2,5\n"), &["\"1,5\" is not a number", "decimal points"]);
        assert_refused(read("1,5 2,5\n"), &["\"5 2\" is not a number", "decimal points"]);
        assert_refused(read("1,2\r3,4\r"), &["\"2\\r3\" is not a number"]);
        assert_refused(read("(1+2j) 3\n"), &["\"(1+2j)\""]);
        for empty in ["", "\n\n", "# only a comment\n", "\r\n % \r\n"] {
            assert_refused(read(empty), &["holds no numbers", ".npy"]);
        }
        assert_refused(read(b"\x89PNG\r\n\x1a\n\0\0\0"), &["line 1", "not a number"]);
        assert_refused(read([0; 100_000]), &["line 1", "...\" is not a number"]);
        assert_refused(read(b"\xff\xfe1\0 \x002\0"), &["not a number"]);
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert_refused(read_field(folder.path()), &["is a folder"]);
        assert_refused(read_field(&folder.path().join("missing.npy")), &["does not exist", "check the path"]);
        if cfg!(unix) {
            assert_refused(read_field(Path::new("/dev/zero")), &["not a regular file"]);
        }
    }

    #[test]
    fn written_npy_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("field.npy");
        let field = array![[1.5, f64::INFINITY], [-0.0, 2.0], [3.0, 4.0]];
        write_npy(&path, &field).unwrap();
        assert_eq!(read_field(&path).unwrap(), field);
        write_npy(&path, &field.mapv(|v| v as f32)).unwrap();
        assert_eq!(read_field(&path).unwrap(), field);
        let fortran = Array2::from_shape_fn((2, 3).f(), |(i, j)| (3 * i + j) as i16);
        write_npy(&path, &fortran).unwrap();
        assert_eq!(read_field(&path).unwrap(), fortran.mapv(f64::from));
        assert_refused(write_npy(&folder.path().join("missing/field.npy"), &field), &["cannot be written"]);
    }

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn output_folder_appears_on_commit() {
        let parent = tempfile::tempdir().unwrap();
        let destination = parent.path().join("new/results");
        let output = OutputFolder::create(&destination, &["a.txt", "b.txt", "unused"], false).unwrap();
        fs::write(output.path("a.txt"), "a").unwrap();
        fs::write(output.path("b.txt"), "b").unwrap();
        assert!(!parent.path().join("new").exists());
        assert!(names_in(parent.path())[0].starts_with(".asperity-"));
        output.commit().unwrap();
        assert_eq!(names_in(parent.path()), ["new"]);
        assert_eq!(names_in(&destination), ["a.txt", "b.txt"]);
        assert_eq!(fs::read_to_string(destination.join("a.txt")).unwrap(), "a");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
            assert_eq!(mode(&destination), mode(destination.parent().unwrap()), "the usual permissions");
        }
    }

    #[test]
    fn output_folder_that_exists_keeps_its_other_files() {
        let parent = tempfile::tempdir().unwrap();
        fs::write(parent.path().join("other.txt"), "other").unwrap();
        let output = OutputFolder::create(parent.path(), &["a.txt"], false).unwrap();
        fs::write(output.path("a.txt"), "a").unwrap();
        output.commit().unwrap();
        assert_eq!(names_in(parent.path()), ["a.txt", "other.txt"]);
    }

    #[test]
    fn dropped_output_folder_leaves_nothing() {
        let parent = tempfile::tempdir().unwrap();
        for destination in [parent.path().to_owned(), parent.path().join("new/results")] {
            let output = OutputFolder::create(&destination, &["a.txt"], false).unwrap();
            fs::write(output.path("a.txt"), "a").unwrap();
            drop(output);
            assert!(names_in(parent.path()).is_empty());
        }
    }

    #[test]
    fn existing_results_are_replaced_only_with_force() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("a.txt");
        fs::write(&file, "old").unwrap();
        let refused = OutputFolder::create(parent.path(), &["b.txt", "a.txt"], false);
        assert!(matches!(&refused, Err(Error::File { path, .. }) if *path == file));
        assert_refused(refused, &["exists", "--force"]);
        assert_eq!(names_in(parent.path()), ["a.txt"]);

        let output = OutputFolder::create(parent.path(), &["a.txt"], true).unwrap();
        fs::write(output.path("a.txt"), "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
        output.commit().unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");

        fs::create_dir(parent.path().join("sub")).unwrap();
        assert_refused(OutputFolder::create(parent.path(), &["sub"], true), &["is a folder"]);
    }

    #[test]
    fn results_of_another_run_meanwhile_are_kept() {
        let parent = tempfile::tempdir().unwrap();
        let destination = parent.path().join("results");
        let output = OutputFolder::create(&destination, &["a.txt", "b.txt"], false).unwrap();
        fs::write(output.path("a.txt"), "ours").unwrap();
        fs::write(output.path("b.txt"), "ours").unwrap();
        fs::create_dir(&destination).unwrap();
        fs::write(destination.join("b.txt"), "theirs").unwrap();
        assert_refused(output.commit(), &["exists", "--force"]);
        assert_eq!(names_in(&destination), ["b.txt"]);
        assert_eq!(fs::read_to_string(destination.join("b.txt")).unwrap(), "theirs");
        assert_eq!(names_in(parent.path()), ["results"]);
    }

    #[test]
    fn output_folder_that_cannot_be_written_is_refused() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("file");
        fs::write(&file, "").unwrap();
        for path in [file.clone(), file.join("below/it")] {
            assert_refused(OutputFolder::create(&path, &["a.txt"], true), &["is not a folder", "choose another"]);
        }
        assert_eq!(names_in(parent.path()), ["file"]);
        if cfg!(target_os = "linux") {
            let path = Path::new("/proc/asperity/results");
            assert_refused(OutputFolder::create(path, &["a.txt"], false), &["cannot be written"]);
        }
    }
}
