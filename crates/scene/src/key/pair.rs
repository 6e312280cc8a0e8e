//! Two surfaces that face each other, as files and arrays bring them.

use asperity::Surface;
use asperity_maps::Topography;

use crate::key::{Boundary, Units, in_unit};

/// The surface between a first one, with the unit and the original that its map names, and the map of a second one that
/// faces it ([`Surface::against`]), moved by a shift. Missing points of the second become absent nodes, or are refused.
///
/// A mirrored map has the image of its original as its other half, which as it is turned over comes to lie in the place of
/// the original: originals that are to face each other lie half a side apart.
///
/// # Errors
/// The reason with a remedy, with keys in braces, for [`worded`](crate::worded).
pub fn between(
    (first, unit, original): (&Surface, Option<&str>, Option<(usize, usize)>),
    mut second: Topography,
    shift: (f64, f64),
    (boundary, absent_missing): (Boundary, bool),
) -> Result<Surface, String> {
    match (unit, second.unit.as_deref()) {
        (Some(first), Some(_)) => second = in_unit(second, first).map_err(|text| format!("{{against}} {text}"))?,
        (None, None) => {}
        (one, other) => {
            let (named, unnamed) = if one.is_some() { ("heights", "against") } else { ("against", "heights") };
            let unit = one.or(other).unwrap_or_default();
            return Err(format!(
                "{{{named}}} is in {unit}, but {{{unnamed}}} names no unit: give it one by {{prepare:unit}}"
            ));
        }
    }
    let (grid, shape) = (first.grid(), second.heights.dim());
    let sides = *second.lengths.get_or_insert(grid.lengths());
    let near = |a: f64, b: f64| (a / b - 1.0).abs() <= 1e-6;
    let is_same = near(sides.0, grid.lengths().0) && (near(sides.1, grid.lengths().1) || grid.is_line());
    if shape != grid.shape() || !is_same {
        let told = |(nx, ny), sides| format!("{nx} x {ny} nodes on {}", Units::of_map(unit).sides(sides));
        return Err(format!(
            "{{against}} has {}, but {{heights}} has {}: both need the same, cut or interpolate one by {{prepare:crop}} or \
             {{prepare:resample}}",
            told(shape, sides),
            told(grid.shape(), grid.lengths())
        ));
    }
    second.lengths = Some(grid.lengths());
    let (missing, has_infinite) = (second.missing(), second.heights.iter().any(|h| h.is_infinite()));
    if missing > 0 && (has_infinite || !absent_missing) {
        return Err(format!(
            "{{against}}: {missing} of {} points are missing: fill them by {{prepare:fill=}}, or treat those that are NaN as \
             absent nodes by {{absent_missing=}}",
            second.heights.len()
        ));
    }
    let shift = shift_of((first, original), second.original, shift, boundary)?;
    let second = if missing > 0 { second.surface_with_absent() } else { second.surface() };
    second.and_then(|second| first.against(&second, shift)).map_err(|error| error.to_string())
}

/// The shift of a second surface against a first one, each with the nodes of its original if it is mirrored.
fn shift_of(
    (first, original): (&Surface, Option<(usize, usize)>),
    other: Option<(usize, usize)>,
    shift: (f64, f64),
    boundary: Boundary,
) -> Result<(f64, f64), String> {
    let shifted = shift != (0.0, 0.0);
    let told = format!("{{shift}} is {} {}", shift.0, shift.1);
    match (boundary, original, other) {
        (Boundary::Free, ..) if shifted => Err(format!(
            "{told}, but with a free boundary the surface ends, and nothing follows it as it moves: move the heights \
                 within larger maps, or leave out {{boundary}}"
        )),
        (Boundary::Free, ..) | (_, None, None) => Ok(shift),
        (_, Some(_), Some(_)) if shifted => Err(format!(
            "{told}, but when a mirrored map moves, its original leaves its place: make both maps periodic by \
                 {{prepare:window}}, without mirror images"
        )),
        (_, Some((nx, _)), Some(_)) if other == original => Ok((nx as f64 * first.grid().spacing().0, 0.0)),
        _ => Err("{heights} and {against} are not mirrored alike: mirror both by {prepare:mirror}, or none".to_owned()),
    }
}
