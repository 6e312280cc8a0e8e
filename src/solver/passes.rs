//! The passes over fields that make an iteration.
//!
//! Each does all that can be done while its nodes are in cache, as their cost is memory traffic. Law and constraint
//! come in as a [`Potential`](super::potential::Potential), at one virtual call a chunk.

use crate::field::{Field, Reducer};
use crate::grid::Grid;
use crate::real::Real;

mod held;
mod residual;
mod step;
mod tally;

pub(super) use held::{hold, release_held};
pub(super) use residual::{Continued, Working};
pub(super) use residual::{idle, release, released, residual};
pub(super) use step::{Advance, Attempt, Tried, advance, energy_after, reach, trial};
pub(super) use tally::{FullTally, Tally, tally};

/// The fields of a solve: the state in the precision T, its corrections in Lo.
#[derive(Debug)]
pub(super) struct Fields<T, Lo> {
    /// the gap g
    pub(super) gap: Field<T>,
    /// the elastic pressure p = K⁻¹(g + h), of zero mean
    pub(super) pressure: Field<T>,
    /// the residual r' (negative zero: a node outside of the working set), or during a step K⁻¹c of the change c
    pub(super) residual: Field<Lo>,
    /// the preconditioned residual z = M r', until then of the previous state
    pub(super) preconditioned: Field<Lo>,
    /// the change c, a multiple of the last step, during the next one not yet scaled to the mean gap; the direction t
    /// of [`Method::Rey2017`](crate::solver::Method)
    pub(super) change: Field<Lo>,
    pub(super) reducer: Reducer,
    /// the least r in contact of each chunk
    pub(super) least_r: Vec<f64>,
    /// the number of nodes in the working set of each chunk
    pub(super) moving: Vec<f64>,
}

impl<T: Real, Lo: Real> Fields<T, Lo> {
    pub(super) fn new(grid: &Grid, gap: Field<T>, pressure: Field<T>) -> Self {
        let reducer = grid.reducer();
        let [residual, preconditioned, change] = std::array::from_fn(|_| Field::zeros(gap.dim()));
        let [least_r, moving] = std::array::from_fn(|_| vec![0.0; reducer.chunks()]);
        Self { gap, pressure, residual, preconditioned, change, reducer, least_r, moving }
    }
}

#[inline(always)]
pub(super) fn count(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

#[inline(always)]
pub(super) fn idles<T: Real>(residual: T) -> bool {
    (residual == T::zero()) & residual.is_sign_negative()
}
