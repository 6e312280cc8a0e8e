use std::fmt::{Display, LowerExp};

use num_traits::{Float, NumAssign};
use rustfft::FftNum;

/// The scalar of every field: `f32` or `f64`.
///
/// One trait gathers what the transforms and the field arithmetic need; sums over fields accumulate in
/// `f64` whichever it is.
///
/// ```
/// use asperity::Real;
/// fn half<T: Real>(x: T) -> T { x * T::lit(0.5) }
/// assert_eq!(half(3.0_f32), 1.5);
/// assert_eq!(half(3.0_f64).widen(), 1.5);
/// ```
pub trait Real: FftNum + Float + NumAssign + Default + Display + LowerExp {
    /// The name of the precision, as the report prints it: `"f32"` or `"f64"`.
    const NAME: &'static str;

    /// The value nearest to a literal.
    fn lit(value: f64) -> Self;

    /// The value in `f64`, exactly.
    fn widen(self) -> f64;
}

impl Real for f32 {
    const NAME: &'static str = "f32";
    #[inline]
    fn lit(value: f64) -> Self {
        value as f32
    }
    #[inline]
    fn widen(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    const NAME: &'static str = "f64";
    #[inline]
    fn lit(value: f64) -> Self {
        value
    }
    #[inline]
    fn widen(self) -> f64 {
        self
    }
}
