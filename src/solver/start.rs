//! The start of a solve.

use std::borrow::Cow;

use ndarray::{Array2, ArrayRef2, CowArray, Ix2};

use super::iterate::Iterate;
use super::minimisation::Nearness;
use super::place::Place;
use super::potential::{Least, bounded};
use super::{Branch, Method, Settings};
use crate::adhesion::{AdhesionLaw, Values};
use crate::constraint::Wall;
use crate::error::{Error, Result};
use crate::field::{CHUNK, Field, ordered, write};
use crate::grid::Grid;
use crate::par::{self, Parts};
use crate::problem::{Load, PressedFlat};
use crate::real::Real;

/// The start of a solve: the gap from which the energy is minimised.
///
/// A gap has the shape (Nx, Ny) of the surface, with any values at absent nodes and in any memory layout, and is scaled
/// to a mean gap that is given. The start matters for the work, and with adhesion for the equilibrium that is found.
///
/// The solution in `f32` as a start near the solution in `f64`:
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
/// let solution = solver.solve_with(&mut double, control, Start::Near(near), |state| {
///     println!("{} {:.1e}", state.iteration, state.relative_error);
///     ControlFlow::Continue(())
/// })?;
/// assert_eq!(solution.report.status, Status::Converged);
/// assert!(solution.report.relative_error < 1e-6);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, Default)]
pub enum Start<'a, T> {
    /// Without adhesion a uniform gap: the given mean gap, or twice the rms height; with a free boundary undeformed
    /// bodies that just touch. With adhesion the start of the [`Branch`] that
    /// [`Settings::branch`](crate::Settings::branch) names. A law that jumps, as
    /// [`MaugisDugdale`](crate::MaugisDugdale), is [smoothed](crate::adhesion::Discretisation::Smooth) first, and the
    /// equilibrium found then becomes the start, all within the same solve.
    #[default]
    Default,
    /// A gap, such as an equilibrium at another load. With adhesion the gap chooses the branch. The jumps of a law are
    /// smoothed on the way, as for a default start: else the grid holds the edges of contacts where they are, and a
    /// loop of such solves bears too much tension. So a start at an equilibrium of a law with jumps takes some
    /// iterations, and may end at another equilibrium.
    From(&'a ArrayRef2<T>),
    /// The gap of the solution of the same problem in another precision or on another grid, which is not copied. Its
    /// error is of short waves: the first steps are shorter than with [`Start::From`]. [`Nested`](crate::Nested) starts
    /// each grid so.
    Near(Array2<T>),
}

pub(crate) enum Begin<'a, T> {
    At(Start<'a, T>),
    On(Branch),
    /// At the gap of another grid's solution, as [`Start::Near`], but with all nodes of the operator's grid.
    Prolonged(Array2<T>),
    /// At the gap of another load or of a part, on the operator's grid.
    Found(Place<T>),
    /// At a gap to which gaps of other loads lead, on the operator's grid, with the contacts of the last of them.
    Ahead {
        gap: Array2<T>,
        last: &'a Place<T>,
        nearness: Nearness,
    },
}

impl<'a, T> Begin<'a, T> {
    /// The start at the first of several loads: from afar, if the law attracts next to contacts alone.
    pub(crate) fn of_series(law: &dyn AdhesionLaw<T>, settings: &Settings) -> Self
    where
        T: Real,
    {
        let from_afar = law.hints().touches() && settings.method != Method::Rey2017;
        if from_afar { Self::On(settings.branch.unwrap_or(Branch::Loading)) } else { Self::At(Start::Default) }
    }

    pub(crate) fn is_default(&self) -> bool {
        matches!(self, Self::At(Start::Default) | Self::On(_))
    }

    /// The gap with the contacts before, if it is not the gap of the start, and the nodes that have not parted since;
    /// takes both out.
    pub(super) fn last(&mut self) -> (Option<&'a Array2<T>>, Option<Cow<'a, Array2<bool>>>) {
        match self {
            Self::Found(place) => (None, place.not_parted.take().map(Cow::Owned)),
            Self::Ahead { last, .. } => (Some(&last.gap), last.not_parted.as_ref().map(Cow::Borrowed)),
            _ => (None, None),
        }
    }

