//! Tables: a row for each state of a course, appended to a file as it comes, from which an interrupted run goes on.

pub mod csv;
pub(crate) mod fields;
pub(crate) mod identity;
pub mod journal;
pub(crate) mod kept;
pub mod legs;
pub mod output;

use std::fs;
use std::path::{Path, PathBuf};

use asperity::{Error, Grid, Status};
use ndarray::Array2;
use serde_json::{Map, Value};

use crate::account::found::Found;
use crate::key::scalar::Scalar;
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::session::course::{Course, Place, Row};
use crate::table::identity::Identity;
use crate::table::journal::{Journal, Row as Line, Seen, damaged, refused, state_path};
use crate::table::kept::Kept;

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum Format {
    /// Comma-separated values, with a header.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    Csv,
    /// A JSON object on each line.
    #[cfg_attr(feature = "options", value(help = None::<&str>))]
    Jsonl,
}

/// The opening of a table.
pub struct Opening {
    /// The file.
    pub out: PathBuf,
    /// Its format.
    pub format: Format,
    /// The names of the columns, with their units where these are known.
    pub header: Vec<String>,
    /// The folder for the fields of the rows, if they are kept.
    pub fields: Option<PathBuf>,
    /// Whether to start over, and to replace files that are there.
    pub force: bool,
    /// Whether it is that of a case of a study: it waits for another run that writes there, and saves its state now and then.
    pub is_case: bool,
    /// The files that may stand beside the table and its state.
    pub beside: Vec<PathBuf>,
    /// The grid of the fields from which the next row starts.
    pub nodes: Grid,
}

/// A table on disk, new or continued, whose file the first of several processes has.
///
/// One that ends without a row, as by an error at the first one, leaves no file behind that it made.
pub struct Table {
    opening: Opening,
    names: Vec<&'static str>,
    identity: Identity,
    loads: Option<Vec<f64>>,
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
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" => Some(Self::Jsonl),
            _ => None,
        }
    }

    /// The name, the end of the names of its files.
    pub fn name(self) -> &'static str {
        if self == Self::Csv { "csv" } else { "jsonl" }
    }

    /// A row as a line.
    pub fn line(self, row: &Map<String, Value>) -> String {
        match self {
            Self::Csv => csv::line(row),
            Self::Jsonl => serde_json::to_string(row).unwrap_or_default(),
        }
    }

    /// The row of a line, whose columns have these names.
    pub fn parsed(self, names: &[impl AsRef<str>], line: &str) -> Value {
        match self {
            Self::Csv => csv::parsed(names, line),
            Self::Jsonl => serde_json::from_str(line).unwrap_or_default(),
        }
    }
}

impl Table {
    /// Opens the table of a course whose problem has an identity, which the first of several processes knows, and returns
    /// it with the course from where its last row leads, or from a start.
    ///
    /// # Errors
    /// A table of another run, one that was changed or is being written, and files that are not to be replaced or
    /// cannot be written.
    pub fn open<T: Scalar>(
        opening: Opening,
        identity: Option<Identity>,
        course: Course<T>,
        start: Option<Array2<f64>>,
        processes: &Processes,
    ) -> Outcome<(Self, Course<T>)> {
        let mut identity = identity.unwrap_or_default();
        identity.extend(course.identity());
        identity.insert("fields".to_owned(), if opening.fields.is_some() { "kept" } else { "left out" }.into());
        let loads = course.loads();
        if loads.is_some() {
            identity.insert("format".to_owned(), opening.format.name().into());
        }
        let (names, journal, made) = (course.columns(), None, Vec::new());
        let mut table =
            Self { opening, names, identity, loads, journal, rows: 0, unconverged: 0, had_event: false, made };
        let begun = processes.agree(processes.is_first().then(|| table.begin()).transpose())?;
        // what the first process has open by now
        let place = processes.agree(begun.map_or_else(|| table.see(), Ok))?;
        let course = table.resume(course, &place, start, processes)?;
        Ok((table, course))
    }

    /// Begins the table, or goes on with it, in the first process.
    fn begin(&mut self) -> Outcome<Vec<u8>> {
        let &Opening { ref out, force, is_case, ref beside, .. } = &self.opening;
        self.kept().check(force, out)?;
        let files = [state_path(out)].into_iter().chain(beside.clone()).chain([out.clone()]);
        self.made = files.filter(|path| !path.exists()).collect();
        let place = self.lock(force, is_case)?;
        if self.rows == 0 {
            self.kept().clear();
            remove(if force { &self.opening.beside } else { &[] });
        }
        Ok(place)
    }

