//! Lists of numbers and ranges, as options take them.

use crate::key::Quantity;

/// Loads in the order of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads {
    /// The values.
    pub values: Vec<f64>,
    /// The numbers that stand in the list
    pub given: Vec<Quantity>,
}

/// The largest number of loads; more are taken for a slip of the pen.
const MOST_LOADS: usize = 100_000;

/// Reads numbers and ranges with commas between, FROM:TO:COUNT or FROM:TO:COUNT:log, by the parser of a number.
///
/// # Errors
/// The part that is no number and no range, with the reason.
pub fn parsed(text: &str, number: &dyn Fn(&str) -> Result<Quantity, String>) -> Result<Loads, String> {
    let (mut loads, mut given) = (Vec::new(), Vec::new());
    for item in text.split(',').map(str::trim) {
        if loads.len() > MOST_LOADS {
            break;
        }
        let mut number = |text: &str| {
            let quantity = number(text).map_err(|error| match ends_of(text, number) {
                Some((from, to)) => {
                    format!(
                        "'{text}' is two numbers: a range is FROM:TO:COUNT, such as {from}:{to}:10 or {from}:{to}:10:log"
                    )
                }
                None => format!("'{text}': {error}"),
            })?;
            given.push(quantity);
            Ok::<_, String>(quantity.value)
        };
        let parts: Vec<_> = item.split(':').collect();
        let (from, to, count, log) = match parts[..] {
            [one] => {
                loads.push(number(one)?);
                continue;
            }
            [from, to, count] => (number(from)?, number(to)?, count, false),
            [from, to, count, "log"] => (number(from)?, number(to)?, count, true),
            _ => return Err(format!("'{item}' must be a number, FROM:TO:COUNT or FROM:TO:COUNT:log")),
        };
        let count = match count.trim().parse() {
            Ok(count @ 2..=MOST_LOADS) => count,
            _ => return Err(format!("the count in '{item}' must be from 2 to {MOST_LOADS}")),
        };
        let ratio: f64 = to / from;
        if log && !(ratio > 0.0 && ratio.is_finite()) {
            return Err(format!("'{item}' must go from one positive number to another, or leave out :log"));
        }
        let last = count - 1;
        // whole numbers stay whole
        let between = |k: f64, of: f64| if log { from * ratio.powf(k / of) } else { from + (to - from) * k / of };
        loads.extend((0..last).map(|k| between(k as f64, last as f64)));
        loads.push(to);
        if let Some(load) = loads.iter().find(|load| !load.is_finite()) {
            return Err(format!("'{item}' contains {load}: it must be finite"));
        }
    }
    if loads.len() > MOST_LOADS {
        return Err(format!("it has more loads than the {MOST_LOADS} that are allowed"));
    }
    let bare = given.iter().find(|given| given.is_bare());
    if let Some(bare) = bare.filter(|_| given.iter().any(|given| given.has_unit)) {
        return Err(format!("{bare} has no unit, but others in the list have one: give all of them units, or none"));
    }
    Ok(Loads { values: loads, given })
}

/// The two numbers of a range as people write it, 1MPa-2MPa, if it is one.
fn ends_of<'a>(text: &'a str, number: &dyn Fn(&str) -> Result<Quantity, String>) -> Option<(&'a str, &'a str)> {
    let splits = ["...", "..", "–", "-", " to "].into_iter().flat_map(|dash| {
        let end = move |(at, _)| (text[..at].trim(), text[at + dash.len()..].trim());
        text.match_indices(dash).map(end)
    });
    splits.into_iter().find(|(from, to)| number(from).is_ok() && number(to).is_ok())
}
