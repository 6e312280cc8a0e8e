//! The check of fields before they are written.

use asperity::Solution;

use crate::options::Scalar;
use crate::outcome::Outcome;
use crate::printing::in_options;

/// Refuses a solution of a solve that has run away.
pub fn check_finite<T: Scalar>(solution: &Solution<T>) -> Outcome<()> {
    in_options(asperity_scene::check_finite(solution))
}
