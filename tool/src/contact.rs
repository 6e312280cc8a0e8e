//! `asperity contact`: the contact of a solve in tables and charts.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use asperity::{Error, Grid};
use asperity_plot::{Chart, Picture};
use asperity_scene::contact::{ContactTables, Density};
use clap::Args;
use serde_json::{Value, json};

use crate::csv;
use crate::outcome::Outcome;
use crate::output::{at_destination, check_apart, commit, output_folder, write_text};
use crate::pictures::{PictureFormat, Resolution};
use crate::printing::{Printing, name, say};
use crate::quantity::{PER_LENGTH, PER_PRESSURE};
use crate::report;
use crate::scene::{self, SceneFile};
use crate::solved::{CONTACT_PRESSURE, GAP, Solved};
use crate::units::Units;

/// Tabulate and chart the contact of a solve.
///
/// Distributions of gap and contact pressure, the autocorrelation of the pressure, and clusters. SOLVED is the folder
/// of a solve, of which gap.npy, contact_pressure.npy and report.json are taken. Near the edge of the contact the
/// densities of gap and contact pressure are powers of them, of -1/3 and 1 at a hard wall without adhesion; the
/// exponents are told in a window above the nodes at the edge itself, whose density the grid makes uniform, and not
/// where the nodes do not reach that near. The autocorrelation of the contact pressure is about its mean and over its
/// variance, in a periodic cell.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// Folder of a solve
    #[arg(value_name = "SOLVED")]
    solved: PathBuf,
    /// Folder for gap.csv and pressure.csv, the densities over the nodes in bins that are equally wide in the
    /// logarithm, autocorrelation.csv, clusters.csv with area, perimeter and force of each, a chart of each of these,
    /// report.json, and scene.toml
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    out: Option<PathBuf>,
    /// Replace results that are there
    #[arg(long, help_heading = "Output")]
    force: bool,
    /// Format of the charts
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "png", help_heading = "Output")]
    picture_format: PictureFormat,
    #[command(flatten)]
    resolution: Resolution,
    #[command(flatten)]
    printing: Printing,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
    asperity solve --heights heights.npy --mean-pressure 0.01 --out pressed
    asperity contact pressed
    asperity contact pressed --out contact --picture-format svg";

const TABLES: [&str; 4] = ["gap.csv", "pressure.csv", "autocorrelation.csv", "clusters.csv"];
const CHARTS: [[&str; 4]; 3] = [
    ["gap.png", "pressure.png", "autocorrelation.png", "clusters.png"],
    ["gap.svg", "pressure.svg", "autocorrelation.svg", "clusters.svg"],
    ["gap.pdf", "pressure.pdf", "autocorrelation.pdf", "clusters.pdf"],
];

const REPORT: &str = "report.json";

/// All files that the command may leave.
fn files() -> Vec<&'static str> {
    [REPORT, scene::NAME].into_iter().chain(TABLES).chain(CHARTS.into_iter().flatten()).collect()
}

/// Runs the command; always successful if it ends.
pub fn run(options: &Options, scene: &SceneFile) -> Outcome<bool> {
    let Options { solved: folder, out, force, printing, .. } = options;
    if let Some(out) = out {
        scene.check(&out.join(scene::NAME))?;
        let read = Solved::files(folder, &[GAP, CONTACT_PRESSURE]);
        files().iter().try_for_each(|name| check_apart(&out.join(name), read.iter().map(PathBuf::as_path)))?;
        drop(output_folder(out, &files(), *force)?);
    }
    let solved = Solved::read(folder)?;
    let [gap, pressure] = [solved.map(GAP)?, solved.map(CONTACT_PRESSURE)?];
    let lengths = gap.lengths.ok_or_else(|| Error::file(folder, "has a report.json without side lengths"))?;
    let grid = Grid::new(gap.heights.dim(), lengths)?;
    let tables = ContactTables::of(gap.heights.view(), pressure.heights.view(), grid, solved.boundary())?;
    let (figures, units) = (tables.figures(), solved.units());
    let report = || {
        let inputs = json!({
            "solved": folder.to_string_lossy(),
            "shape": grid.shape(),
            "lengths": grid.lengths(),
            "length_unit": units.length,
            "pressure_unit": units.pressure,
            "boundary": solved.boundary(),
            "version": env!("CARGO_PKG_VERSION"),
        });
        report::report("contact", json!(figures), &inputs)
    };
    let written = out.as_deref().map(|out| options.write(out, &tables, grid, &units, scene, &report())).transpose()?;
    if printing.for_people() {
        let rows = figures.rows(&units);
        let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        rows.iter().for_each(|(name, text)| say(&format!("{name:width$}  {text}")));
        if let (Some(out), Some(names)) = (out, written) {
            say(&format!("results in {}: {}", name(out), names.join(", ")));
        }
    }
    printing.report(report);
    Ok(true)
}

impl Options {
    /// Writes all files, and tells their names.
    fn write(
        &self,
        out: &Path,
        tables: &ContactTables,
        grid: Grid,
        units: &Units,
        scene: &SceneFile,
        report: &Value,
    ) -> Outcome<Vec<&'static str>> {
        let folder = output_folder(out, &files(), self.force)?;
        let charts = self.picture_format.of(CHARTS);
        let has = [
            !tables.gap.density.is_empty(),
            !tables.pressure.density.is_empty(),
            !tables.autocorrelation.is_empty(),
            !tables.spots.is_empty(),
        ];
        let chosen =
            |names: [&'static str; 4]| names.into_iter().zip(has).filter(|(_, has)| *has).map(|(name, _)| name);
        let names: Vec<_> = [REPORT, scene::NAME].into_iter().chain(chosen(TABLES)).chain(chosen(charts)).collect();
        let texts = [
            densities("gap", &tables.gap, units),
            densities("pressure", &tables.pressure, units),
            autocorrelation(tables, units),
            clusters(tables, grid, units),
        ];
        let write = || {
            write_text(&folder.path(REPORT), &format!("{report:#}\n"))?;
            write_text(&folder.path(scene::NAME), &scene.text(out))?;
            for ((name, text), has) in TABLES.into_iter().zip(texts).zip(has) {
                if has {
                    write_text(&folder.path(name), &text)?;
                }
            }
            for ((name, draw), has) in charts.into_iter().zip(DRAWN).zip(has) {
                if has {
                    draw(tables, units, self.resolution.dpi)?.write(folder.path(name))?;
                }
            }
            asperity::Result::Ok(())
        };
        write().map_err(|error| at_destination(error, out))?;
        commit(folder)?;
        Ok(names)
    }
}

