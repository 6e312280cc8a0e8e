//! Random numbers, drawn one after the other by SplitMix64.

/// The state of the numbers.
pub struct Draw(pub u64);

impl Draw {
    /// A number from zero to one.
    pub fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number between two others.
    pub fn between(&mut self, (low, high): (f64, f64)) -> f64 {
        low + (high - low) * self.share()
    }

    /// A number with a uniform logarithm.
    pub fn around(&mut self, (low, high): (f64, f64)) -> f64 {
        low * (high / low).powf(self.share())
    }
}
