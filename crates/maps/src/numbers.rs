//! Numbers as text for people: digits, prefixes, shares.

/// A share in percent, with enough digits that a little contact is not none.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent == 0.0 || percent >= 1.0 {
        format!("{percent:.1}")
    } else if percent >= 0.01 {
        format!("{percent:.2}")
    } else if percent >= 1e-6 {
        format!("{percent:.*}", (-percent.log10().floor()) as usize)
    } else {
        format!("{percent:.0e}")
    }
}

/// A number to seven digits.
pub fn plain(value: f64) -> String {
    rounded(value, 7, 1e6)
}

/// A number to so many digits, with an exponent below 1e-3 and from `most` on.
pub fn rounded(value: f64, digits: usize, most: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..most).contains(&magnitude) {
        return scientific(format!("{value:.*e}", digits - 1));
    }
    let decimals = (digits as f64 - 1.0 - magnitude.log10().floor()).max(0.0);
    trimmed(format!("{value:.*}", decimals as usize))
}

/// A number to four digits with its SI unit, and the prefix that makes it readable. A number too large for any prefix
/// has a power of ten, and a number too small is zero, but for energies, which are so small on nanometres.
pub fn si(value: f64, unit: &str) -> String {
    // Rounded first, so that 999.96 n is 1 µ.
    let text = format!("{value:.3e}");
    let rounded: f64 = text.parse().unwrap_or(value);
    let Some((power, unit)) = scale(rounded, unit) else {
        let is_zero = rounded.abs() < 1.0 && unit != "J";
        let number = if is_zero { "0".to_owned() } else { scientific(text) };
        return format!("{number} {unit}");
    };
    let value = rounded / 10f64.powi(power);
    let decimals = if value == 0.0 { 0.0 } else { (3.0 - (value.abs().log10() + 1e-9).floor()).max(0.0) };
    format!("{} {unit}", trimmed(format!("{value:.*}", decimals as usize)))
}

/// The power of ten by which a number with a SI unit is readable, and the unit with the prefix for it, which m³ and 1/m
/// have in their powers; none without such a prefix.
pub fn scale(value: f64, unit: &str) -> Option<(i32, String)> {
    const PREFIXES: [&str; 12] = ["z", "a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];
    let decade = if value == 0.0 { 0 } else { (value.abs().log10() + 1e-9).floor() as i32 };
    // a stiffness is said over micrometres
    if decade >= 12 && unit == "Pa/m" {
        return scale(1e-6 * value, "Pa/µm").map(|(power, unit)| (power + 6, unit));
    }
    let above = unit.split('/').next().unwrap_or(unit);
    let power: i32 = match above {
        "1" => -1,
        above if above.ends_with('²') => 2,
        above if above.ends_with('³') => 3,
        _ => 1,
    };
    // of squares two decades lie below one, and of cubes three
    let least = if power > 1 { -power } else { 0 };
    let thousands = if value == 0.0 { 0 } else { power.signum() * (decade - least).div_euclid(3 * power.abs()) };
    let prefix = PREFIXES.get(usize::try_from(thousands + 7).ok()?)?;
    let unit = unit.strip_prefix("1/").map_or(format!("{prefix}{unit}"), |below| format!("1/{prefix}{below}"));
    Some((3 * power * thousands, unit))
}

/// A number in scientific notation, without zeros at the end of its decimals.
fn scientific(text: String) -> String {
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{}e{exponent}", trimmed(digits.to_owned())),
        None => text,
    }
}

/// A number without zeros at the end of its decimals.
fn trimmed(digits: String) -> String {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.').to_owned() } else { digits }
}
