//! `asperity cycle`: a path of equilibria through loading and unloading, with its jumps.

use std::path::PathBuf;
use std::sync::Arc;

use asperity::path::PathSettings;
use asperity::{Error, Surface};
use asperity_scene::{Boundary, Course, Way};
use clap::{ArgGroup, Args};
use ndarray::ArrayRef2;
use serde_json::{Map, Value, json};

use crate::adhesion::{Adhesion, AdhesionOptions};
use crate::allowed::positive;
use crate::boundary::{LOADS, LoadsOptions, check_load};
use crate::csv;
use crate::identity::{Identity, identity};
use crate::options::{Given, Precision, ProblemOptions, Scalar, SolverOptions, SurfaceOptions};
use crate::outcome::Outcome;
use crate::pictures::{Resolution, chart_of_columns, check_plot, write_picture};
use crate::printing::{self, Printing, say};
use crate::processes::Processes;
use crate::quantity::{Dimension, ENERGY_PER_AREA, FORCE, LENGTH, PRESSURE};
use crate::scene::Scene;
use crate::table::{self, Table, TableOptions};
use crate::units::{UnitOptions, Units, header};
use crate::warnings::Strictness;

/// Follow the contact along a cycle of approach and withdrawal, and find its jumps.
///
/// Numbers may have units, all of them or none, as in asperity solve. The loads are the turning points, at least two:
/// the first is the start, and from each to the next the tool goes in adaptive steps, an approach or a withdrawal. A
/// withdrawal ends once the surfaces are apart, where they neither touch nor attract each other. Where the state jumps,
/// the step is halved down to a given share of the way, which locates the jump and the energy that it dissipates. A
/// limit point is the greatest or least load of a branch; a cycle along pressures or forces goes on beyond it at given
/// mean gaps (with a free boundary at given approaches). Each state gives a row of the file, with the columns of
/// asperity sweep, the work done by the load so far and the energy dissipated in jumps so far, per area, the imbalance
/// of energy, and the event on the way to it: jump-in, jump-out, pull-off, limit-point, bifurcation. The same command
/// again continues an interrupted cycle; for that it keeps FILE.state.npz beside the file, which may be deleted at the
/// end. FILE.scene.toml beside it repeats or continues the cycle by asperity run.
/// Exits with 0 if all rows converged, 2 if not, and 1 if the input is refused or a file cannot be written.
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("loads").required(true).args(LOADS)))]
pub struct Options {
    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    loads: LoadsOptions,
    /// Least number of steps from one turning point to the next
    #[arg(long, value_name = "N", default_value_t = 50, allow_hyphen_values = true, help_heading = "Loads")]
    steps: usize,
    /// Step to which jumps are located, as a share of the way from one turning point to the next
    #[arg(long, value_name = "SHARE", default_value = "1e-4", allow_hyphen_values = true, value_parser = positive)]
    #[arg(help_heading = "Loads")]
    smallest_step: f64,
    /// Imbalance of energy that a step may have, as a share of how much the energy has changed
    #[arg(long, value_name = "SHARE", default_value = "1e-4", allow_hyphen_values = true, value_parser = positive)]
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
    /// Folder for the fields at the jumps, made if needed: of the rows with an event, of those before them, and of the
    /// last row, gap-0001.npy, pressure-0001.npy, contact_pressure-0001.npy and so on
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    fields: Option<PathBuf>,
    /// File for a picture of the mean pressure over the mean gap, with a free boundary of the normal force over the
    /// approach, with jumps as dashed lines, .png, .svg or .pdf
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    resolution: Resolution,
    #[command(flatten)]
    units: UnitOptions,
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
      --range 4e-3 --mean-pressures 0.02,-1 --out pull-off.csv
  A tip on a free half-space, together from afar and apart again, with a picture of force over approach:
    asperity cycle --heights tip.npy --boundary free --law exponential --work-of-adhesion 1e-4 \\
      --range 4e-3 --approaches -0.03,0.01,-0.03 --out tip.csv --plot tip.png";

/// The number of events that are printed at the end.
const MOST_EVENTS: usize = 8;

/// Runs the command; whether all rows converged.
pub fn run(options: &Options, scene: &Scene, processes: &Processes) -> Outcome<bool> {
    processes.first(|| options.check_files())?;
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
        part.check(self.loads.control(0.0))?;
        let values = self.loads.values(self.surface.full_pressure(&surface, self.loads.are_reduced())?);
        let loads = self.loads.controls(&values);
        if loads.len() < 2 {
            return Err("a cycle needs two turning points at least: give more loads, with commas between".into());
        }
        let grid = *surface.grid();
        let units = processes.agree(self.units.units(origin.unit.as_deref(), scene.is_si()))?;
        let settings = PathSettings::default()
            .steps(self.steps)
            .smallest_step(self.smallest_step)
            .imbalance(self.imbalance)
            .smooth(!self.sharp);
        let course = Course::new(Way::Cycle(loads.clone(), settings), false);
        let names = course.columns();
        let header = header(&units, &names, self.loads.control(0.0).name(), grid.is_line());
        let &Self { ref out, force, printing, strictness, .. } = self;
        let (fields, units) = (self.fields.as_deref(), &units);
        let (problem, part, surface) = (self.problem(), &part, Arc::new(surface));
        let mut posed = problem.posed::<T>(surface.clone(), adhesion.law(), part)?;
        let nodes = *posed.parts()?.1.operator().grid();
        let options =
            TableOptions { problem, out, force, printing, scene, units, part, strictness, fields, processes, nodes };
        let identity =
            |surface: &_, adhesion: &Adhesion<'_>, start: Option<&_>| self.identity(surface, adhesion, start, &values);
        course.check(&mut posed)?;
        let given = (&*surface, &origin, &adhesion, start.as_ref());
        let (mut table, saved) = Table::open::<T>(options, &header, given, identity, None)?;
        let start = start.or_else(|| problem.start_afar(&surface, &loads));
        drop(surface);
        let last = csv::parsed(&names, table.text()?.lines().next_back().unwrap_or_default());
        let mut had_event = !last["event"].is_null();
        let mut course = table.course(course, saved, &last, start);
        while let Some(row) = table.extend(&mut course, &mut posed, origin.seed, csv::line)? {
            let event = row.step.and_then(|step| step.event);
            // the fields of a row stay where it or the next one has an event
            if !had_event && event.is_none() {
                table.forget(table.rows() - 1);
            }
            had_event = event.is_some();
            let event = event.map_or(String::new(), |event| format!("  {event}"));
            self.printing.say(&format!("{:>4}  {}{event}", table.rows(), table::brief(&row.account, units)));
        }
        self.conclude(&table, &names, units, processes)?;
        Ok(table.converged("or use a larger --tolerance"))
    }

