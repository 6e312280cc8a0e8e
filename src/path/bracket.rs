//! The bracket of a jump: from the last state to the end of a step that was taken back.

use super::balance::Balance;
use super::quadrature::trapezoid;
use crate::degrees::MOSTLY;

/// The end of the shortest step that was taken back: what it jumped over, or bent too much in, is on the way there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bracket {
    /// the held quantity there, and the derivative of the potential by it
    pub(super) end: (f64, f64),
    pub(super) potential: f64,
    /// what a jump in the whole of it would dissipate
    pub(super) drop: f64,
    /// the length of the first step that was taken back
    pub(super) stride: f64,
}

impl Bracket {
    /// Whether a step on the way jumps by as much as the one that was taken back: of the energy under a corner of the load,
    /// where a node comes into contact, half at most is left.
    pub(super) fn keeps(&self, drop: f64) -> bool {
        drop >= MOSTLY * self.drop && self.drop >= MOSTLY * drop
    }

    /// The length of the next step from a state on the way, with the balance of the step to it: half the way if a jump
    /// is ahead that the whole would not locate, so that no state behind it is solved twice.
    pub(super) fn next_step(&self, (at, slope): (f64, f64), potential: f64, balance: Balance) -> f64 {
        let left = self.end.0 - at;
        let product = left * (self.end.1 - slope);
        let drop = trapezoid((at, slope), self.end) - (self.potential - potential);
        // the trapezoid rule is right to a sixth where the load is a parabola
        let is_smooth = drop.abs() <= balance.allowed.max(1.0 / 6.0 * product.abs());
        let locates = self.keeps(drop) && Balance { drop, ..balance }.locates(product);
        if is_smooth || locates { left.abs() } else { 0.5 * left.abs() }
    }
}
