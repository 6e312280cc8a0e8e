//! The branch of equilibria with adhesion.

use ndarray::Zip;

#[cfg(doc)]
use super::Report;
use super::descent::rey2017;
use super::start::{Begin, Start};
use super::{Method, Settings, Solution, Status};
use crate::adhesion::AdhesionLaw;
use crate::constraint::Wall;
use crate::degrees::FAR;
use crate::error::Result;
use crate::names::names;
use crate::problem::{Load, PressedFlat};
use crate::real::Real;

/// The branch of equilibria on which a solve with adhesion starts.
///
/// With adhesion a load may have several equilibria. If the traction of the law falls with the gap, surfaces pressed
/// together from afar come to the equilibrium with the largest gap at every node, and surfaces that were pressed flat
/// to the equilibrium with the smallest gap. The page [`branches`](crate::guide::branches) says how well a solve keeps
/// to its branch.
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
    /// The branch of surfaces pressed together from afar. A solve starts from the gap that the wall alone leaves under
    /// the load, under a tension from undeformed surfaces that touch.
    Loading,
    /// The branch of surfaces pressed flat before. A solve starts from full contact, at a given mean gap from a uniform
    /// gap.
    Unloading,
}

names!(Branch { Loading = "loading", Unloading = "unloading" });

impl Branch {
    /// The other branch.
    pub fn other(self) -> Self {
        match self {
            Self::Loading => Self::Unloading,
            Self::Unloading => Self::Loading,
        }
    }

    /// The branch of a default start, as [`Settings::branch`] says; none without adhesion and of Algorithm 3.
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
            Begin::At(Start::From(_) | Start::Near(_)) | Begin::Found(_) | Begin::Ahead { .. } => return Ok(None),
        };
        let paper = settings.method == Method::Rey2017;
        if paper && wanted == Some(Self::Loading) {
            return Err(rey2017::refused(
                "it starts from full contact: take the default method for the branch of loading",
            ));
        }
        let presses = match load {
            Load::Gap(_) => false,
            Load::Pressure(_) | Load::Spring { .. } => load.pressure_at(flat.peak) >= 0.0,
        };
        let usual = if presses && wall.springs().is_none() { Self::Loading } else { Self::Unloading };
        Ok((!law.hints().zero && !paper).then(|| wanted.unwrap_or(usual)))
    }
}

impl<T: Real> Solution<T> {
    /// The distance of two solutions under one load in the energy norm, relative to the larger: √(⟨Δu, Δp⟩/⟨u, p⟩), on
    /// the scale of [`Report::relative_error`]; infinite between different grids.
    pub fn distance(&self, other: &Self) -> f64 {
        if self.grid != other.grid {
            return f64::INFINITY;
        }
        // absent nodes have no gap
        let change = |g: T, h: T| if g.is_finite() { g - h } else { T::zero() };
        let gaps = Zip::from(&self.gap).and(&other.gap).map_collect(|&g, &h| change(g, h));
        let pressures = &self.pressure - &other.pressure;
        let square = self.grid.mean_of_both(gaps.view(), pressures.view(), |g, p| g.widen() * p.widen());
        let [own, its] = [self, other].map(|one| one.report.error_scale.max(2.0 * one.report.elastic_energy));
        let scale = own.max(its);
        if square == 0.0 { 0.0 } else { (square.abs() / scale).sqrt() }
    }

    /// Whether two solutions under one load are the same equilibrium, to their accuracies: with adhesion a certified
    /// error bounds the distance but for a factor, the softness of the equilibrium. False without convergence.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|solution| solution.report.relative_error.max(solution.report.load_error));
        let found = [self, other].iter().all(|solution| solution.report.status == Status::Converged);
        // all processes that share the grid have to ask
        let distance = self.distance(other);
        // the stiffness of the elastic body over the stiffness of the equilibrium
        let softness = FAR * FAR;
        found && distance <= softness * (a + b)
    }
}
