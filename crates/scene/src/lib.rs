//! The contact problem of a run, its solve and the account of it, and the surfaces that are prepared and made, by the
//! names that the program `asperity`, the Python package and the page in the browser share.
//!
//! This crate is internal to asperity, and its interface may change in any version.

mod account;
mod clock;
mod hash;
mod key;
pub mod outcome;
pub mod processes;
mod session;
mod table;

pub use asperity_maps::numbers;

pub use account::dimensions::{dimension_of, dimension_of_key};
pub use account::entries::{GridErrors, GridLevel, Left, OtherBranch, Reached, Search, Steadiness, Step};
pub use account::findings::{Conducted, Findings};
pub use account::found::{Found, Sight, check_finite};
pub use account::leaked::{Along, Enclosed, Leaked, Narrowest, Transmissivity};
pub use account::pulled_off::PulledOff;
pub use account::row::Row;
pub use account::rows::{corrected, rows};
pub use account::sentences::shortfalls;
pub use account::slopes::Slopes;
pub use account::{Account, Inputs};
pub use account::{contact, interface, statistics};
pub use hash::Hash;
pub use key::accuracy::{AccuracyKeys, Goal, PullOffKeys};
pub use key::adhesion::{Adhesion, AdhesionKeys};
pub use key::after::{After, ConductorKeys, Conductors, FindingsKeys, LeakageKeys, PercolationKeys, StiffnessKeys};
pub use key::allowed;
pub use key::asked::{Asked, NestedKeys, PathKeys};
pub use key::body::{Body, BodyForm, FormKeys, FourierKeys, GridKeys, Roughness, RoughnessKeys};
pub use key::boundary::Boundary;
pub use key::elastic::{Elastic, LengthsKeys, SurfaceKeys};
pub use key::formula::{AnyLaw, Formula, tabulated};
pub use key::given::{Given, Measured, Quantities, Typed};
pub use key::laws::{LAWS, Law};
pub use key::leak::{LeakAsked, LeakKeys};
pub use key::load::{FractionsKeys, Load, LoadKeys, LoadsKeys};
#[cfg(feature = "options")]
pub use key::options::Chosen;
pub use key::pair::between;
pub use key::preparation::{CutOffKeys, Log, NewLengthsKeys, Preparation, StepKeys, in_unit};
pub use key::scalar::Scalar;
pub use key::scene::{Branches, Files, Precision, Scene, SolverKeys};
pub use key::symbol::{Stiffness, Symbol};
pub use key::told::Told;
pub use key::units::UnitKeys;
pub use key::wall::{Constraint, Wall};
pub use key::words::{Skin, worded};
pub use key::{Key, Keys, Kind, Lists, Values, Word, without_files};
pub use key::{list, quantity, synonyms, units};
pub use session::way::Way;
pub use session::{AnySession, Input, Next, Observe, Session, Solved, TableFile};
pub use session::{fall, pace};
pub use table::Format;
pub use table::fields::{gap_to_write, write_fields};
pub use table::identity::Identity;
pub use table::{csv, journal, legs, output, warnings};

/// Something in either precision.
pub enum Either<S, D> {
    /// In `f32`.
    F32(S),
    /// In `f64`.
    F64(D),
}

/// Does the same with something in either precision: `either!(session = problem => session.rows())`.
#[macro_export]
macro_rules! either {
    ($name:ident = $of:expr => $work:expr) => {
        match $of {
            $crate::Either::F32($name) => $work,
            $crate::Either::F64($name) => $work,
        }
    };
}
