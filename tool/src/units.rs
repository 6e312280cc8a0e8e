//! The units of the numbers that a command gives, as far as they are known.

use asperity_maps::io::LONGEST_UNIT;
use asperity_maps::warning::Warning;
use asperity_scene::Told;
use clap::Args;

use crate::csv;
use crate::numbers::{plain, si};
use crate::outcome::Outcome;
use crate::quantity::{
    Dimension, ENERGY, ENERGY_PER_AREA, FORCE, FORCE_PER_LENGTH, LENGTH, PER_LENGTH, PER_PRESSURE, PRESSURE,
    PRESSURE_PER_LENGTH,
};

/// The units of numbers that are given without them.
#[derive(Args)]
pub struct UnitOptions {
    /// Unit of lengths that are given without one, for tables and pictures; m gets prefixes
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Output")]
    length_unit: Option<String>,
    /// Unit of pressures that are given without one, for tables and pictures; Pa gets prefixes
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Output")]
    pressure_unit: Option<String>,
    /// Unit of forces, for tables and pictures; N gets prefixes [default: that of pressure times length squared]
    #[arg(long, value_name = "UNIT", value_parser = unit, help_heading = "Output")]
    force_unit: Option<String>,
}

/// A unit as it is typed, which will be printed, and may come into a file.
pub fn unit(text: &str) -> Result<String, String> {
    let fits = text.chars().count() <= LONGEST_UNIT && !text.contains(char::is_control);
    let text = Some(text.to_owned()).filter(|_| fits);
    text.ok_or_else(|| format!("it must be a text of at most {LONGEST_UNIT} characters, without control characters"))
}

/// The units of lengths, pressures and forces, from which the others follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    pub length: Option<String>,
    pub pressure: Option<String>,
    pub force: Option<String>,
}

impl UnitOptions {
    /// The units of numbers beside a file with a unit of length, or none; `si` says that they were given with units.
    pub fn units(&self, file: Option<&str>, si: bool) -> Outcome<Units> {
        let chosen = |name: &str, option: &Option<String>, known: Option<&str>| match (option, known) {
            (Some(unit), Some(known)) if unit != known => {
                Err(format!("--{name}-unit is {unit}, but that unit is {known} already: leave it out"))
            }
            (Some(unit), _) => Ok(Some(unit.clone())),
            (None, known) => Ok(known.map(str::to_owned)),
        };
        let of_si = |dimension: Dimension| si.then_some(dimension.si);
        Ok(Units {
            length: chosen("length", &self.length_unit, of_si(LENGTH).or(file))?,
            pressure: chosen("pressure", &self.pressure_unit, of_si(PRESSURE))?,
            force: chosen("force", &self.force_unit, of_si(FORCE))?,
        })
    }
}

impl Units {
    /// Metres and pascals.
    pub fn si() -> Self {
        let [length, pressure, force] = [LENGTH, PRESSURE, FORCE].map(|dimension| Some(dimension.si.to_owned()));
        Self { length, pressure, force }
    }

    /// The units of a map, of which that of length alone may be known.
    pub fn of_map(length: Option<&str>) -> Self {
        Self { length: length.map(str::to_owned), ..Self::default() }
    }

    /// A warning in these units.
    pub fn told(&self, warning: &Warning) -> Told {
        Told::new(warning, |value| self.number(value, LENGTH), |value| self.number(value, PRESSURE))
    }

    /// The unit of a dimension: its own of the SI, or a product of those that are known.
    pub fn of(&self, dimension: Dimension) -> Option<String> {
        if let (true, Some(force)) = (dimension == FORCE, &self.force) {
            return Some(force.clone());
        }
        let (length, pressure) = (self.length.as_deref(), self.pressure.as_deref());
        // a force is a pressure times an area
        let (pressures, lengths) = (dimension.force, dimension.length + 2 * dimension.force);
        let is_si = (pressures == 0 || pressure == Some(PRESSURE.si)) && (lengths == 0 || length == Some(LENGTH.si));
        if is_si {
            return Some(dimension.si.to_owned());
        }
        let pressure = if pressures == 0 { "" } else { pressure? };
        let length = if lengths == 0 { "" } else { length? };
        Some(match (pressures, lengths) {
            (0, -1) => format!("1/{length}"),
            (-1, 0) => format!("1/{pressure}"),
            (_, -1) => format!("{pressure}/{length}"),
            (0, _) | (_, 0) => format!("{pressure}{length}"),
            (_, 1) => format!("{pressure}·{length}"),
            (_, 2) => format!("{pressure}·{length}²"),
            (_, power) => format!("{pressure}·{length}^{power}"),
        })
    }

    /// A number of a dimension for people, with its unit as far as that is known, and with a prefix in the SI.
    pub fn number(&self, value: f64, dimension: Dimension) -> String {
        match self.of(dimension) {
            Some(unit) if unit == dimension.si && dimension != PER_LENGTH => si(value, &unit),
            Some(unit) => format!("{} {unit}", plain(value)),
            None => plain(value),
        }
    }

