//! The contact problem of a run, its solve and the account of it, by the names that the program `asperity` and the
//! Python package share.

mod account;
mod accuracy;
mod adhesion;
mod compiled;
mod course;
mod entries;
mod formula;
mod found;
mod half_space;
mod laws;
pub mod numbers;
mod posed;
pub mod quantity;
mod record;
mod settings;
mod told;
pub mod units;
mod wall;

pub use account::{Account, Inputs};
pub use accuracy::{GIB, Goal};
pub use adhesion::Adhesion;
pub use course::{Course, Row, Step, Way, is_apart};
pub use entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness};
pub use formula::{AnyLaw, Formula, tabulated};
pub use found::{Found, Sight, check_finite, warnings_of};
pub use half_space::{Boundary, HalfSpace};
pub use laws::{LAWS, Law, PARAMETERS, Parameter};
pub use posed::{AnyProblem, Asked, Observe, Posed};
pub use settings::{Branches, settings};
pub use told::Told;
pub use wall::{Constraint, Wall};
