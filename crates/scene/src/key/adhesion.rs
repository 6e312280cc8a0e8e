//! The adhesion between the surfaces, as options, keywords and reports describe it.

use std::sync::Arc;

use asperity::{Hardness, MaugisDugdale, Real, Result, Tabulated};
use ndarray::ArrayView2;
use serde::{Deserialize, Serialize};

use crate::key::formula::Formula;
use crate::key::laws::{LAWS, Law, PARAMETERS, Parameter, WORK};
use crate::key::wall::{Constraint, Wall};
use crate::numbers::plain;

/// The adhesion and the wall, by their names in every report; without adhesion at a hard wall by default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Adhesion {
    /// The name of the law, one of [`LAWS`] or the class of one's own.
    pub law: String,
    /// The work of adhesion, if it is a parameter.
    pub work_of_adhesion: Option<f64>,
    /// The range, if it is a parameter.
    pub range: Option<f64>,
    /// The exponent of a power law.
    pub exponent: Option<f64>,
    /// Hamaker's constant, if it is a parameter.
    pub hamaker: Option<f64>,
    /// The file of a table.
    pub law_table: Option<String>,
    /// The gap at which the law is cut off, if it is.
    pub cut_off: Option<f64>,
    /// The file of works of adhesion that vary.
    pub work_of_adhesion_map: Option<String>,
    /// The wall.
    pub wall: Wall,
    /// The stiffness of the springs of a wall that has some, a pressure per length.
    pub wall_stiffness: Option<f64>,
    /// The hardness at which the surface yields, a pressure, if it does; of a hardness that varies its mean, in
    /// reports.
    pub hardness: Option<f64>,
    /// The file of a hardness that varies.
    pub hardness_map: Option<String>,
}

impl Default for Adhesion {
    fn default() -> Self {
        Self::of("none")
    }
}

impl Adhesion {
    /// A law by its name, without parameters.
    pub fn of(law: impl Into<String>) -> Self {
        Self {
            law: law.into(),
            work_of_adhesion: None,
            range: None,
            exponent: None,
            hamaker: None,
            law_table: None,
            cut_off: None,
            work_of_adhesion_map: None,
            wall: Wall::default(),
            wall_stiffness: None,
            hardness: None,
            hardness_map: None,
        }
    }

