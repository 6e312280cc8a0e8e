//! The units of the numbers that a command gives.

pub use asperity_scene::dimension_of;
pub use asperity_scene::units::Units;
use serde_json::Value;

/// The units of the numbers of a report, as far as they are known.
pub fn units_of(report: &Value) -> Units {
    let [length, pressure] = ["length_unit", "pressure_unit"].map(|key| report[key].as_str().map(str::to_owned));
    Units { length, pressure, force: None }
}
