//! The entries of an account that have keys of their own.

use asperity::accuracy::{GridError, Quantity};
use asperity::nested::Level;
use asperity::path::{Event, PathStep};
use asperity::search::FoundContact;
use asperity::stability::{Departure, Stability, Verdict};
use asperity::{Branch, Real, Report, Status};
use serde::{Deserialize, Serialize};

use crate::key::record;
use crate::numbers::percent;

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
    /// The cost of one of the nested grids, with its problem, and its results; see [`Level`].
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

record! {
    /// The estimated errors of the finest of nested grids, by quantity; none where one cannot be told, or is given.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    GridErrors of (all: [(Quantity, Option<GridError>); 4]) {
        /// That of the corrected area.
        area: Option<GridError> = all[0].1,
        /// That of the mean gap.
        gap: Option<GridError> = all[1].1,
        /// That of the approach.
        approach: Option<GridError> = all[2].1,
        /// That of the mean pressure.
        pressure: Option<GridError> = all[3].1,
    }
}

impl GridErrors {
    /// The errors with their quantities.
    pub fn all(&self) -> [(Quantity, Option<GridError>); 4] {
        let Self { area, gap, approach, pressure } = *self;
        let errors = [area, gap, approach, pressure];
        std::array::from_fn(|i| (Quantity::ALL[i], errors[i]))
    }

    /// The errors in words: of the quantity that has an accuracy; or of the area, and of quantities with a sure error.
    /// None where no such error can be told.
    pub fn in_words(&self, of_accuracy: Option<Quantity>) -> Option<String> {
        let counts = |of: Quantity, error: &GridError| match of_accuracy {
            Some(wanted) => of == wanted,
            None => of == Quantity::Area || !error.rough,
        };
        let told = self.all().into_iter().filter_map(|(of, error)| {
            let error = error.filter(|error| counts(of, error))?;
            Some(format!("{} % of the {of}{}", percent(error.relative), if error.rough { ", roughly" } else { "" }))
        });
        let words: Vec<_> = told.collect();
        (!words.is_empty()).then(|| words.join(", "))
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

record! {
    /// The search for the load of a contact fraction; see [`FoundContact`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Search of <T: Real>(wanted: f64, found: &FoundContact<T>) {
        /// The contact fraction that was wanted.
        wanted: f64 = wanted,
        /// Whether it was reached.
        reached: bool = found.reached,
        /// The nearest contact fraction below.
        below: Option<f64> = found.below,
        /// The nearest contact fraction above.
        above: Option<f64> = found.above,
        /// The number of solves.
        solves: usize = found.solves,
        /// The operator applications of all solves.
        operator_applications: usize = found.operator_applications,
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

record! {
    /// An unstable equilibrium that was left; see [`Departure`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Left of <T: Real>(eigenvalue: f64, departure: &Departure<T>) {
        /// Its smallest eigenvalue.
        eigenvalue: f64 = eigenvalue,
        /// The energy that the departure sets free.
        energy_drop: f64 = departure.energy_drop,
        /// The distance to the next equilibrium in the energy norm.
        distance: f64 = departure.distance,
    }
}

record! {
    /// The place of a state on a cycle, by the names of its columns; see [`PathStep`].
    #[derive(Clone, Debug, PartialEq, Serialize)]
    Step of <T: Real>(found: &PathStep<T>, direction: &'static str) {
        /// The leg: 0 is the start, 1 the way to the second load.
        leg: usize = found.leg,
        /// The direction of the leg, or `"start"`.
        direction: &'static str = direction,
        /// The work done by the load since the start, per area.
        work: f64 = found.work,
        /// The energy dropped in jumps since the start, per area.
        dissipated: f64 = found.dissipated,
        /// The imbalance of energy.
        imbalance: f64 = found.imbalance,
        /// The standard error of the work.
        work_error: f64 = found.work_error,
        /// The event before the state.
        event: Option<&'static str> = found.event.as_ref().map(Event::name),
        /// The energy that its jump dissipates, per area.
        energy_drop: Option<f64> = found.event.as_ref().and_then(Event::jump).map(|jump| jump.energy_drop),
    }
}
