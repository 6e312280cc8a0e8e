//! Codes for missing heights.

use super::Topography;

/// The rounding of codes in files of `f32`.
const ROUNDING: f64 = f32::EPSILON as f64;

impl Topography {
    /// Takes the heights that are equal to `code`, to the rounding of `f32`, for missing: they become NaN.
    ///
    /// Instruments write a value as −9999 or 32767 where they found no height.
    /// [`Warning::of_topography`](crate::warning::Warning::of_topography) says which value of a map looks like one.
    ///
    /// ```
    /// use asperity_maps::Topography;
    /// let map = Topography::new(ndarray::array![[0.1, -9999.0], [-9999.0, 0.3]]);
    /// assert_eq!(map.declare_missing(-9999.0).missing(), 2);
    /// ```
    #[must_use]
    pub fn declare_missing(mut self, code: f64) -> Self {
        let slack = ROUNDING * code.abs();
        self.heights.mapv_inplace(|h| if (h - code).abs() <= slack { f64::NAN } else { h });
        self
    }
}
