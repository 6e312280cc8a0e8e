//! `asperity cycle`: a path of equilibria through loading and unloading, with its jumps.

use asperity_scene::column::{APPROACH, MEAN_GAP, MEAN_PRESSURE, NORMAL_FORCE};
use std::path::PathBuf;

use asperity_scene::legs::value;
use asperity_scene::{
    Account, CycleLimit, CycleLimits, Entries, FORCE, Kind, Load, Outcome, PRESSURE, Scalar, Session, Skin, Step,
    Units, Way, key, keys, unbalanced,
};
use serde_json::{Map, Value, json};

use crate::columns::Columns;
use crate::command::Call;
use crate::pictures::{PaperOptions, chart_of_columns, check_plot, write_picture};
use crate::printing::{self, in_options, say, warn};
use crate::progress::Progress;
use crate::report::LAST;
use crate::table::{Fill, Table, TableOptions, format_of};

keys! {
    /// Follow the contact along a cycle of approach and withdrawal, and find its jumps.
    ///
    /// Numbers may have units, all of them or none, as for asperity solve. The loads are the turning points, at least
    /// two: the first is the start, and the program goes from each to the next in adaptive steps, on approach or
    /// withdrawal. A withdrawal ends once the surfaces do not touch, and hardly attract each other: below a thousandth
    /// of the greatest tension. Where the state jumps, the step is halved down to a given share of the way, which
    /// locates the jump and the energy that it dissipates. A limit point is the greatest or least load of a branch;
    /// beyond it, a cycle along pressures or forces continues at given mean gaps (with a free boundary at given
    /// approaches). Each state gives a row of the file. It has the columns of asperity sweep, the work of the load and
    /// the energy dissipated in jumps so far, the imbalance of energy (all per area), and the event on the way to it:
    /// touch, jump-in, jump-out, pull-off, limit-point, bifurcation. With jkr the same cycle on half as many nodes
    /// along the sides tells the limits of no range of the work and of the greatest tension, with their errors, and
    /// --accuracy takes the coarsest grid that has them. With a hardness the surface keeps its plastic depth, and the
    /// balance has the energy that yielding dissipates. The same command continues an interrupted cycle; for that it
    /// keeps FILE.state next to the file, which may be deleted at the end. asperity run FILE.scene.toml repeats or
    /// continues the cycle. Exits with 0 if all rows converged, 2 if not, and 1 if the input is refused or a file
    /// cannot be written.
    ///
    /// # Examples
    ///   Approach and withdrawal of a map of 1 by 1, with a picture of the loop:
    ///     asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3 --mean-gaps 0.05,0.02,0.05 --out cycle.csv --plot cycle.png
    ///   Press, and pull until it comes off:
    ///     asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3 --mean-pressures 0.02,-1 --out pull-off.csv
    ///   A tip on a free half-space, together from afar and apart again, with a picture of force over approach:
    ///     asperity cycle --heights tip.npy --boundary free --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3 --approaches -0.03,0.01,-0.03 --out tip.csv --plot tip.png
    Options {
        "Output" {
            /// File for the rows, .csv or .jsonl (one JSON object per line)
            out: PathBuf = Kind::file().required(),
            /// Folder for the fields at the jumps, made if needed: gap-0001.npy, pressure-0001.npy,
            /// contact_pressure-0001.npy and so on, for the rows with an event, the rows before them, and the last row
            fields: Option<PathBuf> = Kind::folder(),
            /// File for a picture of the mean pressure over the mean gap, or with a free boundary of the normal force over
            /// the approach, with jumps as dashed lines; .png, .svg or .pdf
            plot: Option<PathBuf> = Kind::file(),
        }
    }
}

/// The number of events that are printed at the end.
const MOST_EVENTS: usize = 8;

/// Runs the command; whether all rows converged.
pub fn run(call: &Call<'_>) -> Outcome<bool> {
    let options = &call.scene.keys::<Options>();
    let Options { out, fields, plot } = options;
    let table = TableOptions::new(call, out, format_of(out, "")?, fields.as_deref())?;
    call.processes.first(|| check_plot(plot.as_deref(), out, table.force))?;
    table.fill(options)
}

impl Fill for Options {
    fn way(&self, loads: &[Load], full: f64, given: &Entries) -> Outcome<Way> {
        Ok(Way::cycle(loads, full, given.path())?)
    }

