//! The FNV-1a hash of inputs, by which a journal knows them again.

use std::fmt;

/// A fingerprint of bytes: FNV-1a, the same on every platform and in every version.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hash(pub u64);

impl Hash {
    /// The hash of nothing.
    pub const NEW: Self = Self(0xcbf2_9ce4_8422_2325);

    /// The hash with some more bytes.
    pub fn of(self, bytes: &[u8]) -> Self {
        Self(bytes.iter().fold(self.0, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)))
    }

    /// The hash with some more numbers.
    pub fn of_numbers<'a>(self, numbers: impl IntoIterator<Item = &'a f64>) -> Self {
        numbers.into_iter().fold(self, |hash, number| hash.of(&number.to_bits().to_le_bytes()))
    }
}

impl fmt::Display for Hash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}
