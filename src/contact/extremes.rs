//! The least and the greatest elastic pressure.

use ndarray::ArrayView2;

use crate::grid::Grid;
use crate::real::Real;

/// The least and the greatest elastic pressure of a solution.
///
/// Without adhesion nothing pulls, and no pressure is below zero but by rounding, and by the tolerance of the solve: the
/// least pressure is zero then, and `residue` says how far below zero the field is.
///
/// ```
/// use asperity::contact::PressureExtremes;
/// use asperity::Grid;
/// let pressure = ndarray::array![[2.0, 0.5], [0.0, -1e-5]];
/// let grid = Grid::square(2, 1.0)?;
/// let found = PressureExtremes::of(pressure.view(), &grid, false);
/// assert_eq!((found.least, found.greatest, found.residue), (0.0, 2.0, 5e-6));
/// assert_eq!(PressureExtremes::of(pressure.view(), &grid, true).least, -1e-5);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureExtremes {
    /// The least elastic pressure, with adhesion the most tensile one.
    pub least: f64,
    /// The greatest elastic pressure.
    pub greatest: f64,
    /// Without adhesion the most that the field is below zero, as a share of the greatest pressure; zero with adhesion.
    pub residue: f64,
}

impl PressureExtremes {
    /// The extremes of an elastic pressure on a grid, which processes may share, of surfaces that adhere or do not.
    pub fn of<T: Real>(pressure: ArrayView2<'_, T>, grid: &Grid, adheres: bool) -> Self {
        let fold = |start, of: fn(f64, f64) -> f64| pressure.iter().fold(start, |extreme, p| of(extreme, p.widen()));
        let least = grid.least(fold(f64::INFINITY, f64::min));
        let greatest = grid.greatest(fold(f64::NEG_INFINITY, f64::max));
        if adheres || least >= 0.0 {
            return Self { least, greatest, residue: 0.0 };
        }
        Self { least: 0.0, greatest, residue: if greatest > 0.0 { -least / greatest } else { 0.0 } }
    }
}
