//! The table of a session: its way through loads, state by state, and the file that it fills.

use std::ops::ControlFlow;
use std::path::PathBuf;

use asperity::solver::Iteration;
use asperity::{Error, Status};
use asperity_maps::warning::Warning;
use ndarray::Array2;
use serde_json::Value;

use crate::account::interface::touch;
use crate::account::{Found, Row};
use crate::key::{After, Request, Scalar};
use crate::outcome::Outcome;
use crate::session::course::Course;
use crate::session::limit::Coarser;
use crate::session::pace::Pace;
use crate::session::way::Way;
use crate::session::{Session, Solved};
use crate::table::identity::{Fields, Identity, identity};
use crate::table::output::with_suffix;
use crate::table::warnings::path_for;
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
    pub found: Found<T>,
    /// The row.
    pub row: Row,
    course: Course<T>,
}

/// The refusal of a state before there is a way.
const NOT_BEGUN: &str = "there are no loads to follow: begin first";

impl<T: Scalar> Session<T> {
    /// Begins a way through loads, from a gap or the default start, with what is asked for after each state, or
    /// continues its table in a file; an interface's, if it is one.
    ///
    /// # Errors
    /// A way that the problem does not have, a table of another run, or one that was changed or is being written, and files
    /// that are not to be replaced or cannot be written.
    pub fn begin(
        &mut self,
        way: Way,
        after: After,
        is_interface: bool,
        start: Option<Array2<f64>>,
        file: Option<TableFile>,
    ) -> Outcome<()> {
        let loads = way.loads();
        let control = way.control(&self.facts.scene);
        self.worded(Request { after, ..Request::under(control) }.check(
            &self.facts.scene.adhesion,
            self.facts.scene.method,
            false,
        ))?;
        if let Some(value) = loads.iter().map(|load| load.value()).find(|&load| !T::lit(load).is_finite()) {
            let (name, requirement) = ("load", "finite in the precision of the fields");
            return Err(Error::Value { name, value, requirement }.into());
        }
        let afar = if start.is_none() { self.start_afar(loads) } else { None };
        let touch = match is_interface {
            true => {
                let surface = self.surface()?;
                if surface.absent_nodes() > 0 {
                    self.facts.processes.alone("the closure of a surface with absent nodes")?;
                }
                Some(touch(&surface))
            }
            false => None,
        };
        self.coarser =
            self.coarser.take().filter(|coarser| matches!((coarser, &way), (Coarser::Behind(_), Way::Cycle(..))));
        if let Way::Cycle(_, settings) = &way {
            if self.coarser.is_none() {
                self.coarser = self.coarser(loads, *settings, start.as_ref())?;
            }
            let modulus = self.facts.scene.elastic.body()?.modulus_on(&self.grid);
            let found = Warning::of_cycle(&*self.law, &self.grid, modulus, settings.smooth);
            self.warnings.add_of_input(found.iter().map(|warning| self.facts.units.describe(warning)).collect())?;
        }
        let mut course = Course::new(way, after, touch, |load| self.on_whole(load))?;
        course.expect(self)?;
        let identity = file.as_ref().map(|file| self.identity(file, start.as_ref())).transpose()?;
        course.check(self)?;
        let start = start.or(afar).map(T::field);
        // the one before, if there is one, may have the same file
        self.table = None;
        self.course = Some(match file.zip(identity) {
            None => course.starting_from(start),
            Some((file, identity)) => {
                let opening = self.opening(file, &course, identity, control.name())?;
                let (table, course) = course.open(opening, start, &self.nodes()?, &self.facts.processes)?;
                self.table = Some(table);
                course
            }
        });
        Ok(())
    }

    /// What opens the table of a course in a file.
    fn opening(&self, file: TableFile, course: &Course<T>, identity: Identity, control: &str) -> Outcome<Opening> {
        let TableFile { out, format, fields, force, is_case, .. } = file;
        let known = format.or_else(|| Format::of(&out));
        let format = known.ok_or("out ends in neither .csv nor .jsonl: rename it")?;
        let (names, loads) = (course.columns(&self.facts.scene.adhesion), course.loads());
        let header = self.facts.units.columns(&names, control, self.grid.is_line());
        let beside = vec![with_suffix(&out, ".scene.toml"), path_for(&out)];
        Ok(Opening { out, format, names, header, identity, loads, fields, force, is_case, beside })
    }

