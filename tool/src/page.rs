//! `asperity report`: the results of a run as one page for a browser.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::contact::PressureDistribution;
use asperity::{Error, Grid};
use asperity_maps::io::read_field;
use asperity_plot::{Chart, Colouring, Map};
use clap::Args;
use ndarray::Zip;
use serde_json::Value;
use toml::Table;

use crate::citation::{PAPER, PROGRAM};
use crate::csv;
use crate::journal::state_path;
use crate::numbers::plain;
use crate::outcome::Outcome;
use crate::output::{OutputFile, check_apart, with_suffix, write_text};
use crate::pictures::{MapColours, chart_of_columns, chart_of_loads, draw_clusters, draw_pressure, draw_regions};
use crate::printing::{name, say};
use crate::quantity::PRESSURE;
use crate::scene;
use crate::solve;
use crate::units::{Units, dimension_of};
use crate::warnings;

/// Put the results of a run on one page for a browser.
///
/// RESULTS is the folder of a solve, or the table of a sweep, a cycle or a study. The page has the figures, the
/// warnings, maps that can be zoomed, curves, the scene that repeats the run, and how to cite. It is one file, which
/// loads nothing from elsewhere: for a colleague, or beside the data. Maps are drawn from gap.npy, pressure.npy and
/// contact_pressure.npy.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// Folder of a solve, or table of a sweep, a cycle or a study
    #[arg(value_name = "RESULTS")]
    results: PathBuf,
    /// File for the page [default: report.html in the folder, or beside the table]
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
    /// Replace a page that is there
    #[arg(long, help_heading = "Output")]
    force: bool,
    #[command(flatten)]
    colours: MapColours,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
    asperity solve --heights heights.npy --mean-gap 0.04 --out results
    asperity report results
    asperity sweep --heights heights.npy --mean-gaps 0.05:0.04:3 --out sweep.csv
    asperity report sweep.csv";

/// The resolution of the maps, for those who zoom.
const FINE: f64 = 288.0;
/// The share of w/ρ from which on attraction is shown, as in the column `attractive_fraction`.
const NOTICEABLE: f64 = 0.01;
/// The number of classes of the distribution of the pressure.
const CLASSES: usize = 60;

/// Runs the command; always successful if it ends.
pub fn run(options: &Options) -> Outcome<bool> {
    let results = &options.results;
    let folder = results.is_dir();
    options.colours.check()?;
    if !folder && (options.colours.limits().is_some() || options.colours.colour_clusters) {
        let text = "has no maps, of which --colour-limits and --colour-clusters are: name the folder of a solve";
        return Err(Error::file(results, text).into());
    }
    let default = if folder { results.join("report.html") } else { with_suffix(results, ".html") };
    let out = options.out.as_ref().unwrap_or(&default);
    let read: Vec<_> = match folder {
        true => solve::FILES.iter().map(|name| results.join(name)).collect(),
        false => vec![results.clone(), scene::beside(results), warnings::beside(results), state_path(results)],
    };
    check_apart(out, read.iter().map(PathBuf::as_path))?;
    let file = OutputFile::create(out, options.force)?;
    let page = if folder { page_of_solve(results, &options.colours)? } else { page_of_table(results)? };
    file.write(|path| write_text(path, &page))?;
    file.commit()?;
    say(&format!("page in {}", name(out)));
    Ok(true)
}

/// A page as it grows.
struct Page {
    text: String,
}

