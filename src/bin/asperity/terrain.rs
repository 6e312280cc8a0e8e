use std::f64::consts::TAU;

use asperity::{Grid, Surface};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// The waves of the terrain, in periods per side.
const WAVES: std::ops::RangeInclusive<f64> = 3.0..=40.0;
const HURST: f64 = 0.8;

/// A self-affine rough surface with random phases, the same every time and on every grid that resolves its waves.
pub fn rough(grid: Grid, rms_height: f64) -> asperity::Result<Surface> {
    let shortest = *WAVES.end() as i32;
    let mut random = ChaCha8Rng::seed_from_u64(2017);
    let mut power = 0.0;
    // The wave along x with kx periods has amplitudes (cosine, sine) that vary along y.
    let mut rows = vec![(0.0, 0.0); (shortest as usize + 1) * grid.shape().1];
    for (kx, row) in rows.chunks_exact_mut(grid.shape().1).enumerate() {
        for ky in -shortest..=shortest {
            let k = (kx as f64).hypot(f64::from(ky));
            if !WAVES.contains(&k) || (kx == 0 && ky < 0) {
                continue;
            }
            let (amplitude, phase) = (k.powf(-1.0 - HURST), TAU * random.random::<f64>());
            power += 0.5 * amplitude * amplitude;
            for (j, (cosine, sine)) in row.iter_mut().enumerate() {
                let (s, c) = (TAU * f64::from(ky) * j as f64 / grid.shape().1 as f64 + phase).sin_cos();
                *cosine += amplitude * c;
                *sine -= amplitude * s;
            }
        }
    }
    let scale = rms_height / power.sqrt();
    let along_x: Vec<_> = (0..grid.shape().0).map(|i| TAU * i as f64 / grid.shape().0 as f64).collect();
    let mut heights = ndarray::Array2::zeros(grid.shape());
    for (i, mut line) in heights.rows_mut().into_iter().enumerate() {
        for (kx, row) in rows.chunks_exact(grid.shape().1).enumerate() {
            let (s, c) = (kx as f64 * along_x[i]).sin_cos();
            line.iter_mut().zip(row).for_each(|(h, (cosine, sine))| *h += scale * (cosine * c + sine * s));
        }
    }
    Surface::new(grid, heights)
}
