//! The report of a solve: its status, its figures, and the fields of the solution.

use std::borrow::Cow;

use ndarray::Array2;

use super::place::Place;
use super::{Branch, Criterion, Method};
use crate::adhesion::{AdhesionLaw, SharedLaw};
use crate::constraint::ContactConstraint;
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::names::names;
use crate::problem::{Control, ProblemMut};
use crate::real::Real;

/// The status of a solve: how it ended, and how good its fields are.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Status {
    /// The criterion was met, on the fields that were returned: they are the solution to the tolerance.
    Converged,
    /// The iterations ran out: the state is feasible, and its [`relative_error`](Report::relative_error) says how far
    /// the solve got.
    IterationLimit,
    /// No more progress is possible in this precision.
    Stalled,
    /// The observer stopped the solve: a feasible state.
    Stopped,
    /// A tensile mean pressure under which no equilibrium was found: with the default start at any mean gap, with a
    /// given start on its branch. The fields show the surfaces at rest, held out of each other's reach.
    Detached,
}

names!(Status {
    Converged = "converged",
    IterationLimit = "iteration-limit",
    Stalled = "stalled",
    Stopped = "stopped",
    Detached = "detached",
});

/// The state of an iteration, as an observer sees it.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The number of steps.
    pub iteration: usize,
    /// The number of operator applications of this solve so far.
    pub operator_applications: usize,
    /// The certified relative error in the energy norm, [`Report::relative_error`]; with [`Method::Rey2017`] the last
    /// one computed, and infinite before.
    pub relative_error: f64,
    /// The relative error of the load, [`Report::load_error`].
    pub load_error: f64,
    /// The energy that is minimised, per area of the operator's grid: elastic, adhesive, in springs, and under pressure
    /// control p̄ times the mean gap. Summed up step by step, in `f64` to the rounding of `f32`.
    pub energy: f64,
    /// The mean gap; with a free boundary or absent nodes over the operator's grid.
    pub mean_gap: f64,
    /// The number of nodes in contact.
    pub contact_nodes: usize,
    /// The number of changes of the minimised energy so far, by the law, multipliers, or the mean gap in search of a
    /// state that holds a tension. The energy falls within a round.
    pub round: usize,
    /// Whether the law is still [smoothed](crate::adhesion::Discretisation::Smooth), and energy and error are of that
    /// law.
    pub smoothed: bool,
    /// The control of the solve.
    pub control: Control,
}

