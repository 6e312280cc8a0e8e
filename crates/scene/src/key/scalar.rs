//! Scalars in which one can solve, and that files have.

use std::sync::Arc;

use asperity::adhesion::Formula;
use asperity::{AdhesionLaw, Real};
use ndarray::Array2;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A scalar in which one can solve, and that can be written: `f32` or `f64`.
pub trait Scalar: Real + Serialize + DeserializeOwned {
    /// A law in this precision.
    fn law(law: Formula) -> Arc<dyn AdhesionLaw<Self>>;

    /// A field in this precision; in place, if the file has this precision.
    fn field(field: Array2<f64>) -> Array2<Self> {
        field.mapv_into_any(Self::lit)
    }
}

impl Scalar for f32 {
    fn law(law: Formula) -> Arc<dyn AdhesionLaw<Self>> {
        law
    }
}

impl Scalar for f64 {
    fn law(law: Formula) -> Arc<dyn AdhesionLaw<Self>> {
        law
    }
}
