use std::ops::ControlFlow;

use super::fitted::COST;
use super::refine::twice;
use super::{GridError, Quantity, adhesion, resolves_adhesion};
use crate::adhesion::{AdhesionLaw, Discretisation, SharedLaw, mu_rho};
use crate::constraint::{ContactConstraint, Wall};
use crate::degrees::ROUGHLY;
use crate::elastic::{ElasticOperator, OnGrids};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::nested::{GridObserver, Level, Nested, equivalent_applications};
use crate::problem::Control;
use crate::real::{Real, once};
use crate::setters::setters;
use crate::solver::{Iteration, Settings, Solution, Solver};
use crate::stability::ContactStiffness;
use crate::surface::Surface;

once! {
    /// A solve to an accuracy.
    refine<'a, T>(
        accuracy: &'a Accuracy, solver: &'a mut Solver<dyn ContactConstraint<T>>, surface: &'a Surface,
        operators: &'a mut dyn OnGrids<T>,
        law: &'a SharedLaw<T>, control: Control, observe: GridObserver<'a>,
    ) -> Result<AccurateSolution<T>> = Accuracy::refine;
}

/// The tolerance of the solver as a share of the accuracy.
const SHARE: f64 = 0.05;

/// The least nodes along a side of a coarser grid.
pub(super) const COARSEST: usize = 16;

/// The least nodes along a side of the grids with which a search for a pull-off or for the grid of a loop begins.
pub(super) const FIRST: usize = 32;

/// The most doublings of a grid.
pub(super) const MOST_DOUBLINGS: i32 = 40;

/// The memory that a solve may take by default, in bytes: 4 GiB.
const MEMORY: f64 = 4.0 * 1_073_741_824.0;

/// An accuracy that is asked for: a relative error of a quantity, from which tolerance and grid follow.
///
/// The given grid is solved first, with coarser ones below it ([`Nested`]), and its error estimated ([`GridError`]). As
/// long as the estimate and the certified error of the solver together exceed the accuracy, the surface is put on twice as
/// many nodes along its sides by Fourier interpolation ([`resample`](crate::surface::resample), but with node (0, 0) in
/// its place; with a free boundary continued by its mirror images).
///
/// The answer has the grid of [`AccurateSolution::surface`], never coarser than the given one. A surface with absent
/// nodes, and one with steps are not refined. A [`Varying`](crate::adhesion::Varying) law has the work of adhesion of
/// each node on all nodes in its place; other laws that vary are not refined.
///
/// ```
/// use asperity::accuracy::{Accuracy, Quantity};
/// use asperity::{Control, Grid, NoAdhesion, SelfAffine, Solver, Westergaard};
/// // the shortest wave has four nodes: too few for an area that is right to 2 %
/// let surface = SelfAffine::default().k_s(16.0).surface(Grid::square(64, 1.0)?)?;
/// let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
/// let (wanted, load) = (Accuracy::new(0.02, Quantity::Area), Control::MeanPressure(2e-3));
/// let found = wanted.solve(&mut Solver::default(), &surface, half_space, NoAdhesion, load)?;
/// assert!(found.reached && found.error.unwrap().relative < 0.02);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The relative error that is wanted, between 0 and 1.
    pub target: f64,
    /// The quantity that has it.
    pub of: Quantity,
    /// The bytes that a solve on a refined grid may take; 4 GiB by default.
    pub memory: f64,
    /// The given grid and coarser ones, by default all down to 16 nodes along a side.
    pub nested: Nested,
}

/// The expected cost of a solve to an accuracy, from the cost on other surfaces.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The [nodes of the shortest wave](crate::surface::Spectrum::nodes_per_wave) on the given grid.
    pub nodes_per_wave: f64,
    /// The tolerance of the solver.
    pub tolerance: f64,
    /// The grid that is likely to be fine enough.
    pub shape: (usize, usize),
    /// The memory that it takes, in bytes.
    pub bytes: f64,
    /// The time that it takes, in operator applications on the given grid.
    pub applications: f64,
}

