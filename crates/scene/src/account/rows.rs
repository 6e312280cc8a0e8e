//! The summary of solves for people, row by row.

use serde_json::{Value, json};

use crate::account::{Account, SUMMARY};
use crate::key::{Measure, Skin, Units};
use crate::numbers::plain;

/// The rows of a summary: their names, and their texts for each of the solves.
pub(crate) type Rows = Vec<(String, Vec<String>)>;

/// What a row of a summary tells.
pub(crate) enum Line {
    /// A number of the account.
    Of(&'static str),
    /// A number of the account, where any of the solves adheres.
    OfAdhesion(&'static str),
    /// Words, in units and in the words of a skin.
    Words(fn(&Account, &Units, Skin) -> Option<String>),
    /// Rows with their names, of a single solve.
    Alone(fn(&Account, &Units) -> Vec<(String, String)>),
}

/// The rows of a summary of solves after a look: the name of each, and its text for each of the solves, in units as far
/// as they are known, and in the words of a skin. A row without any value is left out.
pub fn rows(solves: &[&Account], units: &Units, skin: Skin) -> Rows {
    let adheres = solves.iter().any(|solve| solve.inputs.adhesion.adheres());
    let told: Vec<_> = solves.iter().map(|solve| json!(solve)).collect();
    let number = |name: &str| {
        let measure = Measure::find(name, "", false);
        let text = |value: &Value| match (measure, value.as_f64()) {
            // as many digits as there is room for
            (Measure::Plain, Some(number)) if value.is_f64() => Some(plain(number)),
            _ => measure.describe(value, units),
        };
        told.iter().map(|report| text(&report[name])).collect()
    };
    let mut rows = Rows::new();
    for (name, line) in SUMMARY {
        let texts: Vec<Option<String>> = match (line, solves) {
            (Line::Of(name), _) => number(name),
            (Line::OfAdhesion(name), _) if adheres => number(name),
            (Line::Words(say), _) => solves.iter().map(|solve| say(solve, units, skin)).collect(),
            (Line::Alone(say), [solve]) => {
                rows.extend(say(solve, units).into_iter().map(|(name, text)| (name, vec![text])));
                continue;
            }
            _ => continue,
        };
        if texts.iter().any(Option::is_some) {
            rows.push(((*name).to_owned(), texts.into_iter().map(Option::unwrap_or_default).collect()));
        }
    }
    rows
}
