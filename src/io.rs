//! Reading height maps and gaps, and writing results.
//!
//! [`read_field`] takes what measuring instruments and numpy write: `.npy`, `.npz` and text matrices.
//! [`OutputFolder`] collects the files of one run and shows them only once all of them are complete.

mod npy;
mod output;
mod text;

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use ndarray::Array2;
use ndarray_npy::WritableElement;

use crate::error::{Error, Result};
use npy::{NPY, ZIP, read_npy, read_npz};
pub use output::OutputFolder;
use text::read_text;

const TRUNCATED: &str = "ends too early: it is truncated or damaged, copy or save it again";
const DAMAGED: &str = "is damaged: copy or save it again";

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
///
/// ```
/// use asperity::io::{read_field, write_npy};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("gap.npy");
/// let gap = ndarray::array![[0.0_f32, 1.5]];
/// write_npy(&path, &gap)?;
/// assert_eq!(read_field(&path)?, gap.mapv(f64::from));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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

#[cfg(test)]
mod tests {
    use ndarray::{ShapeBuilder, array};

    use super::*;

    pub(super) fn read(bytes: impl AsRef<[u8]>) -> Result<Array2<f64>> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("heights");
        fs::write(&path, bytes).unwrap();
        read_field(&path)
    }

    /// Why it was refused, after checking that the message names the file and is a single line.
    pub(super) fn reason(result: Result<impl std::fmt::Debug>) -> String {
        let error = result.unwrap_err();
        assert_eq!(error.to_string().lines().count(), 1, "{error:?}");
        assert!(error.to_string().chars().all(|c| !c.is_control()), "{error:?}");
        match error {
            Error::File { reason, path } if !path.as_os_str().is_empty() => reason,
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    pub(super) fn assert_refused(result: Result<impl std::fmt::Debug>, parts: &[&str]) {
        let reason = reason(result);
        for part in parts {
            assert!(reason.contains(part), "{part:?} not in {reason:?}");
        }
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
}
