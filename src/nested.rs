//! Nested grids: solutions on coarser grids as starts on finer ones.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Projection};
use crate::contact::ContactArea;
use crate::elastic::{Boundary, ElasticOperator};
use crate::error::{Error, Result};
use crate::field::flat_mut;
use crate::grid::Grid;
use crate::par;
use crate::problem::{Control, Problem};
use crate::real::Real;
use crate::solver::{Iteration, Settings, Solution, Solver, Start, Status};
use crate::stability::ContactStiffness;
use crate::surface::Surface;

/// The resolution measure μ_ρ above which a coarse grid would pin the contact.
const RESOLVED: f64 = 0.5;

/// The relative load error at and above which a coarse solution is not used as a start.
const CARRIED: f64 = 0.5;

/// Nested grids: solutions on coarser grids, each the start on the next finer one.
///
/// A coarser grid has every second node of the finer one, along both sides (along x on a line); its heights are those
/// of its nodes. Its solution is prolonged by cubic interpolation of the displacement g + h; nodes between nodes in
/// contact are in contact. On the finest grid the iteration, the certificate and the tolerance are those of
/// [`Solver`].
///
/// Sizes are halved while they are even and both sides keep `coarsest` nodes; an odd size has no coarser grid. With
/// adhesion only grids that resolve it ([`Problem::mu_rho`] up to 0.5) are used, as a coarser one may pin the
/// contact on another branch. If the traction of the law jumps, the coarser grids [smooth](AdhesionLaw::smoothed) it,
/// and so does the finest one on its way from their solution, as it does from the default start. Without a coarser
/// grid all is as with [`Solver::solve`].
///
/// Memory per node of the finest grid: no more than a solve on that grid alone, five scalars in `f64` and seven in `f32` with
/// [`Westergaard`](crate::Westergaard); the start from the coarser grid becomes one of them.
///
/// ```
/// use asperity::{Control, Grid, Nested, NoAdhesion, SelfAffine, Status, Westergaard};
/// let grid = Grid::square(256, 1.0)?;
/// let surface = SelfAffine { k_s: 32.0, ..SelfAffine::default() }.surface(grid)?;
/// let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
/// let nested = Nested::default().solve(&surface, half_space, NoAdhesion, Control::MeanPressure(0.01))?;
/// assert_eq!(nested.solution.report.status, Status::Converged);
/// assert_eq!(nested.levels.len(), 3); // 64², 128², 256²
/// assert!(nested.equivalent_applications() < 40.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Nested<C = Projection> {
    /// The solver of all grids; its tolerance is that of the finest.
    pub solver: Solver<C>,
    /// The tolerance on the coarser grids, or that of the solver if it is larger. Default 1e-2, which is below the
    /// discretisation error of a coarser grid.
    pub coarse_tolerance: f64,
    /// The least number of nodes along a side of a coarser grid. Default 64.
    pub coarsest: usize,
    /// The relative error to which the contact stiffness of each grid is found; `None`, the default, finds none.
    pub stiffness: Option<f64>,
}

/// The cost of the solve on one of the nested grids, and what it found there.
///
/// The figures of a coarser grid are those of its solution to the coarse tolerance; how good it is says its relative error.
/// [`NestedSolution`] has an example.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// The nodes (Nx, Ny) of the grid.
    pub shape: (usize, usize),
    /// The status: how the solve ended.
    pub status: Status,
    /// The number of steps.
    pub iterations: usize,
    /// The number of operator applications, with the one that constructs the problem.
    pub operator_applications: usize,
    /// The certified relative error, [`Report::relative_error`](crate::Report::relative_error).
    pub relative_error: f64,
    /// The mean gap, [`Report::mean_gap`](crate::Report::mean_gap).
    pub mean_gap: f64,
    /// The mean external pressure, [`Report::mean_pressure`](crate::Report::mean_pressure).
    pub mean_pressure: f64,
    /// The mean contact pressure, [`Report::mean_contact_pressure`](crate::Report::mean_contact_pressure).
    pub mean_contact_pressure: f64,
    /// The elastic energy per area, [`Report::elastic_energy`](crate::Report::elastic_energy).
    pub elastic_energy: f64,
    /// The contact area, as nodes count it and corrected.
    pub area: ContactArea,
    /// The contact stiffness, if [`Nested::stiffness`] asks for it.
    pub stiffness: Option<ContactStiffness>,
}

