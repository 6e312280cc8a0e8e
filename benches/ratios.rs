//! Ratios of times, measured one after the other in one run: two threads and one, `f32` and `f64`, no adhesion
//! and laws of no energy and of hardly any range, lines, narrow grids and a square of as many nodes.
//!
//! `cargo bench --bench ratios`. All but the first pair are on one thread.

mod common;

use std::f64::consts::TAU;
use std::time::Duration;

use asperity::{Control, Exponential, Grid, Real, Settings, Solver, Surface};
use common::{GAP, Law, Make, PRESSURE, exponential, group, none, problem, rough_square};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Array2;
use rayon::{ThreadPool, ThreadPoolBuilder};

fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("so many threads")
}

fn solve<T: Real>(surface: &Surface, law: Law<T>, control: Control, settings: Settings) {
    Solver::new(settings).solve(&mut problem(surface, law), control).expect("a good problem");
}

/// A solve that has nothing but iterations.
fn some(max_iterations: usize) -> Settings {
    Settings::default().max_iterations(max_iterations).tolerance(1e-14)
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
    let settings = Settings::default().tolerance(1e-4);
    let mut group = group(criterion, "precision, to 1e-4 at 1024");
    group.bench_function("f32", |b| b.iter(|| pool.install(|| solve::<f32>(&surface, none(), PRESSURE, settings))));
    group.bench_function("f64", |b| b.iter(|| pool.install(|| solve::<f64>(&surface, none(), PRESSURE, settings))));
    group.finish();
}

fn adhesion(criterion: &mut Criterion) {
    let (surface, pool) = (rough_square(1024), threads(1));
    let law = |w, range| -> Law<f64> { Box::new(Exponential::new(w, range).expect("a good law")) };
    let laws: [(_, &(dyn Fn() -> Law<f64> + Sync)); 5] = [
        ("none", &none),
        ("no energy", &|| law(0.0, 1e-3)),
        // traction 1e-6 in contact, and none elsewhere
        ("hardly any range", &|| law(1e-24, 1e-18)),
        ("exponential", &exponential),
        ("Maugis-Dugdale", &common::maugis_dugdale),
    ];
    let mut group = group(criterion, "adhesion, iteration at 1024");
    for (name, law) in laws {
        group.bench_function(name, |b| {
            b.iter_custom(|times| {
                pool.install(|| {
                    let mut problem = problem(&surface, law());
                    (0..times).map(|_| common::iterations(&mut problem, GAP, 6)).sum::<Duration>() / 6
                })
            });
        });
    }
    group.finish();
}

/// A surface that is rough along its longer side, and hardly across.
fn shaped((nx, ny): (usize, usize)) -> Surface {
    let (long, short) = (nx.max(ny), nx.min(ny));
    if long == short {
        return rough_square(long);
    }
    let line = oracles::rough::rough(Grid::line(long, 1.0).expect("a good grid"), 64, 1);
    let side = |n: usize| n as f64 / long as f64;
    let grid = Grid::new((nx, ny), (side(nx), side(ny))).expect("a good grid");
    let heights = Array2::from_shape_fn((nx, ny), |(i, j)| {
        let (along, across) = if nx == long { (i, j) } else { (j, i) };
        line.heights()[[along, 0]] + 1e-5 * (TAU * across as f64 / short as f64).cos()
    });
    Surface::new(grid, heights).expect("good heights")
}

fn shapes(criterion: &mut Criterion) {
    let pool = threads(1);
    for precision in ["f64", "f32"] {
        let mut group = group(criterion, &format!("shape, iteration at 2^20 nodes, {precision}"));
        for shape in [(1 << 10, 1 << 10), (1 << 20, 1), (1, 1 << 20), (1 << 18, 4), (4, 1 << 18)] {
            let surface = shaped(shape);
            let time = |times: u64| match precision {
                "f64" => many::<f64>(&surface, times),
                _ => many::<f32>(&surface, times),
            };
            group.bench_function(format!("{} x {}", shape.0, shape.1), |b| {
                b.iter_custom(|times| pool.install(|| time(times)));
            });
        }
        group.finish();
    }
}

fn many<T: Real>(surface: &Surface, times: u64) -> Duration {
    let mut problem = problem::<T>(surface, none());
    (0..times).map(|_| common::iterations(&mut problem, GAP, 6)).sum::<Duration>() / 6
}

criterion_group!(benches, two_threads, precisions, adhesion, shapes);
criterion_main!(benches);
