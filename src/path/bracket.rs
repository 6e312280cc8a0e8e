//! The bracket of a jump: from the last state to the end of a step that was taken back.

use super::account::Balance;

/// The share of the imbalance of a step that was taken back, below which its first half has none.
const AHEAD: f64 = 0.125;

/// The end of the shortest step that was taken back: what it jumped over, or bent too much in, is on the way there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Bracket {
    /// the held quantity there
    pub(super) target: f64,
    /// the derivative of the potential by it
    pub(super) slope: f64,
    pub(super) excess: f64,
    pub(super) drop: f64,
    /// the length of the first step that was taken back
    pub(super) stride: f64,
}

impl Bracket {
    /// The length of the next step from a state on the way, with the balance of the step to it: half the way where the
    /// jump is ahead and not located, so that no state behind it is solved twice.
    pub(super) fn next_step(&self, (at, slope): (f64, f64), balance: Balance) -> f64 {
        let left = (self.target - at).abs();
        let is_ahead = balance.excess.abs() < AHEAD * self.excess.abs();
        let is_located = Balance { drop: self.drop, ..balance }.locates(left * (self.slope - slope));
        if is_ahead && !is_located { 0.5 * left } else { left }
    }
}
