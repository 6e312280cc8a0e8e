//! The rows of a session: its way through loads, state by state, and the file of its table.

use std::path::PathBuf;

use asperity::{Error, Grid, Result, Status};
use asperity_maps::warning::Warning;
use ndarray::Array2;
use serde_json::Value;

use crate::account::interface::touch;
use crate::account::{Answer, Row};
use crate::key::{After, Request, Scalar};
use crate::outcome::Outcome;
use crate::session::course::Course;
use crate::session::limit::Coarser;
use crate::session::pace::Pace;
use crate::session::way::Way;
use crate::session::{Facts, OneGrid, Session, Watch};
use crate::table::identity::{Fields, Identity, identity};
use crate::table::output::with_suffix;
use crate::table::warnings::{Warnings, path_for};
use crate::table::{Format, Opening, Table};

/// The file of a table, with the fields of the law on which its rows depend.
#[derive(Default)]
pub struct TableFile {
    /// The file.
    pub out: PathBuf,
    /// The format, if it does not follow from the name.
    pub format: Option<Format>,
    /// The folder for the fields of the rows, if they are kept.
    pub fields: Option<PathBuf>,
    /// Whether to start over, and to replace files that are there.
    pub force: bool,
    /// Whether the table belongs to a case of a study.
    pub is_case: bool,
    /// The gaps and tractions of a law, a pair in each row.
    pub law_table: Option<Array2<f64>>,
    /// The works of adhesion, where they vary.
    pub works: Option<Array2<f64>>,
    /// Whether the law differs from the laws of its name and parameters.
    pub law_differs: bool,
}

/// A state on a course that is not kept yet.
pub struct Next<T: Scalar> {
    /// The findings.
    pub found: Answer<T>,
    /// The row.
    pub row: Row,
    course: Course<T>,
}

/// The rows along a way through loads, as they are found, and the file of their table.
pub struct Rows<T: Scalar> {
    pub(super) one: OneGrid<T>,
    pub(super) course: Course<T>,
    table: Option<Table>,
    /// What tells the limits of a cycle
    pub(super) coarser: Option<Coarser<T>>,
}

impl<T: Scalar> Session<T> {
    /// Begins a way through loads, from a gap or the default start, with what is asked for after each state, or
    /// continues its table in a file; an interface's, if it is one.
    ///
    /// # Errors
    /// A way that the problem does not have, a table of another run, or one that was changed or is being written, and files
    /// that are not to be replaced or cannot be written.
    pub fn begin(
        mut self,
        way: Way,
        after: After,
        is_interface: bool,
        start: Option<Array2<f64>>,
        file: Option<TableFile>,
    ) -> Outcome<Rows<T>> {
        let (loads, scene) = (way.loads(), &self.facts.scene);
        let control = way.control(scene);
        let asked = Request { after, ..Request::under(control) };
        self.facts.worded(asked.check(&scene.adhesion, scene.method, false))?;
        if let Some(value) = loads.iter().map(|load| load.value()).find(|&load| !T::lit(load).is_finite()) {
            let (name, requirement) = ("load", "finite in the precision of the fields");
            return Err(Error::Value { name, value, requirement }.into());
        }
        let afar = if start.is_none() { self.start_afar(loads) } else { None };
        let touch = match is_interface {
            true => {
                if self.surface.absent_nodes() > 0 {
                    self.facts.processes.alone("the closure of a surface with absent nodes")?;
                }
                Some(touch(&self.surface))
            }
            false => None,
        };
        let mut coarser = None;
        if let Way::Cycle(_, settings) = &way {
            coarser = match self.chosen.take() {
                Some(chosen) => Some(Coarser::Behind(chosen)),
                None => self.coarser(loads, *settings, start.as_ref())?,
            };
            let modulus = scene.elastic.body()?.modulus_on(self.grid());
            let found = Warning::of_cycle(&*self.law, self.grid(), modulus, settings.smooth);
            let found = found.iter().map(|warning| self.facts.units.describe(warning)).collect();
            self.facts.warnings.add_of_input(found)?;
        }
        let mut course = Course::new(way, after, touch, |load| self.facts.on_whole(load))?;
        course.expect(&self)?;
        let identity = file.as_ref().map(|file| self.identity(file, start.as_ref())).transpose()?;
        let Rows { one, course, .. } = self.follow(course)?;
        let start = start.or(afar).map(T::field);
        let (course, table) = match file.zip(identity) {
            None => (course.starting_from(start), None),
            Some((file, identity)) => {
                let opening = one.opening(&course, file, identity, control.name())?;
                let (table, course) = course.open(opening, start, &one.nodes(), &one.facts.processes)?;
                (course, Some(table))
            }
        };
        Ok(Rows { one, course, table, coarser })
    }

    /// The rows of a course that the problem has.
    ///
    /// # Errors
    /// As [`Session::on_one_grid`] and [`Course::check`].
    pub(super) fn follow(self, course: Course<T>) -> Result<Rows<T>> {
        let one = self.on_one_grid()?;
        course.check(&one)?;
        Ok(Rows { one, course, table: None, coarser: None })
    }

    /// The identity of the problem with the fields of a table, which the first of several processes knows, from a given
    /// start.
    fn identity(&self, file: &TableFile, start: Option<&Array2<f64>>) -> Outcome<Identity> {
        let Self { facts, surface, law, .. } = self;
        let (start, surface) = (start.map(|start| self.grid().whole(start)), surface.whole());
        if !facts.processes.is_first() {
            return Ok(Identity::new());
        }
        let given = Fields {
            surface: &surface,
            law_table: file.law_table.as_deref(),
            works: file.works.as_deref(),
            hardness: facts.hardness.as_deref().map(|hardness| &**hardness),
            start: start.as_deref(),
            law_differs: file.law_differs,
        };
        Ok(identity(&facts.inputs, facts.scene.settings().branch, &facts.units.of_table(), given, &**law))
    }
}

