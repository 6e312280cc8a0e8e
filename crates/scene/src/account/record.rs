//! Records: structs whose fields say from where they are taken.

/// A struct of public fields, each with its value and the dimension of its number, if that has one; and the function that
/// makes it of those values.
macro_rules! record {
    (
        $(#[$about:meta])*
        $name:ident of $(<$scalar:ident $(: $bound:path)?>)? ($($given:ident: $kind:ty),* $(,)?) {
            $($(#[$meta:meta])* $key:ident: $type:ty $([$dimension:expr])? = $value:expr,)*
        }
    ) => {
        $(#[$about])*
        pub struct $name {
            $($(#[$meta])* pub $key: $type,)*
        }

        impl $name {
            /// The dimensions of its numbers, by the names of their fields.
            pub const DIMENSIONS: &'static [(&'static str, $crate::key::quantity::Dimension)] =
                &[$($((stringify!($key), $dimension),)?)*];

            pub(crate) fn of$(<$scalar $(: $bound)?>)?($($given: $kind),*) -> Self {
                Self { $($key: $value,)* }
            }
        }
    };
}
pub(crate) use record;
