//! The flat punch, and the uniform pressure on a square.

use std::f64::consts::PI;

use crate::error::{Error, Result};

/// The contact of a rigid cylinder's flat end, of radius a, without friction or adhesion; Boussinesq (1885).
///
/// ```math
/// F = 2 a E* δ ,   p(r) = F / (2πa √(a² − r²))
/// ```
///
/// ```
/// use asperity::exact::FlatPunch;
/// let punch = FlatPunch::new(0.5, 2.0)?;
/// assert_eq!((punch.load(0.01), punch.approach(0.02)), (0.02, 0.01));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatPunch {
    radius: f64,
    modulus: f64,
}

impl FlatPunch {
    /// A punch of radius a (length) on a half-space of contact modulus E* (pressure).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(radius: f64, modulus: f64) -> Result<Self> {
        Error::positive("radius of the punch", radius)?;
        Error::positive("contact modulus", modulus)?;
        Ok(Self { radius, modulus })
    }

    /// The load F at an approach δ.
    pub fn load(&self, approach: f64) -> f64 {
        2.0 * self.radius * self.modulus * approach
    }

    /// The approach δ at a load F.
    pub fn approach(&self, load: f64) -> f64 {
        load / (2.0 * self.radius * self.modulus)
    }

    /// The pressure at the distance r ≥ 0 from the axis: infinite at the edge, zero beyond.
    pub fn pressure(&self, load: f64, r: f64) -> f64 {
        if r > self.radius { 0.0 } else { load / (2.0 * PI * self.radius * (self.radius.powi(2) - r * r).sqrt()) }
    }
}
