//! The legs of a table, and the axes of its charts.

use serde_json::Value;

use crate::account::INPUTS;

/// The most curves of a study that a chart names: it has as many colours.
const MOST_NAMED: usize = 8;

/// The value of a column, not a number where there is none.
pub fn value(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or(f64::NAN)
}

/// Whether the axes of columns `x` and `y` of rows are logarithmic: where the values along x span more than a decade, and
/// are spread more evenly so; along y if that spans a decade, too. Those of a cycle are not: the area of its loop is an
/// energy.
pub fn logarithmic(rows: &[Value], x: &str, y: &str) -> [bool; 2] {
    let [across, up] = [x, y].map(|column| spread(rows, column));
    // more than a decade, but for rounding
    let is_wide = |[low, _, high]: [f64; 3]| low > 0.0 && high > 9.99 * low;
    // the one in the middle is nearer to the geometric mean of the ends than to their arithmetic mean
    let is_geometric = |[low, median, high]: [f64; 3]| median * median < (low * high).sqrt() * (0.5 * (low + high));
    let x_log = !is_cycle(rows) && across.is_some_and(|x| is_wide(x) && is_geometric(x));
    [x_log, x_log && up.is_some_and(is_wide)]
}

/// Whether rows are those of a cycle.
fn is_cycle(rows: &[Value]) -> bool {
    rows.first().is_some_and(|row| row["leg"].is_u64())
}

/// The least, the median and the greatest of the values of a column that are finite, if there are any.
fn spread(rows: &[Value], column: &str) -> Option<[f64; 3]> {
    let mut values: Vec<_> = rows.iter().map(|row| value(row, column)).filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    Some([*values.first()?, values[(values.len() - 1) / 2], *values.last()?])
}

/// The parts of a table for one curve each, with its name: of a sweep the loads that rise or fall, of a cycle its legs,
/// which begin with the row before them, and of a study its cases, by the numbers that they vary, each of a column as it
/// is `told`. A single curve has no name.
pub fn legs(rows: &[Value], told: impl Fn(&str, f64) -> String) -> Vec<(String, Vec<&[Value]>)> {
    if rows.first().is_some_and(|row| row["case"].is_u64()) {
        return cases(rows, &told);
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
    let legs: Vec<_> = starts.iter().zip(ends).map(|(&start, end)| &rows[start..end]).collect();
    if legs.len() < 2 {
        return vec![(String::new(), legs)];
    }
    let number = |k: usize| if legs.len() > 2 { format!(" {}", k / 2 + 1) } else { String::new() };
    starts.iter().enumerate().map(|(k, start)| (direction(start + 1) + &number(k), vec![legs[k]])).collect()
}

/// The columns that a study varies: those between the number of the case and the load, and of the inputs those that are
/// not the same in all rows. None of another table.
pub fn varied(rows: &[Value]) -> Vec<&str> {
    let Some(first) = rows.first().filter(|row| row["case"].is_u64()) else { return Vec::new() };
    let mut keys = first.as_object().into_iter().flat_map(|row| row.keys().map(String::as_str));
    let own =
        keys.by_ref().skip_while(|key| *key != "case").skip(1).take_while(|key| !["leg", "control"].contains(key));
    let mut varied: Vec<_> = own.collect();
    let differs =
        |key: &&str| INPUTS.split(' ').any(|input| input == *key) && rows.iter().any(|row| row[*key] != first[*key]);
    varied.extend(keys.filter(differs));
    varied
}

/// The cases of a study under the values that they vary; where there are more cases than colours, those together whose
/// values agree in the columns with the fewest of them. A seed then names none: surfaces of several seeds are samples of
/// one.
fn cases<'a>(rows: &'a [Value], told: &dyn Fn(&str, f64) -> String) -> Vec<(String, Vec<&'a [Value]>)> {
    let cases: Vec<_> = rows.chunk_by(|row, next| row["case"] == next["case"]).collect();
    let few = cases.len() <= MOST_NAMED;
    let mut columns = varied(rows);
    columns.retain(|column| few || *column != "seed");
    let count = |columns: &[&str]| grouped(&cases, columns, told).len();
    columns.sort_by_cached_key(|column| count(&[column]));
    let mut naming: Vec<&str> = Vec::new();
    for column in columns {
        naming.push(column);
        if count(&naming) > MOST_NAMED {
            naming.pop();
        }
    }
    let mut found = grouped(&cases, &naming, told);
    if let [(name, _)] = &mut *found {
        name.clear();
    }
    found
}

/// The cases by their values in some columns, which are their names.
fn grouped<'a>(
    cases: &[&'a [Value]],
    columns: &[&str],
    told: &dyn Fn(&str, f64) -> String,
) -> Vec<(String, Vec<&'a [Value]>)> {
    let mut found: Vec<(String, Vec<&[Value]>)> = Vec::new();
    for case in cases {
        let named = |column: &&str| {
            let value = match &case[0][*column] {
                Value::Null => return None,
                Value::String(text) => text.clone(),
                Value::Number(number) if number.is_f64() => told(column, number.as_f64().unwrap_or(f64::NAN)),
                other => other.to_string(),
            };
            Some(format!("{} {value}", column.replace('_', " ")))
        };
        let name = columns.iter().filter_map(named).collect::<Vec<_>>().join(", ");
        match found.iter_mut().find(|(known, _)| *known == name) {
            Some((_, cases)) => cases.push(case),
            None => found.push((name, vec![case])),
        }
    }
    found
}
