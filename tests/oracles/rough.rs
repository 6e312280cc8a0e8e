//! A self-affine surface with random phases, the same on every grid that resolves it.

use asperity::{Amplitude, Grid, SelfAffine, Surface};

/// Waves of 4 to `shortest` periods per side, Hurst exponent 0.8; rms slope 1.
pub fn rough(grid: Grid, shortest: i32, seed: u64) -> Surface {
    let k_s = f64::from(shortest);
    let amplitude = Amplitude::RmsSlope(1.0);
    let surface = SelfAffine::default().k_s(k_s).amplitude(amplitude).random_phase(true).seed(seed);
    surface.surface(grid).expect("the grid resolves the waves")
}
