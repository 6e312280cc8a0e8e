//! The contact problem of a run: the half-space, the wall, the settings and the accuracy, by the names that the program
//! `asperity` and the Python package share.

mod accuracy;
mod half_space;
mod law;
mod settings;
mod wall;

pub use accuracy::{GIB, Goal, planned};
pub use half_space::{Boundary, HalfSpace};
pub use law::tabulated;
pub use settings::{Branches, settings};
pub use wall::Wall;
