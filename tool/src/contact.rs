//! `asperity contact`: the contact of a solve in tables and charts.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::{Error, Grid};
use asperity_plot::{Chart, Paper, Picture};
use asperity_scene::contact::{ContactFigures, ContactTables, Density, Spot};
use asperity_scene::output::write_text;
use asperity_scene::{
    Account, Dimension, Inputs, Kind, LENGTH, Outcome, PER_LENGTH, PER_PRESSURE, PRESSURE, Units, csv, key, keys,
};
use serde_json::{Value, json};

use crate::command::Call;
use crate::pictures::{FormatKeys, PaperOptions};
use crate::printing::{Printing, aligned};
use crate::report;
use crate::results::{self, Contents, Results, write_report};
use crate::solved::{CONTACT_PRESSURE, GAP, Solved, units_of};

keys! {
    /// Tabulate and chart the contact of a solve.
    ///
    /// The tables are the distributions of gap and contact pressure, the autocorrelation of the pressure, and the clusters.
    /// SOLVED is the folder of a solve, from which gap.npy, contact_pressure.npy and report.json are read. Near the edge of
    /// the contact the densities of gap and contact pressure are powers of them, with the exponents -1/3 and 1 at a hard
    /// wall without adhesion. The exponents are determined in a window above the values of the nodes next to the edge,
    /// where the grid distorts the density; if no window fits, they are unknown. The autocorrelation of the contact
    /// pressure is about its mean and over its variance, in a periodic cell.
    ///
    /// # Examples
    ///     asperity solve --heights heights.npy --mean-pressure 0.01 --out pressed
    ///     asperity contact pressed
    ///     asperity contact pressed --out contact --picture-format svg
    Options {
        "Output" {
            /// Folder of a solve
            solved: PathBuf = Kind::file().positional(&["SOLVED"]).required(),
            /// Folder for gap.csv and pressure.csv, the densities over the nodes in bins that are equally wide in the
            /// logarithm, autocorrelation.csv, clusters.csv with area, perimeter and force of each, a chart of each of
            /// these, report.json, and scene.toml
            out: Option<PathBuf> = Kind::folder(),
            /// Replace results that are there
            force: bool = Kind::switch(),
        }
    }
}

/// The names of the tables and of their charts.
const NAMES: [&str; 4] = ["gap", "pressure", "autocorrelation", "clusters"];

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let (Options { solved: folder, out, force }, FormatKeys { picture_format }) = (scene.keys(), scene.keys());
    let (paper, printing) = (scene.keys::<PaperOptions>().paper(), scene.keys::<Printing>());
    let folder = &*folder;
    let files = || results::files(&NAMES.map(|name| format!("{name}.csv")).each_ref().map(String::as_str), &NAMES);
    let results = out.as_deref().map(|out| Results { out, scene, files: files(), force });
    results.iter().try_for_each(|results| results.check(Solved::files(folder, &[GAP, CONTACT_PRESSURE])))?;
    let solved = Solved::read(folder)?;
    let [gap, pressure] = [solved.map(GAP)?, solved.map(CONTACT_PRESSURE)?];
    let lengths = gap.lengths.ok_or_else(|| Error::file(folder, "has a report.json without side lengths"))?;
    let grid = Grid::new(gap.heights.dim(), lengths)?;
    let (boundary, is_original) = (solved.boundary(), solved.is_original());
    let tables = ContactTables::measure(gap.heights.view(), pressure.heights.view(), grid, boundary, is_original)?;
    let (figures, units) = (tables.figures(), solved.units());
    let report = || {
        let inputs = json!({
            "solved": folder.to_string_lossy(),
            "shape": grid.shape(),
            "lengths": grid.lengths(),
            "length_unit": units.length,
            "pressure_unit": units.pressure,
            "boundary": boundary,
            "version": env!("CARGO_PKG_VERSION"),
        });
        report::report("contact", json!(figures), &inputs)
    };
    let write = |results: &Results<'_>| {
        let found = Charts { tables: &tables, grid, units: &units, paper };
        let parts = NAMES.into_iter().zip(found.parts()?).filter_map(|(name, part)| Some((name, part?)));
        let parts: Vec<_> = parts.collect();
        results.write(results.folder()?, |folder| {
            write_report(folder, &report())?;
            parts.iter().try_for_each(|(name, (table, chart))| {
                write_text(&folder.path(&format!("{name}.csv")), table)?;
                chart.write(folder.path(&picture_format.file(name)))
            })
        })?;
        Outcome::Ok(results.list())
    };
    let told = results.as_ref().map(write).transpose()?;
    printing.say(&aligned(&figures.rows(&units)));
    told.iter().for_each(|told| printing.say(told));
    printing.report(report);
    Ok(true)
}

