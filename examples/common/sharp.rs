//! A law that keeps its jumps.

use asperity::AdhesionLaw;
use asperity::adhesion::Hints;

/// A law that does not say how its jumps are smoothed: the edge of the adhesive zone stays where a start leaves it.
pub struct Sharp<L>(pub L);

impl<L: AdhesionLaw<f64>> AdhesionLaw<f64> for Sharp<L> {
    fn energy(&self, gap: f64) -> f64 {
        self.0.energy(gap)
    }
    fn traction(&self, gap: f64) -> f64 {
        self.0.traction(gap)
    }
    fn slope(&self, gap: f64) -> f64 {
        self.0.slope(gap)
    }
    fn hints(&self) -> Hints<f64> {
        self.0.hints()
    }
}
