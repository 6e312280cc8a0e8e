//! A file to which rows are appended as they come, and from which an interrupted sweep goes on.
//!
//! Beside the file stands its state, an archive with the gaps from which the next row starts, and with a comment that
//! says how far the file had got by then, and to what it belongs. A row is appended and brought to the disk before the
//! state is replaced, in one go: the state never runs ahead of the file, and what the file has beyond the state is at
//! most one row, whole or not, which is taken back and computed again. The file is locked as long as the journal is
//! open.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::io::read_field;
use ndarray::{Array2, ArrayView2, Axis};
use ndarray_npy::{WritableElement, WriteNpyExt};
use serde_json::{Map, Value, json};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::Outcome;
use crate::hash::Hash;

/// The identity of a run: the inputs on which its rows depend, by name. A run goes on only with equal ones.
pub type Identity = Map<String, Value>;

/// The rows of a sweep on disk, and how to go on with them.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    header: String,
    identity: Identity,
    file: File,
    written: Written,
    /// the numbers, beside the gaps, on which the next row depends
    numbers: Vec<f64>,
}

/// The content of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Written {
    rows: usize,
    /// the number of rows that did not converge
    unconverged: usize,
    /// the loads of the rows
    loads: Hash,
    bytes: u64,
    content: Hash,
}

impl Written {
    const NOTHING: Self = Self { rows: 0, unconverged: 0, loads: Hash::NEW, bytes: 0, content: Hash::NEW };
}

const REMEDY: &str = "choose another --out, or --force to start over";

impl Journal {
    /// Opens the file for the rows of `loads`, new or to go on with, and returns the gaps from which to go on, the
    /// latest last. With `force` it is new in any case.
    pub fn open(
        path: &Path,
        header: &str,
        identity: Identity,
        loads: &[f64],
        force: bool,
    ) -> Outcome<(Self, Vec<Array2<f64>>)> {
        Self::open_for(path, header, identity, Some(loads), force)
    }

    /// Opens a journal for a number of rows that is not known before.
    pub fn open_endless(
        path: &Path,
        header: &str,
        identity: Identity,
        force: bool,
    ) -> Outcome<(Self, Vec<Array2<f64>>)> {
        Self::open_for(path, header, identity, None, force)
    }

