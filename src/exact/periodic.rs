//! Spheres on a periodic square: an isolated sphere, corrected for its images.

use std::f64::consts::PI;

use ndarray::Array2;

use super::contact::Contact;
use super::numerics::{falls_to, peak};
use super::sphere::Sphere;
use crate::error::{Error, Result};
use crate::grid::Grid;

/// The lattice constant M₁ = −4ζ(½)β(½): −Σ1/n over the square lattice without its origin, the mean removed.
const M1: f64 = 3.900_264_920_001_956;

/// The lattice constant c₂ = ζ(3/2)β(3/2): a quarter of the sum of 1/n³ over the square lattice without its origin.
const C2: f64 = 2.258_405_420_775_237_6;

/// A sphere among its periodic images on a square of side L, which shift and bend the surface, to the second order in
/// the distance from the axis: an exact solution on a paraboloid of radius R_e.
///
/// ```math
/// 1/R_e = 1/R + 2c₂P/(πE*L³) ,
/// ḡ = −⟨h⟩ − δ(R_e) + M₁P/(πE*L) − c₂/(πE*L³) · ∫ r² p dA
/// ```
///
/// with M₁ = 3.9003, c₂ = 2.2584, δ the approach of the sphere, and ⟨h⟩ the mean height, h = 0 at the apex: −L²/12R,
/// or [`Surface::mean`](crate::Surface::mean) of a numerical solution. The next term, of relative order (a/L)⁵ in the
/// shape of the surface, is neglected. Contacts with c ≤ L/3 are accepted.
///
/// ```
/// use asperity::exact::{Hertz, Periodic};
/// use asperity::{Grid, Surface};
/// let mean_height = Surface::paraboloid(Grid::square(512, 1.0)?, 2.0)?.mean();
/// let state = Periodic::new(Hertz::new(2.0, 1.0)?, 1.0)?.at_mean_gap(0.0398, mean_height)?;
/// assert!((state.mean_pressure() - 1.8e-4).abs() < 1e-6);
/// assert!((state.mean_gap(mean_height) - 0.0398).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodic<S> {
    sphere: S,
    length: f64,
}

impl<S: Sphere> Periodic<S> {
    /// A sphere at every point of a square lattice of period L.
    ///
    /// # Errors
    /// [`Error::Value`] if the period is not positive and finite.
    pub fn new(sphere: S, period: f64) -> Result<Self> {
        Error::positive("period", period)?;
        Ok(Self { sphere, length: period })
    }

    /// The stable contact at the load P of each sphere, compression positive.
    ///
    /// # Errors
    /// [`Error::Value`] if the load is not finite, beyond the pull-off, or too large for the approximation.
    pub fn at_load(&self, load: f64) -> Result<PeriodicContact> {
        Error::finite("load", load)?;
        let curvature = self.curvature(load);
        // the images of a large tension make the surface a hollow
        Error::positive("effective curvature under the load", curvature)?;
        self.checked("load", load, self.sphere.at_load_on(load, curvature)?)
    }

    /// The contact of radius a ≥ 0.
    ///
    /// # Errors
    /// [`Error::Value`] if the radius is negative, not finite, or too large for the approximation.
    pub fn at_contact_radius(&self, radius: f64) -> Result<PeriodicContact> {
        Error::non_negative("contact radius", radius)?;
        if radius > self.widest() {
            return Err(too_wide("contact radius", radius));
        }
        let contact = self.settle(|curvature| self.sphere.at_radius_on(radius, curvature));
        self.checked("contact radius", radius, contact)
    }

    /// The stable contact, of the larger radius, at the mean gap ḡ over heights of mean ⟨h⟩, h = 0 at the apex.
    ///
    /// # Errors
    /// [`Error::Value`] if a number is not finite, or the gap larger than in any contact or too small for the theory.
    pub fn at_mean_gap(&self, mean_gap: f64, mean_height: f64) -> Result<PeriodicContact> {
        Error::finite("mean gap", mean_gap)?;
        Error::finite("mean height", mean_height)?;
        let (low, high) = self.parameters()?;
        let f = |s: f64| self.at(s).level();
        let target = mean_gap + mean_height;
        let start = peak(f, low, high);
        if target > f(start) {
            let requirement = "no more than the mean gap at which contact is lost";
            return Err(Error::Value { name: "mean gap", value: mean_gap, requirement });
        }
        if target < f(high) {
            return Err(too_wide("mean gap", mean_gap));
        }
        self.checked("mean gap", mean_gap, self.at(falls_to(f, target, start, high)).contact)
    }

