//! The place in which a solve ends, and from which others go on.

use ndarray::Array2;

/// The place in which a solve ends, on the grid of the operator: its gap, and where surfaces that attract each other next
/// to contacts alone have not parted.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Place<T> {
    pub(crate) gap: Array2<T>,
    /// none of other laws, and of a gap alone
    pub(crate) not_parted: Option<Array2<bool>>,
    /// whether surfaces touched at new places on the way there
    pub(crate) touches: bool,
}

impl<T> From<Array2<T>> for Place<T> {
    fn from(gap: Array2<T>) -> Self {
        Self { gap, not_parted: None, touches: false }
    }
}
