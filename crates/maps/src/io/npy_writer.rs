//! Writing fields and texts as NumPy arrays (`.npy`).

use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use asperity::{Error, Real, Result};
use ndarray::{ArrayView2, AsArray, Ix2};

use super::npy::NPY;

/// Writes a field as `.npy`, over a file that may be there.
///
/// # Errors
///
/// [`Error::File`] if the file cannot be written.
///
/// ```
/// use asperity_maps::io::{read_field, write_npy};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("gap.npy");
/// let gap = ndarray::array![[0.0_f32, 1.5]];
/// write_npy(&path, &gap)?;
/// assert_eq!(read_field(&path)?, gap.mapv(f64::from));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_npy<'a, T: Real>(path: impl AsRef<Path>, field: impl AsArray<'a, T, Ix2>) -> Result<()> {
    let path = path.as_ref();
    File::create(path).and_then(|mut file| write_field(&mut file, field.into())).map_err(|e| Error::unwritable(path, e))
}

/// Creates a `.npy` of zeros of a shape, over a file that may be there, for [`write_npy_rows`].
///
/// # Errors
///
/// [`Error::File`] if the file cannot be written.
pub fn create_npy<T: Real>(path: impl AsRef<Path>, shape: (usize, usize)) -> Result<()> {
    let path = path.as_ref();
    let header = header(dtype::<T>(), false, &[shape.0, shape.1]);
    let size = header.len() + shape.0 * shape.1 * size_of::<T>();
    File::create(path)
        .and_then(|mut file| file.write_all(&header).and_then(|()| file.set_len(size as u64)))
        .map_err(|e| Error::unwritable(path, e))
}

/// Writes some rows of a field into a `.npy` that [`create_npy`] has made, from the row `first` on. Several processes
/// may write rows into one file.
///
/// ```
/// use asperity_maps::io::{create_npy, read_field, write_npy_rows};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("gap.npy");
/// create_npy::<f64>(&path, (3, 2))?;
/// write_npy_rows(&path, (3, 2), 1, &ndarray::array![[1.0, 2.0], [3.0, 4.0]])?;
/// assert_eq!(read_field(&path)?, ndarray::array![[0.0, 0.0], [1.0, 2.0], [3.0, 4.0]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`Error::File`] if the file cannot be written, [`Error::Shape`] if the rows are not rows of that shape.
pub fn write_npy_rows<'a, T: Real>(
    path: impl AsRef<Path>,
    shape: (usize, usize),
    first: usize,
    rows: impl AsArray<'a, T, Ix2>,
) -> Result<()> {
    let path = path.as_ref();
    let rows = rows.into();
    let (count, ny) = rows.dim();
    Error::shape("rows to write", (first + count, ny), ((first + count).min(shape.0), shape.1))?;
    let write = || {
        let mut file = OpenOptions::new().write(true).open(path)?;
        // the numbers are all that follows the header
        let numbers = ((shape.0 - first) * ny * size_of::<T>()) as u64;
        file.seek(SeekFrom::Start(file.metadata()?.len().saturating_sub(numbers)))?;
        write_numbers(&mut file, rows)
    };
    write().map_err(|e| Error::unwritable(path, e))
}

/// Writes a whole field, header and numbers, in its own order of rows and columns if that is one of numpy's.
pub(super) fn write_field<T: Real>(writer: &mut impl Write, field: ArrayView2<'_, T>) -> io::Result<()> {
    let (rows, columns) = field.dim();
    let fortran = !field.is_standard_layout() && field.t().is_standard_layout();
    writer.write_all(&header(dtype::<T>(), fortran, &[rows, columns]))?;
    write_numbers(writer, if fortran { field.reversed_axes() } else { field })
}

/// Writes numbers in the precision of `T`, row after row.
pub(super) fn write_numbers<T: Real>(writer: &mut impl Write, numbers: ArrayView2<'_, T>) -> io::Result<()> {
    if T::NAME == "f32" {
        write_blocks(writer, numbers, |number| (number.widen() as f32).to_le_bytes())
    } else {
        write_blocks(writer, numbers, |number| number.widen().to_le_bytes())
    }
}

fn write_blocks<T: Real, const N: usize>(
    writer: &mut impl Write,
    numbers: ArrayView2<'_, T>,
    bytes: impl Fn(T) -> [u8; N],
) -> io::Result<()> {
    let mut block = vec![[0; N]; numbers.len().min(1 << 13)];
    let mut numbers = numbers.iter();
    while numbers.len() > 0 {
        let count = block.len().min(numbers.len());
        block.iter_mut().zip(numbers.by_ref()).for_each(|(slot, number)| *slot = bytes(*number));
        writer.write_all(block[..count].as_flattened())?;
    }
    Ok(())
}

/// A text without dimensions.
pub(super) fn text_as_npy(text: &str) -> Vec<u8> {
    let characters = text.chars().flat_map(|c| u32::from(c).to_le_bytes());
    header(&format!("<U{}", text.chars().count()), false, &[]).into_iter().chain(characters).collect()
}

/// The header of an array, of version 1.
pub(super) fn header(dtype: &str, fortran: bool, shape: &[usize]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let shape = match shape {
        [length] => format!("({length},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    };
    let dictionary = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}");
    // the data start at a multiple of 64 bytes
    let header = format!("{dictionary:width$}\n", width = (dictionary.len() + 11).next_multiple_of(64) - 11);
    [NPY, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat()
}

fn dtype<T: Real>() -> &'static str {
    if T::NAME == "f32" { "<f4" } else { "<f8" }
}
