//! The entries of an account that have keys of their own.

use asperity::accuracy::{GridError, Quantity};
use asperity::nested::Level;
use asperity::path::{Event, PathStep};
use asperity::search::FoundContact;
use asperity::stability::{Departure, Stability, Verdict};
use asperity::{Branch, Real, Report, Status};
use serde::{Deserialize, Serialize};

use crate::key::{ENERGY_PER_AREA, LENGTH, PRESSURE, PRESSURE_PER_LENGTH, record};
use crate::numbers::percent;

record! {
    /// The equilibrium on the other branch, and its distance.
    #[derive(Clone, Debug, Serialize)]
    OtherBranch of (report: &Report, distance: f64, same: bool) {
        /// Branch.
        branch: Option<Branch> = report.branch,
        /// How its solve ended.
        status: Status = report.status,
        /// Certified relative error.
        relative_error: f64 as Error = report.relative_error,
        /// Error of the load.
        load_error: f64 as Error = report.load_error,
        /// Operator applications.
        operator_applications: usize = report.operator_applications,
        /// Share of the nodes in contact.
        contact_fraction: f64 as Share = report.contact_fraction,
        /// Mean gap.
        mean_gap: f64 [LENGTH] = report.mean_gap,
        /// Mean external pressure.
        mean_pressure: f64 [PRESSURE] = report.mean_pressure,
        /// Elastic energy per area.
        elastic_energy: f64 [ENERGY_PER_AREA] = report.elastic_energy,
        /// Adhesive energy per area.
        adhesive_energy: f64 [ENERGY_PER_AREA] = report.adhesive_energy,
        /// Relative distance in the energy norm.
        distance: f64 as Share = distance,
        /// Whether both are one equilibrium.
        same: bool = same,
    }
}

record! {
    /// The cost of one of the nested grids, with its problem, and its results; see [`Level`].
    #[derive(Clone, Debug, Serialize)]
    GridLevel of (level: &Level) {
        /// Nodes (Nx, Ny) of the grid.
        shape: (usize, usize) = level.shape,
        /// How its solve ended.
        status: Status = level.status,
        /// Iterations.
        iterations: usize = level.iterations,
        /// Operator applications.
        operator_applications: usize = level.operator_applications,
        /// Certified relative error.
        relative_error: f64 as Error = level.relative_error,
        /// Mean gap.
        mean_gap: f64 [LENGTH] = level.mean_gap,
        /// Mean external pressure.
        mean_pressure: f64 [PRESSURE] = level.mean_pressure,
        /// Mean contact pressure.
        mean_contact_pressure: f64 [PRESSURE] = level.mean_contact_pressure,
        /// Elastic energy per area.
        elastic_energy: f64 [ENERGY_PER_AREA] = level.elastic_energy,
        /// Share of the nodes in contact.
        contact_fraction: f64 as Share = level.area.contact_fraction,
        /// Share of the area within the contact edge.
        corrected_contact_fraction: f64 as Share = level.area.corrected_contact_fraction,
        /// With `jkr`, the area of the theory of JKR.
        jkr_contact_fraction: Option<f64> as Share = level.area.jkr_contact_fraction,
        /// Contact stiffness, if it was asked for.
        contact_stiffness: Option<f64> [PRESSURE_PER_LENGTH] = level.stiffness.map(|found| found.pressure_per_length),
    }
}

