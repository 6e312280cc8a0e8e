//! The precisions of a solve.

use super::Method;
use super::driver::{Job, run};
use super::operators::{One, Two};
use super::report::Solved;
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::problem::Load;
use crate::real::Real;

/// A mean pressure below the rounding of corrections in `f32`, over the rms pressure that presses the surface flat.
const LIGHT: f64 = 1e-8;

/// Solves a problem in `f32`.
pub(crate) fn in_single(operator: &mut dyn ElasticOperator<f32>, job: Job<'_, f32>) -> Result<Solved<f32>> {
    run(&mut One(operator), job)
}

/// Solves a problem in `f64`, with corrections in `f32` where these will do.
pub(crate) fn in_double(operator: &mut dyn ElasticOperator<f64>, job: Job<'_, f64>) -> Result<Solved<f64>> {
    let spectral = operator.spectral().filter(|_| takes_coarse_corrections(&job));
    match spectral.and_then(|spectral| spectral.in_single()) {
        Some(corrections) => run(&mut Two::new(operator, corrections), job),
        None => run(&mut One(operator), job),
    }
}

/// Whether corrections in `f32` will do: they miss the first contact under a light load, and on a flat surface, where
/// every pressure is light, each step leaves more rounding than pressure. The slopes of a law that keeps the surfaces
/// apart by itself multiply their rounding.
fn takes_coarse_corrections<T: Real>(job: &Job<'_, T>) -> bool {
    let (wall, light) = (job.constraint.wall(), LIGHT * job.flat.rms_pressure());
    let is_light = |pressure: f64| light == 0.0 || pressure.abs() < light;
    let is_lightly_loaded =
        matches!(job.flat.load(job.control, wall), Ok(Load::Pressure(pressure)) if is_light(pressure));
    job.settings.method == Method::Preconditioned && !is_lightly_loaded && wall.keeps_apart()
}
