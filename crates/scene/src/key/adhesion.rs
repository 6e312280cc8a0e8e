//! The adhesion between the surfaces, as options, keywords and reports describe it.

use std::path::PathBuf;

use asperity::adhesion::Formula;
use asperity::{AdhesionLaw, Error, Hardness, MaugisDugdale, Real, Result, Tabulated};
use ndarray::ArrayView2;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::key::{
    Constraint, ENERGY, ENERGY_PER_AREA, Entries, Kind, LAWS, LENGTH, Law, PRESSURE, PRESSURE_PER_LENGTH, Range,
    Scalar, WORK, Wall, Word, keys, record,
};
use crate::numbers::plain;

keys! {
    /// The adhesion between the surfaces, the wall, and the hardness.
    AdhesionKeys {
        "Adhesion" {
            /// Adhesion law, over the gap g; asperity laws lists the parameters and the source of each
            law: Option<String> = Kind::word(laws, &["LAW"]).or("none"),
            /// Work of adhesion; all that jkr needs
            work_of_adhesion: Option<f64> = Kind::quantity(ENERGY_PER_AREA, Range::NON_NEGATIVE, &["W"]),
            /// Range of adhesion; for lennard-jones and van-der-waals the distance of the surfaces in contact
            range: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["RHO"]),
            /// Exponent of the energy of a power law
            exponent: Option<f64> = Kind::number(Range::POSITIVE, &["N"]),
            /// Hamaker's constant of van-der-waals
            hamaker: Option<f64> = Kind::quantity(ENERGY, Range::POSITIVE, &["A"]),
            /// Table of a law: lines of a gap, rising from 0, and a traction, attraction positive, the last one 0
            law_table: Option<PathBuf> = Kind::file(),
            /// Gap at which a law without an end is cut off, smoothly and with all of its work of adhesion
            cut_off: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["D"]),
            /// Work of adhesion at each node, in a file with a format and the shape of the heights
            work_of_adhesion_map: Option<PathBuf> = Kind::file(),
            /// What keeps the surfaces apart: a rigid wall, the repulsion of lennard-jones or morse alone, or springs
            wall: Option<Wall> = Kind::word(Wall::words, &["WALL"]).or("hard"),
            /// Stiffness of the springs of a penalty or uzawa wall
            wall_stiffness: Option<f64> = Kind::quantity(PRESSURE_PER_LENGTH, Range::POSITIVE, &["K"]),
        }
        "Body" {
            /// Hardness, the greatest contact pressure, at which the surface yields and stays flattened
            hardness: Option<f64> = Kind::quantity(PRESSURE, Range::POSITIVE, &["H"]),
            /// Hardness at each node, in a file with a format and the shape of the heights; in Pa if other numbers have
            /// units
            hardness_map: Option<PathBuf> = Kind::file(),
        }
    }
}

/// The names of the laws, with their formulas.
fn laws() -> Vec<Word> {
    LAWS.iter().map(|law| Word { name: law.name, help: law.formula }).collect()
}

record! {
    /// The adhesion and the wall, by their names in every report; without adhesion at a hard wall by default.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    Adhesion of (keys: AdhesionKeys) {
        /// The name of the law, one of [`LAWS`] or the class of one's own.
        law: String = keys.law.unwrap_or(LAWS[0].name.to_owned()),
        /// The work of adhesion, if it is a parameter.
        work_of_adhesion: Option<f64> = keys.work_of_adhesion,
        /// The range, if it is a parameter.
        range: Option<f64> = keys.range,
        /// The exponent of a power law.
        exponent: Option<f64> = keys.exponent,
        /// Hamaker's constant, if it is a parameter.
        hamaker: Option<f64> = keys.hamaker,
        /// The file of a table.
        law_table: Option<String> = keys.law_table.map(named),
        /// The gap at which the law is cut off, if it is.
        cut_off: Option<f64> = keys.cut_off,
        /// The file of works of adhesion that vary.
        work_of_adhesion_map: Option<String> = keys.work_of_adhesion_map.map(named),
        /// The wall.
        wall: Wall = keys.wall.unwrap_or_default(),
        /// The stiffness of the springs of a wall that has some, a pressure per length.
        wall_stiffness: Option<f64> = keys.wall_stiffness,
        /// The hardness at which the surface yields, a pressure, if it does; of a hardness that varies its mean, in
        /// reports.
        hardness: Option<f64> = keys.hardness,
        /// The file of a hardness that varies.
        hardness_map: Option<String> = keys.hardness_map.map(named),
    }
}