    /// The unit of a column of a table; see [`dimension_of`].
    pub fn of_column(&self, name: &str, control: &str, on_line: bool) -> Option<String> {
        self.of(dimension_of(name, control, on_line)?)
    }

    /// The units of a table, if they are all known, for comparing two runs.
    pub fn of_table(&self) -> String {
        let units = [LENGTH, PRESSURE, FORCE].map(|dimension| self.of(dimension));
        units.into_iter().collect::<Option<Vec<_>>>().map_or("none".to_owned(), |units| units.join(" "))
    }

    /// The header of a table with these columns: their names, with their units where those are all known.
    pub fn header(&self, names: &[&str], control: &str, on_line: bool) -> String {
        let known = self.of_table() != "none";
        let name = |name: &&str| match self.of_column(name, control, on_line).filter(|_| known) {
            // letters and digits of ASCII, as spreadsheets may take a file without a mark for another encoding
            Some(unit) => format!("{name} [{}]", unit.replace('²', "2").replace('·', " ")),
            None => (*name).to_owned(),
        };
        csv::header(names.iter().map(name)) + "\n"
    }
}

/// The dimension of a column of a table, or of a figure of a report, under loads of this kind; none for shares, numbers
/// and words. The perimeter of contact on a line is the number of its ends.
pub fn dimension_of(name: &str, control: &str, on_line: bool) -> Option<Dimension> {
    Some(match (name, control) {
        ("mean_gap" | "min_gap" | "approach" | "range" | "cut_off" | "lengths", _) => LENGTH,
        ("perimeter", _) if !on_line => LENGTH,
        ("mean_pressure" | "net_pressure" | "mean_contact_pressure" | "min_pressure" | "max_pressure", _) => PRESSURE,
        ("modulus" | "from_pressure" | "to_pressure", _) => PRESSURE,
        ("density", _) => PER_PRESSURE,
        ("normal_force", _) => FORCE,
        ("elastic_energy" | "adhesive_energy" | "work" | "dissipated" | "energy_drop" | "work_of_adhesion", _) => {
            ENERGY_PER_AREA
        }
        ("hamaker", _) => ENERGY,
        ("contact_stiffness", _) => PRESSURE_PER_LENGTH,
        ("normal_stiffness" | "spring_stiffness", _) => FORCE_PER_LENGTH,
        ("control_value", "mean-pressure") => PRESSURE,
        ("control_value", "normal-force") => FORCE,
        ("control_value", "mean-gap" | "approach" | "spring") => LENGTH,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(length: &str, pressure: &str) -> Units {
        Units { length: Some(length.to_owned()), pressure: Some(pressure.to_owned()), force: None }
    }

    #[test]
    fn units_of_a_dimension_follow_from_length_and_pressure() {
        let dimensions = [LENGTH, PRESSURE, FORCE, ENERGY_PER_AREA, PRESSURE_PER_LENGTH, PER_LENGTH, PER_PRESSURE];
        let names = |units: Units| dimensions.map(|dimension| units.of(dimension).unwrap_or_default());
        assert_eq!(names(Units::si()), ["m", "Pa", "N", "J/m²", "Pa/m", "1/m", "1/Pa"]);
        assert_eq!(names(units("um", "MPa")), ["um", "MPa", "MPa·um²", "MPa·um", "MPa/um", "1/um", "1/MPa"]);
        assert_eq!(names(Units::of_map(Some("m"))), ["m", "", "", "", "", "1/m", ""]);
        assert_eq!(names(Units::default()), [""; 7]);
    }

    #[test]
    fn numbers_and_headers_have_their_units() {
        assert_eq!(Units::si().number(6.273889e-10, LENGTH), "627.4 pm");
        assert_eq!(Units::si().number(-1e-25, LENGTH), "0 m");
        assert_eq!(Units::si().number(9.999e14, PRESSURE_PER_LENGTH), "999.9 TPa/m");
        assert_eq!(Units::si().number(9.9999e14, PRESSURE_PER_LENGTH), "1e15 Pa/m");
        assert_eq!(Units::si().number(2.6170857e17, PRESSURE_PER_LENGTH), "2.617e17 Pa/m");
        assert_eq!(Units::si().number(0.05, ENERGY_PER_AREA), "50 mJ/m²");
        assert_eq!(units("um", "MPa").number(0.5, PRESSURE), "0.5 MPa");
        assert_eq!(Units::default().number(0.5, PRESSURE), "0.5");
        let names = ["control_value", "mean_gap", "elastic_energy", "perimeter", "status"];
        assert_eq!(
            Units::si().header(&names, "normal-force", false),
            "control_value [N],mean_gap [m],elastic_energy [J/m2],perimeter [m],status\n"
        );
        assert_eq!(
            Units::of_map(Some("m")).header(&names, "spring", false),
            "control_value,mean_gap,elastic_energy,perimeter,status\n"
        );
    }
}
