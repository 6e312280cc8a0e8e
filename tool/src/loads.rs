//! Lists of loads: numbers and ranges on the command line.

use crate::quantity::Quantity;

/// Loads in the order of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads {
    pub values: Vec<f64>,
    /// The numbers that stand in the list
    pub given: Vec<Quantity>,
}

/// The largest number of loads; more are taken for a slip of the pen.
const MOST_LOADS: usize = 100_000;

/// The parser of numbers and ranges with commas between, from that of a number.
pub fn list<P>(number: P) -> impl Fn(&str) -> Result<Loads, String> + Clone + Send + Sync + 'static
where
    P: Fn(&str) -> Result<Quantity, String> + Clone + Send + Sync + 'static,
{
    move |text| parsed(text, &number)
}

/// Reads numbers and ranges with commas between.
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
                        "'{text}' is two numbers: a range is FROM:TO:COUNT, as {from}:{to}:10 or {from}:{to}:10:log"
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
        let between = |share: f64| if log { from * ratio.powf(share) } else { from + (to - from) * share };
        let last = count - 1;
        loads.extend((0..last).map(|k| between(k as f64 / last as f64)));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::LENGTH;

    fn gaps(text: &str) -> Result<Loads, String> {
        list(LENGTH.non_negative())(text)
    }

    fn signed(text: &str) -> Result<Loads, String> {
        list(LENGTH.finite())(text)
    }

    #[test]
    fn lists_are_numbers_and_ranges() {
        let check = |text, expected: &[f64]| assert_eq!(signed(text).unwrap().values, expected, "{text}");
        check("1", &[1.0]);
        check("1e-3, -2,3", &[1e-3, -2.0, 3.0]);
        check("0:1:5", &[0.0, 0.25, 0.5, 0.75, 1.0]);
        check("1:0:3,-1", &[1.0, 0.5, 0.0, -1.0]);
        check("1:16:5:log", &[1.0, 2.0, 4.0, 8.0, 16.0]);
        check("-4:-1:2:log", &[-4.0, -1.0]);
        check("-6nm,0,1nm", &[-6e-9, 0.0, 1e-9]);
        check("1um:4um:3:log", &[1e-6, 2e-6, 4e-6]);
    }

    #[test]
    fn lists_that_are_none_are_refused() {
        for (text, part) in [
            ("", "''"),
            ("1,,2", "''"),
            ("1,", "''"),
            ("one", "'one'"),
            ("nan", "'nan'"),
            ("1,inf", "'inf'"),
            ("-1", "'-1'"),
            ("0.1,-1e-3", "'-1e-3'"),
            ("1:2", "FROM:TO:COUNT"),
            ("1:2:3:4", "FROM:TO:COUNT"),
            ("1:2:3:log:1", "FROM:TO:COUNT"),
            ("1:2:1", "from 2"),
            ("1:2:0", "from 2"),
            ("1:2:-3", "from 2"),
            ("1:2:2.5", "from 2"),
            ("1:2:99999999999999999999", "from 2"),
            ("1:2:100001", "from 2"),
            ("0:1:5:log", ":log"),
            ("1:0:5:log", ":log"),
            ("0:-1:5", "'-1'"),
            ("1nm-2nm", "as 1nm:2nm:10 or"),
            ("1e-3-1e-1", "as 1e-3:1e-1:10 or"),
            ("1..2", "as 1:2:10 or"),
            ("1nm-2N", "nm-2N is no unit"),
            ("1nm,2", "2 has no unit"),
            ("1:2nm:5", "1 has no unit"),
            ("1nm:2nN:5", "'2nN'"),
        ] {
            let error = gaps(text).unwrap_err();
            assert!(error.contains(part) && error.lines().count() == 1, "{text}: {error}");
        }
        let refused = signed("-1:1:5:log").unwrap_err();
        assert!(refused.contains(":log"), "{refused}");
        let many = ["0:1:100000"; 2].join(",");
        assert!(gaps(&many).unwrap_err().contains("more loads than the 100000"));
        assert!(signed("-1e308:1e308:3").unwrap_err().contains("finite"));
    }
}
