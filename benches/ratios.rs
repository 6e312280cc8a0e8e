//! Pairs of which the ratio matters, one after the other in one run: two threads and one, `f32` and `f64`, no adhesion and a
//! law of no energy, a line and a square of as many nodes.
//!
//! `cargo bench --bench ratios`. All but the first pair are on one thread.

mod common;

use std::time::Duration;

use asperity::{Control, Exponential, Grid, Real, Settings, Solver, Surface};
use common::{GAP, Law, Make, PRESSURE, exponential, group, none, problem, rough_square};
use criterion::{Criterion, criterion_group, criterion_main};
use rayon::{ThreadPool, ThreadPoolBuilder};

fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("so many threads")
}

fn solve<T: Real>(surface: &Surface, law: Law<T>, control: Control, settings: Settings) {
    Solver::new(settings).solve(&mut problem(surface, law), control).expect("a good problem");
}

/// A solve that has nothing but iterations.
fn some(max_iterations: usize) -> Settings {
    Settings { max_iterations, tolerance: 1e-14, ..Settings::default() }
}

fn two_threads(criterion: &mut Criterion) {
    let surface = rough_square(2048);
    let laws: [(_, Make<f64>, _); 2] = [("none", none, PRESSURE), ("exponential", exponential, GAP)];
    for (name, law, control) in laws {
        let mut group = group(criterion, &format!("threads, 4 iterations at 2048, {name}"));
        for count in [1, 2] {
            let (pool, surface) = (threads(count), &surface);
            group.bench_function(count.to_string(), |b| {
                b.iter(|| pool.install(|| solve::<f64>(surface, law(), control, some(4))));
            });
        }
        group.finish();
    }
}

fn precisions(criterion: &mut Criterion) {
    let (surface, pool) = (rough_square(1024), threads(1));
    // what f32 reaches
    let settings = Settings { tolerance: 1e-4, ..Settings::default() };
    let mut group = group(criterion, "precision, to 1e-4 at 1024");
    group.bench_function("f32", |b| b.iter(|| pool.install(|| solve::<f32>(&surface, none(), PRESSURE, settings))));
    group.bench_function("f64", |b| b.iter(|| pool.install(|| solve::<f64>(&surface, none(), PRESSURE, settings))));
    group.finish();
}

fn no_adhesion(criterion: &mut Criterion) {
    let (surface, pool) = (rough_square(1024), threads(1));
    let zero = || -> Law<f64> { Box::new(Exponential::new(0.0, 1e-3).expect("a good law")) };
    let mut group = group(criterion, "no adhesion, 8 iterations at 1024");
    group.bench_function("none", |b| b.iter(|| pool.install(|| solve(&surface, none::<f64>(), PRESSURE, some(8)))));
    group.bench_function("zero energy", |b| b.iter(|| pool.install(|| solve(&surface, zero(), PRESSURE, some(8)))));
    group.finish();
}

fn lines(criterion: &mut Criterion) {
    let pool = threads(1);
    let line = common::rough::rough(Grid::line(1 << 20, 1.0).expect("a good grid"), 64, 1);
    let square = rough_square(1 << 10);
    let mut group = group(criterion, "line and square, iteration at 2^20 nodes");
    for (name, surface) in [("line", &line), ("square", &square)] {
        group.bench_function(name, |b| {
            b.iter_custom(|times| {
                pool.install(|| {
                    let mut problem = problem::<f64>(surface, none());
                    (0..times).map(|_| common::iterations(&mut problem, GAP, 6)).sum::<Duration>() / 6
                })
            });
        });
    }
    group.finish();
}

criterion_group!(benches, two_threads, precisions, no_adhesion, lines);
criterion_main!(benches);