    fn open_for(
        path: &Path,
        header: &str,
        identity: Identity,
        loads: Option<&[f64]>,
        force: bool,
    ) -> Outcome<(Self, Vec<Array2<f64>>)> {
        let unwritable = |path: &Path, e: io::Error| Error::file(path, format!("cannot be written: {e}"));
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => {
                return Err(Error::file(path, "is not a regular file: choose another --out").into());
            }
            Ok(_) => {}
            Err(_) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                fs::create_dir_all(folder).map_err(|e| unwritable(folder, e))?;
            }
        }
        let (mut file, made) = open_locked(path)?;
        let mut begin = || -> Outcome<_> {
            let mut content = Vec::new();
            file.read_to_end(&mut content).map_err(|e| Error::file(path, format!("cannot be read: {e}")))?;
            // an empty file without a state is what a run leaves that is killed before its first one
            let new = content.is_empty() && (made || !state_path(path).exists());
            let (written, gaps, numbers) = if new || force {
                save(path, &identity, &Written::NOTHING, &[] as &[ArrayView2<'_, f64>], &[])?;
                (Written::NOTHING, Vec::new(), Vec::new())
            } else {
                resume(path, &content, header, &identity, loads)?
            };
            file.set_len(written.bytes).map_err(|e| unwritable(path, e))?;
            Ok((written, gaps, numbers))
        };
        let (written, gaps, numbers) = begin().inspect_err(|_| {
            if made {
                let _ = fs::remove_file(path);
            }
        })?;
        Ok((Self { path: path.to_owned(), header: header.to_owned(), identity, file, written, numbers }, gaps))
    }

    /// All rows there are, with their header.
    pub fn text(&self) -> asperity::Result<String> {
        let mut text = String::new();
        // by the same handle: on some platforms a lock keeps out others of the same process, too
        let read = (&self.file).rewind().and_then(|()| (&self.file).read_to_string(&mut text));
        read.map_err(|e| Error::file(&self.path, format!("cannot be read: {e}")))?;
        Ok(text)
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.written.rows
    }

    /// The number of rows that did not converge.
    pub fn unconverged(&self) -> usize {
        self.written.unconverged
    }

    /// Warns of the rows that have not converged, if there are any; `remedy` is what else may help.
    pub fn warn_of_unconverged(&self, remedy: &str) {
        if self.unconverged() > 0 {
            let (count, rows, path) = (self.unconverged(), self.rows(), self.path.display());
            let text = format!(
                "{count} of {rows} rows not converged, their status and errors are in {path}: raise --max-iterations, {remedy}"
            );
            crate::complain("warning", &text);
        }
    }

    /// The numbers that were saved with the last row.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// Appends a row, and saves the gaps and numbers from which the next one starts.
    pub fn append_endless<T: WritableElement + Clone>(
        &mut self,
        row: &str,
        converged: bool,
        gaps: &[ArrayView2<'_, T>],
        numbers: &[f64],
    ) -> Outcome<()> {
        self.numbers = numbers.to_vec();
        self.append(row, 0.0, converged, gaps)
    }

    /// Appends a row, and saves the gaps from which the next one starts, the latest last.
    pub fn append<T: WritableElement + Clone>(
        &mut self,
        row: &str,
        load: f64,
        converged: bool,
        gaps: &[ArrayView2<'_, T>],
    ) -> Outcome<()> {
        let text = if self.written.rows == 0 { format!("{}{row}\n", self.header) } else { format!("{row}\n") };
        let mut write = || {
            // by its name: it may be another file by now
            if fs::metadata(&self.path)?.len() != self.written.bytes {
                return Err(io::Error::other("it was changed by another program meanwhile"));
            }
            let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data());
            written.inspect_err(|_| {
                // no half row
                let _ = self.file.set_len(self.written.bytes);
            })
        };
        write().map_err(|e| Error::file(&self.path, format!("cannot be written: {e}")))?;
        self.written = Written {
            rows: self.written.rows + 1,
            unconverged: self.written.unconverged + usize::from(!converged),
            loads: self.written.loads.of(&load.to_bits().to_le_bytes()),
            bytes: self.written.bytes + text.len() as u64,
            content: self.written.content.of(text.as_bytes()),
        };
        save(&self.path, &self.identity, &self.written, gaps, &self.numbers)
    }
}

/// Opens a file, which is made if needed, and locks it until it is closed; whether it was made.
fn open_locked(path: &Path) -> asperity::Result<(File, bool)> {
    let mut options = OpenOptions::new();
    options.read(true).append(true);
    let (opened, made) = match options.clone().create_new(true).open(path) {
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => (options.create(true).open(path), false),
        opened => (opened, true),
    };
    let file = opened.map_err(|e| Error::file(path, format!("cannot be written: {e}")))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            Err(Error::file(path, "another run is writing there: wait until it has ended, or choose another --out"))
        }
        // not every file system has locks
        Ok(()) | Err(TryLockError::Error(_)) => Ok((file, made)),
    }
}

/// The path of the state of a file.
fn state_path(path: &Path) -> PathBuf {
    with_suffix(path, ".state.npz")
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(suffix);
    name.into()
}

/// What of a file is to be kept, and the gaps from which to go on.
fn resume(
    path: &Path,
    content: &[u8],
    header: &str,
    identity: &Identity,
    loads: Option<&[f64]>,
) -> Outcome<(Written, Vec<Array2<f64>>, Vec<f64>)> {
    let refuse = |reason: String| Err(Error::file(path, format!("{reason}: {REMEDY}")).into());
    let state = state_path(path);
    let comment = match File::open(&state) {
        Ok(file) => ZipArchive::new(file).map(|archive| archive.comment().to_vec()).unwrap_or_default(),
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return refuse(format!("exists, but its state to go on from, {}, does not", state.display()));
        }
        Err(e) => return refuse(format!("cannot be continued, {} cannot be read ({e})", state.display())),
    };
    let damaged = || refuse(format!("cannot be continued, {} is damaged", state.display()));
    let Some((theirs, written, count, numbers)) = parse(&comment) else { return damaged() };
    for (key, here) in identity {
        let there = theirs.get(key).unwrap_or(&Value::Null);
        if there != here {
            let name = key.replace('_', " ");
            return refuse(match key.as_str() {
                "heights" | "initial_gap" => format!("belongs to another run, with another file of its {name}"),
                _ => format!("belongs to another run, whose {name} is {}, and not {}", bare(there), bare(here)),
            });
        }
    }
    let same_loads = loads.is_none_or(|loads| {
        loads.get(..written.rows).is_some_and(|loads| Hash::NEW.of_numbers(loads) == written.loads)
    });
    if !same_loads {
        return refuse(format!("belongs to another run, whose first {} loads are others", written.rows));
    }
    let (kept, rest) = content.split_at((written.bytes as usize).min(content.len()));
    // an interrupted write leaves at most one row, whole or not, and before the first one the header, whole or not
    let rest = match rest.strip_prefix(header.as_bytes()) {
        _ if written.rows > 0 => Some(rest),
        Some(rest) => Some(rest),
        None if header.as_bytes().starts_with(rest) => Some(&[][..]),
        None => None,
    };
    let one_row = rest.is_some_and(|rest| rest.split_inclusive(|c| *c == b'\n').count() <= 1);
    if Hash::NEW.of(kept) != written.content || !one_row {
        return refuse("was changed since it was written".to_owned());
    }
    let mut gaps = Vec::new();
    if written.rows > 0 {
        let Ok(stack) = read_field(&state) else { return damaged() };
        let rows = stack.nrows().checked_div(count).unwrap_or_default().max(1);
        gaps.extend(stack.axis_chunks_iter(Axis(0), rows).map(|gap| gap.to_owned()));
        let shape = |gap: &Array2<f64>| Value::from(format!("{} {}", gap.nrows(), gap.ncols()));
        let fits = |gap: &Array2<f64>| theirs.get("shape") == Some(&shape(gap)) && gap.iter().all(|g| g.is_finite());
        if gaps.len() != count || !gaps.iter().all(fits) {
            return damaged();
        }
    }
    Ok((written, gaps, numbers))
}

