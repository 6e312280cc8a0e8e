//! Lists of keys, enumerations of words, and records of values, each written once.

/// A list of keys as a type: the names with their help, and the kinds of their values, by sections.
macro_rules! keys {
    ($(#[$about:meta])* $list:ident { $($section:literal { $($(#[doc = $help:literal])+ $name:ident: $kind:expr,)+ })+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        pub struct $list;

        impl $crate::key::Keys for $list {
            const KEYS: &'static [$crate::key::Key] = &[$($($crate::key::Key {
                name: stringify!($name),
                help: concat!($($help),+),
                section: $section,
                kind: $kind,
            },)+)+];
        }
    };
}
pub(crate) use keys;

/// An enumeration of words: their names, with what each stands for. The first is the default.
macro_rules! choice {
    ($(#[$about:meta])* $name:ident { $($(#[doc = $help:literal])+ $variant:ident = $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $($(#[doc = $help])+ #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// All words.
            pub fn words() -> Vec<$crate::key::Word> {
                vec![$($crate::key::Word { name: $word, help: concat!($($help),+) }),+]
            }

            /// The word.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }
        }

        impl Default for $name {
            fn default() -> Self {
                [$(Self::$variant),+][0]
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}
pub(crate) use choice;

/// A struct of public fields, each with its value and the dimension of its number, if that has one; and the function that
/// makes it of those values.
macro_rules! record {
    (
        $(#[$about:meta])*
        $name:ident $(<$own:ident: $of:path>)? of $(<$scalar:ident $(: $bound:path)?>)? ($($given:ident: $kind:ty),* $(,)?) {
            $($(#[$meta:meta])* $key:ident: $type:ty $([$dimension:expr])? = $value:expr,)*
        }
    ) => {
        $(#[$about])*
        pub struct $name$(<$own: $of>)? {
            $($(#[$meta])* pub $key: $type,)*
        }

        impl$(<$own: $of>)? $name$(<$own>)? {
            /// The dimensions of its numbers, by the names of their fields.
            pub const DIMENSIONS: &'static [(&'static str, $crate::key::quantity::Dimension)] =
                &[$($((stringify!($key), $dimension),)?)*];

            /// The record of what is given.
            pub fn of$(<$scalar $(: $bound)?>)?($($given: $kind),*) -> Self {
                Self { $($key: $value,)* }
            }
        }
    };
}
pub(crate) use record;
