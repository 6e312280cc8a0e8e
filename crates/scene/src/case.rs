//! A case: what is asked of a scene, checked, and posed on its maps, the same for program, Python and page.

mod maps;
mod part;
mod posed;

use asperity::Tabulated;
use asperity::adhesion::Formula;

pub use self::maps::{Map, Maps, complete, sided};
pub use self::part::Part;
pub use self::posed::Posed;
use crate::key::{
    Adhesion, After, Boundary, Branches, Entries, Load, Quantities, Request, Scene, Skin, Symbol, worded,
};
use crate::outcome::Outcome;

/// What a face gives as objects, in the place of keys.
#[derive(Default)]
pub struct Objects {
    /// The law, with its name and parameters in reports.
    pub law: Option<(Formula, Adhesion)>,
    /// The stiffness of the waves of a body.
    pub symbol: Option<Symbol>,
    /// Whether the hardness differs from node to node.
    pub has_hardness: bool,
    /// Whether numbers without units are in SI units.
    pub numbers_are_si: bool,
}

/// What is asked, checked: units, law, wall and body. A case alone has a formula and is posed on maps.
#[derive(Clone)]
pub struct Case {
    given: Entries,
    quantities: Quantities,
    scene: Scene,
    law: Option<Formula>,
    numbers_are_si: bool,
    skin: Skin,
}

impl Case {
    /// The case of what is given, with words in a skin. All `quantities` have units, or none has.
    ///
    /// # Errors
    /// The key and the remedy, for units of some quantities, a law, a wall or a body without their parameters, and
    /// parameters of another one.
    pub fn new(given: Entries, quantities: Quantities, objects: Objects, skin: Skin) -> Outcome<Self> {
        let Objects { law, symbol, has_hardness, numbers_are_si } = objects;
        if !numbers_are_si {
            quantities.check(skin)?;
        }
        let mut scene = given.scene();
        if has_hardness {
            scene.adhesion.hardness_map = Some("array".to_owned());
        }
        let law = law.map(|(formula, adhesion)| {
            scene.adhesion = scene.adhesion.clone().of_law(adhesion);
            formula
        });
        if symbol.is_some() {
            scene.elastic.symbol = symbol;
        }
        let adhesion = if law.is_some() { scene.adhesion.check_wall() } else { scene.adhesion.check() };
        adhesion.and_then(|()| scene.elastic.check()).map_err(|text| worded(&text, skin))?;
        scene.elastic.body()?;
        Ok(Self { given, quantities, scene, law, numbers_are_si, skin })
    }

    /// The case with what is given for a call of it besides.
    ///
    /// # Errors
    /// The key and the remedy for units of some quantities.
    pub fn with(&self, parts: &[Entries]) -> Outcome<Self> {
        let of_call = parts.iter().map(|part| match self.numbers_are_si {
            true => part.quantities().in_si(),
            false => part.quantities(),
        });
        let quantities = Quantities::all(std::iter::once(self.quantities.clone()).chain(of_call));
        if !self.numbers_are_si {
            quantities.check(self.skin)?;
        }
        Ok(Self { given: Entries::all(std::iter::once(&self.given).chain(parts)), quantities, ..self.clone() })
    }

    /// What was given.
    pub fn given(&self) -> &Entries {
        &self.given
    }

    /// The quantities that were given.
    pub fn quantities(&self) -> &Quantities {
        &self.quantities
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// A result with a reason that has keys in braces.
    fn worded<V>(&self, found: Result<V, String>) -> Outcome<V> {
        Ok(found.map_err(|text| worded(&text, self.skin))?)
    }

    /// The load of a solve.
    ///
    /// # Errors
    /// As [`Entries::load`] and [`Load::check`].
    pub fn load(&self) -> Outcome<Load> {
        let load = self.worded(self.given.load())?;
        self.check_loads(&[load])?;
        Ok(load)
    }

    /// The loads of a table.
    ///
    /// # Errors
    /// As [`Entries::loads`] and [`Load::check`].
    pub fn loads(&self) -> Outcome<Vec<Load>> {
        let loads = self.worded(self.given.loads())?;
        self.check_loads(&loads)?;
        Ok(loads)
    }

    fn check_loads(&self, loads: &[Load]) -> Outcome<()> {
        let Scene { elastic, adhesion, .. } = &self.scene;
        let check = |load: &Load| load.check(elastic.boundary, elastic.has_approach(), adhesion.adheres());
        self.worded(loads.iter().try_for_each(check))
    }

    /// The findings that are asked for after a state; an interface has the contact stiffness.
    ///
    /// # Errors
    /// As [`Entries::after`] and [`After::check`].
    pub fn after(&self, is_interface: bool) -> Outcome<After> {
        if is_interface && self.scene.elastic.boundary == Boundary::Free {
            let text = "{boundary=free}: an interface has its law per area of a periodic cell: leave it out";
            return self.worded(Err(text.to_owned()));
        }
        let after = self.worded(self.given.after())?;
        let after = After { stiffness: after.stiffness || is_interface, ..after };
        self.worded(after.check(&self.scene.elastic, &self.scene.adhesion))?;
        Ok(after)
    }

    /// What is asked of a solve under its load, where a reduced pressure of 1 is the `full` pressure, from a start that is
    /// given or the default.
    ///
    /// # Errors
    /// As [`Case::load`], [`Case::after`] and [`Request::check`].
    pub fn request(&self, full: f64, started: bool) -> Outcome<Request> {
        self.after(false)?;
        let asked = self.worded(self.given.request(self.load()?, full))?;
        self.worded(asked.check(&self.scene.adhesion, self.scene.method, started))?;
        Ok(asked)
    }

    /// Refuses both branches of equilibria where each state starts from the one before.
    ///
    /// # Errors
    /// The remedy.
    pub fn check_table(&self) -> Outcome<()> {
        let both = self.scene.branch == Some(Branches::Both);
        let text = "{branch=both} compares two solves under one load: solve under one, or give one branch";
        self.worded(if both { Err(text.to_owned()) } else { Ok(()) })
    }

    /// Refuses a surface that yields, for a reason.
    ///
    /// # Errors
    /// The reason and the remedy.
    pub fn check_elastic(&self, reason: &str) -> Outcome<()> {
        self.worded(self.scene.adhesion.check_elastic(reason))
    }

    /// The law, with the law of its table and its works of adhesion at the nodes, if it has some.
    ///
    /// # Errors
    /// Errors of the law.
    fn formula(&self, table: Option<&Tabulated>, works: Option<&ndarray::Array2<f64>>) -> asperity::Result<Formula> {
        match (&self.law, works) {
            (Some(law), _) => Ok(law.clone()),
            // whatever the law refuses with any work of adhesion
            (None, Some(works)) => self.scene.adhesion.formula_on(works.view(), table),
            (None, None) => self.scene.adhesion.formula(table),
        }
    }
}