    pub(super) fn nearness(&self) -> Nearness {
        match self {
            Self::At(Start::Near(_)) | Self::Prolonged(_) => Nearness::Near,
            Self::Found(_) => Nearness::Loaded,
            Self::Ahead { nearness, .. } => *nearness,
            Self::At(Start::Default | Start::From(_)) | Self::On(_) => Nearness::Afar,
        }
    }
}

/// The uniform gap of a default start.
pub(super) fn uniform_start<T: Real>(law: &dyn AdhesionLaw<T>, flat: &PressedFlat<T>, load: Load) -> f64 {
    match load {
        Load::Gap(gap) => gap,
        _ if law.hints().zero => 2.0 * flat.rms_height,
        _ => law.hints().rest.map_or(0.0, T::widen),
    }
}

/// The given gap, if any, as a start under a load.
pub(super) fn given_start<T: Real>(
    begin: Begin<'_, T>,
    grid: &Grid,
    flat: &PressedFlat<T>,
    load: Load,
    wall: Wall<'_, T>,
) -> Result<Option<Field<T>>> {
    let (given, whole): (CowArray<'_, T, Ix2>, _) = match begin {
        Begin::At(Start::Default) | Begin::On(_) => return Ok(None),
        Begin::At(Start::From(gap)) => (gap.view().into(), false),
        Begin::At(Start::Near(gap)) => (gap.into(), false),
        Begin::Prolonged(gap) | Begin::Found(Place { gap, .. }) | Begin::Ahead { gap, .. } => (gap.into(), true),
    };
    let start = if whole { given } else { flat.start(given)? };
    grid.fits("starting gap", start.dim())?;
    grid.finite("starting gap", start.view())?;
    // without places, and without an end, the pass is several times as fast
    let some = wall.is_rigid() && start.fold(false, |some, &gap| some | (gap < T::zero()));
    let mut nodes = start.iter().zip(grid.first_node()..);
    let find = || nodes.find(|&(&gap, node)| gap < T::zero() && flat.faces(node));
    let negative = some.then(find).flatten().map_or(Ok(()), |(gap, _)| {
        let requirement = "zero or positive at every node";
        Err(Error::Value { name: "starting gap", value: gap.widen(), requirement })
    });
    grid.agreed(negative)?;
    let mut gap = Field::of(start);
    if let Load::Gap(mean) = load {
        let present = grid.mean(gap.view(), T::widen);
        if !wall.projects() && grid.any(gap.iter().any(|&g| g < T::zero())) {
            // gaps of both signs may have hardly any mean
            gap.view_mut().mapv_inplace(|g| g + T::lit(mean - present));
        } else if present > 0.0 {
            gap.view_mut().mapv_inplace(|g| g * T::lit(mean / present));
        } else {
            gap.nodes_mut().fill(T::lit(mean));
        }
    }
    Ok(Some(gap))
}

/// Refuses a law that is not finite at the start.
pub(super) fn check_start<T: Real, Lo: Real>(iterate: &Iterate<'_, T, Lo>) -> Result<()> {
    if iterate.energy().is_finite() && iterate.tally().sum_r.is_finite() {
        return Ok(());
    }
    iterate.posed.operators.state().grid().agreed(check_gaps(iterate))
}

fn check_gaps<T: Real, Lo: Real>(iterate: &Iterate<'_, T, Lo>) -> Result<()> {
    let law = iterate.posed.law();
    let mut value = [T::zero()];
    let first = iterate.posed.operators.state().grid().first_node();
    let window = iterate.posed.flat.window.as_ref();
    let on_surface = |node| window.map_or(Some(node), |window| window.pieces(node..node + 1).next()?.1);
    for (node, gap) in (first..).zip(iterate.fields.gap.nodes()) {
        let Some(node) = on_surface(node) else { continue };
        let gap = gap.max(T::zero());
        for (order, function) in ["adhesive energy", "adhesive traction"].into_iter().enumerate() {
            law.evaluate(node, &[gap], Values::one(order, &mut value));
            if !value[0].is_finite() {
                return Err(Error::not_finite(function, gap.widen(), value[0].widen()));
            }
        }
    }
    Ok(())
}