/// The account of a solve: its problem in numbers and names, its cost, and its outcome.
///
/// Energies are per area; all numbers are in the units of the input. With the feature `serde` it is data; JSON has only
/// finite numbers.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Report {
    /// The status: how the solve ended.
    pub status: Status,
    /// The certified relative error of the gap in the energy norm, √(⟨r', K r'⟩/⟨u, p⟩), on the returned fields.
    ///
    /// Without adhesion it bounds the distance from the exact discrete solution (under pressure control the solution at
    /// the same mean gap); with adhesion it bounds the error where the equilibrium is stable. It includes the rounding
    /// of the pressure. Without any contact ⟨h, K⁻¹h⟩ stands for a smaller ⟨u, p⟩, which may vanish. Where nodes bear
    /// their own attraction, so that ⟨u, p⟩ is rounding, the work of this attraction alone on the stiffest wave stands
    /// for it.
    ///
    /// With [`NoWall`](crate::NoWall) the norm belongs to K⁻¹ + κ, with κ = max(φ'', 0) the slope of the nodes that the
    /// law holds: √⟨s r', K s r'⟩ + √⟨(1 − s)² r'²/κ⟩ takes the place of √⟨r', K r'⟩, with s = (1 + κ/k)⁻², k 0.4 times
    /// the stiffness of the shortest wave, and r' less its mean weighted by s² where the mean gap is given.
    pub relative_error: f64,
    /// The scale of this error: ⟨u, p⟩ per area, or its substitute.
    pub error_scale: f64,
    /// The branch of the start; none without adhesion, from a given start, and of [`Method::Rey2017`].
    pub branch: Option<Branch>,
    /// The error of the load, relative to the larger of |p̄| and the mean contact pressure: the larger of the imbalance
    /// of the nodes apart and the difference from the load that the fields carry. It is one without a contact that the
    /// load needs. Under no load it may also be relative to the energy of adhesion over its range, a pressure, since
    /// nodes at rest have no traction. For a held mean gap it is the distance from this gap, beyond rounding, as a
    /// share of it.
    pub load_error: f64,
    /// The paper's criterion ε = Σ|g r'|, in units of E*·√(Lx·Ly), on the returned fields.
    pub complementarity: f64,
    /// The number of steps.
    pub iterations: usize,
    /// The number of operator applications, each a forward and an inverse transform, without the application of the
    /// problem.
    pub operator_applications: usize,
    /// The boundary of the elastic body.
    pub boundary: Boundary,
    /// The contact modulus E* of the elastic body, [`ElasticOperator::modulus`](crate::ElasticOperator::modulus).
    pub modulus: f64,
    /// The control that was held.
    pub control: Control,
    /// The wall, by the name of [`Wall::name`](crate::constraint::Wall::name).
    #[cfg_attr(feature = "serde", serde(deserialize_with = "named"))]
    pub wall: Name,
    /// The name of the law, [`Hints::name`](crate::adhesion::Hints::name); `"none"` without adhesion.
    pub law: Cow<'static, str>,
    /// The work of adhesion w of the law, the largest where it varies; zero without adhesion.
    pub work_of_adhesion: f64,
    /// The mean gap, over the nodes that are not absent.
    pub mean_gap: f64,
    /// The mean external pressure p̄, the force over the nominal area Lx·Ly, compression positive.
    pub mean_pressure: f64,
    /// The normal force F = p̄·Lx·Ly, compression positive.
    pub normal_force: f64,
    /// The approach δ, as [`Control::Approach`] defines it; nothing in a periodic cell.
    pub approach: Option<f64>,
    /// The mean pressure that the returned fields carry, ⟨λ⟩ − ⟨φ'⟩: where the solve has converged
    /// [`mean_pressure`](Self::mean_pressure) to the tolerance; if [`Detached`](Status::Detached), what is left of it.
    pub net_pressure: f64,
    /// The mean contact (repulsive) pressure, the paper's q₀.
    pub mean_contact_pressure: f64,
    /// The share of nodes in contact, as [`Solution::contact_map`] says, among those that are not absent.
    pub contact_fraction: f64,
    /// The number of nodes in contact, by [`Solution::contact_map`].
    pub contact_nodes: usize,
    /// The number of [absent nodes](crate::Surface::with_absent) of the surface.
    pub absent_nodes: usize,
    /// The largest traction at the edge of a free boundary's window over the largest anywhere; none in a periodic cell.
    pub edge_traction: Option<f64>,
    /// Whether contact, or more than a thousandth of the largest traction, reaches the edge of a free boundary's
    /// window, which is then too small unless the body ends there. False for bodies apart with less than 1 % of w/ρ.
    pub reaches_edge: bool,
    /// The smallest gap: zero in contact, negative only where the constraint lets the surfaces interpenetrate.
    pub min_gap: f64,
    /// The elastic energy, the mean of u·p/2 over the nominal area.
    pub elastic_energy: f64,
    /// The adhesive energy, the mean of φ(g) over the nominal area.
    pub adhesive_energy: f64,
    /// The range ρ of a law with a range set by the grid, as [`Jkr`](crate::Jkr); none for other laws.
    pub range: Option<f64>,
    /// The traction in contact, 2w/ρ, for a law with a range set by the grid; none for other laws.
    pub peak_traction: Option<f64>,
    /// The share of contact by the adhesive energy, −E_adh/w, for a law with a range set by the grid, at a hard wall,
    /// and where nothing has yielded: in the theory of Johnson, Kendall and Roberts each area of contact has the energy
    /// −w. Where w varies it is taken node by node, and nodes without a work of adhesion count where they touch. It is
    /// smooth in the load, and too large by the process zone at the edges; see
    /// [`ContactArea::of_solution`](crate::contact::ContactArea::of_solution).
    pub adhesive_contact_fraction: Option<f64>,
    /// The resolution measure μ_ρ of [`Problem::mu_rho`](crate::Problem::mu_rho).
    pub mu_rho: f64,
    /// Whether μ_ρ exceeds [`Report::RESOLVED_MU_RHO`]: the answer then depends on the grid and on the start.
    pub under_resolved: bool,
    /// The precision of the fields, `"f32"` or `"f64"`.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "named"))]
    pub precision: Name,
    /// The iteration that was used.
    pub method: Method,
    /// The measure that was compared with the tolerance; [`Criterion::Complementarity`] bounds no error.
    pub criterion: Criterion,
    /// The tolerance of the solve, [`Settings::tolerance_in`](crate::Settings::tolerance_in) its precision.
    pub tolerance: f64,
    /// How far the surface has yielded, at a [`Hardness`](crate::Hardness); nothing at another wall.
    pub plastic: Option<Plastic>,
}