impl<T: Scalar> OneGrid<T> {
    /// What opens the table of a course in a file.
    fn opening(&self, course: &Course<T>, file: TableFile, identity: Identity, control: &str) -> Outcome<Opening> {
        let TableFile { out, format, fields, force, is_case, .. } = file;
        let known = format.or_else(|| Format::from_path(&out));
        let format = known.ok_or("out ends in neither .csv nor .jsonl: rename it")?;
        let (names, loads) = (course.columns(&self.facts.scene.adhesion), course.loads());
        let header = self.facts.units.columns(&names, control, self.nodes().is_line());
        let beside = vec![with_suffix(&out, ".scene.toml"), path_for(&out)];
        Ok(Opening { out, format, names, header, identity, loads, fields, force, is_case, beside })
    }

    /// The grid of the operator, on which the next state follows.
    fn nodes(&self) -> Grid {
        *self.problem.operator().grid()
    }
}

impl<T: Scalar> Rows<T> {
    /// The facts that the accounts of the rows have in common.
    pub fn facts(&self) -> &Facts {
        &self.one.facts
    }

    /// The warnings so far.
    pub fn warnings(&mut self) -> &mut Warnings {
        &mut self.one.facts.warnings
    }

    /// The names of the columns of the table.
    pub fn columns(&self) -> Vec<&'static str> {
        self.course.columns(&self.facts().scene.adhesion)
    }

    /// The command of the table.
    pub fn command(&self) -> &'static str {
        self.course.command()
    }

    /// Finds the next state of the way; none at its end. The way continues from it once it is [kept](Self::keep): a state
    /// that was stopped, or ran away, is looked for again.
    ///
    /// # Errors
    /// Errors of the solvers of the library, a solve that ran away, warnings, if they are errors, and rows that another
    /// run has written since [`Self::release`].
    pub fn seek(&mut self, observe: Watch<'_>) -> Outcome<Option<Next<T>>> {
        let before = self.course.clone();
        let found = self.find(observe);
        let course = std::mem::replace(&mut self.course, before);
        Ok(found?.map(|(found, row)| Next { found, row, course }))
    }

    /// Finds the next state, with its row.
    fn find(&mut self, observe: Watch<'_>) -> Outcome<Option<(Answer<T>, Row)>> {
        let Self { one, course, table, coarser } = self;
        if let Some(table) = table {
            one.facts.processes.first(|| table.claim())?;
        }
        let Some(mut found) = course.next(one, observe)? else { return Ok(None) };
        let account = one.facts.account(course.command(), &found)?;
        if let Some(Coarser::Behind(chosen)) = coarser {
            found.refined = Some((*chosen.surface).clone());
        }
        let row = course.row(&mut found, account, one.facts.seed)?;
        Ok(Some((found, row)))
    }

    /// Appends the row of a state, and continues from there, unless its solve was stopped.
    ///
    /// # Errors
    /// Files that cannot be written, or were changed meanwhile.
    pub fn keep(&mut self, next: Next<T>) -> Outcome<(Answer<T>, Row)> {
        let Next { found, row, course } = next;
        if found.solution.report.status != Status::Stopped {
            if let Some(table) = &mut self.table {
                course.append(table, (&found, &row), &self.one.nodes(), &self.one.facts.processes)?;
            }
            self.course = course;
        }
        Ok((found, row))
    }

    /// Finds and keeps the next state; none at the end of the way, which ends with a state that was stopped. The fields of
    /// the place before are not kept meanwhile, as [`Self::seek`] keeps them.
    ///
    /// # Errors
    /// As [`Self::seek`] and [`Self::keep`].
    pub fn next(&mut self, observe: Watch<'_>) -> Outcome<Option<(Answer<T>, Row)>> {
        let found = self.find(observe);
        let goes_on = |found: &(Answer<T>, Row)| found.0.solution.report.status != Status::Stopped;
        self.course.is_over |= !found.as_ref().is_ok_and(|found| found.as_ref().is_some_and(goes_on));
        let found = found?;
        if let (Some((found, row)), Some(table), false) = (&found, &mut self.table, self.course.is_over) {
            let kept = self.course.append(table, (found, row), &self.one.nodes(), &self.one.facts.processes);
            // a row that is not in the file is not behind the next one
            self.course.is_over |= kept.is_err();
            kept?;
        }
        Ok(found)
    }

    /// Lets other runs write the table until the next state.
    pub fn release(&mut self) {
        self.table.iter_mut().for_each(Table::release);
    }

    /// The number of rows that the table has.
    pub fn count(&self) -> usize {
        self.table.as_ref().map_or(0, Table::rows)
    }

    /// The number of rows when the table is complete, where there is one, and that is known before.
    pub fn of_rows(&self) -> Option<usize> {
        self.table.as_ref().and_then(Table::of_rows)
    }

    /// The number of rows of the table that did not converge.
    pub fn unconverged(&self) -> usize {
        self.table.as_ref().map_or(0, Table::unconverged)
    }

    /// The pace of a cycle.
    pub fn pace(&self) -> Option<&Pace> {
        self.course.pace()
    }

    /// All rows of the file of the table; every process gets them.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(&self) -> Outcome<Vec<Value>> {
        self.table.as_ref().map_or(Ok(Vec::new()), |table| table.read(&self.one.facts.processes))
    }
}