/// The gap so many steps beyond the last of two, on the operator's grid; nodes come no closer than they may in a step.
///
/// Over `long` steps the power 3/4 of the gap is extrapolated at a wall. Next to a contact, with an edge that moves
/// with the load, the gap grows as the power 3/2 of the distance from the edge, and elsewhere it is smooth in the load.
pub(crate) fn extrapolated<T: Real>(
    [before, last]: [&Array2<T>; 2],
    steps: f64,
    (least, long): (Least<T>, bool),
    (flat, grid): (&PressedFlat<T>, Grid),
) -> Array2<T> {
    let (steps, mut next, before) = (T::lit(steps), Field::of(last), ordered(before.view()));
    let power = |gap: T| gap.sqrt() * gap.sqrt().sqrt();
    let bends = long && least.is_wall();
    grid.reducer().run(write(&mut next).zip(par::chunks(&before, CHUNK)), |first, (gaps, before)| {
        for ((gap, &before), node) in gaps.iter_mut().zip(before).zip(first..) {
            let straight = *gap + steps * (*gap - before);
            // not a number below the wall, where a free half-space faces no surface
            let bent = power(*gap) + steps * (power(*gap) - power(before));
            let wanted = if bends && bent > T::zero() { bent * bent.cbrt() } else { straight };
            let feasible = bounded(least, *gap, wanted);
            let free = wanted < feasible && !flat.faces(node);
            *gap = if free { wanted } else { feasible };
        }
    });
    next.into_array()
}

/// Refuses springs, where the energy of a solution has to be in its report.
pub(crate) fn refuse_springs<T: Real>(wall: Wall<'_, T>) -> Result<()> {
    let reason = "the energy of springs is not in the report of a solution, so that jumps could not be told from work: \
                  take a rigid wall, or none with a law that repels";
    if wall.springs().is_some() { Err(Error::Unsuited { what: "springs", reason }) } else { Ok(()) }
}

/// Refuses a wall that yields, where a state has to bear what it has borne before.
pub(crate) fn refuse_hardness<T: Real>(wall: Wall<'_, T>, reason: &'static str) -> Result<()> {
    wall.hardness().map_or(Ok(()), |_| Err(Error::Unsuited { what: "a hardness", reason }))
}

/// Refuses a mean pressure that a wall which yields everywhere cannot bear, besides what the law pulls there.
pub(crate) fn check_hardness<T: Real>(
    law: &dyn AdhesionLaw<T>,
    load: Load,
    flat: &PressedFlat<T>,
    wall: Wall<'_, T>,
) -> Result<()> {
    let Some(hardness) = wall.hardness() else { return Ok(()) };
    let pull = law.traction(T::zero()).widen();
    if pull >= hardness.least() {
        let requirement = "below the hardness: else each contact crushes itself";
        return Err(Error::Value { name: "adhesive traction at contact", value: pull, requirement });
    }
    let facing = flat
        .window
        .as_ref()
        .map_or(1.0, |window| window.facing() as f64 / (window.grid().nodes() as f64 * flat.padding));
    match load {
        Load::Pressure(pressure) if pressure >= facing * (hardness.mean() - pull) => Err(Error::Value {
            name: "mean pressure",
            value: pressure * flat.padding,
            requirement: "below the hardness, less the adhesive traction at contact: a surface that yields everywhere \
                          bears no more",
        }),
        _ => Ok(()),
    }
}

/// Refuses a law that is not made for a wall.
pub(crate) fn check_wall<T: Real>(law: &dyn AdhesionLaw<T>, wall: Wall<'_, T>) -> Result<()> {
    let (what, reason) = match wall {
        Wall::None if law.hints().rest.is_none() => (
            "no wall",
            "the adhesion law does not repel at every node, so that nothing would keep the surfaces apart: choose a wall",
        ),
        Wall::Rigid | Wall::Capped(_) | Wall::Springs(_) if !law.energy(T::zero()).is_finite() => (
            "a wall at zero gap",
            "the adhesion law has no bound there: solve it without a wall (NoWall), or cut it at its equilibrium \
             separation",
        ),
        _ => return Ok(()),
    };
    Err(Error::Unsuited { what, reason })
}