impl Level {
    /// The level of a solution on its grid.
    pub(crate) fn of<T: Real>(solution: &Solution<T>, grid: &Grid) -> Result<Self> {
        let report = &solution.report;
        Ok(Self {
            shape: grid.shape(),
            status: report.status,
            iterations: report.iterations,
            operator_applications: report.operator_applications + 1,
            relative_error: report.relative_error,
            mean_gap: report.mean_gap,
            mean_pressure: report.mean_pressure,
            mean_contact_pressure: report.mean_contact_pressure,
            elastic_energy: report.elastic_energy,
            area: ContactArea::of_solution(solution, solution.contact_map().view(), grid)?,
            stiffness: None,
        })
    }
}

/// The solution on the finest of nested grids.
///
/// ```
/// use asperity::{Control, Grid, Nested, NoAdhesion, Surface, Westergaard};
/// let surface = Surface::wave_2d(Grid::square(128, 1.0)?, 0.02, 2)?;
/// let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
/// let nested = Nested::default().solve(&surface, half_space, NoAdhesion, Control::MeanPressure(0.01))?;
/// for level in &nested.levels {
///     println!("{:?}: {}, {} applications", level.shape, level.status, level.operator_applications);
/// }
/// assert_eq!(nested.levels[0].shape, (64, 64));
/// assert_eq!(nested.solution.gap.dim(), (128, 128));
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct NestedSolution<T> {
    /// The solution; its report counts the finest grid alone.
    pub solution: Solution<T>,
    /// The grids, the finest last.
    pub levels: Vec<Level>,
}

impl<T> NestedSolution<T> {
    /// All operator applications in units of one on the finest grid, those that construct the problems included: one
    /// on a grid with a quarter of the nodes counts as a quarter.
    pub fn equivalent_applications(&self) -> f64 {
        let nodes = |level: &Level| (level.shape.0 * level.shape.1) as f64;
        let finest = self.levels.last().map_or(1.0, nodes);
        self.levels.iter().map(|level| level.operator_applications as f64 * nodes(level) / finest).sum()
    }
}

impl Nested {
    /// Nested grids for a solver that confines the gap to g ≥ 0 by projection.
    pub fn new(settings: Settings) -> Self {
        Self { solver: Solver::new(settings), coarse_tolerance: 1e-2, coarsest: 64, stiffness: None }
    }
}

impl Default for Nested {
    /// The default settings, and projection.
    fn default() -> Self {
        Self::new(Settings::default())
    }
}