/// How far a surface has yielded: since it was made, or since the depth that [`Problem::flatten`](crate::Problem) gave
/// it. Shares and means are over the nodes that are not absent.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Plastic {
    /// The hardness H, in the mean over the nodes.
    pub hardness: f64,
    /// The share of nodes that have yielded.
    pub fraction: f64,
    /// The greatest plastic depth.
    pub depth_max: f64,
    /// The mean plastic depth.
    pub depth_mean: f64,
    /// The dissipated energy, the mean of H − t times the depth over the nominal area, with t the traction of the law at
    /// contact.
    pub energy: f64,
}

impl Report {
    /// The largest resolution measure μ_ρ at which the grid resolves the adhesion.
    pub const RESOLVED_MU_RHO: f64 = 0.5;
}

/// A name in a report; a type of its own, which derived data does not treat as borrowed.
type Name = &'static str;

#[cfg(feature = "serde")]
fn named<'de, D: serde::Deserializer<'de>>(from: D) -> std::result::Result<Name, D::Error> {
    let name: String = serde::Deserialize::deserialize(from)?;
    let known = ["rigid", "capped", "springs", "none", f32::NAME, f64::NAME].into_iter().find(|known| *known == name);
    known.ok_or_else(|| serde::de::Error::custom(format_args!("{name} names neither a wall nor a precision")))
}

/// The solution of a contact problem: its fields, of the shape (Nx, Ny) of the surface, and its report.
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
#[derive(Clone, Debug)]
pub struct Solution<T: Real> {
    /// The gap g ≥ 0 between the surfaces, infinite at [absent nodes](crate::Surface::with_absent). Where the surface
    /// has yielded, it is the gap to the yielded surface.
    pub gap: Array2<T>,
    /// The full elastic pressure p + p̄: the contact pressure less the adhesive traction; zero at absent nodes.
    pub pressure: Array2<T>,
    /// The contact pressure λ ≥ 0, zero wherever the gap is not.
    pub contact_pressure: Array2<T>,
    /// The plastic depth by which the surface has yielded, at a [`Hardness`](crate::Hardness); zero at absent nodes.
    pub plastic_depth: Option<Array2<T>>,
    /// Where surfaces attract each other by a law that attracts next to contacts alone, as [`Jkr`](crate::Jkr); none
    /// for other laws, and where all nodes attract, as on the branch of [unloading](crate::Branch).
    pub touched: Option<Array2<bool>>,
    /// The grid of the surface, and of the fields.
    pub grid: Grid,
    /// The account of the solve.
    pub report: Report,
    /// the law of its problem, as it was given
    pub(crate) law: SharedLaw<T>,
}

impl<T: Real> Solution<T> {
    /// The adhesion law of its problem, as it was given.
    pub fn law(&self) -> &dyn AdhesionLaw<T> {
        &*self.law
    }
}

impl<T: Real> PartialEq for Solution<T> {
    /// Compares fields, grid and report, which names the law.
    fn eq(&self, other: &Self) -> bool {
        let Self { gap, pressure, contact_pressure, plastic_depth, touched, grid, report, law: _ } = self;
        (gap, pressure, contact_pressure) == (&other.gap, &other.pressure, &other.contact_pressure)
            && (plastic_depth, touched) == (&other.plastic_depth, &other.touched)
            && (grid, report) == (&other.grid, &other.report)
    }
}

