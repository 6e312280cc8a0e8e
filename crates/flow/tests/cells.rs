//! The error of the grid of leakage through random cells of two gaps, which meet at corners.

use std::f64::consts::FRAC_PI_4;

use asperity::Grid;
use asperity_flow::{Axis, Gap, Leakage};
use ndarray::Array2;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// The cells along a side.
const CELLS: usize = 8;

/// The transmissivities on so many nodes along a side, and their errors of the grid as they are told.
fn leaked(wide: &Array2<bool>, contrast: f64, nodes: usize) -> [(f64, Option<f64>); 2] {
    let values = Array2::from_shape_fn((nodes, nodes), |(i, j)| {
        if wide[[i * CELLS / nodes, j * CELLS / nodes]] { contrast } else { 1.0 }
    });
    let gap = Gap::new(values.view(), Grid::square(nodes, 1.0).unwrap()).unwrap();
    let leak = Leakage::default().tolerance(1e-7).through(&gap).unwrap();
    let errors = Leakage::default().grid_error(&gap, &leak).unwrap();
    Axis::BOTH.map(|axis| (leak.along(axis).transmissivity.upper, errors[axis as usize]))
}

/// Differences from grid to grid fall by a factor that tends to the one of corners, 2^(−2λ) with λ = 4/π atan(κ^(−1/2))
/// for conductances of a ratio κ that meet crosswise (Keller, J. Math. Phys. 5, 548, 1964), by which they are continued.
#[test]
fn the_error_of_the_grid_covers_nine_of_ten_maps_of_random_cells() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (mut told, mut covered) = (0, 0);
    for contrast in [2.0, 3.0, 5.0, 10.0, 30.0, 100.0_f64] {
        let corner = 0.25_f64.powf(contrast.powf(-1.5).atan() / FRAC_PI_4);
        for share in [0.35, 0.5, 0.5, 0.5, 0.65, 0.65, 0.65] {
            let wide = Array2::from_shape_simple_fn((CELLS, CELLS), || random.random_bool(share));
            let [coarse, half, fine, finest] = [32, 64, 128, 256].map(|nodes| leaked(&wide, contrast, nodes));
            for axis in [0, 1] {
                let (last, before) = (finest[axis].0 - fine[axis].0, fine[axis].0 - half[axis].0);
                let fall = (last / before).max(0.25).min(corner);
                let limit = finest[axis].0 + last * fall / (1.0 - fall);
                for (found, error) in [coarse[axis], half[axis]] {
                    let Some(error) = error else { continue };
                    told += 1;
                    covered += usize::from((found / limit - 1.0).abs() <= error);
                }
            }
        }
    }
    println!("{covered} of {told} errors are at most what is told");
    assert!(told > 80 && 10 * covered > 9 * told, "{covered} of {told}");
}
