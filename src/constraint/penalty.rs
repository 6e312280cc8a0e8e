//! Penalty springs: a wall of given stiffness that the surfaces may interpenetrate.

use super::{ContactConstraint, Springs, Wall};
use crate::error::{Error, Result};
use crate::real::Real;

/// Interpenetration is allowed, and resisted by springs of stiffness k: the energy gains ½k⟨−g⟩₊² at each node.
///
/// The surfaces interpenetrate by the contact pressure over k, [`Report::min_gap`](crate::Report) says how far at
/// worst. The larger k, the less, and the more iterations: beside [`Projection`](super::Projection) this is for
/// comparison. Adhesion goes on into negative gaps as [`ContactConstraint`] says.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Penalty, Problem, Settings, Solver, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(500.0)? };
/// let report = solver.solve(&mut problem, Control::MeanGap(0.0398))?.report;
/// assert!(report.min_gap < 0.0 && report.min_gap > -1e-4);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty<T> {
    stiffness: T,
}

impl<T: Real> Penalty<T> {
    /// Springs of stiffness k, pressure per length; the paper's 5000 is in units of E*/L.
    ///
    /// # Errors
    /// [`Error::Value`] if the stiffness is not positive and finite.
    pub fn new(stiffness: T) -> Result<Self> {
        Error::positive("penalty stiffness", stiffness.widen())?;
        Ok(Self { stiffness })
    }
}

impl<T: Real> ContactConstraint<T> for Penalty<T> {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Springs(self)
    }
}

impl<T: Real> Springs<T> for Penalty<T> {
    fn energy(&self, _: usize, gap: T) -> T {
        let depth = (-gap).max(T::zero());
        T::lit(0.5) * self.stiffness * depth * depth
    }
    fn traction(&self, _: usize, gap: T) -> T {
        self.stiffness * gap.min(T::zero())
    }
    fn slope(&self, _: usize, gap: T) -> T {
        if gap < T::zero() { self.stiffness } else { T::zero() }
    }
}
