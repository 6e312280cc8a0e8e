//! The change of a solution with the mean gap.

use ndarray::Array2;

/// The change of a solution as the mean gap opens by 1, on the grid of the operator.
pub(super) struct Tangent<T> {
    pub(super) opening: Array2<T>,
    /// the contact pressure that is lost
    pub(super) pressure: Array2<T>,
}
