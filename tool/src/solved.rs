//! The results of a solve, as other commands read them from its folder.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::{Error, Result};
use asperity_maps::Topography;
use asperity_maps::io::read_field;
use asperity_scene::{Account, Boundary, Elastic, Inputs, Units, key};
use serde_json::Value;

/// The files of gap and contact pressure.
pub const GAP: &str = "gap.npy";
pub const CONTACT_PRESSURE: &str = "contact_pressure.npy";
const REPORT: &str = "report.json";

/// The folder of a solve, with its report.
pub struct Solved<'a> {
    pub folder: &'a Path,
    pub report: Value,
}

impl<'a> Solved<'a> {
    /// The files that are read of a folder: the report, and some fields.
    pub fn files(folder: &Path, fields: &[&str]) -> Vec<PathBuf> {
        std::iter::once(&REPORT).chain(fields).map(|name| folder.join(name)).collect()
    }

    /// Reads the report.
    ///
    /// # Errors
    /// [`Error::File`] if the folder does not belong to a solve.
    pub fn read(folder: &'a Path) -> Result<Self> {
        let refuse = |reason: &str| Error::file(folder, reason);
        let text = fs::read_to_string(folder.join(REPORT))
            .map_err(|_| refuse("has no report.json: name the folder of a solve"))?;
        let report: Value =
            serde_json::from_str(&text).map_err(|_| refuse("has a report.json that is no report of a solve"))?;
        if report[key!(Account, command)] != "solve" && report[key!(Account, command)] != "demo" {
            return Err(refuse("has the results of another command: name the folder of a solve"));
        }
        Ok(Self { folder, report })
    }

    /// A field with its side lengths and their unit.
    ///
    /// # Errors
    /// [`Error::File`] if it is not there, or cannot be read.
    pub fn map(&self, name: &str) -> Result<Topography> {
        let path = self.folder.join(name);
        if !path.exists() {
            return Err(Error::file(self.folder, format!("has no {name}: solve with --format npy")));
        }
        let mut map = Topography::new(read_field(&path)?);
        let side = |k: usize| self.report[key!(Inputs, lengths)][k].as_f64();
        map.lengths = side(0).zip(side(1));
        map.unit = self.report[key!(Inputs, length_unit)].as_str().map(str::to_owned);
        Ok(map)
    }

    /// What is beyond the map: around the original of a mirrored map sides through which nothing flows, or which have
    /// one pressure, as around a free map.
    pub fn boundary(&self) -> Boundary {
        let free = self.report[key!(Elastic, boundary)] == "free" || self.is_original();
        if free { Boundary::Free } else { Boundary::Periodic }
    }

    /// Whether the map is the original of a mirrored one.
    pub fn is_original(&self) -> bool {
        self.report[key!(Inputs, solved_shape)].is_array()
    }

    /// The units of its numbers, as far as they are known.
    pub fn units(&self) -> Units {
        units_of(&self.report)
    }
}

/// The units of the numbers of a report, as far as they are known.
pub fn units_of(report: &Value) -> Units {
    let [length, pressure] = ["length_unit", "pressure_unit"].map(|key| report[key].as_str().map(str::to_owned));
    Units { length, pressure, force: None }
}
