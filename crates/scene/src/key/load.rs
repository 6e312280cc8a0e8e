//! The loads of a run, as options and keywords say them.

use asperity::{Control, Held};

use crate::key::{Boundary, Entries, FORCE, FORCE_PER_LENGTH, Kind, LENGTH, PRESSURE, Range, keys};

keys! {
    /// The load of a solve, one of these.
    LoadKeys {
        "Load" {
            /// Mean gap, with a periodic boundary
            mean_gap: Option<f64> = Kind::quantity(LENGTH, Range::NON_NEGATIVE, &["G"]),
            /// Mean external pressure over the area of the map, compression positive
            mean_pressure: Option<f64> = Kind::quantity(PRESSURE, Range::FINITE, &["P"]),
            /// Normal force, compression positive: the mean pressure times the area of the map
            normal_force: Option<f64> = Kind::quantity(FORCE, Range::FINITE, &["F"]),
            /// Approach, with a free boundary or over a layer or a coating: the way of the bodies towards each other
            /// since first touch without deformation; negative before it
            approach: Option<f64> = Kind::quantity(LENGTH, Range::FINITE, &["D"]),
            /// Stiffness of a spring in series, such as a cantilever; needs {spring_position}
            spring_stiffness: Option<f64> =
                Kind::quantity(FORCE_PER_LENGTH, Range::POSITIVE, &["K"]).needs(&["spring_position"]),
            /// Position Z of the spring's far end, at which the spring is relaxed: with a free boundary an approach, F =
            /// K (Z - D); with a periodic one a mean gap, F = K (G - Z)
            spring_position: Option<f64> = Kind::quantity(LENGTH, Range::FINITE, &["Z"]).needs(&["spring_stiffness"]),
            /// Mean pressure over the contact modulus and the rms slope of the surface: p/(E* h'rms)
            reduced_pressure: Option<f64> = Kind::number(Range::FINITE, &["R"]),
            /// Share of the nodes in contact to search for, to one node or 1 %, by a mean pressure; with adhesion by a
            /// mean gap, or with a free boundary by an approach. If the contact jumps past the share, the nearer side
            /// of the jump is written, and the exit code is 2
            contact_fraction: Option<f64> = Kind::number(Range::SHARE, &["A"]).excludes(&["accuracy", "nested"]),
        }
    }
}

keys! {
    /// The loads of a table, a list of one kind.
    LoadsKeys {
        "Loads" {
            /// Mean gaps, with a periodic boundary: numbers and ranges FROM:TO:COUNT or FROM:TO:COUNT:log, separated by
            /// commas
            mean_gaps: Vec<f64> = Kind::quantities(LENGTH, Range::NON_NEGATIVE),
            /// Mean external pressures over the area of the map, compression positive: a list like {mean_gaps}
            mean_pressures: Vec<f64> = Kind::quantities(PRESSURE, Range::FINITE),
            /// Normal forces, compression positive: a list like {mean_gaps}
            normal_forces: Vec<f64> = Kind::quantities(FORCE, Range::FINITE),
            /// Approaches since first touch without deformation, with a free boundary or over a layer or a coating: a
            /// list like {mean_gaps}. A list that grows from a negative value begins with the bodies apart
            approaches: Vec<f64> = Kind::quantities(LENGTH, Range::FINITE),
            /// Stiffness of a spring in series, such as a cantilever; needs {spring_positions}
            spring_stiffness: Option<f64> =
                Kind::quantity(FORCE_PER_LENGTH, Range::POSITIVE, &["K"]).needs(&["spring_positions"]),
            /// Positions Z of the spring's far end, at which the spring is relaxed: a list like {mean_gaps}. With a free
            /// boundary positions are approaches, F = K (Z - D), and a list that grows from a negative value begins
            /// with the bodies apart; with a periodic one they are mean gaps, F = K (G - Z)
            spring_positions: Vec<f64> = Kind::quantities(LENGTH, Range::FINITE).needs(&["spring_stiffness"]),
            /// Mean pressures over the contact modulus and the rms slope of the surface, p/(E* h'rms): a list like
            /// {mean_gaps}
            reduced_pressures: Vec<f64> = Kind::numbers(Range::FINITE),
        }
    }
}

