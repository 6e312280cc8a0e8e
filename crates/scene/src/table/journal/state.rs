//! The state of a journal, from which an interrupted run continues: a file next to the table.
//!
//! Its first line is a hash of the rest, the second one as JSON the identity of the run and what it has written, and the
//! place from which the next row follows comes behind them as bytes.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use asperity::Error;
use serde::{Deserialize, Serialize};

use crate::hash::Hash;
use crate::outcome::Outcome;
use crate::table::identity::Identity;
use crate::table::output::with_suffix;

/// The content of the table that belongs to a state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Written {
    /// The number of rows.
    pub rows: usize,
    /// The number of rows that did not converge.
    pub unconverged: usize,
    /// The loads of the rows.
    pub loads: Hash,
    /// The length.
    pub bytes: u64,
    /// The content.
    pub content: Hash,
}

impl Written {
    /// The state of a table without rows.
    pub const NOTHING: Self = Self { rows: 0, unconverged: 0, loads: Hash::NEW, bytes: 0, content: Hash::NEW };
}

/// The state of a table.
#[derive(Serialize, Deserialize)]
pub struct State {
    pub identity: Identity,
    pub written: Written,
    /// the place from which the next row follows
    #[serde(skip)]
    pub place: Vec<u8>,
}

impl State {
    /// Reads the state of a table, or says why there is none to continue from.
    pub fn read(table: &Path) -> Result<Self, String> {
        let path = state_path(table);
        match fs::read(&path) {
            Ok(bytes) => Self::parse(&bytes).ok_or_else(|| damaged(table)),
            Err(e) if e.kind() == io::ErrorKind::NotFound && with_suffix(table, ".state.npz").exists() => {
                Err("was begun by an earlier version of asperity, which alone continues it".to_owned())
            }
            Err(e) if e.kind() == io::ErrorKind::NotFound => {
                Err(format!("exists, but its state to continue from, {}, does not", path.display()))
            }
            Err(e) => Err(format!("cannot be continued, {} cannot be read ({e})", path.display())),
        }
    }

    fn parse(bytes: &[u8]) -> Option<Self> {
        let line_end = |bytes: &[u8]| bytes.iter().position(|&byte| byte == b'\n');
        let (hash, rest) = bytes.split_at_checked(line_end(bytes)?)?;
        let rest = rest.strip_prefix(b"\n")?;
        if hash != Hash::NEW.extend(rest).to_string().as_bytes() {
            return None;
        }
        let (json, place) = rest.split_at_checked(line_end(rest)?)?;
        let state: Self = serde_json::from_slice(json).ok()?;
        Some(Self { place: place.strip_prefix(b"\n")?.to_vec(), ..state })
    }

    /// Replaces the state of a table, in one go.
    pub fn save(&self, table: &Path) -> Outcome<()> {
        let (state, temporary) = (state_path(table), with_suffix(table, ".state.tmp"));
        let write = || -> Outcome<()> {
            let rest = [serde_json::to_vec(self)?, self.place.clone()].join(&b'\n');
            let mut file = File::create(&temporary)?;
            writeln!(file, "{}", Hash::NEW.extend(&rest))?;
            file.write_all(&rest)?;
            file.sync_all()?;
            fs::rename(&temporary, &state)?;
            // or the next row might reach the disk before the name does
            let folder = state.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
            if cfg!(unix) {
                File::open(folder)?.sync_all()?;
            }
            Ok(())
        };
        write().map_err(|e| {
            let _ = fs::remove_file(&temporary);
            Error::file(&state, format!("cannot be written: {e}")).into()
        })
    }
}

/// The reason of a state that is not as it was written.
pub fn damaged(table: &Path) -> String {
    format!("cannot be continued, {} is damaged", state_path(table).display())
}

/// The path of the state of a table.
pub fn state_path(table: &Path) -> PathBuf {
    with_suffix(table, ".state")
}
