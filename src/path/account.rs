//! The account of energy along a path.

/// The figures of a path at its end, or so far.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEnd {
    /// The work done by the load, [`PathStep::work`](super::PathStep::work).
    pub work: f64,
    /// The standard error of the work, [`PathStep::work_error`](super::PathStep::work_error).
    pub work_error: f64,
    /// The energy dropped in jumps, [`PathStep::dissipated`](super::PathStep::dissipated).
    pub dissipated: f64,
    /// The greatest tension of the states after the first, a pressure; zero if there was none.
    pub greatest_tension: f64,
    /// The number of states on the way to which surfaces touched at new places, by a law that attracts [next to contacts
    /// alone](crate::adhesion::Hints::touching).
    pub touches: usize,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Account {
    pub(super) work: f64,
    pub(super) dissipated: f64,
    pub(super) imbalance: f64,
    /// the square of the error of the work
    pub(super) variance: f64,
    /// the least and the largest energy
    pub(super) range: (f64, f64),
    /// the largest tension
    pub(super) tension: f64,
    /// the number of states on the way to which surfaces touched at new places
    pub(super) touches: usize,
}
