//! One solve, by the default and by the paper's Algorithm 3, to the same certified error.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench solve`

#[path = "../tests/common/rough.rs"]
mod rough;

use asperity::{
    AdhesionLaw, Control, Criterion as Stop, Exponential, Grid, NoAdhesion, Problem, Settings, Solver, Surface,
    Westergaard,
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn bench<L: AdhesionLaw<f64>>(criterion: &mut Criterion, name: &str, surface: &Surface, law: L, control: Control) {
    let operator = Westergaard::new(*surface.grid(), 1.0).expect("a good modulus");
    let mut problem = Problem::new(surface, operator, law).expect("a good problem");
    let paper = Settings { criterion: Stop::EnergyNorm, tolerance: 1e-6, ..Settings::rey2017() };
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10);
    for settings in [Settings::default(), paper] {
        group.bench_function(BenchmarkId::from_parameter(settings.method.name()), |b| {
            b.iter(|| Solver::new(settings).solve(&mut problem, control));
        });
    }
    group.finish();
}

fn solves(criterion: &mut Criterion) {
    let grid = Grid::square(512, 1.0).expect("a good grid");
    let sphere = Surface::paraboloid(grid, 2.0).expect("a good radius");
    bench(criterion, "Hertz 512", &sphere, NoAdhesion, Control::MeanGap(0.0398));
    let rough = rough::rough(grid, 64, 1);
    bench(criterion, "rough 512, 3 % contact", &rough, NoAdhesion, Control::MeanGap(0.0305));
    let law = Exponential::new(1e-5, 1e-3).expect("a good law");
    bench(criterion, "rough 512, exponential law", &rough, law, Control::MeanGap(0.0305));
}

criterion_group!(benches, solves);
criterion_main!(benches);