/// A value without quotation marks.
fn bare(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Replaces the state, in one go.
fn save<T: WritableElement + Clone>(
    path: &Path,
    identity: &Identity,
    written: &Written,
    gaps: &[ArrayView2<'_, T>],
    numbers: &[f64],
) -> Outcome<()> {
    let (state, temporary) = (state_path(path), with_suffix(path, ".state.tmp"));
    let comment = json!({
        "rows": written.rows,
        "gaps": gaps.len(),
        "unconverged": written.unconverged,
        "loads": written.loads.to_string(),
        "bytes": written.bytes,
        "content": written.content.to_string(),
        "numbers": numbers.iter().map(|number| format!("{:016x}", number.to_bits())).collect::<Vec<_>>(),
        "sweep": identity,
    })
    .to_string();
    // in memory first: in a file that cannot take it, the writer of the archive would say so when it is dropped
    let archive = || -> Outcome<Vec<u8>> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        zip.set_comment(format!("{comment}\n{}", Hash::NEW.of(comment.as_bytes())));
        if !gaps.is_empty() {
            let stack = ndarray::concatenate(Axis(0), gaps)?;
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

/// To what a state belongs, how far it is, how many gaps it has, and its numbers.
fn parse(comment: &[u8]) -> Option<(Identity, Written, usize, Vec<f64>)> {
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
    let numbers = state.get("numbers")?.as_array()?.iter().map(|text| Some(f64::from_bits(bits(text)?)));
    let numbers = numbers.collect::<Option<_>>()?;
    Some((state.get("sweep")?.as_object()?.clone(), written, number("gaps")?.try_into().ok()?, numbers))
}

#[cfg(test)]
mod tests {
    use ndarray::array;

    use super::*;

    const HEADER: &str = "load,answer\n";
    const LOADS: [f64; 3] = [1.0, 2.0, 3.0];

    fn identity(modulus: &str) -> Identity {
        let Value::Object(identity) = json!({ "shape": "2 1", "modulus": modulus, "heights": "0123" }) else {
            panic!()
        };
        identity
    }

    fn open(path: &Path, loads: &[f64]) -> Outcome<(Journal, Vec<Array2<f64>>)> {
        Journal::open(path, HEADER, identity("1"), loads, false)
    }

    /// A sweep whose answer depends on the two gaps before, killed after so many rows.
    fn sweep(path: &Path, loads: &[f64], killed: usize) -> Outcome<String> {
        let (mut journal, mut gaps) = open(path, loads)?;
        for &load in &loads[journal.rows()..killed] {
            let sum = gaps.iter().fold(0.0, |sum, gap| sum + gap[[0, 0]] + 2.0 * gap[[1, 0]]);
            gaps.push(array![[load], [sum]]);
            gaps.drain(..gaps.len().saturating_sub(2));
            let views: Vec<_> = gaps.iter().map(|gap| gap.view()).collect();
            journal.append(&format!("{load},{sum}"), load, load != 2.0, &views)?;
        }
        assert_eq!(journal.unconverged(), usize::from(journal.rows() > 1));
        Ok(fs::read_to_string(path)?)
    }

    fn reason(result: Outcome<impl std::fmt::Debug>) -> String {
        result.unwrap_err().to_string()
    }

    #[test]
    fn a_sweep_killed_anywhere_ends_as_one_that_was_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/sweep.csv");
        let whole = sweep(&path, &LOADS, 3).unwrap();
        assert_eq!(whole, "load,answer\n1,0\n2,1\n3,5\n");
        assert_eq!(sweep(&path, &LOADS, 3).unwrap(), whole);
        let rows: Vec<usize> = (0..whole.len()).filter(|&i| whole.as_bytes()[i] == b'\n').map(|i| i + 1).collect();
        for killed in 0..=3 {
            // all that an interrupted write of the next row may leave
            let (from, to) = match killed {
                0 => (0, rows[1]),
                3 => (whole.len(), whole.len()),
                k => (rows[k], rows[k + 1]),
            };
            for length in from..=to {
                let path = folder.path().join(format!("{killed}-{length}.csv"));
                sweep(&path, &LOADS, killed).unwrap();
                fs::write(&path, &whole[..length]).unwrap();
                fs::write(with_suffix(&path, ".state.tmp"), "half of it").unwrap();
                assert_eq!(sweep(&path, &LOADS, 3).unwrap(), whole, "{killed} {length}");
            }
        }
    }

    #[test]
    fn a_sweep_can_be_made_longer_but_not_another() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.csv");
        sweep(&path, &LOADS[..2], 2).unwrap();
        let whole = sweep(&path, &LOADS, 3).unwrap();
        assert!(reason(sweep(&path, &LOADS[..2], 2)).contains("loads are others"));
        assert!(reason(sweep(&path, &[1.0, 2.5, 3.0], 3)).contains("loads are others"));
        let other = |modulus, force| Journal::open(&path, HEADER, identity(modulus), &LOADS, force);
        let refused = reason(other("2", false));
        assert!(["modulus is 1, and not 2", "--force"].iter().all(|part| refused.contains(part)), "{refused}");
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        assert_eq!(other("2", true).unwrap().0.rows(), 0);
        assert_eq!(fs::read_to_string(&path).unwrap(), "");
        assert!(reason(open(&path, &LOADS)).contains("modulus is 2, and not 1"));
    }

    #[test]
    fn files_that_were_changed_are_refused_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.csv");
        let whole = sweep(&path, &LOADS, 3).unwrap();
        let partly = folder.path().join("partly.csv");
        sweep(&partly, &LOADS, 0).unwrap();
        for (path, content) in [
            (&path, whole.replace("2,1", "2,7")),
            (&path, whole.replace("2,1\n", "")),
            (&path, String::new()),
            (&path, format!("{whole}4,5\n5,6\n")),
            (&path, format!("{whole}4,5\n5")),
            (&partly, "a note\n".to_owned()),
            (&partly, "a note\n".to_owned() + &whole),
            (&partly, whole.clone()),
        ] {
            fs::write(path, &content).unwrap();
            assert!(reason(open(path, &LOADS)).contains("was changed"), "{content}");
            assert_eq!(fs::read_to_string(path).unwrap(), content);
        }
        fs::write(&path, &whole).unwrap();
        let state = fs::read(state_path(&path)).unwrap();
        for length in 0..state.len() {
            fs::write(state_path(&path), &state[..length]).unwrap();
            assert!(reason(open(&path, &LOADS)).contains("is damaged"));
        }
        for at in (0..state.len()).step_by(5) {
            let mut state = state.clone();
            state[at] ^= 0x15;
            fs::write(state_path(&path), state).unwrap();
            // not every byte of an archive matters
            if let Ok((journal, gaps)) = open(&path, &LOADS) {
                assert_eq!((journal.rows(), journal.unconverged(), &gaps[1]), (3, 1, &array![[3.0], [5.0]]));
            }
            assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        }
        fs::remove_file(state_path(&path)).unwrap();
        let refused = reason(open(&path, &LOADS));
        assert!(["sweep.csv.state.npz", "does not", "--force"].iter().all(|part| refused.contains(part)), "{refused}");
        assert_eq!(fs::read_to_string(&path).unwrap(), whole);
        assert!(reason(open(folder.path(), &LOADS)).contains("not a regular file"));
    }

    #[test]
    fn two_sweeps_do_not_write_into_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.csv");
        let (mut first, _) = open(&path, &LOADS).unwrap();
        for force in [false, true] {
            let second = Journal::open(&path, HEADER, identity("1"), &LOADS, force);
            assert!(reason(second).contains("sweep.csv: another run is writing there"));
        }
        let gap = array![[1.0], [2.0]];
        first.append("1,0", 1.0, true, &[gap.view()]).unwrap();
        assert_eq!(first.text().unwrap(), "load,answer\n1,0\n");
        // what knows nothing of the lock
        for changed in ["load,answer\n", ""] {
            fs::write(&path, changed).unwrap();
            assert!(reason(first.append("2,1", 2.0, true, &[gap.view()])).contains("another program"));
            assert_eq!(fs::read_to_string(&path).unwrap(), changed);
        }
        fs::remove_file(&path).unwrap();
        assert!(reason(first.append("2,1", 2.0, true, &[gap.view()])).contains("cannot be written"));
        drop(first);
        assert_eq!(open(&path, &LOADS).unwrap().0.rows(), 0);
    }
}
