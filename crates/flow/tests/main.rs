//! Percolation, leakage and conductance against exact solutions and dense ones.

use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

mod cells;
mod conductance;
mod leakage;
mod percolation;

/// Small gaps with closed nodes, and whether each is periodic. Their values are from 0.05 to 1, some of them equal.
fn random_gaps(seed: u64) -> impl Iterator<Item = (Array2<f64>, bool)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    std::iter::repeat_with(move || {
        let shape = (random.random_range(1..8), random.random_range(1..8));
        let closed = random.random_range(0.0..0.6);
        let steps: f64 = if random.random_bool(0.3) { 4.0 } else { 1e9 };
        let values = Array2::from_shape_simple_fn(shape, || {
            let gap: f64 = 0.05 + 0.95 * random.random_range(0.0..steps).floor() / steps;
            if random.random_bool(closed) { 0.0 } else { gap }
        });
        (values, random.random_bool(0.5))
    })
}
