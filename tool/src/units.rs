//! The units of the numbers that a command gives.

pub use asperity_scene::units::{Units, dimension_of};
