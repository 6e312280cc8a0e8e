//! The page of a table of a sweep, a cycle or a study.

use asperity_scene::column::{APPROACH, CONTACT_FRACTION, MEAN_GAP, MEAN_PRESSURE, NORMAL_FORCE};
use std::fmt::Write;
use std::fs;
use std::path::Path;

use asperity::Error;
use asperity_plot::Picture;
use asperity_plot::page::escaped;
use asperity_scene::allowed::Range;
use asperity_scene::legs::{CASE, abscissa, value, varied};
use asperity_scene::list::parsed;
use asperity_scene::{Account, Format, Load, Outcome, Quantity, Step, Units, csv, dimension_of_key, key, warnings};
use serde_json::Value;
use toml::Table;

use super::figures::{place, shown};
use super::{FINE, Page};
use crate::columns::{Columns, spaced};
use crate::pictures::{PlotOptions, chart, chart_of_columns, chart_of_loads};
use crate::scene;

/// The page of a table of loads, or of a study.
pub fn page(table: &Path) -> Outcome<String> {
    let text = fs::read_to_string(table).map_err(|_| {
        let what = if table.exists() { "cannot be read as a table" } else { "does not exist" };
        Error::file(table, format!("{what}: name a folder of results, or the table of a sweep or a cycle"))
    })?;
    let (header, columns, rows) = rows(&text);
    let has = |name: &str| columns.iter().any(|column| column == name);
    if rows.is_empty() || !has("control_value") && !has("closure") {
        return Err(Error::file(table, "is no table of a sweep or a cycle: it has no column control_value").into());
    }
    let scene = fs::read_to_string(scene::path_for(table)).ok();
    let units = units_of_table(&header, scene.as_deref());
    let name = table.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let cycle = has("leg");
    let study = columns.first().is_some_and(|column| column == CASE);
    let command = match (study, cycle) {
        (true, _) => "study",
        (_, true) => "cycle",
        _ if has("closure") => "interface",
        _ => "sweep",
    };
    let mut page = Page::new(&name, &format!("asperity {command}: {} rows", rows.len()));
    let unconverged = rows.iter().filter(|row| is_bad(row)).count();
    let count = rows.len();
    let marked = format!("{unconverged} of {count} rows have not converged; they are marked in the table.");
    let said = warnings::read_beside(table)?.into_iter().map(|told| told.message);
    let left = scene.as_deref().filter(|_| !study).and_then(|scene| left_of(&rows, scene));
    let left = left
        .map(|left| format!("The table is not complete, {left}: asperity run {}.{} continues it.", name, scene::NAME));
    page.warnings(&left.into_iter().chain((unconverged > 0).then_some(marked)).chain(said).collect::<Vec<_>>());
    if cycle && !study {
        page.figures(None, &head_of_cycle(&rows, &units));
    }
    let mut curves = Page::default();
    for chart in charts(&rows, cycle, &units)? {
        curves.figure(&chart.svg()?);
    }
    page.pictures("Curves", &curves);
    page.heading("Rows");
    put_rows(&mut page, (&header, &columns, &rows), &units);
    Ok(page.finish(scene.as_deref()))
}

fn is_bad(row: &Value) -> bool {
    row[key!(Account, status)] != "converged"
}

/// Puts the rows of a table on a page.
fn put_rows(page: &mut Page, (header, columns, rows): (&[String], &[String], &[Value]), units: &Units) {
    // what no row has is left out, what is the same in all is folded, and the others stand as one asks for them
    let control = rows[0]["control"].as_str().unwrap_or_default();
    let held = control.replace('-', "_");
    let same = |column: &str| rows.iter().all(|row| row[column] == rows[0][column]);
    let is_there = |column: &str| match column {
        "control_value" => rows.iter().any(|row| {
            let [given, found] = [column, &held].map(|column| value(row, column));
            (given - found).abs() > 1e-6 * found.abs() || found.is_nan()
        }),
        _ => rows.iter().any(|row| !row[column].is_null()),
    };
    let filled = header.iter().zip(columns).filter(|(_, column)| is_there(column));
    let varied = varied(rows);
    let is_setting = |(_, column): &(&String, &String)| {
        !varied.contains(&column.as_str()) && same(column) && (rows.len() > 1 || place(column) == usize::MAX)
    };
    let (settings, mut kept): (Vec<_>, Vec<_>) = filled.partition(is_setting);
    let is_first = |column: &str| column == CASE || varied.contains(&column);
    kept.sort_by_key(|(_, column)| if is_first(column) { 0 } else { place(column).saturating_add(1) });
    let cells = |tag: &str, text: &dyn Fn(&str) -> String| -> String {
        kept.iter().map(|(_, column)| format!("<{tag}>{}</{tag}>", escaped(&text(column)))).collect()
    };
    let _ = writeln!(page.text, "<div class=\"rows\">\n<table>\n<tr>{}</tr>", cells("th", &Columns::label));
    let of = Columns::new(rows, units);
    let text = |row: &Value, column: &str| {
        let number = |name: &str, found| of.number(name, if name == column { of.value(row, name) } else { found });
        shown(column, &row[column], &number).unwrap_or_default()
    };
    for row in rows {
        let cells = cells("td", &|column| text(row, column));
        let _ = writeln!(page.text, "<tr{}>{cells}</tr>", if is_bad(row) { " class=\"bad\"" } else { "" });
    }
    page.text.push_str("</table>\n</div>\n");
    let same = |(_, column): (&String, &String)| (column.clone(), text(&rows[0], column));
    page.figures(Some("The same in all rows"), &settings.into_iter().map(same).collect::<Vec<_>>());
}

