//! The account of energy along a path, and the balance of a step.

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Account {
    pub(super) work: f64,
    pub(super) dissipated: f64,
    pub(super) imbalance: f64,
    /// the least and the largest energy
    pub(super) range: (f64, f64),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// whether the energy changed by the work of the load
    pub(super) balanced: bool,
    /// whether it fell by more than any work of the load in such a step
    pub(super) jumped: bool,
    /// the work by quadrature
    pub(super) work: f64,
    /// the change of the energy beyond the work
    pub(super) excess: f64,
    /// the factor by which the next step may be longer
    pub(super) growth: f64,
}
