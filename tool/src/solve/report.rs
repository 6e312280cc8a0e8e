//! The report of a solve: what it found, by the keys of `report.json`.

use asperity::contact::Patch;
use asperity::nested::Level;
use asperity::{Branch, Control};
use serde_json::{Value, json};

use super::Options;
use crate::accuracy;
use crate::case::{Account, Left, Other, Search};
use crate::loads::name_and_value;
use crate::part::Part;
use crate::report;
use crate::scene::Scene;
use crate::units::Units;

impl Options {
    /// All that one needs for understanding a run later; numbers that are not finite become null.
    pub fn report(&self, part: &Part, account: &Account, units: &Units, scene: &Scene) -> Value {
        let report = &account.report;
        let (control, held) = name_and_value(report.control);
        let levels = account.grids.as_ref().map(|(levels, _)| levels.iter().map(level).collect::<Vec<_>>());
        let outcome = json!({
            "status": report.status.name(),
            "branch": report.branch.map(Branch::name),
            "other_branch": account.other.as_ref().map(other),
            "relative_error": report.relative_error,
            "load_error": report.load_error,
            "criterion": report.criterion.name(),
            "iterations": report.iterations,
            "operator_applications": report.operator_applications,
            "levels": levels,
            "equivalent_applications": account.grids.as_ref().map(|(_, applications)| applications),
            "grid_error": account.grids.as_ref().map(|(levels, _)| {
                accuracy::errors(levels, report, account.nodes_per_wave)
            }),
            "accuracy": account.reached.as_ref().map(|reached| json!({
                "wanted": reached.accuracy,
                "of": reached.of.name(),
                "reached": reached.reached,
            })),
            "search": account.search.as_ref().map(search),
            "mean_gap": report.mean_gap,
            "mean_pressure": report.mean_pressure,
            "normal_force": report.normal_force,
            "approach": report.approach,
            "spring_stiffness": spring_stiffness(report.control),
            "net_pressure": report.net_pressure,
            "mean_contact_pressure": report.mean_contact_pressure,
            "contact_fraction": report.contact_fraction,
            "contact_nodes": report.contact_nodes,
            "absent_nodes": report.absent_nodes,
            "edge_traction": report.edge_traction,
            "corrected_contact_fraction": account.contact.corrected_contact_fraction,
            "perimeter": account.contact.perimeter,
            "repulsive_fraction": account.contact.repulsive_fraction,
            "attractive_fraction": account.contact.attractive_fraction,
            "patches": account.contact.patches.iter().map(patch).collect::<Vec<_>>(),
            "min_gap": report.min_gap,
            "min_pressure": account.pressures.0,
            "max_pressure": account.pressures.1,
            "elastic_energy": report.elastic_energy,
            "adhesive_energy": report.adhesive_energy,
            "stability": account.stability.as_ref().map(|stability| json!({
                "verdict": stability.verdict.name(),
                "eigenvalue": stability.eigenvalue,
                "residual": stability.residual,
                "lower_bound": stability.lower_bound,
                "error_bound": stability.error_bound,
                "smoothed": stability.smoothed,
                "operator_applications": stability.operator_applications,
            })),
            "contact_stiffness": account.stiffness.map(|found| found.pressure_per_length),
            "normal_stiffness": account.stiffness.map(|found| found.force_per_length),
            "departures": self.leave.then(|| account.departures.iter().map(departure).collect::<Vec<_>>()),
            "mu_rho": report.mu_rho,
            "mu_rho_node": account.strongest,
            "under_resolved": report.under_resolved,
            "warnings": account.warnings,
            "seconds": account.seconds,
            "control": control,
            "control_value": held,
        });
        let mut inputs = report::inputs(self.problem(), part, units, scene);
        // with an accuracy the one that was chosen
        inputs.insert("tolerance".to_owned(), report.tolerance.into());
        report::report("solve", outcome, inputs)
    }
}

/// The contact of the nodes of one work of adhesion.
fn patch(patch: &Patch) -> Value {
    json!({
        "work_of_adhesion": patch.work_of_adhesion,
        "area_fraction": patch.area_fraction,
        "contact_fraction": patch.contact_fraction,
        "attractive_fraction": patch.attractive_fraction,
    })
}

/// The equilibrium on the other branch, and its distance.
fn other(other: &Other) -> Value {
    let report = &other.report;
    json!({
        "branch": report.branch.map(Branch::name),
        "status": report.status.name(),
        "relative_error": report.relative_error,
        "load_error": report.load_error,
        "operator_applications": report.operator_applications,
        "contact_fraction": report.contact_fraction,
        "mean_gap": report.mean_gap,
        "mean_pressure": report.mean_pressure,
        "elastic_energy": report.elastic_energy,
        "adhesive_energy": report.adhesive_energy,
        "distance": other.distance,
        "same": other.same,
    })
}

/// The search for the load of a contact fraction.
fn search(search: &Search) -> Value {
    json!({
        "wanted": search.wanted,
        "reached": search.reached,
        "below": search.below,
        "above": search.above,
        "solves": search.solves,
        "operator_applications": search.operator_applications,
    })
}

/// The stiffness of a spring, if the load is one.
fn spring_stiffness(control: Control) -> Option<f64> {
    if let Control::Spring { stiffness, .. } = control { Some(stiffness) } else { None }
}

/// The cost of one of the nested grids and what it found; the applications include the one that constructs its problem.
fn level(level: &Level) -> Value {
    json!({
        "shape": level.shape,
        "status": level.status.name(),
        "iterations": level.iterations,
        "operator_applications": level.operator_applications,
        "relative_error": level.relative_error,
        "mean_gap": level.mean_gap,
        "mean_pressure": level.mean_pressure,
        "mean_contact_pressure": level.mean_contact_pressure,
        "elastic_energy": level.elastic_energy,
        "contact_fraction": level.area.contact_fraction,
        "corrected_contact_fraction": level.area.corrected_contact_fraction,
        "contact_stiffness": level.stiffness.map(|found| found.pressure_per_length),
    })
}

/// The cost of the departure from an unstable equilibrium.
fn departure(left: &Left) -> Value {
    json!({ "eigenvalue": left.eigenvalue, "energy_drop": left.energy_drop, "distance": left.distance })
}
