//! The axis of a search: the load along which the wanted contact is sought.

use std::f64::consts::FRAC_PI_2;

use super::bracket::{Point, Target};
use crate::constraint::Wall;
use crate::degrees::LITTLE;
use crate::error::{Error, Result};
use crate::problem::{Control, PressedFlat};
use crate::real::Real;

#[derive(Clone, Copy, Debug)]
pub(super) enum Axis {
    /// the logarithm of the mean pressure
    Pressure { flat: f64 },
    /// minus the logarithm of the mean gap
    Gap { rms_height: f64 },
    /// the approach over the span of the heights
    Approach { span: f64 },
}

impl Axis {
    pub(super) fn of<T: Real>(flat: &PressedFlat<T>, adhesion: bool) -> Result<Self> {
        let &PressedFlat { rms_height, stiffness, height_span: span, .. } = flat;
        Error::positive("rms height of the surface", rms_height)?;
        match (adhesion, flat.boundary.is_periodic()) {
            // the waves of free heights begin and end at the edge of the window, waves of the padding do not count
            (false, _) => Ok(Self::Pressure { flat: stiffness * rms_height }),
            (true, true) if !flat.faces_all() => Err(Error::Unsuited {
                what: "contact-fraction",
                reason: "with adhesion it is searched for by the mean gap, which a periodic surface with absent nodes \
                         does not have: give a pressure",
            }),
            (true, true) => Ok(Self::Gap { rms_height }),
            (true, false) => Ok(Self::Approach { span }),
        }
    }

    /// Whether surfaces adhere, so that the search is not for a pressure.
    pub(super) fn adheres(self) -> bool {
        !matches!(self, Self::Pressure { .. })
    }

    /// Whether each solve starts anew: to so much less of the mean gap no scaled gap of surfaces that have yielded leads.
    pub(super) fn starts_anew<T: Real>(self, wall: Wall<'_, T>) -> bool {
        matches!(self, Self::Gap { .. }) && wall.hardness().is_some()
    }

    pub(super) fn control(self, x: f64) -> Control {
        match self {
            Self::Pressure { .. } => Control::MeanPressure(x.exp()),
            Self::Gap { .. } => Control::MeanGap((-x).exp()),
            Self::Approach { span } => Control::Approach(x * span),
        }
    }

    pub(super) fn first(self, fraction: f64) -> f64 {
        match self {
            // the inverse of Persson's error function, exact at small and at large loads
            Self::Pressure { flat } => {
                let depth = -(-fraction).ln_1p();
                (FRAC_PI_2.sqrt() * flat * depth / (1.0 + depth).sqrt()).ln()
            }
            // as the contact of rough surfaces falls off with the gap
            Self::Gap { rms_height } => -(-0.5 * rms_height * fraction.ln()).ln(),
            // as the contact of a paraboloid grows with the approach
            Self::Approach { .. } => fraction,
        }
    }

    /// The end of the axis, where surfaces yield.
    pub(super) fn end<T: Real>(self, target: Target, wall: Wall<'_, T>) -> f64 {
        match (self, wall.hardness()) {
            // surfaces that yield bear no more with fewer nodes in contact
            (Self::Pressure { .. }, Some(hardness)) => {
                let Target { fraction, facing, nodes } = target;
                (facing / nodes * hardness.bears(fraction.min(1.0 - facing.recip()))).ln()
            }
            // the gap is to the surface as it was made, and the contact may grow on below zero
            (Self::Gap { rms_height }, Some(_)) => -(LITTLE * rms_height).ln(),
            _ => f64::INFINITY,
        }
    }

    /// How much the level changes along the axis: as between the last two results, if credible.
    pub(super) fn slope(self, points: &[Point]) -> f64 {
        let Some(last) = points.last() else { return 1.0 };
        let usual = match self {
            Self::Pressure { .. } => 1.0,
            Self::Gap { rms_height } => (2.0 * (-last.x).exp() / rms_height).clamp(0.1, 10.0),
            Self::Approach { .. } => self.scale(last.x).recip(),
        };
        let [before, last] = points else { return usual };
        let secant = (last.level - before.level) / (last.x - before.x);
        if secant.is_finite() { secant.clamp(0.2 * usual, 5.0 * usual) } else { usual }
    }

    /// The length along the axis that is one in ln(load).
    pub(super) fn scale(self, x: f64) -> f64 {
        if let Self::Approach { .. } = self { x.abs().max(1e-3) } else { 1.0 }
    }
}
