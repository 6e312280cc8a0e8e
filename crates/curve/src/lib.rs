//! The least squares of force curves of tips: fits of modulus, work of adhesion, contact point and Tabor parameter to
//! equilibria in tables, with the jumps of the spring. Internal to the Python package, without promises.

mod jumps;
mod search;
mod squares;
mod tip;
mod ways;

pub use search::{Asked, greatest_root};
pub use squares::{Curve, Fit, Parameters, Prediction, Scales, Seen, Side, Sides};
pub use tip::{Chain, Contact, Knot, Model, Scale};
