//! The driver: the methods of solution, their settings, and the public solver.

use std::ops::ControlFlow;

use crate::constraint::{ContactConstraint, Projection};
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::names::names;
use crate::problem::{Control, Problem, ProblemMut};
use crate::real::{Real, once};
use crate::setters::setters;

mod branch;
mod coarse;
mod descent;
mod driver;
mod finish;
mod iterate;
mod minimisation;
mod operators;
mod passes;
mod place;
mod plan;
mod plastic;
mod posed;
mod potential;
mod precision;
mod proof;
mod report;
mod rescue;
mod stages;
mod start;
mod tension;
mod touch;
mod unload;
mod work;

pub use branch::Branch;
pub(crate) use coarse::Coarse;
pub use descent::rey2017::Criterion;
use driver::Job;
pub(crate) use driver::{Aim, Observer};
pub(crate) use minimisation::Nearness;
pub(crate) use place::Place;
pub(crate) use potential::{Least, Of, Potential, bounded};
use precision::{in_double, in_single};
pub(crate) use report::Solved;
pub use report::{Iteration, Plastic, Report, Solution, Status};
pub use start::Start;
pub(crate) use start::{Begin, check_hardness, check_wall, extrapolated, refuse_hardness, refuse_springs};
pub(crate) use unload::unload;

once! {
    /// A solve.
    solve<'a, T>(operator: &'a mut dyn ElasticOperator<T>, job: Job<'a, T>) -> Result<Solved<T>> =
        [within] in_single, in_double;
}

/// The method of iteration, one of two.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Method {
    /// Conjugate gradients preconditioned with the compliance; the energy falls in every iteration.
    #[default]
    #[cfg_attr(feature = "serde", serde(rename = "default"))]
    Preconditioned,
    /// Algorithm 3 of Rey, Anciaux and Molinari (2017), with its misprints corrected.
    Rey2017,
}

names!(Method { Preconditioned = "default", Rey2017 = "rey2017" });

/// The settings of a solve.
///
/// The tolerance is 1e-6 in `f64`, 1e-4 in `f32`, and 1e-9 by [`Criterion::Complementarity`], unless one is given.
/// Below the [floor](crate::guide::choosing#rounding-floors) of the precision a solve ends as [`Status::Stalled`]. With
/// the feature `serde` settings are data; any setting may be left out.
///
/// ```
/// use asperity::Settings;
/// let loose = Settings::default().tolerance(1e-3);
/// assert_eq!((loose.tolerance_in::<f32>(), loose.max_iterations), (1e-3, 2000));
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Settings {
    /// The iteration.
    pub method: Method,
    /// The measure that is compared with the tolerance; [`Criterion::EnergyNorm`] by default.
    pub criterion: Criterion,
    /// The tolerance of the criterion, and under pressure control of the relative error of the load, positive; `None`,
    /// the default, is [`Settings::tolerance_in`].
    pub tolerance: Option<f64>,
    /// The number of iterations after which the solve ends without having converged; 2000 by default.
    pub max_iterations: usize,
    /// The branch of equilibria of [`Start::Default`] with adhesion. `None`: loading under a load that presses;
    /// unloading under one that pulls, at a given mean gap, and with springs for a wall. A load has the sign of the
    /// pressure under which undeformed surfaces would just touch.
    pub branch: Option<Branch>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Preconditioned,
            criterion: Criterion::EnergyNorm,
            tolerance: None,
            max_iterations: 2000,
            branch: None,
        }
    }
}

impl Settings {
    /// The paper's Algorithm 3 to the certified error; its own criterion is [`Criterion::Complementarity`] < 1e-9.
    pub fn rey2017() -> Self {
        Self { method: Method::Rey2017, max_iterations: 20_000, ..Self::default() }
    }

    setters! {
        method: Method,
        criterion: Criterion,
        tolerance: impl Into<Option<f64>>,
        max_iterations: usize,
        branch: impl Into<Option<Branch>>,
    }

    /// The tolerance that holds in a precision: the given one, or the default of the criterion.
    pub fn tolerance_in<T: Real>(&self) -> f64 {
        self.tolerance.unwrap_or(match self.criterion {
            Criterion::EnergyNorm if T::NAME == f32::NAME => 1e-4,
            Criterion::EnergyNorm => 1e-6,
            Criterion::Complementarity => 1e-9,
        })
    }
}

