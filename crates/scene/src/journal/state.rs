//! The state of a journal, from which an interrupted run goes on: an archive beside the table.
//!
//! The archive holds the fields from which the next row starts, one below the other, and a comment with all else.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_maps::io::read_field;
use ndarray::{Array2, ArrayView2, Axis};
use ndarray_npy::{WritableElement, WriteNpyExt};
use serde_json::{Map, Value, json};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::hash::Hash;
use crate::identity::Identity;
use crate::outcome::Outcome;
use crate::output::with_suffix;

/// Values by their names.
pub type Values = BTreeMap<String, Vec<f64>>;

/// The content of the table that belongs to a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Written {
    pub rows: usize,
    /// the number of rows that did not converge
    pub unconverged: usize,
    /// the loads of the rows
    pub loads: Hash,
    pub bytes: u64,
    pub content: Hash,
}

impl Written {
    pub const NOTHING: Self = Self { rows: 0, unconverged: 0, loads: Hash::NEW, bytes: 0, content: Hash::NEW };
}

/// The state of a table as its comment says it.
pub struct State {
    path: PathBuf,
    pub identity: Identity,
    pub written: Written,
    /// The values, beside the fields, on which the next row depends
    pub values: Values,
    /// The number of fields
    fields: usize,
    /// The shape of each of them
    shape: (usize, usize),
}

impl State {
    /// Reads the state of a table, or says why there is none to go on from.
    pub fn read(table: &Path) -> Result<Self, String> {
        let path = state_path(table);
        let comment = match File::open(&path) {
            Ok(file) => ZipArchive::new(file).map(|archive| archive.comment().to_vec()).unwrap_or_default(),
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                return Err(format!("exists, but its state to go on from, {}, does not", path.display()));
            }
            Err(e) => return Err(format!("cannot be continued, {} cannot be read ({e})", path.display())),
        };
        Self::parse(&path, &comment).ok_or_else(|| damaged(&path))
    }

    /// Reads the fields from which the next row starts, the latest last.
    pub fn read_fields(&self) -> Result<Vec<Array2<f64>>, String> {
        if self.written.rows == 0 {
            return Ok(Vec::new());
        }
        let stack = read_field(&self.path).map_err(|_| damaged(&self.path))?;
        let rows = stack.nrows().checked_div(self.fields).unwrap_or_default().max(1);
        let fields: Vec<_> = stack.axis_chunks_iter(Axis(0), rows).map(|field| field.to_owned()).collect();
        let fits = |field: &Array2<f64>| field.dim() == self.shape && field.iter().all(|value| !value.is_nan());
        if fields.len() != self.fields || !fields.iter().all(fits) {
            return Err(damaged(&self.path));
        }
        Ok(fields)
    }

    fn parse(path: &Path, comment: &[u8]) -> Option<Self> {
        let (comment, check) = std::str::from_utf8(comment).ok()?.rsplit_once('\n')?;
        if check != Hash::NEW.of(comment.as_bytes()).to_string() {
            return None;
        }
        let state: Value = serde_json::from_str(comment).ok()?;
        let number = |key: &str| state.get(key)?.as_u64();
        let hash = |key: &str| Some(Hash(u64::from_str_radix(state.get(key)?.as_str()?, 16).ok()?));
        let written = Written {
            rows: number("rows")?.try_into().ok()?,
            unconverged: number("unconverged")?.try_into().ok()?,
            loads: hash("loads")?,
            bytes: number("bytes")?,
            content: hash("content")?,
        };
        let bits = |text: &Value| u64::from_str_radix(text.as_str()?, 16).ok();
        let number_of = |text: &Value| Some(f64::from_bits(bits(text)?));
        let values = state.get("values")?.as_object()?.iter().map(|(name, values)| {
            Some((name.clone(), values.as_array()?.iter().map(number_of).collect::<Option<_>>()?))
        });
        Some(Self {
            path: path.to_owned(),
            identity: state.get("sweep")?.as_object()?.clone(),
            written,
            values: values.collect::<Option<_>>()?,
            fields: number("gaps")?.try_into().ok()?,
            shape: (number("rows_of_gap")?.try_into().ok()?, number("columns_of_gap")?.try_into().ok()?),
        })
    }
}

fn damaged(path: &Path) -> String {
    format!("cannot be continued, {} is damaged", path.display())
}

/// The path of the state of a table.
pub fn state_path(table: &Path) -> PathBuf {
    with_suffix(table, ".state.npz")
}

/// Replaces the state, in one go.
pub fn save<T: WritableElement + Clone>(
    table: &Path,
    identity: &Identity,
    written: &Written,
    fields: &[ArrayView2<'_, T>],
    values: &Values,
) -> Outcome<()> {
    let bits = |values: &Vec<f64>| values.iter().map(|number| format!("{:016x}", number.to_bits())).collect::<Value>();
    let (state, temporary) = (state_path(table), with_suffix(table, ".state.tmp"));
    let comment = json!({
        "rows": written.rows,
        "gaps": fields.len(),
        "rows_of_gap": fields.first().map_or(0, |field| field.nrows()),
        "columns_of_gap": fields.first().map_or(0, |field| field.ncols()),
        "unconverged": written.unconverged,
        "loads": written.loads.to_string(),
        "bytes": written.bytes,
        "content": written.content.to_string(),
        "values": values.iter().map(|(name, values)| (name.clone(), bits(values))).collect::<Map<_, _>>(),
        "sweep": identity,
    })
    .to_string();
    // in memory first: in a file that cannot take it, the writer of the archive would say so when it is dropped
    let archive = || -> Outcome<Vec<u8>> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        zip.set_comment(format!("{comment}\n{}", Hash::NEW.of(comment.as_bytes())));
        if !fields.is_empty() {
            let stack = ndarray::concatenate(Axis(0), fields)?;
            let large = stack.len() as u64 * size_of::<T>() as u64 > u64::from(u32::MAX) / 2;
            let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(large);
            zip.start_file("gap.npy", options)?;
            stack.write_npy(&mut zip)?;
        }
        Ok(zip.finish()?.into_inner())
    };
    let write = |archive: Vec<u8>| -> Outcome<()> {
        let mut file = File::create(&temporary)?;
        file.write_all(&archive)?;
        file.sync_all()?;
        fs::rename(&temporary, &state)?;
        // or the next row might reach the disk before the name does
        let folder = state.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        if cfg!(unix) {
            File::open(folder)?.sync_all()?;
        }
        Ok(())
    };
    archive().and_then(write).map_err(|e| {
        let _ = fs::remove_file(&temporary);
        Error::file(&state, format!("cannot be written: {e}")).into()
    })
}
