use std::f64::consts::PI;

use super::layer::{THICK, sinh_beyond};
use super::{Body, Material, images};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// A coating of finite thickness t that is bonded to a half-space, its substrate.
///
/// With the coating 1 and the substrate 2, α = qt, θ = e^(−2α), m = G₁/G₂ the ratio of the shear moduli,
/// κ = (m − 1)/(m + 3 − 4ν₁) and λ = 1 − 4(1 − ν₁)/(1 + m(3 − 4ν₂)), in plane strain and loaded without shear,
///
/// ```math
/// 1/k = 2/(E₁* q) · (1 + 4ακθ − λκθ²) / (1 − (λ + κ + 4κα²)θ + λκθ²)
/// ```
///
/// Burmister, J. Appl. Phys. 16 (1945); O'Sullivan and King, J. Tribol. 110 (1988). Waves that are short compared with
/// the thickness have the stiffness of a half-space of the coating, long waves the stiffness of the substrate. On a
/// substrate that does not yield the coating is a bonded [`Layer`](super::Layer).
///
/// ```
/// use asperity::elastic::{Body, Coating, Material};
/// let (diamond, steel) = (Material::new(1e12, 0.1)?, Material::new(2e11, 0.3)?);
/// let coated = Coating::new(diamond, 1e-6, steel)?;
/// let over_half_space = |q: f64| coated.stiffness(q, 0.0) / (0.5 * q);
/// assert!((over_half_space(1e9) / 1e12 - 1.0).abs() < 1e-12);
/// assert!((over_half_space(1.0) / 2e11 - 1.0).abs() < 1e-4);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coating {
    material: Material,
    thickness: f64,
    /// the contact modulus of the substrate
    substrate: f64,
    /// 1 − λκ
    far: f64,
    /// (1 − κ)(1 − λ)
    thin: f64,
    /// 1 − 2κ + λκ, zero if the substrate is nothing compared with the coating
    bends: f64,
    /// 1 + 2κ + λκ, zero if the substrate is rigid and the coating incompressible
    flows: f64,
}

impl Coating {
    /// The coating of a material and a thickness, a length, on a substrate.
    ///
    /// # Errors
    /// [`Error::Value`] if the thickness is not positive and finite.
    pub fn new(material: Material, thickness: f64, substrate: Material) -> Result<Self> {
        let m = material.shear_modulus() / substrate.shear_modulus();
        let [c1, c2] = [material, substrate].map(|material| 2.0 - 4.0 * material.poisson());
        let (b1, b2) = (1.0 + c1, 1.0 + c2);
        // κ = (m − 1)/u and λ = (m b₂ − b₁)/v: the differences lose digits where m is large or small
        let (u, v) = (m + b1, 1.0 + m * b2);
        Ok(Self {
            material,
            thickness: Error::positive("thickness of the coating", thickness)?,
            substrate: substrate.modulus(),
            far: m * (1.0 + b1) * (1.0 + b2) / (u * v),
            thin: (1.0 + b1).powi(2) / (u * v),
            bends: (1.0 + b1) / u * (1.0 - (m - 1.0) / v),
            flows: ((2.0 * m + c1) * v + (m - 1.0) * (2.0 * m * b2 - c1)) / (u * v),
        })
    }
}

impl Body for Coating {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        let Self { far, thin, bends, flows, .. } = *self;
        let q = qx.hypot(qy);
        let alpha = (q * self.thickness).min(THICK);
        // numerator and denominator over θ, without the loss of digits for small α
        let (sinh, double) = (alpha.sinh(), 2.0 * alpha);
        let bent = 2.0 * (2.0 - far) * sinh_beyond(alpha) * (sinh + alpha) + 2.0 * bends * alpha * alpha;
        let stiffer = bent + thin + far * double.sinh();
        let softer = far * double.cosh() + (2.0 - far) * sinh_beyond(double) + flows * double;
        0.5 * self.material.modulus() * q * stiffer / softer
    }

    fn modulus(&self) -> f64 {
        self.material.modulus()
    }

    /// The compression of the coating, over its substrate.
    fn mean_compliance(&self) -> f64 {
        self.thickness / self.material.confined_modulus()
    }

    /// The far compliance of the substrate, and 1/k of long waves beyond it.
    fn far_compliance(&self, grid: &Grid) -> Option<f64> {
        let Self { far, thin, bends, flows, .. } = *self;
        // N and D of the formula and their derivatives by α, where α is zero
        let (above, below) = (flows - bends + 4.0 * (1.0 - far), 2.0 * (far - thin));
        let coating = 2.0 * self.thickness / self.material.modulus() * (above * thin - far * below) / (thin * thin);
        Some(images(grid)? / (PI * self.substrate) + coating)
    }
}
