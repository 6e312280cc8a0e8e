//! The journal of a table: rows are appended to its file as they come, and an interrupted run continues from there.
//!
//! Next to the file stands its state: the place from which the next row follows, the identity of the run, and the
//! length and hash of the file. A row is written to the disk before the state is replaced, in one go. So
//! the state is never ahead of the file, and the file is ahead of the state by at most one row, whole or not; this row
//! is cut off and computed again. The file is locked as long as the journal is open.
//!
//! A case of a study saves its state, and waits for the disk, only if a second has passed since it did so last. The
//! rows behind its state are cut off and computed again; the study has a checksum of a case that is done.

mod lock;
mod state;

use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use asperity::Error;
use serde_json::Value;

use self::lock::open_locked;
pub(crate) use self::state::{State, damaged};
pub use self::state::{Written, state_path};
use crate::hash::Hash;
use crate::outcome::Outcome;
use crate::table::identity::{FIELDS, Identity};

/// The rows of a table on disk, and how to continue them.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    header: String,
    identity: Identity,
    file: File,
    written: Written,
    is_case: bool,
    saved: Instant,
}

/// The work, in time, that an interrupted case of a study may lose.
const A_WHILE: Duration = Duration::from_secs(1);

/// A row to append.
pub struct Row<'a> {
    /// The line.
    pub text: &'a str,
    /// The load, as it stands in the list of the loads.
    pub load: f64,
    /// Whether the row converged.
    pub converged: bool,
    /// The place from which the next row follows, where the state is to be saved.
    pub place: Option<Vec<u8>>,
}

const REMEDY: &str = "choose another --out, or --force to start over";

impl Journal {
    /// Opens the file of a table, new or to continue; with `force` it is new in any case. The rows belong to `loads`,
    /// where these are known before. While another run writes there, the file is refused, but for a case of a study,
    /// which waits.
    pub fn open(
        path: &Path,
        header: &str,
        identity: Identity,
        loads: Option<&[f64]>,
        (force, is_case): (bool, bool),
    ) -> Outcome<(Self, Vec<u8>)> {
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => {
                return Err(Error::file(path, "is not a regular file: choose another --out").into());
            }
            Ok(_) => {}
            Err(_) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                fs::create_dir_all(folder).map_err(|e| Error::unwritable(folder, e))?;
            }
        }
        let (mut file, made) = open_locked(path, is_case)?;
        let mut begin = || -> Outcome<_> {
            let mut content = Vec::new();
            file.read_to_end(&mut content).map_err(|e| Error::unreadable(path, e))?;
            // a run that is killed before it writes its first state leaves an empty file
            let new = content.is_empty() && (made || !state_path(path).exists());
            let state = if new || force {
                let state = State { identity: identity.clone(), written: Written::NOTHING, place: Vec::new() };
                if !is_case {
                    state.save(path)?;
                }
                state
            } else {
                resume(path, &content, header, &identity, loads, is_case)?
            };
            // some file systems write what was cut to disk when it is closed
            if state.written.bytes != content.len() as u64 {
                file.set_len(state.written.bytes).map_err(|e| Error::unwritable(path, e))?;
            }
            Ok(state)
        };
        let State { written, place, .. } = begin().inspect_err(|_| {
            if made {
                let _ = fs::remove_file(path);
            }
        })?;
        let (path, header, now) = (path.to_owned(), header.to_owned(), Instant::now());
        Ok((Self { path, header, identity, file, written, is_case, saved: now }, place))
    }

    /// All rows there are, with their header.
    pub fn text(&self) -> asperity::Result<String> {
        let mut text = String::new();
        // by the same handle: on some platforms a lock keeps out others of the same process, too
        let read = (&self.file).rewind().and_then(|()| (&self.file).read_to_string(&mut text));
        read.map_err(|e| Error::unreadable(&self.path, e))?;
        match Hash::NEW.extend(text.as_bytes()) == self.written.content {
            true => Ok(text),
            false => Err(Error::unreadable(&self.path, changed())),
        }
    }

    /// What of the table is written.
    pub fn written(&self) -> Written {
        self.written
    }

    /// Whether the next row has its state saved: for a case of a study, once it has run for a while.
    pub fn saves(&self) -> bool {
        !self.is_case || self.saved.elapsed() >= A_WHILE
    }

    /// Appends a row, and saves the state if the row has its place.
    pub fn append(&mut self, row: Row<'_>) -> Outcome<()> {
        let Row { text, load, converged, place } = row;
        let header = if self.written.rows == 0 { self.header.as_str() } else { "" };
        let text = format!("{header}{text}\n");
        let mut write = || {
            // by its name: it may be another file by now
            if fs::metadata(&self.path)?.len() != self.written.bytes {
                return Err(changed());
            }
            let written = self.file.write_all(text.as_bytes());
            let written = written.and_then(|()| if place.is_some() { self.file.sync_data() } else { Ok(()) });
            written.inspect_err(|_| {
                // no half row
                let _ = self.file.set_len(self.written.bytes);
            })
        };
        write().map_err(|e| Error::unwritable(&self.path, e))?;
        self.written = Written {
            rows: self.written.rows + 1,
            unconverged: self.written.unconverged + usize::from(!converged),
            loads: self.written.loads.of_numbers([&load]),
            bytes: self.written.bytes + text.len() as u64,
            content: self.written.content.extend(text.as_bytes()),
        };
        if let Some(place) = place {
            State { identity: self.identity.clone(), written: self.written, place }.save(&self.path)?;
            self.saved = Instant::now();
        }
        Ok(())
    }
}

