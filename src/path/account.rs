//! The account of energy along a path.

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
}
