//! Two bodies: their contact modulus.

use asperity::elastic::{Body, HalfSpace, Material, Series};
use pyo3::prelude::*;

use crate::refusal::refusal;

/// The contact modulus of one or more bodies by Young's modulus and Poisson's ratio of each.
#[pyfunction]
pub fn contact_modulus(bodies: Vec<(f64, f64)>) -> PyResult<f64> {
    let half_space = |(young, poisson)| HalfSpace::new(Material::of_young(young, poisson)?.modulus());
    let found: asperity::Result<Vec<_>> = bodies.into_iter().map(half_space).collect();
    Ok(match found.map_err(refusal)?[..] {
        [one] => one.modulus(),
        [one, other] => Series(one, other).modulus(),
        _ => f64::NAN,
    })
}
