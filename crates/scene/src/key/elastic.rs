//! The elastic body, by the names of its parameters.

use std::path::PathBuf;
use std::sync::Arc;

use asperity::elastic::{Base, Body, Coating, HalfSpace, Layer, Material, Plate, Series};
use asperity::{Boussinesq, ElasticOperator, Error, Grid, Real, Result, Spectral, Surface, Westergaard};
use asperity_maps::io::check_memory;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::key::{
    Boundary, ENERGY, Entries, Keys, Kind, LENGTH, PRESSURE, Range, Symbol, Units, Word, keys, needed, readable, record,
};

keys! {
    /// The surface, the bodies, and the boundary.
    SurfaceKeys {
        "Surface" {
            /// Heights of the rough surface, shape (Nx, Ny), peaks up: .npy, .npz, .gwy or .gsf (Gwyddion), .xyz,
            /// Gwyddion's text export, or a text matrix
            heights: Option<PathBuf> = Kind::file().required(),
            /// Side lengths of the map, in the unit of the heights; LX alone means square cells [default: the file's, else
            /// 1 1]
            lengths: Vec<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LX", "LY"]).from(1),
            /// Contact modulus E* = E/(1 - nu^2), with Young's modulus E and Poisson's ratio nu of the body that
            /// deforms
            modulus: Option<f64> = Kind::quantity(PRESSURE, Range::POSITIVE, &["E"]).or("1"),
            /// Surroundings of the map
            boundary: Option<Boundary> = Kind::word(Boundary::words, &["BOUNDARY"]).or("periodic"),
            /// Treat missing points of the file as absent nodes, where nothing faces the half-space, such as around a
            /// punch; in files of results their gap is NaN and their pressures are 0
            absent_missing: bool = Kind::switch(),
        }
        "Body" {
            /// Thickness of an elastic layer on a rigid base; needs {poisson}
            layer: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["T"]).excludes(&["coating"]),
            /// Hold of the base on the layer: bonded, or sliding without friction [default: bonded]
            base: Option<Base> = Kind::word(|| Word::all(&["bonded", "sliding"]), &["BASE"]),
            /// Thickness of an elastic coating on the half-space; {modulus} then belongs to the substrate; needs
            /// {coating_modulus}, {coating_poisson} and {poisson}
            coating: Option<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["T"]),
            /// Contact modulus E/(1 - nu^2) of the coating
            coating_modulus: Option<f64> = Kind::quantity(PRESSURE, Range::POSITIVE, &["E"]),
            /// Poisson's ratio of the coating
            coating_poisson: Option<f64> = Kind::number(Range::POISSON, &["NU"]),
            /// Bending stiffness D = E t^3/(12 (1 - nu^2)) of a plate on the half-space; {modulus} then belongs to the
            /// half-space
            plate: Option<f64> = Kind::quantity(ENERGY, Range::POSITIVE, &["D"]).excludes(&["layer", "coating"]),
            /// Poisson's ratio of the layer, or of the substrate under a coating
            poisson: Option<f64> = Kind::number(Range::POISSON, &["NU"]),
        }
        "Surface" {
            /// Heights of the second surface, with its peaks up, on as many nodes and the same sides; the program turns
            /// it over about the y axis, to face the first one
            against: Option<PathBuf> = Kind::file(),
            /// Contact modulus E/(1 - nu^2) of the second body, an elastic half-space [default: it is rigid]
            against_modulus: Option<f64> = Kind::quantity(PRESSURE, Range::POSITIVE, &["E"]),
            /// Shift of the second surface along x and y, also by parts of a node [default: 0 0]; write negative ones
            /// with a unit as --shift=-1um,0um
            shift: Vec<f64> = Kind::quantity(LENGTH, Range::FINITE, &["X", "Y"]).from(1).commas().needs(&["against"]),
            /// Give results on all nodes of a map that asperity prepare has mirrored, instead of the original
            whole: bool = Kind::switch(),
        }
    }
}

