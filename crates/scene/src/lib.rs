//! The contact problem of a run, its solve and the account of it, and the surfaces that are prepared and made, by the
//! names that the program `asperity` and the Python package share.

mod account;
mod accuracy;
mod adhesion;
#[cfg(feature = "options")]
pub mod allowed;
mod body;
mod compiled;
mod course;
mod entries;
mod formula;
mod found;
mod half_space;
mod laws;
mod posed;
mod preparation;
pub mod quantity;
mod record;
mod rows;
mod sentences;
mod settings;
pub mod synonyms;
mod told;
pub mod units;
mod wall;
mod warnings;
mod words;

pub use asperity_maps::numbers;

pub use account::{Account, Inputs};
pub use accuracy::Goal;
pub use adhesion::Adhesion;
pub use body::{Body, BodyForm, Roughness};
pub use course::{Course, Row, Step, Way, is_apart};
pub use entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness};
pub use formula::{AnyLaw, Formula, tabulated};
pub use found::{Found, Sight, check_finite, warnings_of};
pub use half_space::{Boundary, HalfSpace};
pub use laws::{LAWS, Law, PARAMETERS, Parameter};
pub use posed::{AnyProblem, Asked, Observe, Posed};
pub use preparation::{Log, Preparation, in_unit};
pub use rows::rows;
pub use sentences::{check_part, shortfalls};
pub use settings::{Branches, settings};
pub use told::Told;
pub use wall::{Constraint, Wall};
pub use warnings::warnings_of_input;
pub use words::{Skin, worded};
