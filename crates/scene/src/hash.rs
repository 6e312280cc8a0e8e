//! The hash of inputs, by which a journal knows them again.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A fingerprint of bytes, which is FNV-1a, or of numbers: the same on every platform and in every version.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hash(pub u64);

impl Hash {
    /// The hash of nothing.
    pub const NEW: Self = Self(0xcbf2_9ce4_8422_2325);

    /// The hash with some more bytes.
    pub fn extend(self, bytes: &[u8]) -> Self {
        Self(bytes.iter().fold(self.0, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)))
    }

    /// The hash with some more numbers, each at once: they are many.
    pub fn of_numbers<'a>(self, numbers: impl IntoIterator<Item = &'a f64>) -> Self {
        Self(numbers.into_iter().fold(self.0, |hash, number| {
            let product = (hash ^ number.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            // the product takes the bits only upwards
            product ^ (product >> 32)
        }))
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
