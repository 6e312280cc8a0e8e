//! The theory of Greenwood and Williamson of rough surfaces.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::numerics::pressed;
use crate::Error;

/// The logarithms of F₃⸝₂ and F₁ of a standard normal distribution, Fₙ(x) = ∫ (s − x)ⁿ φ(s) ds from x on, at separations
/// from far to near.
static OF_NORMAL_HEIGHTS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    // with s = x + u² the integrands are smooth, and the trapezoidal rule has the integrals to rounding
    let at = |x: f64| {
        let (load, area) = (0..840).map(|k| 0.01 * f64::from(k)).fold((0.0, 0.0), |(load, area), u| {
            let weight = u.powi(3) * (-0.5 * (x + u * u).powi(2)).exp();
            (load + u * weight, area + weight)
        });
        let factor = 0.02 / (2.0 * PI).sqrt();
        ((factor * load).ln(), (factor * area).ln())
    };
    (0..=1440).map(|k| at(12.0 - 0.05 * f64::from(k))).collect()
});

/// The theory of Greenwood and Williamson of a rough surface without adhesion: spheres that do not feel each other.
///
/// An approximation for light loads: Greenwood and Williamson (1966), with the asperities of McCool (1986).
///
/// ```
/// use asperity::exact::GreenwoodWilliamson;
///
/// let theory = GreenwoodWilliamson::new(0.01, 0.1, 2.0, 1.0)?;
/// assert!(theory.contact_fraction(1e-3)? < theory.contact_fraction(2e-3)?);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct GreenwoodWilliamson {
    /// The number η of asperities per area, m₄/(6π√3 m₂).
    pub density: f64,
    /// The radius R of their curvature, 3√π/(8√m₄).
    pub radius: f64,
    /// The root mean square σ of their heights, √((1 − 0.8968/α) m₀) with Nayak's parameter α.
    pub height: f64,
    modulus: f64,
}

impl GreenwoodWilliamson {
    /// The theory of a surface by its rms height, slope and curvature.
    ///
    /// # Errors
    /// [`Error::Value`] if one of them or the modulus is not positive and finite, or Nayak's parameter is too small.
    pub fn new(rms_height: f64, rms_slope: f64, rms_curvature: f64, modulus: f64) -> crate::Result<Self> {
        let m0 = Error::positive("rms_height", rms_height)?.powi(2);
        let m2 = 0.5 * Error::positive("rms_slope", rms_slope)?.powi(2);
        let m4 = 1.5 * Error::positive("rms_curvature", rms_curvature)?.powi(2);
        let (modulus, nayak) = (Error::positive("modulus", modulus)?, m0 * m4 / (m2 * m2));
        if nayak.is_nan() || nayak <= 0.8968 {
            let name = "Nayak's parameter by rms_height, rms_slope and rms_curvature";
            let requirement = "more than 0.8968, and of a random surface it is 1.5 at least";
            return Err(Error::Value { name, value: (1e3 * nayak).round() / 1e3, requirement });
        }
        Ok(Self {
            modulus,
            density: m4 / (6.0 * PI * 3f64.sqrt() * m2),
            radius: 3.0 * (PI / m4).sqrt() / 8.0,
            height: ((1.0 - 0.8968 / nayak) * m0).sqrt(),
        })
    }

    /// The contact fraction at a mean pressure; NaN where it would be larger than one.
    ///
    /// # Errors
    /// [`Error::Value`] for a tension.
    pub fn contact_fraction(&self, mean_pressure: f64) -> crate::Result<f64> {
        let Self { modulus, density, radius, height } = *self;
        let scale = 4.0 / 3.0 * modulus * density * radius.sqrt() * height.powf(1.5);
        let load = (pressed(mean_pressure)? / scale).ln();
        let table = &*OF_NORMAL_HEIGHTS;
        let after = table.partition_point(|(entry, _)| *entry <= load);
        if after == 0 || after == table.len() {
            return Ok(if after == 0 { 0.0 } else { f64::NAN });
        }
        let ((from, here), (to, next)) = (table[after - 1], table[after]);
        let area = here + (next - here) / (to - from) * (load - from);
        let found = PI * density * radius * height * area.exp();
        Ok(if found <= 1.0 { found } else { f64::NAN })
    }
}