impl<C> Nested<C> {
    /// Solves the contact of `surface` with the elastic body for which `operator` makes an operator on each grid.
    ///
    /// # Errors
    /// Those of `operator`, [`Problem::new`] and [`Solver::solve_with`]; [`Error::Value`] if the coarse tolerance is
    /// not positive.
    pub fn solve<T, O, L>(
        &mut self,
        surface: &Surface,
        operator: impl FnMut(Grid) -> Result<O>,
        law: L,
        control: Control,
    ) -> Result<NestedSolution<T>>
    where
        T: Real,
        O: ElasticOperator<T>,
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        self.solve_observed(surface, operator, law, control, |_, _| ControlFlow::Continue(()))
    }

    /// Solves as [`Nested::solve`], and calls `observe` with the grid in every iteration. Where it stops a solve, the
    /// finer grids end with their first iteration.
    ///
    /// # Errors
    /// Those of [`Nested::solve`].
    pub fn solve_observed<T, O, L>(
        &mut self,
        surface: &Surface,
        mut operator: impl FnMut(Grid) -> Result<O>,
        law: L,
        control: Control,
        mut observe: impl FnMut(&Grid, &Iteration) -> ControlFlow<()>,
    ) -> Result<NestedSolution<T>>
    where
        T: Real,
        O: ElasticOperator<T>,
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        Error::positive("coarse tolerance", self.coarse_tolerance)?;
        let settings = self.solver.settings;
        let strides = strides(surface.grid().shape(), self.coarsest);
        let (mut levels, mut start) = (Vec::new(), None);
        let mut stopped = false;
        for &stride in strides.iter().rev().filter(|&&stride| stride > (1, 1)) {
            let Some(coarse) = coarsen(surface, stride)? else { continue };
            let coarse_law = law.coarsened(stride).unwrap_or_else(|| Box::new(&law));
            let mut problem = Problem::new(&coarse, operator(*coarse.grid())?, coarse_law)?;
            if problem.mu_rho() > RESOLVED {
                continue;
            }
            let tolerance = self.coarse_tolerance.max(settings.tolerance_in::<T>());
            self.solver.settings = Settings { tolerance: Some(tolerance), ..settings };
            let mut smoothed = false;
            let begin = start.take().map_or(Start::Default, Start::Near);
            let result = self.solver.solve_with(&mut problem, control, begin, |iteration| {
                stopped = stopped || observe(coarse.grid(), iteration).is_break();
                // the equilibrium of the smoothed law is all that the next grid needs
                let done = smoothed && !iteration.smoothed;
                smoothed = iteration.smoothed;
                if stopped || done { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            self.solver.settings = settings;
            let solution = result?;
            let stiffness = self.stiffness_of(&mut problem, &solution)?;
            levels.push(Level { stiffness, ..Level::of(&solution, coarse.grid())? });
            let Solution { gap, report, .. } = solution;
            // a coarse grid that does not carry its load says nothing of a finer one
            if report.load_error < CARRIED {
                let finer = finer(&strides, stride);
                let rigid = self.solver.constraint.wall().is_rigid();
                start = Some(prolong(surface, finer, &coarse, &gap, (rigid, report.boundary == Boundary::Periodic)));
            }
        }
        let mut problem = Problem::new(surface, operator(*surface.grid())?, law)?;
        let begin = start.take().map_or(Start::Default, Start::Near);
        let solution = self.solver.solve_with(&mut problem, control, begin, |iteration| {
            stopped = stopped || observe(surface.grid(), iteration).is_break();
            if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        let stiffness = self.stiffness_of(&mut problem, &solution)?;
        levels.push(Level { stiffness, ..Level::of(&solution, surface.grid())? });
        Ok(NestedSolution { solution, levels })
    }
}

impl<C> Nested<C> {
    /// The contact stiffness of a solution, if it is asked for.
    pub(crate) fn stiffness_of<T, O, L>(
        &self,
        problem: &mut Problem<T, O, L>,
        solution: &Solution<T>,
    ) -> Result<Option<ContactStiffness>>
    where
        T: Real,
        O: ElasticOperator<T>,
        L: AdhesionLaw<T>,
        C: ContactConstraint<T>,
    {
        let find = |tolerance| ContactStiffness::of_constrained(problem, &self.solver.constraint, solution, tolerance);
        self.stiffness.map(find).transpose()
    }
}

/// The strides of all grids in nodes of the finest one along (x, y), the finest first.
fn strides((nx, ny): (usize, usize), coarsest: usize) -> Vec<(usize, usize)> {
    let coarsest = coarsest.max(4);
    let halves = |n: usize, stride: usize| n.is_multiple_of(2 * stride) && n / (2 * stride) >= coarsest;
    let mut all = vec![(1, 1)];
    let mut stride = (1, 1);
    while halves(nx, stride.0) && (ny == 1 || halves(ny, stride.1)) {
        stride = (2 * stride.0, if ny == 1 { 1 } else { 2 * stride.1 });
        all.push(stride);
    }
    all
}

/// The next finer grid.
fn finer(strides: &[(usize, usize)], stride: (usize, usize)) -> (usize, usize) {
    strides.iter().rev().copied().find(|finer| finer.0 < stride.0).unwrap_or((1, 1))
}

/// The surface on a coarser grid; nothing if all of its nodes are absent.
fn coarsen(surface: &Surface, (x, y): (usize, usize)) -> Result<Option<Surface>> {
    let (nx, ny) = surface.grid().shape();
    let grid = Grid::new((nx / x, ny / y), surface.grid().lengths())?;
    let faces = |i, j| surface.absent().is_none_or(|absent| !absent[[i, j]]);
    let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| match (i * x, j * y) {
        (i, j) if faces(i, j) => surface.heights()[[i, j]],
        _ => f64::NAN,
    });
    if heights.iter().all(|h| h.is_nan()) { Ok(None) } else { Surface::with_absent(grid, heights).map(Some) }
}

/// The gap prolonged to the next finer grid, which has every `stride`-th node of the surface.
pub(crate) fn prolong<T: Real>(
    surface: &Surface,
    stride: (usize, usize),
    coarse: &Surface,
    gap: &Array2<T>,
    (projects, periodic): (bool, bool),
) -> Array2<T> {
    let (cx, cy) = coarse.grid().shape();
    let (nx, ny) = surface.grid().shape();
    let shape = (nx / stride.0, ny / stride.1);
    // finer nodes for each coarse one
    let (rx, ry) = (shape.0 / cx, shape.1 / cy);
    // where nothing faces the half-space, a start need not be good
    let displacement = |i: usize, j: usize| {
        let gap = gap[[i, j]].widen();
        if gap.is_finite() { gap + coarse.heights()[[i, j]] } else { coarse.heights()[[i, j]] }
    };
    // the nodes from the one before on; beyond a free boundary the last one again
    let shifted = |i: usize, shift: usize, n: usize| match periodic {
        true => (i + n + shift - 1) % n,
        false => (i + shift).clamp(1, n) - 1,
    };
    // whether the interpolation has only nodes in contact about it
    let touches = |i: usize, j: usize| gap[[i, j]] <= T::zero();
    let mut fine = Array2::zeros(shape);
    par::for_each(par::chunks_mut(flat_mut(&mut fine), shape.1), |row, nodes| {
        let (i, between) = (row / rx, !row.is_multiple_of(rx));
        let at = |shift: usize| shifted(i, shift, cx);
        let (mut line, mut contact) = (vec![0.0; cy], vec![false; cy]);
        for j in 0..cy {
            let u = |shift: usize| displacement(at(shift), j);
            (line[j], contact[j]) = if between {
                (middle(u(0), u(1), u(2), u(3)), touches(i, j) && touches(at(2), j))
            } else {
                (u(1), touches(i, j))
            };
        }
        for (k, g) in nodes.iter_mut().enumerate() {
            let (j, next) = (k / ry, shifted(k / ry, 2, cy));
            let (u, contact) = if k.is_multiple_of(ry) {
                (line[j], contact[j])
            } else {
                let (before, after) = (shifted(j, 0, cy), shifted(j, 3, cy));
                (middle(line[before], line[j], line[next], line[after]), contact[j] && contact[next])
            };
            let apart = u - surface.heights()[[row * stride.0, k * stride.1]];
            *g = match projects {
                true if contact => T::zero(),
                true => T::lit(apart.max(0.0)),
                false => T::lit(apart),
            };
        }
    });
    fine
}

/// Half-way between the second and the third of four equidistant values, on the cubic through all four.
fn middle(a: f64, b: f64, c: f64, d: f64) -> f64 {
    (9.0 * (b + c) - (a + d)) / 16.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_sizes_are_halved() {
        let squares = |n| strides((n, n), 64).len();
        assert_eq!([64, 96, 127, 128, 192, 256, 1023, 1024, 1536].map(squares), [1, 1, 1, 2, 2, 3, 1, 5, 5]);
        assert_eq!(strides((512, 1), 64), [(1, 1), (2, 1), (4, 1), (8, 1)]);
        assert_eq!(strides((512, 192), 64), [(1, 1), (2, 2)]);
        assert_eq!(strides((512, 95), 64), [(1, 1)]);
    }

    #[test]
    fn a_wave_is_prolonged_to_fourth_order() {
        for shape in [(64, 64), (64, 32), (64, 1)] {
            let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
            let surface = Surface::wave(grid, 1e-3, 3).unwrap();
            let stride = (2, if shape.1 == 1 { 1 } else { 2 });
            let coarse = coarsen(&surface, stride).unwrap().unwrap();
            let wave = |grid: &Grid| {
                grid.sample(|x, y| 2.0 + (std::f64::consts::TAU * x).sin() * (std::f64::consts::TAU * y).cos())
            };
            let (gap, exact) = (wave(coarse.grid()) - coarse.heights(), wave(&grid) - surface.heights());
            let fine = prolong(&surface, (1, 1), &coarse, &gap, (true, true));
            // the error of the cubic in the middle, 3/128 of the fourth derivative, along both sides
            let spacing = std::f64::consts::TAU / 16.0;
            let worst = (&fine - &exact).iter().fold(0.0_f64, |worst, e| worst.max(e.abs()));
            assert!(worst < 2.1 * 3.0 / 128.0 * spacing.powi(4), "{worst}");
        }
    }

    #[test]
    fn nodes_between_nodes_in_contact_are_in_contact() {
        let grid = Grid::square(16, 1.0).unwrap();
        let surface = Surface::wave_2d(grid, 0.1, 3).unwrap();
        let coarse = coarsen(&surface, (2, 2)).unwrap().unwrap();
        let gap = Array2::from_shape_fn((8, 8), |(i, _)| if i < 4 { 0.0_f32 } else { 1.0 });
        let fine = prolong(&surface, (1, 1), &coarse, &gap, (true, true));
        assert!(fine.rows().into_iter().take(7).all(|row| row.iter().all(|&g| g == 0.0)));
        assert!(fine.rows().into_iter().skip(8).step_by(2).all(|row| row.iter().all(|&g| g > 0.0)));
    }
}
