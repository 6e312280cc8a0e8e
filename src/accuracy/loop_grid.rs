//! The grid on which a loop of loads has an accuracy, by the loop on coarser grids.

use std::fmt;
use std::sync::Arc;

use super::fitted::{COST, LOOP};
use super::goal::{COARSEST, FIRST, MOST_DOUBLINGS, is_refinable, on_coarse, on_twice};
use super::refine::{overshoots, refined, twice};
use super::{Accuracy, LoopLimit, Quantity};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::elastic::ElasticOperator;
use crate::error::{Error, Result};
use crate::nested::coarsened;
use crate::path::PathEnd;
use crate::real::Real;
use crate::surface::Surface;

/// The relative error that is left of errors of the grid and of its jumps on a grid that is so many times doubled.
fn left([of_grid, of_jumps]: [f64; 2], finer: i32) -> f64 {
    (of_grid * LOOP.left.powi(finer)).hypot(of_jumps)
}

/// The grid on which a loop of loads is likely to have an accuracy; [`Accuracy::loop_grid`] has an example.
#[non_exhaustive]
#[derive(Clone)]
pub struct LoopGrid<T: Real> {
    /// The surface on this grid.
    pub surface: Surface,
    /// The law on it.
    pub law: Arc<dyn AdhesionLaw<T>>,
    /// The nodes (Nx, Ny) of the coarser grids on which the loop was followed, the coarsest first, and its end on each.
    pub levels: Vec<((usize, usize), PathEnd)>,
    /// The relative error of the limit that is to be expected with this grid.
    pub expected: f64,
    /// The memory that the loop takes on this grid, in bytes.
    pub bytes: f64,
    /// Whether the surface and the law are known on finer grids, as in [`AccurateSolution`](super::AccurateSolution).
    pub refinable: bool,
    /// The next finer grid and its memory in bytes, if that is too much.
    pub unaffordable: Option<((usize, usize), f64)>,
}

impl<T: Real> fmt::Debug for LoopGrid<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let law = self.law.hints().known_as();
        f.debug_struct("LoopGrid").field("surface", &self.surface).field("law", &law).finish_non_exhaustive()
    }
}

