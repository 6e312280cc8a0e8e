//! The error of the grid with a law that has the range of the grid: by the process zone at the edge of the contact.

use super::fitted::{Factors, ZONE};
use super::{GridError, Quantity, at_edge, is_coarser, observed_order};
use crate::nested::Level;

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
        let (zone, work) = (level.area.process_zone, 0.0 - level.adhesive_energy / by_energy);
        let of = |value: f64, sign: f64, zone: f64| Told { value, limit: value + sign * zone, zone };
        // the energy of the zone over what moves its edge
        let length = work * zone / level.mean_contact_pressure;
        let told = match self {
            Self::Area => Told { value: area, limit: area, zone },
            Self::Gap => of(level.mean_gap, 1.0, length),
            Self::Approach => of(level.approach?, -1.0, length),
            Self::Pressure => of(level.mean_pressure, 1.0, work * zone / level.mean_gap),
            Self::Work | Self::Tension => return None,
        };
        Some(told).filter(|told| told.limit.is_finite())
    }

    /// The relative error without adhesion, besides the share of the difference to the coarser grid.
    fn without_adhesion(self, finest: &Level, coarser: Option<&Level>, nodes_per_wave: f64) -> Option<f64> {
        let line = finest.shape.0 == 1 || finest.shape.1 == 1;
        let [places, _] = at_edge(&finest.area, nodes_per_wave, 0.0);
        let waves = if coarser.is_none() || finest.area.edges == 0 { self.by_waves(nodes_per_wave, line) } else { 0.0 };
        let [with_coarser, alone] = Factors::of(self, line)?.places;
        let of_places = if coarser.is_some() { with_coarser } else { alone };
        Some(GridError::COVER * (of_places * places).hypot(waves))
    }
}

/// The estimated error of a quantity on the finest of some levels, the coarsest first.
pub(super) fn error(
    levels: &[Level],
    quantity: Quantity,
    nodes_per_wave: f64,
    resolves: impl Fn(f64) -> bool,
) -> Option<GridError> {
    let (finest, coarser) = levels.split_last().filter(|_| resolves(1.0))?;
    let told = quantity.told(finest)?;
    let area = Quantity::Area.told(finest)?;
    let mut limits = vec![told.limit];
    let mut before = None;
    for level in coarser.iter().rev() {
        let factor = f64::from(1 << limits.len());
        let usable = is_coarser(level, finest, factor) && resolves(factor);
        let Some(coarse) = quantity.told(level).filter(|_| usable) else { break };
        before = before.or(Some(level));
        limits.push(coarse.limit);
    }
    let change = before.and_then(|level| Some((Quantity::Area.told(level)?.limit - area.limit).abs()));
    let without_adhesion = |of: Quantity| of.without_adhesion(finest, before, nodes_per_wave);
    let (elastic, of_area) = (without_adhesion(quantity)?, without_adhesion(Quantity::Area)? * area.limit);
    let adhesive = area.zone / (area.zone + of_area).max(f64::MIN_POSITIVE);
    // around holes the zone is narrower
    let closed = if quantity == Quantity::Area { 1.0 + area.limit.powi(4) } else { 1.0 };
    let Factors { zone: [of_zone, of_difference, alone], weak, .. } = Factors::of(quantity, false)?;
    // where adhesion carries more than the load
    let pull = (1.0 - finest.mean_pressure / finest.mean_contact_pressure).clamp(0.0, 1.0);
    let strong = if quantity == Quantity::Area { 1.0 + ZONE.strong * pull * pull } else { 1.0 };
    let [of_zone, alone] = [strong * of_zone, alone].map(|factor| closed * factor);
    let of_difference = adhesive * of_difference + (1.0 - adhesive) * (weak * GridError::COVER);
    let error = match limits[..] {
        [limit, coarse, ..] => (of_zone * told.zone).hypot(of_difference * (limit - coarse)),
        _ => alone * told.zone,
    };
    let apart = change.is_some_and(|change| change > 0.5 * area.zone + of_area);
    let relative = (if apart { ZONE.apart * error } else { error } / told.value.abs()).hypot(elastic);
    let rough = apart || change.is_none();
    let is_told = relative.is_finite() && relative > 0.0;
    is_told.then(|| GridError { relative, order: observed_order(&limits), rough })
}
