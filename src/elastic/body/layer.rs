use super::{Body, Material};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// A layer of finite thickness t on a rigid base.
///
/// With α = qt, in plane strain and loaded without shear,
///
/// ```math
/// bonded:    k = ½ E* q · ((3 − 4ν) cosh 2α + 2α² + 5 − 12ν + 8ν²) / ((3 − 4ν) sinh 2α − 2α)
/// sliding:   k = ½ E* q · (sinh 2α + 2α) / (2 sinh² α)
/// ```
///
/// Bentall and Johnson, Int. J. Mech. Sci. 10 (1968); Johnson, *Contact Mechanics* (1985), section 5.8. A thick layer
/// is the half-space. A thin one is a foundation of springs: of stiffness M/t if it is bonded and E*/t if it slides,
/// with M the [confined modulus](Material::confined_modulus). If it is bonded and incompressible, the material flows
/// sideways, k = ¾E*/(q²t³).
///
/// ```
/// use asperity::elastic::{Base, Body, Layer, Material};
/// let layer = Layer::new(Material::new(2.0, 0.3)?, 0.01, Base::Sliding)?;
/// assert!((layer.stiffness(1e-3, 0.0) - 2.0 / 0.01).abs() < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    material: Material,
    thickness: f64,
    base: Base,
}

/// The hold of a rigid base on a layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Base {
    /// The layer does not move on its base.
    #[default]
    Bonded,
    /// The layer slides on its base without friction, and does not lift off.
    Sliding,
}

/// The α beyond which the stiffness equals the half-space's to the last digit.
pub(super) const THICK: f64 = 25.0;

impl Layer {
    /// The layer of a material and a thickness, a length.
    ///
    /// # Errors
    /// [`Error::Value`] if the thickness is not positive and finite.
    pub fn new(material: Material, thickness: f64, base: Base) -> Result<Self> {
        Ok(Self { material, thickness: Error::positive("thickness of the layer", thickness)?, base })
    }
}

impl Body for Layer {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        let (q, nu) = (qx.hypot(qy), self.material.poisson());
        let alpha = (q * self.thickness).min(THICK);
        let over_half_space = match self.base {
            Base::Bonded => {
                let (a, b) = (3.0 - 4.0 * nu, 5.0 - 12.0 * nu + 8.0 * nu * nu);
                let above = a * (2.0 * alpha).cosh() + 2.0 * alpha * alpha + b;
                above / ((2.0 - 4.0 * nu) * (2.0 * alpha).sinh() + sinh_beyond(2.0 * alpha))
            }
            Base::Sliding => ((2.0 * alpha).sinh() + 2.0 * alpha) / (2.0 * alpha.sinh().powi(2)),
        };
        0.5 * self.material.modulus() * q * over_half_space
    }

    fn modulus(&self) -> f64 {
        self.material.modulus()
    }

    fn mean_compliance(&self) -> f64 {
        self.thickness / self.material.confined_modulus()
    }

    /// 1/k of long waves: beside a load the layer is free sideways only where it slides.
    fn far_compliance(&self, _grid: &Grid) -> Option<f64> {
        Some(match self.base {
            Base::Bonded => self.mean_compliance(),
            Base::Sliding => self.thickness / self.material.modulus(),
        })
    }
}

/// sinh x − x, without the loss of digits for small x.
pub(super) fn sinh_beyond(x: f64) -> f64 {
    if x > 1.0 {
        return x.sinh() - x;
    }
    let square = x * x;
    let series = [342.0, 272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0, 6.0];
    x * series.iter().fold(0.0, |sum, product| square / product * (1.0 + sum))
}
