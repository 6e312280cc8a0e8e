//! What a grid says of the limit, and how wrong that is, by the zone at the edge and by a grid of half the nodes.

use crate::scene::{Kind, Level, Scene};

/// The difference of the areas less their zones, over the zone, above which the grid is too coarse.
const FAR: f64 = 0.5;

/// The factor of the error where that may be far larger.
const ROUGH: f64 = 3.0;

/// A quantity of a scene.
#[derive(Clone, Copy, PartialEq)]
pub enum Quantity {
    Area,
    Gap,
    Approach,
    Pressure,
    PullOff,
}

/// A quantity as it is found on a grid, and how much of it is the zone at the edge.
#[derive(Clone, Copy)]
pub struct Found {
    pub value: f64,
    pub zone: f64,
}

impl Found {
    /// It less the zone.
    pub fn less_zone(&self) -> f64 {
        self.value - self.zone
    }
}

impl Quantity {
    pub const ALL: [Self; 5] = [Self::Area, Self::Gap, Self::Approach, Self::Pressure, Self::PullOff];

    pub fn name(self) -> &'static str {
        match self {
            Self::Area => "area, less the zone",
            Self::Gap => "mean gap",
            Self::Approach => "approach",
            Self::Pressure => "mean pressure",
            Self::PullOff => "pull-off, less the zone",
        }
    }

    /// Whether the scene has it, and does not give it.
    pub fn is_found(self, scene: &Scene) -> bool {
        let free = scene.kind == Kind::Sphere;
        match self {
            Self::Area => true,
            Self::Gap => !free && !scene.by_gap,
            Self::Approach => free,
            Self::Pressure => scene.by_gap,
            Self::PullOff => scene.pulls,
        }
    }

    /// As it is found on a grid.
    pub fn found(self, level: &Level) -> Found {
        let (value, zone) = match self {
            Self::Area => (level.areas.by_energy, level.areas.zone()),
            Self::Gap => (level.gap, -level.areas.zone_length()),
            Self::Approach => (level.approach, level.areas.zone_length()),
            Self::Pressure => (level.pressure, -level.areas.zone_length() * level.contact_pressure / level.gap),
            Self::PullOff => (level.pull_off, level.pull_off * level.lost.map_or(f64::NAN, |areas| areas.zone_share())),
        };
        Found { value, zone }
    }

    /// As it is reported: area and pull-off less the zone, all else as found.
    pub fn reported(self, found: &Found) -> f64 {
        match self {
            Self::Area | Self::PullOff => found.less_zone(),
            Self::Gap | Self::Approach | Self::Pressure => found.value,
        }
    }

    /// What its errors are relative to.
    pub fn scale(self, limit: f64, finest: &Level) -> f64 {
        if self == Self::Pressure { finest.contact_pressure } else { limit.abs() }
    }

    /// The factors of the zone and of the difference to the coarser grid in the error, and the factor of the zone
    /// alone.
    fn factors(self) -> [f64; 3] {
        match self {
            Self::Area => [0.6, 1.2, 1.0],
            Self::PullOff => [1.2, 0.75, 1.2],
            Self::Gap => [4.0, 4.0, 5.0],
            Self::Approach => [2.5, 0.0, 2.5],
            Self::Pressure => [6.0, 3.0, 10.0],
        }
    }

    /// The error of what is reported, by the zone, and by the difference less the zone to a grid of half the nodes.
    pub fn error(self, fine: &Found, coarse: Option<&Found>, is_rough: bool) -> f64 {
        let [of_zone, of_difference, alone] = self.factors();
        let error = match coarse {
            Some(coarse) => (of_zone * fine.zone).hypot(of_difference * (fine.less_zone() - coarse.less_zone())),
            None => alone * fine.zone.abs(),
        };
        if is_rough { ROUGH * error } else { error }
    }

    /// Whether the error may be far larger: where the areas of the grids differ by too much.
    pub fn is_rough(self, fine: &Level, coarse: Option<&Level>) -> bool {
        let area = |level: &Level| Self::Area.found(level);
        let differ = |coarse| (area(fine).less_zone() - area(coarse).less_zone()).abs() > FAR * area(fine).zone;
        self != Self::PullOff && coarse.is_some_and(differ)
    }
}
