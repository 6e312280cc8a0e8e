//! The error of the grid with a law that has the range of the grid: by the process zone at the edge of the contact.

use super::{GridError, Quantity, is_coarser, observed_order};
use crate::nested::Level;

/// The factors of the process zone and of the difference to the grid of half as many nodes, in the error of a quantity.
const AREA: [f64; 2] = [0.5, 2.0];
const LENGTHS: [f64; 2] = [1.5, 1.5];

impl Quantity {
    /// The value on a level, and the part of it that the process zone makes.
    fn with_zone(self, level: &Level) -> Option<(f64, f64)> {
        let (by_energy, area) = (level.adhesive_contact_fraction?, level.area.jkr_contact_fraction?);
        let zone = by_energy - area;
        // the energy of the zone over the contact pressure, which moves its edge
        let length = 0.0 - level.adhesive_energy / by_energy * zone / level.mean_contact_pressure;
        match self {
            Self::Area => Some((area, zone)),
            Self::Gap => Some((level.mean_gap, length)),
            Self::Approach => Some((level.approach?, length)),
            Self::Pressure | Self::Stiffness => None,
        }
    }
}

/// The estimated error of a quantity on the finest of some levels, the coarsest first.
pub(super) fn error(levels: &[Level], quantity: Quantity, resolves: impl Fn(f64) -> bool) -> Option<GridError> {
    let (finest, coarser) = levels.split_last()?;
    let (value, zone) = quantity.with_zone(finest).filter(|_| resolves(1.0))?;
    let mut values = vec![value];
    for (i, level) in coarser.iter().rev().enumerate() {
        let factor = f64::from(1 << (i + 1));
        let usable = is_coarser(level, finest, factor) && resolves(factor);
        let Some((value, _)) = quantity.with_zone(level).filter(|_| usable) else { break };
        values.push(value);
    }
    let [of_zone, of_difference] = if quantity == Quantity::Area { AREA } else { LENGTHS };
    let relative = match values[..] {
        [value, coarse, ..] => (of_zone * zone).hypot(of_difference * (value - coarse)) / value,
        _ if quantity == Quantity::Area => zone / value,
        _ => return None,
    };
    let order = observed_order(&values);
    let rough = values.len() < 2;
    Some(GridError { relative: relative.abs(), order, rough }).filter(|error| error.relative.is_finite())
}
