//! What follows a contact of rough surfaces that was solved with [`asperity`]: what flows through the gap, and through the
//! contact.
//!
//! | item | contents |
//! |---|---|
//! | [`Gap`] | the gap at the nodes of a grid, periodic or free, with its absent nodes open or closed |
//! | [`Percolation`] | whether the gap is open from side to side, and its [`Constriction`] |
//! | [`Leakage`] | the transmissivity of the gap by Reynolds' equation, between two bounds |
//! | [`Conductance`] | of heat and electric current through the contact, from its stiffness |

mod clusters;
mod conductance;
mod elimination;
mod fields;
mod gap;
mod grid_error;
mod leakage;
mod network;
mod percolation;
mod tree;
mod trial;

pub use conductance::Conductance;
pub use gap::{Axis, Gap};
pub use leakage::{Bounds, Flow, Leak, Leakage};
pub use percolation::{Constriction, Percolation};

/// Runs the code of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
