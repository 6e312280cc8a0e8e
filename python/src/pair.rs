//! Two bodies: the surface between them, and their contact modulus.

use asperity::elastic::{Body, HalfSpace, Material, Series};
use asperity_maps::Topography;
use asperity_scene::Boundary;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;

use crate::inputs::surface;
use crate::pools::Pool;
use crate::refusal::{reason, refusal};
use crate::surface::Given;

/// The heights between a map and another one that faces it, NaN where one of them has none.
#[pyfunction]
pub fn between<'py>(
    py: Python<'py>,
    first: Given<'py>,
    second: Given<'py>,
    shift: (f64, f64),
    boundary: &str,
    absent_missing: bool,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let boundary = if boundary == "free" { Boundary::Free } else { Boundary::Periodic };
    let (first, second) = (first.topography()?, second.topography()?);
    let Topography { heights, lengths, unit, original, .. } = first;
    let (pool, first) = (Pool::of(None)?, surface(heights, lengths.unwrap_or((1.0, 1.0)), absent_missing)?);
    let both =
        || asperity_scene::between((&first, unit.as_deref(), original), second, shift, (boundary, absent_missing));
    let found = pool.install(py, both).map_err(reason)?;
    Ok(Topography::from(found).heights.into_pyarray(py))
}

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
