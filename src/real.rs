//! The scalar of every field, and functions that are compiled once for each of the two.

use std::fmt::{Debug, Display, LowerExp};

use num_traits::{Float, FromPrimitive, NumAssign, Signed};

use crate::ranks::Sent;

/// The scalar of every field, `f32` or `f64`, and no other type; sums over fields accumulate in `f64`.
pub trait Real:
    Float + NumAssign + FromPrimitive + Signed + Default + Debug + Display + LowerExp + Send + Sync + Sent + 'static
{
    /// The name of the precision, as the report prints it: `"f32"` or `"f64"`.
    const NAME: &'static str;

    /// The value nearest to a literal.
    fn lit(value: f64) -> Self;

    /// The value in `f64`, exactly.
    fn widen(self) -> f64;

    /// Calls the function of this precision.
    #[doc(hidden)]
    fn call<F: Compiled>(input: F::Input<Self>) -> F::Output<Self>;
}

#[inline(always)]
pub(crate) fn cast<S: Real, T: Real>(value: S) -> T {
    T::lit(value.widen())
}

/// A function of either precision that is compiled with this crate, and not again with each crate that calls it.
pub trait Compiled {
    /// The argument of the function.
    type Input<T: Real>;
    /// The value of the function.
    type Output<T: Real>;
    /// The function in `f32`.
    fn single(input: Self::Input<f32>) -> Self::Output<f32>;
    /// The function in `f64`.
    fn double(input: Self::Input<f64>) -> Self::Output<f64>;
}

/// Declares a function that calls a generic one of the same arguments as it is [compiled](Compiled) with this crate.
macro_rules! compiled {
    ($(#[$doc:meta])* $see:vis fn $name:ident<$($a:lifetime,)* T>($($arg:ident: $of:ty),*) -> $value:ty = $generic:path) => {
        $(#[$doc])*
        $see fn $name<$($a,)* T: $crate::real::Real>($($arg: $of),*) -> $value {
            struct Call<$($a),*>($(std::marker::PhantomData<&$a ()>),*);
            impl<$($a),*> $crate::real::Compiled for Call<$($a),*> {
                type Input<T: $crate::real::Real> = ($($of,)*);
                type Output<T: $crate::real::Real> = $value;
                fn single(($($arg,)*): Self::Input<f32>) -> Self::Output<f32> {
                    $generic($($arg),*)
                }
                fn double(($($arg,)*): Self::Input<f64>) -> Self::Output<f64> {
                    $generic($($arg),*)
                }
            }
            T::call::<Call<$($a),*>>(($($arg,)*))
        }
    };
}
pub(crate) use compiled;

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
    fn call<F: Compiled>(input: F::Input<Self>) -> F::Output<Self> {
        F::single(input)
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
    fn call<F: Compiled>(input: F::Input<Self>) -> F::Output<Self> {
        F::double(input)
    }
}