impl Page {
    fn new(title: &str, subtitle: &str) -> Self {
        let title = escaped(title);
        let text = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{title}</title>\n<style>\n{}</style>\n</head>\n\
             <body>\n<h1>{title}</h1>\n<p>{}</p>\n",
            include_str!("page/style.css"),
            escaped(subtitle)
        );
        Self { text }
    }

    fn heading(&mut self, text: &str) {
        let _ = writeln!(self.text, "<h2>{}</h2>", escaped(text));
    }

    fn warnings(&mut self, warnings: &[String]) {
        if !warnings.is_empty() {
            let items: String = warnings.iter().map(|text| format!("<li>{}</li>\n", escaped(text))).collect();
            let _ = writeln!(self.text, "<h2>Warnings</h2>\n<ul class=\"warnings\">\n{items}</ul>");
        }
    }

    /// A picture; a map can be zoomed.
    fn figure(&mut self, kind: &str, svg: &str) {
        let _ = writeln!(self.text, "<figure class=\"{kind}\">\n{svg}</figure>");
    }

    /// The scene, how to cite, and the end.
    fn finish(mut self, scene: Option<&str>) -> String {
        if let Some(scene) = scene {
            let _ = writeln!(
                self.text,
                "<h2>Scene</h2>\n<p>asperity run repeats the run with this file.</p>\n<pre>{}</pre>",
                escaped(scene)
            );
        }
        let (program, paper) = (escaped(PROGRAM), escaped(PAPER));
        let _ = write!(
            self.text,
            "<h2>How to cite</h2>\n<p>{program}</p>\n<p>{paper}</p>\n<script>\n{}</script>\n</body>\n</html>\n",
            include_str!("page/zoom.js")
        );
        self.text
    }
}

/// The page of a folder of `asperity solve`.
fn page_of_solve(folder: &Path, colours: &MapColours) -> Outcome<String> {
    let path = folder.join("report.json");
    let text = fs::read_to_string(&path).map_err(|_| {
        Error::file(&path, "is not there: name the folder of a solve, or the table of a sweep or a cycle")
    })?;
    let report: Value =
        serde_json::from_str(&text).map_err(|e| Error::file(&path, format!("is no report of a solve: {e}")))?;
    let scene = fs::read_to_string(folder.join(scene::NAME)).ok();
    let word = |key: &str| report[key].as_str().unwrap_or_default();
    let name = folder.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let name = name.unwrap_or_else(|| "results".to_owned());
    let status = word("status");
    let mut page = Page::new(&name, &format!("asperity solve, version {}: {status}", word("version")));

    let mut warnings: Vec<String> = Vec::new();
    if status != "converged" {
        warnings.push(format!("The solve has not converged, it is {status}: the answer may be wrong."));
    }
    let said = report["warnings"].as_array().into_iter().flatten();
    warnings.extend(said.filter_map(|warning| warning["message"].as_str()).map(str::to_owned));
    let units = units_of_report(&report);
    if colours.has_unit() && units.pressure.as_deref() != Some(PRESSURE.si) {
        return Err("--colour-limits has a unit, but the pressures of this run are not in Pa: give its numbers".into());
    }
    let maps = maps_of_solve(folder, &report, &units, colours);
    if let Err(error) = &maps {
        warnings.push(format!("There are no maps on this page: {error}"));
    }
    page.warnings(&warnings);
    if let Ok(maps) = maps {
        page.heading("Maps and curves");
        maps.iter().for_each(|(kind, svg)| page.figure(kind, svg));
    }
    page.heading("Figures");
    page.text.push_str("<table>\n");
    let on_line = report["shape"][1] == 1;
    let number = |key: &str, value| match dimension_of(key, word("control"), on_line) {
        Some(dimension) => units.number(value, dimension),
        None => plain(value),
    };
    for (key, value) in report.as_object().into_iter().flatten().filter(|(key, _)| *key != "warnings") {
        if let Some(value) = shown(key, value, &number) {
            let _ = writeln!(page.text, "<tr><th>{}</th><td>{}</td></tr>", escaped(&spaced(key)), escaped(&value));
        }
    }
    page.text.push_str("</table>\n");
    Ok(page.finish(scene.as_deref()))
}