/// The solution to an accuracy; [`Accuracy`] has an example.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct AccurateSolution<T: Real> {
    /// The solution on the finest grid.
    pub solution: Solution<T>,
    /// The surface on that grid.
    pub surface: Surface,
    /// All grids, the finest last.
    pub levels: Vec<Level>,
    /// The estimated error of the finest grid, if it can be told.
    pub error: Option<GridError>,
    /// Whether the estimate, with the error of the solver, meets the accuracy.
    pub reached: bool,
    /// Whether the surface and the law are known on finer grids. At steps and between plateaus interpolated heights are a
    /// guess that decides the contact: then this is false, and the solution is that on the given grid.
    pub refinable: bool,
    /// The next finer grid and its memory in bytes, if that was too much.
    pub unaffordable: Option<((usize, usize), f64)>,
}

impl<T: Real> AccurateSolution<T> {
    /// All operator applications, [as on nested grids](crate::nested::NestedSolution::equivalent_applications).
    pub fn equivalent_applications(&self) -> f64 {
        equivalent_applications(&self.levels)
    }
}

pub(super) fn is_refinable<T: Real>(surface: &Surface, law: &dyn AdhesionLaw<T>) -> bool {
    let known = law.hints().shape.is_none() || law.adapted(Discretisation::Fine(2, 2)).is_some();
    surface.absent().is_none() && known && surface.grid().nodes() > 1
}

/// The law of a surface on the grid of a coarser one.
pub(super) fn on_coarse<T: Real>(law: &SharedLaw<T>, surface: &Surface, coarse: &Surface) -> SharedLaw<T> {
    let ((nx, ny), (cx, cy)) = (surface.grid().shape(), coarse.grid().shape());
    law.adapted(Discretisation::Coarse(nx / cx, ny / cy)).map_or_else(|| law.clone(), SharedLaw)
}

/// The law of a surface on the grid of a finer one.
pub(super) fn on_twice<T: Real>(law: SharedLaw<T>, surface: &Surface, fine: &Surface) -> SharedLaw<T> {
    let ((nx, ny), (fx, fy)) = (surface.grid().shape(), fine.grid().shape());
    law.adapted(Discretisation::Fine(fx / nx, fy / ny)).map_or(law, SharedLaw)
}

impl Accuracy {
    /// An accuracy of a quantity.
    pub fn new(target: f64, of: Quantity) -> Self {
        // a coarser grid that gives no start tells the error all the same
        let nested = Nested::default().coarsest(COARSEST).closed(1.0);
        Self { target, of, memory: MEMORY, nested }
    }

    setters! { memory: f64, nested: Nested }

    /// The tolerance of a solver: a twentieth of the accuracy, and at most 1e-3; or the one of its settings.
    ///
    /// # Errors
    /// [`Error::Value`] if the accuracy is not between 0 and 1, or the given tolerance is larger.
    pub fn tolerance(&self, settings: &Settings) -> Result<f64> {
        if !(self.target > 0.0 && self.target < 1.0) {
            let (name, value, requirement) = ("accuracy", self.target, "between 0 and 1, such as 0.01 for 1 %");
            return Err(Error::Value { name, value, requirement });
        }
        let needed = (SHARE * self.target).min(ROUGHLY);
        match settings.tolerance {
            Some(value) if value > needed => {
                let requirement = "at most a twentieth of the accuracy, and at most 1e-3; without one it is chosen";
                Err(Error::Value { name: "tolerance", value, requirement })
            }
            given => Ok(given.unwrap_or(needed)),
        }
    }

