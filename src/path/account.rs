//! The account of energy along a path.

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Account {
    pub(super) work: f64,
    pub(super) dissipated: f64,
    pub(super) imbalance: f64,
    /// the sum of the squares of the errors of the work of the steps
    variance: f64,
    /// the work beyond that by quadrature
    beyond: f64,
    /// the least and the largest energy
    pub(super) range: (f64, f64),
    /// the largest tension
    pub(super) tension: f64,
}

impl Account {
    /// Adds the work of a step, of which some is beyond quadrature, and its standard error.
    pub(super) fn add(&mut self, work: f64, beyond: f64, error: f64) {
        self.work += work;
        self.beyond += beyond;
        self.variance += error.powi(2);
    }

    /// The standard error of the work. The work beyond quadrature may be an error, too.
    pub(super) fn work_error(&self) -> f64 {
        self.variance.sqrt().hypot(self.beyond)
    }
}