    /// The contact of least load: the pull-off force of each sphere is minus its load.
    ///
    /// # Errors
    /// [`Error::Value`] if the contact is too large for the approximation.
    pub fn pull_off(&self) -> Result<PeriodicContact> {
        let (low, high) = self.parameters()?;
        let f = |s: f64| -self.at(s).contact.load();
        let least = peak(f, low, high);
        if f(high) >= f(least) {
            return Err(too_wide("period", self.length));
        }
        self.checked("period", self.length, self.at(least).contact)
    }

    fn curvature(&self, load: f64) -> f64 {
        let (radius, modulus) = self.sphere.body();
        radius.recip() + 2.0 * C2 * load / (PI * modulus * self.length.powi(3))
    }

    fn widest(&self) -> f64 {
        self.length / 3.0
    }

    fn at(&self, parameter: f64) -> PeriodicContact {
        PeriodicContact { contact: self.settle(|curvature| self.sphere.at(parameter, curvature)), length: self.length }
    }

    /// The contact consistent with the curvature that its load adds: in each step the error falls by
    /// (8c₂/3π)(a/L)³ ≤ 0.07.
    fn settle(&self, at: impl Fn(f64) -> Contact) -> Contact {
        let mut contact = at(self.sphere.body().0.recip());
        for _ in 0..40 {
            let next = at(self.curvature(contact.load()));
            let change = (next.load() - contact.load()).abs();
            contact = next;
            if change <= 0.25 * f64::EPSILON * contact.load().abs() {
                break;
            }
        }
        contact
    }

    /// The parameters to which the approximation applies.
    fn parameters(&self) -> Result<(f64, f64)> {
        let curvature = self.sphere.body().0.recip();
        let (low, mut high) = self.sphere.range();
        let narrow = |s: f64| self.sphere.at(s, curvature).adhesion_radius() <= self.widest();
        if !narrow(low) || !self.at(low).level().is_finite() {
            return Err(too_wide("period", self.length));
        }
        while narrow(high) {
            high += 8.0;
        }
        Ok((low, falls_to(|s| if narrow(s) { 1.0 } else { -1.0 }, 0.0, low, high)))
    }

    fn checked(&self, name: &'static str, value: f64, contact: Contact) -> Result<PeriodicContact> {
        // (the images of a strong tension may leave no paraboloid)
        if contact.adhesion_radius() > self.widest() || !(contact.curvature > 0.0 && contact.load.is_finite()) {
            return Err(too_wide(name, value));
        }
        Ok(PeriodicContact { contact, length: self.length })
    }
}

fn too_wide(name: &'static str, value: f64) -> Error {
    Error::Value {
        name,
        value,
        requirement: "such that the contact, with its adhesive zone, stays within a third of the period",
    }
}

/// A contact among its periodic images, as [`Periodic`] returns it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicContact {
    contact: Contact,
    length: f64,
}

impl PeriodicContact {
    /// The contact on the paraboloid of the effective radius R_e.
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// The mean pressure p̄ = P/L².
    pub fn mean_pressure(&self) -> f64 {
        self.contact.load / (self.length * self.length)
    }

    /// The mean gap ḡ over heights of the mean ⟨h⟩, with h = 0 at the apex.
    pub fn mean_gap(&self, mean_height: f64) -> f64 {
        self.level() - mean_height
    }

    /// The pressure at the nodes of a grid of this period, the axis through its origin; on a line the profile y = 0.
    ///
    /// # Errors
    /// [`Error::Value`] if a side of the grid is not the period.
    pub fn pressure_field(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.fits(grid)?;
        Ok(self.contact.pressure_field(grid))
    }

    /// The displacement at the nodes of a grid of this period, as [`Self::pressure_field`]; u = h = 0 at the apex.
    ///
    /// It is [`Contact::deflection`] and the deflection by the images, by Ewald's sum over P and the second moment of
    /// the pressure: valid everywhere but for terms of relative order (a/L)⁴.
    ///
    /// # Errors
    /// [`Error::Value`] if a side of the grid is not the period.
    pub fn displacement_field(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.fits(grid)?;
        let Contact { modulus, load, second_moment, approach, .. } = self.contact;
        let l = self.length;
        let (order_0, order_2) = (load / (PI * modulus * l), second_moment / (4.0 * PI * modulus * l.powi(3)));
        let images = |x: f64, y: f64| {
            let (value, laplacian) = images(x / l, y / l);
            order_0 * value + order_2 * laplacian
        };
        let apex = approach + images(0.0, 0.0);
        Ok(grid.sample(|x, y| self.contact.deflection(x.hypot(y)) + images(x, y) - apex))
    }

