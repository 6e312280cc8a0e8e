//! The elastic work ⟨u, p⟩, twice the elastic energy, which scales the certificate.
//!
//! With u = g + h it is ⟨g, p⟩ + ⟨g, K⁻¹h⟩ + ⟨h, K⁻¹h⟩, sums over fields that an iteration reads anyway. Under light
//! loads they cancel, to less than their rounding; one application then gives ⟨p, K p⟩, a sum of squares.

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    pub(super) sum: f64,
    /// a bound of the rounding in the sum
    pub(super) noise: f64,
}

impl Work {
    pub(super) fn is_doubtful(self, share: f64) -> bool {
        self.noise > share * self.sum
    }

    /// The work after a step that changes it by `change`, to within `noise`.
    pub(super) fn after(self, change: f64, noise: f64) -> Self {
        Self { sum: self.sum + change, noise: self.noise + noise }
    }
}
