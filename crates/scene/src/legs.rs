//! The legs of a table, and the axes of its charts.

use serde_json::Value;

/// The most cases of a study that a chart names: it has as many colours.
const MOST_NAMED: usize = 4;

/// The value of a column, not a number where there is none.
pub fn value(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or(f64::NAN)
}

/// Whether the axes of columns `x` and `y` of rows are logarithmic: where the values along x span more than a decade, and
/// are spread more evenly so; along y if that spans a decade, too. Those of a cycle are not: the area of its loop is an
/// energy.
pub fn logarithmic(rows: &[Value], x: &str, y: &str) -> [bool; 2] {
    let [across, up] = [x, y].map(|column| Spread::of(rows.iter().map(|row| value(row, column))));
    let x_log = !is_cycle(rows) && across.is_some_and(|x| x.is_wide() && x.is_geometric());
    [x_log, x_log && up.is_some_and(|y| y.is_wide())]
}

/// Whether rows are those of a cycle.
fn is_cycle(rows: &[Value]) -> bool {
    rows.first().is_some_and(|row| row["leg"].is_u64())
}

/// The spread of the values along an axis.
struct Spread {
    low: f64,
    median: f64,
    high: f64,
}

impl Spread {
    /// The spread of those that are finite, if there are any.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<_> = values.filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let (&low, &high) = (values.first()?, values.last()?);
        Some(Self { low, median: values[(values.len() - 1) / 2], high })
    }

    /// Whether they are positive and span more than a decade, but for rounding.
    fn is_wide(&self) -> bool {
        self.low > 0.0 && self.high > 9.99 * self.low
    }

    /// Whether the one in the middle is nearer to the geometric mean of the ends than to their arithmetic mean.
    fn is_geometric(&self) -> bool {
        let (geometric, arithmetic) = ((self.low * self.high).sqrt(), 0.5 * (self.low + self.high));
        self.median * self.median < geometric * arithmetic
    }
}

/// The rows of each part of a table, with its name; a part begins with the row before it, but for the cases of a study.
/// A single one has no name, and neither have more cases than there are colours.
pub fn legs(rows: &[Value]) -> Vec<(String, &[Value])> {
    if rows.first().is_some_and(|row| row["case"].is_u64()) {
        let cases: Vec<_> = rows.chunk_by(|row, next| row["case"] == next["case"]).collect();
        let name = |rows: &[Value]| format!("case {}", rows[0]["case"]);
        let named = (2..=MOST_NAMED).contains(&cases.len());
        return cases.into_iter().map(|rows| (if named { name(rows) } else { String::new() }, rows)).collect();
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
        return legs.into_iter().map(|leg| (String::new(), leg)).collect();
    }
    let number = |k: usize| if legs.len() > 2 { format!(" {}", k / 2 + 1) } else { String::new() };
    starts.iter().enumerate().map(|(k, start)| (direction(start + 1) + &number(k), legs[k])).collect()
}