    fn refine<T: Scalar>(
        &self,
        session: &mut Session<T>,
        way: &Way,
        table: &TableOptions<'_>,
        is_started: bool,
    ) -> Outcome<()> {
        let (printing, tolerance) = (table.printing, session.facts.scene.tolerance());
        let Some(goal) = in_options(table.scene.given.cycle_goal())? else {
            if !is_started && session.may_choose_grid() {
                printing.say("--accuracy 0.1 would take the coarsest grid on which the work is known to 10 %");
            }
            return Ok(());
        };
        printing.say(&format!("accuracy {} of the {}: the cycle on coarser grids first", goal.accuracy, goal.of));
        let mut progress = Progress::new("", tolerance, 0, printing.without_bars());
        let chosen = session.refine(way, goal, is_started, &mut progress.on_grids());
        drop(progress);
        printing.say(&chosen?);
        Ok(())
    }

    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool> {
        table.announce();
        while let Some(row) = table.extend()? {
            let event = row.step.and_then(|step| step.event).map_or(String::new(), |event| format!("  {event}"));
            table.options.printing.say(&format!("{:>4}  {}{event}", table.rows.count(), table.brief(&row.account)));
        }
        let limit = table.limit()?;
        let shortfall = limit.as_ref().and_then(|limit| limit.shortfall(Skin::Options));
        self.conclude(table, limit)?;
        let converged = table.converged("or --tolerance");
        Ok(shortfall.map(warn).is_none() && converged)
    }
}

impl Options {
    /// Prints the summary or the report of all rows, and draws the picture.
    fn conclude<T: Scalar>(&self, table: &Table<'_, T>, limits: Option<CycleLimits>) -> Outcome<()> {
        let (rows, units, free) = (&table.rows.read()?, &table.rows.facts().units, table.is_free());
        let (x, y) = if free { (APPROACH, NORMAL_FORCE) } else { (MEAN_GAP, MEAN_PRESSURE) };
        let limit = limits.as_ref().map(|limits| limits.limit);
        let followed = Followed { rows, units, free, axes: [x, y], limit, limits };
        table.options.printing.report(|| table.report(followed.report()));
        if table.options.printing.for_people() {
            say(&format!("{} rows in {}", table.rows.count(), printing::name(&self.out)));
            followed.lines().iter().for_each(|line| say(line));
        }
        if let Some(text) = unbalanced(followed.greatest_work().0, followed.imbalance(), Skin::Options) {
            warn(format!("{}: {text}", printing::name(&self.out)));
        }
        let Some(plot) = &self.plot else { return Ok(()) };
        table.first(|| {
            write_picture(
                plot,
                &chart_of_columns(rows, x, y, units, table.options.scene.keys::<PaperOptions>().paper())?,
            )
        })
    }
}

/// A cycle with all of its rows.
struct Followed<'a> {
    rows: &'a [Value],
    units: &'a Units,
    /// Whether the boundary is free
    free: bool,
    /// The columns along which the cycle is told
    axes: [&'static str; 2],
    limit: Option<CycleLimit>,
    limits: Option<CycleLimits>,
}

