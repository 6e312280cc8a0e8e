//! The report of a solve: its status, its figures, and the fields of the solution.

use std::borrow::Cow;
use std::fmt;

use ndarray::{Array2, CowArray};

use super::{Branch, Criterion, Method};
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::elastic::{Boundary, ElasticOperator};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::problem::{Control, Problem};
use crate::real::Real;

/// The status of a solve: how it ended, and how good its fields are.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Settings, Solver, Status, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::new(Settings::default().max_iterations(2));
/// let report = solver.solve(&mut problem, Control::MeanGap(0.01))?.report;
/// assert_eq!(report.status, Status::IterationLimit); // no error: the fields are there, and the report says how good
/// assert_eq!(report.status.to_string(), "iteration-limit");
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Status {
    /// The criterion was met, on the fields that were returned: they are the solution to the tolerance.
    Converged,
    /// The iterations ran out: a feasible state whose [`relative_error`](Report::relative_error) says how far it got.
    IterationLimit,
    /// No more progress is possible in this precision: the best accuracy to be had is in the report.
    Stalled,
    /// The observer stopped the solve: a feasible state.
    Stopped,
    /// A tensile mean pressure under which no equilibrium was found. From the default start it was looked for among
    /// the states at given mean gaps, too, of which none held the load; from a given start the branch ended there. The
    /// fields are of the surfaces held apart, at rest, where they no longer reach each other; under the load they
    /// would go on for ever.
    Detached,
}

impl Status {
    /// The name that the tool and `report.json` use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::IterationLimit => "iteration-limit",
            Self::Stalled => "stalled",
            Self::Stopped => "stopped",
            Self::Detached => "detached",
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The state of an iteration, as an observer sees it.
///
/// ```
/// use std::ops::ControlFlow;
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Start, Status, Surface, Westergaard};
/// let grid = Grid::square(32, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve_with(&mut problem, Control::MeanGap(0.01), Start::Default, |state| {
///     println!("{} {:.1e} {:.6e}", state.iteration, state.relative_error, state.energy);
///     if state.relative_error < 1e-2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
/// })?;
/// assert_eq!(solution.report.status, Status::Stopped);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The number of steps.
    pub iteration: usize,
    /// The number of operator applications of this solve so far.
    pub operator_applications: usize,
    /// The certified relative error in the energy norm, [`Report::relative_error`]. [`Method::Rey2017`] does not need
    /// it and computes it only now and then; it is infinite before.
    pub relative_error: f64,
    /// The relative error of the load, [`Report::load_error`].
    pub load_error: f64,
    /// The energy that is minimised, per area of the operator's grid: elastic and adhesive energy, and under pressure
    /// control p̄ times the mean gap; with a spring its energy. It is summed up step by step, in `f64` to the rounding
    /// of `f32`; the report has it as it is.
    pub energy: f64,
    /// The mean gap; with a free boundary or absent nodes over the operator's grid, on which the gap goes on as the
    /// displacement less heights that are interpolated.
    pub mean_gap: f64,
    /// The number of nodes in contact.
    pub contact_nodes: usize,
    /// The number of changes of the minimised energy so far: of the law, the multipliers of a constraint, or, in
    /// search of a state that holds a tension, the mean gap. The energy falls within a round.
    pub round: usize,
    /// Whether the solve is still on the way to its start, with the jumps of the law smoothed: then the energy and the
    /// error are those of the smoothed law. See [`Discretisation::Smooth`](crate::adhesion::Discretisation::Smooth).
    pub smoothed: bool,
}

