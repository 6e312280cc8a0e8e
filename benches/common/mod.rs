//! The cases that the benches solve.
#![allow(dead_code, reason = "each bench uses its part")]

use std::time::{Duration, Instant};

use asperity::{
    AdhesionLaw, Control, Exponential, Grid, MaugisDugdale, NoAdhesion, Problem, Real, Settings, Solver, Surface,
    Westergaard,
};
use criterion::{BenchmarkGroup, Criterion, SamplingMode, measurement::WallTime};

/// Laws by virtual calls, which cost nothing for a run of nodes, so that each precision is compiled once.
pub type Law<T> = Box<dyn AdhesionLaw<T>>;

/// A law, made anew for every solve.
pub type Make<T> = fn() -> Law<T>;

/// About 3 % contact without adhesion.
pub const PRESSURE: Control = Control::MeanPressure(0.0132);
/// About the same.
pub const GAP: Control = Control::MeanGap(0.022);

pub fn none<T: Real>() -> Law<T> {
    Box::new(NoAdhesion)
}

pub fn maugis_dugdale<T: Real>() -> Law<T> {
    Box::new(MaugisDugdale::new(1.42e-4, 2.9e-3).expect("a good law"))
}

pub fn exponential<T: Real>() -> Law<T> {
    Box::new(Exponential::new(1.42e-4, 2.9e-3).expect("a good law"))
}

pub fn half_space<T: Real>(grid: Grid) -> asperity::Result<Westergaard<T>> {
    Westergaard::new(grid, 1.0)
}

/// A square with waves of 4 to 64 periods, rms slope 1.
pub fn rough_square(n: usize) -> Surface {
    oracles::rough::rough(Grid::square(n, 1.0).expect("a good grid"), 64, 1)
}

pub fn problem<T: Real>(surface: &Surface, law: Law<T>) -> Problem<T> {
    let operator = half_space(*surface.grid()).expect("a good modulus");
    Problem::new(surface, operator, law).expect("a good problem")
}

/// Few samples of one run each where a run is long.
pub fn group<'a>(criterion: &'a mut Criterion, name: &str) -> BenchmarkGroup<'a, WallTime> {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(500));
    group
}

/// The time of so many iterations: the time of a solve, less the time of a solve without its first iterations.
pub fn iterations<T: Real>(problem: &mut Problem<T>, control: Control, count: usize) -> Duration {
    let mut time = |max_iterations| {
        let settings = Settings::default().max_iterations(max_iterations).tolerance(1e-14);
        let clock = Instant::now();
        let solution = Solver::new(settings).solve(problem, control).expect("a good problem");
        let elapsed = clock.elapsed();
        assert_eq!(solution.report.iterations, max_iterations);
        elapsed
    };
    let short = time(1);
    time(1 + count).saturating_sub(short)
}
