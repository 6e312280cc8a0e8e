//! The legs of a table, and the axes of its charts.

use std::collections::{HashMap, HashSet};

use serde_json::Value;

use crate::account::{INPUTS, Step};

/// The most colours and dashes of a chart that have names.
const MOST_COLOURS: usize = 8;
const MOST_DASHES: usize = 4;

/// The column of the number of a case.
pub const CASE: &str = "case";

/// The first columns of the tables of cases.
const FIRST: [&str; 3] = ["leg", "control", "pull_off_pressure"];

/// The curves of one colour and dash in the chart of a table: parts of its rows that are not connected, with the names
/// of colour and dash, which may be empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg<'a> {
    /// The name of the colour.
    pub colour: String,
    /// The name of the dash.
    pub dash: String,
    /// The rows of each part.
    pub parts: Vec<Vec<&'a Value>>,
}

/// The value of a column, not a number where there is none.
pub fn value(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or(f64::NAN)
}

/// Whether the axes of columns `x` and `y` of rows are logarithmic: where the values along x span more than a decade, and
/// are spread more evenly so; along y if that spans a decade, too. A cycle has no logarithmic axes: the area of its
/// loop is an energy. A transmissivity, which falls to zero as the cube of the gap, is logarithmic wherever it spans a
/// decade.
pub fn logarithmic(rows: &[Value], x: &str, y: &str) -> [bool; 2] {
    let leaks = y.starts_with("transmissivity");
    let across = spread(rows.iter().map(|row| value(row, x)));
    let up = spread(rows.iter().map(|row| value(row, y)).filter(|value| !leaks || *value != 0.0));
    // more than a decade, but for rounding
    let is_wide = |[low, _, high]: [f64; 3]| low > 0.0 && high > 9.99 * low;
    // the one in the middle is nearer to the geometric mean of the ends than to their arithmetic mean
    let is_geometric = |[low, median, high]: [f64; 3]| median * median < (low * high).sqrt() * (0.5 * (low + high));
    let x_log = !is_cycle(rows) && across.is_some_and(|x| is_wide(x) && is_geometric(x));
    [x_log, (x_log || leaks) && up.is_some_and(is_wide)]
}

/// Whether rows belong to a cycle.
fn is_cycle(rows: &[Value]) -> bool {
    rows.first().is_some_and(|row| row[crate::key!(Step, leg)].is_u64())
}

/// The least, the median and the greatest of values that are finite, if there are any.
fn spread(values: impl Iterator<Item = f64>) -> Option<[f64; 3]> {
    let mut values: Vec<_> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    Some([*values.first()?, values[(values.len() - 1) / 2], *values.last()?])
}

/// The legs of a table over column `x`: of a sweep the loads that rise or fall, of a cycle its legs, which begin with the
/// row before them, and of a study its cases, by the values that they vary, each of a column as it is `told`. A single
/// one has no name.
pub fn legs<'a>(rows: &'a [Value], x: &str, told: impl Fn(&str, f64) -> String) -> Vec<Leg<'a>> {
    if rows.first().is_some_and(|row| row[CASE].is_u64()) {
        return cases(rows, x, &told);
    }
    let load = |row: &Value| value(row, "control_value");
    let cycle = is_cycle(rows);
    let direction = |k: usize| match &rows[k]["direction"] {
        Value::String(name) => name.clone(),
        _ => if load(&rows[k]) < load(&rows[k - 1]) { "falling" } else { "rising" }.to_owned(),
    };
    // the first row is a start and no leg
    let same = |k: usize| if cycle { rows[k]["leg"] == rows[k - 1]["leg"] } else { direction(k) == direction(k - 1) };
    let mut starts = vec![0];
    starts.extend((2..rows.len()).filter(|&k| !same(k)).map(|k| k - 1));
    let ends = starts.iter().skip(1).map(|start| start + 1).chain([rows.len()]);
    let count = starts.len();
    let number = |k: usize| if count > 2 { format!(" {}", k / 2 + 1) } else { String::new() };
    let leg = |(k, (&start, end)): (usize, (&usize, usize))| {
        let colour = if count > 1 { direction(start + 1) + &number(k) } else { String::new() };
        Leg { colour, dash: String::new(), parts: vec![rows[start..end].iter().collect()] }
    };
    starts.iter().zip(ends).enumerate().map(leg).collect()
}

