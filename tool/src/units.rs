//! The units of the numbers that a command gives.

pub use asperity_scene::dimension_of;
pub use asperity_scene::units::Units;
