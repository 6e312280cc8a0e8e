//! The limit of no range of what a loop of loads dissipates, from paths on two grids.

use crate::adhesion::AdhesionLaw;
use crate::error::Result;
use crate::nested::coarsened;
use crate::path::PathEnd;
use crate::real::Real;
use crate::surface::Surface;

/// The least number of nodes along a side of the coarser grid.
const COARSEST: usize = 16;

/// The share of the difference of two grids by which the limit is beyond the finer one: where surfaces touch once, and where
/// they touch at several places one after the other. Which places touch differs from grid to grid, too, and half of the
/// difference has the least errors there.
const BEYOND: [f64; 2] = [1.0, 0.5];

/// The share of a limit that these places take in its error.
const SCATTER: [f64; 2] = [0.0, 0.1];

/// The standard errors of the work, in the error of its limit.
const STANDARD: f64 = 2.0;

/// A number on a grid in the limit of no range, where it has a first-order error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limit {
    /// The limit, in the unit of the number.
    pub value: f64,
    /// The estimated error of the limit, in the same unit. It covers most true errors, and is no bound.
    pub error: f64,
}

impl Limit {
    /// The limit from the values on a grid and on one of half as many nodes along the sides, with their own errors.
    fn of([fine, coarse]: [f64; 2], [own, coarser]: [f64; 2], is_scattered: bool) -> Self {
        let [beyond, scatter] = [BEYOND, SCATTER].map(|shares| shares[usize::from(is_scattered)]);
        let difference = fine - coarse;
        let value = fine + beyond * difference;
        let of_values = STANDARD * ((1.0 + beyond) * own).hypot(beyond * coarser);
        Self { value, error: difference.hypot(scatter * value).hypot(of_values) }
    }
}

/// The limits of no range of a path by a law that attracts next to contacts alone, as [`Jkr`](crate::Jkr).
///
/// On a grid of spacing Δx a path has the work W + O(Δx), where W is the work of the limit. Two grids extrapolate to
/// 2W₁ − W₂, with W₂ on the grid of half as many nodes along the sides. Where surfaces touch at several places one after the other, other
/// places do so on another grid: the limit is then W₁ + (W₁ − W₂)/2, and its error has a tenth of the limit for that. On 20
/// random surfaces the limit by 128² and 256² nodes was within the error in 19, and by 64² and 128² in 16.
///
/// ```
/// use asperity::accuracy::LoopLimit;
/// use asperity::path::{Path, PathSettings};
/// use asperity::{AdhesionLaw, Boussinesq, Control, Grid, Jkr, Problem, Solver, Surface};
/// let follow = |surface: &Surface| {
///     let half_space = Boussinesq::<f64>::new(*surface.grid(), 1.0)?;
///     let mut problem = Problem::new(surface, half_space, Jkr::new(2e-3)?)?;
///     let mut path = Path::new([-0.02, 0.01, -0.2].map(Control::Approach), PathSettings::default())?;
///     while path.next(&mut Solver::default(), &mut problem)?.is_some() {}
///     Ok::<_, asperity::Error>(path.end())
/// };
/// let sphere = Surface::paraboloid(Grid::square(48, 1.6)?, 1.0)?;
/// let coarser = LoopLimit::coarser(&sphere, &Jkr::new(2e-3)? as &dyn AdhesionLaw<f64>)?.unwrap();
/// let limit = LoopLimit::of(&follow(&sphere)?, &follow(&coarser)?);
/// assert!(0.0 < limit.work.error && limit.work.error < 0.2 * limit.work.value);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LoopLimit {
    /// The work done by the load, energy per nominal area: over a closed loop, the energy that it dissipates.
    pub work: Limit,
    /// The greatest tension, a pressure.
    pub tension: Limit,
}

impl LoopLimit {
    /// The limits from the ends of one path on a grid and on one of half as many nodes along the sides.
    pub fn of(fine: &PathEnd, coarse: &PathEnd) -> Self {
        let is_scattered = fine.touches.max(coarse.touches) > 1;
        let tensions = [fine.greatest_tension, coarse.greatest_tension];
        Self {
            work: Limit::of([fine.work, coarse.work], [fine.work_error, coarse.work_error], is_scattered),
            tension: Limit::of(tensions, [0.0; 2], is_scattered),
        }
    }

    /// The surface on the grid of half as many nodes along the sides; none if there is no such grid, as for odd numbers of
    /// nodes and a law that varies from node to node.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) for a grid that processes cannot share.
    pub fn coarser<T: Real>(surface: &Surface, law: &dyn AdhesionLaw<T>) -> Result<Option<Surface>> {
        Ok(coarsened(surface, COARSEST, law.hints().shape.is_none())?.into_iter().next())
    }
}
