//! Nested grids: solutions on coarser grids as starts on finer ones.

use std::borrow::Borrow;
use std::ops::ControlFlow;

use crate::adhesion::{AdhesionLaw, Discretisation, Jkr, NoAdhesion, SharedLaw, Weakened, mu_rho};
use crate::constraint::ContactConstraint;
use crate::degrees::HALF;
use crate::elastic::OnGrids;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::problem::{Control, Held, Problem, ProblemMut};
use crate::real::{Real, once};
use crate::setters::setters;
use crate::solver::{Begin, Branch, Iteration, Method, Report, Settings, Solution, Solved, Solver, Start, Status};
use crate::stability::ContactStiffness;
use crate::surface::Surface;

mod hierarchy;
mod level;
mod part;
mod transfer;

pub(crate) use hierarchy::coarsened;
use hierarchy::coarser;
pub use level::Level;
pub(crate) use level::equivalent_applications;
pub(crate) use transfer::{Deformed, Touching};

once! {
    /// A solve on nested grids.
    nested<'a, T>(
        nested: &'a Nested, solver: &'a mut Solver<dyn ContactConstraint<T>>, heights: Heights<'a>,
        operators: &'a mut dyn OnGrids<T>,
        law: &'a SharedLaw<T>, control: Control, observe: GridObserver<'a>,
    ) -> Result<(Solved<T>, Vec<Level>)> = Nested::run;
}

/// The observer of iterations on some grid, which may stop a solve.
pub(crate) type GridObserver<'a> = &'a mut (dyn FnMut(&Grid, &Iteration) -> ControlFlow<()> + Send);

/// A surface that is lent, or handed over.
pub(crate) type Heights<'a> = Box<dyn Borrow<Surface> + 'a>;

/// The least number of nodes for which nested grids pay at a given load or approach, and at a given mean gap.
const PAYS: (usize, usize) = (1 << 16, 1 << 18);

/// The share of the work of adhesion with which the grid of half as many nodes leads to the finest one, and the grid before
/// it to that one; the wall alone leads to others. The area of contact exceeds the area of the limit by the process zone,
/// which is longer on coarser grids, and what has touched too early sticks.
const WEAKER: [f64; 2] = [0.9, 0.5];

/// The greatest [`Problem::mu_rho`] of a finest grid that coarser ones lead to on loading: it hardly resolves the
/// adhesion. On a grid with 1.2, areas of contact are up to 17 % beyond the loading branch.
const HARDLY_RESOLVED: f64 = 1.05;

/// Nested grids: solutions on coarser grids, each the start on the next finer one.
///
/// A coarser grid has every second node of the finer one along each side with more than one, and their heights; of an
/// odd number n it has (n + 1)/2, with heights by cubic interpolation. Its displacement g + h is prolonged by cubic
/// interpolation; the edge of contact follows from the gaps of the next two nodes, which open with the power 3/2 of the
/// distance. On the finest grid [`Solver`] has iteration, certificate and tolerance.
///
/// Sizes are halved while both sides keep `coarsest` nodes; with [absent nodes](Surface::with_absent) or a law that
/// [varies](crate::adhesion::Varying), while they are even. A coarser grid that does not resolve the adhesion
/// ([`Problem::mu_rho`] above 0.5) would pin the contact on another branch: there [`Jkr`] of the same work of adhesion,
/// with a range set by the grid, takes the place of a law with a range, if the finest grid resolves that one, or on
/// loading hardly does (μ_ρ up to 1). Otherwise, and of a law that varies or without a rigid wall, only grids that
/// resolve the law are used. On loading, a law that the finest grid does not resolve, and one without a range, leads from
/// grid to grid with a smaller work of adhesion, so that a finer grid does not keep patches that touch on coarser ones
/// alone; each coarser grid then has the law itself for its own figures. A law that jumps is
/// [smoothed](crate::adhesion::Discretisation::Smooth) on coarser grids, and on the finest on its way from there.
///
/// The finest grid starts anew, by [`Start::Default`], where the coarsest one is nearly [`closed`](Self::closed), a
/// coarser one does not carry its load, or the solve from the prolonged start has come apart or stalled above the
/// coarse tolerance.
///
/// On a free half-space a part of the window that holds all contact and attraction of the start, on half of the nodes
/// or fewer with a margin, is solved first, as a window of its own, and the whole from the deformation by its pressure.
///
/// [`Nested::pays`] says where nested grids are faster. A node of the finest grid takes the memory of a solve on this
/// grid alone; a surface that is handed over, and not lent, leaves before the solve on the finest grid.
///
/// ```
/// use asperity::{Control, Grid, Nested, NoAdhesion, SelfAffine, Solver, Status, Westergaard};
/// let grid = Grid::square(256, 1.0)?;
/// let surface = SelfAffine::default().k_s(32.0).surface(grid)?;
/// let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
/// let (mut solver, load) = (Solver::default(), Control::MeanPressure(0.01));
/// let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, load)?;
/// assert_eq!(nested.solution.report.status, Status::Converged);
/// assert_eq!(nested.levels.len(), 3); // 64², 128², 256²
/// assert!(nested.equivalent_applications() < 40.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nested {
    /// The tolerance on coarser grids, or the solver's if larger. Default 1e-2, below their discretisation error.
    pub coarse_tolerance: f64,
    /// The least number of nodes along a side of a coarser grid. Default 64.
    pub coarsest: usize,
    /// The relative error to which the contact stiffness of each grid is found; `None`, the default, finds none.
    pub stiffness: Option<f64>,
    /// The share of contact of the coarsest grid, less what has yielded, above which only the finest one follows.
    /// Default 0.8, above which nothing is gained. With 1 all grids are solved, as
    /// [`GridError`](crate::accuracy::GridError) needs.
    pub closed: f64,
}

