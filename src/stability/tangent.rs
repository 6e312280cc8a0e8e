//! The change of a solution with the mean gap.

use crate::field::Field;

/// The change of a solution as the mean gap opens by 1, on the grid of the operator.
pub(super) struct Tangent<T> {
    pub(super) opening: Field<T>,
    /// the contact pressure that is lost
    pub(super) pressure: Field<T>,
}
