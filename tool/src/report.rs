//! The report on a command as JSON: its outcome, then its inputs.

use std::path::Path;

use serde_json::{Map, Value, json};

use crate::options::ProblemOptions;
use crate::part::Part;
use crate::quantity::Quantity;
use crate::scene::Scene;
use crate::threads;
use crate::units::Units;

/// The inputs of a command, by their names in every report.
pub fn inputs(
    ProblemOptions { surface, adhesion, solver }: ProblemOptions<'_>,
    part: &Part,
    units: &Units,
    scene: &Scene,
) -> Map<String, Value> {
    let settings = solver.settings();
    let number = |given: Option<Quantity>| given.map(|given| given.value);
    let inputs = json!({
        "heights": surface.heights.to_string_lossy(),
        "initial_gap": solver.initial_gap.as_deref().map(Path::to_string_lossy),
        "part": part.name(),
        "solved_shape": part.solved(),
        "shape": part.grid().shape(),
        "lengths": part.grid().lengths(),
        "length_unit": units.length,
        "pressure_unit": units.pressure,
        "given": scene.given(),
        "boundary": surface.beyond.boundary.to_string(),
        "modulus": surface.modulus(),
        "law": adhesion.law.to_string(),
        "work_of_adhesion": number(adhesion.work_of_adhesion),
        "range": number(adhesion.range),
        "exponent": adhesion.exponent,
        "hamaker": number(adhesion.hamaker),
        "law_table": adhesion.law_table.as_deref().map(Path::to_string_lossy),
        "cut_off": number(adhesion.cut_off),
        "work_of_adhesion_map": adhesion.work_of_adhesion_map.as_deref().map(Path::to_string_lossy),
        "wall": adhesion.wall.to_string(),
        "method": settings.method.name(),
        "precision": solver.precision.name(),
        "tolerance": solver.tolerance(),
        "max_iterations": settings.max_iterations,
        "threads": threads::count(),
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