/// The solution on the finest of nested grids, and the grids before it.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct NestedSolution<T: Real> {
    /// The solution; its report counts the finest grid alone.
    pub solution: Solution<T>,
    /// The grids, the finest last.
    pub levels: Vec<Level>,
}

impl<T: Real> NestedSolution<T> {
    /// All operator applications in units of one on the finest grid, the construction of the problems included.
    pub fn equivalent_applications(&self) -> f64 {
        equivalent_applications(&self.levels)
    }
}

impl Default for Nested {
    fn default() -> Self {
        Self { coarse_tolerance: 1e-2, coarsest: 64, stiffness: None, closed: 0.8 }
    }
}

impl Nested {
    setters! { coarse_tolerance: f64, coarsest: usize, stiffness: impl Into<Option<f64>>, closed: f64 }

    /// Whether nested grids are the faster way to the same equilibrium, as measured
    /// ([`performance`](crate::guide::performance)): at a given load or approach from 256² nodes on, at a given mean
    /// gap from 512², if there is a coarser grid.
    ///
    /// Not with adhesion under a tension or with a spring, where there may be several equilibria, nor, with [`Jkr`], under
    /// no load, at a given approach, or on a branch that [`Settings::branch`](crate::Settings::branch) names, but for loading
    /// under a load that presses; nor with [absent nodes](Surface::with_absent), a law that
    /// [varies](crate::adhesion::Varying), or [`Method::Rey2017`], where it was not measured.
    pub fn pays<T: Real>(
        &self,
        settings: &Settings,
        surface: &Surface,
        law: &dyn AdhesionLaw<T>,
        control: Control,
    ) -> bool {
        let (shape, nodes) = (surface.grid().shape(), surface.grid().nodes());
        let hints = law.hints();
        let longer = hints.takes_range_of_grid();
        let (held, load) = (control.holds(), control.value());
        let presses = held == Held::Load && load > 0.0;
        let comes_from_afar = presses && settings.branch == Some(Branch::Loading) && hints.touches();
        let least = match held {
            _ if longer && settings.branch.is_some() && !comes_from_afar => return false,
            Held::MeanGap => PAYS.1,
            Held::Approach if !longer => PAYS.0,
            Held::Load if hints.zero || presses || (load == 0.0 && !longer) => PAYS.0,
            Held::Spring(_) if hints.zero => PAYS.0,
            _ => return false,
        };
        let measured = surface.absent().is_none() && hints.shape.is_none();
        let method = settings.method == Method::Preconditioned;
        measured && method && nodes >= least && coarser(shape, self.coarsest, true).is_some()
    }