/// How far a table is that lacks rows of the loads in its scene.
fn left_of(rows: &[Value], scene: &str) -> Option<String> {
    let scene: Table = scene.parse().ok()?;
    let (name, list) = scene.get("loads")?.as_table()?.iter().find(|(name, _)| *name != "spring-stiffness")?;
    let key = name.replace('-', "_");
    let dimension = dimension_of_key(&key);
    let number = |text: &str| match dimension {
        Some(dimension) => dimension.within(Range::FINITE)(text),
        None => text.parse().map(Quantity::number).map_err(|_| String::new()),
    };
    let loads = parsed(&list.as_str().map_or_else(|| list.to_string(), str::to_owned), &number).ok()?.values;
    let (last, count, to) = (rows.last()?, loads.len(), loads.last()?);
    match last[key!(Step, leg)].as_u64() {
        None => (rows.len() < count).then(|| format!("it has {} of {count} rows", rows.len())),
        Some(leg) => {
            // a force is held by a mean pressure, and the position of a spring has no column of its own
            let found = value(last, Load::one_of(&key).unwrap_or_default());
            let found = if found.is_nan() { value(last, "control_value") } else { found };
            let is_there = dimension.is_none() || (found - to).abs() <= 1e-6 * to.abs();
            // a withdrawal ends where the surfaces are apart
            let shares = [CONTACT_FRACTION, "attractive_fraction"].map(|share| value(last, share));
            let is_apart = last[key!(Step, direction)] == "withdrawal" && shares == [0.0; 2];
            let is_over = leg as usize + 1 == count && (is_there || is_apart);
            (!is_over).then(|| format!("it ends on leg {leg} of {}", count - 1))
        }
    }
}

/// Draws the chart of the loads of a table, if it is wanted.
pub fn draw_loads(table: &Path, plot: &PlotOptions) -> Outcome<()> {
    let text = fs::read_to_string(table).map_err(|e| Error::unreadable(table, e))?;
    let (header, _, rows) = rows(&text);
    plot.draw(&rows, &units_of_table(&header, None), None)
}

/// What one asks of a cycle first: the pull-off, the jumps, and the energy that they dissipate. A body with a free
/// boundary has forces and energies, others have them over the area, too.
fn head_of_cycle(rows: &[Value], units: &Units) -> Vec<(String, String)> {
    let columns = Columns::new(rows, units);
    let free = !columns.are_per_area();
    let told = |row: &Value, column: &str| columns.number(column, columns.value(row, column));
    let mut figures = Vec::new();
    let least = rows.iter().enumerate().min_by(|(_, a), (_, b)| {
        let [a, b] = [a, b].map(|row| value(row, NORMAL_FORCE));
        a.total_cmp(&b)
    });
    if let Some((k, row)) = least.filter(|(_, row)| value(row, NORMAL_FORCE) < 0.0) {
        let (at, place) = if free { ("an approach", APPROACH) } else { ("a mean gap", MEAN_GAP) };
        // what the surfaces come to in an approach, or still bear at the end, is no pull-off
        let is_lost = row[key!(Step, direction)] == "withdrawal" && k + 1 < rows.len();
        let name = if is_lost { "pull-off force" } else { "greatest tensile force" };
        let force = columns.number(NORMAL_FORCE, -value(row, NORMAL_FORCE));
        figures.push((name.to_owned(), format!("at least {force}, at {at} of {}", told(row, place))));
        if !free {
            let tension = columns.number(MEAN_PRESSURE, -value(row, MEAN_PRESSURE));
            figures.push(("greatest tension".to_owned(), format!("at least {tension}")));
        }
    }
    let jumps: Vec<_> = rows.iter().filter(|row| value(row, "energy_drop") > 0.0).collect();
    let of = |direction: &str| jumps.iter().filter(|row| row[key!(Step, direction)] == direction).count();
    let (approach, withdrawal) = (of("approach"), of("withdrawal"));
    figures.push(("jumps".to_owned(), format!("{approach} in approach, {withdrawal} in withdrawal")));
    let per_area = if free { "" } else { " per area" };
    if let Some(last) = rows.last() {
        figures.push((format!("dissipated energy{per_area}"), told(last, "dissipated")));
        if last[key!(Account, plastic_energy)].is_number() {
            figures.push((format!("plastic work{per_area}"), told(last, "plastic_energy")));
        }
    }
    let drop = |row: &&&Value| value(row, "energy_drop");
    if let Some(most) = jumps.iter().max_by(|a, b| drop(a).total_cmp(&drop(b))) {
        figures.push((format!("greatest of a jump{per_area}"), told(most, "energy_drop")));
    }
    figures
}

