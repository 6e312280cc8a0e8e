//! The limit of no range of what a loop of loads dissipates, from paths on two grids.

use std::sync::Arc;

use super::Quantity;
use super::fitted::LOOP;
use super::goal::{COARSEST, on_coarse};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::error::Result;
use crate::nested::coarsened;
use crate::path::PathEnd;
use crate::real::Real;
use crate::surface::Surface;

/// A number on a grid in the limit of no range, where it has a first-order error.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limit {
    /// The limit, in the unit of the number.
    pub value: f64,
    /// The estimated error of the limit, in the same unit. It covers most true errors, and is no bound.
    pub error: f64,
}

impl Limit {
    /// The limit from the values on a grid and on one of half as many nodes along the sides, with their own errors, a
    /// share of their difference `beyond` the finer one, with the share of it that places take.
    fn of([fine, coarse]: [f64; 2], [own, coarser]: [f64; 2], (beyond, scatter): (f64, f64)) -> Self {
        let difference = fine - coarse;
        let value = fine + beyond * difference;
        let of_values = LOOP.standard * ((1.0 + beyond) * own).hypot(beyond * coarser);
        Self { value, error: difference.hypot(scatter * value).hypot(of_values) }
    }

    /// The error, relative to the limit.
    pub fn relative_error(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.value.abs() }
    }
}

/// The limits of no range of a path by a law that attracts next to contacts alone, as [`Jkr`](crate::Jkr).
///
/// On a grid of spacing Δx a path has the work W + O(Δx), where W is the work of the limit. With W₁ and W₂, the work
/// on the grid and on the grid of half as many nodes along the sides, the limit is W₁ + 1.35 (W₁ − W₂). Where
/// surfaces touch at several places one after the other, other places do so on another grid: the limit is then W₁ +
/// (W₁ − W₂)/2, and its error has 24 % of the limit for that on 128 nodes along a side and fewer, and less in
/// proportion to the root of the spacing on finer grids. Of 24 random surfaces the limit of the work by 64² and 128²
/// nodes is within this error of the limit by 128² and 256² on 23
/// (`cargo run --release -p asperity-examples --example touch -- --surfaces 12 --seed 700`, and 760).
///
/// ```
/// use std::sync::Arc;
/// use asperity::accuracy::LoopLimit;
/// use asperity::path::{Path, PathSettings};
/// use asperity::{AdhesionLaw, Boussinesq, Control, Grid, Jkr, Problem, Solver, Surface};
/// let follow = |surface: &Surface, law: Arc<dyn AdhesionLaw<f64>>| {
///     let half_space = Boussinesq::<f64>::new(*surface.grid(), 1.0)?;
///     let mut problem = Problem::new(surface, half_space, law)?;
///     let mut path = Path::new([-0.02, 0.01, -0.2].map(Control::Approach), PathSettings::default())?;
///     while path.next(&mut Solver::default(), &mut problem)?.is_some() {}
///     Ok::<_, asperity::Error>(path.end())
/// };
/// let sphere = Surface::paraboloid(Grid::square(48, 1.6)?, 1.0)?;
/// let law: Arc<dyn AdhesionLaw<f64>> = Arc::new(Jkr::new(2e-3)?);
/// let (coarser, on_coarser) = LoopLimit::coarser(&sphere, law.clone())?.unwrap();
/// let limit = LoopLimit::of((48, 48), &follow(&sphere, law)?, &follow(&coarser, on_coarser)?);
/// assert!(0.0 < limit.work.error && limit.work.error < 0.2 * limit.work.value);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LoopLimit {
    /// The work done by the load, energy per nominal area: over a closed loop, the energy that it dissipates.
    pub work: Limit,
    /// The greatest tension, a pressure.
    pub tension: Limit,
}

/// A surface, and the law on its grid.
type OnGrid<T> = (Surface, Arc<dyn AdhesionLaw<T>>);

impl LoopLimit {
    /// The limits from the ends of one path on a grid of this shape, and on one of half as many nodes along the sides.
    pub fn of(shape: (usize, usize), fine: &PathEnd, coarse: &PathEnd) -> Self {
        let sides = [shape.0, shape.1].into_iter().filter(|&nodes| nodes > 1);
        let finer = LOOP.nodes / (shape.0 as f64 * shape.1 as f64).powf(1.0 / sides.count().max(1) as f64);
        let is_scattered = fine.touches.max(coarse.touches) > 1;
        let of_places = (LOOP.beyond_places, LOOP.scatter * finer.sqrt().min(1.0));
        let [work, tension] = LOOP.beyond.map(|one| if is_scattered { of_places } else { (one, 0.0) });
        let tensions = [fine.greatest_tension, coarse.greatest_tension];
        Self {
            work: Limit::of([fine.work, coarse.work], [fine.work_error, coarse.work_error], work),
            tension: Limit::of(tensions, [0.0; 2], tension),
        }
    }

    /// The limit of a quantity of loops, by default of the work.
    pub fn get(&self, of: Quantity) -> Limit {
        if of == Quantity::Tension { self.tension } else { self.work }
    }

    /// The surface and the law on the grid of half as many nodes along the sides; none if there is no such grid, as for odd
    /// numbers of nodes and a law that varies from node to node.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) for a grid that processes cannot share.
    pub fn coarser<T: Real>(surface: &Surface, law: Arc<dyn AdhesionLaw<T>>) -> Result<Option<OnGrid<T>>> {
        let coarse = coarsened(surface, COARSEST, law.hints().shape.is_none())?.into_iter().next();
        Ok(coarse.map(|coarse| {
            let law = on_coarse(&SharedLaw(law), surface, &coarse).0;
            (coarse, law)
        }))
    }
}