impl Accuracy {
    /// The grid on which a loop is likely to have the accuracy, by a law that attracts next to contacts alone; none if
    /// `follow` returns none.
    ///
    /// `follow` follows the loop on a surface with a law, and returns its end: first on coarser grids, each with half of the
    /// nodes of the next along the sides, from 32 nodes on, or a quarter of the nodes of the surface. As long as the error of
    /// the [limit](LoopLimit) that is to be expected exceeds the accuracy, it follows on the next grid: the grid of the
    /// surface, and then grids of twice as many nodes, for which the surface is interpolated as by [`Accuracy::solve`]. It
    /// ends with the first grid on which the error that is found meets the accuracy. The loop on the grid that is returned
    /// is left to be followed: with the end on the last of the levels, [`LoopLimit::of`] tells its limit and its error.
    /// `operator` is the operator on the grid of the surface.
    ///
    /// # Errors
    /// [`Error::Unsuited`] for a law that attracts everywhere, a quantity that is not of a loop, and a grid that has
    /// no coarser one; [`Error::Value`] for an accuracy that is not positive; [`Error::Unaffordable`] if the grid is
    /// far beyond the memory; those of `follow`.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use asperity::accuracy::{Accuracy, LoopLimit, Quantity};
    /// use asperity::path::{Path, PathSettings};
    /// use asperity::{AdhesionLaw, Boussinesq, Control, Error, Grid, Jkr, Problem, Solver, Surface};
    /// let mut follow = |surface: &Surface, law: &Arc<dyn AdhesionLaw<f64>>| {
    ///     let half_space = Boussinesq::<f64>::new(*surface.grid(), 1.0)?;
    ///     let mut problem = Problem::new(surface, half_space, law.clone())?;
    ///     let mut path = Path::new([-0.02, 0.01, -0.2].map(Control::Approach), PathSettings::default())?;
    ///     while path.next(&mut Solver::default(), &mut problem)?.is_some() {}
    ///     Ok::<_, Error>(Some(path.end()))
    /// };
    /// let sphere = Surface::paraboloid(Grid::square(32, 1.6)?, 1.0)?;
    /// let mut half_space = Boussinesq::<f64>::new(*sphere.grid(), 1.0)?;
    /// let (wanted, law) = (Accuracy::new(0.1, Quantity::Work), Arc::new(Jkr::new(2e-3)?));
    /// let found = wanted.loop_grid(&sphere, &mut half_space, law, &mut follow)?.unwrap();
    /// let end = follow(&found.surface, &found.law)?.unwrap();
    /// let shape = found.surface.grid().shape();
    /// let limit = LoopLimit::of(shape, &end, &found.levels.last().unwrap().1).work;
    /// assert!(shape > (32, 32) && limit.relative_error() < 0.1);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn loop_grid<T: Real, E: From<Error>>(
        &self,
        surface: &Surface,
        operator: &mut dyn ElasticOperator<T>,
        law: Arc<dyn AdhesionLaw<T>>,
        mut follow: impl FnMut(&Surface, &Arc<dyn AdhesionLaw<T>>) -> std::result::Result<Option<PathEnd>, E>,
    ) -> std::result::Result<Option<LoopGrid<T>>, E> {
        let coarser = self.grids_below(surface, &*law)?;
        let periodic = operator.boundary().is_periodic();
        let padding = operator.grid().nodes() as f64 / surface.grid().nodes() as f64;
        let bytes = |(nx, ny): (usize, usize)| 8.0 * (COST.numbers + COST.of_path) * padding * nx as f64 * ny as f64;
        let (mut surface, mut law, mut levels) = (surface.clone(), SharedLaw(law), Vec::new());
        let mut refinable = is_refinable(&surface, &*law);
        for coarse in coarser {
            let (shape, on_coarse) = (coarse.grid().shape(), on_coarse(&law, &surface, &coarse).0);
            let Some(end) = follow(&coarse, &on_coarse)? else { return Ok(None) };
            levels.push((shape, end));
            let expected = self.error_of_loop(&levels);
            if expected <= self.target {
                // the limit of this grid is told by the coarser ones
                levels.pop();
                let (surface, law, bytes) = (coarse, on_coarse, bytes(shape));
                return Ok(Some(LoopGrid { surface, law, levels, expected, bytes, refinable, unaffordable: None }));
            }
        }
        loop {
            let (errors, shape) = (self.errors_of_loop(&levels), surface.grid().shape());
            let (expected, finer) = (left(errors, 1), twice(shape));
            if refinable && levels.len() > 1 {
                self.check_loop(errors, shape, bytes)?;
            }
            let fits = bytes(finer) <= self.memory;
            let mut fine = None;
            if refinable && fits && expected > self.target {
                fine = Some(refined(&surface, periodic)?);
                refinable = !fine.as_ref().is_some_and(|fine| overshoots(fine, &surface));
            }
            let Some(fine) = fine.filter(|_| refinable) else {
                let unaffordable = (refinable && !fits).then(|| (finer, bytes(finer)));
                let (law, bytes) = (law.0, bytes(shape));
                return Ok(Some(LoopGrid { surface, law, levels, expected, bytes, refinable, unaffordable }));
            };
            let Some(end) = follow(&surface, &law.0)? else { return Ok(None) };
            levels.push((shape, end));
            let expected = self.error_of_loop(&levels);
            if expected <= self.target {
                levels.pop();
                let (law, bytes, unaffordable) = (law.0, bytes(shape), None);
                return Ok(Some(LoopGrid { surface, law, levels, expected, bytes, refinable, unaffordable }));
            }
            law = on_twice(law, &surface, &fine);
            surface = fine;
        }
    }

    /// The relative error on the last of some levels.
    fn error_of_loop(&self, levels: &[((usize, usize), PathEnd)]) -> f64 {
        let [of_grid, of_jumps] = self.errors_of_loop(levels);
        of_grid.hypot(of_jumps)
    }

    /// The surface on coarser grids, the coarsest first: those of half and of a quarter of the nodes along the sides,
    /// as far as there are any, and coarser ones with no less than [`FIRST`].
    fn grids_below<T: Real>(&self, surface: &Surface, law: &dyn AdhesionLaw<T>) -> Result<Vec<Surface>> {
        surface.grid().refuse_shared("accuracy")?;
        Error::positive("accuracy", self.target)?;
        let what = "accuracy of a loop";
        if !Quantity::OF_LOOPS.contains(&self.of) {
            return Err(Error::Unsuited { what, reason: "it is of the work, or of the tension" });
        }
        let hints = law.hints();
        if !hints.touches() {
            let reason = "the error of the grid is known of the law jkr alone: take that, or leave out the accuracy";
            return Err(Error::Unsuited { what, reason });
        }
        let mut coarser = coarsened(surface, COARSEST, hints.shape.is_none())?;
        let least = |surface: &Surface| {
            let (nx, ny) = surface.grid().shape();
            [nx, ny].into_iter().filter(|&nodes| nodes > 1).min().unwrap_or(0)
        };
        let few = coarser.iter().skip(2).take_while(|coarse| least(coarse) >= FIRST).count();
        coarser.truncate(2 + few);
        if coarser.is_empty() {
            let reason = "a grid of half as many nodes along the sides tells it, and there is none of 16 nodes or more, with \
                          every second node of this one: take more nodes, a number that is a power of two";
            return Err(Error::Unsuited { what, reason });
        }
        coarser.reverse();
        Ok(coarser)
    }

    /// The relative errors on the last of some levels: of the grid, and of where in their steps the jumps are.
    fn errors_of_loop(&self, levels: &[((usize, usize), PathEnd)]) -> [f64; 2] {
        let [.., (_, coarse), (shape, fine)] = levels else { return [f64::INFINITY, 0.0] };
        let error = |ends: [PathEnd; 2]| LoopLimit::of(*shape, &ends[0], &ends[1]).get(self.of).relative_error();
        let [of_grid, all] =
            [[*fine, *coarse].map(|end| PathEnd { work_error: 0.0, ..end }), [*fine, *coarse]].map(error);
        [of_grid, (all * all - of_grid * of_grid).max(0.0).sqrt()]
    }

    /// Refuses an accuracy that no grid has, or none within the memory, where the grid below one of this shape has these
    /// relative errors.
    fn check_loop(&self, errors: [f64; 2], shape: (usize, usize), bytes: impl Fn((usize, usize)) -> f64) -> Result<()> {
        if errors[1] >= self.target {
            let reason =
                "it is less than the error of where in their steps the jumps are: give a smaller step for jumps";
            return Err(Error::Unsuited { what: "accuracy of a loop", reason });
        }
        let reached = |finer: i32| left(errors, 1 + finer);
        let needed = |smaller: f64| {
            (0..MOST_DOUBLINGS).find(|&finer| reached(finer) <= smaller * self.target).unwrap_or(MOST_DOUBLINGS)
        };
        let finer = |count: i32| (0..count).fold(shape, |shape, _| twice(shape));
        let least = needed(COST.doubt);
        if least == 0 || bytes(finer(least)) <= self.memory {
            return Ok(());
        }
        let most = (0..least).rev().find(|&count| bytes(finer(count)) <= self.memory).unwrap_or(0);
        let shape = finer(needed(1.0));
        Err(Error::Unaffordable {
            quantity: self.of.name(),
            accuracy: self.target,
            shape,
            bytes: bytes(shape),
            available: self.memory,
            affordable: reached(most),
        })
    }
}
