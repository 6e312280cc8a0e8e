//! Names of variants, as reports, options and messages have them.

/// Gives the variants of an enumeration their names, by which it is displayed.
macro_rules! names {
    ($type:ident { $($variant:ident = $name:literal),+ $(,)? }) => {
        impl $type {
            #[doc = concat!("The name in reports and options:", $(" `", $name, "`",)+ ".")]
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant { .. } => $name),+ }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use names;
