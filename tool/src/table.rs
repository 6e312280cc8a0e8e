//! The table that `asperity sweep` and `asperity cycle` fill: a row for each equilibrium, in the order of the loads.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use asperity::path::PathCheckpoint;
use asperity::{Grid, Status, Surface};
use asperity_scene::{Account, Course, Posed, is_apart};
use ndarray::{Array2, ArrayRef2, Axis, Slice};
use serde_json::{Map, Value, json};

use crate::adhesion::Adhesion;
use crate::fields::check_finite;
use crate::heights::Origin;
use crate::identity::Identity;
use crate::interruption;
use crate::journal::{Journal, Row, Saved, Seen, state_path};
use crate::kept::Kept;
use crate::numbers::percent;
use crate::options::{Precision, ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::output::check_apart;
use crate::part::Part;
use crate::printing::{Printing, complain, name};
use crate::processes::{Processes, WHOLE};
use crate::progress::Progress;
use crate::quantity::{FORCE, LENGTH, PRESSURE};
use crate::report;
use crate::scene::{self, Scene};
use crate::units::Units;
use crate::warnings::{self, Strictness, Warnings};

/// The code of the warning that rows have not converged; it stands before the message, as those of all warnings do.
pub const UNCONVERGED: &str = "unconverged";

/// The options of a table.
#[derive(Clone, Copy)]
pub struct TableOptions<'a> {
    pub problem: ProblemOptions<'a>,
    pub out: &'a Path,
    pub force: bool,
    pub printing: Printing,
    pub scene: &'a Scene,
    pub units: &'a Units,
    pub strictness: Strictness,
    /// The folder for the fields of the rows
    pub fields: Option<&'a Path>,
    pub processes: &'a Processes,
    /// The part of the surface that the rows are of.
    pub part: &'a Part,
    /// The grid of the fields from which the next row starts.
    pub nodes: Grid,
}

/// A table on disk, new or continued, with the warnings of its run. The first of several processes has its file.
/// All of them read the whole of the fields from which it goes on when it is opened again.
pub struct Table<'a> {
    options: TableOptions<'a>,
    journal: Option<Journal>,
    /// The number of loads, where that is known before
    loads: Option<usize>,
    rows: usize,
    unconverged: usize,
    warnings: Warnings,
    /// The files that this run made; the table, which is locked, comes last
    made: Vec<PathBuf>,
}