/// The maps and the curve of a solve, each with its kind.
fn maps_of_solve(
    folder: &Path,
    report: &Value,
    units: &Units,
    colours: &MapColours,
) -> Outcome<Vec<(&'static str, String)>> {
    let [gap, pressure, contact_pressure] =
        ["gap", "pressure", "contact_pressure"].map(|name| read_field(folder.join(format!("{name}.npy"))));
    let (gap, pressure, contact_pressure) = (gap?, pressure?, contact_pressure?);
    let side = |k: usize| report["lengths"][k].as_f64().unwrap_or(1.0);
    let grid = Grid::new(gap.dim(), (side(0), side(1)))?;
    if [pressure.dim(), contact_pressure.dim()] != [gap.dim(); 2] {
        return Err("gap, pressure and contact pressure have not one shape: they are of different runs".into());
    }
    let (length, pressure_unit) = (units.length.as_deref(), units.pressure.as_deref());

    let adhesive = report["law"].as_str() != Some("none");
    // the traction of the law is what the contact pressure has more than the elastic one
    let least =
        report["work_of_adhesion"].as_f64().zip(report["range"].as_f64()).map(|(w, range)| NOTICEABLE * w / range);
    let least = least.filter(|_| adhesive).unwrap_or(f64::INFINITY);
    let regions = Zip::from(&gap).and(&pressure).and(&contact_pressure).map_collect(|&gap, &pressure, &contact| {
        match contact - pressure {
            _ if contact > 0.0 || gap <= 0.0 => 1.0,
            _ if gap.is_nan() => f64::NAN,
            traction if traction > least => -1.0,
            _ => 0.0,
        }
    });
    // the sides of an original do not meet
    let sides_meet = report["boundary"] != "free" && !report["solved_shape"].is_array();
    let contact = match colours.colour_clusters {
        true => draw_clusters(grid, "Contact", units, (&regions, sides_meet), FINE)?,
        false => draw_regions(grid, "Contact", units, &regions, FINE)?,
    };
    let drawn = if adhesive { &pressure } else { &contact_pressure };
    let pressures = draw_pressure(grid, ("Pressure", ""), units, drawn, colours.limits(), FINE)?;
    let gaps = Map {
        title: "Gap",
        length_unit: length,
        label: "gap",
        unit: length,
        ..Map::new(gap.view(), grid, Colouring::Sequential)
    };
    let chart =
        distribution(&PressureDistribution::of_fields(gap.view(), contact_pressure.view(), CLASSES)?, pressure_unit)?;
    Ok(vec![("map", contact.svg()?), ("map", pressures.svg()?), ("map", gaps.draw(FINE)?.svg()?), ("chart", chart)])
}

/// The chart of a distribution of the contact pressure: the nodes of each class, as a share of those in contact.
fn distribution(found: &PressureDistribution, unit: Option<&str>) -> asperity::Result<String> {
    let contact = found.integral();
    let point = |(edges, density): (&[f64], &f64)| {
        (0.5 * (edges[0] + edges[1]), 100.0 * density * (edges[1] - edges[0]) / contact)
    };
    let points = found.edges.windows(2).zip(&found.density).map(point);
    let curve = if contact > 0.0 { points.collect() } else { Vec::new() };
    let chart = Chart {
        title: "Distribution of the contact pressure",
        x_label: "contact pressure",
        x_unit: unit,
        y_label: "nodes in contact",
        y_unit: Some("%"),
        curves: vec![("", curve)],
        ..Chart::default()
    };
    chart.draw(FINE)?.svg()
}

/// The page of a table of `asperity sweep` or `asperity cycle`.
fn page_of_table(table: &Path) -> Outcome<String> {
    let text = fs::read_to_string(table).map_err(|_| {
        Error::file(table, "cannot be read: name the folder of a solve, or the table of a sweep or a cycle")
    })?;
    let (header, columns, rows) = rows(&text);
    if rows.is_empty() || !columns.iter().any(|column| column == "control_value") {
        return Err(Error::file(table, "is no table of a sweep or a cycle: it has no column control_value").into());
    }
    let scene = fs::read_to_string(scene::beside(table)).ok();
    let units = units_of_table(&header, scene.as_deref());
    let name = table.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let cycle = columns.iter().any(|column| column == "leg");
    let study = columns.first().is_some_and(|column| column == "case");
    let command = if study {
        "study"
    } else if cycle {
        "cycle"
    } else {
        "sweep"
    };
    let mut page = Page::new(&name, &format!("asperity {command}: {} rows", rows.len()));
    let bad = |row: &Value| row["status"] != "converged";
    let unconverged = rows.iter().filter(|row| bad(row)).count();
    let count = rows.len();
    let marked = format!("{unconverged} of {count} rows have not converged; they are marked in the table.");
    let said = warnings::read_beside(table)?.into_iter().map(|told| told.message);
    page.warnings(&(unconverged > 0).then_some(marked).into_iter().chain(said).collect::<Vec<_>>());
    page.heading("Curves");
    page.figure("chart", &chart_of_loads(&rows, &units, FINE)?.svg()?);
    let energy = if cycle { "dissipated" } else { "elastic_energy" };
    for (x, y) in [("mean_gap", "contact_fraction"), ("mean_gap", energy)] {
        // what is the same in all rows needs no curve
        if rows.iter().any(|row| row[y] != rows[0][y]) {
            page.figure("chart", &chart_of_columns(&rows, x, y, &units, FINE)?.svg()?);
        }
    }
    page.heading("Rows");
    // what no row has is left out
    let filled =
        header.iter().zip(&columns).filter(|(_, column)| rows.iter().any(|row| !row[column.as_str()].is_null()));
    let (header, columns): (Vec<_>, Vec<_>) = filled.unzip();
    let head: String = header.iter().map(|name| format!("<th>{}</th>", escaped(&spaced(name)))).collect();
    let _ = writeln!(page.text, "<div class=\"rows\">\n<table>\n<tr>{head}</tr>");
    // the header of a CSV table has the units
    let number = |column: &str, value| shown(column, value, &|_, number| plain(number)).unwrap_or_default();
    for row in &rows {
        let cell = |column: &&String| format!("<td>{}</td>", escaped(&number(column, &row[column.as_str()])));
        let cells: String = columns.iter().map(cell).collect();
        let _ = writeln!(page.text, "<tr{}>{cells}</tr>", if bad(row) { " class=\"bad\"" } else { "" });
    }
    page.text.push_str("</table>\n</div>\n");
    Ok(page.finish(scene.as_deref()))
}

