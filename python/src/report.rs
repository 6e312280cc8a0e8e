//! The outcome of a solve, with the names and in the order of the tool's `report.json`.

use asperity::stability::Stability;
use asperity::{Level, Warning};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::account::{Account, Scalar};
use crate::inputs::stiffness;

/// A dictionary of its entries.
macro_rules! dictionary {
    ($py:expr, $($name:literal: $value:expr,)*) => {{
        let entries = PyDict::new($py);
        $(entries.set_item($name, $value)?;)*
        entries
    }};
}

/// The outcome of a solve.
pub fn of<'py, T: Scalar>(py: Python<'py>, account: &Account<T>) -> PyResult<Bound<'py, PyDict>> {
    let Account { solution, area, pressures, .. } = account;
    let report = &solution.report;
    let stability = account.stability.as_ref().map(|found| stability(py, found)).transpose()?;
    let departures = account.departures.as_ref().map(|left| {
        left.iter()
            .map(|&(eigenvalue, energy_drop, distance)| -> PyResult<_> {
                Ok(dictionary!(py, "eigenvalue": eigenvalue, "energy_drop": energy_drop, "distance": distance,))
            })
            .collect::<PyResult<Vec<_>>>()
    });
    let levels =
        |(levels, _): &(Vec<Level>, f64)| levels.iter().map(|found| level(py, found)).collect::<PyResult<Vec<_>>>();
    let levels = account.grids.as_ref().map(levels).transpose()?;
    let warnings = account.warnings.iter().map(|found| warning(py, found)).collect::<PyResult<Vec<_>>>()?;
    Ok(dictionary!(py,
        "status": report.status.name(),
        "relative_error": report.relative_error,
        "load_error": report.load_error,
        "criterion": report.criterion.name(),
        "iterations": report.iterations,
        "operator_applications": report.operator_applications,
        "levels": levels,
        "equivalent_applications": account.grids.as_ref().map(|(_, applications)| applications),
        "mean_gap": report.mean_gap,
        "mean_pressure": report.mean_pressure,
        "normal_force": report.normal_force,
        "approach": report.approach,
        "spring_stiffness": stiffness(account.control),
        "carried_pressure": report.carried_pressure,
        "mean_contact_pressure": report.mean_contact_pressure,
        "contact_fraction": report.contact_fraction,
        "contact_nodes": report.contact_nodes,
        "absent_points": report.absent_nodes,
        "edge_traction": report.edge_traction,
        "corrected_contact_fraction": area.corrected_contact_fraction,
        "perimeter": area.perimeter,
        "min_gap": report.min_gap,
        "min_pressure": pressures.0,
        "max_pressure": pressures.1,
        "elastic_energy": report.elastic_energy,
        "adhesive_energy": report.adhesive_energy,
        "stability": stability,
        "departures": departures.transpose()?,
        "mu_rho": report.mu_rho,
        "mu_rho_node": account.strongest.map(|(x, y)| [x, y]),
        "under_resolved": report.under_resolved,
        "warnings": warnings,
        "seconds": account.seconds,
        "control": account.control.name(),
        "control_value": account.control.value(),
    ))
}

/// The cost of one of the nested grids.
fn level<'py>(py: Python<'py>, level: &Level) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py,
        "shape": [level.shape.0, level.shape.1],
        "status": level.status.name(),
        "iterations": level.iterations,
        "operator_applications": level.operator_applications,
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

fn warning<'py>(py: Python<'py>, found: &Warning) -> PyResult<Bound<'py, PyDict>> {
    Ok(dictionary!(py, "code": found.code.name(), "message": &found.message,))
}
