//! The scalar of every field.

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
    fn call<F: Once>(function: F, arguments: F::Arguments<Self>) -> F::Value<Self>;
}

/// A function of the scalar that is compiled once for each precision, as `once!` makes it.
pub trait Once {
    type Arguments<T: Real>;
    type Value<T: Real>;

    fn single(arguments: Self::Arguments<f32>) -> Self::Value<f32>;
    fn double(arguments: Self::Arguments<f64>) -> Self::Value<f64>;
}

/// Functions that are compiled once for each precision, with this crate: generic functions are compiled with each crate
/// that calls them. Each calls the function next to it: one for `f32` and `f64`, or one for each; with `[within]` on one
/// of the workers, as it has many short loops.
macro_rules! once {
    ($($(#[$doc:meta])* $see:vis $name:ident<$($life:lifetime,)* T>($($arg:ident: $of:ty),* $(,)?) -> $value:ty =
        $([$within:ident])? $both:path $(, $double:path)?;)*) => {$(
        $(#[$doc])*
        $see fn $name<$($life,)* T: $crate::real::Real>($($arg: $of),*) -> $value {
            struct Function<$($life),*>($(std::marker::PhantomData<&$life ()>),*);
            impl<$($life),*> $crate::real::Once for Function<$($life),*> {
                type Arguments<T: $crate::real::Real> = ($($of,)*);
                type Value<T: $crate::real::Real> = $value;

                fn single(($($arg,)*): Self::Arguments<f32>) -> Self::Value<f32> {
                    $crate::real::once!(@ $([$within])? $both($($arg),*))
                }
                fn double(($($arg,)*): Self::Arguments<f64>) -> Self::Value<f64> {
                    $crate::real::once!(@ $([$within])? $crate::real::once!(@ $both $(, $double)?)($($arg),*))
                }
            }
            T::call(Function($(std::marker::PhantomData::<&$life ()>),*), ($($arg,)*))
        }
    )*};
    (@ [$within:ident] $call:expr) => { $crate::par::$within(|| $call) };
    (@ $first:path, $last:path) => { $last };
    (@ $call:expr) => { $call };
}
pub(crate) use once;

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
    fn call<F: Once>(_: F, arguments: F::Arguments<Self>) -> F::Value<Self> {
        F::single(arguments)
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
    fn call<F: Once>(_: F, arguments: F::Arguments<Self>) -> F::Value<Self> {
        F::double(arguments)
    }
}
