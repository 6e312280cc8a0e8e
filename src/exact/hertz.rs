//! The sphere of Hertz (1882), without adhesion.

use super::contact::Contact;
use super::sphere::{Family, Sphere, beyond_pull_off, hertz};
use crate::error::{Error, Result};

/// Hertz's contact, without adhesion; equation (22) of Rey, Anciaux and Molinari (2017) has the fields.
///
/// ```math
/// P = 4E*a³/(3R) ,   δ = a²/R
/// ```
///
/// ```
/// use asperity::exact::{Hertz, Sphere};
/// let contact = Hertz::new(2.0, 1.0)?.at_load(2e-4)?;
/// assert!((contact.contact_radius() - 0.066943).abs() < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    radius: f64,
    modulus: f64,
}

impl Hertz {
    /// A paraboloid of radius of curvature R (length) on a half-space of contact modulus E* (pressure).
    ///
    /// # Errors
    /// [`Error::Value`] if one is not positive and finite.
    pub fn new(radius: f64, modulus: f64) -> Result<Self> {
        Error::positive("radius of curvature", radius)?;
        Error::positive("contact modulus", modulus)?;
        Ok(Self { radius, modulus })
    }
}

impl Family for Hertz {
    fn body(&self) -> (f64, f64) {
        (self.radius, self.modulus)
    }
    fn at(&self, parameter: f64, curvature: f64) -> Contact {
        hertz(self.modulus, curvature, self.radius * parameter.exp())
    }
    fn range(&self) -> (f64, f64) {
        (-80.0, 5.0)
    }
    fn at_load_on(&self, load: f64, curvature: f64) -> Result<Contact> {
        Error::finite("load", load)?;
        if load < 0.0 {
            return Err(beyond_pull_off(load));
        }
        Ok(hertz(self.modulus, curvature, (0.75 * load / (self.modulus * curvature)).cbrt()))
    }
    fn at_radius_on(&self, radius: f64, curvature: f64) -> Contact {
        hertz(self.modulus, curvature, radius)
    }
}

impl Sphere for Hertz {
    fn at_approach(&self, approach: f64) -> Result<Contact> {
        Error::non_negative("approach", approach)?;
        self.at_contact_radius((approach * self.radius).sqrt())
    }
    fn pull_off(&self) -> Contact {
        hertz(self.modulus, self.radius.recip(), 0.0)
    }
}
