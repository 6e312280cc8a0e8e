//! The wall between the surfaces.

use asperity::{ContactConstraint, Hardness, NoWall, Penalty, Projection, Real, Result, Uzawa};

use crate::key::choice;

/// The constraint of a solve, of any kind.
pub type Constraint<T> = Box<dyn ContactConstraint<T>>;

choice! {
    /// The wall that keeps the surfaces apart, by its name.
    Wall {
        /// rigid, at zero gap
        Hard = "hard",
        /// the law itself
        None = "none",
        /// springs at zero gap, into which the surfaces sink by the contact pressure over the stiffness
        Penalty = "penalty",
        /// springs with multipliers that take over the contact pressure, in rounds, until the wall is hard
        Uzawa = "uzawa",
    }
}

impl Wall {
    /// Whether it is made of springs, which have a stiffness.
    pub fn has_springs(self) -> bool {
        matches!(self, Self::Penalty | Self::Uzawa)
    }

    /// The constraint of a solve, with springs of a stiffness k, a pressure per length, if it has some, and a hardness,
    /// if the surface yields.
    ///
    /// # Errors
    /// As [`Penalty::new`] and [`Uzawa::new`]; a stiffness that is not given is zero.
    pub fn constraint<T: Real>(self, stiffness: Option<f64>, hardness: Option<Hardness>) -> Result<Constraint<T>> {
        let stiffness = stiffness.unwrap_or_default();
        Ok(match (self, hardness) {
            (Self::Hard, None) => Box::new(Projection),
            (Self::Hard, Some(hardness)) => Box::new(hardness),
            (Self::None, _) => Box::new(NoWall),
            (Self::Penalty, _) => Box::new(Penalty::new(stiffness)?),
            (Self::Uzawa, _) => Box::new(Uzawa::new(stiffness)?),
        })
    }
}
