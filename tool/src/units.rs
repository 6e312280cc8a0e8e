//! The units of the numbers that a command gives.

pub use asperity_scene::units::{Units, dimension_of};
use clap::Args;

use crate::allowed::unit;
use crate::outcome::Outcome;
use crate::quantity::{Dimension, FORCE, LENGTH, PRESSURE};

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
