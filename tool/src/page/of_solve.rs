//! The page of a folder: of a solve, of the last state of a pull-off, or of what follows a solve.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use asperity::Error;
use asperity::accuracy::Quantity;
use asperity_scene::{
    Account, Adhesion, ENERGY, ENERGY_PER_AREA, Elastic, GROUPS, GridErrors, Inputs, Measure, Notice, OF_ADHESION,
    Outcome, PRESSURE, PulledOff, Units, corrected, key,
};
use serde::Deserialize;
use serde_json::Value;

use super::figures::{is_constant, place, shown};
use super::maps::resolution;
use super::{FINE, Page};
use crate::columns::spaced;
use crate::contact;
use crate::leak;
use crate::pictures::MapColours;
use crate::report::LAST;
use crate::results::{Contents, REPORT};
use crate::scene;
use crate::solved::{Solved, units_of};

/// The page of a folder of results.
pub fn page(folder: &Path, colours: &MapColours, is_si: bool) -> Outcome<String> {
    let path = folder.join(REPORT);
    let text = fs::read_to_string(&path).map_err(|_| {
        Error::file(&path, "is not there: name a folder of results, or the table of a sweep or a cycle")
    })?;
    let mut report: Value =
        serde_json::from_str(&text).map_err(|e| Error::file(&path, format!("is no report of asperity: {e}")))?;
    let command = report[key!(Account, command)].as_str().unwrap_or_default().to_owned();
    let longest = report[key!(Inputs, shape)].as_array().into_iter().flatten().filter_map(Value::as_u64).max();
    let paper = resolution(longest.unwrap_or_default());
    match &*command {
        "solve" | "demo" => {}
        "pull-off" => {
            // of the last state that holds
            let mut all = report[LAST].as_object().cloned().unwrap_or_default();
            all.extend(report.as_object().cloned().unwrap_or_default().into_iter().filter(|(key, _)| key != LAST));
            report = all.into();
        }
        "leak" => return page_of(folder, &report, leak::contents(folder, &report, paper)?),
        "contact" => return page_of(folder, &report, contact::contents(folder, &report, FINE.into())?),
        other => return Err(Error::file(&path, format!("is of asperity {other}, which has no page")).into()),
    }
    let solved = Solved { folder, report };
    let (report, units) = (&solved.report, solved.units());
    let scene = fs::read_to_string(folder.join(scene::NAME)).ok();
    let status = report[key!(Account, status)].as_str().unwrap_or_default();
    let mut page = Page::of_folder(folder, report, status);

    let mut warnings = warnings_of(report);
    if is_si && units.pressure.as_deref() != Some(PRESSURE.si) {
        return Err("--colour-limits has a unit, but the pressures of this run are not in Pa: give its numbers".into());
    }
    let mut maps = Page::default();
    if let Err(error) = super::maps::draw(&mut maps, &solved, &units, colours) {
        warnings.push(format!("There are no maps on this page: {error}"));
        maps = Page::default();
    }
    page.warnings(&warnings);
    page.heading("Numbers");
    page.text.push_str("<div class=\"groups\">\n");
    for (heading, figures) in groups(report, &units) {
        let _ = writeln!(page.text, "<section>\n<h3>{heading}</h3>");
        page.figures(None, &figures);
        page.text.push_str("</section>\n");
    }
    page.text.push_str("</div>\n");
    page.pictures("Maps and curves", &maps);
    page.heading("Surface and settings");
    put_inputs(&mut page, report, &units);
    Ok(page.finish(scene.as_deref()))
}

/// What a reader of a report has to know first.
fn warnings_of(report: &Value) -> Vec<String> {
    let status = report[key!(Account, status)].as_str().unwrap_or_default();
    let unconverged = format!("The solve has not converged, it is {status}: the answer may be wrong.");
    let open = "The pull-off is not found to its tolerance: the surfaces may bear more than is found here.".to_owned();
    let said: Vec<Notice> = serde_json::from_value(report[key!(Account, warnings)].clone()).unwrap_or_default();
    let unconverged = (status != "converged").then_some(unconverged);
    let open = (report[key!(PulledOff, reached)] == false).then_some(open);
    unconverged.into_iter().chain(open).chain(said.iter().map(Notice::to_string)).collect()
}

