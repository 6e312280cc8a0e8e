//! `asperity cycle`: a path of equilibria through loading and unloading, with its jumps.

use std::path::PathBuf;

use asperity_scene::{
    AdhesionKeys, Chosen, CycleLimit, Load, LoadsKeys, PathKeys, Skin, SolverKeys, SurfaceKeys, UnitKeys, Way,
    unbalanced,
};
use clap::{ArgGroup, Args};
use serde_json::{Map, Value, json};

use crate::columns::Columns;
use crate::options::{ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::pictures::{PaperOptions, chart_of_columns, check_plot, write_picture};
use crate::printing::{self, say, warn};
use crate::processes::Processes;
use crate::quantity::{FORCE, PRESSURE};
use crate::scene::SceneFile;
use crate::table::{Fill, Manner, Table, TableOptions, format_of};

/// Follow the contact along a cycle of approach and withdrawal, and find its jumps.
///
/// Numbers may have units, all of them or none, as for asperity solve. The loads are the turning points, at least two:
/// the first is the start, and the program goes from each to the next in adaptive steps, on approach or withdrawal. A
/// withdrawal ends once the surfaces do not touch, and hardly attract each other: below a thousandth of the greatest
/// tension. Where the state jumps, the step is halved down to a given share of the way, which locates the jump and the
/// energy that it dissipates. A limit point is the greatest or least load of a branch; beyond it, a cycle along
/// pressures or forces continues at given mean gaps (with a free boundary at given approaches). Each state gives a row
/// of the file. It has the columns of asperity sweep, the work of the load and the energy dissipated in jumps so far,
/// the imbalance of energy (all per area), and the event on the way to it: touch, jump-in, jump-out, pull-off,
/// limit-point, bifurcation. With jkr the same cycle on half as many nodes along the sides tells the limits of no range
/// of the work and of the greatest tension, with their errors. With a hardness the surface keeps its plastic depth, and
/// the balance has the energy that yielding dissipates. The same command continues an interrupted cycle; for that it
/// keeps FILE.state next to the file, which may be deleted at the end. asperity run FILE.scene.toml repeats or
/// continues the cycle. Exits with 0 if all rows converged, 2 if not, and 1 if the input is refused or a file cannot be
/// written.
#[derive(Args)]
#[command(after_help = EXAMPLES, group(ArgGroup::new("loads").required(true).args(Load::many())))]
pub struct Options {
    #[command(flatten)]
    problem: Chosen<(SurfaceKeys, LoadsKeys, PathKeys, AdhesionKeys, SolverKeys)>,

    /// File for the rows, .csv or .jsonl (one JSON object per line)
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: PathBuf,
    /// Folder for the fields at the jumps, made if needed: gap-0001.npy, pressure-0001.npy, contact_pressure-0001.npy
    /// and so on, for the rows with an event, the rows before them, and the last row
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    fields: Option<PathBuf>,
    /// File for a picture of the mean pressure over the mean gap, or with a free boundary of the normal force over the
    /// approach, with jumps as dashed lines; .png, .svg or .pdf
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    size: PaperOptions,
    #[command(flatten)]
    units: Chosen<UnitKeys>,
    #[command(flatten)]
    pub manner: Manner,
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
pub fn run(options: &Options, scene: &SceneFile, processes: &Processes) -> Outcome<bool> {
    let Options { out, fields, plot, manner, .. } = options;
    let format = format_of(out, "")?;
    processes.first(|| check_plot(plot.as_deref(), out, manner.force))?;
    let (problem, fields) = (&options.problem()?, fields.as_deref());
    TableOptions { problem, out, format, fields, scene, processes, manner, interface: false }.fill(options)
}

impl Fill for Options {
    fn way(&self, loads: &[Load], full: f64) -> Outcome<Way> {
        Ok(Way::cycle(loads, full, self.problem.0.path())?)
    }

    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool> {
        table.announce();
        while let Some(row) = table.extend()? {
            let event = row.step.and_then(|step| step.event).map_or(String::new(), |event| format!("  {event}"));
            self.manner.printing.say(&format!("{:>4}  {}{event}", table.session.rows(), table.brief(&row.account)));
        }
        let limit = table.limit()?;
        self.conclude(table, limit)?;
        Ok(table.converged("or --tolerance"))
    }
}

impl Options {
    /// The problem.
    pub fn problem(&self) -> Outcome<ProblemOptions> {
        ProblemOptions::of([&self.problem.0, &self.units.0])
    }

    /// Prints the summary or the report of all rows, and draws the picture.
    fn conclude<T: Scalar>(&self, table: &Table<'_, T>, limit: Option<CycleLimit>) -> Outcome<()> {
        let (rows, units) = (table.session.read()?, table.session.units());
        let number = |row: &Value, name: &str| row[name].as_f64().unwrap_or(f64::NAN);
        let least = |name: &str| rows.iter().map(|row| number(row, name)).fold(0.0, f64::min);
        let tension = -least("mean_pressure");
        // the largest jump first, and at the end limit points, which dissipate nothing
        let mut events: Vec<usize> = (0..rows.len()).filter(|&k| !rows[k]["event"].is_null()).collect();
        let drop = |k: usize| rows[k]["energy_drop"].as_f64().unwrap_or(f64::NEG_INFINITY);
        events.sort_by(|&a, &b| drop(b).total_cmp(&drop(a)));
        // of the greatest work, as it is that of the jumps alone at the end
        let most = rows.iter().map(|row| number(row, "work").abs()).fold(f64::MIN_POSITIVE, f64::max);
        let imbalance = rows.last().map_or(0.0, |last| number(last, "imbalance"));
        let free = table.is_free();
        let (x, y) = if free { ("approach", "normal_force") } else { ("mean_gap", "mean_pressure") };
        self.manner.printing.report(|| {
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
                "greatest_tension": (tension > 0.0).then_some(tension),
                "greatest_tensile_force": (tension > 0.0).then_some(-least("normal_force")),
                "events": events.iter().map(event).collect::<Vec<_>>(),
                "work": last["work"],
                "dissipated": last["dissipated"],
                "plastic_energy": last["plastic_energy"],
                "imbalance": last["imbalance"],
                "work_error": last["work_error"],
                "last": last,
            });
            let parts = [found, json!(limit)];
            table.report(
                parts.iter().filter_map(Value::as_object).flatten().map(|(k, v)| (k.clone(), v.clone())).collect(),
            )
        });
        if self.manner.printing.for_people() {
            let columns = Columns::new(&rows, units);
            let in_limit = |[value, error]: [String; 2]| say(&format!("  in the limit          {value} ± {error}"));
            let told = |row: &Value, name: &str| columns.number(name, columns.value(row, name));
            let tension_in_limit = |scale: f64, dimension| {
                if let Some(CycleLimit { tension_limit, tension_limit_error, .. }) = limit {
                    in_limit(
                        [tension_limit, tension_limit_error].map(|number| units.number(scale * number, dimension)),
                    );
                }
            };
            say(&format!("{} rows in {}", table.session.rows(), printing::name(&self.out)));
            if tension > 0.0 {
                if !free {
                    say(&format!("greatest tension        at least {}", units.number(tension, PRESSURE)));
                    tension_in_limit(1.0, PRESSURE);
                }
                let force = -least("normal_force");
                say(&format!("greatest tensile force  at least {}", units.number(force, FORCE)));
                tension_in_limit(force / tension, FORCE);
            }
            for &k in events.iter().take(MOST_EVENTS) {
                let (row, before) = (&rows[k], &rows[k.saturating_sub(1)]);
                let event = row["event"].as_str().unwrap_or_default();
                let ways = [x, y]
                    .map(|name| format!("{} {} to {}", name.replace('_', " "), told(before, name), told(row, name)));
                let drop = row["energy_drop"].as_f64().map(|_| format!(", energy drop {}", told(row, "energy_drop")));
                say(&format!("{event:<23} {}{}", ways.join(", "), drop.unwrap_or_default()));
            }
            if events.len() > MOST_EVENTS {
                let more = events.len() - MOST_EVENTS;
                say(&format!("and {more} smaller event{}", if more == 1 { "" } else { "s" }));
            }
            if let Some(last) = rows.last() {
                say(&format!("dissipated in jumps     {}", told(last, "dissipated")));
                if last["plastic_energy"].is_number() {
                    say(&format!("dissipated by yielding  {}", told(last, "plastic_energy")));
                }
                say(&format!("work done by the load   {} ± {}", told(last, "work"), told(last, "work_error")));
                if let Some(CycleLimit { work_limit, work_limit_error, .. }) = limit {
                    let limit = json!({ "work": work_limit, "work_error": work_limit_error });
                    in_limit(["work", "work_error"].map(|name| told(&limit, name)));
                }
                let share = 100.0 * (imbalance / most).abs();
                let greatest = rows.iter().find(|row| number(row, "work").abs() == most).unwrap_or(last);
                let of = columns.number("work", columns.value(greatest, "work").abs());
                let imbalance = told(last, "imbalance");
                say(&format!(
                    "imbalance of energy     {imbalance}, {share:.1} % of the greatest work on the way, {of}"
                ));
            }
        }
        if let Some(text) = unbalanced(most, imbalance, Skin::Options) {
            warn(format!("{}: {text}", printing::name(&self.out)));
        }
        let Some(plot) = &self.plot else { return Ok(()) };
        table.first(|| write_picture(plot, &chart_of_columns(&rows, x, y, units, self.size.paper())?))
    }
}
