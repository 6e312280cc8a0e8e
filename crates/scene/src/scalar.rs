//! Scalars in which one can solve, and that files have.

use asperity::Real;
use ndarray::Array2;
use ndarray_npy::WritableElement;

/// A scalar in which one can solve, and that can be written.
pub trait Scalar: Real + WritableElement {
    /// A field in this precision; in place, if it is that of the file.
    fn field(field: Array2<f64>) -> Array2<Self> {
        field.mapv_into_any(Self::lit)
    }
}

impl<T: Real + WritableElement> Scalar for T {}
