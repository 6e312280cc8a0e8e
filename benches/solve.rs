//! Solves of a rough surface by size, precision, law, control and method, to a certified error of 1e-6 (in `f32` 1e-4,
//! which it reaches on every grid), with all that it takes from the heights on; and one iteration.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench solve`. With `ASPERITY_BENCH=all` also what takes
//! longer, solves at 4096² and Algorithm 3 at 1024².

mod common;

use asperity::{Control, Nested, Real, Settings, Solver, Surface};
use common::{GAP, Law, Make, PRESSURE, exponential, group, half_space, maugis_dugdale, none, problem, rough_square};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn single<T: Real>(surface: &Surface, law: Law<T>, control: Control, settings: Settings) {
    Solver::new(settings).solve(&mut problem(surface, law), control).expect("a good problem");
}

fn nested<T: Real>(surface: &Surface, law: Law<T>, control: Control) {
    let mut solver = Solver::default();
    Nested::default().solve(&mut solver, surface, half_space::<T>, law, control).expect("a good problem");
}

fn all() -> bool {
    std::env::var_os("ASPERITY_BENCH").is_some_and(|value| value == "all")
}

fn sizes<T: Real>(criterion: &mut Criterion) {
    for name in ["default", "nested"] {
        let mut group = group(criterion, &format!("solve {name} {}", T::NAME));
        let largest = if all() { 4096 } else { 2048 };
        for n in [256, 512, 1024, 2048, 4096].into_iter().filter(|&n| n <= largest) {
            let surface = rough_square(n);
            group.bench_function(BenchmarkId::from_parameter(n), |b| match name {
                "nested" => b.iter(|| nested::<T>(&surface, none(), PRESSURE)),
                _ => b.iter(|| single::<T>(&surface, none(), PRESSURE, Settings::default())),
            });
        }
        group.finish();
    }
}

fn laws(criterion: &mut Criterion) {
    let surface = rough_square(512);
    let mut group = group(criterion, "solve 512 f64");
    let laws: [(_, Make<f64>); 3] = [("none", none), ("Maugis-Dugdale", maugis_dugdale), ("exponential", exponential)];
    for (name, law) in laws {
        for (load, control) in [("pressure", PRESSURE), ("gap", GAP)] {
            group.bench_function(BenchmarkId::new(name, load), |b| {
                b.iter(|| single(&surface, law(), control, Settings::default()));
            });
            group.bench_function(BenchmarkId::new(format!("{name} nested"), load), |b| {
                b.iter(|| nested(&surface, law(), control));
            });
        }
    }
    group.finish();
}

fn rey2017(criterion: &mut Criterion) {
    let mut group = group(criterion, "solve rey2017 f64");
    let largest = if all() { 1024 } else { 512 };
    for n in [256, 512, 1024].into_iter().filter(|&n| n <= largest) {
        let surface = rough_square(n);
        // to the same certified error
        let settings = Settings::rey2017().tolerance(1e-6);
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| single::<f64>(&surface, none(), PRESSURE, settings));
        });
    }
    group.finish();
}

fn iteration<T: Real>(criterion: &mut Criterion) {
    const COUNT: usize = 3;
    let laws: [(_, Make<T>); 2] = [("none", none), ("exponential", exponential)];
    for (name, law) in laws {
        let mut group = group(criterion, &format!("iteration {name} {}", T::NAME));
        for n in [512, 1024, 2048] {
            let mut problem = problem(&rough_square(n), law());
            group.bench_function(BenchmarkId::from_parameter(n), |b| {
                b.iter_custom(|times| {
                    (0..times).map(|_| common::iterations(&mut problem, PRESSURE, COUNT)).sum::<std::time::Duration>()
                        / COUNT as u32
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, iteration::<f32>, iteration::<f64>, sizes::<f32>, sizes::<f64>, laws, rey2017);
criterion_main!(benches);