/// The columns that a study varies: those between the number of the case and the load, and of the inputs those that are
/// not the same in all rows. None of another table.
pub fn varied(rows: &[Value]) -> Vec<&str> {
    let Some(first) = rows.first().filter(|row| row[CASE].is_u64()) else { return Vec::new() };
    let mut keys = first.as_object().into_iter().flat_map(|row| row.keys().map(String::as_str));
    let own = keys.by_ref().skip_while(|key| *key != CASE).skip(1).take_while(|key| !FIRST.contains(key));
    let mut varied: Vec<_> = own.collect();
    let differs =
        |key: &&str| INPUTS.split(' ').any(|input| input == *key) && rows.iter().any(|row| row[*key] != first[*key]);
    varied.extend(keys.filter(differs));
    varied
}

/// The column along which the cases of a study lie, where each has a single row: of the numbers that vary, but for the
/// seed, the one with the most values.
pub fn abscissa(rows: &[Value]) -> Option<&str> {
    let mut columns = varied(rows);
    columns.retain(|column| *column != "seed" && rows.iter().all(|row| row[*column].is_number()));
    let found = columns.into_iter().max_by_key(|column| distinct(rows, &[column]))?;
    let is_single = rows.windows(2).all(|two| two[0][CASE] != two[1][CASE]);
    (is_single && distinct(rows, &[found]) > 1).then_some(found)
}

/// The number of combinations of values that rows have in columns.
fn distinct(rows: &[Value], columns: &[&str]) -> usize {
    let values = |row: &Value| columns.iter().map(|column| row[*column].to_string()).collect::<Vec<_>>();
    rows.iter().map(values).collect::<HashSet<_>>().len()
}

/// The cases of a study over column `x`, by the other columns that vary: columns that determine each other are one key,
/// the key with the fewest values is told by the dash, and the others by the colour, as far as there are colours. Where
/// there are more cases than these, a seed names none: surfaces of several seeds are samples of one.
fn cases<'a>(rows: &'a [Value], x: &str, told: &dyn Fn(&str, f64) -> String) -> Vec<Leg<'a>> {
    let mut columns = varied(rows);
    let is_along = columns.contains(&x);
    let count = |columns: &[&str]| distinct(rows, columns);
    columns.retain(|column| !is_along || count(&[x, column]) > count(&[x]));
    let mut parts: Vec<Vec<&Value>> = Vec::new();
    let mut known = HashMap::new();
    for row in rows {
        let case = if is_along { Value::Null } else { row[CASE].clone() };
        let key = columns.iter().map(|column| &row[*column]).chain([&case]).map(Value::to_string).collect::<Vec<_>>();
        let k = *known.entry(key).or_insert(parts.len());
        if k == parts.len() {
            parts.push(Vec::new());
        }
        parts[k].push(row);
    }
    if is_along {
        parts.iter_mut().for_each(|part| part.sort_by(|a, b| value(a, x).total_cmp(&value(b, x))));
    }
    let name = |part: &[&Value], columns: &[&str]| {
        let named = |column: &&str| {
            let value = match &part[0][*column] {
                Value::Null => return None,
                Value::String(text) => text.clone(),
                Value::Number(number) if number.is_f64() => told(column, number.as_f64().unwrap_or(f64::NAN)),
                other => other.to_string(),
            };
            Some(format!("{} {value}", column.replace('_', " ")))
        };
        columns.iter().filter_map(named).collect::<Vec<_>>().join(", ")
    };
    columns.retain(|column| count(&[column]) > 1 && (parts.len() <= MOST_COLOURS || *column != "seed"));
    let mut keys: Vec<Vec<&str>> = Vec::new();
    for column in columns {
        let joined = |key: &Vec<&str>| count(&[&key[..], &[column]].concat()) == count(key).max(count(&[column]));
        match keys.iter_mut().find(|key| joined(key)) {
            Some(key) => key.push(column),
            None => keys.push(vec![column]),
        }
    }
    let fewest = (0..keys.len()).rev().min_by_key(|k| count(&keys[*k]));
    let dashed = fewest.filter(|k| keys.len() > 1 && count(&keys[*k]) <= MOST_DASHES);
    let dash = dashed.map(|k| keys.remove(k)).unwrap_or_default();
    keys.sort_by_cached_key(|key| count(key));
    let colour = keys.into_iter().fold(Vec::new(), |colour, key| {
        let more = [colour.clone(), key].concat();
        if count(&more) > MOST_COLOURS { colour } else { more }
    });
    let mut legs: Vec<Leg<'_>> = Vec::new();
    for part in parts {
        let [colour, dash] = [&colour, &dash].map(|columns| name(&part, columns));
        match legs.iter_mut().find(|leg| (&leg.colour, &leg.dash) == (&colour, &dash)) {
            Some(leg) => leg.parts.push(part),
            None => legs.push(Leg { colour, dash, parts: vec![part] }),
        }
    }
    legs
}