    /// The law, if it is one of the library.
    pub fn law(&self) -> Option<&'static Law> {
        Law::named(&self.law)
    }

    /// Whether there is adhesion.
    pub fn adheres(&self) -> bool {
        self.law != LAWS[0].name
    }

    /// Whether the surface yields.
    pub fn yields(&self) -> bool {
        self.hardness.is_some() || self.hardness_map.is_some()
    }

    /// The value of a parameter in words, if it is given.
    fn given(&self, key: &str) -> Option<String> {
        match key {
            WORK => self.work_of_adhesion.map(plain),
            "range" => self.range.map(plain),
            "exponent" => self.exponent.map(|value| value.to_string()),
            "hamaker" => self.hamaker.map(plain),
            "law_table" => self.law_table.clone(),
            "cut_off" => self.cut_off.map(plain),
            "work_of_adhesion_map" => self.work_of_adhesion_map.clone(),
            _ => None,
        }
    }

    /// Refuses a law without its parameters, parameters that are not those of the law, and a wall that does not fit.
    ///
    /// # Errors
    /// The reason with a remedy, with the names that `named` gives to keys.
    pub fn check(&self, named: impl Fn(&str) -> String) -> std::result::Result<(), String> {
        let Some(law) = self.law() else { return Ok(()) };
        let (name, mapped) = (law.name, self.work_of_adhesion_map.is_some());
        let chosen = format!("{} {name}", named("law"));
        if law.needs.is_empty() {
            let mut keys = PARAMETERS.iter().map(|parameter| parameter.key).chain(["cut_off", "work_of_adhesion_map"]);
            if let Some((key, value)) = keys.find_map(|key| Some((key, self.given(key)?))) {
                let law = named("law");
                return Err(format!(
                    "{} is {value}, but there is no adhesion: choose {law} jkr, or {law} exponential for a work of \
                     adhesion with a range, or leave it out",
                    named(key)
                ));
            }
        }
        for Parameter { key, what, .. } in &PARAMETERS {
            let replaced = mapped && *key == WORK;
            match self.given(key) {
                None if law.needs.contains(key) && !replaced => {
                    return Err(format!("{chosen} lacks {}: give it, {what}", named(key)));
                }
                Some(_) if replaced => {
                    return Err(format!(
                        "{} is given beside {}, which says it at every node: leave one of them out",
                        named(key),
                        named("work_of_adhesion_map")
                    ));
                }
                Some(value) if law.of_grid && *key == "range" => {
                    return Err(format!(
                        "{} is {value}, but {chosen} is the limit of no range, as short as the grid can resolve: leave it \
                         out, or choose a law with a range, as {} exponential",
                        named(key),
                        named("law")
                    ));
                }
                Some(value) if !law.needs.contains(key) => {
                    return Err(format!("{} is {value}, but {chosen} has no use for it: leave it out", named(key)));
                }
                _ => {}
            }
        }
        if let (Some(distance), false) = (self.cut_off, law.never_ends) {
            return Err(format!("{} is {distance}, but {chosen} ends by itself: leave it out", named("cut_off")));
        }
        self.check_wall(named)
    }

    /// Refuses a wall that does not fit.
    ///
    /// # Errors
    /// As of [`Adhesion::check`].
    pub fn check_wall(&self, named: impl Fn(&str) -> String) -> std::result::Result<(), String> {
        let (wall, repels) = (named("wall"), self.law().is_none_or(|law| law.repels));
        if self.wall == Wall::None && !repels {
            return Err(format!(
                "{wall} none leaves the surfaces to the law, but {} {} does not repel: choose lennard-jones or morse, \
                 or {wall} hard",
                named("law"),
                self.law
            ));
        }
        let [hardness, map] = ["hardness", "hardness_map"].map(&named);
        if let (Some(_), Some(_)) = (self.hardness, &self.hardness_map) {
            return Err(format!(
                "{hardness} is given beside {map}, which says it at every node: leave one of them out"
            ));
        }
        if self.yields() && self.wall != Wall::Hard {
            let given = if self.hardness.is_some() { hardness } else { map };
            let chosen = self.wall;
            return Err(format!(
                "{given} is given, but {wall} {chosen} does not yield: leave it out, or choose {wall} hard"
            ));
        }
        let stiffness = named("wall_stiffness");
        match (self.wall.has_springs(), self.wall_stiffness) {
            (true, None) => Err(format!("{wall} {} lacks {stiffness}: give it, a pressure per length", self.wall)),
            (false, Some(given)) => Err(format!(
                "{stiffness} is {}, but {wall} {} has no springs: leave it out, or choose {wall} penalty or {wall} uzawa",
                plain(given),
                self.wall
            )),
            _ => Ok(()),
        }
    }

    /// The wall as a solve takes it, with a hardness at the nodes of the surface where it varies.
    ///
    /// # Errors
    /// Those of [`Wall::constraint`] and [`Hardness`].
    pub fn constraint<T: Real>(&self, hardness: Option<ArrayView2<'_, f64>>) -> Result<Constraint<T>> {
        let hardness = match hardness {
            Some(varying) => Some(Hardness::varying(varying.to_owned())?),
            None => self.hardness.map(Hardness::new).transpose()?,
        };
        self.wall.constraint(self.wall_stiffness, hardness)
    }

    /// The law, whose works of adhesion do not vary, with the law of its table, if it has one.
    ///
    /// # Errors
    /// Those of the law, and those of [`CutOff::new`](asperity::adhesion::CutOff::new).
    pub fn formula(&self, table: Option<&Tabulated>) -> Result<Formula> {
        let law = self.law().unwrap_or(&LAWS[0]);
        let [work, range, hamaker] =
            [self.work_of_adhesion, self.range, self.hamaker].map(|value| value.unwrap_or(1.0));
        let values = [work, range, self.exponent.unwrap_or_default(), hamaker];
        let law = (law.make)(values, self.wall != Wall::None, table)?;
        match self.cut_off {
            Some(distance) => law.cut_off(distance),
            None => Ok(law),
        }
    }

    /// The law with works of adhesion at the nodes, shape (Nx, Ny).
    ///
    /// # Errors
    /// Those of [`Adhesion::formula`] and [`Varying::new`](asperity::adhesion::Varying::new).
    pub fn formula_on(&self, works: ArrayView2<'_, f64>, table: Option<&Tabulated>) -> Result<Formula> {
        // of a law of one unit they are multiples of one
        let unit: Formula = Arc::new(MaugisDugdale::new(1.0, 1.0)?);
        let most = unit.varied(works)?.law::<f64>().hints().work_of_adhesion;
        Self { work_of_adhesion: Some(most), ..self.clone() }.formula(table)?.varied(works)
    }
}
