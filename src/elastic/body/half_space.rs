use super::Body;
use crate::error::{Error, Result};

/// The homogeneous half-space: k = ½E*q. [`Westergaard`](crate::Westergaard) is its operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    modulus: f64,
}

impl HalfSpace {
    /// The half-space of a contact modulus E*, a pressure.
    ///
    /// # Errors
    /// [`Error::Value`] if the modulus is not positive and finite.
    pub fn new(modulus: f64) -> Result<Self> {
        Ok(Self { modulus: Error::positive("contact modulus", modulus)? })
    }
}

impl Body for HalfSpace {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        0.5 * self.modulus * qx.hypot(qy)
    }

    fn modulus(&self) -> f64 {
        self.modulus
    }
}
