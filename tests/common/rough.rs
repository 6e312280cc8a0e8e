//! A self-affine surface with random phases, the same on every grid that resolves it.

use std::f64::consts::TAU;

use asperity::{Grid, Surface};
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Waves of 4 to `shortest` periods per side, Hurst exponent 0.8, on a square grid; rms slope 1.
pub fn rough(grid: Grid, shortest: i32, seed: u64) -> Surface {
    let (nx, ny) = grid.shape();
    let mut spectrum = Array2::<Complex<f64>>::zeros((nx, ny));
    let mut phases = ChaCha8Rng::seed_from_u64(seed);
    let mut slope = 0.0;
    for kx in 0..=shortest {
        for ky in -shortest..=shortest {
            let phase: f64 = phases.random();
            let k = f64::from(kx).hypot(f64::from(ky));
            if !(4.0..=f64::from(shortest)).contains(&k) || (kx == 0 && ky < 0) {
                continue;
            }
            let amplitude = k.powf(-1.8);
            let index = (kx as usize, ky.rem_euclid(ny as i32) as usize);
            spectrum[index] += Complex::from_polar(amplitude, TAU * phase);
            slope += 0.5 * (TAU * k * amplitude / grid.lengths().0).powi(2);
        }
    }
    let mut planner = FftPlanner::new();
    let (along_x, along_y) = (planner.plan_fft_inverse(nx), planner.plan_fft_inverse(ny));
    for mut row in spectrum.rows_mut() {
        along_y.process(row.as_slice_mut().expect("rows are contiguous"));
    }
    let mut transposed = spectrum.reversed_axes().as_standard_layout().into_owned();
    for mut column in transposed.rows_mut() {
        along_x.process(column.as_slice_mut().expect("columns are contiguous"));
    }
    let heights = transposed.reversed_axes().mapv(|z| z.re / slope.sqrt());
    Surface::new(grid, heights).expect("a sum of waves is finite")
}
