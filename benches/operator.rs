//! One operator application, forward and inverse transform with the product, compared with a copy of the field.
//!
//! `RAYON_NUM_THREADS=1 cargo bench --bench operator`

use std::hint::black_box;
use std::time::Duration;

use asperity::{ElasticOperator, Grid, Real, Westergaard};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use ndarray::Array2;

fn operator<T: Real>(criterion: &mut Criterion) {
    for name in ["copy", "application"] {
        let mut group = criterion.benchmark_group(format!("{name} {}", T::NAME));
        group.sample_size(10).sampling_mode(SamplingMode::Flat);
        group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
        for n in [512, 1024, 2048, 4096] {
            let grid = Grid::square(n, 1.0).expect("a good grid");
            let mut operator = Westergaard::<T>::new(grid, 1.0).expect("a good modulus");
            let input = Array2::from_shape_fn((n, n), |(i, j)| T::lit(((i * 37 + j * 61) % 101) as f64));
            let mut output = Array2::zeros((n, n));
            // read and written
            group.throughput(Throughput::Bytes(2 * (n * n * size_of::<T>()) as u64));
            group.bench_function(BenchmarkId::from_parameter(n), |b| match name {
                "copy" => b.iter(|| black_box(&mut output).assign(black_box(&input))),
                _ => b.iter(|| operator.pressure(black_box(input.view()), black_box(output.view_mut()))),
            });
        }
        group.finish();
    }
}

criterion_group!(benches, operator::<f32>, operator::<f64>);
criterion_main!(benches);