keys! {
    /// The contact fractions of a table.
    FractionsKeys {
        "Loads" {
            /// Shares of the nodes in contact to search for, as by asperity solve --contact-fraction: a list like
            /// {mean_gaps}. The table has two more columns, wanted_contact_fraction and reached
            contact_fractions: Vec<f64> = Kind::numbers(Range::SHARE),
        }
    }
}

/// A kind of load.
struct LoadKind {
    /// The key of one load.
    one: &'static str,
    /// The key of a list of them.
    many: &'static str,
    /// The number of one load, if it is given.
    given: fn(&LoadKeys) -> Option<f64>,
    /// The numbers of a list of them.
    listed: fn(LoadsKeys, FractionsKeys) -> Vec<f64>,
    /// The load of its number, and of the stiffness of a spring.
    make: fn(f64, f64) -> Load,
}

/// A kind of load by its keys: the key of one load, and of a list in `LoadsKeys` or in another list.
macro_rules! kind {
    ($one:ident, $many:ident, $make:expr) => {
        kind!($one, $many, |keys, _| keys.$many, $make)
    };
    ($one:ident, $many:ident, $listed:expr, $make:expr) => {
        LoadKind {
            one: stringify!($one),
            many: stringify!($many),
            given: |keys| keys.$one,
            listed: $listed,
            make: $make,
        }
    };
}

/// The kinds of loads.
static KINDS: [LoadKind; 7] = [
    kind!(mean_gap, mean_gaps, |gap, _| Load::Held(Control::MeanGap(gap))),
    kind!(mean_pressure, mean_pressures, |pressure, _| Load::Held(Control::MeanPressure(pressure))),
    kind!(normal_force, normal_forces, |force, _| Load::Held(Control::Force(force))),
    kind!(approach, approaches, |approach, _| Load::Held(Control::Approach(approach))),
    kind!(spring_position, spring_positions, |rest, stiffness| Load::Held(Control::Spring { stiffness, rest })),
    kind!(reduced_pressure, reduced_pressures, |ratio, _| Load::Reduced(ratio)),
    kind!(contact_fraction, contact_fractions, |_, keys| keys.contact_fractions, |share, _| Load::Fraction(share)),
];

impl Entries {
    /// The load of a solve.
    ///
    /// # Errors
    /// The remedy where none is given, or several are, for [`worded`](crate::worded).
    pub fn load(&self) -> Result<Load, String> {
        let keys: LoadKeys = self.keys();
        let found = loads_by(keys.spring_stiffness, |kind| kind.one, |kind| (kind.given)(&keys).into_iter().collect())?;
        match found[..] {
            [load] => Ok(load),
            [] => {
                let keys: Vec<_> = KINDS.iter().map(|kind| format!("{{{}}}", kind.one)).collect();
                Err(format!("there is no load: give one of {}", keys.join(", ")))
            }
            _ => Err("there are several loads: give one".to_owned()),
        }
    }

    /// The loads of a table, of one kind.
    ///
    /// # Errors
    /// As of [`Entries::load`].
    pub fn loads(&self) -> Result<Vec<Load>, String> {
        let (keys, fractions): (LoadsKeys, FractionsKeys) = (self.keys(), self.keys());
        let numbers = |kind: &LoadKind| (kind.listed)(keys.clone(), fractions.clone());
        let found = loads_by(keys.spring_stiffness, |kind| kind.many, numbers)?;
        if found.is_empty() {
            return Err("there are no loads: give a list, such as {mean_pressures}".to_owned());
        }
        Ok(found)
    }

    /// The stiffness of the spring, if there is one.
    pub fn spring_stiffness(&self) -> Option<f64> {
        self.keys::<LoadsKeys>().spring_stiffness
    }
}