impl Followed<'_> {
    fn least(&self, name: &str) -> f64 {
        self.rows.iter().map(|row| value(row, name)).fold(0.0, f64::min)
    }

    fn imbalance(&self) -> f64 {
        self.rows.last().map_or(0.0, |last| value(last, key!(Step, imbalance)))
    }

    /// The greatest work on the way, as at the end the work is that of the jumps alone, and the row that has it.
    fn greatest_work(&self) -> (f64, Option<&Value>) {
        let work = |row: &Value| value(row, "work").abs();
        let most = self.rows.iter().map(work).fold(f64::MIN_POSITIVE, f64::max);
        (most, self.rows.iter().find(|row| work(row) == most).or(self.rows.last()))
    }

    /// The rows with an event: the largest jump first, and at the end limit points, which dissipate nothing.
    fn events(&self) -> Vec<usize> {
        let mut events: Vec<_> = (0..self.rows.len()).filter(|&k| !self.rows[k][key!(Step, event)].is_null()).collect();
        let drop = |k: usize| self.rows[k][key!(Step, energy_drop)].as_f64().unwrap_or(f64::NEG_INFINITY);
        events.sort_by(|&a, &b| drop(b).total_cmp(&drop(a)));
        events
    }

    /// The keys of the report.
    fn report(&self) -> Value {
        let last = self.rows.last().cloned().unwrap_or_default();
        let kept = [MEAN_GAP, MEAN_PRESSURE, NORMAL_FORCE, APPROACH];
        let event = |&k: &usize| {
            let of_step = ["leg", "direction", "control_value", "event", "energy_drop"];
            let mut found = cells(&self.rows[k], of_step.iter().chain(&kept));
            if let Some(before) = k.checked_sub(1) {
                found.insert("from".to_owned(), cells(&self.rows[before], &kept).into());
            }
            Value::Object(found)
        };
        let [tension, force] = [MEAN_PRESSURE, NORMAL_FORCE].map(|name| -self.least(name));
        let of_cycle = [
            key!(Step, work),
            key!(Step, dissipated),
            key!(Account, plastic_energy),
            key!(Step, imbalance),
            key!(Step, work_error),
        ];
        let mut found = Map::from_iter([
            ("greatest_tension".to_owned(), json!((tension > 0.0).then_some(tension))),
            ("greatest_tensile_force".to_owned(), json!((tension > 0.0).then_some(force))),
            ("events".to_owned(), self.events().iter().map(event).collect()),
        ]);
        found.extend(cells(&last, &of_cycle));
        found.insert(LAST.to_owned(), last);
        found.extend(json!(self.limits).as_object().cloned().unwrap_or_default());
        found.into()
    }

    /// The summary for people.
    fn lines(&self) -> Vec<String> {
        let columns = Columns::new(self.rows, self.units);
        let told = |row: &Value, name: &str| columns.number(name, columns.value(row, name));
        let mut lines = self.tension();
        let events = self.events();
        for &k in events.iter().take(MOST_EVENTS) {
            let (row, before) = (&self.rows[k], &self.rows[k.saturating_sub(1)]);
            let event = row[key!(Step, event)].as_str().unwrap_or_default();
            let way = |name: &str| format!("{} {} to {}", name.replace('_', " "), told(before, name), told(row, name));
            let drop =
                row[key!(Step, energy_drop)].as_f64().map(|_| format!(", energy drop {}", told(row, "energy_drop")));
            lines.push(format!("{event:<23} {}{}", self.axes.map(way).join(", "), drop.unwrap_or_default()));
        }
        if events.len() > MOST_EVENTS {
            let more = events.len() - MOST_EVENTS;
            lines.push(format!("and {more} smaller event{}", if more == 1 { "" } else { "s" }));
        }
        let (most, greatest) = self.greatest_work();
        let Some((last, greatest)) = self.rows.last().zip(greatest) else { return lines };
        lines.push(format!("dissipated in jumps     {}", told(last, "dissipated")));
        if last[key!(Account, plastic_energy)].is_number() {
            lines.push(format!("dissipated by yielding  {}", told(last, "plastic_energy")));
        }
        lines.push(format!("work done by the load   {} ± {}", told(last, "work"), told(last, "work_error")));
        if let Some(CycleLimit { work_limit, work_limit_error, .. }) = self.limit {
            let limit = json!({ "work": work_limit, "work_error": work_limit_error });
            lines.push(in_limit(["work", "work_error"].map(|name| told(&limit, name))));
        }
        let share = 100.0 * (self.imbalance() / most).abs();
        let of = columns.number("work", columns.value(greatest, "work").abs());
        let imbalance = told(last, key!(Step, imbalance));
        lines.push(format!("imbalance of energy     {imbalance}, {share:.1} % of the greatest work on the way, {of}"));
        lines
    }

    /// The greatest tension, as a pressure where there is an area, and as a force.
    fn tension(&self) -> Vec<String> {
        let [tension, force] = [MEAN_PRESSURE, NORMAL_FORCE].map(|name| -self.least(name));
        if tension <= 0.0 {
            return Vec::new();
        }
        let told = |name: &str, found: f64, dimension| {
            let limit = self.limit.map(|CycleLimit { tension_limit, tension_limit_error, .. }| {
                [tension_limit, tension_limit_error].map(|value| self.units.number(found / tension * value, dimension))
            });
            let found = self.units.number(found, dimension);
            [Some(format!("{name:<24}at least {found}")), limit.map(in_limit)].into_iter().flatten()
        };
        let of_area = (!self.free).then(|| told("greatest tension", tension, PRESSURE));
        of_area.into_iter().flatten().chain(told("greatest tensile force", force, FORCE)).collect()
    }
}

/// A line with the limit of no range, and its error.
fn in_limit([value, error]: [String; 2]) -> String {
    format!("  in the limit          {value} ± {error}")
}

/// The cells of a row by the names of their columns.
fn cells<'a>(row: &Value, names: impl IntoIterator<Item = &'a &'static str>) -> Map<String, Value> {
    names.into_iter().map(|name| ((*name).to_owned(), row[*name].clone())).collect()
}
