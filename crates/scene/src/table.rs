//! Tables: a row for each state of a course, appended to a file as it comes, from which an interrupted run continues.

pub mod csv;
pub(crate) mod field_folder;
pub(crate) mod fields;
pub(crate) mod identity;
pub mod journal;
pub mod legs;
pub mod output;
pub mod warnings;

use std::fs;
use std::path::{Path, PathBuf};
use std::str::Lines;

use asperity::{Error, Solution};
use serde_json::{Map, Value};

use crate::account::{Row, Step};
use crate::key::{Choice, Scalar, choice};
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::table::field_folder::FieldFolder;
use crate::table::identity::Identity;
use crate::table::journal::{Journal, Row as Line, State, Written, refused, state_path};

choice! {
    /// The format of a table, by the end of the names of its files.
    Format {
        /// comma-separated values, with a header
        Csv = "csv",
        /// a JSON object on each line
        Jsonl = "jsonl",
    }
}

/// The opening of a table.
pub struct Opening {
    /// The file.
    pub out: PathBuf,
    /// Its format.
    pub format: Format,
    /// The names of the columns.
    pub names: Vec<&'static str>,
    /// The same with their units, where these are known.
    pub header: Vec<String>,
    /// The inputs on which the rows depend, which the first of several processes knows.
    pub identity: Identity,
    /// The loads of the rows, where these are known before.
    pub loads: Option<Vec<f64>>,
    /// The folder for the fields of the rows, if they are kept.
    pub fields: Option<PathBuf>,
    /// Whether to start over, and to replace files that are there.
    pub force: bool,
    /// Whether the table belongs to a case of a study: it waits for another run that writes there, and saves its state
    /// from time to time.
    pub is_case: bool,
    /// The files that may stand next to the table and its state.
    pub beside: Vec<PathBuf>,
}

/// A table on disk, new or continued; the first of several processes has its file.
///
/// One that ends without a row, as by an error at the first one, leaves no file behind that it made.
pub struct Table {
    opening: Opening,
    journal: Option<Journal>,
    rows: usize,
    unconverged: usize,
    /// Whether there was an event before the last row
    had_event: bool,
    /// The files that this run made; the table, which is locked, comes last
    made: Vec<PathBuf>,
}

impl Format {
    /// The format of a file by its name.
    pub fn from_path(path: &Path) -> Option<Self> {
        Self::named(&path.extension()?.to_str()?.to_lowercase())
    }

    /// The first line of a table with these columns; none, if each row names them.
    pub fn header(self, columns: &[impl AsRef<str>]) -> String {
        if self == Self::Csv { csv::header(columns) + "\n" } else { String::new() }
    }

    /// A row as a line.
    pub fn line(self, row: &Map<String, Value>) -> String {
        match self {
            Self::Csv => csv::line(row),
            Self::Jsonl => serde_json::to_string(row).unwrap_or_default(),
        }
    }

    /// The names of the columns of a table, and the lines of its rows.
    pub fn parts(self, text: &str) -> (Vec<String>, Lines<'_>) {
        let mut lines = text.lines();
        let names = match self {
            Self::Csv => csv::names(lines.next().unwrap_or_default()),
            Self::Jsonl => {
                let first: Map<_, _> =
                    lines.clone().next().and_then(|line| serde_json::from_str(line).ok()).unwrap_or_default();
                first.into_iter().map(|(name, _)| name).collect()
            }
        };
        (names, lines)
    }

    /// The row of a line with columns of these names.
    pub fn parsed(self, names: &[impl AsRef<str>], line: &str) -> Value {
        match self {
            Self::Csv => csv::parsed(names, line),
            Self::Jsonl => serde_json::from_str(line).unwrap_or_default(),
        }
    }
}

impl Table {
    /// Opens a table, and returns it with the place from which its next row follows, if it has rows.
    ///
    /// # Errors
    /// A table of another run, one that was changed or is being written, and files that are not to be replaced or
    /// cannot be written.
    pub fn open(mut opening: Opening, processes: &Processes) -> Outcome<(Self, Option<Vec<u8>>)> {
        let Opening { identity, fields, loads, format, .. } = &mut opening;
        identity.insert("fields".to_owned(), if fields.is_some() { "kept" } else { "left out" }.into());
        if loads.is_some() {
            identity.insert("format".to_owned(), format.name().into());
        }
        let mut table = Self { opening, journal: None, rows: 0, unconverged: 0, had_event: false, made: Vec::new() };
        let begun = processes.agree(processes.is_first().then(|| table.begin()).transpose())?;
        // what the first process has open by now
        let place = processes.agree(begun.map_or_else(|| table.see(), Ok))?;
        let text = table.text(processes)?;
        if table.rows == 0 {
            return Ok((table, None));
        }
        let mut rows = text.lines().rev().map(|line| table.opening.format.parsed(&table.opening.names, line));
        let [last, before] = [rows.next(), rows.next()].map(Option::unwrap_or_default);
        table.had_event = !last[crate::key!(Step, event)].is_null();
        // a run that was killed may have left them
        if table.opening.loads.is_none()
            && !table.had_event
            && before[crate::key!(Step, event)].is_null()
            && table.journal.is_some()
        {
            table.field_folder().forget(table.rows - 1);
        }
        Ok((table, Some(place)))
    }

