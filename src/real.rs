//! The scalar of every field.

use std::fmt::{Debug, Display, LowerExp};

use num_traits::{Float, FromPrimitive, NumAssign, Signed};

use crate::heavy::Heavy;
use crate::ranks::Sent;

/// The scalar of every field, `f32` or `f64`, and no other type; sums over fields accumulate in `f64`.
pub trait Real:
    Float + NumAssign + FromPrimitive + Signed + Default + Debug + Display + LowerExp + Send + Sync + Sent + Heavy + 'static
{
    /// The name of the precision, as the report prints it: `"f32"` or `"f64"`.
    const NAME: &'static str;

    /// The value nearest to a literal.
    fn lit(value: f64) -> Self;

    /// The value in `f64`, exactly.
    fn widen(self) -> f64;
}

#[inline(always)]
pub(crate) fn cast<S: Real, T: Real>(value: S) -> T {
    T::lit(value.widen())
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