keys! {
    /// The side lengths of a map.
    LengthsKeys {
        "" {
            /// Side lengths of the map, in the unit of the file; LX alone means square cells [default: the file's]
            lengths: Vec<f64> = Kind::quantity(LENGTH, Range::POSITIVE, &["LX", "LY"]).from(1),
        }
    }
}

record! {
    /// The elastic body; a periodic half-space of a contact modulus of 1 by default. As data it has the keys of a report.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    Elastic of (keys: SurfaceKeys) {
        /// The boundary.
        boundary: Boundary = keys.boundary.unwrap_or_default(),
        /// The contact modulus E*, a pressure; of a coated body the substrate's.
        modulus: f64 = keys.modulus.unwrap_or(1.0),
        /// Poisson's ratio of a layer or of the substrate under a coating.
        poisson: Option<f64> = keys.poisson,
        /// The thickness of a layer on a rigid base, a length.
        layer: Option<f64> = keys.layer,
        /// The hold of the base on a layer; bonded by default.
        base: Option<Base> = keys.base.or(keys.layer.map(|_| Base::default())),
        /// The thickness of a coating on a half-space, a length.
        coating: Option<f64> = keys.coating,
        /// The contact modulus of a coating, a pressure.
        coating_modulus: Option<f64> = keys.coating_modulus,
        /// Poisson's ratio of a coating.
        coating_poisson: Option<f64> = keys.coating_poisson,
        /// The bending stiffness of a plate on a half-space, an energy.
        plate: Option<f64> = keys.plate,
        /// The body of a user's own, by the stiffness of its waves.
        symbol: Option<Symbol> = None,
        /// The contact modulus of the other body, an elastic half-space, a pressure; the other body is rigid without it.
        against_modulus: Option<f64> = keys.against_modulus,
    }
}

readable! {
    Option<Base>: Word = |value| serde_json::from_value(value?.clone()).ok();
}

impl Default for Elastic {
    fn default() -> Self {
        Self::record(Entries::default().keys())
    }
}

/// A kind of elastic body that is no half-space.
struct BodyKind {
    /// The key that chooses it, its thickness.
    key: &'static str,
    /// The keys that it needs besides.
    needs: &'static [&'static str],
    /// The keys that it may have.
    takes: &'static [&'static str],
    /// The body of its parameters.
    make: fn(&Elastic) -> Result<Arc<dyn Body>>,
    /// The body in words.
    told: fn(&Elastic, &Units) -> String,
}

impl BodyKind {
    /// Whether a key is one of its parameters.
    fn has(&self, key: &str) -> bool {
        self.needs.contains(&key) || self.takes.contains(&key)
    }
}

/// The kinds of elastic bodies besides the half-space.
static BODIES: [BodyKind; 4] = [
    BodyKind {
        key: "layer",
        needs: &["poisson"],
        takes: &["base"],
        make: |elastic| {
            let material = Material::new(elastic.modulus, needed(elastic.poisson)?)?;
            Ok(Arc::new(Layer::new(material, needed(elastic.layer)?, elastic.base.unwrap_or_default())?))
        },
        told: |elastic, units| {
            let hold = if elastic.base == Some(Base::Sliding) { "sliding" } else { "bonded" };
            format!("{hold} layer of {}", units.number(or_nan(elastic.layer), LENGTH))
        },
    },
    BodyKind {
        key: "coating",
        needs: &["coating_modulus", "coating_poisson", "poisson"],
        takes: &[],
        make: |elastic| {
            let coating = Material::new(needed(elastic.coating_modulus)?, needed(elastic.coating_poisson)?)?;
            let substrate = Material::new(elastic.modulus, needed(elastic.poisson)?)?;
            Ok(Arc::new(Coating::new(coating, needed(elastic.coating)?, substrate)?))
        },
        told: |elastic, units| {
            let modulus = units.number(or_nan(elastic.coating_modulus), PRESSURE);
            format!("coating of {}, contact modulus {modulus}", units.number(or_nan(elastic.coating), LENGTH))
        },
    },
    BodyKind {
        key: "plate",
        needs: &[],
        takes: &[],
        make: |elastic| Ok(Arc::new(Plate::new(needed(elastic.plate)?, HalfSpace::new(elastic.modulus)?)?)),
        told: |elastic, units| format!("plate of bending stiffness {}", units.number(or_nan(elastic.plate), ENERGY)),
    },
    BodyKind {
        key: "symbol",
        needs: &[],
        takes: &[],
        make: |elastic| match &elastic.symbol {
            Some(symbol) => Ok(Arc::new(symbol.clone())),
            None => Err(Error::Unsuited { what: "symbol", reason: "give the stiffness of waves" }),
        },
        told: |elastic, _| {
            let name = elastic.symbol.as_ref().map_or("none", |symbol| symbol.0.name());
            format!("by the stiffness of its waves, {name}")
        },
    },
];

