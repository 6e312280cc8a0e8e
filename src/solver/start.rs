//! The start of a solve: its gap, its law, and their checks.

use ndarray::{Array2, ArrayRef2, CowArray, Ix2};

use super::Branch;
use super::potential::{Least, bounded};
use crate::adhesion::AdhesionLaw;
use crate::constraint::Wall;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::problem::{Load, PressedFlat, Window};
use crate::real::Real;

/// The start of a solve: the gap from which the energy is minimised.
///
/// A gap has the shape (Nx, Ny) of the surface, whatever it has at absent nodes, may be an array or a view in any
/// memory layout, and is scaled to the mean gap, if that is given. The start matters for the work, and with adhesion,
/// where there may be several equilibria, for the answer.
///
/// The solution in `f32` as a start near that in `f64`:
///
/// ```
/// use std::ops::ControlFlow;
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Start, Status, Surface, Westergaard};
/// let grid = Grid::square(128, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let (mut solver, control) = (Solver::default(), Control::MeanPressure(0.01));
/// let mut single = Problem::new(&surface, Westergaard::<f32>::new(grid, 1.0)?, NoAdhesion)?;
/// let near = solver.solve(&mut single, control)?.gap.mapv(f64::from);
/// let mut double = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = solver.solve_with(&mut double, control, Start::Near(near), |_| ControlFlow::Continue(()))?;
/// assert_eq!(solution.report.status, Status::Converged);
/// assert!(solution.report.relative_error < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, Default)]
pub enum Start<'a, T> {
    /// Without adhesion a uniform gap: the mean gap, if that is given, otherwise twice the rms height; with a free
    /// boundary the undeformed bodies that just touch. With adhesion the start of the [`Branch`] that
    /// [`Settings::branch`](crate::Settings::branch) names: the gap that the wall alone would leave, which is found
    /// first, within the same solve, or full contact, and at a given mean gap a uniform one. If the traction of the law
    /// jumps, as that of [`MaugisDugdale`](crate::MaugisDugdale) does, the equilibrium of the law with its jump
    /// [smoothed](crate::adhesion::Discretisation::Smooth) is found next and becomes the start, within the same solve.
    #[default]
    Default,
    /// A gap, as that of an equilibrium at another load. With adhesion it chooses the branch of the equilibrium that is
    /// found.
    From(&'a ArrayRef2<T>),
    /// The gap of the solution of the same problem in another precision or on another grid, which is not copied.
    ///
    /// The error of a near start is of short waves, so that the first steps are shorter than from a gap that is given
    /// by [`Start::From`], and the jumps of a law are smoothed on the way from it, as from the default start.
    /// [`Nested`](crate::Nested) starts each grid so.
    Near(Array2<T>),
}

/// Where a solve begins.
pub(crate) enum Begin<'a, T> {
    At(Start<'a, T>),
    /// At the default start on a branch, whatever the settings say.
    On(Branch),
    /// The gap of the solution on another grid, near as that of [`Start::Near`], but on the grid of the operator, with
    /// the nodes that face no surface.
    Prolonged(Array2<T>),
    /// The gap of the solution at another load, or of that on a part of the grid, on the grid of the operator as well.
    Found(Array2<T>),
}

impl<T> Begin<'_, T> {
    pub(crate) fn is_default(&self) -> bool {
        matches!(self, Self::At(Start::Default) | Self::On(_))
    }

    pub(super) fn is_near(&self) -> bool {
        matches!(self, Self::At(Start::Near(_)) | Self::Prolonged(_))
    }
}

/// The uniform gap from which a solve starts, if no other is given.
pub(super) fn uniform_start<T: Real>(law: &dyn AdhesionLaw<T>, flat: &PressedFlat<T>, load: Load) -> f64 {
    match load {
        Load::Gap(gap) => gap,
        _ if law.hints().zero => 2.0 * flat.rms_height,
        _ => law.hints().rest.map_or(0.0, T::widen),
    }
}

