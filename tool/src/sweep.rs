//! `asperity sweep`: equilibria at a list of loads, as a table.

use std::path::PathBuf;
use std::sync::Arc;

use asperity::{Control, Error, Status, Surface};
use asperity_scene::{Boundary, Course, Way};
use clap::{ArgGroup, Args, ValueEnum};
use ndarray::ArrayRef2;
use serde_json::{Map, Value, json};

use crate::adhesion::{Adhesion, AdhesionOptions};
use crate::boundary::{FractionsOptions, LOADS, LoadsOptions, check_load};
use crate::csv;
use crate::identity::{Identity, identity};
use crate::options::{Given, Precision, ProblemOptions, Scalar, SolverOptions, SurfaceOptions};
use crate::outcome::Outcome;
use crate::pictures::PlotOptions;
use crate::printing::{Printing, complain, name};
use crate::processes::Processes;
use crate::scene::Scene;
use crate::table::{self, Table, TableOptions};
use crate::units::{UnitOptions, header};
use crate::warnings::Strictness;

/// Solve a contact problem under many loads, one after the other.
///
/// Each load starts from the solutions under the loads before it. Numbers may have units, all of them or none, as in
/// asperity solve. Each load gives a row of the file: the load, the mean gap, the contact area and its statistics, the
/// energies, and how the solve ended. contact_fraction counts nodes in contact; corrected_contact_fraction is the area
/// within the contact edge, which gap and pressure locate between the nodes; clusters counts separate contacts, and
/// largest_cluster the nodes of the largest. The same command again continues an interrupted sweep, or one with loads
/// added to the end of the list, to the same file, byte for byte; for that it keeps FILE.state.npz beside the file,
/// which may be deleted at the end. FILE.scene.toml beside it repeats or continues the sweep by asperity run. Exits
/// with 0 if all rows converged, 2 if not (they are written all the same), and 1 if the input is refused or the file
/// cannot be written.
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("loads").required(true).args(LOADS).arg("contact_fractions")))]
pub struct Options {
    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    loads: LoadsOptions,
    #[command(flatten)]
    fractions: FractionsOptions,

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
    #[command(flatten)]
    units: UnitOptions,
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
  Contact area and stiffness against load, twenty loads over two decades:
    asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --stiffness \\
      --out area.csv --plot area.pdf
  With units; rows and header are in the SI then:
    asperity sweep --heights heights.npy --lengths 20um --modulus 70GPa \\
      --mean-pressures 1MPa:1GPa:12:log --out steel.csv
  Approach and withdrawal with adhesion, eleven mean gaps each:
    asperity sweep --heights heights.npy --law exponential --work-of-adhesion 1e-4 \\
      --range 4e-3 --mean-gaps 0.05:0.03:11,0.03:0.05:11 --out hysteresis.jsonl";

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Format {
    Csv,
    Jsonl,
}

/// Runs the command; whether all rows converged.
pub fn run(options: &Options, scene: &Scene, processes: &Processes) -> Outcome<bool> {
    options.format()?;
    processes.first(|| options.plot.check(&options.out, options.force))?;
    options.solver.check_table()?;
    check_load(options.surface.beyond.boundary, options.loads.control(0.0))?;
    let given = options.problem().read(scene.is_si(), processes)?;
    match options.solver.precision {
        Precision::F32 => options.run::<f32>(given, scene, processes),
        Precision::F64 => options.run::<f64>(given, scene, processes),
    }
}

impl Options {
    fn run<T: Scalar>(&self, given: Given<'_>, scene: &Scene, processes: &Processes) -> Outcome<bool> {
        let Given { surface, adhesion, origin, part, start } = given;
        let listed = self.loads.values(self.surface.full_pressure(&surface, self.loads.are_reduced())?);
        let loads = self.fractions.values().unwrap_or(&listed);
        part.check(self.control())?;
        if let Some(&value) = loads.iter().find(|&&load| !T::lit(load).is_finite()) {
            let (name, requirement) = ("load", "finite in the precision of the fields");
            return Err(Error::Value { name, value, requirement }.into());
        }
        let grid = *surface.grid();
        let units = processes.agree(self.units.units(origin.unit.as_deref(), scene.is_si()))?;
        let format = self.format()?;
        let control = self.control().name();
        let controls = self.loads.controls(&listed);
        let way = match self.fractions.values() {
            Some(fractions) => Way::Search(fractions.to_vec()),
            None => Way::Sweep(controls.clone()),
        };
        let course = Course::new(way, self.stiffness);
        let names = course.columns();
        let header = match format {
            Format::Csv => header(&units, &names, control, grid.is_line()),
            Format::Jsonl => String::new(),
        };
        let &Self { ref out, force, printing, strictness, .. } = self;
        let (fields, units) = (self.fields.as_deref(), &units);
        let (problem, part, surface) = (self.problem(), &part, Arc::new(surface));
        let mut posed = problem.posed::<T>(surface.clone(), adhesion.law(), part)?;
        let nodes = *posed.parts()?.1.operator().grid();
        let options =
            TableOptions { problem, out, force, printing, scene, units, part, strictness, fields, processes, nodes };
        let identity =
            |surface: &_, adhesion: &Adhesion<'_>, start: Option<&_>| self.identity(surface, adhesion, start);
        let given = (&*surface, &origin, &adhesion, start.as_ref());
        let (mut table, saved) = Table::open::<T>(options, &header, given, identity, Some(loads))?;
        let start = start.or_else(|| problem.start_afar(&surface, &controls));
        drop(surface);

        let mut course = table.course(course, saved, &Value::Null, start);
        let (count, width) = (loads.len(), loads.len().to_string().len());
        while table.rows() < count {
            let line = |row: &Map<_, _>| match format {
                Format::Csv => csv::line(row),
                Format::Jsonl => json!(row).to_string(),
            };
            let Some(row) = table.extend(&mut course, &mut posed, origin.seed, line)? else { break };
            let (rows, account) = (table.rows(), &row.account);
            self.printing.say(&format!("{rows:>width$}/{count}  {}", table::brief(account, units)));
            let converged = account.status == Status::Converged;
            if let Some(searched) = account.search.filter(|searched| converged && !searched.reached) {
                complain("warning", &format!("row {rows}: {}", searched.jump()));
            }
        }
        let text = table.text()?;
        let rows = text.lines().skip(usize::from(format == Format::Csv)).map(|row| parsed(format, &names, row));
        processes.first(|| self.plot.draw(&rows.collect::<Vec<_>>(), units))?;
        self.printing.say(&format!("{count} rows in {}", name(&self.out)));
        self.printing.report(|| {
            let last = parsed(format, &names, text.lines().next_back().unwrap_or_default());
            table.report("sweep", control, json!({ "spring_stiffness": self.loads.spring_stiffness(), "last": last }))
        });
        Ok(table.converged(match self.fractions.values() {
            Some(_) => "or leave out the contact fractions past which the contact jumps",
            None => "use a larger --tolerance or finer steps, or less tension where they are detached",
        }))
    }

