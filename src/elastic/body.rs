//! Elastic bodies with properties that do not change along the surface, by the stiffness of their waves.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::grid::Grid;

mod coating;
mod half_space;
mod layer;
mod plate;
mod series;

pub use coating::Coating;
pub use half_space::HalfSpace;
pub use layer::{Base, Layer};
pub use plate::Plate;
pub use series::Series;

/// An elastic body with properties that do not change along its surface: a wave of displacement û needs a pressure k û.
///
/// [`Spectral::of`](crate::Spectral::of) makes an operator of it. [`HalfSpace`], [`Layer`], [`Coating`], [`Plate`] and
/// [`Series`], two bodies that both deform, are bodies; one of your own is its stiffness and its modulus.
///
/// ```
/// use asperity::elastic::{Base, Body, Layer, Material};
/// let rubber = Material::new(2e6, 0.5)?;
/// let layer = Layer::new(rubber, 1e-3, Base::Bonded)?;
/// // waves that are short compared with the thickness see a half-space
/// assert!((layer.stiffness(1e5, 0.0) / (0.5 * 2e6 * 1e5) - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
pub trait Body: Send + Sync {
    /// The stiffness k of a wave, pressure per displacement, with the wave numbers in radians per length: even,
    /// k(−q) = k(q), and positive; of no meaning for q = 0.
    fn stiffness(&self, qx: f64, qy: f64) -> f64;

    /// The contact modulus E* of the shortest waves, where k = ½E*q.
    fn modulus(&self) -> f64;

    /// The modulus of the shortest waves along the sides of a grid, 2k/q in the mean: the contact modulus where they are
    /// short enough for the body.
    fn modulus_on(&self, grid: &Grid) -> f64 {
        let shortest = PI / grid.largest_spacing();
        let along = |qx: f64, qy: f64| 2.0 * self.stiffness(qx * shortest, qy * shortest) / shortest;
        match grid.shape() {
            (_, 1) => along(1.0, 0.0),
            (1, _) => along(0.0, 1.0),
            _ => 0.5 * (along(1.0, 0.0) + along(0.0, 1.0)),
        }
    }

    /// The compression of the whole body under a mean pressure of one, length per pressure, held sideways; zero where
    /// it is unknown, as for a half-space. The compression changes the approach of the base, not the gap.
    fn mean_compliance(&self) -> f64 {
        0.0
    }

    /// The part of the approach of points far away that the waves of a periodic cell do not have, over the mean pressure
    /// in the cell, length per pressure, for a load on a part of the cell that is alone on the body. None if unknown,
    /// as for a body of your own. Right to the first order in the size of the contact over the size of the cell.
    fn far_compliance(&self, _grid: &Grid) -> Option<f64> {
        None
    }
}

/// How much less a half-space yields at a point load in a cell than under the load alone, over the mean pressure and
/// 1/(πE*): the sum of 1/r over the images less the mean, after Ewald; none on lines.
pub(crate) fn images(grid: &Grid) -> Option<f64> {
    let ((nx, ny), (lx, ly)) = (grid.shape(), grid.lengths());
    if nx == 1 || ny == 1 {
        return None;
    }
    let (area, split) = (lx * ly, (PI / (lx * ly)).sqrt());
    let sum = |a: f64, b: f64, of: &dyn Fn(f64) -> f64| -> f64 {
        // terms fall below the last digit at five units of the longer side
        let [m, n] = [a, b].map(|side| (5.0 * a.max(b) / side).ceil() as i32);
        let terms = (-m..=m).flat_map(|i| (-n..=n).map(move |j| (f64::from(i) * a).hypot(f64::from(j) * b)));
        terms.filter(|&r| r > 0.0).map(of).sum()
    };
    let near = sum(lx, ly, &|r| libm::erfc(split * r) / r);
    let far = sum(2.0 * PI / lx, 2.0 * PI / ly, &|q| 2.0 * PI / area * libm::erfc(0.5 * q / split) / q);
    Some(area * (2.0 * split / PI.sqrt() + 2.0 * PI.sqrt() / (area * split) - near - far))
}

impl<B: Body + ?Sized> Body for Arc<B> {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        (**self).stiffness(qx, qy)
    }

    fn modulus(&self) -> f64 {
        (**self).modulus()
    }

    fn modulus_on(&self, grid: &Grid) -> f64 {
        (**self).modulus_on(grid)
    }

    fn mean_compliance(&self) -> f64 {
        (**self).mean_compliance()
    }

    fn far_compliance(&self, grid: &Grid) -> Option<f64> {
        (**self).far_compliance(grid)
    }
}

/// An isotropic elastic material: its contact modulus and its Poisson's ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    modulus: f64,
    poisson: f64,
}

impl Material {
    /// The material of a contact modulus E* = E/(1 − ν²), a pressure, and a Poisson's ratio ν.
    ///
    /// # Errors
    /// [`Error::Value`] unless E* is positive and finite, and −1 < ν ≤ ½.
    pub fn new(modulus: f64, poisson: f64) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        if !(poisson > -1.0 && poisson <= 0.5) {
            let requirement = "greater than -1 and at most 0.5";
            return Err(Error::Value { name: "Poisson's ratio", value: poisson, requirement });
        }
        Ok(Self { modulus, poisson })
    }

    /// The material of a Young's modulus E and a Poisson's ratio ν.
    ///
    /// ```
    /// use asperity::elastic::Material;
    /// let steel = Material::of_young(210e9, 0.3)?;
    /// assert!((steel.modulus() / 230.77e9 - 1.0).abs() < 1e-5);
    /// // of two half-spaces that both deform 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂
    /// let both = 1.0 / (1.0 / steel.modulus() + 1.0 / steel.modulus());
    /// assert!((both / 115.38e9 - 1.0).abs() < 1e-4);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Value`] unless E is positive and finite, and −1 < ν ≤ ½.
    pub fn of_young(young: f64, poisson: f64) -> Result<Self> {
        Error::positive("Young's modulus", young)?;
        Self::new(young / (1.0 - poisson * poisson), poisson)
    }

    /// The contact modulus E*.
    pub fn modulus(&self) -> f64 {
        self.modulus
    }

    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// The shear modulus G = E*(1 − ν)/2.
    pub fn shear_modulus(&self) -> f64 {
        0.5 * self.modulus * (1.0 - self.poisson)
    }

    /// The modulus against compression without strain sideways, M = E*(1 − ν)²/(1 − 2ν); infinite for ν = ½.
    pub fn confined_modulus(&self) -> f64 {
        self.modulus * (1.0 - self.poisson).powi(2) / (1.0 - 2.0 * self.poisson)
    }
}