    fn problem(&self) -> ProblemOptions<'_> {
        ProblemOptions { surface: &self.surface, adhesion: &self.adhesion, solver: &self.solver }
    }

    fn check_files(&self) -> Outcome<()> {
        let ends =
            |path: &std::path::Path, with: &str| path.extension().is_some_and(|end| end.eq_ignore_ascii_case(with));
        if !ends(&self.out, "csv") {
            return Err(Error::file(&self.out, "does not end in .csv: rename it").into());
        }
        check_plot(self.plot.as_deref(), &self.out, self.force)
    }

    /// The inputs on which the rows depend.
    fn identity(
        &self,
        surface: &Surface,
        adhesion: &Adhesion<'_>,
        start: Option<&ArrayRef2<f64>>,
        values: &[f64],
    ) -> Identity {
        let mut identity = identity(self.problem(), surface, adhesion, start);
        identity.insert("control".to_owned(), self.loads.kind().into());
        let values: Vec<_> = values.iter().map(f64::to_string).collect();
        identity.insert("loads".to_owned(), values.join(" ").into());
        for (name, value) in [
            ("steps", self.steps.to_string()),
            ("smallest_step", self.smallest_step.to_string()),
            ("imbalance", self.imbalance.to_string()),
            ("sharp", self.sharp.to_string()),
            ("fields", if self.fields.is_some() { "kept" } else { "left out" }.to_owned()),
        ] {
            identity.insert(name.to_owned(), value.into());
        }
        identity
    }

    /// Prints the summary or the report of all rows, and draws the picture.
    fn conclude(&self, table: &Table<'_>, names: &[&str], units: &Units, processes: &Processes) -> Outcome<()> {
        let text = table.text()?;
        let rows: Vec<_> = text.lines().skip(1).map(|row| csv::parsed(names, row)).collect();
        let number = |row: &Value, name: &str| row[name].as_f64().unwrap_or(f64::NAN);
        let least = |name: &str| rows.iter().map(|row| number(row, name)).fold(0.0, f64::min);
        let tension = -least("mean_pressure");
        // the largest jump first, and at the end limit points, which dissipate nothing
        let mut events: Vec<usize> = (0..rows.len()).filter(|&k| !rows[k]["event"].is_null()).collect();
        let drop = |k: usize| rows[k]["energy_drop"].as_f64().unwrap_or(f64::NEG_INFINITY);
        events.sort_by(|&a, &b| drop(b).total_cmp(&drop(a)));
        let free = self.surface.beyond.boundary == Boundary::Free;
        let (x, y) = if free { ("approach", "normal_force") } else { ("mean_gap", "mean_pressure") };
        let y_dimension = if free { FORCE } else { PRESSURE };
        self.printing.report(|| {
            let last = rows.last().cloned().unwrap_or_default();
            let event = |&k: &usize| {
                let kept = ["mean_gap", "mean_pressure", "normal_force", "approach"];
                let names = ["leg", "direction", "control_value", "event", "energy_drop"].iter().chain(&kept);
                let mut found: Map<_, _> = names.map(|name| ((*name).to_owned(), rows[k][*name].clone())).collect();
                if let Some(before) = k.checked_sub(1) {
                    let from = kept.iter().map(|name| ((*name).to_owned(), rows[before][*name].clone()));
                    found.insert("from".to_owned(), from.collect::<Value>());
                }
                Value::Object(found)
            };
            let found = json!({
                "spring_stiffness": self.loads.spring_stiffness(),
                "greatest_tension": (tension > 0.0).then_some(tension),
                "greatest_tensile_force": (tension > 0.0).then_some(-least("normal_force")),
                "events": events.iter().map(event).collect::<Vec<_>>(),
                "work": last["work"],
                "dissipated": last["dissipated"],
                "imbalance": last["imbalance"],
                "last": last,
            });
            table.report("cycle", self.loads.control(0.0).name(), found)
        });
        if self.printing.for_people() {
            let energy = |value| units.number(value, ENERGY_PER_AREA);
            say(&format!("{} rows in {}", table.rows(), printing::name(&self.out)));
            if tension > 0.0 {
                say(&format!("greatest tension        {}", units.number(tension, PRESSURE)));
                say(&format!("greatest tensile force  {}", units.number(-least("normal_force"), FORCE)));
            }
            for &k in events.iter().take(MOST_EVENTS) {
                let (row, before) = (&rows[k], &rows[k.saturating_sub(1)]);
                let event = row["event"].as_str().unwrap_or_default();
                let ways = [(x, LENGTH), (y, y_dimension)].map(|(name, dimension): (_, Dimension)| {
                    let [from, to] = [before, row].map(|row| units.number(number(row, name), dimension));
                    format!("{} {from} to {to}", name.replace('_', " "))
                });
                let drop = row["energy_drop"].as_f64().map(|drop| format!(", energy drop {}", energy(drop)));
                say(&format!("{event:<23} {}{}", ways.join(", "), drop.unwrap_or_default()));
            }
            if events.len() > MOST_EVENTS {
                say(&format!("and {} smaller events", events.len() - MOST_EVENTS));
            }
            if let Some(last) = rows.last() {
                say(&format!("dissipated in jumps     {}", energy(number(last, "dissipated"))));
                say(&format!("work done by the load   {}", energy(number(last, "work"))));
                say(&format!("imbalance of energy     {:.1e}", number(last, "imbalance")));
            }
        }
        let Some(plot) = &self.plot else { return Ok(()) };
        processes.first(|| write_picture(plot, &chart_of_columns(&rows, x, y, units, self.resolution.dpi)?))
    }
}
