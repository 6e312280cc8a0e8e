//! The law without a range in other shapes, and with another steepest slope.

use std::f64::consts::PI;
use std::sync::Arc;

use asperity::adhesion::Hints;
use asperity::{AdhesionLaw, Real};

/// The shape of the traction, from one in contact to zero at the range, or far beyond it.
#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    Ramp,
    HalfCosine,
    CubicStep,
    QuinticStep,
    Square,
    Exponential,
}

/// The steepest slope of the law of the library, a quintic step, times the compliance of a node.
pub const STEEPEST: f64 = 3.75 / 13.0;

impl Shape {
    pub const ALL: [Self; 6] =
        [Self::Ramp, Self::HalfCosine, Self::CubicStep, Self::QuinticStep, Self::Square, Self::Exponential];

    fn name(self) -> &'static str {
        match self {
            Self::Ramp => "ramp",
            Self::HalfCosine => "half cosine",
            Self::CubicStep => "cubic step",
            Self::QuinticStep => "quintic step",
            Self::Square => "(1 − g/ρ)²",
            Self::Exponential => "exponential",
        }
    }

    /// With a steepest slope, said of the law of the library.
    pub fn name_at(self, steepest: f64) -> String {
        let of_library =
            if self == Self::QuinticStep && steepest == STEEPEST { ", the law of the library" } else { "" };
        self.name().to_owned() + of_library
    }

    /// Some steepest slopes, and the slope of the law of the library if it has this shape.
    pub fn slopes(self, some: &[f64]) -> Vec<f64> {
        let mut slopes = some.to_vec();
        if self == Self::QuinticStep {
            slopes.push(STEEPEST);
            slopes.sort_by(f64::total_cmp);
        }
        slopes
    }

    /// The mean of the traction over the range, and its steepest slope, both over the traction in contact.
    fn mean_and_steepest(self) -> (f64, f64) {
        match self {
            Self::Ramp => (0.5, 1.0),
            Self::HalfCosine => (0.5, 0.5 * PI),
            Self::CubicStep => (0.5, 1.5),
            Self::QuinticStep => (0.5, 1.875),
            Self::Square => (1.0 / 3.0, 2.0),
            Self::Exponential => (1.0, 1.0),
        }
    }

    /// The range over √(w · compliance of a node) at a steepest slope of so much over the compliance.
    pub fn range(self, steepest: f64) -> f64 {
        let (mean, steepest_of_shape) = self.mean_and_steepest();
        (steepest_of_shape / (mean * steepest)).sqrt()
    }

    /// What is left at x = g/ρ of the energy, of the traction, and the slope of the latter.
    fn at(self, x: f64) -> [f64; 3] {
        if self == Self::Exponential {
            let left = (-x).exp();
            return [left, left, -left];
        }
        let x = x.min(1.0);
        let left = 1.0 - x;
        match self {
            Self::Ramp if x < 1.0 => [left * left, left, -1.0],
            Self::Ramp | Self::Exponential => [0.0; 3],
            Self::HalfCosine => {
                let (sine, cosine) = (PI * x).sin_cos();
                [left - sine / PI, 0.5 * (1.0 + cosine), -0.5 * PI * sine]
            }
            Self::CubicStep => [left.powi(3) * (1.0 + x), left * left * (1.0 + 2.0 * x), -6.0 * x * left],
            Self::QuinticStep => [
                left.powi(4) * (1.0 + 2.0 * x * (1.0 + x)),
                left.powi(3) * (1.0 + 3.0 * x + 6.0 * x * x),
                -30.0 * x * x * left * left,
            ],
            Self::Square => [left.powi(3), left * left, -2.0 * left],
        }
    }
}

/// A law of a work of adhesion: on each grid its traction falls no more steeply than `steepest` over the compliance of
/// a node.
#[derive(Clone, Copy)]
pub struct Short {
    pub work_of_adhesion: f64,
    pub shape: Shape,
    pub steepest: f64,
    /// The range on a grid; zero before.
    pub range: f64,
}

impl Short {
    pub fn new(work_of_adhesion: f64, shape: Shape, steepest: f64) -> Self {
        Self { work_of_adhesion, shape, steepest, range: 0.0 }
    }

    fn at(&self, gap: f64) -> [f64; 3] {
        let (mean, _) = self.shape.mean_and_steepest();
        let (w, peak) = (self.work_of_adhesion, self.work_of_adhesion / (mean * self.range));
        // without a range all of the attraction is in contact
        let [energy, traction, slope] = self.shape.at(if gap > 0.0 { gap / self.range } else { 0.0 });
        [-w * energy, peak * traction, peak / self.range * slope]
    }
}

impl<T: Real> AdhesionLaw<T> for Short {
    fn energy(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[0])
    }
    fn traction(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[1])
    }
    fn slope(&self, gap: T) -> T {
        T::lit(self.at(gap.widen())[2])
    }
    fn hints(&self) -> Hints<T> {
        let mut hints = Hints::new(T::lit(self.work_of_adhesion), T::lit(self.range)).named("short").concave();
        hints.of_grid = true;
        hints
    }
    fn on_nodes(&self, compliance: T) -> Option<Arc<dyn AdhesionLaw<T>>> {
        let unit = (self.work_of_adhesion * compliance.widen()).sqrt();
        Some(Arc::new(Self { range: self.shape.range(self.steepest) * unit, ..*self }))
    }
}