/// A solution, with what other solves need.
pub struct Solved<T: Real> {
    pub(crate) solution: Solution<T>,
    /// the gap on the operator's grid, with that grid, if not all of its nodes face the surface, or some may yield
    pub(crate) whole: Option<(Grid, Array2<T>)>,
    /// where surfaces that attract each other next to contacts alone have not parted, on the operator's grid
    pub(crate) not_parted: Option<Array2<bool>>,
    /// whether surfaces touched at new places
    pub(crate) touches: bool,
    /// whether the residual is at the rounding floor
    pub(crate) at_floor: bool,
}

impl<T: Real> Solved<T> {
    /// Whether the fields are as good as the tolerance asks, or as good as rounding lets them be.
    pub(crate) fn is_settled(&self) -> bool {
        match self.solution.report.status {
            Status::Converged => true,
            Status::Stalled => self.at_floor,
            _ => false,
        }
    }
}

impl<T: Real> Solved<T> {
    /// The place in which the solve has ended.
    pub(crate) fn place(&self) -> Place<T> {
        let gap = self.whole.as_ref().map_or(&self.solution.gap, |(_, gap)| gap).clone();
        Place { gap, not_parted: self.not_parted.clone(), touches: self.touches }
    }

    pub(crate) fn with_place(self) -> (Solution<T>, Place<T>) {
        let gap = self.whole.map_or_else(|| self.solution.gap.clone(), |(_, gap)| gap);
        (self.solution, Place { gap, not_parted: self.not_parted, touches: self.touches })
    }
}

impl<T: Real> Solution<T> {
    /// The solution with whole fields, on every one of the processes that share its grid. All of them have to ask.
    pub fn whole(&self) -> Cow<'_, Self> {
        if !self.grid.is_shared() {
            return Cow::Borrowed(self);
        }
        let whole = |field: &Array2<T>| self.grid.whole(field).into_owned();
        let [gap, pressure, contact_pressure] = [&self.gap, &self.pressure, &self.contact_pressure].map(whole);
        let (plastic_depth, grid) = (self.plastic_depth.as_ref().map(whole), self.grid.alone());
        let touched = self.touched.as_ref().map(|touched| self.grid.whole(touched).into_owned());
        let (report, law) = (self.report.clone(), self.law.clone());
        Cow::Owned(Self { gap, pressure, contact_pressure, plastic_depth, touched, grid, report, law })
    }

    /// Refuses an adhesion law of another name or work of adhesion than the solution's.
    pub(crate) fn check_law(&self, law: &dyn AdhesionLaw<T>) -> Result<()> {
        let hints = law.hints();
        let (value, known) = (hints.work_of_adhesion.widen(), self.report.work_of_adhesion);
        let same = value == known || (value - known).abs() <= T::epsilon().widen().sqrt() * known.abs();
        let name = match same {
            true if self.report.law == hints.known_as() => return Ok(()),
            true => "work of adhesion of a law of another name",
            false => "work of adhesion",
        };
        let requirement = "the solution's: give the law of its problem";
        Err(Error::Value { name, value, requirement })
    }

    /// Refuses a problem with another grid, body, law or wall than the solution's.
    pub(crate) fn check(&self, problem: &ProblemMut<'_, T>, constraint: &dyn ContactConstraint<T>) -> Result<()> {
        let (own, grid, wall) = (self.grid.lengths(), problem.grid(), constraint.wall().name());
        Error::shape("solution", self.grid.shape(), grid.shape())?;
        let figures = [
            ("side length Lx of the solution", own.0, grid.lengths().0),
            ("side length Ly of the solution", own.1, grid.lengths().1),
            ("contact modulus of the solution", self.report.modulus, problem.operator.modulus()),
        ];
        let other = |(_, found, expected): &(_, f64, f64)| found.total_cmp(expected).is_ne();
        if let Some((name, value, _)) = figures.into_iter().find(other) {
            return Err(Error::Value { name, value, requirement: "as in the problem" });
        }
        if self.report.wall != wall {
            let reason = "the solution was found with another wall: give the constraint of its solver";
            return Err(Error::Unsuited { what: wall, reason });
        }
        self.check_law(problem.law)
    }
}