/// Puts the inputs of a solve on a page, and the levels of nested grids.
fn put_inputs(page: &mut Page, report: &Value, units: &Units) {
    let number = number_of(report, units);
    let (levels, others): (Vec<_>, Vec<_>) = report
        .as_object()
        .into_iter()
        .flatten()
        .filter(|(key, _)| {
            *key != "warnings" && *key != "grid_error_reason" && (place(key) == usize::MAX || is_constant(key, report))
        })
        .partition(|(key, _)| *key == "levels");
    let others = others.into_iter().filter_map(|(key, value)| Some((key.clone(), shown(key, value, &number)?)));
    page.figures(Some("All inputs"), &others.collect::<Vec<_>>());
    for (_, levels) in levels {
        let level = |level: &Value| {
            let shape = shown("shape", &level[key!(Inputs, shape)], &number)?;
            let rest = level.as_object()?.iter().filter(|(key, _)| *key != "shape");
            let rest = rest.filter_map(|(key, value)| Some(format!("{} {}", spaced(key), shown(key, value, &number)?)));
            Some((shape, rest.collect::<Vec<_>>().join(", ")))
        };
        let levels: Vec<_> = levels.as_array().into_iter().flatten().filter_map(level).collect();
        page.figures(Some("Levels of nested grids"), &levels);
    }
}

/// The page of a folder with these contents, and with its report.
fn page_of(folder: &Path, report: &Value, contents: Contents) -> Outcome<String> {
    let (units, Contents { figures, shortfall, pictures }) = (units_of(report), contents);
    let mut page = Page::of_folder(folder, report, if shortfall.is_some() { "not reached" } else { "done" });
    page.warnings(shortfall.as_slice());
    page.heading("Numbers");
    page.figures(None, &figures);
    let mut drawn = Page::default();
    for picture in pictures {
        match picture.key() {
            [] => drawn.figure(&picture.svg()?),
            _ => drawn.map(&picture, &report[key!(Inputs, lengths)], units.length.as_deref())?,
        }
    }
    page.pictures("Maps and curves", &drawn);
    page.heading("Settings");
    // what is known along axes is among the figures
    let inputs =
        report.as_object().into_iter().flatten().filter(|(_, value)| value.get("x").is_none_or(Value::is_null));
    let number = number_of(report, &units);
    let inputs = inputs.filter_map(|(key, value)| Some((key.clone(), shown(key, value, &number)?)));
    page.figures(Some("All inputs"), &inputs.collect::<Vec<_>>());
    Ok(page.finish(fs::read_to_string(folder.join(scene::NAME)).ok().as_deref()))
}

/// What writes the numbers of a report, by their keys.
fn number_of<'a>(report: &'a Value, units: &'a Units) -> impl Fn(&str, f64) -> String + use<'a> {
    let control = report[key!(Account, control)].as_str().unwrap_or_default();
    let on_line = report[key!(Inputs, shape)][1] == 1;
    let counted = report[key!(Account, contact_fraction)].as_f64().unwrap_or_default();
    move |key, value| match Measure::find(key, control, on_line) {
        // a window around a tip is no area of its energy
        Measure::Of(ENERGY_PER_AREA) if report[key!(Elastic, boundary)] == "free" && key.ends_with("_energy") => {
            let area: f64 =
                report[key!(Inputs, lengths)].as_array().into_iter().flatten().filter_map(Value::as_f64).product();
            units.number(area * value, ENERGY)
        }
        _ if key == "corrected_contact_fraction" => corrected(value, counted),
        // the distance of another branch, or of a departure, is relative; a column of tables with this name is a length
        _ if key == "distance" => Measure::Share.text(value, units),
        measure => measure.text(value, units),
    }
}

/// The error of the grid in the words of a summary, or the reason why there is none; nothing without nested grids.
fn error_of_grid(report: &Value) -> Option<String> {
    let errors = GridErrors::deserialize(&report[key!(Account, grid_error)]).ok()?;
    let words =
        errors.in_words(report[key!(Account, accuracy)].get("of").and_then(|of| Quantity::deserialize(of).ok()));
    words.or_else(|| Some(format!("unknown: {}", report[key!(Account, grid_error_reason)].as_str()?)))
}

/// The figures of a report by their names, in groups with a heading.
pub fn groups(report: &Value, units: &Units) -> Vec<(&'static str, Vec<(String, String)>)> {
    let number = number_of(report, units);
    // the load is said once, under its own name
    let given = report[key!(Account, control)].as_str().unwrap_or_default().replace('-', "_");
    let once = |key: &str| match key {
        _ if is_constant(key, report) => false,
        "control" | "control_value" => !report[given.as_str()].is_f64(),
        "absent_nodes" => report[key] != 0,
        "under_resolved" => report[key] != false,
        _ if report[key!(Adhesion, law)] == "none" => {
            !OF_ADHESION.split_whitespace().any(|of_adhesion| of_adhesion == key)
        }
        _ => true,
    };
    let figure = |key: &str| {
        if key == "grid_error" {
            return Some(("error_of_the_grid".to_owned(), error_of_grid(report)?));
        }
        let name = if key == given { format!("{key}, given") } else { key.to_owned() };
        Some((name, shown(key, report.get(key)?, &number)?))
    };
    let group = |keys: &str| keys.split_whitespace().filter(|key| once(key)).filter_map(figure).collect::<Vec<_>>();
    GROUPS.into_iter().map(|(heading, keys)| (heading, group(keys))).filter(|(_, found)| !found.is_empty()).collect()
}
