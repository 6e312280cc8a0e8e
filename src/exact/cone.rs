//! The cone, without adhesion.

use std::f64::consts::PI;

use crate::error::{Error, Result};

/// The contact of a cone −m r with a half-space, without adhesion; Love (1939), Sneddon (1965).
///
/// ```math
/// F = ½ π E* m a² ,   δ = ½ π m a
/// ```
///
/// ```
/// use asperity::exact::Cone;
/// let cone = Cone::new(0.1, 1.0)?;
/// assert!((cone.load(cone.contact_radius(1e-3)?) / 1e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    slope: f64,
    modulus: f64,
}

impl Cone {
    /// A cone of slope m (height over radius) on a half-space of contact modulus E* (pressure).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(slope: f64, modulus: f64) -> Result<Self> {
        Error::positive("slope of the cone", slope)?;
        Error::positive("contact modulus", modulus)?;
        Ok(Self { slope, modulus })
    }

    /// The contact radius a at a load F.
    ///
    /// # Errors
    /// [`Error::Value`] if the load is negative or not finite.
    pub fn contact_radius(&self, load: f64) -> Result<f64> {
        Ok((2.0 * Error::non_negative("load", load)? / (PI * self.modulus * self.slope)).sqrt())
    }

    /// The load F at a contact radius a.
    pub fn load(&self, contact_radius: f64) -> f64 {
        0.5 * PI * self.modulus * self.slope * contact_radius.powi(2)
    }

    /// The approach δ at a contact radius a.
    pub fn approach(&self, contact_radius: f64) -> f64 {
        0.5 * PI * self.slope * contact_radius
    }
}
