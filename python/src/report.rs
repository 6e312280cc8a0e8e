//! The outcome of a solve, with the names and in the order of the tool's `report.json`.

use asperity::Branch;
use asperity::accuracy::GridError;
use asperity::contact::{ContactStatistics, Patch};
use asperity::nested::Level;
use asperity::stability::Stability;
use asperity_maps::warning::Warning;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::{Account, Grids, Other, Reached, Scalar, Search};
use crate::inputs::stiffness;
use crate::refusal::refusal;
use crate::sight::{Errors, Estimate};

/// A dictionary of its entries.
macro_rules! dictionary {
    ($py:expr, $($name:literal: $value:expr,)*) => {{
        let entries = PyDict::new($py);
        $(entries.set_item($name, $value)?;)*
        entries
    }};
}

/// The outcome of a solve; what the fields have is left to [`of_fields`].
pub fn of<'py, T: Scalar>(py: Python<'py>, account: &Account<T>) -> PyResult<Bound<'py, PyDict>> {
    let part = account.sight.original.map(|original| original.of_solution(&account.solution)).transpose();
    let part = part.map_err(refusal)?;
    let report = part.as_ref().map_or(&account.solution.report, |part| &part.report);
    let share = account.sight.original.map_or(1.0, |original| original.share());
    let stability = account.stability.as_ref().map(|found| stability(py, found)).transpose()?;
    let departures = account.departures.as_ref().map(|left| {
        left.iter()
            .map(|&(eigenvalue, energy_drop, distance)| -> PyResult<_> {
                Ok(dictionary!(py, "eigenvalue": eigenvalue, "energy_drop": energy_drop, "distance": distance,))
            })
            .collect::<PyResult<Vec<_>>>()
    });
    let levels = |grids: &Grids| grids.levels.iter().map(|found| level(py, found)).collect::<PyResult<Vec<_>>>();
    let levels = account.grids.as_ref().map(levels).transpose()?;
    let errors = account.sight.estimate.as_ref().and_then(Estimate::found);
    let grid_error = errors.map(|errors| grid_error(py, errors)).transpose()?;
    let reached = |found: &Reached| -> PyResult<_> {
        Ok(dictionary!(py, "wanted": found.wanted, "of": found.of.name(), "reached": found.reached,))
    };
    let reached = account.reached.as_ref().map(reached).transpose()?;
    let unit = account.unit.as_deref();
    let warnings = account.warnings.iter().map(|found| warning(py, found, unit)).collect::<PyResult<Vec<_>>>()?;
    Ok(dictionary!(py,
        "status": report.status.name(),
        "branch": report.branch.map(Branch::name),
        "other_branch": account.other.as_ref().map(|found| other(py, found)).transpose()?,
        "relative_error": report.relative_error,
        "load_error": report.load_error,
        "criterion": report.criterion.name(),
        "iterations": report.iterations,
        "operator_applications": report.operator_applications,
        "levels": levels,
        "equivalent_applications": account.grids.as_ref().map(|grids| grids.applications),
        "grid_error": grid_error,
        "accuracy": reached,
        "search": account.search.as_ref().map(|found| search(py, found)).transpose()?,
        "mean_gap": report.mean_gap,
        "mean_pressure": report.mean_pressure,
        "normal_force": report.normal_force,
        "approach": report.approach,
        "spring_stiffness": stiffness(report.control),
        "net_pressure": report.net_pressure,
        "mean_contact_pressure": report.mean_contact_pressure,
        "contact_fraction": report.contact_fraction,
        "contact_nodes": report.contact_nodes,
        "absent_nodes": report.absent_nodes,
        "edge_traction": report.edge_traction,
        "corrected_contact_fraction": py.None(),
        "perimeter": py.None(),
        "repulsive_fraction": py.None(),
        "attractive_fraction": py.None(),
        "patches": py.None(),
        "min_gap": report.min_gap,
        "min_pressure": py.None(),
        "max_pressure": py.None(),
        "elastic_energy": report.elastic_energy,
        "adhesive_energy": report.adhesive_energy,
        "stability": stability,
        "contact_stiffness": account.stiffness.map(|found| found.pressure_per_length),
        "normal_stiffness": account.stiffness.map(|found| share * found.force_per_length),
        "departures": departures.transpose()?,
        "mu_rho": report.mu_rho,
        "mu_rho_node": account.strongest.map(|(x, y)| [x, y]),
        "under_resolved": report.under_resolved,
        "warnings": warnings,
        "seconds": account.seconds,
        "control": report.control.name(),
        "control_value": report.control.value(),
    ))
}