/// The header, the names of the columns, and the rows of a table, of comma-separated values or of a JSON object on each
/// line.
fn rows(text: &str) -> (Vec<String>, Vec<String>, Vec<Value>) {
    if text.starts_with('{') {
        let rows: Vec<Value> = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        let columns = rows.first().and_then(Value::as_object).map(|row| row.keys().cloned().collect());
        let columns: Vec<_> = columns.unwrap_or_default();
        return (columns.clone(), columns, rows);
    }
    let mut lines = text.lines();
    let header = csv::names(lines.next().unwrap_or_default());
    let name = |column: &String| column.split(" [").next().unwrap_or_default().to_owned();
    let columns: Vec<_> = header.iter().map(name).collect();
    let rows = lines.map(|line| csv::parsed(&columns, line)).collect();
    (header, columns, rows)
}

/// The units in the report of a solve.
fn units_of_report(report: &Value) -> Units {
    let [length, pressure] = ["length_unit", "pressure_unit"].map(|key| report[key].as_str().map(str::to_owned));
    Units { length, pressure, force: None }
}

/// The units in the header of a table, or else those that the options in its scene name.
fn units_of_table(header: &[String], scene: Option<&str>) -> Units {
    let scene: Table = scene.and_then(|scene| scene.parse().ok()).unwrap_or_default();
    let unit = |column: &str, option: &str| {
        let start = format!("{column} [");
        let in_header = header.iter().find_map(|name| name.strip_prefix(&start)?.strip_suffix(']'));
        let in_scene = || scene.get("output")?.get(option)?.as_str();
        in_header.or_else(in_scene).map(str::to_owned)
    };
    Units {
        length: unit("mean_gap", "length-unit"),
        pressure: unit("mean_pressure", "pressure-unit"),
        force: unit("normal_force", "force-unit"),
    }
}

/// A value as people read it, with a number of a name as it is to be; none for what there is not.
fn shown(name: &str, value: &Value, number: &dyn Fn(&str, f64) -> String) -> Option<String> {
    let all = |parts: Vec<String>, between: &str| (!parts.is_empty()).then(|| parts.join(between));
    match value {
        Value::Null => None,
        Value::String(word) => Some(word.clone()),
        Value::Number(found) if found.is_f64() => found.as_f64().map(|found| number(name, found)),
        Value::Array(values) => {
            let between = if values.iter().any(Value::is_object) { "; " } else { " × " };
            all(values.iter().filter_map(|value| shown(name, value, number)).collect(), between)
        }
        Value::Object(values) => {
            let part = |(name, value): (&String, _)| Some(format!("{} {}", spaced(name), shown(name, value, number)?));
            all(values.iter().filter_map(part).collect(), ", ")
        }
        other => Some(other.to_string()),
    }
}

/// A name with spaces.
fn spaced(name: &str) -> String {
    name.replace('_', " ")
}

/// A text without characters that mean something in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
