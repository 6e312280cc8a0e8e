//! The statistics of a surface, by the names of reports and for people.

use std::path::Path;

use asperity::surface::SurfaceStatistics;
use asperity_maps::Topography;
use serde_json::{Value, json};

use crate::key::{Dimension, LENGTH, PER_LENGTH, Skin, Units, worded};
use crate::numbers::plain;

/// The statistics of the map in a file, and the wavelength of the knee of its spectrum, by name.
pub fn figures(map: &Topography, (found, knee): &(SurfaceStatistics, Option<f64>), heights: &Path) -> Value {
    let of_map = json!({
        "heights": heights.to_string_lossy(),
        "shape": map.heights.dim(),
        "lengths": map.lengths,
        "length_unit": map.unit,
        "original": map.original,
    });
    let parts = [of_map, json!(found), json!({ "knee_wavelength": knee })];
    parts.iter().filter_map(Value::as_object).flatten().map(|(key, value)| (key.clone(), value.clone())).collect()
}

/// The statistics of a map for people: their names and texts, in the words of a skin, with the unit of length if it is
/// known. A mirrored map has statistics of all nodes.
pub fn rows(
    map: &Topography,
    (found, knee): &(SurfaceStatistics, Option<f64>),
    skin: Skin,
) -> Vec<(&'static str, String)> {
    let ((nx, ny), unit) = (map.heights.dim(), map.unit.as_deref());
    // Shape and Nayak's parameter have no meaning on a flat surface.
    let units = Units::of_map(unit);
    let number = |value: f64, dimension: Option<Dimension>| match dimension {
        _ if value.is_nan() => "-".to_owned(),
        Some(dimension) => units.number(value, dimension),
        None => plain(value),
    };
    let sides = match map.lengths {
        Some((lx, _)) if ny == 1 => units.number(lx, LENGTH),
        Some(lengths) => units.sides(lengths),
        None => worded("unknown: give {lengths} for slopes, curvatures and Nayak's parameter", skin),
    };
    let mut rows = vec![("nodes", format!("{nx} x {ny}")), ("side lengths", sides)];
    if let Some((x, y)) = map.original {
        rows.push(("original", format!("{x} x {y} nodes, all others are its mirror images")));
    }
    let mut before = f64::NAN;
    for (name, value, dimension) in [
        ("mean height", found.mean, Some(LENGTH)),
        ("lowest", found.lowest, Some(LENGTH)),
        ("highest", found.highest, Some(LENGTH)),
        ("rms height", found.rms_height, Some(LENGTH)),
        ("skewness", found.skewness, None),
        ("kurtosis", found.kurtosis, None),
        ("rms slope, spectral", found.rms_slope, None),
        ("  by differences", found.rms_slope_differences, None),
        ("rms curvature, spectral", found.rms_curvature, Some(PER_LENGTH)),
        ("  by differences", found.rms_curvature_differences, Some(PER_LENGTH)),
        ("Nayak's parameter", found.nayak, None),
    ] {
        // in the unit of the one before, if it is the same figure
        let like = if name.starts_with(' ') { before } else { value };
        let text = dimension.filter(|_| !value.is_nan()).map(|dimension| units.number_like(value, like, dimension));
        rows.push((name, text.unwrap_or_else(|| number(value, dimension))));
        before = value;
    }
    if let Some(knee) = knee {
        let remedy = worded(
            "shorter waves are noise, spikes or offsets of lines; {prepare:cut_off_wavelength} removes noise",
            skin,
        );
        rows.push(("knee of the spectrum", format!("{}: {remedy}", units.number(*knee, LENGTH))));
    }
    rows
}
