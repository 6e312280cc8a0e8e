//! The pull-off with the error of its grid, of a law that has the range of the grid.

use std::ops::ControlFlow;

use super::goal::{NUMBERS, is_refinable};
use super::refine::{overshoots, refined, twice};
use super::{Accuracy, GridError, observed_order};
use crate::adhesion::{AdhesionLaw, Discretisation, SharedLaw};
use crate::constraint::ContactConstraint;
use crate::contact::ContactArea;
use crate::elastic::{Boundary, OnGrids};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::nested::{GridObserver, coarsened};
use crate::problem::Problem;
use crate::pull_off::{FoundPullOff, PullOff};
use crate::real::Real;
use crate::solver::{Iteration, Solver, Start, Status};
use crate::surface::Surface;

/// The factors of the process zone and of the difference to the grid of half as many nodes, in the error.
const FACTORS: [f64; 2] = [1.2, 0.75];

/// The width of the bracket of a search, as a share of the accuracy.
const BRACKET: f64 = 0.2;

/// The contact fraction by the adhesive energy, above which a periodic cell is closed: the grid decides when it opens.
const CLOSED: f64 = 0.75;

/// The growth of the limit from one grid to the next, above which the two tell no error.
const GROWTH: f64 = 1.2;

/// The pull-off on the finest of some grids, and the estimated error of its [limit](FoundPullOff::limit).
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct AccuratePullOff<T: Real> {
    /// The search on the finest grid.
    pub found: FoundPullOff<T>,
    /// The surface on that grid.
    pub surface: Surface,
    /// The nodes (Nx, Ny) of each grid, the finest last, and the limit of the pull-off that it tells, a pressure.
    pub levels: Vec<((usize, usize), f64)>,
    /// The estimated error of the limit on the finest grid, with the width of its bracket, if two grids tell it.
    pub error: Option<GridError>,
    /// Whether the estimate meets the accuracy.
    pub reached: bool,
    /// Whether the surface and the law are known on finer grids, as in [`AccurateSolution`](super::AccurateSolution).
    pub refinable: bool,
    /// The next finer grid and its memory in bytes, if that was too much.
    pub unaffordable: Option<((usize, usize), f64)>,
}

impl<T: Real> FoundPullOff<T> {
    /// The pull-off in the limit of no range, a pressure, that a state under the greatest tension tells on its grid: the
    /// tension less the share of the process zone in its adhesive energy. None of a law with a range, without a tension,
    /// and of a periodic cell of which more than three quarters are in contact by A_E: closed surfaces have no flaw from
    /// which to peel, and their pull-off grows as 1/√Δx.
    ///
    /// ```math
    /// T = T_grid · A/A_E ,   A_E = −E_adh/w ,   A = A_E − 0.16 S Δx
    /// ```
    ///
    /// At steps of the surface A is another, as [`ContactArea::jkr_contact_fraction`] says.
    ///
    /// # Errors
    /// Those of [`ContactArea::of_solution`].
    pub fn limit(&self) -> Result<Option<f64>> {
        let report = &self.solution.report;
        let (tension, by_energy) = (-report.mean_pressure, report.adhesive_contact_fraction);
        let area = ContactArea::of_solution(&self.solution)?.jkr_contact_fraction;
        let facing = 1.0 - report.absent_nodes as f64 / self.solution.grid.nodes() as f64;
        let is_closed = report.approach.is_none() && by_energy.is_some_and(|share| share * facing > CLOSED);
        let share = area.zip(by_energy).filter(|_| !is_closed).map(|(area, by_energy)| area / by_energy);
        Ok(share.filter(|share| tension > 0.0 && share.is_finite()).map(|share| share * tension))
    }
}

