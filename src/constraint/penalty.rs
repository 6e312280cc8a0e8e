//! Penalty springs: a wall of given stiffness that the surfaces may interpenetrate.

use super::{ContactConstraint, Springs, Wall};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::real::Real;

/// Penalty springs of stiffness k that resist interpenetration: the energy gains ½k⟨−g⟩₊² at each node.
///
/// The surfaces interpenetrate by the contact pressure over k, at worst by [`Report::min_gap`](crate::Report). A
/// solve with stiff springs starts from the state of a rigid wall, and takes hardly more iterations than a solve with
/// [`Projection`](super::Projection).
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
pub struct Penalty {
    stiffness: f64,
}

impl Penalty {
    /// Springs of stiffness k, pressure per length; the paper's 5000 is in units of E*/L.
    ///
    /// # Errors
    /// [`Error::Value`] if the stiffness is not positive and finite.
    pub fn new(stiffness: f64) -> Result<Self> {
        Ok(Self { stiffness: Error::positive("penalty stiffness", stiffness)? })
    }
}

impl<T: Real> ContactConstraint<T> for Penalty {
    fn wall(&self) -> Wall<'_, T> {
        Wall::Springs(self)
    }
    fn start(&mut self, _: &Grid, _: f64, _: f64) -> Result<()> {
        check_stiffness::<T>(self.stiffness)
    }
}

/// Refuses a stiffness that leaves the range of T.
pub(super) fn check_stiffness<T: Real>(stiffness: f64) -> Result<()> {
    let rounded = T::lit(stiffness);
    if rounded > T::zero() && rounded.is_finite() {
        return Ok(());
    }
    let requirement = "positive and finite in the precision of the fields";
    Err(Error::Value { name: "penalty stiffness", value: stiffness, requirement })
}

impl<T: Real> Springs<T> for Penalty {
    fn energy(&self, _: usize, gap: T) -> T {
        let depth = (-gap).max(T::zero());
        T::lit(0.5) * T::lit(self.stiffness) * depth * depth
    }
    fn traction(&self, _: usize, gap: T) -> T {
        T::lit(self.stiffness) * gap.min(T::zero())
    }
    fn slope(&self, _: usize, gap: T) -> T {
        if gap < T::zero() { T::lit(self.stiffness) } else { T::zero() }
    }
}
