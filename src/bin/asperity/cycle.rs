//! `asperity cycle`: a path of equilibria through loading and unloading, with its jumps.

use std::path::PathBuf;

use asperity::path::{Event, Path, PathCheckpoint, PathSettings, PathStep};
use asperity::picture::Chart;
use asperity::{Control, Error, Grid, Problem, Solver, Status, Surface, Westergaard};
use clap::{ArgGroup, Args};
use ndarray::Array2;
use serde_json::{Map, Value, json};

use crate::adhesion::{Adhesion, AdhesionOptions, Wall};
use crate::csv;
use crate::identity::{Identity, identity};
use crate::journal::Row;
use crate::loads::{self, Loads, name_and_value};
use crate::numbers::Style;
use crate::options::{self, Given, Precision, ProblemOptions, Scalar, SolverOptions, SurfaceOptions};
use crate::outcome::Outcome;
use crate::output::OutputFile;
use crate::printing::{Printing, say};
use crate::scene::Scene;
use crate::table::{self, Table, TableOptions};
use crate::warnings::{Strictness, Warnings};

/// Follow the contact along a cycle of approach and withdrawal, and find its jumps.
///
/// The loads are the turning points: the first is the start, and from each to the next the tool goes in steps that
/// adapt themselves. Where the state jumps, the step is halved down to a given share of the way, so that the jump is
/// located and its energy known. Under given pressures it goes on at given mean gaps past the limit points, where
/// there is no equilibrium close by. A row for each state is appended to the file as it comes, with the loads, the
/// contact, the energies per area, the work done by the load so far, the energy dissipated in jumps so far, what is
/// missing from the balance of the two, and what happened on the way: jump-in, jump-out, pull-off, limit-point,
/// bifurcation. The same command again goes on where an interrupted one was; for that it keeps FILE.state.npz beside
/// the file, which may be deleted at the end. FILE.scene.toml beside it repeats or continues the cycle by asperity
/// run. Exits with 0 if all rows converged, 2 if not, and 1 if the input is refused or a file cannot be written.
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("loads").required(true).args(["mean_gaps", "mean_pressures"])))]
pub struct Options {
    #[command(flatten)]
    surface: SurfaceOptions,

    /// Mean gaps at the turning points, lengths, with commas between; at least two
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = loads::gaps, help_heading = "Loads")]
    mean_gaps: Option<Loads>,
    /// Mean external pressures at the turning points, compression positive; at least two
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = loads::pressures, help_heading = "Loads")]
    mean_pressures: Option<Loads>,
    /// Least number of steps from one turning point to the next
    #[arg(long, value_name = "N", default_value_t = 50, allow_hyphen_values = true, help_heading = "Loads")]
    steps: usize,
    /// Step to which jumps are located, as a share of the way from one turning point to the next
    #[arg(long, value_name = "SHARE", default_value = "1e-4", allow_hyphen_values = true, value_parser = options::positive)]
    #[arg(help_heading = "Loads")]
    smallest_step: f64,
    /// Imbalance of energy that a step may have, as a share of how much the energy has changed
    #[arg(long, value_name = "SHARE", default_value = "1e-4", allow_hyphen_values = true, value_parser = options::positive)]
    #[arg(help_heading = "Loads")]
    imbalance: f64,
    /// Do not smooth a law whose traction jumps: the grid then holds the edge of the adhesive zone back
    #[arg(long, help_heading = "Adhesion")]
    sharp: bool,

    #[command(flatten)]
    adhesion: AdhesionOptions,
    #[command(flatten)]
    solver: SolverOptions,

    /// File for the rows, .csv
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: PathBuf,
    /// File for a picture of the mean pressure over the mean gap, .png
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    plot: Option<PathBuf>,
    /// Unit of the lengths, on the picture only; m gets prefixes
    #[arg(long, value_name = "UNIT", help_heading = "Output")]
    length_unit: Option<String>,
    /// Unit of the pressures, on the picture only; Pa gets prefixes
    #[arg(long, value_name = "UNIT", help_heading = "Output")]
    pressure_unit: Option<String>,
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
  Approach and withdrawal of a map of 1 by 1, with a picture of the loop:
    asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \\
      --range 4e-3 --mean-gaps 0.05,0.02,0.05 --out cycle.csv --plot cycle.png
  Press, and pull until it comes off:
    asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \\
      --range 4e-3 --mean-pressures 0.02,-1 --out pull-off.csv";

/// The number of events that are printed at the end.
const MOST_EVENTS: usize = 8;

/// The names of the columns, in the order of [`row`].
const COLUMNS: [&str; 18] = [
    "leg",
    "control",
    "control_value",
    "mean_gap",
    "mean_pressure",
    "mean_contact_pressure",
    "contact_fraction",
    "elastic_energy",
    "adhesive_energy",
    "work",
    "dissipated",
    "imbalance",
    "event",
    "energy_drop",
    "relative_error",
    "iterations",
    "operator_applications",
    "status",
];

