//! An exponential law that is evaluated at negative gaps, as it stands.

use asperity::constraint::{Springs, Update, Wall};
use asperity::{AdhesionLaw, ContactConstraint, Exponential, Grid, Result};
use ndarray::ArrayView2;

/// Another constraint, with what an exponential law adds to its tangent where the surfaces interpenetrate: the energy
/// then has no lower bound.
pub struct Outrun<C>(pub C, pub Exponential);

impl<C> Outrun<C> {
    fn excess(&self, gap: f64, of_law: f64, of_tangent: f64) -> f64 {
        if gap < 0.0 { of_law - of_tangent } else { 0.0 }
    }
}

impl<C: ContactConstraint<f64> + Springs<f64>> ContactConstraint<f64> for Outrun<C> {
    fn wall(&self) -> Wall<'_, f64> {
        Wall::Springs(self)
    }
    fn start(&mut self, grid: &Grid, stiffest: f64, tolerance: f64) -> Result<()> {
        self.0.start(grid, stiffest, tolerance)
    }
    fn round_tolerance(&self) -> f64 {
        self.0.round_tolerance()
    }
    fn update(&mut self, gap: ArrayView2<'_, f64>, work: f64) -> Update {
        self.0.update(gap, work)
    }
}

impl<C: ContactConstraint<f64> + Springs<f64>> Springs<f64> for Outrun<C> {
    fn energy(&self, node: usize, gap: f64) -> f64 {
        let tangent = self.1.energy(0.0) + gap * self.1.traction(0.0);
        self.0.energy(node, gap) + self.excess(gap, self.1.energy(gap), tangent)
    }
    fn traction(&self, node: usize, gap: f64) -> f64 {
        self.0.traction(node, gap) + self.excess(gap, self.1.traction(gap), self.1.traction(0.0))
    }
    fn slope(&self, node: usize, gap: f64) -> f64 {
        self.0.slope(node, gap) + self.excess(gap, self.1.slope(gap), 0.0)
    }
}