/// The account of a solve: its problem in numbers and names, its cost, and its outcome. Energies are per area; all
/// numbers are in the units of the input. With the feature `serde` it is data; JSON has only finite numbers.
///
/// ```
/// use asperity::{AdhesionLaw, Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let law = Exponential::new(1e-5, 4e-3)?;
/// let mut problem = Problem::new(&Surface::wave_2d(grid, 0.02, 1)?, Westergaard::<f64>::new(grid, 1.0)?, law)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.01))?;
/// let report = &solution.report;
/// // the two mean pressures differ by the adhesive traction
/// let traction = solution.gap.iter().map(|&g| law.traction(g)).sum::<f64>() / 4096.0;
/// assert!((report.mean_contact_pressure - report.mean_pressure - traction).abs() < 1e-4 * traction);
/// assert!(report.elastic_energy > 0.0 && report.adhesive_energy < 0.0 && !report.under_resolved);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report {
    /// The status: how the solve ended.
    pub status: Status,
    /// The certified relative error of the gap in the energy norm, √(⟨r', K r'⟩/⟨u, p⟩), evaluated on the returned
    /// fields.
    ///
    /// Without adhesion it bounds the distance from the exact discrete solution (under pressure control: the one at
    /// the same mean gap). With adhesion it measures how far the state is from equilibrium, and bounds the error where
    /// that equilibrium is stable. As long as no node is in contact, ⟨h, K⁻¹h⟩ stands for a smaller ⟨u, p⟩, which may
    /// vanish then. Without a wall ([`NoWall`](crate::NoWall)) the nodes that the law holds resist with its slope
    /// κ = max(φ'', 0), and the norm is that of K⁻¹ + κ: in the place of √⟨r', K r'⟩ there is
    /// √⟨s r', K s r'⟩ + √⟨(1 − s)² r'²/κ⟩, which bounds the distance in it, with the share s = (1 + κ/k)⁻² of a node
    /// in the waves, k being 0.4 times the stiffness of the shortest wave, and with r' less its mean weighted by s²
    /// where the mean gap is given. Under the lightest loads ⟨u, p⟩ is computed as ⟨p, K p⟩, which does not cancel, and
    /// the error is never less than the rounding of the pressure alone makes it, so that it is not understated.
    pub relative_error: f64,
    /// The branch of equilibria on which the solve has started; nothing without adhesion, where there is but one
    /// equilibrium, from a given start, and of [`Method::Rey2017`].
    pub branch: Option<Branch>,
    /// Under a given pressure or with a spring, the error of the load relative to the larger of |p̄| and the mean
    /// contact pressure: the larger of the imbalance of the nodes that are apart and the difference between the load
    /// and the one that the returned fields carry. One without contact under a load that needs it; zero under gap
    /// control.
    pub load_error: f64,
    /// The paper's criterion ε = Σ|g r'|, in units of E*·√(Lx·Ly), on the returned fields.
    pub complementarity: f64,
    /// The number of steps.
    pub iterations: usize,
    /// The number of operator applications, each a forward and an inverse transform; the construction of the problem
    /// takes one more.
    pub operator_applications: usize,
    /// The boundary of the elastic body.
    pub boundary: Boundary,
    /// The contact modulus E* of the elastic body, [`ElasticOperator::modulus`].
    pub modulus: f64,
    /// The control: the load that was held.
    pub control: Control,
    /// The wall, by the name of [`Wall::name`](crate::constraint::Wall::name).
    #[cfg_attr(feature = "serde", serde(deserialize_with = "named"))]
    pub wall: Name,
    /// The work of adhesion w of the law, the largest where it varies; zero without adhesion.
    pub work_of_adhesion: f64,
    /// The mean gap, over the nodes that are not absent.
    pub mean_gap: f64,
    /// The mean external pressure p̄, the force over the nominal area Lx·Ly of the surface, compression positive; under
    /// pressure control the given one.
    pub mean_pressure: f64,
    /// The normal force F = p̄·Lx·Ly, compression positive.
    pub normal_force: f64,
    /// The approach δ: how far the bodies have moved towards each other since they would first touch undeformed.
    /// Nothing in a periodic cell, where it has no meaning.
    pub approach: Option<f64>,
    /// The mean pressure that the returned fields carry, ⟨λ⟩ − ⟨φ'⟩. Under pressure control the solve was asked for
    /// [`mean_pressure`](Self::mean_pressure), and where it has converged this is the same to the tolerance; of
    /// surfaces that were [`Detached`](Status::Detached) it is the remaining part of the load.
    pub net_pressure: f64,
    /// The mean contact (repulsive) pressure, the paper's q₀.
    pub mean_contact_pressure: f64,
    /// The share of nodes in contact, as [`Solution::contact_map`] says, among those that are not absent.
    pub contact_fraction: f64,
    /// The number of nodes in contact, by [`Solution::contact_map`].
    pub contact_nodes: usize,
    /// The number of [absent nodes](crate::Surface::with_absent) of the surface.
    pub absent_nodes: usize,
    /// The largest traction on the outermost nodes of a free boundary's window, as a share of the largest anywhere.
    /// Nothing in a periodic cell.
    pub edge_traction: Option<f64>,
    /// Whether contact, or more than a thousandth of the largest traction, reaches the outermost nodes of a free
    /// boundary's window. Unless the body ends there, the window is too small for it. Not where the bodies are apart,
    /// with no traction above 1 % of w/ρ.
    pub reaches_edge: bool,
    /// The smallest gap: zero in contact, negative only where the constraint lets the surfaces interpenetrate.
    pub min_gap: f64,
    /// The elastic energy, the mean of u·p/2 over the nominal area.
    pub elastic_energy: f64,
    /// The adhesive energy, the mean of φ(g) over the nominal area.
    pub adhesive_energy: f64,
    /// The resolution measure μ_ρ of [`Problem::mu_rho`](crate::Problem::mu_rho).
    pub mu_rho: f64,
    /// Whether μ_ρ exceeds [`Report::RESOLVED_MU_RHO`]: the answer then depends on the grid and on the start.
    pub under_resolved: bool,
    /// The precision of the fields, `"f32"` or `"f64"`.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "named"))]
    pub precision: Name,
    /// The iteration that was used.
    pub method: Method,
    /// The measure that was compared with the tolerance. [`Criterion::Complementarity`] bounds no error: a solve that
    /// has converged by it may have any [`relative_error`](Self::relative_error).
    pub criterion: Criterion,
    /// The tolerance to which the solve was held, [`Settings::tolerance_in`](crate::Settings::tolerance_in) its
    /// precision.
    pub tolerance: f64,
}

