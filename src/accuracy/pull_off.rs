//! The pull-off with the error of its grid, of a law that has the range of the grid.

use std::ops::ControlFlow;

use super::fitted::{COST, PULL_OFF};
use super::goal::{FIRST, is_refinable, on_coarse, on_twice};
use super::refine::{overshoots, refined, twice};
use super::{Accuracy, GridError, NoEstimate, adhesion, observed_order};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::constraint::ContactConstraint;
use crate::contact::ContactArea;
use crate::elastic::{Boundary, OnGrids};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::nested::{GridObserver, coarsened};
use crate::problem::Problem;
use crate::pull_off::{FoundPullOff, PullOff};
use crate::real::{Real, once};
use crate::solver::{Iteration, Solver, Start, Status};
use crate::surface::Surface;

once! {
    /// A search for a pull-off to an accuracy.
    refine<'a, T>(
        accuracy: &'a Accuracy, solver: &'a mut Solver<dyn ContactConstraint<T>>, surface: &'a Surface,
        operators: &'a mut dyn OnGrids<T>,
        law: &'a SharedLaw<T>, search: PullOff, observe: GridObserver<'a>,
    ) -> Result<AccuratePullOff<T>> = Accuracy::refine_pull_off;
}

/// The width of the bracket of a search, as a share of the accuracy.
const BRACKET: f64 = 0.2;

/// The pull-off on the finest of some grids, and the estimated error of its limit.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct AccuratePullOff<T: Real> {
    /// The search on the finest grid.
    pub found: FoundPullOff<T>,
    /// The surface on that grid.
    pub surface: Surface,
    /// The nodes (Nx, Ny) of each grid, the finest last, with the greatest tension and the [limit](FoundPullOff::limit)
    /// that it tells, pressures.
    pub levels: Vec<((usize, usize), [f64; 2])>,
    /// The pull-off in the limit of no range, a pressure, if its error is known: of tension and limit on the finest level
    /// the one that changed less from the grid before.
    pub limit: Option<f64>,
    /// The estimated error of the limit, with the width of its bracket, or the reason why it is not told.
    pub error: std::result::Result<GridError, NoEstimate>,
    /// Whether the estimate meets the accuracy.
    pub reached: bool,
    /// Whether the surface and the law are known on finer grids, as in [`AccurateSolution`](super::AccurateSolution).
    pub refinable: bool,
    /// The next finer grid and its memory in bytes, if that was too much.
    pub unaffordable: Option<((usize, usize), f64)>,
}

impl<T: Real> FoundPullOff<T> {
    /// The pull-off in the limit of no range, a pressure, that a state under the greatest tension tells on its grid: the
    /// tension less the share of the process zone in its adhesive energy. None for a law with a range, without a
    /// tension, and for a periodic cell with more than three quarters in contact by A_E: closed surfaces have no flaw
    /// from which to peel, and their pull-off grows as 1/√Δx.
    ///
    /// ```math
    /// T = T_grid · A/A_E ,   A_E = −E_adh/w ,   A = A_E − 0.16 S Δx
    /// ```
    ///
    /// At steps of the surface A is another, as [`ContactArea::jkr_contact_fraction`] says.
    ///
    /// # Errors
    /// As [`ContactArea::of_solution`].
    pub fn limit(&self) -> Result<Option<f64>> {
        let report = &self.solution.report;
        let (tension, by_energy) = (-report.mean_pressure, report.adhesive_contact_fraction);
        let area = ContactArea::of_solution(&self.solution)?.jkr_contact_fraction;
        let is_closed = self.closed_share().is_some_and(|share| share > PULL_OFF.closed);
        let share = area.zip(by_energy).filter(|_| !is_closed).map(|(area, by_energy)| area / by_energy);
        Ok(share.filter(|share| tension > 0.0 && share.is_finite()).map(|share| share * tension))
    }
}