impl Accuracy {
    /// The pull-off to the accuracy, if it can be had; an infinite accuracy asks for the error on the given grid alone.
    ///
    /// The given grid and one of half as many nodes along the sides are searched. As long as the estimated error of the
    /// [limit](FoundPullOff::limit) exceeds the accuracy, the surface is put on twice as many nodes, as by
    /// [`Accuracy::solve`]. With a law that has a range of its own the given grid alone is searched, without an estimate.
    ///
    /// # Errors
    /// [`Error::Unsuited`] for an accuracy with a law that has a range; [`Error::Value`] for one that is not positive;
    /// those of `operators` and [`PullOff::find`].
    ///
    /// ```
    /// use asperity::accuracy::{Accuracy, Quantity};
    /// use asperity::{Boussinesq, Grid, Jkr, PullOff, Solver, Surface, exact, exact::Sphere};
    /// let sphere = Surface::paraboloid(Grid::square(64, 1.6)?, 1.0)?;
    /// let half_space = |grid| Boussinesq::<f64>::new(grid, 1.0);
    /// let (told, law) = (Accuracy::new(f64::INFINITY, Quantity::Area), Jkr::new(2e-3)?);
    /// let found = told.pull_off(&mut Solver::default(), &sphere, half_space, law, &PullOff::default())?;
    /// let force = found.found.limit()?.unwrap() * 1.6 * 1.6;
    /// let ratio = force / -exact::Jkr::new(1.0, 1.0, 2e-3)?.pull_off().load();
    /// assert!((ratio - 1.0).abs() < found.error.unwrap().relative);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn pull_off<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        search: &PullOff,
    ) -> Result<AccuratePullOff<T>> {
        self.pull_off_observed(solver, surface, operators, law, search, |_, _| ControlFlow::Continue(()))
    }

    /// As [`Accuracy::pull_off`], and calls `observe` with the grid in every iteration; where it stops a search, no
    /// finer grid follows.
    ///
    /// # Errors
    /// Those of [`Accuracy::pull_off`].
    pub fn pull_off_observed<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        mut operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        search: &PullOff,
        mut observe: impl FnMut(&Grid, &Iteration) -> ControlFlow<()> + Send,
    ) -> Result<AccuratePullOff<T>> {
        T::refine_pull_off(self, solver, surface, &mut operators, &SharedLaw::new(law), *search, &mut observe)
    }

    pub(crate) fn refine_pull_off<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operators: &mut dyn OnGrids<T>,
        law: &SharedLaw<T>,
        search: PullOff,
        observe: GridObserver<'_>,
    ) -> Result<AccuratePullOff<T>> {
        let hints = law.hints();
        let refines = self.target.is_finite();
        if refines {
            Error::positive("accuracy", self.target)?;
        }
        if refines && !hints.of_grid {
            let reason = "it is known of a law that has the range of the grid alone: take that of JKR, or leave out the accuracy";
            return Err(Error::Unsuited { what: "accuracy of the pull-off", reason });
        }
        let search = search.tolerance(search.tolerance.min(BRACKET * self.target));
        let mut find = |surface: &Surface, law: SharedLaw<T>| {
            let grid = *surface.grid();
            let mut problem = Problem::of(surface, operators.on(grid)?, law)?;
            let found = search.find_from(solver, &mut problem, Start::Default, |state| observe(&grid, state))?;
            let limit = found.limit()?;
            Ok::<_, Error>((found, limit, problem.operator.grid().nodes(), problem.operator.boundary()))
        };
        let mut levels = Vec::new();
        if hints.of_grid && !hints.zero {
            let coarse = coarsened(surface, self.nested.coarsest, hints.shape.is_none())?.into_iter().next();
            if let Some(coarse) = &coarse {
                let ((nx, ny), (cx, cy)) = (surface.grid().shape(), coarse.grid().shape());
                let on_coarse = law.adapted(Discretisation::Coarse(nx / cx, ny / cy));
                // what cannot be found there says nothing of the finer grid
                let found = find(coarse, on_coarse.map_or_else(|| law.clone(), SharedLaw)).ok();
                levels.extend(found.and_then(|(_, limit, ..)| Some((coarse.grid().shape(), limit?))));
            }
        }
        let mut surface = surface.clone();
        let mut refinable = is_refinable(&surface, &**law);
        loop {
            let (found, limit, nodes, boundary) = find(&surface, law.clone())?;
            let waves = surface.nodes_per_wave(boundary);
            let stopped = found.solution.report.status == Status::Stopped;
            levels.extend(limit.map(|limit| (surface.grid().shape(), limit)));
            let told = found.reached && limit.is_some();
            let error = if told { error(&found, &levels, waves) } else { None };
            let reached = !refines || error.is_some_and(|error| error.relative <= self.target);
            let shape = twice(surface.grid().shape());
            let growth = (shape.0 * shape.1) as f64 / surface.grid().nodes() as f64;
            let bytes = 8.0 * NUMBERS * nodes as f64 * growth;
            let ends = reached || stopped || !found.reached || limit.is_none() || !refinable || bytes > self.memory;
            let fine = if ends { None } else { Some(refined(&surface, boundary == Boundary::Periodic)?) };
            refinable &= !fine.as_ref().is_some_and(|fine| overshoots(fine, &surface));
            let Some(fine) = fine.filter(|_| refinable) else {
                let unaffordable =
                    (!reached && found.reached && refinable && bytes > self.memory).then_some((shape, bytes));
                return Ok(AccuratePullOff { found, surface, levels, error, reached, refinable, unaffordable });
            };
            surface = fine;
        }
    }
}

/// The error of the limit on the finest of the levels.
fn error<T: Real>(found: &FoundPullOff<T>, levels: &[((usize, usize), f64)], nodes_per_wave: f64) -> Option<GridError> {
    let limits: Vec<f64> = levels.iter().rev().map(|(_, limit)| *limit).collect();
    let &[limit, coarse, ..] = &limits[..] else { return None };
    if nodes_per_wave < 2.0 * GridError::LEAST_NODES_PER_WAVE || limit > GROWTH * coarse {
        return None;
    }
    let tension = -found.solution.report.mean_pressure;
    let bracket = found.lost.map_or(0.0, |lost| lost - tension);
    let [of_zone, of_difference] = FACTORS;
    let of_grid = (of_zone * (tension - limit)).hypot(of_difference * (limit - coarse));
    let relative = (of_grid + bracket) / limit;
    Some(GridError { relative, order: observed_order(&limits), rough: false })
}
