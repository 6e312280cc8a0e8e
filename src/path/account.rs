//! The account of energy along a path, and the balance of a step.

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

/// The share of the energy of a jump to which the work of the load in its step is known.
const LOCATED: f64 = 0.2;

#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// whether the energy changed by the work of the load
    pub(super) balanced: bool,
    /// whether it fell by more than any work of the load in such a step
    pub(super) jumped: bool,
    /// whether it jumped in a step that is short enough to be taken
    pub(super) located: bool,
    /// whether the tension may have grown in it beyond the largest one so far
    pub(super) peaks: bool,
    /// the imbalance that the step may have
    pub(super) allowed: f64,
    /// the work by quadrature
    pub(super) work: f64,
    /// the change of the energy beyond the work
    pub(super) excess: f64,
    /// what a jump anywhere in it dissipates
    pub(super) drop: f64,
    /// the factor by which the next step may be longer
    pub(super) growth: f64,
}

impl Balance {
    /// Whether a jump is located by a step, from the product of the step and the change of the load: its work lies
    /// within half of that, as the jump may be anywhere in the step.
    pub(super) fn locates(&self, product: f64) -> bool {
        0.5 * product.abs() <= self.allowed.max(LOCATED * self.drop)
    }
}