impl<'a> Table<'a> {
    /// Opens the table, writes the scene of the run beside it, and says the warnings so far. Returns the table and the
    /// state from which an interrupted run goes on, in the rows of nodes that this process holds. `identity` is that of
    /// the whole of the fields; the rows are those of `loads`, where these are known before.
    pub fn open<T: Scalar>(
        options: TableOptions<'a>,
        header: &str,
        (surface, origin, adhesion, start): (&Surface, &Origin, &Adhesion<'_>, Option<&Array2<f64>>),
        identity: impl FnOnce(&Surface, &Adhesion<'_>, Option<&ArrayRef2<f64>>) -> Identity,
        loads: Option<&[f64]>,
    ) -> Outcome<(Self, Saved)> {
        let TableOptions { problem, out, force, scene, strictness, processes, .. } = options;
        let grid = *surface.grid();
        if grid.is_shared() && grid.nodes() > WHOLE {
            processes.alone("a table of more than 4096 x 4096 nodes")?;
        }
        let kept = Kept(options.fields);
        let start = start.map(|start| grid.gathered(start));
        let whole = surface.gathered().zip(adhesion.gathered(processes)?);
        let mut opened = None;
        processes.first(|| {
            let Some((surface, adhesion)) = whole else { return Ok(()) };
            let mut warnings =
                Warnings::of_input::<T>(strictness, (&surface, origin), &adhesion, problem, options.units)?;
            check_apart(out, problem.files().chain(problem.solver.initial_gap.as_deref()))?;
            kept.check(force, out)?;
            scene.check_beside(out, force || out.exists())?;
            warnings::check_beside(out, force || out.exists())?;
            let scene_file = scene.written_beside(out)?;
            let made = [state_path(out), scene::beside(out), warnings::beside(out), out.to_owned()]
                .into_iter()
                .filter(|path| !path.exists());
            let made: Vec<_> = made.collect();
            let mut identity = identity(&surface, &adhesion, start.flatten().as_deref());
            identity.insert("units".to_owned(), options.units.of_table().into());
            identity.insert("part".to_owned(), options.part.name().unwrap_or("all").into());
            let (journal, saved) = Journal::open(out, header, identity, loads, force)?;
            scene_file.commit()?;
            let rows = journal.rows();
            warnings.keep_beside(out, rows > 0).inspect_err(|_| {
                if rows == 0 {
                    remove(&made)
                }
            })?;
            if rows == 0 {
                kept.clear();
            } else {
                let of = loads.map_or(String::new(), |loads| format!(" of {}", loads.len()));
                options.printing.say(&format!("{} has {}{of} rows already", name(out), journal.rows()));
            }
            opened = Some((journal, saved, warnings, made));
            Ok(())
        })?;
        let count = loads.map(<[_]>::len);
        let opened = match opened {
            Some((journal, saved, warnings, made)) => {
                let (rows, unconverged) = (journal.rows(), journal.unconverged());
                Ok((saved, Self { options, journal: Some(journal), loads: count, rows, unconverged, warnings, made }))
            }
            None => Seen::read(out).and_then(|Seen { saved, rows, unconverged }| {
                let warnings = Warnings::none(strictness, options.units, true)?;
                Ok((
                    saved,
                    Self { options, journal: None, loads: count, rows, unconverged, warnings, made: Vec::new() },
                ))
            }),
        };
        let (mut saved, table) = processes.agree(opened)?;
        if grid.is_shared() {
            let own = |field: Array2<f64>| field.slice_axis(Axis(0), Slice::from(options.nodes.rows())).to_owned();
            saved.fields = saved.fields.into_iter().map(own).collect();
        }
        table.stands();
        Ok((table, saved))
    }

    /// Sets what an interruption says of the rows.
    fn stands(&self) {
        let TableOptions { out, force, .. } = self.options;
        let of = self.loads.map_or(String::new(), |loads| format!(" of {loads}"));
        let command = if force { "the same command without --force" } else { "the same command" };
        let (rows, out) = (self.rows, out.display());
        interruption::stands(format!("{rows}{of} rows are in {out}: {command} goes on from there"));
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// All rows, with their header.
    pub fn text(&self) -> Outcome<String> {
        let text = self.journal.as_ref().map_or(Ok(String::new()), |journal| Ok(journal.text()?));
        let processes = self.options.processes;
        Ok(processes.told(processes.agree(text)?))
    }

    /// The course of its rows: from the place of the last one, the cells of which tell whether a leg of a cycle ends
    /// there, or from a start.
    pub fn course<T: Scalar>(
        &self,
        course: Course<T>,
        Saved { fields, values }: Saved,
        last: &Value,
        start: Option<Array2<f64>>,
    ) -> Course<T> {
        if self.rows == 0 {
            return course.starting_from(start.map(T::field));
        }
        let shares = ["contact_fraction", "attractive_fraction"].map(|name| last[name].as_f64());
        let fields = fields.into_iter().map(T::field).collect();
        course.continuing(self.rows, PathCheckpoint { values, fields }, is_apart(last["direction"].as_str(), shares))
    }

    /// Solves the next row of a course, while a bar has its number, and appends its cells as `line` writes them, with
    /// the fields of its solution on the part of the surface, if they are kept. Refuses a solution that ran away, and
    /// says its warnings; returns no row at the end of the course.
    pub fn extend<T: Scalar>(
        &mut self,
        course: &mut Course<T>,
        posed: &mut Posed<T>,
        seed: Option<u64>,
        line: impl FnOnce(&Map<String, Value>) -> String,
    ) -> Outcome<Option<asperity_scene::Row>> {
        let TableOptions { problem, printing, scene, units, fields, processes, part, nodes, .. } = self.options;
        let name = format!("{}{}", self.rows + 1, self.loads.map_or(String::new(), |loads| format!("/{loads}")));
        let (tolerance, grid) = (problem.solver.tolerance(), *posed.parts()?.1.grid());
        let mut progress = Progress::new(&name, tolerance, grid.nodes(), printing.without_bars());
        let found = course.next(posed, &mut |state| {
            progress.update(state);
            ControlFlow::Continue(())
        });
        drop(progress);
        let Some(mut found) = found? else { return Ok(None) };
        check_finite(&found.solution)?;
        processes.agree(found.solution.gathered().map_or(Ok(()), |whole| self.warnings.look_at(&whole, part)))?;
        let inputs = report::inputs(problem, part, units, scene);
        let row = found.account(course.command(), &inputs, None, Vec::new())?;
        let row = course.row(&mut found, row, seed)?;
        Kept(fields).write(self.rows + 1, part.grid(), &*part.of_solution(&found.solution)?, processes)?;
        let PathCheckpoint { fields, values } = course.place();
        let whole: Vec<_> = fields.iter().map(|field| nodes.gathered(field)).collect();
        let load = row.wanted_contact_fraction.unwrap_or(row.account.control_value);
        let converged = row.account.status == Status::Converged && row.reached != Some(false);
        processes.first(|| {
            let Some(journal) = &mut self.journal else { return Ok(()) };
            let fields: Vec<_> = whole.iter().flatten().map(|field| field.view()).collect();
            let text = line(&row.cells(&course.columns()));
            journal.append(&Row { text: &text, load, converged, fields: &fields, values })
        })?;
        self.rows += 1;
        self.unconverged += usize::from(!converged);
        self.stands();
        Ok(Some(row))
    }

    /// Removes the fields of a row, if they were kept.
    pub fn forget(&self, row: usize) {
        if self.journal.is_some() {
            Kept(self.options.fields).forget(row);
        }
    }

    /// The report on the table: the number of its rows, the figures that a command `found` in them, and the inputs.
    pub fn report(&self, command: &str, control: &str, found: Value) -> Value {
        let mut outcome = json!({
            "control": control,
            "rows": self.rows(),
            "unconverged": self.unconverged,
            "out": self.options.out.to_string_lossy(),
        });
        if let (Value::Object(outcome), Value::Object(found)) = (&mut outcome, found) {
            outcome.extend(found);
            outcome.insert("warnings".to_owned(), json!(self.warnings.found()));
        }
        let TableOptions { problem, units, scene, part, .. } = self.options;
        report::report(command, outcome, &report::inputs(problem, part, units, scene))
    }

    /// Whether all rows converged; if not, a warning says so, with what else may help.
    pub fn converged(&self, remedy: &str) -> bool {
        let (count, rows, path) = (self.unconverged, self.rows(), self.options.out.display());
        if count > 0 {
            let precise = match self.options.problem.solver.precision {
                Precision::F32 => "use --precision f64, as f32 ends where its rounding does, ",
                Precision::F64 => "",
            };
            let text = format!(
                "{UNCONVERGED}: {count} of {rows} rows not converged, their status and errors are in {path}: {precise}\
                 raise --max-iterations, {remedy}"
            );
            complain("warning", &text);
        }
        count == 0
    }
}

/// A table that ends without a row, as by an error at the first one, leaves no file behind that it made.
impl Drop for Table<'_> {
    fn drop(&mut self) {
        // by the rows of the journal: one may be in the file though its state could not be saved
        if self.journal.as_ref().is_some_and(|journal| journal.rows() == 0) {
            remove(&self.made);
        }
    }
}

/// Removes files, as far as they are there.
fn remove(made: &[PathBuf]) {
    for path in made {
        let _ = fs::remove_file(path);
    }
}

/// The fields of a row that are printed.
pub fn brief(account: &Account, units: &Units) -> String {
    let load = match account.approach {
        Some(approach) => {
            let (force, approach) = (units.number(account.normal_force, FORCE), units.number(approach, LENGTH));
            format!("normal force {force}  approach {approach}")
        }
        None => {
            let (pressure, gap) =
                (units.number(account.mean_pressure, PRESSURE), units.number(account.mean_gap, LENGTH));
            format!("mean pressure {pressure}  mean gap {gap}")
        }
    };
    format!("{load}  contact {} %  {}", percent(account.contact_fraction), account.status)
}