/// The rows of one of the tables in a folder of this command; none if it has none.
fn rows<const N: usize>(folder: &Path, name: &str) -> Outcome<Vec<[f64; N]>> {
    let path = folder.join(format!("{name}.csv"));
    let text = fs::read_to_string(&path).unwrap_or_default();
    let row = |line: &str| {
        let cells: Option<Vec<f64>> = line.split(',').map(|cell| cell.parse().ok()).collect();
        cells.and_then(|cells| cells.try_into().ok())
    };
    let found = text.lines().skip(1).map(row).collect::<Option<_>>();
    Ok(found.ok_or_else(|| Error::file(&path, format!("has rows of other than {N} numbers: write the folder anew")))?)
}

/// The contents of a folder of this command, with its report.
pub fn contents(folder: &Path, report: &Value, paper: Paper) -> Outcome<Contents> {
    let (figures, units): (ContactFigures, _) = (serde_json::from_value(report.clone())?, units_of(report));
    let (shape, lengths) = serde_json::from_value(json!([report[key!(Inputs, shape)], report[key!(Inputs, lengths)]]))?;
    let density = |name: &str, exponent| {
        let rows = rows::<3>(folder, name)?;
        let edges = rows.iter().map(|row| row[0]).chain(rows.last().map(|row| row[1])).collect();
        Outcome::Ok(Density { edges, density: rows.iter().map(|row| row[2]).collect(), exponent })
    };
    let spot = |row: &[f64; 4]| Spot { nodes: row[0] as usize, area: row[1], perimeter: row[2], force: row[3] };
    let tables = ContactTables {
        gap: density("gap", figures.gap_exponent)?,
        pressure: density("pressure", figures.pressure_exponent)?,
        autocorrelation: rows::<2>(folder, "autocorrelation")?.iter().map(|row| (row[0], row[1])).collect(),
        spots: rows(folder, "clusters")?.iter().map(spot).collect(),
        mean_contact_pressure: figures.mean_contact_pressure,
    };
    let found = Charts { tables: &tables, grid: Grid::new(shape, lengths)?, units: &units, paper };
    let pictures = found.parts()?.into_iter().flatten().map(|(_, chart)| chart).collect();
    Ok(Contents { figures: figures.rows(&units), shortfall: None, pictures })
}

/// A table, and its chart, where there is one.
type Part = Option<(String, Picture)>;

/// The tables that were found, with all that their files have.
struct Charts<'a> {
    tables: &'a ContactTables,
    grid: Grid,
    units: &'a Units,
    paper: Paper,
}