/// The gap that is given, if one is, as a start under a control on the operator's grid.
pub(super) fn given_start<T: Real>(
    begin: Begin<'_, T>,
    grid: &Grid,
    window: Option<&Window>,
    load: Load,
    projects: bool,
) -> Result<Option<Array2<T>>> {
    let (given, whole): (CowArray<'_, T, Ix2>, _) = match begin {
        Begin::At(Start::Default) | Begin::On(_) => return Ok(None),
        Begin::At(Start::From(gap)) => (gap.view().into(), false),
        Begin::At(Start::Near(gap)) => (gap.into(), false),
        Begin::Prolonged(gap) | Begin::Found(gap) => (gap.into(), true),
    };
    let start = match window {
        Some(window) if !whole => window.start(given.view())?.into(),
        _ => given,
    };
    grid.fits("starting gap", start.dim())?;
    grid.finite("starting gap", start.view())?;
    let confined = |node: usize| window.is_none_or(|window| window.faces(node));
    // without places, and without an end, the pass is several times as fast
    let some = projects && start.fold(false, |some, &gap| some | (gap < T::zero()));
    let mut nodes = start.iter().zip(grid.first_node()..);
    let find = || nodes.find(|&(&gap, node)| gap < T::zero() && confined(node));
    let negative = some.then(find).flatten().map_or(Ok(()), |(gap, _)| {
        let requirement = "zero or positive at every node";
        Err(Error::Value { name: "starting gap", value: gap.widen(), requirement })
    });
    grid.agreed(negative)?;
    let mut gap = if start.is_standard_layout() { start.into_owned() } else { start.as_standard_layout().into_owned() };
    if let Load::Gap(mean) = load {
        let present = grid.mean(gap.view(), T::widen);
        if grid.has(gap.iter().any(|&g| g < T::zero())) {
            // gaps of both signs may have hardly any mean
            gap.mapv_inplace(|g| g + T::lit(mean - present));
        } else if present > 0.0 {
            gap.mapv_inplace(|g| g * T::lit(mean / present));
        } else {
            gap.fill(T::lit(mean));
        }
    }
    Ok(Some(gap))
}

/// The gap as many steps beyond the last one of two as given, on the grid of the operator: no node that faces the
/// surface comes closer than it may in a step.
pub(crate) fn extrapolated<T: Real>(
    [before, last]: [&Array2<T>; 2],
    steps: f64,
    least: Least<T>,
    (window, grid): (Option<&Window>, Grid),
) -> Array2<T> {
    let (steps, mut next) = (T::lit(steps), last.clone());
    for ((gap, &before), node) in next.iter_mut().zip(before).zip(grid.first_node()..) {
        let wanted = *gap + steps * (*gap - before);
        let feasible = bounded(least, *gap, wanted);
        let free = wanted < feasible && window.is_some_and(|window| !window.faces(node));
        *gap = if free { wanted } else { feasible };
    }
    next
}

/// Refuses springs, where the energy of a solution has to be in its report.
pub(crate) fn refuse_springs<T: Real>(wall: Wall<'_, T>) -> Result<()> {
    let reason = "the energy of springs is not in the report of a solution, so that jumps could not be told from work: \
                  take a rigid wall (Projection), or NoWall with a law that repels";
    if let Wall::Springs(_) = wall { Err(Error::Wall { wall: "springs", reason }) } else { Ok(()) }
}

/// Refuses a law that is not made for a wall.
pub(crate) fn check_wall<T: Real>(law: &dyn AdhesionLaw<T>, wall: Wall<'_, T>) -> Result<()> {
    let (wall, reason) = match wall {
        Wall::None if law.hints().rest.is_none() => (
            "no wall",
            "the adhesion law does not repel at every node, so that nothing would keep the surfaces apart: choose a wall",
        ),
        Wall::Rigid | Wall::Springs(_) if !law.energy(T::zero()).is_finite() => (
            "a wall at zero gap",
            "the adhesion law has no bound there: solve it without a wall (NoWall), or cut it at its equilibrium \
             separation",
        ),
        _ => return Ok(()),
    };
    Err(Error::Wall { wall, reason })
}
