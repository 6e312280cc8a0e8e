//! The adhesive sphere of Maugis (1992), exact for the law of Maugis and Dugdale.

use std::f64::consts::PI;

use super::contact::{Adhesion, Contact};
use super::numerics::{below, falls_to, peak, sin_minus_x_cos};
use super::sphere::{Family, Sphere, beyond_pull_off, hertz};
use crate::error::{Error, Result};

/// Maugis' contact: a constant traction σ₀ = w/ρ where the gap is below ρ, up to the radius c. With cos θ = a/c:
///
/// ```math
/// ρ = c²/(πR) · [½ sin 2θ − θ cos 2θ] + 4σ₀c/(πE*) · [θ sin θ − 1 + cos θ] ,
/// P = 4E*a³/(3R) − 2σ₀c² [θ + ½ sin 2θ] ,   δ = a²/R − (2σ₀/E*) √(c² − a²) .
/// ```
///
/// The first gives c for θ from 0 (large contacts) to π/2 (a point), at any Tabor parameter. Maugis (1992); equation
/// (30) of Rey, Anciaux and Molinari (2017) has the fields, but no pressure beyond a. Solutions without contact are
/// left out.
///
/// ```
/// use asperity::exact::{MaugisDugdale, Sphere};
/// let sphere = MaugisDugdale::new(2.0, 1.0, 1e-4, 2e-3)?;
/// let force = -sphere.pull_off().load() / (std::f64::consts::PI * 1e-4 * 2.0);
/// assert!(1.5 < force && force < 2.0); // between JKR and DMT
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale {
    radius: f64,
    modulus: f64,
    work_of_adhesion: f64,
    range: f64,
}

impl MaugisDugdale {
    /// A paraboloid of radius of curvature R (length) on a half-space of contact modulus E* (pressure), with work of
    /// adhesion w (energy per area) and range ρ (length).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(radius: f64, modulus: f64, work_of_adhesion: f64, range: f64) -> Result<Self> {
        Error::positive("radius of curvature", radius)?;
        Error::positive("contact modulus", modulus)?;
        Error::positive("work of adhesion", work_of_adhesion)?;
        Error::positive("range of adhesion", range)?;
        Ok(Self { radius, modulus, work_of_adhesion, range })
    }

    /// The Tabor parameter μ_T = (w²R/(E*²ρ³))^(1/3): large for JKR, small for DMT.
    pub fn tabor_parameter(&self) -> f64 {
        (self.work_of_adhesion / (self.modulus * self.range)).powf(2.0 / 3.0) * (self.radius / self.range).cbrt()
    }
}

impl Family for MaugisDugdale {
    fn body(&self) -> (f64, f64) {
        (self.radius, self.modulus)
    }

    /// The parameter is −ln tan θ.
    fn at(&self, parameter: f64, curvature: f64) -> Contact {
        let cotangent = parameter.exp();
        let theta = 1f64.atan2(cotangent);
        let (sin, cos) = (cotangent.hypot(1.0).recip(), cotangent.recip().hypot(1.0).recip());
        let stress = self.work_of_adhesion / self.range;
        let square = curvature * sin_minus_x_cos(2.0 * theta) / (2.0 * PI);
        let linear = 4.0 * stress / (PI * self.modulus) * (theta * sin - 2.0 * (0.5 * theta).sin().powi(2));
        let c = 2.0 * self.range / (linear + linear.hypot(2.0 * (square * self.range).sqrt()));
        let (a, width) = (c * cos, c * sin);
        let contact = hertz(self.modulus, curvature, a);
        Contact {
            adhesion_radius: c,
            load: contact.load - 2.0 * stress * (c * c * theta + a * width),
            approach: contact.approach - 2.0 * stress / self.modulus * width,
            second_moment: contact.second_moment
                - stress * (c.powi(4) * theta + a * width * (5.0 / 3.0 * a * a + width * width)),
            adhesion: Adhesion::Dugdale { stress, width },
            ..contact
        }
    }

    fn range(&self) -> (f64, f64) {
        // at the extremes a/√(c² − a²) goes like μ_T^(3/2) for small and μ_T^2 at most for large μ_T
        let tabor = self.tabor_parameter().ln();
        (tabor.min(0.0) * 1.5 - 10.0, tabor.max(0.0) * 2.0 + 8.0)
    }

    fn at_load_on(&self, load: f64, curvature: f64) -> Result<Contact> {
        Error::finite("load", load)?;
        let f = |s: f64| -self.at(s, curvature).load;
        let (low, high) = self.range();
        let start = peak(f, low, high);
        if -load > f(start) {
            return Err(beyond_pull_off(load));
        }
        Ok(self.at(falls_to(f, -load, start, below(f, -load, start)), curvature))
    }

    fn at_radius_on(&self, radius: f64, curvature: f64) -> Contact {
        if radius == 0.0 {
            return self.at(f64::NEG_INFINITY, curvature);
        }
        let f = |s: f64| -self.at(s, curvature).contact_radius;
        // a/c falls with a, and c does not fall below its value for a = 0
        let start = -below(|s| -f(-s), radius, 0.0);
        self.at(falls_to(f, -radius, start, below(f, -radius, start)), curvature)
    }
}

impl Sphere for MaugisDugdale {}
