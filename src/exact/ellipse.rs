//! The paraboloid with two radii of curvature, without adhesion: Hertz's contact ellipse.

use std::f64::consts::PI;

use super::numerics::{carlson_rd, carlson_rf};
use crate::error::{Error, Result};

/// Hertz's contact of a paraboloid −x²/2R₁ − y²/2R₂, R₁ ≥ R₂: an ellipse of semi-axes a along x and b along y. With
/// e² = 1 − b²/a², K and E the complete elliptic integrals of e, and p₀ = 3F/2πab:
///
/// ```math
/// R₁/R₂ = ((a/b)² E − K)/(K − E) ,   a b² = 3F E / (πE* (1/R₁ + 1/R₂)) ,   δ = p₀ b K/E*
/// ```
///
/// Hertz (1882); Johnson, *Contact Mechanics* (1985), section 4.2.
///
/// ```
/// use asperity::exact::{EllipticHertz, Hertz, Sphere};
/// let circle = Hertz::new(2.0, 1.0)?.at_load(1e-3)?;
/// let contact = EllipticHertz::new((2.0, 2.0 - 1e-9), 1.0)?.at_load(1e-3)?; // nearly a circle
/// assert!((contact.semi_axes.0 / circle.contact_radius() - 1.0).abs() < 1e-8);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticHertz {
    radii: (f64, f64),
    modulus: f64,
    /// b/a
    aspect: f64,
}

/// The state of an [`EllipticHertz`] contact.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticContact {
    /// The semi-axes (a, b) of the ellipse, along x and y.
    pub semi_axes: (f64, f64),
    /// The approach δ.
    pub approach: f64,
    /// The largest pressure p₀, in the centre.
    pub largest_pressure: f64,
}

impl EllipticHertz {
    /// A paraboloid of radii of curvature R₁ ≥ R₂ along x and y on a half-space of contact modulus E*.
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite, or if R₁ is less than R₂.
    pub fn new(radii: (f64, f64), modulus: f64) -> Result<Self> {
        Error::positive("radius of curvature R1", radii.0)?;
        Error::positive("radius of curvature R2", radii.1)?;
        Error::positive("contact modulus", modulus)?;
        if radii.0 < radii.1 {
            let (name, requirement) = ("radius of curvature R1", "no less than R2");
            return Err(Error::Value { name, value: radii.0, requirement });
        }
        // the ratio of curvatures falls with b/a
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        let goal = radii.0 / radii.1;
        while low.midpoint(high) > low && low.midpoint(high) < high {
            let aspect = low.midpoint(high);
            let (first, difference) = integrals(aspect);
            let second = first - difference;
            let ratio = (second / aspect.powi(2) - first) / difference;
            if ratio > goal { low = aspect } else { high = aspect }
        }
        Ok(Self { radii, modulus, aspect: high })
    }

    /// The contact under a load F.
    ///
    /// # Errors
    /// [`Error::Value`] if the load is not positive and finite.
    pub fn at_load(&self, load: f64) -> Result<EllipticContact> {
        Error::positive("load", load)?;
        let (first, difference) = integrals(self.aspect);
        let curvatures = self.radii.0.recip() + self.radii.1.recip();
        let second = first - difference;
        let a = (3.0 * load * second / (PI * self.modulus * curvatures * self.aspect.powi(2))).cbrt();
        let b = self.aspect * a;
        let largest_pressure = 1.5 * load / (PI * a * b);
        let approach = largest_pressure * b * first / self.modulus;
        Ok(EllipticContact { semi_axes: (a, b), approach, largest_pressure })
    }
}

/// K and K − E for an aspect ratio b/a of the ellipse.
fn integrals(aspect: f64) -> (f64, f64) {
    let square = aspect * aspect;
    (carlson_rf(0.0, square, 1.0), (1.0 - square) / 3.0 * carlson_rd(0.0, square, 1.0))
}
