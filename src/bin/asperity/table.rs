//! The table that `asperity sweep` and `asperity cycle` fill: a row for each equilibrium, in the order of the loads.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use asperity::{Grid, Iteration, Report, Solution};
use serde_json::{Value, json};

use crate::case::check_finite;
use crate::identity::Identity;
use crate::journal::{Journal, Row, Saved, state_path};
use crate::numbers::percent;
use crate::options::{ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::part::Part;
use crate::printing::{Printing, complain};
use crate::progress::Progress;
use crate::quantity::{FORCE, LENGTH, PRESSURE};
use crate::report;
use crate::scene::{self, Scene};
use crate::units::Units;
use crate::warnings::Warnings;

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
    /// The part of the surface that the rows are of.
    pub part: &'a Part,
}

/// A table on disk, new or continued, with the warnings of its run.
pub struct Table<'a> {
    options: TableOptions<'a>,
    journal: Journal,
    warnings: Warnings,
    /// The files that this run made; the table, which is locked, comes last
    made: Vec<PathBuf>,
}

impl<'a> Table<'a> {
    /// Opens the table, writes the scene of the run beside it, and says the warnings so far. Returns the table and the
    /// state from which an interrupted run goes on. The rows are those of `loads`, where these are known before.
    pub fn open(
        options: TableOptions<'a>,
        header: &str,
        identity: Identity,
        loads: Option<&[f64]>,
        mut warnings: Warnings,
    ) -> Outcome<(Self, Saved)> {
        let TableOptions { out, force, scene, .. } = options;
        scene.check_beside(out, force || out.exists())?;
        let scene_file = scene.written_beside(out)?;
        let made = [state_path(out), scene::beside(out), out.to_owned()].into_iter().filter(|path| !path.exists());
        let made = made.collect();
        let (journal, saved) = Journal::open(out, header, identity, loads, force)?;
        scene_file.commit()?;
        warnings.say();
        if journal.rows() > 0 {
            let of = loads.map_or(String::new(), |loads| format!(" of {}", loads.len()));
            options.printing.say(&format!("{} has {}{of} rows already", out.display(), journal.rows()));
        }
        Ok((Self { options, journal, warnings, made }, saved))
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.journal.rows()
    }

    /// All rows, with their header.
    pub fn text(&self) -> asperity::Result<String> {
        self.journal.text()
    }

    /// Shows a bar with this name while `solve` runs, which gets the observer of its iterations.
    pub fn observed<S>(
        &self,
        name: &str,
        nodes: usize,
        solve: impl FnOnce(&mut dyn FnMut(&Iteration) -> ControlFlow<()>) -> S,
    ) -> S {
        let tolerance = self.options.problem.solver.tolerance();
        let mut progress = Progress::new(name, tolerance, nodes, self.options.printing.without_bars());
        solve(&mut |state| {
            progress.update(state);
            ControlFlow::Continue(())
        })
    }

    /// Looks at a solution before its row is written: refuses one that ran away, and says its warnings.
    pub fn check<T: Scalar>(&mut self, solution: &Solution<T>) -> Outcome<()> {
        check_finite(solution, &Grid::new(solution.gap.dim(), (1.0, 1.0))?)?;
        self.warnings.look_at(solution, self.options.problem.surface.modulus(), self.options.part)
    }

    /// Appends a row.
    pub fn append<T: Scalar>(&mut self, row: &Row<'_, T>) -> Outcome<()> {
        self.journal.append(row)
    }

    /// The report on the table: the number of its rows, the figures that a command `found` in them, and the inputs.
    pub fn report(&self, command: &str, control: &str, found: Value) -> Value {
        let mut outcome = json!({
            "control": control,
            "rows": self.rows(),
            "unconverged": self.journal.unconverged(),
            "out": self.options.out.to_string_lossy(),
        });
        if let (Value::Object(outcome), Value::Object(found)) = (&mut outcome, found) {
            outcome.extend(found);
            outcome.insert("warnings".to_owned(), self.warnings.report());
        }
        let TableOptions { problem, units, scene, part, .. } = self.options;
        report::report(command, outcome, report::inputs(problem, part, units, scene))
    }

    /// Whether all rows converged; if not, a warning says so, with what else may help.
    pub fn converged(&self, remedy: &str) -> bool {
        let (count, rows, path) = (self.journal.unconverged(), self.rows(), self.options.out.display());
        if count > 0 {
            let text = format!(
                "{UNCONVERGED}: {count} of {rows} rows not converged, their status and errors are in {path}: raise \
                 --max-iterations, {remedy}"
            );
            complain("warning", &text);
        }
        count == 0
    }
}

/// A table that ends without a row, as by an error at the first one, leaves no file behind that it made.
impl Drop for Table<'_> {
    fn drop(&mut self) {
        if self.rows() == 0 {
            for path in &self.made {
                let _ = fs::remove_file(path);
            }
        }
    }
}

/// The fields of a row that are printed.
pub fn brief(report: &Report, units: &Units) -> String {
    let load = match report.approach {
        Some(approach) => {
            let (force, approach) = (units.number(report.normal_force, FORCE), units.number(approach, LENGTH));
            format!("normal force {force}  approach {approach}")
        }
        None => {
            let (pressure, gap) = (units.number(report.mean_pressure, PRESSURE), units.number(report.mean_gap, LENGTH));
            format!("mean pressure {pressure}  mean gap {gap}")
        }
    };
    format!("{load}  contact {} %  {}", percent(report.contact_fraction), report.status)
}
