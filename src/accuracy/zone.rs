//! The error of the grid with a law that has the range of the grid: by the process zone at the edge of the contact.

use super::{GridError, Quantity, is_coarser, observed_order};
use crate::nested::Level;

/// The factor by which an estimate is larger where the area changes from grid to grid by more than half the zone.
const APART: f64 = 4.5;

/// A quantity on a grid: as it is reported, less the process zone, and the zone.
struct Told {
    value: f64,
    limit: f64,
    zone: f64,
}

impl Quantity {
    /// The quantity on a level of a law that has the range of the grid.
    fn told(self, level: &Level) -> Option<Told> {
        let (by_energy, area) = (level.adhesive_contact_fraction?, level.area.jkr_contact_fraction?);
        let (zone, work) = (by_energy - area, 0.0 - level.adhesive_energy / by_energy);
        let of = |value: f64, sign: f64, zone: f64| Told { value, limit: value + sign * zone, zone };
        // the energy of the zone over what moves its edge
        let length = work * zone / level.mean_contact_pressure;
        let told = match self {
            Self::Area => Told { value: area, limit: area, zone },
            Self::Gap => of(level.mean_gap, 1.0, length),
            Self::Approach => of(level.approach?, -1.0, length),
            Self::Pressure => of(level.mean_pressure, 1.0, work * zone / level.mean_gap),
            Self::Stiffness => return None,
        };
        Some(told).filter(|told| told.limit.is_finite())
    }

    /// The factors of the zone and of the difference to the coarser grid, and that of the zone without a coarser grid.
    fn factors(self) -> [f64; 3] {
        match self {
            Self::Area => [0.6, 1.2, 1.5],
            Self::Gap => [4.0, 4.0, 7.5],
            Self::Approach => [2.5, 0.0, 3.75],
            Self::Pressure | Self::Stiffness => [6.0, 3.0, 15.0],
        }
    }
}

/// The estimated error of a quantity on the finest of some levels, the coarsest first.
pub(super) fn error(levels: &[Level], quantity: Quantity, resolves: impl Fn(f64) -> bool) -> Option<GridError> {
    let (finest, coarser) = levels.split_last().filter(|_| resolves(1.0))?;
    let told = quantity.told(finest)?;
    let area = Quantity::Area.told(finest)?;
    let mut limits = vec![told.limit];
    let mut change = None;
    for level in coarser.iter().rev() {
        let factor = f64::from(1 << limits.len());
        let usable = is_coarser(level, finest, factor) && resolves(factor);
        let Some(coarse) = quantity.told(level).filter(|_| usable) else { break };
        change = change.or_else(|| Some(Quantity::Area.told(level)?.limit - area.limit));
        limits.push(coarse.limit);
    }
    let [of_zone, of_difference, alone] = quantity.factors();
    let error = match limits[..] {
        [limit, coarse, ..] => (of_zone * told.zone).hypot(of_difference * (limit - coarse)),
        _ => alone * told.zone,
    };
    let apart = change.is_some_and(|change| change.abs() > 0.5 * area.zone);
    let relative = if apart { APART * error } else { error } / told.value.abs();
    let rough = apart || change.is_none();
    Some(GridError { relative, order: observed_order(&limits), rough }).filter(|error| error.relative.is_finite())
}