impl Charts<'_> {
    fn parts(&self) -> asperity::Result<[Part; 4]> {
        let (gap, pressure) = (&self.tables.gap, &self.tables.pressure);
        Ok([
            self.density(gap, ["gap", "gap", "g^(-1/3)"], -1.0 / 3.0, [LENGTH, PER_LENGTH])?,
            self.density(pressure, ["pressure", "contact pressure", "p"], 1.0, [PRESSURE, PER_PRESSURE])?,
            self.autocorrelation()?,
            self.clusters()?,
        ])
    }

    /// The density of a gap or a pressure, bin by bin, and its chart next to its power near the edge of the contact in
    /// the window of its exponent, if there is one.
    fn density(
        &self,
        found: &Density,
        [of, label, law]: [&str; 3],
        power: f64,
        dimensions: [Dimension; 2],
    ) -> asperity::Result<Part> {
        if found.density.is_empty() {
            return Ok(None);
        }
        let columns = [format!("from_{of}"), format!("to_{of}"), format!("{of}_density")];
        let names = self.units.columns(&columns.each_ref().map(String::as_str), "", false);
        let points = found.points(self.grid.nodes());
        let caption = found.exponent.map(|found| format!("exponent {:.3} in the window of the line", found.exponent));
        let guide = found.exponent.and_then(|window| {
            let middle = (window.from * window.to).sqrt();
            let beside = |point: &(f64, f64)| (point.0 / middle).ln().abs();
            let (at, density) = *points.iter().min_by(|a, b| beside(a).total_cmp(&beside(b)))?;
            Some([window.from, window.to].map(|value| (value, density * (value / at).powf(power))).to_vec())
        });
        let [x_unit, y_unit] = dimensions.map(|dimension| self.units.unit(dimension));
        let chart = Chart {
            title: &format!("Distribution of the {label}"),
            caption: caption.as_deref().unwrap_or_default(),
            x_label: label,
            x_unit: x_unit.as_deref(),
            x_log: true,
            y_label: "probability density",
            y_unit: y_unit.as_deref(),
            y_log: true,
            curves: [("", points)].into_iter().chain(guide.map(|guide| (law, guide))).collect(),
            ..Chart::default()
        };
        Ok(Some((csv::density(names, &found.edges, &found.density), chart.draw(self.paper)?)))
    }

    /// The autocorrelation of the pressure by the distance.
    fn autocorrelation(&self) -> asperity::Result<Part> {
        let found = &self.tables.autocorrelation;
        if found.is_empty() {
            return Ok(None);
        }
        let names = self.units.columns(&["distance", "autocorrelation"], "", false);
        let chart = Chart {
            title: "Autocorrelation of the contact pressure",
            x_label: "distance",
            x_unit: self.units.length.as_deref(),
            x_log: true,
            y_label: "autocorrelation",
            curves: vec![("", found.iter().copied().filter(|(lag, _)| *lag > 0.0).collect())],
            ..Chart::default()
        };
        let lines = found.iter().map(|(distance, value)| format!("{distance:e},{value:e}"));
        Ok(Some((csv::table(names, lines), chart.draw(self.paper)?)))
    }

    /// The clusters of contact, the largest first.
    fn clusters(&self) -> asperity::Result<Part> {
        let (spots, on_line) = (&self.tables.spots, self.grid.is_line());
        if spots.is_empty() {
            return Ok(None);
        }
        let known = if on_line { Units::default() } else { self.units.clone() };
        let names =
            known.columns(&["nodes", "area", key!(Account, perimeter), key!(Account, normal_force)], "", on_line);
        // a step at each area, from the largest on
        let count = |(k, area): (usize, f64)| [(area, k.max(1) as f64), (area, (k + 1) as f64)];
        let extent = if on_line { "length" } else { "area" };
        let unit = self.units.length.as_ref().map(|unit| if on_line { unit.clone() } else { format!("{unit}²") });
        let chart = Chart {
            title: "Clusters of contact",
            x_label: &format!("{extent} of a cluster"),
            x_unit: unit.as_deref(),
            x_log: true,
            y_label: &format!("clusters of that {extent} or more"),
            y_log: true,
            curves: vec![("", spots.iter().map(|spot| spot.area).enumerate().flat_map(count).collect())],
            ..Chart::default()
        };
        let line = |spot: &Spot| format!("{},{:e},{:e},{:e}", spot.nodes, spot.area, spot.perimeter, spot.force);
        Ok(Some((csv::table(names, spots.iter().map(line)), chart.draw(self.paper)?)))
    }
}