    /// The plan of a solver for a surface, the operator on its grid, a law, and a control.
    ///
    /// # Errors
    /// [`Error::Unaffordable`] if the grid is far beyond the memory; [`Error::Unsuited`] if the control gives the
    /// quantity; otherwise as [`Accuracy::tolerance`].
    pub fn plan<T: Real>(
        &self,
        solver: &Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operator: &mut dyn ElasticOperator<T>,
        law: &dyn AdhesionLaw<T>,
        control: Control,
    ) -> Result<Plan> {
        surface.grid().refuse_shared("accuracy")?;
        let tolerance = self.tolerance(&solver.settings)?;
        self.of.check(control)?;
        let boundary = operator.boundary();
        self.of.check_in(boundary)?;
        let nodes_per_wave = surface.nodes_per_wave(boundary);
        let refinable = is_refinable(surface, law);
        let line = surface.grid().shape().0 == 1 || surface.grid().shape().1 == 1;
        let by_edge = self.asks_the_edge(solver.constraint.wall(), surface, law) && boundary.is_periodic();
        let (mu_rho, hints) = (mu_rho(law, surface.grid(), operator.modulus()), law.hints());
        let length = if hints.of_grid { hints.work_of_adhesion.widen() / operator.modulus() } else { 0.0 };
        let adhesion = adhesion(surface, nodes_per_wave, length);
        let needed = |smaller| {
            if refinable { self.refinements((nodes_per_wave, mu_rho), (by_edge, adhesion, line), smaller) } else { 0 }
        };
        let refinements = needed(1.0);
        let nodes = operator.grid().nodes() as f64;
        let (nx, ny) = twice(surface.grid().shape());
        let growth = (nx * ny) as f64 / surface.grid().nodes() as f64;
        let bytes = |refinements: i32| 8.0 * COST.numbers * nodes * growth.powi(refinements);
        let shape = |refinements| (0..refinements).fold(surface.grid().shape(), |shape, _| twice(shape));
        let least = needed(COST.doubt);
        if least > 0 && bytes(least) > self.memory {
            let most = (0..least).rev().find(|&refinements| bytes(refinements) <= self.memory).unwrap_or(0);
            let finer = f64::from(most).exp2();
            let resolved = resolves_adhesion(mu_rho, finer);
            return Err(Error::Unaffordable {
                quantity: self.of.name(),
                accuracy: self.target,
                shape: shape(refinements),
                bytes: bytes(refinements),
                available: self.memory,
                affordable: if resolved {
                    self.of.expected(nodes_per_wave * finer, adhesion, line)
                } else {
                    f64::INFINITY
                },
            });
        }
        let applications = COST.applications * growth.powi(refinements);
        Ok(Plan { nodes_per_wave, tolerance, shape: shape(refinements), bytes: bytes(refinements), applications })
    }

    fn asks_the_edge<T: Real>(&self, wall: Wall<'_, T>, surface: &Surface, law: &dyn AdhesionLaw<T>) -> bool {
        let sharp = wall.is_rigid() && !law.hints().of_grid;
        self.of != Quantity::Area && surface.absent().is_none() && sharp
    }

    /// The expected refinements, if errors are smaller than expected by the factor `smaller`.
    fn refinements(
        &self,
        (nodes_per_wave, mu_rho): (f64, f64),
        (by_edge, adhesion, line): (bool, f64, bool),
        smaller: f64,
    ) -> i32 {
        // without a coarser grid the waves tell the error of the area, and the edge the errors of the others
        let least = GridError::LEAST_NODES_PER_WAVE;
        let least = if by_edge || self.of == Quantity::Area { least } else { 2.0 * least };
        let enough = |refinements: &i32| {
            let finer = f64::from(*refinements).exp2();
            let nodes = nodes_per_wave * finer;
            resolves_adhesion(mu_rho, finer)
                && nodes >= least
                && self.of.expected(nodes, adhesion, line) <= smaller * self.target
        };
        (0..MOST_DOUBLINGS).find(enough).unwrap_or(MOST_DOUBLINGS)
    }

    /// Solves to the accuracy, if it can: see [`AccurateSolution::reached`]. The body has `operators` on each grid.
    ///
    /// # Errors
    /// [`Error::Unsuited`] if the control gives the quantity; otherwise as [`Accuracy::tolerance`] and
    /// [`Nested::solve`].
    pub fn solve<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        control: Control,
    ) -> Result<AccurateSolution<T>> {
        self.solve_observed(solver, surface, operators, law, control, |_, _| ControlFlow::Continue(()))
    }

    /// Solves as [`Accuracy::solve`], and calls `observe` with the grid in every iteration; where it stops a solve, no
    /// finer grid follows.
    ///
    /// # Errors
    /// As [`Accuracy::solve`].
    pub fn solve_observed<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        mut operators: impl OnGrids<T>,
        law: impl AdhesionLaw<T> + 'static,
        control: Control,
        mut observe: impl FnMut(&Grid, &Iteration) -> ControlFlow<()> + Send,
    ) -> Result<AccurateSolution<T>> {
        let tolerance = self.tolerance(&solver.settings)?;
        self.of.check(control)?;
        let mut nested = self.nested.coarse_tolerance(tolerance);
        if self.asks_the_edge(solver.constraint.wall(), surface, &law) {
            let needed = tolerance.min(ContactStiffness::TOLERANCE);
            nested = nested.stiffness(nested.stiffness.map_or(needed, |given| given.min(needed)));
        }
        let (wanted, law) = (Self { nested, ..*self }, SharedLaw::new(law));
        solver.to(tolerance, |solver| refine(&wanted, solver, surface, &mut operators, &law, control, &mut observe))
    }
}
