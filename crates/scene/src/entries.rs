//! The entries of an account that have keys of their own.

use asperity::accuracy::{GridError, Quantity};
use asperity::nested::Level;
use asperity::search::FoundContact;
use asperity::stability::{Stability, Verdict};
use asperity::{Branch, Report, Status};
use serde::{Serialize, Serializer};

/// The equilibrium on the other branch, and its distance.
#[derive(Clone, Debug, Serialize)]
pub struct OtherBranch {
    /// The branch.
    pub branch: Option<Branch>,
    /// The status.
    pub status: Status,
    /// The certified relative error.
    pub relative_error: f64,
    /// The error of the load.
    pub load_error: f64,
    /// The number of operator applications.
    pub operator_applications: usize,
    /// The share of the nodes in contact.
    pub contact_fraction: f64,
    /// The mean gap.
    pub mean_gap: f64,
    /// The mean external pressure.
    pub mean_pressure: f64,
    /// The elastic energy.
    pub elastic_energy: f64,
    /// The adhesive energy.
    pub adhesive_energy: f64,
    /// The distance in the energy norm; see [`Solution::distance`](asperity::Solution::distance).
    pub distance: f64,
    /// Whether the equilibrium is one.
    pub same: bool,
}

impl OtherBranch {
    pub(crate) fn of(report: &Report, distance: f64, same: bool) -> Self {
        Self {
            branch: report.branch,
            status: report.status,
            relative_error: report.relative_error,
            load_error: report.load_error,
            operator_applications: report.operator_applications,
            contact_fraction: report.contact_fraction,
            mean_gap: report.mean_gap,
            mean_pressure: report.mean_pressure,
            elastic_energy: report.elastic_energy,
            adhesive_energy: report.adhesive_energy,
            distance,
            same,
        }
    }
}

/// The cost of one of the nested grids, with that of its problem, and its results; see [`Level`].
#[derive(Clone, Debug, Serialize)]
pub struct GridLevel {
    /// The nodes (Nx, Ny) of the grid.
    #[serde(serialize_with = "list")]
    pub shape: (usize, usize),
    /// The status of its solve.
    pub status: Status,
    /// The number of steps.
    pub iterations: usize,
    /// The number of operator applications.
    pub operator_applications: usize,
    /// The certified relative error.
    pub relative_error: f64,
    /// The mean gap.
    pub mean_gap: f64,
    /// The mean external pressure.
    pub mean_pressure: f64,
    /// The mean contact pressure.
    pub mean_contact_pressure: f64,
    /// The elastic energy.
    pub elastic_energy: f64,
    /// The share of the nodes in contact.
    pub contact_fraction: f64,
    /// The contact area within its edge between the nodes.
    pub corrected_contact_fraction: f64,
    /// The contact stiffness, if it was asked for.
    pub contact_stiffness: Option<f64>,
}

impl GridLevel {
    pub(crate) fn of(level: &Level) -> Self {
        Self {
            shape: level.shape,
            status: level.status,
            iterations: level.iterations,
            operator_applications: level.operator_applications,
            relative_error: level.relative_error,
            mean_gap: level.mean_gap,
            mean_pressure: level.mean_pressure,
            mean_contact_pressure: level.mean_contact_pressure,
            elastic_energy: level.elastic_energy,
            contact_fraction: level.area.contact_fraction,
            corrected_contact_fraction: level.area.corrected_contact_fraction,
            contact_stiffness: level.stiffness.map(|found| found.pressure_per_length),
        }
    }
}

/// The estimated errors of the finest of nested grids, by quantity; none where one cannot be told, or is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GridErrors {
    /// That of the corrected area.
    pub area: Option<GridError>,
    /// That of the mean gap.
    pub gap: Option<GridError>,
    /// That of the mean pressure.
    pub pressure: Option<GridError>,
    /// That of the contact stiffness.
    pub stiffness: Option<GridError>,
}

impl GridErrors {
    pub(crate) fn of(levels: &[Level], report: &Report, nodes_per_wave: f64) -> Self {
        let [(_, area), (_, gap), (_, pressure), (_, stiffness)] = GridError::of_all(levels, report, nodes_per_wave);
        Self { area, gap, pressure, stiffness }
    }

    /// The errors with their quantities.
    pub fn all(&self) -> [(Quantity, Option<GridError>); 4] {
        let Self { area, gap, pressure, stiffness } = *self;
        [(Quantity::Area, area), (Quantity::Gap, gap), (Quantity::Pressure, pressure), (Quantity::Stiffness, stiffness)]
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
    pub fn of<T>(wanted: f64, found: &FoundContact<T>) -> Self {
        let &FoundContact { reached, below, above, solves, operator_applications, .. } = found;
        Self { wanted, reached, below, above, solves, operator_applications }
    }
}

/// The stability of an equilibrium; see [`Stability`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Steadiness {
    /// The verdict.
    pub verdict: Verdict,
    /// The smallest eigenvalue.
    pub eigenvalue: f64,
    /// The residual of its mode.
    pub residual: f64,
    /// A lower bound of the eigenvalue.
    pub lower_bound: f64,
    /// A bound of the error of the gap.
    pub error_bound: Option<f64>,
    /// Whether the law was smoothed.
    pub smoothed: bool,
    /// The number of operator applications, those for the bound included.
    pub operator_applications: usize,
}

impl Steadiness {
    pub(crate) fn of<T>(found: &Stability<T>) -> Self {
        Self {
            verdict: found.verdict,
            eigenvalue: found.eigenvalue,
            residual: found.residual,
            lower_bound: found.lower_bound,
            error_bound: found.error_bound,
            smoothed: found.smoothed,
            operator_applications: found.operator_applications + found.bound_applications,
        }
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

/// A pair, if there is one, as a list: in Python a tuple would be another value.
pub(crate) fn list<P, T, S>(pair: &P, serializer: S) -> Result<S::Ok, S::Error>
where
    P: Copy + Into<Option<(T, T)>>,
    T: Serialize,
    S: Serializer,
{
    let pair: Option<(T, T)> = (*pair).into();
    pair.map(|(first, second)| vec![first, second]).serialize(serializer)
}
