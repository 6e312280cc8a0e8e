//! Chainable setters of the fields of settings.

/// Makes a setter of the same name for each field.
macro_rules! setters {
    ($($field:ident: $value:ty),+ $(,)?) => {$(
        #[doc = concat!("Sets `", stringify!($field), "`.")]
        #[must_use]
        pub fn $field(mut self, $field: $value) -> Self {
            self.$field = $field.into();
            self
        }
    )+};
}

pub(crate) use setters;
