//! The elastic work ⟨u, p⟩, twice the elastic energy, which scales the certificate.
//!
//! With u = g + h it is ⟨g, p⟩ + ⟨g, K⁻¹h⟩ + ⟨h, K⁻¹h⟩, three sums over fields that an iteration reads anyway. Under a
//! light load the gap is nearly the surface upside down, p nearly vanishes, and the three sums cancel: their rounding
//! may exceed the work itself. Then one application gives ⟨p, K p⟩ instead, a sum of squares over the waves.

/// Rounding beyond this share of the work calls for the sum of squares, as long as the work is only a scale.
pub(super) const TRUSTED: f64 = 1e-3;

/// The elastic work, summed over the nodes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    pub(super) sum: f64,
    /// a bound of the rounding in the sum
    pub(super) noise: f64,
}

impl Work {
    /// Whether rounding may exceed `share` of the work.
    pub(super) fn is_doubtful(self, share: f64) -> bool {
        self.noise > share * self.sum
    }

    /// The work after a step that changes it by `change`, to within `noise`.
    pub(super) fn after(self, change: f64, noise: f64) -> Self {
        Self { sum: self.sum + change, noise: self.noise + noise }
    }
}
