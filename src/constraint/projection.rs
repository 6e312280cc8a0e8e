//! Projection: a rigid wall at g = 0, kept by clipping every step.

use super::{ContactConstraint, Wall};
use crate::real::Real;

/// A rigid wall, g ≥ 0: steps that would pass are clipped, and contact nodes under tension are released. Where the
/// contact pressure is positive the gap is exactly zero.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.0398))?; // the default is projection
/// assert!(solution.gap.iter().zip(&solution.contact_pressure).all(|(g, p)| g * p == 0.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Projection;

impl<T: Real> ContactConstraint<T> for Projection {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Rigid
    }
    fn takes_slabs(&self) -> bool {
        true
    }
}
