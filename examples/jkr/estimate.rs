//! What a grid says of the limit, less the zone at the edge, and how wrong that is, by a grid of half the nodes.

use crate::scene::{Kind, Level, Scene};

/// A quantity of a scene.
#[derive(Clone, Copy, PartialEq)]
pub enum Quantity {
    Area,
    Gap,
    Approach,
    Pressure,
    Stiffness,
    PullOff,
}

impl Quantity {
    pub const ALL: [Self; 6] = [Self::Area, Self::Gap, Self::Approach, Self::Pressure, Self::Stiffness, Self::PullOff];

    pub fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::Gap => "mean gap",
            Self::Approach => "approach",
            Self::Pressure => "mean pressure",
            Self::Stiffness => "stiffness, two loads",
            Self::PullOff => "pull-off",
        }
    }

    /// Whether the scene has it, and does not give it.
    pub fn is_found(self, scene: &Scene) -> bool {
        let free = scene.kind == Kind::Sphere;
        match self {
            Self::Area | Self::Stiffness => true,
            Self::Gap => !free && !scene.by_gap,
            Self::Approach => free,
            Self::Pressure => scene.by_gap,
            Self::PullOff => scene.pulls,
        }
    }

    /// As it is found on a grid.
    pub fn found(self, level: &Level) -> f64 {
        match self {
            Self::Area => level.areas.by_energy,
            Self::Gap => level.gap,
            Self::Approach => level.approach,
            Self::Pressure => level.pressure,
            Self::Stiffness => level.secant,
            Self::PullOff => level.pull_off,
        }
    }

    /// How much of it is the zone at the edge.
    pub fn zone(self, level: &Level) -> f64 {
        match self {
            Self::Area => level.areas.zone(),
            Self::Gap => -level.areas.zone_length(),
            Self::Approach => level.areas.zone_length(),
            Self::Pressure => -level.secant * level.areas.zone_length(),
            Self::Stiffness => 0.0,
            Self::PullOff => level.pull_off * level.lost.map_or(f64::NAN, |areas| areas.zone_share()),
        }
    }

    /// It less the zone.
    pub fn less_zone(self, level: &Level) -> f64 {
        self.found(level) - self.zone(level)
    }

    /// What its errors are relative to.
    pub fn scale(self, limit: f64, finest: &Level) -> f64 {
        if self == Self::Pressure { finest.contact_pressure } else { limit.abs() }
    }

    /// The shares of the zone and of the difference to the coarser grid in the error.
    fn shares(self) -> [f64; 2] {
        match self {
            Self::Area => [0.5, 2.0],
            Self::PullOff => [1.0, 1.0],
            Self::Approach => [1.5, 1.5],
            Self::Gap | Self::Pressure | Self::Stiffness => [3.0, 3.0],
        }
    }

    /// The error of what is found less the zone.
    pub fn error(self, fine: &Level, coarse: &Level) -> f64 {
        let zone = if self == Self::Stiffness { fine.secant * fine.areas.zone_share() } else { self.zone(fine) };
        let [of_zone, of_difference] = self.shares();
        (of_zone * zone).hypot(of_difference * (self.less_zone(fine) - self.less_zone(coarse)))
    }
}