    /// The identity of the problem with the fields of a table, which the first of several processes knows, from a given
    /// start.
    fn identity(&self, file: &TableFile, start: Option<&Array2<f64>>) -> Outcome<Identity> {
        let surface = self.surface()?;
        let (start, surface) = (start.map(|start| self.grid.whole(start)), surface.whole());
        if !self.facts.processes.is_first() {
            return Ok(Identity::new());
        }
        let given = Fields {
            surface: &surface,
            law_table: file.law_table.as_deref(),
            works: file.works.as_deref(),
            hardness: self.facts.hardness.as_deref(),
            start: start.as_deref(),
            law_differs: file.law_differs,
        };
        Ok(identity(&self.inputs, self.solver.settings.branch, &self.facts.units.of_table(), given, &*self.law))
    }

    /// The names of the columns of the table, once it was begun.
    pub fn columns(&self) -> Vec<&'static str> {
        self.course.as_ref().map_or(Vec::new(), |course| course.columns(&self.facts.scene.adhesion))
    }

    /// The command of the table, once it was begun.
    pub fn command(&self) -> &'static str {
        self.course.as_ref().map_or("", Course::command)
    }

    /// Finds the next state of the way that was begun last; none at its end. The way continues from it once it is
    /// [kept](Self::keep): a state that was stopped, or ran away, is looked for again.
    ///
    /// # Errors
    /// Errors of the solvers of the library, a solve that ran away, warnings, if they are errors, and rows that another
    /// run has written since [`Self::release`].
    pub fn seek(
        &mut self,
        observe: &mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send),
    ) -> Outcome<Option<Next<T>>> {
        let mut course = self.course.clone().ok_or(NOT_BEGUN)?;
        let found = self.found_on(&mut course, observe)?;
        Ok(found.map(|(found, row)| Next { found, row, course }))
    }

    /// The next state of a course.
    fn found_on(
        &mut self,
        course: &mut Course<T>,
        observe: &mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send),
    ) -> Outcome<Option<(Found<T>, Row)>> {
        if let Some(table) = &mut self.table {
            self.facts.processes.first(|| table.claim())?;
        }
        let Some(found) = course.next(self, observe)? else { return Ok(None) };
        let Solved { mut found, account } = self.solved(course.command(), found)?;
        if let Some(Coarser::Behind(chosen)) = &self.coarser {
            found.refined = Some((*chosen.surface).clone());
        }
        let row = course.row(&mut found, account, self.seed)?;
        Ok(Some((found, row)))
    }

    /// Appends the row of a state, and continues from there, unless its solve was stopped.
    ///
    /// # Errors
    /// Files that cannot be written, or were changed meanwhile.
    pub fn keep(&mut self, next: Next<T>) -> Outcome<(Found<T>, Row)> {
        let Next { found, row, course } = next;
        if found.solution.report.status != Status::Stopped {
            let nodes = self.nodes()?;
            if let Some(table) = &mut self.table {
                course.append(table, (&found, &row), &nodes, &self.facts.processes)?;
            }
            self.course = Some(course);
        }
        Ok((found, row))
    }

    /// Finds and keeps the next state; none at the end of the way, which ends with a state that was stopped. The fields of
    /// the place before are not kept meanwhile, as [`Self::seek`] keeps them.
    ///
    /// # Errors
    /// As [`Self::seek`] and [`Self::keep`].
    pub fn next(
        &mut self,
        observe: &mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send),
    ) -> Outcome<Option<(Found<T>, Row)>> {
        let mut course = self.course.take().ok_or(NOT_BEGUN)?;
        let found = self.found_on(&mut course, observe)?;
        course.is_over |= found.as_ref().is_none_or(|(found, _)| found.solution.report.status == Status::Stopped);
        if course.is_over {
            self.course = Some(course);
            return Ok(found);
        }
        found.map(|(found, row)| self.keep(Next { found, row, course })).transpose()
    }

    /// Lets other runs write the table until the next state.
    pub fn release(&mut self) {
        self.table.iter_mut().for_each(Table::release);
    }

    /// The number of rows that the table has.
    pub fn rows(&self) -> usize {
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
        self.course.as_ref().and_then(Course::pace)
    }

    /// All rows of the file of the table; every process gets them.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(&self) -> Outcome<Vec<Value>> {
        self.table.as_ref().map_or(Ok(Vec::new()), |table| table.read(&self.facts.processes))
    }
}
