//! A state on a path of equilibria.

use super::Event;
use crate::real::Real;
use crate::solver::Solution;

/// A state on a path.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct PathStep<T: Real> {
    /// The state; its report has the control.
    pub solution: Solution<T>,
    /// The leg that it is on: 0 is the start, 1 the way to the second load.
    pub leg: usize,
    /// The work done by the load since the start, −∫p̄ dḡ, and with a free boundary ∫p̄ dδ, per nominal area.
    pub work: f64,
    /// The energy dropped in jumps since the start, per area; over a closed cycle, the lost work of adhesion.
    pub dissipated: f64,
    /// The imbalance of energy: its change, plus the dissipated energy, less the work. It comes from quadrature,
    /// tolerance, and jumps below the imbalance that a step may have.
    pub imbalance: f64,
    /// The standard error of the work, and over a closed cycle of the energy dissipated: a jump is anywhere in its step,
    /// and what a step is out of balance may be work. Jumps that a longer step takes too early are not in it.
    pub work_error: f64,
    /// The event between the previous state and this one.
    pub event: Option<Event>,
}