    /// Begins the table, or continues it, in the first process.
    fn begin(&mut self) -> Outcome<Vec<u8>> {
        let &Opening { ref out, force, is_case, ref beside, .. } = &self.opening;
        self.field_folder().check(force, out)?;
        let files = [state_path(out)].into_iter().chain(beside.clone()).chain([out.clone()]);
        self.made = files.filter(|path| !path.exists()).collect();
        let place = self.lock(force, is_case)?;
        if self.rows == 0 {
            self.field_folder().clear();
            remove(if force { &self.opening.beside } else { &[] });
        }
        Ok(place)
    }

    /// The table as a process sees it that does not have its file.
    fn see(&mut self) -> Outcome<Vec<u8>> {
        let State { place, written: Written { rows, unconverged, .. }, .. } =
            State::read(&self.opening.out).map_err(|reason| refused(&self.opening.out, reason))?;
        (self.rows, self.unconverged) = (rows, unconverged);
        Ok(place)
    }

    fn lock(&mut self, force: bool, is_case: bool) -> Outcome<Vec<u8>> {
        let Opening { out, format, header, identity, loads, .. } = &self.opening;
        let header = format.header(header);
        let (identity, loads) = (identity.clone(), loads.as_deref());
        let (journal, place) = Journal::open(out, &header, identity, loads, (force, is_case))?;
        Written { rows: self.rows, unconverged: self.unconverged, .. } = journal.written();
        self.journal = Some(journal);
        Ok(place)
    }

    /// The folder of the fields.
    fn field_folder(&self) -> FieldFolder<'_> {
        FieldFolder(self.opening.fields.as_deref())
    }

    /// Whether the next row has the place saved from which the one after it follows; on the first of several processes.
    pub fn saves(&self) -> bool {
        self.journal.as_ref().is_some_and(Journal::saves)
    }

    /// Appends a row with the place from which the next one follows, if that is saved, and the fields of its solution on
    /// the part of a mirrored map, if they are kept: for a cycle where the row or the next one has an event, and for
    /// the last row.
    ///
    /// # Errors
    /// Files that cannot be written, or were changed meanwhile.
    pub fn append<T: Scalar>(
        &mut self,
        row: &Row,
        place: Option<Vec<u8>>,
        solution: &Solution<T>,
        processes: &Processes,
    ) -> Outcome<()> {
        self.field_folder().write(self.rows + 1, solution, processes)?;
        processes.first(|| {
            let Some(journal) = &mut self.journal else { return Ok(()) };
            let text = self.opening.format.line(&row.cells(&self.opening.names));
            journal.append(Line { text: &text, load: row.load(), converged: row.converged(), place })
        })?;
        if let Some(step) = &row.step {
            let has_event = step.event.is_some();
            if !self.had_event && !has_event && self.journal.is_some() {
                self.field_folder().forget(self.rows);
            }
            self.had_event = has_event;
        }
        self.rows += 1;
        self.unconverged += usize::from(!row.converged());
        Ok(())
    }

    /// Lets other runs write the table until [`Self::claim`]; it leaves no file behind that it made if it has no row.
    pub fn release(&mut self) {
        if self.journal.as_ref().is_some_and(|journal| journal.written().rows == 0) {
            remove(&self.made);
        }
        self.journal = None;
    }

    /// Opens the table again after [`Self::release`].
    ///
    /// # Errors
    /// As [`Self::open`], and rows of another run.
    pub fn claim(&mut self) -> Outcome<()> {
        if self.journal.is_some() {
            return Ok(());
        }
        let rows = self.rows;
        self.lock(false, false)?;
        if self.rows == rows {
            return Ok(());
        }
        (self.journal, self.rows) = (None, rows);
        Err(Error::file(&self.opening.out, "has rows of another run by now: make the same call again").into())
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of rows when the table is complete, where that is known before.
    pub fn of_rows(&self) -> Option<usize> {
        self.opening.loads.as_ref().map(Vec::len)
    }

    /// The number of rows that did not converge.
    pub fn unconverged(&self) -> usize {
        self.unconverged
    }

    /// All rows, as far as they are in the file; every process gets them.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(&self, processes: &Processes) -> Outcome<Vec<Value>> {
        let text = self.text(processes)?;
        let lines = text.lines().skip(usize::from(self.opening.format == Format::Csv));
        Ok(lines.map(|line| self.opening.format.parsed(&self.opening.names, line)).collect())
    }

    fn text(&self, processes: &Processes) -> Outcome<String> {
        let text = self.journal.as_ref().map_or(Ok(String::new()), |journal| Ok(journal.text()?));
        Ok(processes.broadcast(processes.agree(text)?))
    }
}

impl Drop for Table {
    fn drop(&mut self) {
        // by the rows of the journal: one may be in the file though its state could not be saved
        self.release();
    }
}

/// Removes files, as far as they are there.
fn remove(files: &[PathBuf]) {
    files.iter().for_each(|file| drop(fs::remove_file(file)));
}
