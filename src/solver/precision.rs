//! The precisions of a solve.

use std::marker::PhantomData;

use super::Method;
use super::driver::{Job, run};
use super::operators::{One, Two};
use super::report::Solved;
use crate::constraint::Wall;
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::par;
use crate::problem::Load;
use crate::real::{Compiled, Real};

/// A mean pressure below the rounding of corrections in `f32`, over the rms pressure that presses the surface flat.
const LIGHT: f64 = 1e-8;

/// Solves a problem, compiled once for each precision.
pub(super) fn solve<'a, T: Real>(operator: &'a mut dyn ElasticOperator<T>, job: Job<'a, T>) -> Result<Solved<T>> {
    par::within(|| T::call::<Solve<'a>>((operator, job)))
}

struct Solve<'a>(PhantomData<&'a ()>);

impl<'a> Compiled for Solve<'a> {
    type Input<T: Real> = (&'a mut dyn ElasticOperator<T>, Job<'a, T>);
    type Output<T: Real> = Result<Solved<T>>;
    fn single((operator, job): Self::Input<f32>) -> Result<Solved<f32>> {
        run(&mut One(operator), job)
    }
    fn double((operator, job): Self::Input<f64>) -> Result<Solved<f64>> {
        let corrections =
            if takes_coarse_corrections(&job) { operator.spectral().and_then(|s| s.in_single()) } else { None };
        match corrections {
            Some(corrections) => run(&mut Two::new(operator, corrections), job),
            None => run(&mut One(operator), job),
        }
    }
}

/// Whether corrections in `f32` will do: they miss the first contact under a light load, and the slopes of a law that
/// keeps the surfaces apart by itself multiply their rounding.
fn takes_coarse_corrections<T: Real>(job: &Job<'_, T>) -> bool {
    let (flat, wall) = (job.flat, job.constraint.wall());
    let light = LIGHT * flat.stiffness * flat.rms_height;
    let is_light = matches!(flat.load(job.control, wall), Ok(Load::Pressure(pressure)) if pressure.abs() < light);
    job.settings.method == Method::Preconditioned && !is_light && !matches!(wall, Wall::None)
}
