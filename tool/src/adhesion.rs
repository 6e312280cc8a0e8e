//! The adhesion between the surfaces: its law with the parameters, where it varies, and the wall.

use std::path::{Path, PathBuf};

use asperity::{Error, Grid, Tabulated};
use asperity_maps::io::read_field;
use asperity_scene::{Adhesion as Described, Formula, LAWS, Wall, tabulated};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use ndarray::Array2;

use crate::allowed::positive;
use crate::heights;
use crate::outcome::Outcome;
use crate::processes::Processes;
use crate::quantity::{ENERGY, ENERGY_PER_AREA, LENGTH, PRESSURE, PRESSURE_PER_LENGTH, Quantity};

/// The name of no law.
const NONE: &str = "none";

/// The adhesion between the surfaces.
#[derive(Args)]
pub struct AdhesionOptions {
    /// Adhesion law, over the gap g; asperity laws tells what each needs and where it is from
    #[arg(long, value_name = "LAW", default_value = NONE, value_parser = laws(), help_heading = "Adhesion")]
    pub law: String,
    /// Work of adhesion, an energy per area; all that jkr needs
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = ENERGY_PER_AREA.non_negative())]
    #[arg(help_heading = "Adhesion")]
    pub work_of_adhesion: Option<Quantity>,
    /// Range of adhesion, a length; for lennard-jones and van-der-waals the distance of the surfaces in contact
    #[arg(long, value_name = "RHO", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    #[arg(help_heading = "Adhesion")]
    pub range: Option<Quantity>,
    /// Exponent of the energy of a power law
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = positive, help_heading = "Adhesion")]
    pub exponent: Option<f64>,
    /// Hamaker's constant of van-der-waals, an energy
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = ENERGY.positive())]
    #[arg(help_heading = "Adhesion")]
    pub hamaker: Option<Quantity>,
    /// Table of a law: lines of a gap, rising from 0, and a traction, attraction positive, the last one 0
    #[arg(long, value_name = "FILE", help_heading = "Adhesion")]
    pub law_table: Option<PathBuf>,
    /// Gap at which a law that never ends is cut off, smoothly and with all of its work of adhesion
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = LENGTH.positive())]
    #[arg(help_heading = "Adhesion")]
    pub cut_off: Option<Quantity>,
    /// Work of adhesion at each node, in a file as for the heights and of their shape, in the place of one for all
    #[arg(long, value_name = "FILE", help_heading = "Adhesion")]
    pub work_of_adhesion_map: Option<PathBuf>,
    /// What keeps the surfaces apart: a rigid wall, the repulsion of lennard-jones or morse alone, or springs
    #[arg(long, value_enum, default_value_t = Wall::Hard, help_heading = "Adhesion")]
    pub wall: Wall,
    /// Stiffness of the springs of a penalty or uzawa wall, a pressure per length
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = PRESSURE_PER_LENGTH.positive())]
    #[arg(help_heading = "Adhesion")]
    pub wall_stiffness: Option<Quantity>,
    /// Hardness, a pressure that caps the contact pressure: the surface yields there and stays flattened
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = PRESSURE.positive())]
    #[arg(help_heading = "Body")]
    pub hardness: Option<Quantity>,
    /// Hardness at each node, in a file as for the heights and of their shape, in the place of one for all; in Pa where
    /// other numbers have units
    #[arg(long, value_name = "FILE", help_heading = "Body")]
    pub hardness_map: Option<PathBuf>,
}

/// The law of a table, and its numbers.
type Table = (Tabulated, Array2<f64>);

/// The law that the options choose, with what their files hold.
pub struct Adhesion {
    /// The law
    pub formula: Formula,
    /// The numbers of the table of the law
    pub table: Option<Array2<f64>>,
    /// The works of adhesion of the map, at all nodes
    pub works: Option<Array2<f64>>,
    /// The hardness of the map, at all nodes
    pub hardness: Option<Array2<f64>>,
}

/// The names of the laws, with their help.
fn laws() -> PossibleValuesParser {
    LAWS.iter().map(|law| PossibleValue::new(law.name).help(law.formula)).into()
}

/// The option of a key.
pub fn option(key: &str) -> String {
    format!("--{}", key.replace('_', "-"))
}

impl AdhesionOptions {
    /// The adhesion by the names of reports.
    pub fn described(&self) -> Described {
        let number = |given: Option<Quantity>| given.map(|given| given.value);
        let path = |file: Option<&Path>| file.map(|path| path.to_string_lossy().into_owned());
        Described {
            law: self.law.clone(),
            work_of_adhesion: number(self.work_of_adhesion),
            range: number(self.range),
            exponent: self.exponent,
            hamaker: number(self.hamaker),
            law_table: path(self.law_table.as_deref()),
            cut_off: number(self.cut_off),
            work_of_adhesion_map: path(self.work_of_adhesion_map.as_deref()),
            wall: self.wall,
            wall_stiffness: number(self.wall_stiffness),
            hardness: number(self.hardness),
            hardness_map: path(self.hardness_map.as_deref()),
        }
    }

    /// Refuses a law without its parameters, parameters that are not those of the law, and a wall that does not fit.
    pub fn check(&self) -> Outcome<()> {
        Ok(self.described().check(option)?)
    }

    /// Whether there is adhesion.
    pub fn adheres(&self) -> bool {
        self.law != NONE
    }

    /// Refuses a surface that yields, for a reason.
    pub fn check_elastic(&self, reason: &str) -> Outcome<()> {
        let map = self.hardness_map.as_ref().map(|_| "--hardness-map");
        let given = self.hardness.map(|_| "--hardness").or(map);
        given.map_or(Ok(()), |option| Err(format!("{option} is given, but {reason}: leave it out").into()))
    }

    /// The law, whose works of adhesion do not vary; reads its table.
    pub fn uniform(&self) -> Outcome<(Formula, Option<Table>)> {
        let read = |path: &PathBuf| -> Outcome<_> {
            let table = read_field(path)?;
            Ok((tabulated(path, &table)?, table))
        };
        let table = self.law_table.as_ref().map(read).transpose()?;
        Ok((self.described().formula(table.as_ref().map(|(law, _)| law))?, table))
    }

    /// Reads the files, with maps of all nodes of the grid in each process.
    pub fn read(&self, grid: &Grid, processes: &Processes) -> Outcome<Adhesion> {
        let read = || {
            let map = |option, path: Option<&Path>| {
                path.map(|path| heights::rows_on(option, path, &grid.alone())).transpose()
            };
            let works = map("--work-of-adhesion-map", self.work_of_adhesion_map.as_deref())?;
            let hardness = map("--hardness-map", self.hardness_map.as_deref())?;
            // whatever the law refuses with any work of adhesion
            Ok((self.uniform()?, works, hardness))
        };
        let ((formula, table), works, hardness) = processes.agree(read())?;
        let (tabulated, table) = table.unzip();
        let formula = match (&works, &self.work_of_adhesion_map) {
            (Some(works), Some(path)) => {
                let law = self.described().formula_on(works.view(), tabulated.as_ref());
                law.map_err(|error| Error::file(path, format!("does not fit the law: {error}")))?
            }
            _ => formula,
        };
        Ok(Adhesion { formula, table, works, hardness })
    }
}
