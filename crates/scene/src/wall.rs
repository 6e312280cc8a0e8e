//! The wall between the surfaces.

use std::fmt;

use asperity::constraint::Update;
use asperity::{ContactConstraint, Grid, Hardness, NoWall, Penalty, Projection, Real, Result, Uzawa};
use ndarray::ArrayView2;
use serde::{Deserialize, Serialize};

/// The wall that keeps the surfaces apart, by its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum Wall {
    /// rigid, at zero gap
    #[default]
    Hard,
    /// the law itself
    None,
    /// springs at zero gap, into which the surfaces sink by the contact pressure over the stiffness
    Penalty,
    /// springs whose multipliers take over the contact pressure, in rounds, until the wall is hard
    Uzawa,
}

impl Wall {
    /// Whether it is made of springs, which have a stiffness.
    pub fn has_springs(self) -> bool {
        matches!(self, Self::Penalty | Self::Uzawa)
    }
}

impl fmt::Display for Wall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// The wall as a solve takes it.
#[derive(Clone, Debug, PartialEq)]
pub enum Constraint<T> {
    /// A rigid wall.
    Hard,
    /// A rigid wall, up to a hardness at which the surface yields.
    Capped(Hardness),
    /// No wall.
    None,
    /// Springs.
    Penalty(Penalty),
    /// Springs with multipliers.
    Uzawa(Uzawa<T>),
}

impl<T: Real> Constraint<T> {
    /// The wall of a name, with springs of a stiffness k, a pressure per length, if it has some, and a hardness, if the
    /// surface yields.
    ///
    /// # Errors
    /// Those of [`Penalty::new`] and [`Uzawa::new`]; a stiffness that is not given is zero.
    pub fn new(wall: Wall, stiffness: Option<f64>, hardness: Option<Hardness>) -> Result<Self> {
        let stiffness = stiffness.unwrap_or_default();
        Ok(match wall {
            Wall::Hard => hardness.map_or(Self::Hard, Self::Capped),
            Wall::None => Self::None,
            Wall::Penalty => Self::Penalty(Penalty::new(stiffness)?),
            Wall::Uzawa => Self::Uzawa(Uzawa::new(stiffness)?),
        })
    }
}

impl<T: Real> ContactConstraint<T> for Constraint<T> {
    fn wall(&self) -> asperity::constraint::Wall<'_, T> {
        match self {
            Self::Hard => Projection.wall(),
            Self::Capped(wall) => wall.wall(),
            Self::None => NoWall.wall(),
            Self::Penalty(wall) => wall.wall(),
            Self::Uzawa(wall) => wall.wall(),
        }
    }
    fn start(&mut self, grid: &Grid, stiffest: f64, tolerance: f64) -> Result<()> {
        match self {
            Self::Hard | Self::None => Ok(()),
            Self::Capped(wall) => ContactConstraint::<T>::start(wall, grid, stiffest, tolerance),
            Self::Penalty(wall) => ContactConstraint::<T>::start(wall, grid, stiffest, tolerance),
            Self::Uzawa(wall) => wall.start(grid, stiffest, tolerance),
        }
    }
    fn round_tolerance(&self) -> f64 {
        if let Self::Uzawa(wall) = self { wall.round_tolerance() } else { 0.0 }
    }
    fn ends_rigid(&self) -> bool {
        matches!(self, Self::Uzawa(_))
    }
    fn update(&mut self, gap: ArrayView2<'_, T>, work: f64) -> Update {
        if let Self::Uzawa(wall) = self { wall.update(gap, work) } else { Update::Done }
    }
}
