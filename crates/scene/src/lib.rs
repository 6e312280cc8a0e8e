//! The contact problem of a run, its solve and the account of it, by the names that the program `asperity` and the
//! Python package share.

mod account;
mod accuracy;
mod compiled;
mod course;
pub mod csv;
mod entries;
mod fields;
mod found;
mod half_space;
mod hash;
mod identity;
pub mod journal;
mod kept;
mod law;
pub mod outcome;
pub mod output;
mod posed;
pub mod processes;
pub mod quantity;
mod record;
mod rows;
mod scalar;
mod sentences;
mod settings;
pub mod synonyms;
mod table;
mod told;
pub mod units;
mod wall;
mod warnings;
mod words;

pub use asperity_maps::numbers;

pub use account::{Account, Adhesion, Inputs};
pub use accuracy::Goal;
pub use course::{Course, Row, Step, Way};
pub use entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness};
pub use fields::{gap_to_write, write_fields};
pub use found::{Found, Sight, check_finite, warnings_of};
pub use half_space::{Boundary, HalfSpace};
pub use hash::Hash;
pub use identity::{Fields, Identity};
pub use law::tabulated;
pub use posed::{AnyProblem, Asked, Observe, Posed};
pub use rows::rows;
pub use scalar::Scalar;
pub use sentences::{check_part, shortfalls};
pub use settings::{Branches, settings};
pub use table::{Format, Opening, Table};
pub use told::Told;
pub use wall::Wall;
pub use warnings::warnings_of_input;
pub use words::{Skin, worded};
