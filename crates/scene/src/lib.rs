//! The contact problem of a run, its solve and the account of it, and the surfaces that are prepared and made, by the
//! names that the program `asperity` and the Python package share.
//!
//! This crate is internal to asperity, and its interface may change in any version.

mod account;
mod accuracy;
mod adhesion;
#[cfg(feature = "options")]
pub mod allowed;
mod asked;
mod body;
mod boundary;
mod compiled;
mod course;
pub mod csv;
mod displacement;
mod elastic;
mod entries;
pub mod fall;
mod fields;
mod formula;
mod found;
mod hash;
mod identity;
pub mod journal;
mod kept;
mod laws;
mod leaked;
pub mod legs;
pub mod list;
mod load;
pub mod outcome;
pub mod output;
pub mod pace;
mod pair;
mod posed;
mod preparation;
pub mod processes;
mod pulled_off;
pub mod quantity;
mod record;
mod rows;
mod scalar;
mod scene;
mod sentences;
mod symbol;
pub mod synonyms;
mod table;
mod told;
pub mod units;
mod wall;
mod warnings;
mod words;

pub use asperity_maps::numbers;

pub use account::{Account, Inputs};
pub use accuracy::Goal;
pub use adhesion::Adhesion;
pub use asked::Asked;
pub use body::{Body, BodyForm, Roughness};
pub use boundary::Boundary;
pub use course::{Course, Row, Way};
pub use elastic::Elastic;
pub use entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness, Step};
pub use fields::{gap_to_write, write_fields};
pub use formula::{AnyLaw, Formula, tabulated};
pub use found::{Found, Sight, check_finite, warnings_of};
pub use hash::Hash;
pub use identity::{Fields, Identity};
pub use laws::{LAWS, Law, PARAMETERS, Parameter};
pub use leaked::{Along, Enclosed, LeakAsked, Leaked, Narrowest, Transmissivity};
pub use load::Load;
pub use pair::between;
pub use posed::{AnyProblem, Observe, Posed};
pub use preparation::{Log, Preparation, in_unit};
pub use pulled_off::PulledOff;
pub use rows::{corrected, rows};
pub use scalar::Scalar;
pub use scene::{Branches, Precision, Scene};
pub use sentences::shortfalls;
pub use symbol::{Stiffness, Symbol};
pub use table::{Format, Opening, Table};
pub use told::Told;
pub use wall::{Constraint, Wall};
pub use warnings::warnings_of_input;
pub use words::{Skin, worded};
