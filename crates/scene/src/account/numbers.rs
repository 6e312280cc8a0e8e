//! The numbers of answers: their names, their meaning, and how people read them.

use serde_json::Value;

use crate::account::{Account, INPUTS, LIMIT, OUTCOME, PLASTIC, PulledOff, Row, STATE, STIFFNESS, Step, interface};
use crate::key::{
    AREA, Dimension, ELECTRICAL_CONDUCTANCE, FORCE, Key, LENGTH, Load, Measure, Number, PER_LENGTH, PER_PRESSURE,
    PRESSURE, THERMAL_CONDUCTANCE, TRANSMISSIVITY, Units,
};
use crate::numbers::{percent, rounded};

/// The measures of columns that no record has.
const COLUMNS: [(&str, Measure); 14] = [
    ("from_gap to_gap distance", Measure::Of(LENGTH)),
    ("from_pressure to_pressure", Measure::Of(PRESSURE)),
    ("gap_density", Measure::Of(PER_LENGTH)),
    ("area", Measure::Of(AREA)),
    ("density pressure_density", Measure::Of(PER_PRESSURE)),
    ("electrical_conductance", Measure::Of(ELECTRICAL_CONDUCTANCE)),
    ("thermal_conductance", Measure::Of(THERMAL_CONDUCTANCE)),
    (
        "transmissivity_x_lower transmissivity_x_upper transmissivity_y_lower transmissivity_y_upper",
        Measure::Of(TRANSMISSIVITY),
    ),
    ("conductance_error stiffness_error grid_error", Measure::Error),
    // of a patch, and of an error of the grid
    ("area_fraction relative", Measure::Share),
    // of a surface, of two bodies with Young's moduli, and of closed forms
    ("fourier_unit half_width wavelength", Measure::Of(LENGTH)),
    ("young other_young", Measure::Of(PRESSURE)),
    ("load", Measure::Of(FORCE)),
    ("rms_curvature", Measure::Of(PER_LENGTH)),
];

impl Number {
    /// The numbers of reports and tables.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        [Account::NUMBERS, Row::NUMBERS, Step::NUMBERS, PulledOff::NUMBERS].into_iter().flatten()
    }

    /// Whether tables have a column of the number, some of them if not all.
    pub fn is_column(&self) -> bool {
        let lists = [STATE, OUTCOME, LIMIT, PLASTIC, STIFFNESS, INPUTS, interface::OUTCOME];
        lists.into_iter().flat_map(str::split_whitespace).any(|name| name == self.name)
    }
}

impl Measure {
    /// The measure of a column of a table, or of a number of a report, under loads of this kind. The perimeter of contact
    /// on a line is the number of its ends.
    pub fn find(name: &str, control: &str, on_line: bool) -> Self {
        match (name, control) {
            ("perimeter", _) if on_line => Self::Plain,
            ("control_value", _) => Load::key_of(control).map_or(Self::Plain, |key| Self::find(key, "", on_line)),
            _ => {
                let known = Number::all().filter(|number| number.name == name).map(|number| number.measure);
                let columns = COLUMNS.iter().filter(|(names, _)| names.split(' ').any(|column| column == name));
                // a surface that is made has no columns
                let of_problem = |key: &&Key| !["Form", "Roughness"].contains(&key.section);
                let key = Key::named(name).filter(of_problem).and_then(|key| key.kind.dimension());
                let all = known.chain(columns.map(|(_, measure)| *measure)).chain(key.map(Self::Of));
                all.into_iter().find(|measure| *measure != Self::Plain).unwrap_or(Self::Plain)
            }
        }
    }

    /// The dimension; none of shares and numbers.
    pub fn dimension(self) -> Option<Dimension> {
        if let Self::Of(dimension) = self { Some(dimension) } else { None }
    }

    /// A number for people.
    pub fn text(self, value: f64, units: &Units) -> String {
        match self {
            Self::Of(dimension) => units.number(value, dimension),
            Self::Share => format!("{} %", percent(value)),
            Self::Error => format!("{value:.1e}"),
            Self::Seconds => format!("{value:.3} s"),
            Self::Plain => rounded(value, 4, 1e6),
        }
    }

    /// A number or a word of a report for people; nothing for what does not apply, and for tables.
    pub fn describe(self, value: &Value, units: &Units) -> Option<String> {
        match value {
            Value::String(word) => Some(word.clone()),
            Value::Number(number) if number.is_f64() => Some(self.text(number.as_f64()?, units)),
            Value::Number(_) | Value::Bool(_) => Some(value.to_string()),
            _ => None,
        }
    }
}

impl Units {
    /// The names of the columns of a table, with their units where those are all known.
    pub fn columns(&self, names: &[&str], control: &str, on_line: bool) -> Vec<String> {
        let known = self.of_table() != "none";
        let unit =
            |name: &str| if known { self.unit(Measure::find(name, control, on_line).dimension()?) } else { None };
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
    Key::named(key).map_or_else(|| Measure::find(key, "", false).dimension(), |key| key.kind.dimension())
}