/// A parameter as it is told; NaN of a body that lacks it, which nothing poses.
fn or_nan(number: Option<f64>) -> f64 {
    number.unwrap_or(f64::NAN)
}

impl Elastic {
    /// The keys of the body itself, in the order of its kinds.
    fn own(&self) -> impl Iterator<Item = (&'static str, String)> + use<> {
        let of_half_space = ["boundary", "modulus", "against_modulus"];
        let all = json!(self);
        let keys = SurfaceKeys::KEYS.iter().map(|key| key.name).chain(["symbol"]);
        let keys = keys.filter(move |key| !of_half_space.contains(key));
        keys.filter_map(move |key| match &all[key] {
            Value::Null => None,
            Value::String(text) => Some((key, text.clone())),
            number => number.as_f64().map(|number| (key, number.to_string())),
        })
    }

    /// The contact modulus E* of both bodies, of a body with `modulus` and of the other: 1/E* = 1/E₁* + 1/E₂*.
    pub(crate) fn with_other(&self, modulus: f64) -> f64 {
        self.against_modulus.map_or(modulus, |other| {
            let (softer, harder) = (modulus.min(other), modulus.max(other));
            softer / (1.0 + softer / harder)
        })
    }

    /// The first body alone, against a rigid one.
    pub(crate) fn alone(&self) -> Self {
        Self { against_modulus: None, ..self.clone() }
    }

    /// The other body, if it is elastic.
    pub(crate) fn other(&self) -> Option<Self> {
        self.against_modulus.map(|modulus| Self { modulus, boundary: self.boundary, ..Self::default() })
    }

    /// The body in words, and the other one, unless it is a half-space against a rigid one.
    pub(crate) fn in_words(&self, units: &Units) -> Option<String> {
        let against = |modulus| format!("against a half-space of contact modulus {}", units.number(modulus, PRESSURE));
        let own = self.kind().map(|kind| (kind.told)(self, units));
        let both: Vec<_> = [own, self.against_modulus.map(against)].into_iter().flatten().collect();
        (!both.is_empty()).then(|| both.join(" "))
    }

