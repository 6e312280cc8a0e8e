//! Units of length: heights and sides brought to one unit.

use ndarray::Array2;

use super::{Parsed, is_side, quoted, refuse};
use crate::Topography;

/// The number of units of length in a metre, a whole one: division by it rounds only once.
pub(super) fn per_metre(unit: &str) -> Option<f64> {
    Some(match unit {
        "pm" => 1e12,
        "Å" | "\u{212b}" | "Angstrom" | "angstrom" => 1e10,
        "nm" | "нм" | "nanometers" | "nanometres" => 1e9,
        // the micro sign, in Latin-1 and in code page 437, the Greek letter, and what stands for them
        "µm" | "\u{3bc}m" | "um" | "æm" | "micron" | "microns" | "мкм" | "micrometers" | "micrometres" => 1e6,
        "mm" | "мм" | "millimeters" | "millimetres" => 1e3,
        "cm" => 1e2,
        "m" | "meters" | "metres" => 1.0,
        _ => return None,
    })
}

/// The symbol of a unit of length.
pub(super) fn symbol(unit: &str) -> Option<&'static str> {
    let size = per_metre(unit)?;
    ["pm", "Å", "nm", "µm", "mm", "cm", "m"].into_iter().find(|symbol| per_metre(symbol) == Some(size))
}

/// Whether a unit is one of length.
pub(super) fn is_length(unit: &str) -> bool {
    per_metre(unit).is_some()
}

/// A map from a file that gives side lengths and heights each in a unit, empty for unknown: in metres, or in the unit
/// that they share.
pub(super) fn in_one_unit(
    mut heights: Array2<f64>,
    lengths: Option<(f64, f64)>,
    lateral: &str,
    vertical: &str,
) -> Parsed<Topography> {
    if lengths.is_some_and(|(lx, ly)| !(is_side(lx) && is_side(ly))) {
        let (lx, ly) = lengths.unwrap_or_default();
        return refuse(format!("has side lengths of {lx} and {ly}, expected positive numbers: export it again"));
    }
    let lateral = if lengths.is_some() { lateral } else { vertical };
    let (scale, unit) = match (per_metre(lateral), per_metre(vertical)) {
        (Some(along), Some(up)) => {
            if up != 1.0 {
                heights.mapv_inplace(|h| h / up);
            }
            (along, Some("m"))
        }
        _ if lateral == vertical => (1.0, Some(vertical).filter(|unit| !unit.is_empty())),
        _ => {
            let name = |unit: &str| if unit.is_empty() { "no unit".to_owned() } else { quoted(unit) };
            return refuse(format!(
                "has side lengths in {} and values in {}, expected lengths (pm, Å, nm, µm, mm, cm, m) for both: \
                 export the channel of heights, with both units",
                name(lateral),
                name(vertical)
            ));
        }
    };
    let mut map = Topography::new(heights);
    map.lengths = lengths.map(|(lx, ly)| (lx / scale, ly / scale));
    map.unit = unit.map(str::to_owned);
    Ok(map)
}

/// A unit without brackets around it.
pub(super) fn bare(unit: &str) -> &str {
    unit.trim_matches(|c: char| "[]()".contains(c) || c.is_whitespace())
}
