//! The entries of an account that have keys of their own.

use asperity::accuracy::{GridError, Quantity};
use asperity::nested::Level;
use asperity::search::FoundContact;
use asperity::stability::{Stability, Verdict};
use asperity::{Branch, Real, Report, Status};
use serde::Serialize;

use crate::account::record;

record! {
    /// The equilibrium on the other branch, and its distance.
    #[derive(Clone, Debug, Serialize)]
    OtherBranch of (report: &Report, distance: f64, same: bool) {
        /// The branch.
        branch: Option<Branch> = report.branch,
        /// The status.
        status: Status = report.status,
        /// The certified relative error.
        relative_error: f64 = report.relative_error,
        /// The error of the load.
        load_error: f64 = report.load_error,
        /// The number of operator applications.
        operator_applications: usize = report.operator_applications,
        /// The share of the nodes in contact.
        contact_fraction: f64 = report.contact_fraction,
        /// The mean gap.
        mean_gap: f64 = report.mean_gap,
        /// The mean external pressure.
        mean_pressure: f64 = report.mean_pressure,
        /// The elastic energy.
        elastic_energy: f64 = report.elastic_energy,
        /// The adhesive energy.
        adhesive_energy: f64 = report.adhesive_energy,
        /// The distance in the energy norm; see [`Solution::distance`](asperity::Solution::distance).
        distance: f64 = distance,
        /// Whether the equilibrium is one.
        same: bool = same,
    }
}

record! {
    /// The cost of one of the nested grids, with that of its problem, and its results; see [`Level`].
    #[derive(Clone, Debug, Serialize)]
    GridLevel of (level: &Level) {
        /// The nodes (Nx, Ny) of the grid.
        shape: (usize, usize) = level.shape,
        /// The status of its solve.
        status: Status = level.status,
        /// The number of steps.
        iterations: usize = level.iterations,
        /// The number of operator applications.
        operator_applications: usize = level.operator_applications,
        /// The certified relative error.
        relative_error: f64 = level.relative_error,
        /// The mean gap.
        mean_gap: f64 = level.mean_gap,
        /// The mean external pressure.
        mean_pressure: f64 = level.mean_pressure,
        /// The mean contact pressure.
        mean_contact_pressure: f64 = level.mean_contact_pressure,
        /// The elastic energy.
        elastic_energy: f64 = level.elastic_energy,
        /// The share of the nodes in contact.
        contact_fraction: f64 = level.area.contact_fraction,
        /// The contact area within its edge between the nodes.
        corrected_contact_fraction: f64 = level.area.corrected_contact_fraction,
        /// The contact area that the theory of JKR means, with a law that has the range of the grid.
        jkr_contact_fraction: Option<f64> = level.area.jkr_contact_fraction,
        /// The contact stiffness, if it was asked for.
        contact_stiffness: Option<f64> = level.stiffness.map(|found| found.pressure_per_length),
    }
}

/// The estimated errors of the finest of nested grids, by quantity; none where one cannot be told, or is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GridErrors {
    /// That of the corrected area.
    pub area: Option<GridError>,
    /// That of the mean gap.
    pub gap: Option<GridError>,
    /// That of the approach.
    pub approach: Option<GridError>,
    /// That of the mean pressure.
    pub pressure: Option<GridError>,
    /// That of the contact stiffness.
    pub stiffness: Option<GridError>,
}

impl GridErrors {
    pub(crate) fn of(levels: &[Level], report: &Report, nodes_per_wave: f64) -> Self {
        let [(_, area), (_, gap), (_, approach), (_, pressure), (_, stiffness)] =
            GridError::of_all(levels, report, nodes_per_wave);
        Self { area, gap, approach, pressure, stiffness }
    }

    /// The errors with their quantities.
    pub fn all(&self) -> [(Quantity, Option<GridError>); 5] {
        let Self { area, gap, approach, pressure, stiffness } = *self;
        let errors = [area, gap, approach, pressure, stiffness];
        std::array::from_fn(|i| (Quantity::ALL[i], errors[i]))
    }
}

/// The end of a solve to an accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reached {
    /// The relative error that was wanted.
    pub wanted: f64,
    /// The quantity that has it.
    pub of: Quantity,
    /// Whether it was reached.
    pub reached: bool,
    /// Whether the surface could have been refined.
    #[serde(skip)]
    pub refinable: bool,
    /// The next finer grid, and its bytes, if that was too much.
    #[serde(skip)]
    pub unaffordable: Option<((usize, usize), f64)>,
}

/// The search for the load of a contact fraction; see [`FoundContact`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Search {
    /// The contact fraction that was wanted.
    pub wanted: f64,
    /// Whether it was reached.
    pub reached: bool,
    /// The nearest contact fraction below.
    pub below: Option<f64>,
    /// The nearest contact fraction above.
    pub above: Option<f64>,
    /// The number of solves.
    pub solves: usize,
    /// The operator applications of all solves.
    pub operator_applications: usize,
}

impl Search {
    /// The search for a fraction.
    pub fn of<T: Real>(wanted: f64, found: &FoundContact<T>) -> Self {
        let &FoundContact { reached, below, above, solves, operator_applications, .. } = found;
        Self { wanted, reached, below, above, solves, operator_applications }
    }
}

record! {
    /// The stability of an equilibrium; see [`Stability`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Steadiness of <T> (found: &Stability<T>) {
        /// The verdict.
        verdict: Verdict = found.verdict,
        /// The smallest eigenvalue.
        eigenvalue: f64 = found.eigenvalue,
        /// The residual of its mode.
        residual: f64 = found.residual,
        /// A lower bound of the eigenvalue.
        lower_bound: f64 = found.lower_bound,
        /// A bound of the error of the gap.
        error_bound: Option<f64> = found.error_bound,
        /// Whether the law was smoothed.
        smoothed: bool = found.smoothed,
        /// The number of operator applications, those for the bound included.
        operator_applications: usize = found.operator_applications + found.bound_applications,
    }
}

/// An unstable equilibrium that was left; see [`Departure`](asperity::stability::Departure).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Left {
    /// Its smallest eigenvalue.
    pub eigenvalue: f64,
    /// The energy that the departure sets free.
    pub energy_drop: f64,
    /// The distance to the next equilibrium in the energy norm.
    pub distance: f64,
}

/// The place of a state on a cycle, by the names of its columns; see [`PathStep`](asperity::path::PathStep).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The leg: 0 is the start, 1 the way to the second load.
    pub leg: usize,
    /// The direction of the leg, or `"start"`.
    pub direction: &'static str,
    /// The work done by the load since the start, per area.
    pub work: f64,
    /// The energy dropped in jumps since the start, per area.
    pub dissipated: f64,
    /// The imbalance of energy.
    pub imbalance: f64,
    /// The event before the state.
    pub event: Option<&'static str>,
    /// The energy that its jump dissipates, per area.
    pub energy_drop: Option<f64>,
}