/// Runs the command; whether all rows converged.
pub fn run(options: &Options, scene: &Scene) -> Outcome<bool> {
    options.check_files()?;
    if options.adhesion.wall == Wall::None {
        return Err("a cycle needs a wall: give --wall hard, or follow the loads by asperity sweep".into());
    }
    let given = options.table().problem.read()?;
    match options.solver.precision {
        Precision::F32 => options.run::<f32>(given, scene),
        Precision::F64 => options.run::<f64>(given, scene),
    }
}

impl Options {
    fn run<T: Scalar>(&self, Given { surface, adhesion, unit, start }: Given<'_>, scene: &Scene) -> Outcome<bool> {
        let loads = self.loads();
        if loads.len() < 2 {
            return Err("a cycle needs two turning points at least: give more loads, with commas between".into());
        }
        let warnings = Warnings::of_input::<T>(self.strictness, &surface, &adhesion, self.table().problem)?;
        let grid = *surface.grid();
        let identity = self.identity(&surface, &adhesion, start.as_ref());
        let operator = Westergaard::new(grid, self.surface.modulus)?;
        let mut problem = Problem::new(&surface, operator, adhesion.law::<T>()?)?;
        drop(surface);
        let mut solver = Solver::new(self.solver.settings());
        let settings = PathSettings {
            steps: self.steps,
            smallest_step: self.smallest_step,
            imbalance: self.imbalance,
            smooth: !self.sharp,
        };
        let mut path = Path::new(&mut solver, &mut problem, loads, settings)?;
        let header = COLUMNS.join(",") + "\n";
        let (mut table, saved) = Table::open(self.table(), scene, &header, identity, None, warnings)?;
        if table.rows() > 0 {
            let fields = saved.fields.into_iter().map(T::field).collect();
            path = path.continuing(PathCheckpoint { numbers: saved.numbers, fields })?;
        } else if let Some(start) = start {
            path = path.starting_from(T::field(start));
        }
        loop {
            let name = (table.rows() + 1).to_string();
            let step = table.observed(&name, grid.nodes(), |observe| path.next_observed(observe));
            let Some(step) = step else { break };
            let step = step?;
            table.check(&step.solution)?;
            let (row, checkpoint) = (row(&step), path.checkpoint());
            let fields: Vec<_> = checkpoint.fields.iter().map(|field| field.view()).collect();
            let (report, (_, load)) = (&step.solution.report, name_and_value(step.control));
            let (text, converged) = (csv::line(&row), report.status == Status::Converged);
            table.append(&Row { text: &text, load, converged, fields: &fields, numbers: &checkpoint.numbers })?;
            let event = step.event.map_or(String::new(), |event| format!("  {event}"));
            self.printing.say(&format!("{:>4}  {}{event}", table.rows(), table::brief(report)));
        }
        drop(path);
        self.conclude(&table, self.length_unit.as_deref().or(unit.as_deref()), &grid)?;
        Ok(table.converged("or use a larger --tolerance"))
    }