    /// The kind of the body, unless it is a half-space.
    fn kind(&self) -> Option<&'static BodyKind> {
        let Self { boundary, modulus, against_modulus, .. } = *self;
        // most bodies are half-spaces, which need no search for keys
        if *self == (Self { boundary, modulus, against_modulus, ..Self::default() }) {
            return None;
        }
        self.own().find_map(|(given, _)| BODIES.iter().find(|kind| kind.key == given))
    }

    /// The key that makes the body another one than a half-space, if it is.
    pub(crate) fn no_half_space(&self) -> Option<&'static str> {
        self.kind().map(|kind| kind.key)
    }

    /// Refuses a body without its parameters, and parameters of other bodies.
    ///
    /// # Errors
    /// The reason with a remedy, with keys in braces, for [`worded`](crate::worded).
    pub fn check(&self) -> std::result::Result<(), String> {
        let Some(kind) = self.kind() else {
            return self.own().next().map_or(Ok(()), |(key, value)| {
                let bodies = BODIES.iter().filter(|kind| kind.has(key)).map(|kind| format!("{{{}}}", kind.key));
                Err(format!(
                    "{{{key}}} is {value}, but the body is a half-space with {{modulus}} E/(1 - nu^2): leave it out, \
                     or give {}, a thickness",
                    bodies.collect::<Vec<_>>().join(" or ")
                ))
            });
        };
        if let Some(missing) = kind.needs.iter().find(|key| self.own().all(|(given, _)| given != **key)) {
            return Err(format!("{{{}}} needs {{{missing}}} as well: give both", kind.key));
        }
        let foreign = |key: &str| key != kind.key && !kind.has(key);
        if let Some((key, value)) = self.own().find(|(key, _)| foreign(key)) {
            return Err(format!("{{{key}}} is {value}, but a body with {{{}}} has none: leave it out", kind.key));
        }
        if self.boundary == Boundary::Free {
            return Err(format!(
                "{{{}}} has no free boundary, since only waves that repeat have its stiffness: leave out {{boundary}}, or \
                 make the map so large that its images do not matter",
                kind.key
            ));
        }
        Ok(())
    }

    /// The operator on the nodes of `grid`, if the machine has the memory for a solve: five fields of `f64`, and four
    /// times as many with a free boundary.
    ///
    /// # Errors
    /// [`Error::Memory`] if the memory is too small, and errors of the body and the operator.
    pub(crate) fn operator<T: Real>(&self, grid: Grid) -> Result<Box<dyn ElasticOperator<T>>> {
        if !grid.is_shared() {
            check_memory("a solve", grid.shape(), if self.boundary == Boundary::Free { 160 } else { 40 })?;
        }
        Ok(match (self.kind(), self.boundary) {
            (Some(_), _) => Box::new(Spectral::of(grid, self.body_on(&grid)?)?),
            (None, Boundary::Periodic) => Box::new(Westergaard::new(grid, self.with_other(self.modulus))?),
            (None, Boundary::Free) => Box::new(Boussinesq::new(grid, self.with_other(self.modulus))?),
        })
    }

    /// Whether the body has an approach in a periodic cell: it is a layer or a coating, pressed by a rigid surface.
    pub fn has_approach(&self) -> bool {
        let yields = |kind: &BodyKind| matches!(kind.key, "layer" | "coating");
        self.kind().is_some_and(yields) && self.against_modulus.is_none()
    }

    /// The body by the stiffness of its waves, with the other one if that is elastic.
    ///
    /// # Errors
    /// Errors of the body.
    pub(crate) fn body(&self) -> Result<Arc<dyn Body>> {
        let own = match self.kind() {
            Some(kind) => (kind.make)(self)?,
            None => Arc::new(HalfSpace::new(self.modulus)?),
        };
        self.in_series(own)
    }

    /// The body for the waves of a grid.
    ///
    /// # Errors
    /// Errors of the body.
    fn body_on(&self, grid: &Grid) -> Result<Arc<dyn Body>> {
        match &self.symbol {
            Some(symbol) => self.in_series(Arc::new(symbol.on(grid)?)),
            None => self.body(),
        }
    }

    /// A body with the other one, if that is elastic.
    fn in_series(&self, own: Arc<dyn Body>) -> Result<Arc<dyn Body>> {
        let Some(other) = self.against_modulus else { return Ok(own) };
        let other = HalfSpace::new(Error::positive("contact modulus of the other body", other)?)?;
        Ok(Arc::new(Series(own, other)))
    }

    /// The pressure E* h'rms, with E* of both bodies, the unit of a reduced pressure.
    ///
    /// # Errors
    /// The reason why a surface with absent nodes has none, and a remedy.
    pub(crate) fn full_pressure(&self, surface: &Surface) -> std::result::Result<f64, String> {
        match surface.absent_nodes() {
            0 => Ok(self.with_other(self.modulus) * surface.statistics().rms_slope),
            absent => Err(format!(
                "a reduced pressure is over the rms slope, but {absent} nodes are absent, which have no slope: give a \
                 pressure"
            )),
        }
    }
}
