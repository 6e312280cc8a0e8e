//! The maps of contact and pressure that commands draw.

use std::path::Path;

use asperity::picture::{Colouring, Map};
use asperity::{Grid, Result, Solution};
use ndarray::Array2;

use crate::numbers::percent;
use crate::options::Scalar;

/// The units that pictures have on their axes.
#[derive(Clone, Copy)]
pub struct Units<'a> {
    pub length: Option<&'a str>,
    pub pressure: Option<&'a str>,
}

/// Draws the nodes in contact, black on white.
pub fn draw_contact<T: Scalar>(
    path: &Path,
    grid: Grid,
    title: &str,
    units: Units<'_>,
    solution: &Solution<T>,
) -> Result<()> {
    let contact = solution.contact_map().mapv(f64::from);
    let caption = format!("{} % contact", percent(solution.report.contact_fraction));
    let map = Map {
        title,
        caption: &caption,
        length_unit: units.length,
        label: "contact",
        ..Map::new(contact.view(), grid, Colouring::Binary)
    };
    map.write_png(path)
}

/// The pressure that a map should show. Without adhesion this is the contact pressure: the pressure outside of the
/// contact is a remainder of the error, and would look like attraction on a scale of its own.
pub fn pressure_to_draw<T>(solution: &Solution<T>, adhesive: bool) -> &Array2<T> {
    if adhesive { &solution.pressure } else { &solution.contact_pressure }
}

/// Draws a pressure, compression red and attraction blue.
pub fn draw_pressure<T: Scalar>(
    path: &Path,
    grid: Grid,
    title: &str,
    caption: &str,
    units: Units<'_>,
    pressure: &Array2<T>,
) -> Result<()> {
    let pressure = pressure.mapv(T::widen);
    let map = Map {
        title,
        caption,
        length_unit: units.length,
        label: "pressure",
        unit: units.pressure,
        ..Map::new(pressure.view(), grid, Colouring::Diverging)
    };
    map.write_png(path)
}