/// The driver: minimises the energy of a [`Problem`] under a [`Control`].
///
/// One loop serves all controls, laws, operators, walls and precisions: conjugate gradients, two operator applications
/// an iteration. The page [`driver`](crate::guide::driver) derives it.
///
/// In `f64` changes, residuals and transforms are in `f32`, if the operator is [spectral](crate::ElasticOperator::spectral)
/// and its stiffnesses are in the range of `f32`; gap, pressure, certificate and report are in `f64`.
///
/// Memory per node with a [`Westergaard`](crate::Westergaard) half-space, with its problem: five scalars in `f64`,
/// seven in `f32`; the solution keeps three. With [`Boussinesq`](crate::Boussinesq) the grid has four times the nodes,
/// or somewhat more. The preconditioner of the longest waves adds up to 13 N^(2/3) numbers in `f64`: a fifth
/// of a field on 512² nodes.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Settings, Solver, Status, Surface, Westergaard};
/// let grid = Grid::line(256, 1.0)?;
/// let surface = Surface::wave(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::new(Settings::default().tolerance(1e-8));
/// let solution = solver.solve(&mut problem, Control::MeanPressure(0.03))?;
/// assert_eq!(solution.report.status, Status::Converged);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solver<C: ?Sized = Projection> {
    /// The settings of the solve.
    pub settings: Settings,
    /// The constraint that keeps the gap from becoming negative.
    pub constraint: C,
}

impl Solver {
    /// A solver that confines the gap to g ≥ 0 by projection.
    pub fn new(settings: Settings) -> Self {
        Self { settings, constraint: Projection }
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::new(Settings::default())
    }
}

impl<C> Solver<C> {
    /// Solves from the default start, [`Start::Default`].
    ///
    /// # Errors
    /// As [`Solver::solve_with`].
    pub fn solve<T: Real>(&mut self, problem: &mut Problem<T>, control: Control) -> Result<Solution<T>>
    where
        C: ContactConstraint<T> + 'static,
    {
        self.solve_with(problem, control, Start::Default, |_| ControlFlow::Continue(()))
    }

    /// Solves from a start, and calls `observe` in every iteration; it may stop the solve. [`Start`] has an example.
    ///
    /// # Errors
    /// [`Error::Unsuited`](crate::Error::Unsuited) for a control that the boundary does not have;
    /// [`Error::Value`](crate::Error::Value) for a negative or infinite mean gap, an infinite pressure, a spring
    /// without stiffness, or a tolerance that is not positive; [`Error::Shape`](crate::Error::Shape),
    /// [`Error::NotFinite`](crate::Error::NotFinite) or [`Error::Value`](crate::Error::Value) for a start that does not
    /// fit, is not finite, or is negative somewhere; [`Error::Contract`](crate::Error::Contract) if the law is not
    /// finite at the start; errors of the constraint. Without convergence see [`Report::status`].
    pub fn solve_with<T: Real>(
        &mut self,
        problem: &mut Problem<T>,
        control: Control,
        start: Start<'_, T>,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<Solution<T>>
    where
        C: ContactConstraint<T> + 'static,
    {
        let solver: &mut Solver<dyn ContactConstraint<T>> = self;
        solver.run(problem.parts(), control, Begin::At(start), &mut observe).map(|solved| solved.solution)
    }
}

impl<T: Real> Solver<dyn ContactConstraint<T>> {
    /// Works to another tolerance.
    pub(crate) fn to<R>(&mut self, tolerance: f64, work: impl FnOnce(&mut Self) -> R) -> R {
        let settings = self.settings;
        self.settings.tolerance = Some(tolerance);
        let result = work(self);
        self.settings = settings;
        result
    }

    pub(crate) fn run(
        &mut self,
        problem: ProblemMut<'_, T>,
        control: Control,
        begin: Begin<'_, T>,
        observe: Observer<'_>,
    ) -> Result<Solved<T>> {
        self.run_for(Aim::Solution, problem, control, begin, observe)
    }

    /// Solves for an aim.
    pub(crate) fn run_for(
        &mut self,
        aim: Aim,
        problem: ProblemMut<'_, T>,
        control: Control,
        begin: Begin<'_, T>,
        observe: Observer<'_>,
    ) -> Result<Solved<T>> {
        let Self { settings, constraint } = self;
        let ProblemMut { operator, law, given, flat } = problem;
        solve(operator, Job { aim, law, given, flat, constraint, control, settings: *settings, begin, observe })
    }
}
