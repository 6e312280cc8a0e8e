//! The report on a command as JSON: its outcome, then its inputs.

use std::path::Path;

use asperity_scene::Inputs;
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::options::ProblemOptions;
use crate::part::Part;
use crate::scene::SceneFile;
use crate::threads;
use crate::units::Units;

/// The key of the last state of a pull-off, and of the last row of a table.
pub const LAST: &str = "last";

/// The inputs of a command, as every report has them.
pub fn inputs(problem: &ProblemOptions, part: &Part, units: &Units, scene: &SceneFile) -> Inputs {
    let path = |file: Option<&Path>| file.map(|path| path.to_string_lossy().into_owned());
    Inputs {
        heights: path(Some(&problem.files.heights)),
        against: path(problem.files.against.as_deref()),
        shift: problem.given.shift(),
        initial_gap: path(problem.files.initial_gap.as_deref()),
        part: part.name().map(str::to_owned),
        solved_shape: part.solved(),
        length_unit: units.length.clone(),
        pressure_unit: units.pressure.clone(),
        given: scene.given(),
        ..problem.scene.inputs(part.grid().shape(), part.grid().lengths(), threads::count())
    }
}

/// A report on a command: its outcome, then its inputs.
pub fn report(command: &str, outcome: Value, inputs: &impl Serialize) -> Value {
    let mut report = Map::new();
    report.insert("command".to_owned(), command.into());
    for part in [outcome, json!(inputs)] {
        report.extend(part.as_object().cloned().unwrap_or_default());
    }
    report.into()
}
