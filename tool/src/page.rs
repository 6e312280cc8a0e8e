//! `asperity report`: the results of a run as one page for a browser.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_plot::Picture;
use asperity_plot::page::{LOOK, QUANTITY, ZOOM, escaped};
use asperity_scene::journal::state_path;
use asperity_scene::output::{OutputFile, check_apart, with_suffix, write_text};
use asperity_scene::{Kind, Outcome, keys, warnings};
use serde::Serialize;
use serde_json::{Value, json};

use crate::citation::{PAPER, PROGRAM};
use crate::columns::spaced;
use crate::command::Call;
use crate::pictures::MapColours;
use crate::printing::{name, say};
use crate::results::PAGE;
use crate::scene;
use crate::solve;
use crate::solved::units_of;

mod figures;
mod maps;
mod of_solve;
mod of_table;

pub use of_table::draw_loads;

keys! {
    /// Put the results of a run on one page for a browser.
    ///
    /// RESULTS is the folder of a solve, a pull-off, a leakage or a contact, or the table of a sweep, a cycle, an interface
    /// or a study. The page shows the numbers, the warnings, maps that can be zoomed, curves, the scene that repeats the run,
    /// and how to cite. It is one file, which loads nothing from elsewhere, to send to a colleague or to keep with the data.
    /// Maps and curves are drawn from the files in the folder, for a solve from gap.npy, pressure.npy and
    /// contact_pressure.npy.
    ///
    /// # Examples
    ///     asperity solve --heights heights.npy --mean-gap 0.04 --out results
    ///     asperity report results
    ///     asperity sweep --heights heights.npy --mean-gaps 0.05:0.04:3 --out sweep.csv
    ///     asperity report sweep.csv
    Options {
        "Output" {
            /// Folder of results, or table of a sweep, a cycle, an interface or a study
            results: PathBuf = Kind::file().positional(&["RESULTS"]).required(),
            /// File for the page [default: report.html in the folder, or FILE.html next to the table]
            out: Option<PathBuf> = Kind::file(),
            /// Replace a page that is there
            force: bool = Kind::switch(),
        }
    }
}

/// The resolution of the charts.
const FINE: f64 = 288.0;

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let Options { results, out, force } = scene.keys();
    let out = write(&results, out.as_deref(), force, &scene.keys(), scene.is_si())?;
    say(&format!("page in {}", name(&out)));
    Ok(true)
}

/// Writes the page of results into a file, or next to them, with colours that have limits in SI units or in no unit; its
/// path.
pub fn write(results: &Path, out: Option<&Path>, force: bool, colours: &MapColours, is_si: bool) -> Outcome<PathBuf> {
    let folder = results.is_dir();
    colours.check()?;
    if !folder && (colours.limits().is_some() || colours.colour_clusters) {
        let text = "has no maps for --colour-limits and --colour-clusters: name the folder of a solve";
        return Err(Error::file(results, text).into());
    }
    let beside = || if folder { results.join(PAGE) } else { with_suffix(results, ".html") };
    let out = out.map_or_else(beside, Path::to_path_buf);
    let read: Vec<_> = match folder {
        true => solve::files().iter().filter(|name| *name != PAGE).map(|name| results.join(name)).collect(),
        false => {
            vec![results.to_path_buf(), scene::path_for(results), warnings::path_for(results), state_path(results)]
        }
    };
    check_apart(&out, read.iter().map(PathBuf::as_path))?;
    let file = OutputFile::create(&out, force)?;
    let page = if folder { of_solve::page(results, colours, is_si)? } else { of_table::page(results)? };
    file.complete(|path| write_text(path, &page))?;
    Ok(out)
}

/// The figures of the report of a solve by their names, as its page has them.
pub fn figures(report: &Value) -> Vec<(String, String)> {
    let groups = of_solve::groups(report, &units_of(report)).into_iter().flat_map(|(_, figures)| figures);
    groups.map(|(name, value)| (spaced(&name), value)).collect()
}

/// A page as it grows.
#[derive(Default)]
struct Page {
    text: String,
}

impl Page {
    fn new(title: &str, subtitle: &str) -> Self {
        let title = escaped(title);
        let text = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width\"/>\n\
             <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{title}</title>\n\
             <style>\n{LOOK}{}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>{}</p>\n",
            include_str!("page/style.css"),
            escaped(subtitle)
        );
        Self { text }
    }

    /// The page of a folder, with its report, which ended so.
    fn of_folder(folder: &Path, report: &Value, end: &str) -> Self {
        let name = folder.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
        let [command, version] = ["command", "version"].map(|key| report[key].as_str().unwrap_or_default());
        Self::new(name.as_deref().unwrap_or("results"), &format!("asperity {command}, version {version}: {end}"))
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

    /// Pictures side by side under a heading, as many as there is room for.
    fn pictures(&mut self, heading: &str, Self { text }: &Self) {
        if !text.is_empty() {
            self.heading(heading);
            let _ = writeln!(self.text, "<div class=\"pictures\">\n{text}</div>");
        }
    }

    /// A picture.
    fn figure(&mut self, svg: &str) {
        let _ = writeln!(self.text, "<figure class=\"chart\">\n{svg}</figure>");
    }

    /// A map that can be zoomed, and read under the pointer by the key of its colours.
    fn map(&mut self, map: &Picture, lengths: impl Serialize, unit: Option<&str>) -> Outcome<()> {
        let (svg, told) = (map.svg()?, json!({ "lengths": lengths, "unit": unit, "key": map.key() }));
        let _ =
            writeln!(self.text, "<figure class=\"map\" data-map=\"{}\">\n{svg}</figure>", escaped(&told.to_string()));
        Ok(())
    }

    /// Figures by their names, as a table; folded away under a heading if that is given.
    fn figures(&mut self, folded: Option<&str>, figures: &[(String, String)]) {
        if figures.is_empty() {
            return;
        }
        let row = |(name, value): &(String, String)| {
            format!("<tr><th>{}</th><td>{}</td></tr>\n", escaped(&spaced(name)), escaped(value))
        };
        let table = format!("<table>\n{}</table>\n", figures.iter().map(row).collect::<String>());
        self.text.push_str(&match folded {
            Some(heading) => format!("<details><summary>{}</summary>\n{table}</details>\n", escaped(heading)),
            None => table,
        });
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
        // one script, in which what a file exports is there for the next one
        let lines = [QUANTITY, ZOOM, include_str!("page/maps.js")].into_iter().flat_map(str::lines);
        let lines = lines.filter(|line| !line.starts_with("import "));
        let script: String = lines.flat_map(|line| [line.strip_prefix("export ").unwrap_or(line), "\n"]).collect();
        let _ = write!(
            self.text,
            "<h2>How to cite</h2>\n<p>{program}</p>\n<p>{paper}</p>\n<script>\n{script}</script>\n</body>\n</html>\n"
        );
        self.text
    }
}
