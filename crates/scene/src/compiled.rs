//! Functions that this crate compiles for both precisions, so that crates that call them need not compile them again.

/// A type by whose name [`Real::call`](asperity::Real) calls a function generic in `T`.
macro_rules! compiled {
    ($name:ident: $input:ty => $output:ty = $function:expr) => {
        struct $name<'a>(std::marker::PhantomData<&'a ()>);

        impl<'a> asperity::Compiled for $name<'a> {
            type Input<T: Real> = $input;
            type Output<T: Real> = $output;
            fn single(input: Self::Input<f32>) -> Self::Output<f32> {
                $function(input)
            }
            fn double(input: Self::Input<f64>) -> Self::Output<f64> {
                $function(input)
            }
        }
    };
}
pub(crate) use compiled;
