//! The axisymmetric contact: pressure, displacement and gap at any radius.

use std::f64::consts::PI;

use ndarray::Array2;

use super::numerics::{carlson_rd, carlson_rf, sin_minus_x_cos};
use crate::grid::Grid;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Adhesion {
    None,
    /// A square-root singularity of the pressure, −`edge`/√(a² − r²).
    Crack {
        edge: f64,
    },
    /// A constant traction σ₀ up to the radius c; `width`, √(c² − a²), computed from c and a would lose digits.
    Dugdale {
        stress: f64,
        width: f64,
    },
}

/// The state of an axisymmetric contact, of radius a, of a paraboloid −r²/2R, its apex at r = 0, with a half-space:
///
/// ```math
/// p(r) = 2E*/(πR) · √(a² − r²) + p_adh(r) ,
/// g(r) = a/(πR) · √(r² − a²) + (r² − 2a²)/(πR) · arccos(a/r) + g_adh(r)
/// ```
///
/// for r ≤ a and r ≥ a, with JKR's singularity or Dugdale's constant traction added: equations (22), (29) with
/// K_I = √(2wE*), and (30) with p = −σ₀ for a < r < c, of Rey, Anciaux and Molinari (2017), the integral in (30) in
/// Carlson's elliptic integrals. Nothing cancels at the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    pub(super) modulus: f64,
    pub(super) curvature: f64,
    pub(super) contact_radius: f64,
    pub(super) adhesion_radius: f64,
    pub(super) load: f64,
    pub(super) approach: f64,
    pub(super) second_moment: f64,
    pub(super) adhesion: Adhesion,
}

impl Contact {
    /// The contact radius a.
    pub fn contact_radius(&self) -> f64 {
        self.contact_radius
    }

    /// The radius c ≥ a up to which adhesion acts; a itself but for [`MaugisDugdale`](super::MaugisDugdale).
    pub fn adhesion_radius(&self) -> f64 {
        self.adhesion_radius
    }

    /// The load P, the integral of the pressure: compression is positive.
    pub fn load(&self) -> f64 {
        self.load
    }

    /// The approach δ at infinity since the apex touched undeformed; negative where adhesion pulls the surface out.
    pub fn approach(&self) -> f64 {
        self.approach
    }

    /// The radius of curvature R of this solution: for a periodic contact the effective one, R_e.
    pub fn radius_of_curvature(&self) -> f64 {
        self.curvature.recip()
    }

    /// The integral of r² p over the surface.
    pub fn second_moment(&self) -> f64 {
        self.second_moment
    }

    /// The pressure, with the traction of adhesion, at r ≥ 0: JKR's falls to −∞ for r → a, and is zero from a on.
    pub fn pressure(&self, r: f64) -> f64 {
        let (a, c) = (self.contact_radius, self.adhesion_radius);
        let depth = ((a - r) * (a + r)).max(0.0).sqrt();
        let hertz = 2.0 * self.modulus * self.curvature / PI * depth;
        match self.adhesion {
            Adhesion::Crack { edge } if r < a => hertz - edge / depth,
            Adhesion::Dugdale { stress, width } if r < a => hertz - 2.0 / PI * stress * width.atan2(depth),
            Adhesion::Dugdale { stress, .. } if r < c => -stress,
            _ => hertz,
        }
    }

    /// The gap at r ≥ 0: zero for r ≤ a.
    pub fn gap(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r <= a {
            return 0.0;
        }
        let angle = ((r - a) * (r + a)).sqrt().atan2(a); // acos(a/r)
        let hertz = r * r * self.curvature / (2.0 * PI) * sin_minus_x_cos(2.0 * angle);
        hertz
            + match self.adhesion {
                Adhesion::None => 0.0,
                Adhesion::Crack { edge } => 2.0 * edge / self.modulus * angle,
                // a ring of traction outside the contact opens the gap: the difference is positive but for rounding
                Adhesion::Dugdale { stress, width } => {
                    4.0 * stress / (PI * self.modulus) * (width * angle - self.dugdale_integral(width, r)).max(0.0)
                }
            }
    }

    /// The displacement at r ≥ 0 in the datum of the surface: −r²/2R in the contact, h + g beyond, −δ at infinity.
    pub fn displacement(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r < 2.0 * a { self.gap(r) - 0.5 * r * r * self.curvature } else { self.deflection(r) - self.approach }
    }

    /// The displacement at r ≥ 0 against infinity: δ − r²/2R in the contact, P/(πE*r) far away, accurate there too.
    pub fn deflection(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r <= a {
            return self.approach - 0.5 * r * r * self.curvature;
        }
        let angle = a.atan2(((r - a) * (r + a)).sqrt()); // asin(a/r)
        let hertz = r * r * self.curvature / (2.0 * PI) * sin_minus_x_cos(2.0 * angle);
        hertz
            - match self.adhesion {
                Adhesion::None => 0.0,
                Adhesion::Crack { edge } => 2.0 * edge / self.modulus * angle,
                Adhesion::Dugdale { stress, width } => {
                    4.0 * stress / (PI * self.modulus) * (width * angle + self.dugdale_integral(width, r))
                }
            }
    }

    /// [`Contact::pressure`] at the nodes of a grid, with the axis through its origin; on a line the profile y = 0.
    pub fn pressure_field(&self, grid: &Grid) -> Array2<f64> {
        grid.sample(|x, y| self.pressure(x.hypot(y)))
    }

    /// [`Contact::displacement`] at the nodes of a grid, as [`Contact::pressure_field`].
    pub fn displacement_field(&self, grid: &Grid) -> Array2<f64> {
        grid.sample(|x, y| self.displacement(x.hypot(y)))
    }

    /// The integral I(r) in Dugdale's gap for r > a, 4σ₀/(πE*)·[√(c² − a²) acos(a/r) − I(r)].
    ///
    /// For r < c it is c·[E(k) − E(asin(a/r), k)], k = r/c; for r > c (c²/r)·∫₀^Y x² (1 + x²)^(−3/2) (κ² + x²)^(−1/2)
    /// dx, Y² = c²/a² − 1, κ² = 1 − c²/r²: equation (30) with x² = r²/t² − 1 and x² = c²/t² − 1, less the terms that
    /// cancel as a → 0. Every summand is positive.
    fn dugdale_integral(&self, width: f64, r: f64) -> f64 {
        let (a, c) = (self.contact_radius, self.adhesion_radius);
        // with x from 0 to X, z = 1/X², and m = 1/κ²
        let half = |z: f64, m: f64| m.sqrt() / 3.0 * carlson_rd(z, m + z, 1.0 + z);
        if r < c {
            let (z, m) = (a * a / ((r - a) * (r + a)), c * c / ((c - r) * (c + r)));
            c * (carlson_rf(z, 1.0 + z, m + z) / m.sqrt() + (r / c).powi(2) * half(z, m))
        } else if r > c {
            let (z, m) = ((a / width).powi(2), r * r / ((r - c) * (r + c)));
            c * c / r * half(z, m)
        } else {
            width * width / (c + a)
        }
    }
}