/// A row of numbers.
fn line(text: &mut String, numbers: &[f64]) {
    let cells: Vec<_> = numbers.iter().map(|number| format!("{number:e}")).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", cells.join(","));
}

/// The density of a gap or a pressure, bin by bin.
fn densities(of: &str, found: &Density, units: &Units) -> String {
    let names = ["from", "to"].map(|end| format!("{end}_{of}"));
    let density = format!("{of}_density");
    let mut text = csv::header(units.columns(&[&names[0], &names[1], &density], "", false)) + "\n";
    for (edges, density) in found.edges.windows(2).zip(&found.density) {
        line(&mut text, &[edges[0], edges[1], *density]);
    }
    text
}

/// The autocorrelation of the pressure by the distance.
fn autocorrelation(tables: &ContactTables, units: &Units) -> String {
    let mut text = csv::header(units.columns(&["distance", "autocorrelation"], "", false)) + "\n";
    tables.autocorrelation.iter().for_each(|(distance, value)| line(&mut text, &[*distance, *value]));
    text
}

/// The clusters of contact, the largest first.
fn clusters(tables: &ContactTables, grid: Grid, units: &Units) -> String {
    let columns = ["nodes", "area", "perimeter", "normal_force"];
    let known = if grid.is_line() { Units::default() } else { units.clone() };
    let mut text = csv::header(known.columns(&columns, "", grid.is_line())) + "\n";
    for spot in &tables.spots {
        let _ = writeln!(text, "{},{:e},{:e},{:e}", spot.nodes, spot.area, spot.perimeter, spot.force);
    }
    text
}

type Draw = fn(&ContactTables, &Units, f64) -> asperity::Result<Picture>;

/// The charts of the tables.
const DRAWN: [Draw; 4] = [
    |tables, units, dpi| {
        let (unit, per) = (units.length.as_deref(), units.of(PER_LENGTH));
        let words = ("Distribution of the gap", "gap", "g^(-1/3)", -1.0 / 3.0);
        draw_density(&tables.gap, words, (unit, per.as_deref()), dpi)
    },
    |tables, units, dpi| {
        let (unit, per) = (units.pressure.as_deref(), units.of(PER_PRESSURE));
        let words = ("Distribution of the contact pressure", "contact pressure", "p", 1.0);
        draw_density(&tables.pressure, words, (unit, per.as_deref()), dpi)
    },
    |tables, units, dpi| {
        let chart = Chart {
            title: "Autocorrelation of the contact pressure",
            x_label: "distance",
            x_unit: units.length.as_deref(),
            x_log: true,
            y_label: "autocorrelation",
            curves: vec![("", tables.autocorrelation.iter().copied().filter(|(lag, _)| *lag > 0.0).collect())],
            ..Chart::default()
        };
        chart.draw(dpi)
    },
    |tables, units, dpi| {
        // a step at each area, from the largest on
        let count = |(k, area): (usize, f64)| [(area, k.max(1) as f64), (area, (k + 1) as f64)];
        let points = tables.spots.iter().map(|spot| spot.area).enumerate().flat_map(count).collect();
        let unit = units.length.as_ref().map(|unit| format!("{unit}²"));
        let chart = Chart {
            title: "Clusters of contact",
            x_label: "area of a cluster",
            x_unit: unit.as_deref(),
            x_log: true,
            y_label: "clusters of that area or more",
            y_log: true,
            curves: vec![("", points)],
            ..Chart::default()
        };
        chart.draw(dpi)
    },
];

/// The chart of a density, beside its power near the edge of the contact in the window of its exponent, if there is
/// one.
fn draw_density(
    found: &Density,
    (title, label, law, power): (&str, &str, &str, f64),
    (unit, density_unit): (Option<&str>, Option<&str>),
    dpi: f64,
) -> asperity::Result<Picture> {
    // below a bin without a node there are single nodes, which the table has
    let mut points: Vec<_> = found.points().into_iter().rev().take_while(|(_, density)| *density > 0.0).collect();
    points.reverse();
    let caption = found.exponent.map(|found| format!("exponent {:.3} in the window of the line", found.exponent));
    let guide = found.exponent.and_then(|window| {
        let middle = (window.from * window.to).sqrt();
        let beside = |point: &(f64, f64)| (point.0 / middle).ln().abs();
        let (at, density) = *points.iter().min_by(|a, b| beside(a).total_cmp(&beside(b)))?;
        Some([window.from, window.to].map(|value| (value, density * (value / at).powf(power))).to_vec())
    });
    let chart = Chart {
        title,
        caption: caption.as_deref().unwrap_or_default(),
        x_label: label,
        x_unit: unit,
        x_log: true,
        y_label: "probability density",
        y_unit: density_unit,
        y_log: true,
        curves: [("", points)].into_iter().chain(guide.map(|guide| (law, guide))).collect(),
        ..Chart::default()
    };
    chart.draw(dpi)
}