    /// The table as a process sees it that does not have its file.
    fn see(&mut self) -> Outcome<Vec<u8>> {
        let Seen { place, rows, unconverged } = Seen::read(&self.opening.out)?;
        (self.rows, self.unconverged) = (rows, unconverged);
        Ok(place)
    }

    fn lock(&mut self, force: bool, is_case: bool) -> Outcome<Vec<u8>> {
        let Opening { out, format, header, .. } = &self.opening;
        let header = if *format == Format::Csv { csv::header(header) + "\n" } else { String::new() };
        let (identity, loads) = (self.identity.clone(), self.loads.as_deref());
        let (journal, place) = Journal::open(out, &header, identity, loads, (force, is_case))?;
        (self.rows, self.unconverged) = (journal.rows(), journal.unconverged());
        self.journal = Some(journal);
        Ok(place)
    }

    /// The folder of the fields.
    fn kept(&self) -> Kept<'_> {
        Kept(self.opening.fields.as_deref())
    }

    /// The course from the place that was saved with the last row.
    fn resume<T: Scalar>(
        &mut self,
        course: Course<T>,
        place: &[u8],
        start: Option<Array2<f64>>,
        processes: &Processes,
    ) -> Outcome<Course<T>> {
        let text = self.text(processes)?;
        if self.rows == 0 {
            return Ok(course.starting_from(start.map(T::field)));
        }
        let mut rows = text.lines().rev().map(|line| self.opening.format.parsed(&self.names, line));
        let [last, before] = [rows.next(), rows.next()].map(Option::unwrap_or_default);
        self.had_event = !last["event"].is_null();
        // a run that was killed may have left them
        if self.loads.is_none() && !self.had_event && before["event"].is_null() && self.journal.is_some() {
            self.kept().forget(self.rows - 1);
        }
        let out = &self.opening.out;
        let place: Place<T> = postcard::from_bytes(place).map_err(|_| refused(out, damaged(out)))?;
        Ok(course.continuing(place.shared(&self.opening.nodes)))
    }

    /// Appends the row of the state that its course found last, with the fields on the part of a mirrored map, if they
    /// are kept: those of a cycle where the row or the next one has an event, and of the last row.
    ///
    /// # Errors
    /// Files that cannot be written, or were changed meanwhile.
    pub fn append<T: Scalar>(
        &mut self,
        course: &Course<T>,
        found: &Found<T>,
        row: &Row,
        processes: &Processes,
    ) -> Outcome<()> {
        self.kept().write(self.rows + 1, &*found.part()?, processes)?;
        let place = course.place().whole(&self.opening.nodes);
        let load = row.wanted_contact_fraction.unwrap_or(row.account.control_value);
        let converged = row.account.status == Status::Converged && row.reached != Some(false);
        processes.first(|| {
            let Some(journal) = &mut self.journal else { return Ok(()) };
            let text = self.opening.format.line(&row.cells(&self.names));
            journal.append(Line { text: &text, load, converged, place: postcard::to_stdvec(&place)? })
        })?;
        if let Some(step) = &row.step {
            let has_event = step.event.is_some();
            if !self.had_event && !has_event && self.journal.is_some() {
                self.kept().forget(self.rows);
            }
            self.had_event = has_event;
        }
        self.rows += 1;
        self.unconverged += usize::from(!converged);
        Ok(())
    }

    /// Lets other runs write the table until [`Self::claim`]; it leaves no file behind that it made if it has no row.
    pub fn release(&mut self) {
        if self.journal.as_ref().is_some_and(|journal| journal.rows() == 0) {
            remove(&self.made);
        }
        self.journal = None;
    }

    /// Opens the table again after [`Self::release`].
    ///
    /// # Errors
    /// Those of [`Self::open`], and rows of another run.
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
        self.loads.as_ref().map(Vec::len)
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
        Ok(lines.map(|line| self.opening.format.parsed(&self.names, line)).collect())
    }

    fn text(&self, processes: &Processes) -> Outcome<String> {
        let text = self.journal.as_ref().map_or(Ok(String::new()), |journal| Ok(journal.text()?));
        Ok(processes.told(processes.agree(text)?))
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