impl Report {
    /// The largest resolution measure μ_ρ at which the grid resolves the adhesion.
    pub const RESOLVED_MU_RHO: f64 = 0.5;
}

/// A name that a report has; behind a word of its own, which derived data does not take for a borrowed one.
type Name = &'static str;

/// A wall or a precision from its name.
#[cfg(feature = "serde")]
fn named<'de, D: serde::Deserializer<'de>>(from: D) -> std::result::Result<Name, D::Error> {
    let name: String = serde::Deserialize::deserialize(from)?;
    let known = ["rigid", "springs", "none", f32::NAME, f64::NAME].into_iter().find(|known| *known == name);
    known.ok_or_else(|| serde::de::Error::custom(format_args!("{name} names neither a wall nor a precision")))
}

/// The fields of a solved problem, each of the shape (Nx, Ny) of the surface, their grid, and the account of the solve,
/// which has control, wall, boundary and contact modulus.
///
/// [`ContactStatistics`](crate::contact::ContactStatistics), [`StabilityTest`](crate::stability::StabilityTest),
/// [`ContactStiffness`](crate::stability::ContactStiffness) and [`Warning`](crate::warning::Warning) take them from
/// here. The adhesion law belongs to the problem: what needs its traction takes the law, and refuses one of another
/// work of adhesion.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::wave_2d(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let solution = Solver::default().solve(&mut problem, Control::MeanPressure(0.02))?;
/// let displacement = &solution.gap + surface.heights(); // u = g + h
/// assert_eq!(displacement.dim(), (64, 64));
/// assert!((solution.pressure.sum() / 4096.0 - 0.02).abs() < 1e-8); // its mean is the external pressure
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<T> {
    /// The gap g ≥ 0 between the surfaces, infinite at [absent nodes](crate::Surface::with_absent).
    pub gap: Array2<T>,
    /// The full elastic pressure p + p̄ on the half-space: the contact pressure less the adhesive traction. Zero at
    /// absent nodes.
    pub pressure: Array2<T>,
    /// The contact pressure λ ≥ 0, zero wherever the gap is not.
    pub contact_pressure: Array2<T>,
    /// The grid of the surface, and of the fields.
    pub grid: Grid,
    /// The account.
    pub report: Report,
}