/// The curves of a table, in the order in which one asks for them.
fn charts(rows: &[Value], cycle: bool, units: &Units) -> asperity::Result<Vec<Picture>> {
    let differs = |column: &str| rows.iter().any(|row| row[column] != rows[0][column]);
    let is_there = |column: &str| rows.iter().any(|row| !row[column].is_null());
    let drawn = |x: &str, label: &str, ys: &[(&str, &str)]| chart(rows, (x, label), ys, Vec::new(), units, FINE.into());
    let searched = is_there("wanted_contact_fraction");
    let load = if rows[0]["control"] == "normal-force" && !searched { NORMAL_FORCE } else { MEAN_PRESSURE };
    let free = is_there(APPROACH);
    let gap = if free { APPROACH } else { MEAN_GAP };
    // the curves of a study have their own names
    let (study, along) = (rows[0][CASE].is_u64(), abscissa(rows));
    let x = along.unwrap_or(if cycle { gap } else { load });
    let mut charts = Vec::new();
    if cycle && rows[0]["control"] == "spring" {
        // what is measured
        let y = if free { NORMAL_FORCE } else { MEAN_PRESSURE };
        charts.push(drawn("control_value", "position of the spring", &[("", y)])?);
    }
    let areas = [("counted", CONTACT_FRACTION), ("corrected", "corrected_contact_fraction")];
    charts.push(match cycle || along.is_some() || !differs(load) {
        true => chart_of_loads(rows, units, None, FINE.into())?,
        false if study || !is_there(areas[1].1) => drawn(load, &spaced(load), &[("", areas[0].1)])?,
        false => drawn(load, &spaced(load), &areas)?,
    });
    let leaks = [("along x", "transmissivity_x_upper"), ("along y", "transmissivity_y_upper")];
    let mut pairs = vec![("closure", MEAN_PRESSURE)];
    match along {
        Some(x) if is_there("pull_off_pressure") => pairs.extend([(x, CONTACT_FRACTION), (x, gap)]),
        Some(x) => pairs.push((x, gap)),
        None if !cycle => pairs.push((load, MEAN_GAP)),
        None => {}
    }
    pairs.extend(["contact_stiffness", "electrical_conductance", "thermal_conductance"].map(|y| (x, y)));
    if study {
        pairs.extend(leaks.map(|(_, y)| (x, y)));
    } else if differs(x) && leaks.iter().any(|(_, y)| differs(y)) {
        charts.push(drawn(x, &spaced(x), &leaks)?);
    }
    if along.is_none() {
        pairs.extend([CONTACT_FRACTION, if cycle { "dissipated" } else { "elastic_energy" }].map(|y| (gap, y)));
    }
    // what is the same in all rows needs no curve
    for (x, y) in pairs.into_iter().filter(|(x, y)| differs(x) && differs(y)) {
        charts.push(chart_of_columns(rows, x, y, units, FINE.into())?);
    }
    Ok(charts)
}

/// The header, the names of the columns, and the rows of a table, of comma-separated values or of a JSON object on each
/// line.
fn rows(text: &str) -> (Vec<String>, Vec<String>, Vec<Value>) {
    let format = if text.starts_with('{') { Format::Jsonl } else { Format::Csv };
    let (header, lines) = format.parts(text);
    let columns: Vec<_> = header.iter().map(|column| csv::bare(column).to_owned()).collect();
    let rows = lines.map(|line| format.parsed(&columns, line)).filter(Value::is_object).collect();
    (header, columns, rows)
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
        length: unit(MEAN_GAP, "length-unit"),
        pressure: unit(MEAN_PRESSURE, "pressure-unit"),
        force: unit(NORMAL_FORCE, "force-unit"),
    }
}