    /// The load of the rows, of no meaning but for its kind; a contact fraction is searched for by one of these.
    fn control(&self) -> Control {
        match (self.fractions.values(), self.adhesion.adheres(), self.surface.beyond.boundary) {
            (None, _, _) => self.loads.control(0.0),
            (Some(_), false, _) => Control::MeanPressure(0.0),
            (Some(_), _, Boundary::Periodic) => Control::MeanGap(0.0),
            (Some(_), _, Boundary::Free) => Control::Approach(0.0),
        }
    }

    fn problem(&self) -> ProblemOptions<'_> {
        ProblemOptions { surface: &self.surface, adhesion: &self.adhesion, solver: &self.solver }
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
    fn identity(&self, surface: &Surface, adhesion: &Adhesion<'_>, start: Option<&ArrayRef2<f64>>) -> Identity {
        let mut identity = identity(self.problem(), surface, adhesion, start);
        let csv = self.format().is_ok_and(|format| format == Format::Csv);
        let kind = if self.fractions.values().is_some() { "contact-fraction".to_owned() } else { self.loads.kind() };
        identity.insert("control".to_owned(), kind.into());
        identity.insert("fields".to_owned(), if self.fields.is_some() { "kept" } else { "left out" }.into());
        identity.insert("stiffness".to_owned(), if self.stiffness { "asked for" } else { "left out" }.into());
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
