//! Lists of loads: numbers and ranges on the command line.

use asperity::Control;

/// Loads in the order of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads(pub Vec<f64>);

/// The largest number of loads; more are taken for a slip of the pen.
const MOST_LOADS: usize = 100_000;

/// The name of the kind of a load, and its value.
pub fn name_and_value(control: Control) -> (&'static str, f64) {
    (control.name(), control.value())
}

/// Reads a list of mean gaps.
pub fn gaps(text: &str) -> Result<Loads, String> {
    list(text, |gap| gap >= 0.0 && gap.is_finite(), "zero or positive and finite")
}

/// Reads a list of loads that may have either sign.
pub fn signed(text: &str) -> Result<Loads, String> {
    list(text, f64::is_finite, "finite")
}

/// Reads numbers and ranges with commas between.
fn list(text: &str, allowed: fn(f64) -> bool, requirement: &str) -> Result<Loads, String> {
    let mut loads = Vec::new();
    for item in text.split(',').map(str::trim) {
        if loads.len() > MOST_LOADS {
            break;
        }
        let number = |text: &str| match text.trim().parse() {
            Ok(value) if allowed(value) => Ok(value),
            _ => Err(format!("'{text}' must be a number, {requirement}")),
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
        if let Some(load) = loads.iter().find(|load| !allowed(**load)) {
            return Err(format!("'{item}' contains {load}: it must be {requirement}"));
        }
    }
    if loads.len() > MOST_LOADS {
        return Err(format!("it has more loads than the {MOST_LOADS} that are allowed"));
    }
    Ok(Loads(loads))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_numbers_and_ranges() {
        let check = |text, expected: &[f64]| assert_eq!(signed(text).unwrap(), Loads(expected.to_vec()), "{text}");
        check("1", &[1.0]);
        check("1e-3, -2,3", &[1e-3, -2.0, 3.0]);
        check("0:1:5", &[0.0, 0.25, 0.5, 0.75, 1.0]);
        check("1:0:3,-1", &[1.0, 0.5, 0.0, -1.0]);
        check("1:16:5:log", &[1.0, 2.0, 4.0, 8.0, 16.0]);
        check("-4:-1:2:log", &[-4.0, -1.0]);
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
