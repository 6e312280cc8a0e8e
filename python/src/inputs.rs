//! The inputs of a problem by the names of their keywords: body, load and settings. The law has a file of its own.

use asperity::{Control, Criterion, ElasticOperator, Grid, Real, Settings, Westergaard};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The elastic body of a problem.
pub fn operator<T: Real>(grid: Grid, modulus: f64) -> asperity::Result<Box<dyn ElasticOperator<T>>> {
    Ok(Box::new(Westergaard::<T>::new(grid, modulus)?))
}

/// A load, by the name and value of a keyword.
pub fn control(name: &str, value: f64) -> PyResult<Control> {
    match name {
        "mean_gap" => Ok(Control::MeanGap(value)),
        "mean_pressure" => Ok(Control::MeanPressure(value)),
        other => Err(PyValueError::new_err(format!("control is {other}: it must be mean_gap or mean_pressure"))),
    }
}

/// The name and the value of a load, as in the tool's reports.
pub fn name_and_value(control: Control) -> (&'static str, f64) {
    (control.name(), control.value())
}

/// The settings of a solver.
pub fn settings(tolerance: Option<f64>, max_iterations: Option<usize>, method: &str) -> PyResult<Settings> {
    let default = match method {
        "default" => Settings::default(),
        "rey2017" => Settings { criterion: Criterion::EnergyNorm, ..Settings::rey2017() },
        other => return Err(PyValueError::new_err(format!("method is {other}: it must be default or rey2017"))),
    };
    let max_iterations = max_iterations.unwrap_or(default.max_iterations);
    Ok(Settings { tolerance, max_iterations, ..default })
}
