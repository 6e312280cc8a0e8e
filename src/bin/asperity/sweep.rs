//! `asperity sweep`: equilibria at a list of loads, as a table.

use std::path::PathBuf;

use asperity::contact::ContactStatistics;
use asperity::stability::ContactStiffness;
use asperity::{Control, Error, Problem, Report, Solver, Status, Surface, Sweep};
use clap::{ArgGroup, Args, ValueEnum};
use ndarray::Array2;
use serde_json::{Map, Value, json};

use crate::adhesion::{Adhesion, AdhesionOptions};
use crate::boundary::{LOADS, LoadsOptions};
use crate::columns::{OUTCOME, STATE, STIFFNESS, outcome, state, stiffness};
use crate::csv;
use crate::identity::{Identity, identity};
use crate::journal::Row;
use crate::kept::Kept;
use crate::options::{Given, Precision, ProblemOptions, Scalar, SolverOptions, SurfaceOptions};
use crate::outcome::Outcome;
use crate::pictures::PlotOptions;
use crate::printing::Printing;
use crate::scene::Scene;
use crate::table::{self, Table, TableOptions};
use crate::warnings::{Strictness, Warnings};

/// Solve a contact problem under many loads, one after the other.
///
/// Each load starts from where the ones before lead. A row for each is appended to the file as it comes, with the
/// loads, the mean gap, the contact area and its statistics, the energies, and how the solve ended; contact_fraction
/// counts nodes, corrected_contact_fraction takes off what they count too much along the edge of the contact, and
/// clusters are in nodes. The same command again goes on where an interrupted one was, or with loads that were added
/// to the end of the list, and comes to the same file, byte for byte; for that it keeps FILE.state.npz beside the
/// file, which may be deleted at the end. FILE.scene.toml beside it repeats or continues the sweep by asperity run.
/// Exits with 0 if all rows converged, 2 if not (they are written all the same), and 1 if the input is refused or the
/// file cannot be written.
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("loads").required(true).args(LOADS)))]
pub struct Options {
    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    loads: LoadsOptions,

    #[command(flatten)]
    adhesion: AdhesionOptions,
    #[command(flatten)]
    solver: SolverOptions,

    /// File for the rows, .csv or .jsonl (one JSON object per line)
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: PathBuf,
    /// Format of the file, whatever its name is
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Folder for the fields, made if needed: gap-0001.npy, pressure-0001.npy, contact_pressure-0001.npy and so on
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    fields: Option<PathBuf>,
    #[command(flatten)]
    plot: PlotOptions,
    /// Find the contact stiffness under each load, in two more columns: contact_stiffness, how much the mean pressure
    /// grows with the approach, and normal_stiffness, how much the force does
    #[arg(long, help_heading = "Output")]
    stiffness: bool,
    /// Start over, and replace files that are there
    #[arg(long, help_heading = "Output")]
    force: bool,
    #[command(flatten)]
    strictness: Strictness,
    #[command(flatten)]
    printing: Printing,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  Contact area against load, twenty loads over two decades:
    asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --out area.csv \\
      --plot area.pdf
  Approach and withdrawal with adhesion, eleven mean gaps each:
    asperity sweep --heights heights.npy --law exponential --work-of-adhesion 1e-4 \\
      --range 4e-3 --mean-gaps 0.05:0.03:11,0.03:0.05:11 --out hysteresis.jsonl";

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Format {
    Csv,
    Jsonl,
}

/// The names of the columns, with the contact stiffness or without.
fn names(stiffness: bool) -> Vec<&'static str> {
    [&STATE[..], &OUTCOME[..], if stiffness { &STIFFNESS[..] } else { &[] }].concat()
}

/// Runs the command; whether all rows converged.
pub fn run(options: &Options, scene: &Scene) -> Outcome<bool> {
    options.format()?;
    options.plot.check(&options.out, options.force)?;
    options.surface.beyond.boundary.check(options.loads.control(0.0))?;
    let given = options.table().problem.read()?;
    match options.solver.precision {
        Precision::F32 => options.run::<f32>(given, scene),
        Precision::F64 => options.run::<f64>(given, scene),
    }
}