    /// Solves the contact of `surface` with the elastic body that has `operators` on each grid, the coarsest
    /// first, and with a free boundary on one of the same spacing for a part of the window.
    ///
    /// # Errors
    /// Errors of `operators`, [`Problem::new`] and [`Solver::solve_with`]; [`Error::Value`] if the coarse tolerance is
    /// not positive.
    pub fn solve<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: impl Borrow<Surface>,
        operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        control: Control,
    ) -> Result<NestedSolution<T>> {
        self.solve_observed(solver, surface, operators, law, control, |_, _| ControlFlow::Continue(()))
    }

    /// Solves as [`Nested::solve`], and calls `observe` in every iteration, with the grid, or the whole one for a part.
    /// Where it stops a solve, the finer grids end with their first iteration.
    ///
    /// # Errors
    /// As [`Nested::solve`].
    pub fn solve_observed<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: impl Borrow<Surface>,
        mut operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        control: Control,
        mut observe: impl FnMut(&Grid, &Iteration) -> ControlFlow<()> + Send,
    ) -> Result<NestedSolution<T>> {
        let law = SharedLaw::new(law);
        let (Solved { solution, .. }, levels) =
            nested(self, solver, Box::new(surface), &mut operators, &law, control, &mut observe)?;
        Ok(NestedSolution { solution, levels })
    }

    /// As [`Nested::solve_observed`], with the gap on the operator's grid.
    pub(crate) fn run<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        heights: Heights<'_>,
        operators: &mut dyn OnGrids<T>,
        law: &SharedLaw<T>,
        control: Control,
        observe: GridObserver<'_>,
    ) -> Result<(Solved<T>, Vec<Level>)> {
        Error::positive("coarse tolerance", self.coarse_tolerance)?;
        let surface: &Surface = (*heights).borrow();
        let finest = *surface.grid();
        let mut stopped = false;
        let mut watch = |grid: &Grid, iteration: &Iteration| {
            stopped = stopped || observe(grid, iteration).is_break();
            if stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let (mut levels, coarser) = self.solve_coarser(solver, surface, operators, law, control, &mut watch)?;
        let mut half_space = operators.on(finest)?;
        let wall = solver.constraint.wall();
        let (rigid, touching) = (wall.is_rigid(), Touching::new(wall, &**law));
        let prolonged = coarser.map(|coarser| coarser.prolonged(surface, half_space.grid(), touching));
        let started = prolonged.is_some();
        let mut watch = |iteration: &Iteration| watch(&finest, iteration);
        let part = match &prolonged {
            Some(gap) if rigid => {
                part::solve_part(solver, surface, (&mut *half_space, operators), law, control, gap, &mut watch)?
            }
            _ => None,
        };
        let unique = law.hints().zero;
        let mut problem = Problem::of(surface, half_space, law.clone())?;
        drop(heights);
        let mut spent = part.as_ref().map_or(0, |part| part.applications);
        let (default, branch) = (Begin::At(Start::Default), default_branch(solver, &problem, control)?);
        let begin = match (part.filter(|part| part.leads(unique)), prolonged) {
            (Some(part), _) => {
                spent += 1;
                Begin::Found(part.whole(problem.parts())?.into())
            }
            (None, Some(prolonged)) => Begin::Prolonged(prolonged),
            (None, None) => default,
        };
        let mut solved = solver.run(problem.parts(), control, begin, &mut watch)?;
        if started && self.has_lost(&solved.solution.report) {
            spent += solved.solution.report.operator_applications;
            drop(solved);
            solved = solver.run(problem.parts(), control, Begin::At(Start::Default), &mut watch)?;
        }
        solved.solution.report.branch = branch;
        let stiffness = self.stiffness_of(solver, &mut problem, &solved.solution)?;
        let level = Level::of(&solved.solution)?;
        let operator_applications = level.operator_applications + spent;
        levels.push(Level { operator_applications, stiffness, ..level });
        Ok((solved, levels))
    }

    /// Whether a solve from a coarser grid is of no use.
    fn has_lost(&self, report: &Report) -> bool {
        match report.status {
            // at the floor of rounding another start would stall as well
            Status::Stalled => report.relative_error.max(report.load_error) > self.coarse_tolerance,
            status => status == Status::Detached,
        }
    }

    fn solve_coarser<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operators: &mut dyn OnGrids<T>,
        law: &SharedLaw<T>,
        control: Control,
        watch: GridObserver<'_>,
    ) -> Result<(Vec<Level>, Option<Deformed<T>>)> {
        let (varies, wall) = (law.hints().shape.is_some(), solver.constraint.wall());
        let (rigid, touching) = (wall.is_rigid(), Touching::new(wall, &**law));
        let tolerance = self.coarse_tolerance.max(solver.settings.tolerance_in::<T>());
        let (mut levels, mut coarser): (Vec<Level>, Option<Deformed<T>>) = (Vec::new(), None);
        let mut surfaces = coarsened(surface, self.coarsest, !varies)?;
        while let Some(coarse) = surfaces.pop() {
            let half_space = operators.on(*coarse.grid())?;
            let grids = [coarse.grid(), surface.grid()];
            let Some(coarse_law) = coarsened_law(law, grids, half_space.modulus(), rigid)? else { continue };
            let is_resolved = mu_rho(&**law, surface.grid(), half_space.modulus()) <= Report::RESOLVED_MU_RHO;
            let mut problem = Problem::of(&coarse, half_space, coarse_law)?;
            let loading = default_branch(solver, &problem, control)? == Some(Branch::Loading);
            if !is_resolved && !loading {
                break;
            }
            let prolonged = coarser.take().map(|coarser| coarser.prolonged(&coarse, problem.operator.grid(), touching));
            let mut begin = prolonged.map_or(Begin::At(Start::Default), Begin::Prolonged);
            let mut smoothed = false;
            let mut watch = |iteration: &Iteration| {
                let next = watch(coarse.grid(), iteration);
                // the equilibrium of the smoothed law is all that the next grid needs
                let done = smoothed && !iteration.smoothed;
                smoothed = iteration.smoothed;
                if done { ControlFlow::Break(()) } else { next }
            };
            let mut weaker = None;
            if loading && (!is_resolved || problem.law_on_grid().hints().touches()) {
                let solved = solver.to(tolerance, |solver| {
                    weaken(&mut problem, surfaces.len(), |parts| solver.run(parts, control, begin, &mut watch))
                })?;
                begin = Begin::Found(solved.place());
                weaker = Some(solved);
            }
            let Solved { solution, whole, .. } =
                solver.to(tolerance, |solver| solver.run(problem.parts(), control, begin, &mut watch))?;
            let stiffness = self.stiffness_of(solver, &mut problem, &solution)?;
            let level = Level::of(&solution)?;
            let spent = weaker.as_ref().map_or(0, |weaker| weaker.solution.report.operator_applications);
            levels.push(Level { stiffness, operator_applications: level.operator_applications + spent, ..level });
            let yielded = solution.report.plastic.map_or(0.0, |plastic| plastic.fraction);
            if levels.len() == 1 && levels[0].area.contact_fraction - yielded > self.closed {
                break;
            }
            let (leads, whole) = weaker.map_or((solution, whole), |weaker| (weaker.solution, weaker.whole));
            // a coarse grid that does not carry its load says nothing of a finer one
            if leads.report.load_error < HALF && leads.report.status != Status::Detached {
                coarser = Some(Deformed::new(&coarse, leads.gap, whole));
            }
        }
        Ok((levels, coarser))
    }

    pub(crate) fn stiffness_of<T: Real>(
        &self,
        solver: &Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        solution: &Solution<T>,
    ) -> Result<Option<ContactStiffness>> {
        let find = |tolerance| ContactStiffness::of_constrained(problem, &solver.constraint, solution, tolerance);
        self.stiffness.filter(|_| solution.report.status != Status::Stopped).map(find).transpose()
    }
}

