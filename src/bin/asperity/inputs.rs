//! The inputs of a command as its report lists them.

use std::path::Path;

use asperity::Grid;
use serde_json::{Map, Value, json};

use crate::options::{AdhesionOptions, Precision, SolverOptions, SurfaceOptions};

/// The inputs of a command, by their names in every report.
pub fn inputs(
    surface: &SurfaceOptions,
    adhesion: &AdhesionOptions,
    solver: &SolverOptions,
    grid: &Grid,
    length_unit: Option<&str>,
    threads: usize,
) -> Map<String, Value> {
    let settings = solver.settings();
    let inputs = json!({
        "heights": surface.heights.to_string_lossy(),
        "initial_gap": solver.initial_gap.as_deref().map(Path::to_string_lossy),
        "shape": grid.shape(),
        "lengths": grid.lengths(),
        "length_unit": length_unit,
        "modulus": surface.modulus,
        "law": adhesion.law.to_string(),
        "work_of_adhesion": adhesion.work_of_adhesion,
        "range": adhesion.range,
        "method": settings.method.name(),
        "precision": if solver.precision == Precision::F32 { "f32" } else { "f64" },
        "tolerance": solver.tolerance(),
        "max_iterations": settings.max_iterations,
        "threads": threads,
        "version": env!("CARGO_PKG_VERSION"),
    });
    inputs.as_object().cloned().unwrap_or_default()
}

/// A report on a command: its outcome, then its inputs.
pub fn report(command: &str, outcome: Value, inputs: Map<String, Value>) -> Value {
    let mut report = Map::new();
    report.insert("command".to_owned(), command.into());
    report.extend(outcome.as_object().cloned().unwrap_or_default());
    report.extend(inputs);
    report.into()
}