    fn table(&self) -> TableOptions<'_> {
        let problem = ProblemOptions { surface: &self.surface, adhesion: &self.adhesion, solver: &self.solver };
        let &Self { ref out, force, printing, .. } = self;
        TableOptions { problem, out, force, printing }
    }

    fn loads(&self) -> Vec<Control> {
        match (&self.mean_gaps, &self.mean_pressures) {
            (Some(Loads(gaps)), _) => gaps.iter().copied().map(Control::MeanGap).collect(),
            (None, Some(Loads(pressures))) => pressures.iter().copied().map(Control::MeanPressure).collect(),
            (None, None) => Vec::new(),
        }
    }

    fn check_files(&self) -> Outcome<()> {
        let ends =
            |path: &std::path::Path, with: &str| path.extension().is_some_and(|end| end.eq_ignore_ascii_case(with));
        if !ends(&self.out, "csv") {
            return Err(Error::file(&self.out, "does not end in .csv: rename it").into());
        }
        let Some(plot) = &self.plot else { return Ok(()) };
        if !ends(plot, "png") {
            return Err(Error::file(plot, "does not end in .png: rename it").into());
        }
        if plot.exists() && !self.out.exists() && !self.force {
            return Err(Error::file(plot, "exists: use --force to replace it, or choose another --plot").into());
        }
        Ok(())
    }

    /// The inputs on which the rows depend.
    fn identity(&self, surface: &Surface, adhesion: &Adhesion<'_>, start: Option<&Array2<f64>>) -> Identity {
        let mut identity = identity(self.table().problem, surface, adhesion, start);
        let loads = self.loads();
        let control = loads.first().map_or("none", |load| name_and_value(*load).0);
        let values: Vec<_> = loads.iter().map(|load| name_and_value(*load).1).collect();
        identity.insert("control".to_owned(), control.into());
        let values: Vec<_> = values.iter().map(f64::to_string).collect();
        identity.insert("loads".to_owned(), values.join(" ").into());
        for (name, value) in [
            ("steps", self.steps.to_string()),
            ("smallest_step", self.smallest_step.to_string()),
            ("imbalance", self.imbalance.to_string()),
            ("sharp", self.sharp.to_string()),
        ] {
            identity.insert(name.to_owned(), value.into());
        }
        identity
    }

    /// Prints the summary or the report of all rows, and draws the picture.
    fn conclude(&self, table: &Table<'_>, unit: Option<&str>, grid: &Grid) -> Outcome<()> {
        let text = table.text()?;
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|row| row.split(',').collect()).collect();
        let column = |name: &str| COLUMNS.iter().position(|column| *column == name).unwrap_or_default();
        let number =
            |row: &[&str], name: &str| row.get(column(name)).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
        let least = rows.iter().map(|row| number(row, "mean_pressure")).fold(f64::INFINITY, f64::min);
        let event = |row: &[&str]| row.get(column("event")).copied().unwrap_or_default().to_owned();
        self.printing.report(|| {
            let rows: Vec<_> = text.lines().skip(1).map(|row| csv::parsed(&COLUMNS, row)).collect();
            let last = rows.last().cloned().unwrap_or_default();
            let events = rows.iter().filter(|row| !row["event"].is_null());
            let brief = |row: &Value| {
                let kept = ["leg", "control_value", "mean_gap", "mean_pressure", "event", "energy_drop"];
                kept.iter().map(|key| ((*key).to_owned(), row[key].clone())).collect::<Value>()
            };
            let control = last["control"].as_str().unwrap_or_default();
            let found = json!({
                "greatest_tension": (least < 0.0).then_some(-least),
                "events": events.map(brief).collect::<Vec<_>>(),
                "work": last["work"],
                "dissipated": last["dissipated"],
                "imbalance": last["imbalance"],
                "last": last,
            });
            table.report("cycle", control, found, grid, unit)
        });
        if self.printing.for_people() {
            let plain = |value| Style::Plain.number(value, "");
            say(&format!("{} rows in {}", table.rows(), self.out.display()));
            if least < 0.0 {
                say(&format!("greatest tension        {}", plain(-least)));
            }
            let mut events: Vec<_> = rows.iter().filter(|row| !event(row).is_empty()).collect();
            let count = events.len();
            // limit points first, which dissipate nothing
            events.sort_by(|a, b| number(b, "energy_drop").total_cmp(&number(a, "energy_drop")));
            for row in events.iter().take(MOST_EVENTS) {
                let drop = match number(row, "energy_drop") {
                    drop if drop.is_nan() => String::new(),
                    drop => format!(", energy drop {}", plain(drop)),
                };
                say(&format!("{:<23} to mean gap {}{drop}", event(row), plain(number(row, "mean_gap"))));
            }
            if count > MOST_EVENTS {
                say(&format!("and {} smaller events", count - MOST_EVENTS));
            }
            if let Some(last) = rows.last() {
                say(&format!("dissipated in jumps     {}", plain(number(last, "dissipated"))));
                say(&format!("work done by the load   {}", plain(number(last, "work"))));
                say(&format!("missing from balance    {:.1e}", number(last, "imbalance")));
            }
        }
        let Some(plot) = &self.plot else { return Ok(()) };
        let legs = self.loads().len() - 1;
        let mut curves = Vec::new();
        for leg in 1..=legs {
            let on = |row: &&Vec<&str>| number(row, "leg") == leg as f64;
            let points = rows.iter().filter(on).map(|row| (number(row, "mean_gap"), number(row, "mean_pressure")));
            let before = rows.iter().rfind(|row| number(row, "leg") < leg as f64);
            let before = before.map(|row| (number(row, "mean_gap"), number(row, "mean_pressure")));
            curves.push((leg, before.into_iter().chain(points).collect()));
        }
        let names: Vec<_> = curves.iter().map(|(leg, _)| format!("leg {leg}")).collect();
        let chart = Chart {
            title: "Mean pressure over mean gap",
            x_label: "mean gap",
            x_unit: unit,
            y_label: "mean pressure",
            y_unit: self.pressure_unit.as_deref(),
            curves: names.iter().map(String::as_str).zip(curves.into_iter().map(|(_, points)| points)).collect(),
            ..Chart::default()
        };
        let file = OutputFile::create(plot, true)?;
        file.write(|path| chart.write_png(path))?;
        Ok(file.commit()?)
    }
}

/// The content of a row, by the names of the columns. Nothing in it depends on the clock.
fn row<T>(step: &PathStep<T>) -> Map<String, Value> {
    let (control, value) = name_and_value(step.control);
    let report = &step.solution.report;
    let drop = step.event.as_ref().and_then(Event::jump).map_or(Value::Null, |jump| jump.energy_drop.into());
    let values: [Value; COLUMNS.len()] = [
        step.leg.into(),
        control.into(),
        value.into(),
        report.mean_gap.into(),
        report.mean_pressure.into(),
        report.mean_contact_pressure.into(),
        report.contact_fraction.into(),
        report.elastic_energy.into(),
        report.adhesive_energy.into(),
        step.work.into(),
        step.dissipated.into(),
        step.imbalance.into(),
        step.event.as_ref().map_or(Value::Null, |event| event.name().into()),
        drop,
        report.relative_error.into(),
        report.iterations.into(),
        report.operator_applications.into(),
        report.status.name().into(),
    ];
    COLUMNS.iter().map(|name| (*name).to_owned()).zip(values).collect()
}
