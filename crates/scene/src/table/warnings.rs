//! The warnings of a run: the worst of each code is kept, also next to a table.

use std::path::{Path, PathBuf};
use std::{fs, io};

use asperity::Error;

use crate::key::Notice;
use crate::outcome::Outcome;
use crate::table::output::{OutputFile, check_free, with_suffix, write_text};

/// The file with the warnings of a table, next to it, a line for each; there is none without warnings.
pub fn path_for(table: &Path) -> PathBuf {
    with_suffix(table, ".warnings.txt")
}

/// Refuses a file in the place of the warnings of a new table, unless `force` replaces it.
///
/// # Errors
/// [`Error::File`] with the remedy.
pub fn check_beside(table: &Path, force: bool) -> Outcome<()> {
    check_free(&path_for(table), force, "--out")
}

/// The warnings next to a table.
///
/// # Errors
/// [`Error::File`] if they cannot be read.
pub fn read_beside(table: &Path) -> Outcome<Vec<Notice>> {
    let path = path_for(table);
    match fs::read_to_string(&path) {
        Ok(text) => Ok(text.lines().filter_map(Notice::parse).collect()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(Error::unreadable(&path, error).into()),
    }
}

/// Replaces the warnings next to a table.
///
/// # Errors
/// [`Error::File`] if they cannot be written.
pub fn write_beside(table: &Path, warnings: &[Notice]) -> Outcome<()> {
    let path = path_for(table);
    if warnings.is_empty() {
        return match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(Error::file(&path, format!("cannot be removed: {error}")).into())
            }
            _ => Ok(()),
        };
    }
    let lines: String = warnings.iter().map(Notice::line).collect();
    Ok(OutputFile::create(&path, true)?.complete(|path| write_text(path, &lines))?)
}

/// The warnings of a run so far, each told once; the worst of each code is kept.
#[derive(Clone)]
pub struct Warnings {
    of_input: Vec<Notice>,
    found: Vec<Notice>,
    told: usize,
    is_strict: bool,
    /// The table that keeps them next to itself
    table: Option<PathBuf>,
}

impl Warnings {
    /// The warnings of an input; an error, if warnings are.
    pub(crate) fn new(of_input: Vec<Notice>, is_strict: bool) -> Outcome<Self> {
        let mut warnings = Self { of_input: Vec::new(), found: Vec::new(), told: 0, is_strict, table: None };
        warnings.of_input = warnings.add(of_input)?;
        Ok(warnings)
    }

    /// Keeps further warnings of the input; an error, if warnings are.
    pub(crate) fn add_of_input(&mut self, new: Vec<Notice>) -> Outcome<()> {
        self.of_input = self.add(new)?;
        Ok(())
    }

    /// Keeps the warnings of a state, behind the warnings of the input; an error, if warnings are.
    pub(crate) fn add(&mut self, new: Vec<Notice>) -> Outcome<Vec<Notice>> {
        // earlier rows of a table may have said the same without it
        if self.is_strict && !new.is_empty() {
            let all: Vec<_> = new.iter().map(Notice::to_string).collect();
            return Err(all.join("; and ").into());
        }
        let mut of_state = self.of_input.clone();
        keep(&mut of_state, new.clone());
        let changed = keep(&mut self.found, new);
        self.table.iter().filter(|_| changed).try_for_each(|table| write_beside(table, &self.found))?;
        Ok(of_state)
    }

    /// Keeps the warnings next to a table from here on, behind the warnings of rows that it has already.
    ///
    /// # Errors
    /// As [`read_beside`] and [`write_beside`].
    pub fn keep_beside(&mut self, table: &Path, has_rows: bool) -> Outcome<()> {
        keep(&mut self.found, if has_rows { read_beside(table)? } else { Vec::new() });
        self.told = self.found.len();
        self.table = Some(table.to_owned());
        write_beside(table, &self.found)
    }

    /// The warnings that were not told before.
    pub fn tell(&mut self) -> &[Notice] {
        let told = std::mem::replace(&mut self.told, self.found.len());
        &self.found[told..]
    }

    /// The warnings of the input.
    pub fn of_input(&self) -> &[Notice] {
        &self.of_input
    }

    /// All warnings so far.
    pub fn all(&self) -> &[Notice] {
        &self.found
    }
}

/// Keeps warnings of new codes, and worse ones of those that are known; whether there are any.
fn keep(kept: &mut Vec<Notice>, new: Vec<Notice>) -> bool {
    let mut changed = false;
    for told in new {
        changed |= match kept.iter_mut().find(|known| known.code == told.code) {
            Some(known) => told.replace_if_worse(known),
            None => {
                kept.push(told);
                true
            }
        };
    }
    changed
}
