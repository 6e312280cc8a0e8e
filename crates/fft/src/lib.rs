//! The one-dimensional transforms of asperity: rustfft, compiled once.
//!
//! The transforms of rustfft are generic, so the compiler makes their code in the crate that chooses them. They are
//! two thirds of the code of asperity; here they are compiled once, and not with each change and each test of it.
//!
//! This crate is internal to asperity, and its interface may change in any version.

use std::sync::Arc;

use rustfft::FftNum;
pub use rustfft::{Fft, num_complex};

/// The forward and the inverse transform of a length, both unnormalised.
#[derive(Clone)]
pub struct Transform<T> {
    /// Mode k is the sum of x_j e^(−2πijk/n).
    pub forward: Arc<dyn Fft<T>>,
    /// Node j is the sum of z_k e^(2πijk/n).
    pub inverse: Arc<dyn Fft<T>>,
}

/// The transform of a length in `f32`.
#[inline(never)]
#[must_use]
pub fn single(len: usize) -> Transform<f32> {
    transform(len)
}

/// The transform of a length in `f64`.
#[inline(never)]
#[must_use]
pub fn double(len: usize) -> Transform<f64> {
    transform(len)
}

fn transform<T: FftNum>(len: usize) -> Transform<T> {
    #[cfg(not(target_arch = "wasm32"))]
    let mut planner = rustfft::FftPlanner::new();
    // it would choose this one, and bring the portable transforms along
    #[cfg(target_arch = "wasm32")]
    let mut planner = rustfft::FftPlannerWasmSimd::new().expect("f32 and f64 have transforms in vectors");
    Transform { forward: planner.plan_fft_forward(len), inverse: planner.plan_fft_inverse(len) }
}

impl<T: FftNum> Transform<T> {
    /// The length of the scratch space that either direction needs.
    #[must_use]
    pub fn scratch_len(&self) -> usize {
        self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len())
    }
}
