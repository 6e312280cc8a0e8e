//! The contact constraint: the rigid or elastic wall that keeps the gap from becoming negative.

use std::fmt;

use ndarray::ArrayView2;

use crate::adhesion::Values;
use crate::derivatives::{self, Named};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::real::Real;

mod hardness;
mod no_wall;
mod penalty;
mod projection;
mod uzawa;

pub use hardness::Hardness;
pub use no_wall::NoWall;
pub use penalty::Penalty;
pub use projection::Projection;
pub use uzawa::Uzawa;

/// The contact constraint, which keeps the surfaces from passing through each other.
///
/// Either the gap is confined to g ≥ 0 ([`Projection`]), or any gap is feasible and the energy gains a term at each
/// node that resists negative gaps ([`Penalty`]), perhaps with multipliers that are updated between solves ([`Uzawa`]).
/// A wall of a given [`Hardness`] yields. A law that repels close by needs no wall ([`NoWall`]).
///
/// An [`AdhesionLaw`](crate::AdhesionLaw) is defined for g ≥ 0, and continues at negative gaps as its tangent, φ(0) +
/// φ'(0)g: springs of any stiffness then bound the energy below, which an exponential would outrun.
///
/// ```
/// use asperity::constraint::{Springs, Wall};
/// use asperity::{ContactConstraint, Control, Grid, NoAdhesion, Problem, Settings, Solver, Surface, Westergaard};
/// /// A film that resists compression from a thickness of 1e-3 on.
/// struct Film;
/// impl ContactConstraint<f64> for Film {
///     fn wall(&self) -> Wall<'_, f64> { Wall::Springs(self) }
/// }
/// impl Springs<f64> for Film {
///     fn energy(&self, _: usize, gap: f64) -> f64 { 250.0 * (1e-3 - gap).max(0.0).powi(2) }
///     fn traction(&self, _: usize, gap: f64) -> f64 { -500.0 * (1e-3 - gap).max(0.0) }
///     fn slope(&self, _: usize, gap: f64) -> f64 { if gap < 1e-3 { 500.0 } else { 0.0 } }
/// }
/// let grid = Grid::square(32, 1.0)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver { settings: Settings::default(), constraint: Film };
/// let report = solver.solve(&mut problem, Control::MeanPressure(2e-4))?.report;
/// assert!(report.min_gap > 0.9e-3 && report.contact_nodes > 1);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// A worked example with rounds is on the page [`own_constraint`](crate::guide::own_constraint).
pub trait ContactConstraint<T: Real>: Send + Sync {
    /// The wall that keeps the surfaces apart in the present round.
    fn wall(&self) -> Wall<'_, T>;

    /// Prepares for a solve on a surface's grid, to a tolerance of its criterion. `stiffest` is the stiffness of the
    /// shortest wave ([`ElasticOperator::stiffness_range`](crate::ElasticOperator::stiffness_range)), pressure per
    /// length. Each of several processes has all nodes of the constraint.
    ///
    /// # Errors
    /// The reason, if the constraint cannot be used on that grid.
    fn start(&mut self, _grid: &Grid, _stiffest: f64, _tolerance: f64) -> Result<()> {
        Ok(())
    }

    /// The relative error, in the energy norm, to which the present round has to be solved, where that is above the
    /// tolerance of the solve: a round that only leads to the next one may end early. The solve continues to its own
    /// tolerance once [`update`](Self::update) has returned [`Update::Done`], and asks again.
    fn round_tolerance(&self) -> f64 {
        0.0
    }

    /// Whether the rounds end at a rigid wall, and springs are only the means: stiffness and stability then hold the
    /// nodes that the springs press, as a rigid wall does. Other springs resist with their slopes.
    fn ends_rigid(&self) -> bool {
        false
    }

    /// Takes over the contact pressures that a rigid wall bears, found to a relative error, from which the rounds then
    /// continue; `false`, the default, if the springs press by their gap alone. Zero at absent nodes.
    fn bear(&mut self, _pressures: ArrayView2<'_, T>, _error: f64) -> bool {
        false
    }

    /// Updates the springs when a solve with them has converged, and tells whether to solve again. The gap is infinite at
    /// [absent](crate::Surface::with_absent) nodes. `work` is the scale of the square of relative errors, Σ u·p over
    /// the nodes.
    fn update(&mut self, _gap: ArrayView2<'_, T>, _work: f64) -> Update {
        Update::Done
    }
}

impl<T: Real, C: ContactConstraint<T> + ?Sized> ContactConstraint<T> for Box<C> {
    fn wall(&self) -> Wall<'_, T> {
        (**self).wall()
    }
    fn start(&mut self, grid: &Grid, stiffest: f64, tolerance: f64) -> Result<()> {
        (**self).start(grid, stiffest, tolerance)
    }
    fn round_tolerance(&self) -> f64 {
        (**self).round_tolerance()
    }
    fn ends_rigid(&self) -> bool {
        (**self).ends_rigid()
    }
    fn bear(&mut self, pressures: ArrayView2<'_, T>, error: f64) -> bool {
        (**self).bear(pressures, error)
    }
    fn update(&mut self, gap: ArrayView2<'_, T>, work: f64) -> Update {
        (**self).update(gap, work)
    }
}