record! {
    /// The estimated errors of the finest of nested grids, by quantity; none where one cannot be told, or is given.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    GridErrors of (all: [(Quantity, Option<GridError>); 4]) {
        /// Error of the corrected area.
        area: Option<GridError> = all[0].1,
        /// Error of the mean gap.
        gap: Option<GridError> = all[1].1,
        /// Error of the approach.
        approach: Option<GridError> = all[2].1,
        /// Error of the mean pressure.
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

record! {
    /// The end of a solve to an accuracy.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Refinement of (wanted: f64, of: Quantity, reached: bool, refinable: bool, unaffordable: Option<((usize, usize), f64)>) {
        /// Relative error that was wanted.
        wanted: f64 = wanted,
        /// Quantity that has it.
        of: Quantity = of,
        /// Whether it was reached.
        reached: bool = reached,
        /// Whether the surface could have been refined.
        #[serde(skip)]
        refinable: bool = refinable,
        /// The next finer grid, and its bytes, if that was too much.
        #[serde(skip)]
        unaffordable: Option<((usize, usize), f64)> = unaffordable,
    }
}

record! {
    /// The search for the load of a contact fraction; see [`FoundContact`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Search of <T: Real>(wanted: f64, found: &FoundContact<T>) {
        /// Contact fraction that was wanted.
        wanted: f64 = wanted,
        /// Whether it was reached.
        reached: bool = found.reached,
        /// Nearest contact fraction below.
        below: Option<f64> = found.below,
        /// Nearest contact fraction above.
        above: Option<f64> = found.above,
        /// Solves.
        solves: usize = found.solves,
        /// Operator applications of all solves.
        operator_applications: usize = found.operator_applications,
    }
}

record! {
    /// The stability of an equilibrium; see [`Stability`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Steadiness of <T> (found: &Stability<T>) {
        /// `stable`, `unstable` or `undecided`.
        verdict: Verdict = found.verdict,
        /// Smallest eigenvalue.
        eigenvalue: f64 = found.eigenvalue,
        /// Residual of its mode.
        residual: f64 = found.residual,
        /// Lower bound of the eigenvalue.
        lower_bound: f64 = found.lower_bound,
        /// Bound of the error of the gap.
        error_bound: Option<f64> = found.error_bound,
        /// Whether the law was smoothed.
        smoothed: bool = found.smoothed,
        /// Operator applications, with the applications for the bound.
        operator_applications: usize = found.operator_applications + found.bound_applications,
    }
}

record! {
    /// An unstable equilibrium that was left; see [`Departure`].
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    Left of <T: Real>(eigenvalue: f64, departure: &Departure<T>) {
        /// Smallest eigenvalue.
        eigenvalue: f64 = eigenvalue,
        /// Energy per area that the departure sets free.
        energy_drop: f64 [ENERGY_PER_AREA] = departure.energy_drop,
        /// Relative distance to the next equilibrium in the energy norm.
        distance: f64 as Share = departure.distance,
    }
}

record! {
    /// The place of a state on a cycle, by the names of its columns; see [`PathStep`].
    #[derive(Clone, Debug, PartialEq, Serialize)]
    Step of <T: Real>(found: &PathStep<T>, direction: &'static str) {
        /// Leg of the loads: 0 is the start, 1 the way to the second load.
        leg: usize = found.leg,
        /// `approach` or `withdrawal`, at the start `start`.
        direction: &'static str = direction,
        /// Work done by the load since the start, per area.
        work: f64 [ENERGY_PER_AREA] = found.work,
        /// Energy dissipated in jumps since the start, per area.
        dissipated: f64 [ENERGY_PER_AREA] = found.dissipated,
        /// Change of the energy plus `dissipated` less `work`, per area: zero up to the errors of quadrature and tolerance.
        imbalance: f64 [ENERGY_PER_AREA] = found.imbalance,
        /// Standard error of `work`, and over a closed cycle of the energy dissipated.
        work_error: f64 [ENERGY_PER_AREA] = found.work_error,
        /// Event before the state: `touch`, `jump-in`, `jump-out`, `pull-off`, `bifurcation` or `limit-point`.
        event: Option<&'static str> = found.event.as_ref().map(Event::name),
        /// Energy that the jump of the event dissipates, per area.
        energy_drop: Option<f64> [ENERGY_PER_AREA] = found.event.as_ref().and_then(Event::jump).map(|jump| jump.energy_drop),
    }
}
