use super::{Body, HalfSpace};
use crate::error::{Error, Result};

/// A plate in bending on a half-space, which it holds down and never slides on with friction.
///
/// The plate has no thickness but a bending stiffness D = E t³/(12 (1 − ν²)), and bends with the surface of the
/// half-space, k = ½E*q + D q⁴: a floor on its ground, a sheet of a crystal on a polymer. Waves that are short compared
/// with the length (2D/E*)^(1/3) bend the plate, long ones press the half-space. Hetényi, *Beams on Elastic Foundation*
/// (1946); Selvadurai, *Elastic Analysis of Soil-Foundation Interaction* (1979).
///
/// ```
/// use asperity::elastic::{Body, HalfSpace, Plate};
/// let sheet = Plate::new(2.0, HalfSpace::new(6.0)?)?;
/// assert_eq!(sheet.stiffness(0.6, 0.8), 3.0 + 2.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    bending_stiffness: f64,
    substrate: HalfSpace,
}

impl Plate {
    /// The plate of a bending stiffness D, a force times a length, on a substrate.
    ///
    /// # Errors
    /// [`Error::Value`] if the bending stiffness is not positive and finite.
    pub fn new(bending_stiffness: f64, substrate: HalfSpace) -> Result<Self> {
        Ok(Self { bending_stiffness: Error::positive("bending stiffness", bending_stiffness)?, substrate })
    }
}

impl Body for Plate {
    fn stiffness(&self, qx: f64, qy: f64) -> f64 {
        let square = qx * qx + qy * qy;
        self.substrate.stiffness(qx, qy) + self.bending_stiffness * square * square
    }

    /// Unknown, as the shorter a wave, the stiffer it is.
    fn modulus(&self) -> f64 {
        f64::NAN
    }
}
