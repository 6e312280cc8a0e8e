//! One operator application, forward and inverse transform with the product, beside a copy of the field.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench operator`

use std::hint::black_box;

use asperity::{ElasticOperator, Grid, Real, Westergaard};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ndarray::Array2;

fn application<T: Real>(criterion: &mut Criterion) {
    for n in [512, 1024, 2048] {
        let grid = Grid::square(n, 1.0).expect("a good grid");
        let mut operator = Westergaard::<T>::new(grid, 1.0).expect("a good modulus");
        let input = Array2::from_shape_fn((n, n), |(i, j)| T::lit(((i * 37 + j * 61) % 101) as f64));
        let mut output = Array2::zeros((n, n));
        let mut group = criterion.benchmark_group(format!("{} {n}", T::NAME));
        group.sample_size(20);
        // read and written
        group.throughput(Throughput::Bytes(2 * (n * n * size_of::<T>()) as u64));
        group.bench_function(BenchmarkId::from_parameter("copy"), |b| {
            b.iter(|| black_box(&mut output).assign(black_box(&input)));
        });
        group.bench_function(BenchmarkId::from_parameter("application"), |b| {
            b.iter(|| operator.pressure(black_box(input.view()), black_box(output.view_mut())));
        });
        group.finish();
    }
}

criterion_group!(benches, application::<f32>, application::<f64>);
criterion_main!(benches);
