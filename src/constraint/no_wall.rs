//! No wall: the adhesion law itself keeps the surfaces apart.

use super::{ContactConstraint, Wall};
use crate::real::Real;

/// No wall, for a law that repels close by, as [`LennardJones`](crate::LennardJones) or [`Morse`](crate::Morse).
///
/// Every gap at which the law is finite is feasible; contact is where the law repels, below its
/// [`rest`](crate::adhesion::Hints::rest).
///
/// ```
/// use asperity::{Control, Grid, Morse, NoWall, Problem, Settings, Solver, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, Morse::new(1e-4, 5e-3)?)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: NoWall };
/// let report = solver.solve(&mut problem, Control::MeanPressure(1e-3))?.report;
/// assert!(report.min_gap < 0.0 && report.contact_nodes > 1);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoWall;

impl<T: Real> ContactConstraint<T> for NoWall {
    fn wall(&self) -> Wall<'_, T> {
        Wall::None
    }
}
