//! The dimensions of what is given and found, by names.

use crate::account::Account;
use crate::key::{
    AREA, Dimension, ELECTRICAL_CONDUCTANCE, ENERGY_PER_AREA, FORCE, Key, LENGTH, PER_LENGTH, PER_PRESSURE, PRESSURE,
    THERMAL_CONDUCTANCE, TRANSMISSIVITY, Units,
};

/// The dimensions of the columns that tables alone have.
const COLUMNS: [(&str, Dimension); 14] = [
    ("closure from_gap to_gap distance", LENGTH),
    ("from_pressure to_pressure pull_off_pressure lost_pressure limit_pressure", PRESSURE),
    ("pull_off_force limit_force", FORCE),
    ("gap_density", PER_LENGTH),
    ("area", AREA),
    ("density pressure_density", PER_PRESSURE),
    ("work dissipated imbalance work_error energy_drop", ENERGY_PER_AREA),
    ("electrical_conductance", ELECTRICAL_CONDUCTANCE),
    ("thermal_conductance", THERMAL_CONDUCTANCE),
    ("transmissivity_x_lower transmissivity_x_upper transmissivity_y_lower transmissivity_y_upper", TRANSMISSIVITY),
    // of a surface, of two bodies with Young's moduli, and of closed forms
    ("fourier_unit half_width wavelength", LENGTH),
    ("young other_young", PRESSURE),
    ("load", FORCE),
    ("rms_curvature", PER_LENGTH),
];

/// The dimension of a column of a table, or of a figure of a report, under loads of this kind; none for shares, numbers
/// and words. The perimeter of contact on a line is the number of its ends.
pub fn dimension_of(name: &str, control: &str, on_line: bool) -> Option<Dimension> {
    match (name, control) {
        ("perimeter", _) if on_line => None,
        ("control_value", "mean-pressure") => Some(PRESSURE),
        ("control_value", "normal-force") => Some(FORCE),
        ("control_value", "mean-gap" | "approach" | "spring") => Some(LENGTH),
        _ => {
            let account = Account::DIMENSIONS.iter().find(|(key, _)| *key == name).map(|(_, dimension)| *dimension);
            let column = || COLUMNS.iter().find(|(names, _)| names.split(' ').any(|column| column == name));
            // keys of a surface that is made have none in a table
            let of_problem = |key: &&Key| !["Form", "Roughness"].contains(&key.section);
            let key = || Key::named(name).filter(of_problem).and_then(|key| key.kind.dimension());
            account.or_else(|| column().map(|(_, dimension)| *dimension)).or_else(key)
        }
    }
}

impl Units {
    /// The names of the columns of a table, with their units where those are all known.
    pub fn columns(&self, names: &[&str], control: &str, on_line: bool) -> Vec<String> {
        let known = self.of_table() != "none";
        let unit = |name: &str| if known { self.of(dimension_of(name, control, on_line)?) } else { None };
        let name = |name: &&str| match unit(name) {
            // letters and digits of ASCII, as spreadsheets may take a file without a mark for another encoding
            Some(unit) => format!("{name} [{}]", ascii(&unit)),
            None => (*name).to_owned(),
        };
        names.iter().map(name).collect()
    }
}

/// A unit in letters and digits of ASCII.
fn ascii(unit: &str) -> String {
    unit.replace('²', "2").replace('³', "3").replace('·', " ")
}

/// The dimension of the numbers of a key; none for shares, numbers and words.
pub fn dimension_of_key(key: &str) -> Option<Dimension> {
    Key::named(key).map_or_else(|| dimension_of(key, "", false), |key| key.kind.dimension())
}