/// The law on a coarse grid that leads to a finer one; none if it does not resolve the adhesion.
fn coarsened_law<T: Real>(
    law: &SharedLaw<T>,
    [coarse, fine]: [&Grid; 2],
    modulus: f64,
    rigid: bool,
) -> Result<Option<SharedLaw<T>>> {
    let mu_rho = |grid| mu_rho(&**law, grid, modulus);
    let ((nx, ny), (cx, cy), hints) = (fine.shape(), coarse.shape(), law.hints());
    if mu_rho(coarse) <= Report::RESOLVED_MU_RHO {
        let adapted = law.adapted(Discretisation::Coarse(nx / cx, ny / cy));
        return Ok(Some(adapted.map_or_else(|| law.clone(), SharedLaw)));
    }
    let alike = rigid && hints.shape.is_none() && mu_rho(fine) <= HARDLY_RESOLVED;
    let on_grid = || Jkr::with_range_of_grid(hints.work_of_adhesion.widen()).map(SharedLaw::new);
    alike.then(on_grid).transpose()
}

/// The branch of the default start of a problem.
fn default_branch<T: Real>(
    solver: &Solver<dyn ContactConstraint<T>>,
    problem: &Problem<T>,
    control: Control,
) -> Result<Option<Branch>> {
    let (wall, flat, begin) = (solver.constraint.wall(), &problem.flat, Begin::At(Start::Default));
    let load = flat.load(control, wall)?;
    Branch::of_start(&begin, &solver.settings, problem.law_on_grid(), (load, wall), flat)
}

/// Solves a problem with the share of its adhesion that leads to the finest grid, with so many grids in between.
fn weaken<T: Real, R>(problem: &mut Problem<T>, between: usize, solve: impl FnOnce(ProblemMut<'_, T>) -> R) -> R {
    let parts = problem.parts();
    match WEAKER.get(between) {
        None => solve(ProblemMut { law: &NoAdhesion, ..parts }),
        Some(&share) => solve(ProblemMut { law: &Weakened { law: parts.law, share: T::lit(share) }, ..parts }),
    }
}
