//! The settings of a path of equilibria.

use crate::setters::setters;

/// The settings of a path of equilibria.
///
/// | field | default | meaning | range |
/// |---|---|---|---|
/// | `steps` | 50 | the least number of steps in a leg | at least 1 |
/// | `smallest_step` | none | the step, as a share of the leg, to which a jump is located; none: until the work of the step is known to a fifth of the energy that the jump dissipates, or to 1e-4 of the leg | positive, below 1 |
/// | `smooth` | true | whether jumps of the law's traction are smoothed, by what the grid can resolve | |
/// | `imbalance` | 1e-4 | how far the energy may be from the work done in a step, as a share of how much the energy has changed along the path (or of w/1000, if that is more), and of twenty times what jumps have dissipated so far | positive |
///
/// A solver without a tolerance of its own solves to a hundredth of the root of the imbalance, between 1e-6 (the default
/// of the precision) and 1e-4. The square of a tolerance that is given must be well below the imbalance. That square
/// times the energy of the surface pressed flat is no imbalance, nor is rounding: in `f32` jumps below a millionth of
/// that energy are lost in it. [`Path`](super::Path) has an example.
///
/// Without a smallest step a jump takes some three solves. With one it takes a solve for each halving of the step, and
/// the tension before it is as close as that step.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct PathSettings {
    /// The least number of steps in a leg.
    pub steps: usize,
    /// The step to which a jump is located, as a share of the leg.
    pub smallest_step: Option<f64>,
    /// The imbalance of energy that a step may have without being a jump.
    pub imbalance: f64,
    /// Whether jumps of the law's traction are smoothed.
    pub smooth: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self { steps: 50, smallest_step: None, imbalance: 1e-4, smooth: true }
    }
}

impl PathSettings {
    setters! { steps: usize, smallest_step: impl Into<Option<f64>>, imbalance: f64, smooth: bool }
}
