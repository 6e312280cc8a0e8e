//! The traits that the exact solutions for spheres share.

use super::contact::{Adhesion, Contact};
use super::numerics::{below, falls_to, peak};
use crate::error::{Error, Result};

/// A family of contacts of one paraboloid, by a parameter that grows with the contact radius.
pub trait Family {
    /// R and E*.
    fn body(&self) -> (f64, f64);

    /// The contact of a parameter, on a paraboloid of this curvature.
    fn at(&self, parameter: f64, curvature: f64) -> Contact;

    /// Parameters between which the extremes of load, approach and mean gap lie.
    fn range(&self) -> (f64, f64);

    /// The stable contact at a load.
    fn at_load_on(&self, load: f64, curvature: f64) -> Result<Contact>;

    /// The contact of a radius.
    fn at_radius_on(&self, radius: f64, curvature: f64) -> Contact;
}

/// A paraboloid of radius of curvature R against a half-space, alone: load P, contact radius a, approach δ.
///
/// With adhesion the load has a minimum, minus the pull-off force, and the approach one at a smaller radius; solutions
/// at a given load or approach are the stable ones, of the larger radius. Implemented by [`Hertz`](super::Hertz),
/// [`Jkr`](super::Jkr) and [`MaugisDugdale`](super::MaugisDugdale), and not meant to be elsewhere.
pub trait Sphere: Family {
    /// The contact of radius a ≥ 0.
    ///
    /// # Errors
    /// [`Error::Value`] if the radius is negative or not finite.
    fn at_contact_radius(&self, radius: f64) -> Result<Contact> {
        Error::non_negative("contact radius", radius)?;
        Ok(self.at_radius_on(radius, self.body().0.recip()))
    }

    /// The stable contact at the load P, compression positive.
    ///
    /// # Errors
    /// [`Error::Value`] if the load is not finite, or a tension beyond the pull-off force.
    fn at_load(&self, load: f64) -> Result<Contact> {
        self.at_load_on(load, self.body().0.recip())
    }

    /// The stable contact at the approach δ.
    ///
    /// # Errors
    /// [`Error::Value`] if the approach is not finite, or below the approach at which contact is lost.
    fn at_approach(&self, approach: f64) -> Result<Contact> {
        Error::finite("approach", approach)?;
        let curvature = self.body().0.recip();
        let (low, high) = self.range();
        let f = |s: f64| -self.at(s, curvature).approach;
        let start = peak(f, low, high);
        if -approach > f(start) {
            let requirement = "no less than the approach at which contact is lost";
            return Err(Error::Value { name: "approach", value: approach, requirement });
        }
        Ok(self.at(falls_to(f, -approach, start, below(f, -approach, start)), curvature))
    }

    /// The contact of least load, minus the pull-off force; without adhesion, no contact at no load.
    fn pull_off(&self) -> Contact {
        let curvature = self.body().0.recip();
        let (low, high) = self.range();
        self.at(peak(|s| -self.at(s, curvature).load, low, high), curvature)
    }
}

pub(super) fn beyond_pull_off(load: f64) -> Error {
    Error::Value { name: "load", value: load, requirement: "no tension beyond the pull-off force" }
}

pub(super) fn hertz(modulus: f64, curvature: f64, a: f64) -> Contact {
    let load = 4.0 / 3.0 * modulus * curvature * a.powi(3);
    Contact {
        modulus,
        curvature,
        contact_radius: a,
        adhesion_radius: a,
        load,
        approach: a * a * curvature,
        second_moment: 0.4 * a * a * load,
        adhesion: Adhesion::None,
    }
}
