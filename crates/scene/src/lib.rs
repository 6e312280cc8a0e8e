//! The contact problem of a run, its solve and the account of it, and the surfaces that are prepared and made, by the
//! names that the program `asperity`, the Python package and the page in the browser share.
//!
//! This crate is internal to asperity, and its interface may change in any version.

mod account;
mod case;
mod clock;
mod hash;
mod key;
mod outcome;
mod processes;
mod session;
mod table;

pub use asperity_maps::numbers;

pub use account::*;
pub use case::{Case, Map, Maps, Objects, Part, Posed, complete, sided};
pub use hash::Hash;
pub use key::*;
pub use outcome::Outcome;
pub use processes::{Processes, WHOLE, is_elsewhere};
pub use session::limit::{CycleLevel, CycleLimit, CycleLimits};
pub use session::way::Way;
pub use session::{AnyRows, AnySession, Facts, Next, Observe, OneGrid, Rows, Session, Solved, TableFile, Watch};
pub use session::{fall, pace};
pub use table::Format;
pub use table::fields::{gap_to_write, write_fields};
pub use table::identity::Identity;
pub use table::{csv, journal, legs, output, warnings};

/// The key of a field of an answer, as reports and tables have it; another name does not compile:
/// `row[key!(Account, mean_gap)]`.
#[macro_export]
macro_rules! key {
    ($answer:ty, $field:ident) => {{
        const _: usize = ::std::mem::offset_of!($answer, $field);
        stringify!($field)
    }};
}

/// Something in either precision.
#[derive(Clone)]
pub enum Either<S, D> {
    /// In `f32`.
    F32(S),
    /// In `f64`.
    F64(D),
}

/// Does the same with something in either precision: `either!(session = problem => session.grid())`.
#[macro_export]
macro_rules! either {
    ($name:ident = $of:expr => $work:expr) => {
        match $of {
            $crate::Either::F32($name) => $work,
            $crate::Either::F64($name) => $work,
        }
    };
}
