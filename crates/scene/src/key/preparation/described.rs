//! The map and the effects of steps in words, with the units that are known.

use asperity::Result;
use asperity_maps::{FormFit, Topography, Trend};
use ndarray::Array2;

use crate::key::{LENGTH, PER_LENGTH, Units};
use crate::numbers::plain;

/// The most names in a line.
const MOST_NAMES: usize = 4;

/// A sphere, or a cylinder and its direction.
pub fn described_form(fit: &FormFit, map: &Topography) -> String {
    let (radius, side) = (quantity(fit.radius.abs(), map), if fit.radius > 0.0 { "upwards" } else { "downwards" });
    match fit.axis {
        None => format!("sphere of radius {radius}, bulging {side},"),
        Some(axis) => {
            let degrees = plain(axis.to_degrees());
            format!("cylinder of radius {radius}, bulging {side}, its axis at {degrees} degrees from x,")
        }
    }
}

/// What its file has besides a map.
pub fn list_others(map: &Topography) -> String {
    let names = &map.unread[..map.unread.len().min(MOST_NAMES)];
    match map.unread.len() {
        0 => String::new(),
        all => format!("; also in the file {}{}", names.join(", "), if all > MOST_NAMES { ", ..." } else { "" }),
    }
}

/// The heights that a trend takes away.
pub fn removed(trend: Trend, before: &Topography, after: &Topography) -> Result<String> {
    if let Trend::Polynomial(order @ 3..) = trend {
        return Ok(format!("polynomial of order {order} removed, heights {}", changed(&before.heights, after)));
    }
    let fit = before.fit(trend)?;
    let per = if before.lengths.is_some() { "" } else { " per spacing" };
    let (x, y) = fit.slopes;
    let tilt = format!("tilt {}{per} along x, {}{per} along y", plain(x), plain(y));
    Ok(match trend {
        Trend::Mean | Trend::Polynomial(0) => format!("mean {} removed", quantity(fit.height, before)),
        Trend::Plane | Trend::Polynomial(1) => format!("{tilt} removed"),
        _ => {
            let (xx, xy, yy) = fit.curvatures;
            let units = Units::of_map(before.unit.as_deref().filter(|_| before.lengths.is_some()));
            let [xx, xy, yy] = [xx, xy, yy].map(|curvature| units.number(curvature, PER_LENGTH));
            format!("{tilt} removed, curvatures xx {xx}, xy {xy}, yy {yy}")
        }
    })
}

/// By how much measured heights have changed.
pub fn changed(before: &Array2<f64>, after: &Topography) -> String {
    let changes = before.iter().zip(&after.heights).map(|(before, after)| after - before);
    let (mut squares, mut most, mut count) = (0.0, 0.0, 0.0);
    for change in changes.filter(|change| change.is_finite()) {
        (squares, most, count) = (squares + change * change, f64::max(most, change.abs()), count + 1.0);
    }
    let rms = f64::sqrt(squares / f64::max(count, 1.0));
    format!("changed by {} rms, by {} at most", quantity(rms, after), quantity(most, after))
}

/// Nodes, missing points, side lengths and rms height of a map.
pub fn described(map: &Topography) -> String {
    let (nx, ny) = map.heights.dim();
    let lengths = map.lengths.map_or("unknown side lengths".to_owned(), |l| sides(l, map.unit.as_deref()));
    let missing = holes(map).unwrap_or("none missing".to_owned());
    format!("{nx} x {ny} heights, {missing}, {lengths}, rms height {}", rms(map))
}

/// The numbers of missing and of infinite heights, if there are any.
pub fn holes(map: &Topography) -> Option<String> {
    let infinite = map.heights.iter().filter(|h| h.is_infinite()).count();
    match (map.missing() - infinite, infinite) {
        (0, 0) => None,
        (missing, 0) => Some(format!("{missing} missing")),
        (0, infinite) => Some(format!("{infinite} infinite")),
        (missing, infinite) => Some(format!("{missing} missing, {infinite} infinite")),
    }
}

pub fn sides(lengths: (f64, f64), unit: Option<&str>) -> String {
    Units::of_map(unit).sides(lengths)
}

pub fn rms(map: &Topography) -> String {
    quantity(map.rms_height(), map)
}

pub fn quantity(value: f64, map: &Topography) -> String {
    Units::of_map(map.unit.as_deref()).number(value, LENGTH)
}
