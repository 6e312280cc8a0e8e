//! The columns of a table as people read them.

use asperity_scene::column::{MEAN_PRESSURE, NORMAL_FORCE};
use asperity_scene::legs::value;
use asperity_scene::{Account, Adhesion, ENERGY, ENERGY_PER_AREA, Measure, Units, key};
use serde_json::Value;

/// The columns of the rows of a table, with their units. Energies of a body with a free boundary are in full, as a window
/// around a tip is no area of its energy; others are over the area.
pub struct Columns<'a> {
    units: &'a Units,
    control: &'a str,
    /// The nominal area of a body with a free boundary.
    area: Option<f64>,
}

impl<'a> Columns<'a> {
    pub fn new(rows: &'a [Value], units: &'a Units) -> Self {
        let control = rows.first().and_then(|row| row[key!(Account, control)].as_str()).unwrap_or_default();
        let free = rows.iter().any(|row| !row[key!(Account, approach)].is_null());
        // rows have no side lengths, but the force over the area and the force
        let area = rows.iter().filter_map(area).max_by(f64::total_cmp);
        Self { units, control, area: area.filter(|_| free) }
    }

    /// Whether energies are over the area.
    pub fn are_per_area(&self) -> bool {
        self.area.is_none()
    }

    /// The number of a row in a column; not a number where there is none.
    pub fn value(&self, row: &Value, name: &str) -> f64 {
        match (self.measure(name), self.area) {
            (Measure::Of(ENERGY), Some(of_table)) => area(row).unwrap_or(of_table) * value(row, name),
            _ => value(row, name),
        }
    }

    /// The measure of a column.
    fn measure(&self, name: &str) -> Measure {
        match Measure::find(name, self.control, false) {
            Measure::Of(ENERGY_PER_AREA) if self.area.is_some() && name != key!(Adhesion, work_of_adhesion) => {
                Measure::Of(ENERGY)
            }
            other => other,
        }
    }

    /// The unit of a column.
    pub fn unit(&self, name: &str) -> Option<String> {
        self.units.unit(self.measure(name).dimension()?)
    }

    /// A number of a column for people.
    pub fn number(&self, name: &str, value: f64) -> String {
        self.measure(name).text(value, self.units)
    }

    /// The name of a column for people.
    pub fn label(name: &str) -> String {
        if name == "dissipated" { "dissipated energy".to_owned() } else { spaced(name) }
    }
}

/// A name with spaces.
pub fn spaced(name: &str) -> String {
    name.replace("pull_off", "pull-off").replace('_', " ")
}

/// The nominal area of a row with a load that is not zero.
fn area(row: &Value) -> Option<f64> {
    Some(value(row, NORMAL_FORCE) / value(row, MEAN_PRESSURE)).filter(|area| area.is_finite())
}