impl Accuracy {
    /// The pull-off to the accuracy, if it can be had; an infinite accuracy asks for the error on the given grid alone.
    ///
    /// The given grid and one of half as many nodes along the sides are searched. As long as the estimated error of the
    /// [limit](AccuratePullOff::limit) exceeds the accuracy, the surface is put on twice as many nodes, as by
    /// [`Accuracy::solve`]. With a law that has a range of its own the given grid alone is searched, without an estimate.
    /// [`NoEstimate`] has the reasons for which two grids tell none.
    ///
    /// # Errors
    /// [`Error::Unsuited`] for an accuracy with a law that has a range; [`Error::Value`] for one that is not positive;
    /// errors of `operators` and of [`PullOff::find`].
    ///
    /// ```
    /// use asperity::accuracy::{Accuracy, Quantity};
    /// use asperity::{Boussinesq, Grid, Jkr, PullOff, Solver, Surface, exact, exact::Sphere};
    /// let sphere = Surface::paraboloid(Grid::square(64, 1.6)?, 1.0)?;
    /// let half_space = |grid| Boussinesq::<f64>::new(grid, 1.0);
    /// let (told, law) = (Accuracy::new(f64::INFINITY, Quantity::Area), Jkr::new(2e-3)?);
    /// let found = told.pull_off(&mut Solver::default(), &sphere, half_space, law, &PullOff::default())?;
    /// let force = found.limit.unwrap() * 1.6 * 1.6;
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
    /// As [`Accuracy::pull_off`].
    pub fn pull_off_observed<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        mut operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        search: &PullOff,
        mut observe: impl FnMut(&Grid, &Iteration) -> ControlFlow<()> + Send,
    ) -> Result<AccuratePullOff<T>> {
        refine(self, solver, surface, &mut operators, &SharedLaw::new(law), *search, &mut observe)
    }

    fn refine_pull_off<T: Real>(
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
        let mut searches = Searches { solver, operators, observe, search, tensions: Vec::new() };
        let mut levels = Vec::new();
        if hints.takes_range_of_grid() {
            levels = searches.on_coarser_grids(surface, law, self.nested.coarsest.max(FIRST))?;
        }
        let (mut surface, mut law) = (surface.clone(), law.clone());
        let mut refinable = is_refinable(&surface, &*law);
        loop {
            let Searched { found, level, nodes, boundary } = searches.find(&surface, law.clone())?;
            searches.tensions.push(-found.solution.report.mean_pressure);
            let shape = twice(surface.grid().shape());
            let growth = (shape.0 * shape.1) as f64 / surface.grid().nodes() as f64;
            let bytes = |doubled: i32| 8.0 * COST.numbers * nodes as f64 * growth.powi(doubled);
            let few = found.few_nodes(&surface).filter(|_| hints.of_grid && level.is_some());
            let few = few.map(|(nodes, finer)| too_few(&surface, nodes, finer, bytes));
            levels.extend(level.filter(|_| few.is_none()));
            let waves = surface.nodes_per_wave(boundary);
            let told = (level.is_some(), waves, of_many_waves(&surface, &found, waves));
            let error = few.map_or_else(|| error(&found, &levels, hints.of_grid, told), Err);
            let limit = error.ok().map(|_| limits(&levels)[0]);
            let stopped = found.solution.report.status == Status::Stopped;
            let ended = error.map_or_else(|error| error.stays() || stopped, |error| error.relative <= self.target);
            let reached = !refines || error.is_ok() && ended;
            let ends = reached || ended || !refinable || bytes(1) > self.memory;
            let fine = if ends { None } else { Some(refined(&surface, boundary.is_periodic())?) };
            refinable &= !fine.as_ref().is_some_and(|fine| overshoots(fine, &surface));
            let Some(fine) = fine.filter(|_| refinable) else {
                let too_large = !reached && !ended && refinable && bytes(1) > self.memory;
                let unaffordable = too_large.then_some((shape, bytes(1)));
                return Ok(AccuratePullOff { found, surface, levels, limit, error, reached, refinable, unaffordable });
            };
            law = on_twice(law, &surface, &fine);
            surface = fine;
        }
    }
}

/// Searches on grids from coarse to fine.
struct Searches<'a, 'b, T: Real> {
    solver: &'a mut Solver<dyn ContactConstraint<T>>,
    operators: &'a mut dyn OnGrids<T>,
    observe: GridObserver<'b>,
    search: PullOff,
    /// The pull-offs on the coarser grids.
    tensions: Vec<f64>,
}

/// The nodes (Nx, Ny) of a grid, with the greatest tension and the limit that it tells.
type PullOffLevel = ((usize, usize), [f64; 2]);

/// A search on a grid, with the nodes and the boundary of the operator.
struct Searched<T: Real> {
    found: FoundPullOff<T>,
    level: Option<PullOffLevel>,
    nodes: usize,
    boundary: Boundary,
}

impl<T: Real> Searches<'_, '_, T> {
    fn find(&mut self, surface: &Surface, law: SharedLaw<T>) -> Result<Searched<T>> {
        let expected = expected_on_finer(&self.tensions, self.search.tolerance);
        let search = self.search.expected(expected.or(self.search.expected));
        let grid = *surface.grid();
        let mut problem = Problem::of(surface, self.operators.on(grid)?, law)?;
        let observe = |state: &Iteration| (self.observe)(&grid, state);
        let found = search.find_from(self.solver, &mut problem, Start::Default, observe)?;
        let tension = -found.solution.report.mean_pressure;
        let level = found.limit()?.map(|limit| (grid.shape(), [tension, limit]));
        let (nodes, boundary) = (problem.operator.grid().nodes(), problem.operator.boundary());
        Ok(Searched { found, level, nodes, boundary })
    }