    fn level(&self) -> f64 {
        let Contact { modulus, load, second_moment, approach, .. } = self.contact;
        let l = self.length;
        (M1 * load - C2 * second_moment / (l * l)) / (PI * modulus * l) - approach
    }

    fn fits(&self, grid: &Grid) -> Result<()> {
        let (lx, ly) = grid.lengths();
        let sides = [("side length Lx", lx), ("side length Ly", if grid.is_line() { self.length } else { ly })];
        for (name, value) in sides {
            if (value - self.length).abs() > 1e-12 * self.length {
                return Err(Error::Value { name, value, requirement: "the period of the solution" });
            }
        }
        Ok(())
    }
}

/// The sum of 1/r over the unit lattice but the origin, its mean with the origin's removed, and its Laplacian at a
/// point of the cell: Ewald's sum with α² = π, less terms below 1e-16.
fn images(x: f64, y: f64) -> (f64, f64) {
    const REACH: i32 = 3;
    let alpha = PI.sqrt();
    let (mut value, mut laplacian) = (-2.0, 0.0);
    for i in -REACH..=REACH {
        for j in -REACH..=REACH {
            let square = (x - f64::from(i)).powi(2) + (y - f64::from(j)).powi(2);
            if (i, j) == (0, 0) {
                let (v, l) = origin(square);
                value += v;
                laplacian += l;
            } else if square < 12.0 {
                let r = square.sqrt();
                let (far, near) = (libm::erfc(alpha * r), 2.0 * (-PI * square).exp());
                value += far / r;
                laplacian += far / (r * square) + near / square + 2.0 * PI * near;
            }
        }
    }
    let harmonics = |t: f64| {
        let first = (2.0 * PI * t).cos();
        let second = 2.0 * first * first - 1.0;
        [1.0, first, second, 2.0 * first * second - first]
    };
    let (cx, cy) = (harmonics(x), harmonics(y));
    for (i, cx) in cx.iter().enumerate() {
        for (j, cy) in cy.iter().enumerate() {
            let square = (i * i + j * j) as f64;
            if (1.0..12.0).contains(&square) {
                let order = square.sqrt();
                let both = if i > 0 { 2.0 } else { 1.0 } * if j > 0 { 2.0 } else { 1.0 };
                let term = both * libm::erfc(alpha * order) / order * cx * cy;
                value += term;
                laplacian -= 4.0 * PI * PI * square * term;
            }
        }
    }
    (value, laplacian)
}

/// −erf(αr)/r and its Laplacian, α² = π, from r².
fn origin(square: f64) -> (f64, f64) {
    if square > 0.1 {
        let r = square.sqrt();
        let (inner, near) = (libm::erf(PI.sqrt() * r), 2.0 * (-PI * square).exp());
        return (-inner / r, -inner / (r * square) + near / square + 2.0 * PI * near);
    }
    // −2 Σ (−z)ᵏ/(k! (2k + 1)), z = πr²
    let (mut value, mut laplacian, mut term) = (-2.0, 0.0, -2.0);
    for k in 1..=16 {
        let k = f64::from(k);
        term *= -PI / k; // of r^(2k−2)
        laplacian += 4.0 * k * k * term / (2.0 * k + 1.0);
        term *= square;
        value += term / (2.0 * k + 1.0);
    }
    (value, laplacian)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn the_images_have_the_lattice_constants_and_the_periodicity() {
        let (value, laplacian) = images(0.0, 0.0);
        assert_relative_eq!(value, -M1, max_relative = 1e-14);
        assert_relative_eq!(laplacian, 4.0 * C2, max_relative = 1e-13);
        // with 1/r of the origin restored the sum is periodic
        for y in [0.0, 0.2, 0.5] {
            let [left, right] = [-0.7, 0.3].map(|x: f64| images(x, y).0 + 1.0 / x.hypot(y));
            assert_relative_eq!(left, right, epsilon = 1e-13);
        }
        // the series at the origin meets the formula, and the Laplacian belongs to the value
        let (below, above) = (origin(0.1), origin(0.1 + 1e-15));
        assert_relative_eq!(below.0, above.0, max_relative = 1e-13);
        assert_relative_eq!(below.1, above.1, max_relative = 1e-12);
        for (x, y) in [(0.1, 0.2), (0.5, 0.5), (0.35, 0.0)] {
            let step = 1e-3;
            let around = images(x + step, y).0 + images(x - step, y).0 + images(x, y + step).0 + images(x, y - step).0;
            let (value, laplacian) = images(x, y);
            assert_relative_eq!((around - 4.0 * value) / (step * step), laplacian, max_relative = 1e-4);
        }
    }
}