/// The equilibrium on the other branch, and its distance.
fn other<'py>(py: Python<'py>, found: &Other) -> PyResult<Bound<'py, PyDict>> {
    let report = &found.report;
    Ok(dictionary!(py,
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
        "distance": found.distance,
        "same": found.same,
    ))
}

/// The search for the load of a contact fraction.
fn search<'py>(py: Python<'py>, found: &Search) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py,
        "wanted": found.wanted,
        "reached": found.reached,
        "below": found.below,
        "above": found.above,
        "solves": found.solves,
        "operator_applications": found.operator_applications,
    ))
}

/// The entries that the fields have: the contact, the least and the greatest pressure, and the errors of nested grids.
pub fn of_fields<'py>(
    py: Python<'py>,
    statistics: &ContactStatistics,
    pressures: (f64, f64),
    errors: Option<&Errors>,
) -> PyResult<Bound<'py, PyDict>> {
    let patches = statistics.patches.iter().map(|found| patch(py, found)).collect::<PyResult<Vec<_>>>()?;
    Ok(dictionary!(py,
        "grid_error": errors.map(|errors| grid_error(py, errors)).transpose()?,
        "corrected_contact_fraction": statistics.corrected_contact_fraction,
        "perimeter": statistics.perimeter,
        "repulsive_fraction": statistics.repulsive_fraction,
        "attractive_fraction": statistics.attractive_fraction,
        "patches": patches,
        "min_pressure": pressures.0,
        "max_pressure": pressures.1,
    ))
}

/// The cost of one of the nested grids.
fn level<'py>(py: Python<'py>, level: &Level) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py,
        "shape": [level.shape.0, level.shape.1],
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
    ))
}

/// The estimated errors of the finest of nested grids.
fn grid_error<'py>(py: Python<'py>, errors: &Errors) -> PyResult<Bound<'py, PyDict>> {
    let entries = PyDict::new(py);
    for (of, estimate) in errors {
        let error = |found: &GridError| -> PyResult<_> {
            Ok(dictionary!(py, "relative": found.relative, "order": found.order, "rough": found.rough,))
        };
        entries.set_item(of.name(), estimate.as_ref().map(error).transpose()?)?;
    }
    Ok(entries)
}

/// The contact where the work of adhesion has one of its values.
fn patch<'py>(py: Python<'py>, patch: &Patch) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py,
        "work_of_adhesion": patch.work_of_adhesion,
        "area_fraction": patch.area_fraction,
        "contact_fraction": patch.contact_fraction,
        "attractive_fraction": patch.attractive_fraction,
    ))
}

/// The stability of an equilibrium.
pub fn stability<'py, T: Scalar>(py: Python<'py>, found: &Stability<T>) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py,
        "verdict": found.verdict.name(),
        "eigenvalue": found.eigenvalue,
        "residual": found.residual,
        "lower_bound": found.lower_bound,
        "error_bound": found.error_bound,
        "smoothed": found.smoothed,
        "operator_applications": found.operator_applications + found.bound_applications,
    ))
}

/// A warning, whose lengths have their unit if it is known.
pub fn warning<'py>(py: Python<'py>, found: &Warning, unit: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
    let with_unit = |unit: &str| {
        let length = |value| format!("{} {unit}", Warning::figure(value));
        found.message_with(length, Warning::figure)
    };
    let message = unit.map_or_else(|| found.message(), with_unit);
    Ok(dictionary!(py, "code": found.code.name(), "message": message,))
}
