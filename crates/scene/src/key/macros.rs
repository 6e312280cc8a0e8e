//! Lists of keys, enumerations of words, and records of values, each written once.

/// A list of keys as a struct of what was given for them: the names with their help, and the kinds of their values, by
/// sections. A field whose type does not fit the kind of its values does not compile.
#[macro_export]
macro_rules! keys {
    ($(#[doc = $about:literal])+ $(#[derive($($trait:ident),+)])? $list:ident {
        $($section:literal { $($(#[doc = $help:literal])+ $name:ident: $type:ty = $kind:expr,)+ })*
    }) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug $($(, $trait)+)?)]
        pub struct $list {
            $($($(#[doc = $help])+ pub $name: $type,)+)*
        }

        impl $crate::Keys for $list {
            const ABOUT: &'static str = concat!($($about, "\n"),+);
            const KEYS: &'static [$crate::Key] = &[$($($crate::Key {
                name: $crate::Key::name_of(stringify!($name)),
                help: concat!($($help),+),
                section: $section,
                kind: {
                    let kind = $kind;
                    assert!(<$type as $crate::Readable>::FORM.is(kind.form()));
                    kind
                },
            },)+)*];

            fn read(given: &$crate::Entries) -> Self {
                Self { $($($name: given.field($crate::Key::name_of(stringify!($name))),)+)* }
            }
        }
    };
}
pub(crate) use keys;

/// How fields of types have the value that was given for their key.
macro_rules! readable {
    ($($type:ty: $form:ident = |$value:ident| $of:expr;)+) => {
        $(impl $crate::Readable for $type {
            const FORM: $crate::Form = $crate::Form::$form;

            fn read(given: &$crate::Entries, key: &str) -> Self {
                let $value = given.value(key);
                $of
            }
        })+
    };
}
pub(crate) use readable;

/// An enumeration of words: their names, with what each stands for. The first is the default.
#[macro_export]
macro_rules! choice {
    ($(#[$about:meta])* $name:ident { $($(#[doc = $help:literal])+ $variant:ident = $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $($(#[doc = $help])+ #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// All variants.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// All words.
            pub fn words() -> Vec<$crate::Word> {
                vec![$($crate::Word { name: $word, help: concat!($($help),+) }),+]
            }

            /// The word.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::ALL[0]
            }
        }

        impl $crate::Choice for $name {
            fn named(word: &str) -> Option<Self> {
                Self::ALL.iter().find(|known| known.name() == word).copied()
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

/// A struct of public fields, each with its meaning, its value, and the dimension of its number, as `[LENGTH]`, or another
/// measure, as `as Share`, if it has one; the function that makes the struct of these values, and the list of the numbers.
macro_rules! record {
    (
        $(#[$about:meta])*
        $name:ident $(<$own:ident: $of:path>)? of $(<$scalar:ident $(: $bound:path)?>)? ($($given:ident: $kind:ty),* $(,)?) {
            $($(#[doc = $help:literal])+ $(#[serde($place:ident)])? $key:ident: $type:ty $([$dimension:expr])? $(as $measure:ident)? = $value:expr,)*
        }
    ) => {
        $(#[$about])*
        pub struct $name$(<$own: $of>)? {
            $($(#[doc = $help])+ $(#[serde($place)])? pub $key: $type,)*
        }

        impl$(<$own: $of>)? $name$(<$own>)? {
            /// The numbers, in the order of a report.
            pub const NUMBERS: &'static [$crate::key::Number] = &[$($crate::key::Number {
                name: stringify!($key),
                help: concat!($($help),+),
                kind: stringify!($type),
                measure: [
                    $($crate::key::Measure::Of($dimension),)?
                    $($crate::key::Measure::$measure,)?
                    $crate::key::Measure::Plain,
                ][0],
                is_reported: $crate::key::is_reported(&[$(stringify!($place))?]),
            },)*];

            /// The record of what is given.
            pub fn record$(<$scalar $(: $bound)?>)?($($given: $kind),*) -> Self {
                Self { $($key: $value,)* }
            }
        }
    };
}
pub(crate) use record;