/// A solution, and what only other solves need of it.
pub(crate) struct Solved<T> {
    pub(crate) solution: Solution<T>,
    /// the gap on the grid of the operator, with that grid, if not all of its nodes face the surface
    pub(crate) whole: Option<(Grid, Array2<T>)>,
    /// whether the residual is at the rounding floor
    pub(crate) at_floor: bool,
}

impl<T> Solved<T> {
    /// Whether the fields are as good as the tolerance asks, or as good as rounding lets them be.
    pub(crate) fn is_settled(&self) -> bool {
        match self.solution.report.status {
            Status::Converged => true,
            Status::Stalled => self.at_floor,
            _ => false,
        }
    }
}

impl<T: Clone> Solved<T> {
    /// The gap on the grid of the operator.
    pub(crate) fn gap(&self) -> &Array2<T> {
        self.whole.as_ref().map_or(&self.solution.gap, |(_, gap)| gap)
    }

    /// The solution, and its gap on the grid of the operator.
    pub(crate) fn with_gap(self) -> (Solution<T>, Array2<T>) {
        let gap = self.whole.map_or_else(|| self.solution.gap.clone(), |(_, gap)| gap);
        (self.solution, gap)
    }
}

impl<T: Real> Solution<T> {
    /// The solution with the whole of its fields, on the first of the processes that share the grid of the surface, and
    /// nothing on the others. All of them have to ask. The solution itself, if the grid is not shared.
    pub fn gathered(&self) -> Option<Cow<'_, Self>> {
        if !self.grid.is_shared() {
            return Some(Cow::Borrowed(self));
        }
        let fields = [&self.gap, &self.pressure, &self.contact_pressure];
        let fields = fields.map(|field| self.grid.gathered(field).map(CowArray::into_owned));
        let [Some(gap), Some(pressure), Some(contact_pressure)] = fields else { return None };
        Some(Cow::Owned(Self { gap, pressure, contact_pressure, grid: self.grid.alone(), report: self.report.clone() }))
    }

    /// Refuses an adhesion law of another work of adhesion than that under which the solution was found.
    pub(crate) fn check_law(&self, law: &dyn AdhesionLaw<T>) -> Result<()> {
        let (value, known) = (law.hints().work_of_adhesion.widen(), self.report.work_of_adhesion);
        if value == known || (value - known).abs() <= T::epsilon().widen().sqrt() * known.abs() {
            return Ok(());
        }
        let requirement = "that of the law of the solution: give the law of its problem";
        Err(Error::Value { name: "work of adhesion", value, requirement })
    }

    /// Refuses to take the solution for one of a problem with another grid, body, law or wall.
    pub(crate) fn check<O, L>(&self, problem: &Problem<T, O, L>, constraint: &dyn ContactConstraint<T>) -> Result<()>
    where
        O: ElasticOperator<T>,
        L: AdhesionLaw<T>,
    {
        let (own, grid, wall) = (self.grid.lengths(), problem.grid(), constraint.wall().name());
        Error::shape("solution", self.grid.shape(), grid.shape())?;
        let figures = [
            ("side length Lx of the solution", own.0, grid.lengths().0),
            ("side length Ly of the solution", own.1, grid.lengths().1),
            ("contact modulus of the solution", self.report.modulus, problem.operator.modulus()),
        ];
        let other = |(_, found, expected): &(_, f64, f64)| found.total_cmp(expected).is_ne();
        if let Some((name, value, _)) = figures.into_iter().find(other) {
            return Err(Error::Value { name, value, requirement: "the same as of the problem" });
        }
        if self.report.wall != wall {
            let reason = "the solution was found with another wall: give the constraint of its solver";
            return Err(Error::Wall { wall, reason });
        }
        self.check_law(&problem.law)
    }
}