fn named(path: PathBuf) -> String {
    path.to_string_lossy().into_owned()
}

impl Default for Adhesion {
    fn default() -> Self {
        Self::record(Entries::default().keys())
    }
}

impl Adhesion {
    /// The law, if it is one of the library.
    pub fn law(&self) -> Option<&'static Law> {
        Law::named(&self.law)
    }

    /// The adhesion of a law that a face has as an object, with this wall and this hardness.
    pub(crate) fn of_law(self, law: Self) -> Self {
        let Self { wall, wall_stiffness, hardness, hardness_map, .. } = self;
        Self { wall, wall_stiffness, hardness, hardness_map, ..law }
    }

    /// Whether there is adhesion.
    pub fn adheres(&self) -> bool {
        self.law != LAWS[0].name
    }

    /// Whether the surface yields.
    pub fn yields(&self) -> bool {
        self.hardness.is_some() || self.hardness_map.is_some()
    }

    /// Refuses a law without its parameters, parameters of other laws, and a wall that does not fit.
    ///
    /// # Errors
    /// The reason with a remedy, with keys in braces, for [`worded`](crate::worded).
    pub fn check(&self) -> std::result::Result<(), String> {
        let Some(law) = self.law() else { return Ok(()) };
        let (name, mapped, given) = (law.name, self.work_of_adhesion_map.is_some(), json!(self));
        let text_of = |key: &str| match &given[key] {
            Value::Null => None,
            Value::String(text) => Some(text.clone()),
            number => number.as_f64().map(plain),
        };
        if law.needs.is_empty() {
            let mut keys = Law::keys().map(|key| key.name).chain(["cut_off", "work_of_adhesion_map"]);
            if let Some(key) = keys.find(|key| text_of(key).is_some()) {
                return Err(format!(
                    "{{{key}}} is given, but there is no adhesion: choose {{law}} jkr, or {{law}} exponential for a work \
                     of adhesion with a range, or leave it out"
                ));
            }
        }
        for parameter in Law::keys() {
            let key = parameter.name;
            let replaced = mapped && key == WORK;
            let reason = match text_of(key) {
                None if law.needs.contains(&key) && !replaced => {
                    return Err(format!("{{law}} {name} lacks {{{key}}}: give it, {}", parameter.what()));
                }
                Some(_) if replaced => {
                    return Err(format!(
                        "{{{key}}} is given with {{work_of_adhesion_map}}, which says it at every node: leave one of them \
                         out"
                    ));
                }
                Some(value) if law.of_grid && key == "range" => format!(
                    "{value}, but {{law}} {name} is the limit of zero range, as short as the grid can resolve: leave it out, or \
                     choose a law with a range, such as {{law}} exponential"
                ),
                Some(value) if !law.needs.contains(&key) => {
                    format!("{value}, but {{law}} {name} has no use for it: leave it out")
                }
                _ => continue,
            };
            return Err(format!("{{{key}}} is {reason}"));
        }
        if let (Some(distance), false) = (self.cut_off, law.never_ends) {
            return Err(format!("{{cut_off}} is {distance}, but {{law}} {name} ends by itself: leave it out"));
        }
        self.check_wall()
    }

    /// Refuses a wall that does not fit.
    ///
    /// # Errors
    /// As [`Adhesion::check`].
    pub fn check_wall(&self) -> std::result::Result<(), String> {
        let (wall, law) = (self.wall, &self.law);
        if wall == Wall::None && !self.law().is_none_or(|law| law.repels) {
            let repel: Vec<_> = LAWS.iter().filter(|law| law.repels).map(|law| law.name).collect();
            let repel = repel.join(" or ");
            // a table may repel before its end
            let reason =
                if law == "table" { "ends at a gap of 0, below which nothing repels" } else { "does not repel" };
            return Err(format!(
                "{{wall}} none leaves the surfaces to the law, but {{law}} {law} {reason}: choose {repel}, or {{wall}} hard"
            ));
        }
        if let (Some(_), Some(_)) = (self.hardness, &self.hardness_map) {
            let reason = "which says it at every node: leave one of them out";
            return Err(format!("{{hardness}} is given with {{hardness_map}}, {reason}"));
        }
        if wall != Wall::Hard {
            self.check_elastic(&format!("{{wall}} {wall} does not yield"))
                .map_err(|reason| format!("{reason}, or choose {{wall}} hard"))?;
        }
        match (wall.has_springs(), self.wall_stiffness) {
            (true, None) => Err(format!("{{wall}} {wall} lacks {{wall_stiffness}}: give it, a pressure per length")),
            (false, Some(given)) => Err(format!(
                "{{wall_stiffness}} is {}, but {{wall}} {wall} has no springs: leave it out, or choose {{wall}} penalty or \
                 {{wall}} uzawa",
                plain(given)
            )),
            _ => Ok(()),
        }
    }

    /// Refuses a surface that yields, for a reason.
    ///
    /// # Errors
    /// As [`Adhesion::check`].
    pub fn check_elastic(&self, reason: &str) -> std::result::Result<(), String> {
        let map = self.hardness_map.as_ref().map(|_| "hardness_map");
        let given = self.hardness.map(|_| "hardness").or(map);
        given.map_or(Ok(()), |key| Err(format!("{{{key}}} is given, but {reason}: leave it out")))
    }

    /// The wall as a solve takes it, with a hardness at the nodes of the surface where it varies.
    ///
    /// # Errors
    /// Those of [`Wall::constraint`] and [`Hardness`].
    pub(crate) fn constraint<T: Real>(&self, hardness: Option<ArrayView2<'_, f64>>) -> Result<Constraint<T>> {
        let hardness = match hardness {
            Some(varying) => Some(Hardness::varying(varying.to_owned())?),
            None => self.hardness.map(Hardness::new).transpose()?,
        };
        self.wall.constraint(self.wall_stiffness, hardness)
    }

    /// The law without variation of its work of adhesion, with the law of its table, if it has one.
    ///
    /// # Errors
    /// Errors of the law, and of [`CutOff::new`](asperity::adhesion::CutOff::new).
    pub fn formula(&self, table: Option<&Tabulated>) -> Result<Formula> {
        let unknown = Error::Unsuited { what: "law", reason: "it has no name of a law: see LAWS" };
        let law = (self.law().ok_or(unknown)?.make)(self, table)?;
        match self.cut_off {
            Some(distance) => law.cut_off(distance),
            None => Ok(law),
        }
    }

    /// The law with works of adhesion at the nodes, shape (Nx, Ny).
    ///
    /// # Errors
    /// Those of [`Adhesion::formula`] and [`Varying::new`](asperity::adhesion::Varying::new).
    pub(crate) fn formula_on(&self, works: ArrayView2<'_, f64>, table: Option<&Tabulated>) -> Result<Formula> {
        // of a law of one unit they are multiples of one
        let unit: Formula = MaugisDugdale::new(1.0, 1.0)?.into();
        let most = f64::law(unit.varied(works)?).hints().work_of_adhesion;
        Self { work_of_adhesion: Some(most), ..self.clone() }.formula(table)?.varied(works)
    }
}
