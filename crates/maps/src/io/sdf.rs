//! Height maps in texts of ISO 25178-71 (`.sdf`).

use std::io::BufRead;

use ndarray::Array2;

use super::units::in_one_unit;
use super::{Parsed, quoted, refuse, reserve, unreadable};
use crate::Topography;

/// The starts of such texts, and of those before the standard.
pub(super) const SDF: [&[u8]; 2] = [b"aISO-", b"aBCR-"];

/// Reads a header of lines `name = value` up to a star, and the heights of profiles along x, from the least y on.
pub(super) fn read_sdf(reader: &mut impl BufRead, size: u64) -> Parsed<Topography> {
    let mut bytes = Vec::new();
    reserve(&mut bytes, size as usize)?;
    reader.read_to_end(&mut bytes).map_err(unreadable)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.lines().map(str::trim);
    let header: Vec<_> =
        lines.by_ref().take_while(|line| *line != "*").filter_map(|line| line.split_once('=')).collect();
    let number = |name: &str| {
        let found = header
            .iter()
            .find(|(found, _)| found.trim().eq_ignore_ascii_case(name))
            .map_or("", |(_, value)| value.trim());
        match found.parse::<f64>() {
            Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
            _ => refuse(format!("gives {} for {name}, expected a positive number", quoted(found))),
        }
    };
    let (nx, ny) = (number("NumPoints")?, number("NumProfiles")?);
    let (dx, dy, scale) = (number("Xscale")?, number("Yscale")?, number("Zscale")?);
    let mut heights = Vec::new();
    for word in lines.take_while(|line| *line != "*").flat_map(str::split_whitespace) {
        reserve(&mut heights, 1)?;
        heights.push(match word.parse::<f64>() {
            Ok(height) => scale * height,
            Err(_) if word.eq_ignore_ascii_case("bad") => f64::NAN,
            Err(_) => return refuse(format!("has {} among its heights, expected numbers or BAD", quoted(word))),
        });
    }
    if heights.len() as f64 != nx * ny || nx.fract() + ny.fract() > 0.0 {
        let found = heights.len();
        return refuse(format!("promises {nx} x {ny} heights but has {found}: save it again"));
    }
    let profiles = Array2::from_shape_vec((ny as usize, nx as usize), heights).map_err(|e| e.to_string())?;
    let heights = profiles.reversed_axes().as_standard_layout().into_owned();
    in_one_unit(heights, Some((nx * dx, ny * dy)), "m", "m")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_refused, read_map};

    const TEXT: &str = "aISO-1.0\nManufacID = OWN\nNumPoints = 3\nNumProfiles = 2\nXscale = 5.0E-7\nYscale = 2.5E-7\n\
                        Zscale = 1.0E-9\nDataType = 7\n*\n0 8.5 9\n3 BAD 12\n*\nnotes\n";

    #[test]
    fn profiles_are_along_x_from_the_least_y_on() {
        let map = read_map(TEXT, "a.sdf").unwrap();
        assert_eq!((map.lengths, map.unit.as_deref(), map.missing()), (Some((1.5e-6, 5e-7)), Some("m"), 1));
        // 12 nm, but for the rounding of the scale
        assert!(map.heights[[1, 0]] == 8.5e-9 && (map.heights[[2, 1]] - 12e-9).abs() < 1e-23);
        assert!(map.heights[[1, 1]].is_nan());
        assert_eq!(read_map(TEXT.replace("aISO", "aBCR").replace('\n', "\r\n"), "a").unwrap().heights.dim(), (3, 2));
    }

    #[test]
    fn what_is_damaged_is_refused() {
        assert_refused(read_map(TEXT.replace(" 12", ""), "a"), &["promises 3 x 2 heights but has 5"]);
        assert_refused(read_map(TEXT.replace("Yscale = 2.5E-7", ""), "a"), &["gives \"\" for Yscale", "positive"]);
        assert_refused(read_map(TEXT.replace("= 3", "= 1e300"), "a"), &["but has 6"]);
        assert_refused(read_map(TEXT.replace("8.5", "8,5"), "a"), &["\"8,5\" among its heights"]);
    }
}
