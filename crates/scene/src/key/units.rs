//! The units of numbers, as far as they are known.

use asperity_maps::warning::Warning;

use crate::key::allowed::unit;
use crate::key::given::Given;
use crate::key::quantity::{
    AREA, CONDUCTIVITY, Dimension, ELECTRICAL_CONDUCTANCE, ENERGY, ENERGY_PER_AREA, FORCE, FORCE_PER_LENGTH, LENGTH,
    PER_LENGTH, PER_PRESSURE, PRESSURE, PRESSURE_PER_LENGTH, RESISTIVITY, THERMAL_CONDUCTANCE, TRANSMISSIVITY,
    VISCOSITY,
};
use crate::key::told::Told;
use crate::key::{Kind, keys};
use crate::numbers::{plain, si};

keys! {
    /// The units of numbers that are given without them.
    UnitKeys {
        "Output" {
            /// Unit of lengths that are given without one, for tables and pictures; m gets prefixes
            length_unit: Kind::text(is_unit, &["UNIT"]),
            /// Unit of pressures that are given without one, for tables and pictures; Pa gets prefixes
            pressure_unit: Kind::text(is_unit, &["UNIT"]),
            /// Unit of forces, for tables and pictures; N gets prefixes [default: that of pressure times length squared]
            force_unit: Kind::text(is_unit, &["UNIT"]),
        }
    }
}

/// Whether a text may be a unit.
pub(crate) fn is_unit(text: &str) -> Result<(), String> {
    unit(text).map(drop)
}

impl Given {
    /// The units of numbers beside a file with a unit of length, or none; `si` says that they were given with units.
    ///
    /// # Errors
    /// A unit beside one that is known, and the remedy, for [`worded`](crate::worded).
    pub fn units(&self, file: Option<&str>, si: bool) -> Result<Units, String> {
        let chosen = |key: &str, known: Option<&str>| match (self.word(key), known) {
            (Some(unit), Some(known)) if unit != known => {
                Err(format!("{{{key}}} is {unit}, but that unit is {known} already: leave it out"))
            }
            (unit, known) => Ok(unit.or(known).map(str::to_owned)),
        };
        let of_si = |dimension: Dimension| si.then_some(dimension.si);
        Ok(Units {
            length: chosen("length_unit", of_si(LENGTH).or(file))?,
            pressure: chosen("pressure_unit", of_si(PRESSURE))?,
            force: chosen("force_unit", of_si(FORCE))?,
        })
    }
}

/// The units of lengths, pressures and forces, from which the others follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// That of lengths.
    pub length: Option<String>,
    /// That of pressures.
    pub pressure: Option<String>,
    /// That of forces, if it is another one than a pressure times an area.
    pub force: Option<String>,
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
        let message = warning.message_with(|value| self.number(value, LENGTH), |value| self.number(value, PRESSURE));
        Told { code: warning.code.name().to_owned(), message, severity: warning.severity() }
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
        if [dimension.time, dimension.current, dimension.temperature] != [0; 3] {
            return None;
        }
        let pressure = if pressures == 0 { "" } else { pressure? };
        let length = if lengths == 0 { "" } else { length? };
        Some(match (pressures, lengths) {
            (0, -1) => format!("1/{length}"),
            (0, 2) => format!("{length}²"),
            (0, 3) => format!("{length}³"),
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
            Some(unit) if unit == dimension.si && ![PER_LENGTH, AREA, TRANSMISSIVITY].contains(&dimension) => {
                si(value, &unit)
            }
            Some(unit) => format!("{} {unit}", plain(value)),
            None => plain(value),
        }
    }

    /// The side lengths of a map for people.
    pub fn sides(&self, (lx, ly): (f64, f64)) -> String {
        format!("{} x {}", self.number(lx, LENGTH), self.number(ly, LENGTH))
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

    /// The names of the columns of a table, with their units where those are all known.
    pub fn columns(&self, names: &[&str], control: &str, on_line: bool) -> Vec<String> {
        let known = self.of_table() != "none";
        let name = |name: &&str| match self.of_column(name, control, on_line).filter(|_| known) {
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

/// The dimension of the numbers of a key of a scene; none for shares, numbers and words.
pub fn dimension_of_key(key: &str) -> Option<Dimension> {
    match key {
        "radius" | "amplitude" | "rms_height" | "fourier_unit" | "cut_off_wavelength" => Some(LENGTH),
        "spring_position" | "distance" | "absent_gap" => Some(LENGTH),
        "young" | "other_young" => Some(PRESSURE),
        "resistivities" => Some(RESISTIVITY),
        "conductivities" => Some(CONDUCTIVITY),
        _ => dimension_of(key, "", false),
    }
}

/// The dimension of a column of a table, or of a figure of a report, under loads of this kind; none for shares, numbers
/// and words. The perimeter of contact on a line is the number of its ends.
pub fn dimension_of(name: &str, control: &str, on_line: bool) -> Option<Dimension> {
    Some(match (name, control) {
        (
            "mean_gap" | "min_gap" | "approach" | "closure" | "range" | "cut_off" | "layer" | "coating" | "lengths"
            | "shift",
            _,
        ) => LENGTH,
        ("plastic_depth_max" | "plastic_depth_mean", _) => LENGTH,
        ("perimeter", _) if !on_line => LENGTH,
        ("mean_pressure" | "net_pressure" | "mean_contact_pressure" | "min_pressure" | "max_pressure", _) => PRESSURE,
        ("modulus" | "coating_modulus" | "against_modulus" | "from_pressure" | "to_pressure", _) => PRESSURE,
        ("peak_traction" | "pull_off_pressure" | "lost_pressure" | "preload" | "hardness", _) => PRESSURE,
        ("pull_off_force", _) => FORCE,
        ("from_gap" | "to_gap" | "distance", _) => LENGTH,
        ("gap_density", _) => PER_LENGTH,
        ("area", _) => AREA,
        ("density" | "pressure_density", _) => PER_PRESSURE,
        ("normal_force", _) => FORCE,
        ("elastic_energy" | "adhesive_energy" | "plastic_energy" | "work" | "dissipated" | "energy_drop", _) => {
            ENERGY_PER_AREA
        }
        ("work_of_adhesion", _) => ENERGY_PER_AREA,
        ("hamaker", _) => ENERGY,
        ("viscosity", _) => VISCOSITY,
        ("electrical_conductance", _) => ELECTRICAL_CONDUCTANCE,
        ("thermal_conductance", _) => THERMAL_CONDUCTANCE,
        ("transmissivity_x_lower" | "transmissivity_x_upper", _) => TRANSMISSIVITY,
        ("transmissivity_y_lower" | "transmissivity_y_upper", _) => TRANSMISSIVITY,
        ("contact_stiffness" | "wall_stiffness", _) => PRESSURE_PER_LENGTH,
        ("normal_stiffness" | "spring_stiffness", _) => FORCE_PER_LENGTH,
        ("control_value", "mean-pressure") => PRESSURE,
        ("control_value", "normal-force") => FORCE,
        ("control_value", "mean-gap" | "approach" | "spring") => LENGTH,
        _ => return None,
    })
}
