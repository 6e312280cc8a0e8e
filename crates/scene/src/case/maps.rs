//! The maps of a case, as a face brings them, and their side lengths and missing points.

use asperity::Tabulated;
use asperity_maps::Topography;
use ndarray::Array2;

use crate::key::{Entries, LENGTH, Skin, Units, in_unit, worded};

/// The relative difference that given side lengths may have from the side lengths of a map: headers round.
const ROUNDING: f64 = 1e-2;

/// A map of heights, or the rows of it that this process holds.
#[derive(Clone)]
pub struct Map {
    /// The name in messages and reports; none of an array.
    pub name: Option<String>,
    /// The map.
    pub topography: Topography,
    /// The nodes of all rows.
    pub shape: (usize, usize),
}

/// The maps of a case.
pub struct Maps {
    /// The heights.
    pub heights: Map,
    /// The heights of the surface on the other side, if they are not among the heights already.
    pub against: Option<Map>,
    /// The name of the surface on the other side in reports.
    pub facing: Option<String>,
    /// The hardness at each node, where it varies.
    pub hardness: Option<Array2<f64>>,
    /// The works of adhesion at each node, where they vary.
    pub works: Option<Array2<f64>>,
    /// The law of a table.
    pub table: Option<Tabulated>,
}

impl Maps {
    /// The heights alone.
    pub fn new(heights: Map) -> Self {
        Self { heights, against: None, facing: None, hardness: None, works: None, table: None }
    }
}

impl Map {
    /// A map that this process has as a whole.
    pub fn whole(name: Option<String>, topography: Topography) -> Self {
        Self { name, shape: topography.heights.dim(), topography }
    }

    /// The name in messages.
    pub(super) fn label(&self) -> &str {
        self.name.as_deref().unwrap_or("heights")
    }

    /// The unit from which the map is converted where numbers are in SI units.
    pub(super) fn converted_from(&self, si: bool) -> Option<String> {
        self.topography.unit.clone().filter(|unit| si && unit != LENGTH.si)
    }

    /// The map in metres, if numbers are in SI units.
    ///
    /// # Errors
    /// The name and the remedy, for a unit that is none of length.
    pub(super) fn in_metres_if(self, si: bool, skin: Skin) -> Result<Self, String> {
        if !si {
            return Ok(self);
        }
        let refused = format!("{} ", self.label());
        let topography =
            in_unit(self.topography, LENGTH.si).map_err(|text| worded(&format!("{refused}{text}"), skin))?;
        Ok(Self { topography, ..self })
    }
}

/// A map in metres, if numbers are in SI units, with the side lengths that are given (one alone means square cells), or
/// its own, as far as they are known.
///
/// # Errors
/// The name and the remedy, in the words of a skin: for side lengths that contradict the map, or are unknown where
/// numbers have units, and for a unit that is none of length.
pub fn sided(map: Map, given: &Entries, si: bool, skin: Skin) -> Result<Map, String> {
    let mut map = map.in_metres_if(si, skin)?;
    let (name, known, lengths) = (map.label(), map.topography.lengths, given.lengths(map.shape));
    let near = |a: f64, b: f64| (a / b - 1.0).abs() <= ROUNDING;
    // a line has no width
    let agree =
        |given: (f64, f64), known: (f64, f64)| near(given.0, known.0) && (map.shape.1 == 1 || near(given.1, known.1));
    let text = match (lengths, known) {
        (Some(given), Some(known)) if !agree(given, known) => {
            let units = Units::of_map(map.topography.unit.as_deref());
            format!(
                "{{lengths}} gives sides of {}, but {name} has {}: leave {{lengths}} out, or change those of the map by \
                 {{prepare:lengths}}",
                units.sides(given),
                units.sides(known)
            )
        }
        (None, None) if si => {
            format!(
                "{name}: the numbers have units, but nothing says how large the map is: give {{lengths}}, such as 20um"
            )
        }
        _ => {
            map.topography.lengths = lengths.or(known);
            return Ok(map);
        }
    };
    Err(worded(&text, skin))
}

/// Refuses heights with missing points, of a map with so many nodes in all, but for those that are NaN where they stand
/// for absent nodes.
///
/// # Errors
/// The name, the first of them and the remedy, in the words of a skin.
pub fn complete(
    name: &str,
    (heights, (nx, ny)): (&Array2<f64>, (usize, usize)),
    absent_missing: bool,
    skin: Skin,
) -> Result<(), String> {
    // without counts and places the pass is many times as fast
    if heights.fold(true, |all, height| all & height.is_finite()) {
        return Ok(());
    }
    let of = |is: fn(f64) -> bool| heights.indexed_iter().filter(move |(_, height)| is(**height));
    let (infinite, missing) = (of(f64::is_infinite).count(), of(f64::is_nan).count());
    let refuse = |kind: &str, count: usize, first: Option<((usize, usize), &f64)>, remedy: &str| {
        let ((i, j), value) = first.unwrap_or(((0, 0), &f64::NAN));
        let text = format!(
            "{name}: {count} of {nx} x {ny} heights are {kind}, the first ({value}) at index [{i}, {j}]: {remedy}"
        );
        Err(worded(&text, skin))
    };
    if infinite > 0 {
        let remedy =
            "correct them where they come from; if they stand for missing points, {prepare:fill=} gives them values";
        return refuse("infinite", infinite, of(f64::is_infinite).next(), remedy);
    }
    if missing > 0 && !absent_missing {
        let remedy = "fill them by {prepare:fill=}, or treat them as absent nodes by {absent_missing=}";
        return refuse("missing", missing, of(f64::is_nan).next(), remedy);
    }
    Ok(())
}
