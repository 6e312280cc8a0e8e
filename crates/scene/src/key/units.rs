//! The units of numbers, as far as they are known.

use asperity_maps::warning::Warning;

use crate::key::{Dimension, Entries, FORCE, Kind, LENGTH, Notice, PRESSURE, Range, keys, unit};
use crate::numbers::{self, plain, si};

keys! {
    /// The units of numbers that are given without them.
    UnitKeys {
        "Output" {
            /// Unit of lengths that are given without one, for tables and pictures; m gets prefixes
            length_unit: Option<String> = Kind::text(is_unit, &["UNIT"]),
            /// Unit of pressures that are given without one, for tables and pictures; Pa gets prefixes
            pressure_unit: Option<String> = Kind::text(is_unit, &["UNIT"]),
            /// Unit of forces, for tables and pictures; N gets prefixes [default: pressure times length squared]
            force_unit: Option<String> = Kind::text(is_unit, &["UNIT"]),
        }
    }
}

/// Whether a text may be a unit.
pub(crate) fn is_unit(text: &str) -> Result<(), String> {
    unit(text).map(drop)
}

impl Entries {
    /// The units of numbers next to a file with a unit of length, or none; `si` says that they were given with units.
    ///
    /// # Errors
    /// A unit next to one that is known, and the remedy, for [`worded`](crate::worded).
    pub fn units(&self, file: Option<&str>, si: bool) -> Result<Units, String> {
        let UnitKeys { length_unit, pressure_unit, force_unit } = self.keys();
        let chosen = |key: &str, unit: Option<String>, known: Option<&str>| match (unit, known) {
            (Some(unit), Some(known)) if unit != known => {
                Err(format!("{{{key}}} is {unit}, but that unit is {known} already: leave it out"))
            }
            (unit, known) => Ok(unit.or(known.map(str::to_owned))),
        };
        let of_si = |dimension: Dimension| si.then_some(dimension.si);
        let units = Units {
            length: chosen("length_unit", length_unit, of_si(LENGTH).or(file))?,
            pressure: chosen("pressure_unit", pressure_unit, of_si(PRESSURE))?,
            force: chosen("force_unit", force_unit, of_si(FORCE))?,
        };
        if let Units { length: Some(length), pressure: Some(pressure), force: Some(force) } = &units {
            let size =
                |of: Dimension, unit: &str| of.within(Range::POSITIVE)(&format!("1{unit}")).ok().map(|one| one.value);
            let found =
                size(LENGTH, length).zip(size(PRESSURE, pressure)).map(|(length, pressure)| pressure * length.powi(2));
            let (Some(found), Some(given)) = (found, size(FORCE, force)) else { return Ok(units) };
            if (found / given - 1.0).abs() > 1e-9 {
                let found = numbers::si(found, FORCE.si);
                return Err(format!(
                    "{{force_unit}} is {force}, but with lengths in {length} and pressures in {pressure} forces are in units \
                     of {found}: leave it out, or change the others"
                ));
            }
        }
        Ok(units)
    }
}

/// The units of lengths, pressures and forces, from which the others follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// The unit of lengths.
    pub length: Option<String>,
    /// The unit of pressures.
    pub pressure: Option<String>,
    /// The unit of forces, if it is another one than a pressure times an area.
    pub force: Option<String>,
}

impl Units {
    /// Metres and pascals.
    pub fn si() -> Self {
        let [length, pressure, force] = [LENGTH, PRESSURE, FORCE].map(|dimension| Some(dimension.si.to_owned()));
        Self { length, pressure, force }
    }

    /// The units of a map, which may know the unit of length alone.
    pub fn of_map(length: Option<&str>) -> Self {
        Self { length: length.map(str::to_owned), ..Self::default() }
    }

    /// A warning in these units.
    pub fn describe(&self, warning: &Warning) -> Notice {
        let message = warning.message_with(|value| self.number(value, LENGTH), |value| self.number(value, PRESSURE));
        Notice { code: warning.code.name().to_owned(), message, severity: warning.severity() }
    }

    /// The unit of a dimension: its own of the SI, or a product of those that are known.
    pub fn unit(&self, dimension: Dimension) -> Option<String> {
        if let (true, Some(force)) = (dimension == FORCE, &self.force) {
            return Some(force.clone());
        }
        let (length, pressure) = (self.length.as_deref(), self.pressure.as_deref());
        let [pressures, lengths, others @ ..] = dimension.powers;
        // a force is a pressure times an area
        let lengths = lengths + 2 * pressures;
        let is_si = (pressures == 0 || pressure == Some(PRESSURE.si)) && (lengths == 0 || length == Some(LENGTH.si));
        if is_si {
            return Some(dimension.si.to_owned());
        }
        if others != [0; 3] {
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

    /// A number of a dimension for people, with its unit as far as that is known, and with a prefix in SI units.
    pub fn number(&self, value: f64, dimension: Dimension) -> String {
        match self.unit(dimension) {
            Some(unit) if unit == dimension.si => si(value, &unit),
            Some(unit) => format!("{} {unit}", plain(value)),
            None => plain(value),
        }
    }

    /// The same, with the prefix of another number.
    pub fn number_like(&self, value: f64, like: f64, dimension: Dimension) -> String {
        let si = self.unit(dimension).filter(|unit| unit == dimension.si);
        match si.and_then(|unit| numbers::scale(like, &unit)) {
            Some((power, unit)) => format!("{} {unit}", numbers::rounded(value / 10f64.powi(power), 4, 1e6)),
            None => self.number(value, dimension),
        }
    }

    /// The side lengths of a map for people.
    pub fn sides(&self, (lx, ly): (f64, f64)) -> String {
        format!("{} x {}", self.number(lx, LENGTH), self.number(ly, LENGTH))
    }

    /// The units of a table, if they are all known, for comparing two runs.
    pub fn of_table(&self) -> String {
        let units = [LENGTH, PRESSURE, FORCE].map(|dimension| self.unit(dimension));
        units.into_iter().collect::<Option<Vec<_>>>().map_or("none".to_owned(), |units| units.join(" "))
    }
}
