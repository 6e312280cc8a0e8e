//! The least squares of force curves of tips: fits of modulus, work of adhesion, contact point and Tabor parameter to
//! equilibria in tables, with the jumps of the spring. Internal to the Python package, without promises.

mod curve;
mod jumps;
mod search;
mod squares;
mod tip;
mod ways;

pub use curve::{Curve, Fit, Parameters, Scales, Seen, Side, Sides};
pub use search::{Search, greatest_root};
pub use squares::Prediction;
pub use tip::{Chain, Contact, Knot, Model, Scale};
