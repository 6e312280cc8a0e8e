//! The elastic work ⟨u, p⟩, twice the elastic energy, which scales the certificate.
//!
//! With u = g + h it is ⟨g, p⟩ + ⟨g, K⁻¹h⟩ + ⟨h, K⁻¹h⟩, three sums over fields that an iteration reads anyway. Under a
//! light load the gap is nearly the surface upside down, p nearly vanishes, and the three sums cancel: their rounding
//! may exceed the work itself. Then one application gives ⟨p, K p⟩ instead, a sum of squares over the waves.

use super::state::State;
use crate::elastic::Foundation;
use crate::error::Result;
use crate::real::Real;

/// Rounding beyond this share of the work calls for the sum of squares, as long as the work is only a scale.
pub(super) const TRUSTED: f64 = 1e-3;

/// The roundings that each product and the sum of them may have.
const ROUNDINGS: f64 = 8.0;

/// The elastic work, summed over the nodes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    pub(super) sum: f64,
    /// a bound of the rounding in the sum
    pub(super) noise: f64,
}

impl Work {
    /// Whether rounding may exceed `share` of the work.
    fn is_doubtful(self, share: f64) -> bool {
        self.noise > share * self.sum
    }

    /// The work after a step that changes it by `change`.
    pub(super) fn after(self, change: f64) -> Self {
        Self { sum: self.sum + change, ..self }
    }
}

impl<T: Real> State<'_, T> {
    /// The mean of u·p, twice the elastic energy per area.
    pub(super) fn mean_work(&self) -> f64 {
        (self.work.sum / self.nodes()).max(0.0)
    }

    /// The rounding of a sum over the nodes, with `size` the sum of the magnitudes of its terms.
    fn sum_noise(&self, size: f64) -> f64 {
        ROUNDINGS * (T::epsilon().widen() / self.nodes().sqrt() + f64::EPSILON) * size
    }

    /// The work from the sums of a tally: Σ g·p and Σ g·K⁻¹h.
    pub(super) fn summed_work(&self, sum_gp: f64, gap_surface: f64) -> Work {
        let surface = self.nodes() * self.flat.work;
        Work { sum: sum_gp + gap_surface + surface, noise: self.sum_noise(surface) }
    }

    /// Whether the work has become so small in the steps since its last sum that its rounding matters.
    pub(super) fn has_lost_its_work(&self) -> bool {
        self.work.is_doubtful(TRUSTED)
    }

    /// Computes the work as ⟨p, K p⟩ if rounding may exceed `share` of the present sum. Overwrites the preconditioned
    /// residual z.
    pub(super) fn trust_work(&mut self, share: f64) -> Result<()> {
        if !self.work.is_doubtful(share) {
            return Ok(());
        }
        let stiffness = self.foundation();
        let found = self.operator.precondition(
            self.fields.pressure.view(),
            Foundation::uniform(stiffness, stiffness),
            self.fields.preconditioned.view_mut(),
        )?;
        self.applications += 1;
        if found.error.is_finite() {
            let sum = self.nodes() * found.error.max(0.0);
            self.work = Work { sum, noise: self.sum_noise(sum) };
        }
        Ok(())
    }
}
