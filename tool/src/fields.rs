//! The check of fields before they are written.

use asperity::Solution;

use crate::options::{Scalar, in_options};
use crate::outcome::Outcome;

/// Refuses a solution of a solve that has run away.
pub fn check_finite<T: Scalar>(solution: &Solution<T>) -> Outcome<()> {
    in_options(asperity_scene::check_finite(solution))
}