/// Whether a case of a study could continue a table: all rows of the state are as they were written, and so is the
/// state.
pub fn is_whole(path: &Path) -> bool {
    let (Ok(state), Ok(content)) = (State::read(path), fs::read(path)) else { return false };
    let kept = content.get(..state.written.bytes as usize);
    kept.is_some_and(|kept| Hash::NEW.extend(kept) == state.written.content)
}

/// The state from which the run continues, with the part of the file that is kept.
fn resume(
    path: &Path,
    content: &[u8],
    header: &str,
    identity: &Identity,
    loads: Option<&[f64]>,
    is_case: bool,
) -> Outcome<State> {
    let refused = |reason| refused(path, reason);
    let refuse = |reason| Err(refused(reason).into());
    let state = State::read(path).map_err(refused)?;
    let written = state.written;
    for key in identity.keys().chain(state.identity.keys()) {
        let [here, there] = [identity, &state.identity].map(|inputs| inputs.get(key).unwrap_or(&Value::Null));
        if there != here {
            let name = key.replace('_', " ");
            return refuse(match key.as_str() {
                file if FIELDS.contains(&file) => {
                    format!("belongs to another run, with another file of its {name}")
                }
                "surfaces" => "belongs to another run, with another of its two surfaces, or another shift".to_owned(),
                _ => format!("belongs to another run: its {name} is {}, and not {}", bare(there), bare(here)),
            });
        }
    }
    let same_loads = loads.is_none_or(|loads| {
        loads.get(..written.rows).is_some_and(|loads| Hash::NEW.of_numbers(loads) == written.loads)
    });
    if !same_loads {
        return refuse(format!("belongs to another run: its first {} loads are others", written.rows));
    }
    let (kept, rest) = content.split_at((written.bytes as usize).min(content.len()));
    // an interrupted write leaves at most one row, whole or not, and before the first one the header, whole or not; but
    // a case does not save the state of each row
    let rest = match rest.strip_prefix(header.as_bytes()) {
        _ if written.rows > 0 => Some(rest),
        Some(rest) => Some(rest),
        None if header.as_bytes().starts_with(rest) => Some(&[][..]),
        None => None,
    };
    let one_row = rest.is_some_and(|rest| rest.split_inclusive(|c| *c == b'\n').count() <= 1);
    if Hash::NEW.extend(kept) != written.content || !(one_row || is_case) {
        return refuse("was changed since it was written".to_owned());
    }
    Ok(state)
}

/// The error of a table that something else has written to.
fn changed() -> io::Error {
    io::Error::other("it was changed by another program meanwhile")
}

/// The error of a table that a run cannot continue.
pub fn refused(path: &Path, reason: String) -> Error {
    Error::file(path, format!("{reason}: {REMEDY}"))
}

/// A value without quotation marks.
fn bare(value: &Value) -> String {
    match value {
        Value::Null => "none".to_owned(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}