/// The loads of one kind, by the numbers that are given for each, and the stiffness of a spring.
fn loads_by(
    stiffness: Option<f64>,
    key: fn(&LoadKind) -> &'static str,
    numbers: impl Fn(&LoadKind) -> Vec<f64>,
) -> Result<Vec<Load>, String> {
    let all = KINDS.iter().map(|kind| (kind, numbers(kind))).filter(|(_, numbers)| !numbers.is_empty());
    let all: Vec<_> = all.collect();
    let spring = |kind: &LoadKind| kind.one == "spring_position";
    if all.len() < 2 && stiffness.is_some() != all.iter().any(|(kind, _)| spring(kind)) {
        let position = KINDS.iter().find(|kind| spring(kind)).map(key).unwrap_or_default();
        return Err(format!(
            "a spring has a stiffness and a position: give both, {{spring_stiffness}} and {{{position}}}"
        ));
    }
    if all.len() > 1 {
        return Err("there are several loads: give loads of one kind".to_owned());
    }
    let load = |kind: &LoadKind, number| (kind.make)(number, stiffness.unwrap_or(f64::NAN));
    Ok(all.into_iter().flat_map(|(kind, numbers)| numbers.into_iter().map(move |number| load(kind, number))).collect())
}

/// The load of a solve: one that is held, or one that is to be found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A load that is held.
    Held(Control),
    /// A mean pressure over E* h'rms.
    Reduced(f64),
    /// A contact fraction, for which a load is searched.
    Fraction(f64),
}

impl Load {
    /// The keys of one load, the stiffness for a spring.
    pub fn one() -> impl Iterator<Item = &'static str> {
        KINDS.iter().map(|kind| if kind.one == "spring_position" { "spring_stiffness" } else { kind.one })
    }

    /// The key of one load, by the key of a list of loads.
    pub fn one_of(many: &str) -> Option<&'static str> {
        KINDS.iter().find(|kind| kind.many == many).map(|kind| kind.one)
    }

    /// The key of one load, by the name of its control.
    pub(crate) fn key_of(control: &str) -> Option<&'static str> {
        let makes = |kind: &&LoadKind| matches!((kind.make)(0.0, 1.0), Load::Held(made) if made.name() == control);
        KINDS.iter().find(makes).map(|kind| kind.one)
    }

    /// The keys of a list of loads that are held.
    pub fn many() -> impl Iterator<Item = &'static str> {
        let held = KINDS.iter().filter(|kind| kind.one != "contact_fraction");
        held.map(|kind| if kind.one == "spring_position" { "spring_stiffness" } else { kind.many })
    }

    /// The load that is held where a reduced pressure of 1 is the `full` pressure; of no meaning for a contact
    /// fraction.
    pub fn control(self, full: f64) -> Control {
        match self {
            Self::Held(control) => control,
            Self::Reduced(ratio) => Control::MeanPressure(full * ratio),
            Self::Fraction(_) => Control::MeanPressure(0.0),
        }
    }

    /// The contact fraction, if it is one.
    pub fn fraction(self) -> Option<f64> {
        if let Self::Fraction(fraction) = self { Some(fraction) } else { None }
    }

    /// Refuses a load that a boundary does not have, or a periodic body that yields to its base or not, and a tension
    /// between surfaces that do not adhere.
    ///
    /// # Errors
    /// The reason and the remedy, for [`worded`](crate::worded).
    pub fn check(self, boundary: Boundary, yields: bool, adheres: bool) -> Result<(), String> {
        let control = match self {
            Self::Held(control) => control,
            Self::Reduced(pressure) => Control::MeanPressure(pressure),
            Self::Fraction(_) => return Ok(()),
        };
        let reason = match (boundary, control.holds()) {
            (Boundary::Periodic, Held::Approach) if !yields => {
                "an approach needs {boundary=free}, or a {layer} or a {coating}: in a periodic cell other bodies have \
                 none, give a mean gap, a pressure or a force"
            }
            (Boundary::Free, Held::MeanGap) => {
                "a mean gap needs {boundary=periodic}: a free half-space has none to be held, give an approach, a \
                 force, a pressure or a spring"
            }
            (_, Held::Load) if control.value() < 0.0 && !adheres => {
                "a negative load pulls, and nothing holds surfaces without adhesion together: press them, or give a {law}"
            }
            _ => return Ok(()),
        };
        Err(reason.to_owned())
    }
}