    /// The level of the grid of half as many nodes along the sides, if it tells a pull-off, after searches on coarser ones.
    fn on_coarser_grids(&mut self, surface: &Surface, law: &SharedLaw<T>, least: usize) -> Result<Vec<PullOffLevel>> {
        let mut last = None;
        for coarse in coarsened(surface, least, law.hints().shape.is_none())?.iter().rev() {
            // what cannot be found there, or is of a few nodes, says nothing of the finer grid
            let searched = self.find(coarse, on_coarse(law, surface, coarse)).ok();
            last = None;
            let Some(Searched { found, level, .. }) = searched.filter(|searched| searched.found.reached) else {
                continue;
            };
            // closed surfaces hold roughly where they do not hold
            if found.closed_share().is_none_or(|share| share <= PULL_OFF.nearly_closed) {
                self.tensions.push(-found.solution.report.mean_pressure);
            }
            last = level.filter(|_| 4.0 * found.bearing_nodes() >= PULL_OFF.nodes);
        }
        Ok(last.into_iter().collect())
    }
}

/// So few nodes bear the pull-off, on a grid that has to be so many times finer.
fn too_few(surface: &Surface, nodes: f64, finer: f64, bytes: impl Fn(i32) -> f64) -> NoEstimate {
    let doubled = finer.log2().ceil() as i32;
    let needed = (0..doubled).fold(surface.grid().shape(), |shape, _| twice(shape));
    NoEstimate::FewNodes { nodes, needed, bytes: bytes(doubled) }
}

/// The tensions between which the pull-off on the next finer grid is expected, from the pull-offs on coarser grids:
/// it changes by as much as from grid to grid before, or by half as much.
fn expected_on_finer(tensions: &[f64], tolerance: f64) -> Option<[f64; 2]> {
    let (fine, change) = match *tensions {
        [.., coarse, fine] => (fine, (fine / coarse).clamp(0.5, 2.0)),
        [fine] => (fine, PULL_OFF.change),
        [] => return None,
    };
    let [least, most] = [change.min(change.sqrt()), change.max(change.sqrt())].map(|change| change * fine);
    Some([least * (1.0 - 0.5 * tolerance), most * (1.0 + 0.5 * tolerance)]).filter(|_| fine > 0.0)
}

/// The pull-off in the limit of no range on each of some levels, the finest first: of the tension and of the limit that it
/// tells the one that changed less to the finest level.
fn limits(levels: &[((usize, usize), [f64; 2])]) -> Vec<f64> {
    let change = |of: usize| match levels {
        [.., (_, coarse), (_, fine)] => (fine[of] / coarse[of] - 1.0).abs(),
        _ => 1.0 - of as f64,
    };
    let of = usize::from(change(1) <= change(0));
    levels.iter().rev().map(|(_, found)| found[of]).collect()
}

/// The adhesion of a rough surface in a periodic cell; zero of surfaces of a few waves.
fn of_many_waves<T: Real>(surface: &Surface, found: &FoundPullOff<T>, nodes_per_wave: f64) -> f64 {
    let ((lx, ly), (nx, ny), report) = (surface.grid().lengths(), surface.grid().shape(), &found.solution.report);
    let side = if nx == 1 {
        ly
    } else if ny == 1 {
        lx
    } else {
        lx.min(ly)
    };
    let few = side < PULL_OFF.few_waves * nodes_per_wave * surface.grid().largest_spacing();
    if few || report.approach.is_some() {
        return 0.0;
    }
    adhesion(surface, nodes_per_wave, report.work_of_adhesion / report.modulus)
}

/// The error of the limit on the finest of the levels.
fn error<T: Real>(
    found: &FoundPullOff<T>,
    levels: &[((usize, usize), [f64; 2])],
    of_grid: bool,
    (is_known, nodes_per_wave, adhesion): (bool, f64, f64),
) -> std::result::Result<GridError, NoEstimate> {
    if !of_grid {
        return Err(NoEstimate::Range);
    }
    if !found.reached {
        return Err(NoEstimate::Unreached);
    }
    if let Some(share) = found.closed_share().filter(|share| *share > PULL_OFF.nearly_closed) {
        return Err(NoEstimate::Closed(share));
    }
    if adhesion > PULL_OFF.strong {
        return Err(NoEstimate::Strong(adhesion));
    }
    if found.solution.report.reaches_edge {
        return Err(NoEstimate::Edge);
    }
    if nodes_per_wave < 2.0 * GridError::LEAST_NODES_PER_WAVE {
        return Err(NoEstimate::Waves(nodes_per_wave));
    }
    let limits = limits(levels);
    let (&[limit, coarse, ..], Some((_, [tension, of_zone]))) = (&limits[..], levels.last().filter(|_| is_known))
    else {
        return Err(NoEstimate::OneGrid);
    };
    if limit > PULL_OFF.growth * coarse {
        return Err(NoEstimate::Growth(limit / coarse));
    }
    let bracket = found.lost.map_or(0.0, |lost| lost - tension);
    let (zone, difference) = (PULL_OFF.zone * (tension - of_zone), PULL_OFF.difference * (limit - coarse));
    let of_grid = zone.hypot(difference) * (1.0 + PULL_OFF.adhesion * adhesion);
    Ok(GridError { relative: (of_grid + bracket) / limit, order: observed_order(&limits), rough: false })
}
