//! The control that a user gives, and the load that it is on an operator's grid.

use crate::names::names;

/// The control: what is held fixed while the energy is minimised.
///
/// | control | periodic | free | what follows |
/// |---|---|---|---|
/// | [`MeanGap`](Self::MeanGap) | yes | no | the pressure |
/// | [`MeanPressure`](Self::MeanPressure), [`Force`](Self::Force) | yes | yes | mean gap and approach |
/// | [`Approach`](Self::Approach) | no | yes | the force |
/// | [`Spring`](Self::Spring) | yes | yes | force and position |
///
/// The [`Boundary`](crate::Boundary) is the operator's. Other controls are refused, and mean gap and spring for a
/// periodic surface with [absent nodes](crate::Surface::with_absent), where the load does not work on the mean gap of
/// the others.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let by_gap = Solver::default().solve(&mut problem, Control::MeanGap(0.01))?.report;
/// let by_pressure = Solver::default().solve(&mut problem, Control::MeanPressure(by_gap.mean_pressure))?.report;
/// assert!((by_pressure.mean_gap / 0.01 - 1.0).abs() < 1e-5); // the same state, either way
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Control {
    /// The mean gap ḡ ≥ 0 is given; the external pressure follows.
    MeanGap(f64),
    /// The mean external pressure p̄ is given, the force over the area Lx·Ly, compression positive.
    MeanPressure(f64),
    /// The normal force F = p̄·Lx·Ly is given, compression positive.
    #[cfg_attr(feature = "serde", serde(rename = "normal-force"))]
    Force(f64),
    /// The approach δ is given: how far the bodies have moved together since they would first touch undeformed.
    Approach(f64),
    /// A spring in series is held at its far end: with a free boundary F = k (rest − δ), in a periodic cell, which has
    /// no approach, F = k (ḡ − rest).
    Spring {
        /// The stiffness k, force per length.
        stiffness: f64,
        /// The approach δ at which the spring is relaxed; in a periodic cell the mean gap.
        rest: f64,
    },
}

names!(Control {
    MeanGap = "mean-gap",
    MeanPressure = "mean-pressure",
    Force = "normal-force",
    Approach = "approach",
    Spring = "spring",
});

/// What a [`Control`] holds, as [`Control::holds`] says it.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// The mean gap.
    MeanGap,
    /// The approach.
    Approach,
    /// The load itself: a mean pressure or a force.
    Load,
    /// The far end of a spring of this stiffness, force per length.
    Spring(f64),
}

impl Control {
    /// What is held: of a pressure and of a force the load.
    ///
    /// ```
    /// use asperity::{Control, Held};
    /// assert_eq!(Control::Force(2.0).holds(), Held::Load);
    /// assert_eq!(Control::Spring { stiffness: 3.0, rest: 0.1 }.holds(), Held::Spring(3.0));
    /// ```
    pub fn holds(mut self) -> Held {
        self.quantity().0
    }

    /// The value that is held: a length, pressure or force; of a spring its rest.
    pub fn value(mut self) -> f64 {
        *self.quantity().2
    }

    /// What is held, its name in messages, and its value.
    pub(super) fn quantity(&mut self) -> (Held, &'static str, &mut f64) {
        match self {
            Self::MeanGap(gap) => (Held::MeanGap, "mean gap", gap),
            Self::MeanPressure(pressure) => (Held::Load, "mean pressure", pressure),
            Self::Force(force) => (Held::Load, "normal force", force),
            Self::Approach(approach) => (Held::Approach, "approach", approach),
            Self::Spring { stiffness, rest } => (Held::Spring(*stiffness), "rest of the spring", rest),
        }
    }

    /// The control of the same kind with another value.
    pub(crate) fn with_value(mut self, value: f64) -> Self {
        *self.quantity().2 = value;
        self
    }

    /// The value, of a force the mean pressure on a nominal area.
    pub(super) fn value_on(self, area: f64) -> f64 {
        match self {
            Self::Force(force) => force / area,
            Self::MeanGap(_) | Self::MeanPressure(_) | Self::Approach(_) | Self::Spring { .. } => self.value(),
        }
    }

    /// The load on the position, which is the mean gap, or with a free boundary minus the approach: a force is the mean
    /// pressure on a nominal area, and a spring has its own stiffness.
    pub(crate) fn on_position(self, free: bool, area: f64) -> Load {
        let value = self.value_on(area);
        match self.holds() {
            Held::MeanGap => Load::Gap(value),
            Held::Approach => Load::Gap(-value),
            Held::Load => Load::Pressure(value),
            Held::Spring(stiffness) => Load::Spring { stiffness, rest: if free { -value } else { value } },
        }
    }

    /// Whether another control differs from this one in the value alone.
    pub(crate) fn is_like(self, other: Self) -> bool {
        self.with_value(other.value()) == other
    }

    /// The control on a part of a free surface with these side lengths, if all of the load is on the part, and the
    /// highest node of the part is so much lower.
    pub(crate) fn on_part(self, (lx, ly): (f64, f64), lower: f64) -> Self {
        match self {
            Self::MeanPressure(pressure) => Self::Force(pressure * lx * ly),
            Self::Approach(position) | Self::Spring { rest: position, .. } => self.with_value(position - lower),
            Self::MeanGap(_) | Self::Force(_) => self,
        }
    }

    /// The control on a share of the area, or on several areas, as this control on the area: with their force.
    pub(crate) fn of_share(self, share: f64) -> Self {
        match self {
            Self::Force(force) => Self::Force(share * force),
            Self::Spring { stiffness, rest } => Self::Spring { stiffness: share * stiffness, rest },
            Self::MeanGap(_) | Self::MeanPressure(_) | Self::Approach(_) => self,
        }
    }
}

/// The control on the operator's grid: what holds its mean gap m over all nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Load {
    /// m itself
    Gap(f64),
    /// the mean pressure on the operator's grid
    Pressure(f64),
    /// the mean pressure `stiffness`·(m − `rest`) on the operator's grid
    Spring { stiffness: f64, rest: f64 },
}

impl Load {
    /// The mean pressure at a mean gap; zero where the gap is given.
    pub(crate) fn pressure_at(self, mean_gap: f64) -> f64 {
        match self {
            Self::Gap(_) => 0.0,
            Self::Pressure(pressure) => pressure,
            Self::Spring { stiffness, rest } => stiffness * (mean_gap - rest),
        }
    }

    /// The load on the wall alone, of gaps above the equilibrium separation; a tension would have no hold.
    pub(crate) fn of_wall(self, separation: f64) -> Self {
        match self {
            Self::Gap(gap) => Self::Gap((gap - separation).max(0.0)),
            Self::Pressure(pressure) => Self::Pressure(pressure.max(0.0)),
            Self::Spring { stiffness, rest } => Self::Spring { stiffness, rest: rest - separation },
        }
    }

    /// The energy of the load over its pressure times the mean gap from its rest.
    pub(crate) fn share(self) -> f64 {
        if let Self::Spring { .. } = self { 0.5 } else { 1.0 }
    }

    pub(crate) fn stiffness(self) -> f64 {
        if let Self::Spring { stiffness, .. } = self { stiffness } else { 0.0 }
    }

    pub(crate) fn rest(self) -> f64 {
        if let Self::Spring { rest, .. } = self { rest } else { 0.0 }
    }
}
