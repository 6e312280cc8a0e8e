//! The branch of equilibria with adhesion: that of surfaces which come together, or that of surfaces which come apart.

use std::fmt;

use ndarray::Zip;

#[cfg(doc)]
use super::Report;
use super::start::{Begin, Start};
use super::{Method, Settings, Solution, Status};
use crate::adhesion::AdhesionLaw;
use crate::constraint::Wall;
use crate::error::{Error, Result};
use crate::problem::{Load, PressedFlat};
use crate::real::Real;

/// The distance between two solutions of one equilibrium, over the sum of their certified errors, that there may be:
/// the stiffness of the elastic body alone over that of the equilibrium.
const SOFT: f64 = 100.0;

/// The branch of equilibria on which a solve with adhesion starts.
///
/// With adhesion several gaps may be in equilibrium under one load. Of a law whose traction falls with the gap one of
/// them is the largest, at every node, and one the smallest; all others lie between. Surfaces that are pressed
/// together from afar come to the largest, surfaces that were pressed flat before to the smallest. Where both are the
/// same there is but one equilibrium. The page [`branches`](crate::guide::branches) says how well a solve keeps to its
/// branch.
///
/// ```
/// use asperity::{Branch, Control, Exponential, Grid, Problem, Settings, Solver, Surface, Westergaard};
/// let grid = Grid::line(128, 1.0)?;
/// let wave = Surface::wave(grid, 0.02, 1)?;
/// let mut problem = Problem::new(&wave, Westergaard::<f64>::new(grid, 1.0)?, Exponential::new(4e-4, 4e-3)?)?;
/// let mut contact = |branch| {
///     let mut solver = Solver::new(Settings::default().branch(branch));
///     Ok::<_, asperity::Error>(solver.solve(&mut problem, Control::MeanPressure(0.0))?.report.contact_fraction)
/// };
/// let [loading, unloading] = [contact(Branch::Loading)?, contact(Branch::Unloading)?];
/// assert!(0.0 < loading && loading < 1.0 && unloading == 1.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Branch {
    /// That of surfaces which are pressed together from afar. A solve starts from the gap that the wall alone would
    /// leave, without adhesion, under the load that is given; under a tension from undeformed surfaces that touch.
    Loading,
    /// That of surfaces which were pressed flat before. A solve starts from full contact, and at a given mean gap from
    /// a uniform gap.
    Unloading,
}

impl Branch {
    /// The name that the tool and the report use: `"loading"` or `"unloading"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Loading => "loading",
            Self::Unloading => "unloading",
        }
    }

    /// The other one of the two branches.
    pub fn other(self) -> Self {
        match self {
            Self::Loading => Self::Unloading,
            Self::Unloading => Self::Loading,
        }
    }

    /// The branch on which a solve from the default start begins; nothing where there is but one equilibrium, without
    /// adhesion, and of Algorithm 3, whose start is the paper's.
    ///
    /// Where the settings name none it is loading under a load that would press undeformed surfaces which just touch,
    /// and unloading under one that would pull them, at a given mean gap, and where springs stand for the wall.
    pub(crate) fn of_start<T: Real>(
        begin: &Begin<'_, T>,
        settings: &Settings,
        law: &dyn AdhesionLaw<T>,
        (load, wall): (Load, Wall<'_, T>),
        flat: &PressedFlat<T>,
    ) -> Result<Option<Self>> {
        let wanted = match *begin {
            Begin::At(Start::Default) | Begin::Prolonged(_) => settings.branch,
            Begin::On(branch) => Some(branch),
            Begin::At(Start::From(_) | Start::Near(_)) | Begin::Found(_) => return Ok(None),
        };
        let paper = settings.method == Method::Rey2017;
        if paper && wanted == Some(Self::Loading) {
            return Err(Error::Control {
                control: "Algorithm 3 of Rey, Anciaux and Molinari (2017)",
                reason: "it starts from full contact: take the default method for the branch of loading",
            });
        }
        let presses = match load {
            Load::Gap(_) => false,
            Load::Pressure(_) | Load::Spring { .. } => load.pressure_at(flat.peak) >= 0.0,
        };
        let usual = if presses && !matches!(wall, Wall::Springs(_)) { Self::Loading } else { Self::Unloading };
        Ok((!law.hints().zero && !paper).then(|| wanted.unwrap_or(usual)))
    }
}

impl<T: Real> Solution<T> {
    /// The distance of two solutions of one problem under one load, relative to the displacement of the larger: that in
    /// the energy norm, √(⟨Δu, Δp⟩/⟨u, p⟩), by which [`Report::relative_error`] is measured too; infinite
    /// between solutions on different grids.
    ///
    /// ```
    /// use asperity::{Branch, Control, Exponential, Grid, Problem, Settings, Solver, Surface, Westergaard};
    /// let grid = Grid::square(64, 1.0)?;
    /// let surface = Surface::wave_2d(grid, 0.02, 1)?;
    /// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, Exponential::new(1e-5, 4e-3)?)?;
    /// let mut solve = |branch| {
    ///     let mut solver = Solver::new(Settings::default().branch(branch));
    ///     solver.solve(&mut problem, Control::MeanPressure(0.01))
    /// };
    /// let [loading, unloading] = [solve(Branch::Loading)?, solve(Branch::Unloading)?];
    /// assert!(loading.distance(&unloading) < 1e-5 && loading.agrees_with(&unloading));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn distance(&self, other: &Self) -> f64 {
        if self.grid != other.grid {
            return f64::INFINITY;
        }
        // absent nodes have no gap
        let change = |g: T, h: T| if g.is_finite() { g - h } else { T::zero() };
        let gaps = Zip::from(&self.gap).and(&other.gap).map_collect(|&g, &h| change(g, h));
        let pressures = &self.pressure - &other.pressure;
        let square = self.grid.mean_of_both(gaps.view(), pressures.view(), |g, p| g.widen() * p.widen());
        let scale = 2.0 * self.report.elastic_energy.max(other.report.elastic_energy);
        if square == 0.0 { 0.0 } else { (square.abs() / scale).sqrt() }
    }

    /// Whether two solutions of one problem under one load are the same equilibrium, to their accuracies: with adhesion
    /// a certified error bounds the distance to the equilibrium but for a factor, that of how soft it is. Of solves
    /// that have not converged it is not said.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|solution| solution.report.relative_error.max(solution.report.load_error));
        let found = [self, other].iter().all(|solution| solution.report.status == Status::Converged);
        // all processes that share the grid have to ask
        let distance = self.distance(other);
        found && distance <= SOFT * (a + b)
    }
}

impl fmt::Display for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