impl Options {
    fn run<T: Scalar>(&self, Given { surface, adhesion, unit, start }: Given<'_>, scene: &Scene) -> Outcome<bool> {
        let loads = self.loads.values();
        if let Some(&value) = loads.iter().find(|&&load| !T::lit(load).is_finite()) {
            let (name, requirement) = ("load", "finite in the precision of the fields");
            return Err(Error::Value { name, value, requirement }.into());
        }
        let warnings = Warnings::of_input::<T>(self.strictness, &surface, &adhesion, self.table().problem)?;
        let grid = *surface.grid();
        let identity = self.identity(&surface, &adhesion, start.as_ref());
        let start = start.or_else(|| self.surface.beyond.boundary.start_afar(&surface, &self.loads.controls()));
        let operator = self.surface.beyond.boundary.half_space(grid, self.surface.modulus)?;
        let mut problem = Problem::new(&surface, operator, adhesion.law::<T>()?)?;
        drop(surface);
        let format = self.format()?;
        let header = if format == Format::Csv { names(self.stiffness).join(",") + "\n" } else { String::new() };
        let kept = Kept(self.fields.as_deref());
        kept.check(self.force || self.out.exists())?;
        let (mut table, saved) = Table::open(self.table(), scene, &header, identity, Some(loads), warnings)?;
        let done = table.rows();
        let controls = self.loads.controls();

        let law = adhesion.law::<T>()?;
        let mut solver = Solver { settings: self.solver.settings(), constraint: self.adhesion.wall };
        let first = done.saturating_sub(saved.fields.len());
        let history = controls[first..done].iter().copied().zip(saved.fields.into_iter().map(T::field)).collect();
        let mut sweep = Sweep::new(&mut solver, &mut problem, controls[done..].iter().copied()).continuing(history);
        if let (0, Some(start)) = (done, start) {
            sweep = sweep.starting_from(T::field(start));
        }
        let (count, width) = (loads.len(), loads.len().to_string().len());
        for (k, &load) in loads.iter().enumerate().skip(done) {
            let name = format!("{}/{count}", k + 1);
            let step = table.observed(&name, grid.nodes(), |observe| sweep.next_observed(observe));
            let Some(step) = step else { break };
            let (control, solution) = step?;
            table.check(&solution)?;
            let statistics = ContactStatistics::of(&solution, &grid, &law)?;
            let mut row = row(control, &solution.report, &statistics);
            if self.stiffness {
                let (problem, tolerance) = (sweep.problem(), ContactStiffness::TOLERANCE);
                let found = ContactStiffness::of_constrained(problem, &self.adhesion.wall, &solution, tolerance)?;
                row.extend(stiffness(&found).map(|(name, value)| (name.to_owned(), value)));
            }
            let text = match format {
                Format::Csv => csv::line(&row),
                Format::Jsonl => Value::Object(row).to_string(),
            };
            kept.write(k + 1, &solution)?;
            let fields: Vec<_> = sweep.history().iter().map(|(_, gap)| gap.view()).collect();
            let converged = solution.report.status == Status::Converged;
            table.append(&Row { text: &text, load, converged, fields: &fields, numbers: &[] })?;
            self.printing.say(&format!("{:>width$}/{count}  {}", k + 1, table::brief(&solution.report)));
        }
        let text = table.text()?;
        let names = names(self.stiffness);
        let rows = text.lines().skip(usize::from(format == Format::Csv)).map(|row| parsed(format, &names, row));
        self.plot.draw(&rows.collect::<Vec<_>>(), unit.as_deref())?;
        self.printing.say(&format!("{count} rows in {}", self.out.display()));
        self.printing.report(|| {
            let last = parsed(format, &names, text.lines().next_back().unwrap_or_default());
            table.report(
                "sweep",
                self.loads.control(0.0).name(),
                json!({ "spring_stiffness": self.loads.spring_stiffness(), "last": last }),
                &grid,
                unit.as_deref(),
            )
        });
        Ok(table.converged("use a larger --tolerance or finer steps, or less tension where they are detached"))
    }

    fn table(&self) -> TableOptions<'_> {
        let problem = ProblemOptions { surface: &self.surface, adhesion: &self.adhesion, solver: &self.solver };
        let &Self { ref out, force, printing, .. } = self;
        TableOptions { problem, out, force, printing }
    }

    fn format(&self) -> Outcome<Format> {
        let extension = self.out.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match (self.format, extension.as_deref()) {
            (Some(format), _) => Ok(format),
            (None, Some("csv")) => Ok(Format::Csv),
            (None, Some("jsonl")) => Ok(Format::Jsonl),
            _ => Err(Error::file(&self.out, "does not end in .csv or .jsonl: rename it, or give --format").into()),
        }
    }

    /// The inputs on which the rows depend beside the loads.
    fn identity(&self, surface: &Surface, adhesion: &Adhesion<'_>, start: Option<&Array2<f64>>) -> Identity {
        let mut identity = identity(self.table().problem, surface, adhesion, start);
        let csv = self.format().is_ok_and(|format| format == Format::Csv);
        identity.insert("control".to_owned(), self.loads.kind().into());
        identity.insert("fields".to_owned(), if self.fields.is_some() { "kept" } else { "not kept" }.into());
        identity.insert("stiffness".to_owned(), if self.stiffness { "found" } else { "not found" }.into());
        identity.insert("format".to_owned(), if csv { "csv" } else { "jsonl" }.into());
        identity
    }
}

/// A row of the file.
fn parsed(format: Format, names: &[&'static str], row: &str) -> Value {
    match format {
        Format::Csv => csv::parsed(names, row),
        Format::Jsonl => serde_json::from_str(row).unwrap_or_default(),
    }
}

/// The content of a row, by the names of the columns. Nothing in it depends on the clock.
fn row(control: Control, report: &Report, statistics: &ContactStatistics) -> Map<String, Value> {
    let cells = state(control, report, statistics).chain(outcome(report));
    cells.map(|(name, value)| (name.to_owned(), value)).collect()
}