/// The wall that the half-space meets.
#[non_exhaustive]
#[derive(Clone, Copy)]
pub enum Wall<'a, T> {
    /// The gap is confined to g ≥ 0.
    Rigid,
    /// The gap is confined to g ≥ 0 until the contact pressure reaches a hardness, at which the surface yields.
    Capped(&'a Hardness),
    /// Any gap is feasible, and springs add energy.
    Springs(&'a dyn Springs<T>),
    /// Any gap is feasible at which the adhesion law is finite: the law itself keeps the surfaces apart.
    None,
}

impl<'a, T> Wall<'a, T> {
    /// The name that reports use: `"rigid"`, `"capped"`, `"springs"` or `"none"`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Capped(_) => "capped",
            Self::Springs(_) => "springs",
            Self::None => "none",
        }
    }

    /// Whether the gap is confined to g ≥ 0.
    pub(crate) fn is_rigid(&self) -> bool {
        matches!(self, Self::Rigid)
    }

    /// Whether steps end where the surfaces touch: at a rigid wall, and at one that yields.
    pub(crate) fn projects(&self) -> bool {
        matches!(self, Self::Rigid | Self::Capped(_))
    }

    /// Whether any gap is feasible: springs, or the law alone, make the contact pressure a function of the gap.
    pub(crate) fn is_soft(&self) -> bool {
        !self.projects()
    }

    /// Whether the wall is a term of the energy, with gaps below zero.
    pub(crate) fn goes_below(&self) -> bool {
        matches!(self, Self::Springs(_) | Self::Capped(_))
    }

    /// Whether there is a wall, so that not the law alone keeps the surfaces apart.
    pub(crate) fn keeps_apart(&self) -> bool {
        !matches!(self, Self::None)
    }

    /// The springs of the wall, if it has some.
    pub(crate) fn springs(&self) -> Option<&'a dyn Springs<T>> {
        if let Self::Springs(springs) = self { Some(*springs) } else { None }
    }

    /// The hardness at which the wall yields, if it does.
    pub(crate) fn hardness(&self) -> Option<&'a Hardness> {
        if let Self::Capped(hardness) = self { Some(hardness) } else { None }
    }
}

impl<T> fmt::Debug for Wall<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Springs that resist small or negative gaps, as in the example of [`ContactConstraint`]; nodes are ix·Ny + iy.
///
/// The certificate of a solve knows springs by their pressure and slope at the present gap: it is a bound of the error
/// for linear ones, and an estimate for others ([`driver`](crate::guide::driver)).
pub trait Springs<T: Real>: Sync {
    /// The energy per area.
    fn energy(&self, node: usize, gap: T) -> T;

    /// The derivative of the energy by the gap: minus the contact pressure.
    fn traction(&self, node: usize, gap: T) -> T;

    /// The second derivative of the energy by the gap.
    fn slope(&self, node: usize, gap: T) -> T;

    /// Sets the values that are asked for at the nodes from `first` on, a few hundred at once. The default calls the
    /// functions of one node, and compiles them into its loops.
    fn evaluate(&self, first: usize, gaps: &[T], values: Values<'_, T>) {
        values.each(|order, values| {
            let nodes = values.iter_mut().zip(gaps).enumerate();
            match order {
                0 => nodes.for_each(|(i, (value, &gap))| *value = self.energy(first + i, gap)),
                1 => nodes.for_each(|(i, (value, &gap))| *value = self.traction(first + i, gap)),
                _ => nodes.for_each(|(i, (value, &gap))| *value = self.slope(first + i, gap)),
            }
        });
    }
}

/// The decision of [`ContactConstraint::update`]; [`own_constraint`](crate::guide::own_constraint) uses all three.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// The constraint is met: the solution stands.
    Done,
    /// The energy has changed: minimise on from here.
    Again,
    /// The updates are used up, and the constraint is not met: end without having converged.
    Failed,
}

/// The test of a constraint of your own: whether its springs are each other's derivatives, and resist more the smaller
/// the gap.
///
/// The nodes are seven at most below `nodes`, and the gaps lie between −`depth` and `depth`, as with
/// [`check_law`](crate::adhesion::check_law).
///
/// # Errors
/// [`Error::Contract`] with the function that is not finite, or not the derivative of the one before it, and the gap;
/// [`Error::Value`] if a slope is negative, or `depth` not positive and finite.
///
/// ```
/// use asperity::constraint::check_constraint;
/// use asperity::{Penalty, Projection};
/// check_constraint::<f64>(&Penalty::new(5000.0)?, 1, 1e-3)?;
/// check_constraint::<f64>(&Projection, 1, 1e-3)?;
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn check_constraint<T: Real>(constraint: &impl ContactConstraint<T>, nodes: usize, depth: f64) -> Result<()> {
    Error::positive("depth", depth)?;
    let Some(springs) = constraint.wall().springs() else { return Ok(()) };
    for node in (0..nodes).step_by(nodes.div_ceil(7).max(1)) {
        let slope = |g: f64| springs.slope(node, T::lit(g)).widen();
        let functions: [Named<'_>; 3] = [
            ("energy of the springs", &|g| springs.energy(node, T::lit(g)).widen()),
            ("traction of the springs", &|g| springs.traction(node, T::lit(g)).widen()),
            ("slope of the springs", &slope),
        ];
        derivatives::check::<T>(functions, (-depth, depth), depth)?;
        for i in 0..=100 {
            Error::non_negative("slope of the springs", slope(depth * (0.02 * f64::from(i) - 1.0)))?;
        }
    }
    Ok(())
}
