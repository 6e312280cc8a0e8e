//! The wall between the surfaces.

use asperity::{ContactConstraint, NoWall, Projection, Real};
use serde::{Deserialize, Serialize};

/// The wall that keeps the surfaces apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "options", derive(clap::ValueEnum))]
pub enum Wall {
    /// rigid, at zero gap
    #[default]
    Hard,
    /// the law itself
    None,
}

impl<T: Real> ContactConstraint<T> for Wall {
    fn wall(&self) -> asperity::constraint::Wall<'_, T> {
        match self {
            Self::Hard => Projection.wall(),
            Self::None => NoWall.wall(),
        }
    }
    fn takes_slabs(&self) -> bool {
        true
    }
}
