//! The adhesive sphere of Johnson, Kendall and Roberts (1971).

use std::f64::consts::PI;

use super::contact::{Adhesion, Contact};
use super::sphere::{Family, Sphere, beyond_pull_off, hertz};
use crate::error::{Error, Result};

/// The contact of Johnson, Kendall and Roberts (1971): adhesion of no range, at the edge of the contact.
///
/// ```math
/// P = 4E*a³/(3R) − √(8πwE*a³) ,   δ = a²/R − √(2πwa/E*)
/// ```
///
/// Equation (29) of Rey, Anciaux and Molinari (2017), where K_I = √(2wE*) is misprinted, has the fields. The limit of
/// [`MaugisDugdale`](super::MaugisDugdale) for large Tabor parameters.
///
/// ```
/// use asperity::exact::{Jkr, Sphere};
/// let pull_off = Jkr::new(2.0, 1.0, 1e-5)?.pull_off(); // radius of curvature, contact modulus, work of adhesion
/// assert!((pull_off.load() / (-1.5 * std::f64::consts::PI * 1e-5 * 2.0) - 1.0).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jkr {
    radius: f64,
    modulus: f64,
    work_of_adhesion: f64,
}

impl Jkr {
    /// A paraboloid: radius of curvature R (length), contact modulus E* (pressure), work of adhesion w (energy/area).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(radius: f64, modulus: f64, work_of_adhesion: f64) -> Result<Self> {
        Error::positive("radius of curvature", radius)?;
        Error::positive("contact modulus", modulus)?;
        Error::positive("work of adhesion", work_of_adhesion)?;
        Ok(Self { radius, modulus, work_of_adhesion })
    }

    /// The contact radius at the pull-off, a³ = 9πwR²/8E*.
    fn pull_off_radius(&self) -> f64 {
        (1.125 * PI * self.work_of_adhesion / self.modulus * self.radius * self.radius).cbrt()
    }
}

impl Family for Jkr {
    fn body(&self) -> (f64, f64) {
        (self.radius, self.modulus)
    }
    fn at(&self, parameter: f64, curvature: f64) -> Contact {
        self.at_radius_on(self.pull_off_radius() * parameter.exp(), curvature)
    }
    fn range(&self) -> (f64, f64) {
        (-10.0, 5.0)
    }
    fn at_load_on(&self, load: f64, curvature: f64) -> Result<Contact> {
        Error::finite("load", load)?;
        let unit = 1.5 * PI * self.work_of_adhesion / curvature; // the pull-off force
        if load < -unit {
            return Err(beyond_pull_off(load));
        }
        // a³ = 3/(4E*κ)·[P + 2F + 2√(F (P + F))], F the pull-off force
        let over = load + unit;
        let cube = 0.75 / (self.modulus * curvature) * (over + unit + 2.0 * (unit * over).sqrt());
        Ok(self.at_radius_on(cube.cbrt(), curvature))
    }
    fn at_radius_on(&self, a: f64, curvature: f64) -> Contact {
        let contact = hertz(self.modulus, curvature, a);
        let edge = (2.0 * self.work_of_adhesion * self.modulus * a / PI).sqrt();
        let pull = 2.0 * PI * a * edge;
        Contact {
            load: contact.load - pull,
            approach: contact.approach - PI * edge / self.modulus,
            second_moment: contact.second_moment - 2.0 / 3.0 * a * a * pull,
            adhesion: Adhesion::Crack { edge },
            ..contact
        }
    }
}

impl Sphere for Jkr {
    fn pull_off(&self) -> Contact {
        self.at_radius_on(self.pull_off_radius(), self.radius.recip())
    }
}
