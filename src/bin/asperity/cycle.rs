//! `asperity cycle`: a path of equilibria through loading and unloading, with its jumps.

use std::ops::ControlFlow;
use std::path::PathBuf;

use asperity::path::{Event, Path, PathCheckpoint, PathSettings, PathStep};
use asperity::picture::Chart;
use asperity::{Control, Error, Problem, Solver, Status, Surface, Westergaard};
use clap::{ArgGroup, Args};
use ndarray::Array2;
use serde_json::{Map, Value, json};

use crate::echo::Echo;
use crate::inputs;
use crate::journal::{Identity, Journal};
use crate::loads::{self, Loads};
use crate::numbers::Style;
use crate::options::{self, AdhesionOptions, Precision, SolverOptions, SurfaceOptions};
use crate::output::OutputFile;
use crate::printing::Printing;
use crate::progress::Progress;
use crate::run::{self, Scalar};
use crate::sweep::{cell, identity, line, name_and_value, parsed};
use crate::warnings::{Strictness, Warnings};
use crate::{Outcome, say};

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
pub fn run(options: &Options, echo: &Echo) -> Outcome<bool> {
    options.adhesion.check()?;
    options.check_files()?;
    let (surface, unit) = options.surface.surface_and_unit()?;
    let start = options.solver.start(surface.grid())?;
    let threads = run::use_threads(options.solver.threads)?;
    match options.solver.precision {
        Precision::F32 => options.run::<f32>(surface, start, unit, echo, threads),
        Precision::F64 => options.run::<f64>(surface, start, unit, echo, threads),
    }
}

impl Options {
    fn run<T: Scalar>(
        &self,
        surface: Surface,
        start: Option<Array2<f64>>,
        unit: Option<String>,
        echo: &Echo,
        threads: usize,
    ) -> Outcome<bool> {
        let loads = self.loads();
        if loads.len() < 2 {
            return Err("a cycle needs two turning points at least: give more loads, with commas between".into());
        }
        let mut warnings = Warnings::of_input::<T>(self.strictness, &surface, &self.surface, &self.adhesion)?;
        let (settings, grid) = (self.solver.settings(), *surface.grid());
        let identity = self.identity(&surface, start.as_ref());
        let operator = Westergaard::new(grid, self.surface.modulus)?;
        let mut problem = Problem::new(&surface, operator, self.adhesion.law::<T>()?)?;
        drop(surface);
        let mut solver = Solver::new(settings);
        let path_settings = PathSettings {
            steps: self.steps,
            smallest_step: self.smallest_step,
            imbalance: self.imbalance,
            smooth: !self.sharp,
        };
        let mut path = Path::new(&mut solver, &mut problem, loads, path_settings)?;
        let header = COLUMNS.join(",") + "\n";
        echo.check_beside(&self.out, self.force || self.out.exists())?;
        let scene = echo.written_beside(&self.out)?;
        let (mut journal, fields) = Journal::open_endless(&self.out, &header, identity, self.force)?;
        scene.commit()?;
        warnings.say();
        let narrow = |gap: Array2<f64>| gap.mapv_into_any(T::lit);
        if journal.rows() > 0 {
            self.printing.say(&format!("{} has {} rows already", self.out.display(), journal.rows()));
            let fields = fields.into_iter().map(narrow).collect();
            path = path.continuing(PathCheckpoint { numbers: journal.numbers().to_vec(), fields })?;
        } else if let Some(start) = start {
            path = path.starting_from(narrow(start));
        }
        loop {
            let name = format!("{}", journal.rows() + 1);
            let mut progress =
                Progress::new(&name, settings.tolerance_in::<T>(), grid.nodes(), self.printing.without_bars());
            let step = path.next_observed(|state| {
                progress.update(state);
                ControlFlow::Continue(())
            });
            drop(progress);
            let Some(step) = step else { break };
            let step = step?;
            run::check_finite(&step.solution)?;
            warnings.look_at(&step.solution, self.surface.modulus)?;
            let row = row(&step);
            let text = row.iter().map(|(_, value)| cell(value)).collect::<Vec<_>>().join(",");
            let checkpoint = path.checkpoint();
            let fields: Vec<_> = checkpoint.fields.iter().map(|field| field.view()).collect();
            let report = &step.solution.report;
            journal.append_endless(&text, report.status == Status::Converged, &fields, &checkpoint.numbers)?;
            let event = step.event.map_or(String::new(), |event| format!("  {event}"));
            self.printing.say(&format!("{:>4}  {}{event}", journal.rows(), line(report)));
        }
        drop(path);
        let unit = self.length_unit.as_deref().or(unit.as_deref());
        let inputs = inputs::inputs(&self.surface, &self.adhesion, &self.solver, &grid, unit, threads);
        self.conclude(&journal, unit, inputs, &warnings)?;
        journal.warn_of_unconverged("or use a larger --tolerance");
        Ok(journal.unconverged() == 0)
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

    /// All that the rows depend on.
    fn identity(&self, surface: &Surface, start: Option<&Array2<f64>>) -> Identity {
        let mut identity = identity(&self.surface, &self.adhesion, &self.solver, surface, start);
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

    /// Says what the cycle comes to, by all of its rows, and draws it.
    fn conclude(
        &self,
        journal: &Journal,
        unit: Option<&str>,
        inputs: Map<String, Value>,
        warnings: &Warnings,
    ) -> Outcome<()> {
        let text = journal.text()?;
        let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|row| row.split(',').collect()).collect();
        let column = |name: &str| COLUMNS.iter().position(|column| *column == name).unwrap_or_default();
        let number =
            |row: &[&str], name: &str| row.get(column(name)).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
        let least = rows.iter().map(|row| number(row, "mean_pressure")).fold(f64::INFINITY, f64::min);
        let event = |row: &[&str]| row.get(column("event")).copied().unwrap_or_default().to_owned();
        self.printing.report(|| {
            let rows: Vec<_> = text.lines().skip(1).map(|row| parsed(&COLUMNS, row)).collect();
            let last = rows.last().cloned().unwrap_or_default();
            let events = rows.iter().filter(|row| !row["event"].is_null());
            let brief = |row: &Value| {
                let kept = ["leg", "control_value", "mean_gap", "mean_pressure", "event", "energy_drop"];
                kept.iter().map(|key| ((*key).to_owned(), row[key].clone())).collect::<Value>()
            };
            let outcome = json!({
                "control": last["control"],
                "rows": journal.rows(),
                "unconverged": journal.unconverged(),
                "out": self.out.to_string_lossy(),
                "greatest_tension": (least < 0.0).then_some(-least),
                "events": events.map(brief).collect::<Vec<_>>(),
                "work": last["work"],
                "dissipated": last["dissipated"],
                "imbalance": last["imbalance"],
                "last": last,
                "warnings": warnings.report(),
            });
            inputs::report("cycle", outcome, inputs)
        });
        if self.printing.for_people() {
            let plain = |value| Style::Plain.number(value, "");
            say(&format!("{} rows in {}", journal.rows(), self.out.display()));
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
