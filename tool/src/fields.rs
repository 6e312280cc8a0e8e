//! The check of fields before they are written.

use asperity::Solution;
use asperity_scene::{Skin, worded};

use crate::options::Scalar;
use crate::outcome::Outcome;

/// Refuses a solution of a solve that has run away.
pub fn check_finite<T: Scalar>(solution: &Solution<T>) -> Outcome<()> {
    Ok(asperity_scene::check_finite(solution).map_err(|text| worded(&text, Skin::Options))?)
}
