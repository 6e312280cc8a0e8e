//! A force curve, and the fits of it.

use crate::tip::{Contact, Scale};

/// Parameters of a fit: the logarithm of the modulus over its scale, the root of the work of adhesion over its scale, the
/// contact point less its origin over its scale, and the logarithm of the Tabor parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// ln(E*/E₀)
    pub log_modulus: f64,
    /// p of the work of adhesion w = w₀(p² + a floor)
    pub root_work: f64,
    /// (z − z₀)/L
    pub point: f64,
    /// ln μ
    pub log_tabor: f64,
}

impl Parameters {
    pub(crate) fn to_array(self) -> [f64; 4] {
        [self.log_modulus, self.root_work, self.point, self.log_tabor]
    }

    pub(crate) fn from_array([log_modulus, root_work, point, log_tabor]: [f64; 4]) -> Self {
        Self { log_modulus, root_work, point, log_tabor }
    }
}

/// Scales of the parameters of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// contact modulus E₀
    pub modulus: f64,
    /// work of adhesion w₀
    pub work: f64,
    /// the least work over its scale
    pub floor: f64,
    /// contact point z₀
    pub point: f64,
    /// length L
    pub length: f64,
}

/// The side of a jump on which a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// on neither
    Free,
    /// before contact, or after it
    Apart,
    /// in contact
    Contact,
}

/// Where a jump was seen, and the force that weighs as much as a shift of the jump by a length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// its position
    pub place: f64,
    /// force per length; none counts it not
    pub weight: f64,
}

/// On which sides of jumps the points are, and where the jumps of approach and withdrawal were seen; no sides without any.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sides {
    /// for each point
    pub sides: Vec<Side>,
    /// on the approach and on the withdrawal
    pub seen: [Seen; 2],
}

/// A force curve, and what a fit of it has to know.
#[derive(Clone, Debug)]
pub struct Curve {
    /// positions in the order of time, greater as the bodies come closer
    pub z: Vec<f64>,
    /// forces, compression positive
    pub force: Vec<f64>,
    /// the first point of the withdrawal
    pub turn: usize,
    /// compliance of the spring
    pub compliance: f64,
    /// an orthonormal basis of the baseline, one column after the other
    pub baseline: Vec<Vec<f64>>,
    /// standard deviation of the noise
    pub noise: f64,
    /// scales of the parameters
    pub scales: Scales,
    /// the scaling of the tip
    pub scale: Scale,
    /// the greatest position
    pub farthest: f64,
    /// points of approach and withdrawal in the order of their positions
    pub order: [Vec<usize>; 2],
}

/// A fit of a model.
#[derive(Clone, Debug)]
pub struct Fit {
    /// the number of its model
    pub model: usize,
    /// its parameters
    pub parameters: Parameters,
    /// which of these vary
    pub free: [bool; 4],
    /// the sides of its points
    pub sides: Sides,
    /// the sum of the squares of its residuals
    pub squares: f64,
}

impl Curve {
    /// A curve with its points in the order of their positions.
    #[must_use]
    pub fn ordered(mut self) -> Self {
        let sorted = |range: std::ops::Range<usize>| {
            let mut order: Vec<_> = range.collect();
            order.sort_by(|&a, &b| self.z[a].total_cmp(&self.z[b]));
            order
        };
        self.order = [sorted(0..self.turn), sorted(self.turn..self.z.len())];
        self.farthest = self.z.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        self
    }

    /// The contact of parameters.
    #[must_use]
    pub fn contact(&self, parameters: &Parameters) -> Contact {
        Contact {
            modulus: self.scales.modulus.ln() + parameters.log_modulus,
            work: (self.scales.work * (parameters.root_work.powi(2) + self.scales.floor)).ln(),
            tabor: parameters.log_tabor,
        }
    }

    /// Subtracts from values what a baseline explains.
    pub(crate) fn clear(&self, values: &mut [f64]) {
        for column in &self.baseline {
            let share: f64 = column.iter().zip(&*values).map(|(a, b)| a * b).sum();
            values.iter_mut().zip(column).for_each(|(value, a)| *value -= share * a);
        }
    }
}
