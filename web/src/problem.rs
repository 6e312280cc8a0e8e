//! The contact problem of a page: what its keys pose on a surface, in either precision.

use asperity::contact::Original;
use asperity::path::PathSettings;
use asperity::{Control, Grid, Surface};
use asperity_maps::{Topography, surface_with_absent};
use asperity_scene::outcome::Outcome;
use asperity_scene::quantity::{LENGTH, PRESSURE};
use asperity_scene::units::Units;
use asperity_scene::{Asked, Boundary, Branches, Either, Input, Load, Precision, Scene, Skin, Way, either, in_unit};
use serde_json::{Map, Value};

use crate::given::{Given, reason};
use crate::state::State;

pub use crate::state::Observe;

/// The keys of a scene.
const SCENE: [&str; 22] = [
    "modulus",
    "boundary",
    "layer",
    "poisson",
    "base",
    "coating",
    "coating_modulus",
    "coating_poisson",
    "law",
    "work_of_adhesion",
    "range",
    "exponent",
    "hamaker",
    "cut_off",
    "wall",
    "wall_stiffness",
    "hardness",
    "method",
    "precision",
    "tolerance",
    "max_iterations",
    "branch",
];
/// Those of a load, and of loads.
const LOADS: [&str; 14] = [
    "mean_pressure",
    "mean_gap",
    "normal_force",
    "approach",
    "spring_stiffness",
    "spring_position",
    "reduced_pressure",
    "contact_fraction",
    "mean_pressures",
    "mean_gaps",
    "normal_forces",
    "approaches",
    "spring_positions",
    "reduced_pressures",
];
/// Those of a solve and of a cycle.
const OTHERS: [&str; 7] = ["absent_missing", "lengths", "nested", "steps", "smallest_step", "imbalance", "sharp"];

/// The keys of a solve and of a cycle.
pub fn keys() -> Vec<&'static str> {
    [&SCENE[..], &LOADS, &OTHERS].concat()
}

/// A contact problem on a surface, with its solutions.
pub struct Problem {
    /// What poses it, as it was typed.
    posed: Map<String, Value>,
    state: Either<State<f32>, State<f64>>,
    /// What the last solve was asked, as it was typed, and whether it started from another solution.
    asked: Option<(Map<String, Value>, bool)>,
}

impl Problem {
    /// The problem that keys pose on a map of a name: that of `before`, if it is the same one and solves go on from its
    /// last; or another one, whose solves go on from there.
    ///
    /// # Errors
    /// The key and the remedy, and those of the surface, the law and the body.
    pub fn of(given: &Given, map: &Topography, name: &str, before: &mut Option<Self>, goes_on: bool) -> Outcome<Self> {
        let alone = |key: &&String| !LOADS.contains(&key.as_str()) && *key != "nested";
        let posed: Map<_, _> = given
            .typed()
            .iter()
            .filter(|(key, _)| alone(key))
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect();
        if let Some(same) = before.take_if(|before| goes_on && before.posed == posed) {
            return Ok(same);
        }
        let before = before.as_ref().and_then(|before| either!(state = &before.state => state.gap()));
        let mut given = given.clone();
        let (lengths, absent) = (given.lengths(map.heights.dim()), given.switch("absent_missing"));
        let scene: Scene = given.take(&SCENE, Value::Null)?;
        let units = Units {
            length: if given.is_si() { Some(LENGTH.si.to_owned()) } else { map.unit.clone() },
            pressure: given.is_si().then(|| PRESSURE.si.to_owned()),
            force: None,
        };
        if given.is_si() && !posed.contains_key("modulus") {
            return Err(
                "modulus is 1 by default, without a unit, but other numbers have units: give it, as 70GPa".into()
            );
        }
        scene.adhesion.check(str::to_owned)?;
        scene.elastic.check().map_err(reason)?;
        scene.elastic.body()?;
        let (surface, converted_from) = surface(map, name, lengths, absent, given.is_si())?;
        let original = map.original.filter(|_| scene.elastic.boundary == Boundary::Periodic);
        let original = original.map(|nodes| Original::new(surface.grid(), nodes)).transpose()?;
        let shown = original.map_or(*surface.grid(), |original| *original.grid());
        let mut inputs = scene.inputs(shown.shape(), shown.lengths(), 1);
        inputs.heights = Some(name.to_owned());
        inputs.part = map.original.map(|_| if original.is_some() { "original" } else { "whole" }.to_owned());
        (inputs.length_unit, inputs.pressure_unit) = (units.length.clone(), units.pressure.clone());
        let input = Input {
            surface: surface.into(),
            formula: scene.adhesion.formula(None)?,
            hardness: None,
            original,
            converted_from,
            scars_removed: map.scars_removed,
            is_strict: false,
            skin: Skin::Keywords,
        };
        let state = match scene.precision {
            Precision::F32 => Either::F32(State::new(&scene, input, inputs, units, before)?),
            Precision::F64 => Either::F64(State::new(&scene, input, inputs, units, before)?),
        };
        Ok(Self { posed, state, asked: None })
    }

    /// Solves under the load that is given.
    ///
    /// # Errors
    /// The key and the remedy, and those of the solvers.
    pub fn solve(&mut self, mut given: Given, from_last: bool, observe: Observe<'_>) -> Outcome<Value> {
        let (typed, quantities) = (given.typed().clone(), given.quantities());
        let nested = given.has("nested").then(|| given.switch("nested"));
        let load = load(&mut given)?;
        let full = either!(state = &self.state => state.full_pressure(&[load]))?;
        let scene = either!(state = &self.state => state.scene());
        let adheres = scene.adhesion.adheres();
        let asked = Asked {
            fraction: load.fraction(),
            nested,
            other_branch: scene.branch == Some(Branches::Both),
            ..Asked::under(load.control(full))
        };
        let (answer, started) =
            either!(state = &mut self.state => state.solve(&asked, from_last, quantities, observe))?;
        self.asked = Some((typed, started && adheres));
        Ok(answer)
    }

    /// Begins a cycle along the loads that are given; tells the names of its columns.
    ///
    /// # Errors
    /// The key and the remedy.
    pub fn begin(&mut self, mut given: Given) -> Outcome<Value> {
        let quantities = given.quantities();
        let loads = loads(&mut given)?;
        let usual = PathSettings::default();
        let settings = usual
            .steps(given.number("steps").map_or(usual.steps, |steps| steps as usize))
            .smallest_step(given.number("smallest_step").unwrap_or(usual.smallest_step))
            .imbalance(given.number("imbalance").unwrap_or(usual.imbalance))
            .smooth(!given.switch("sharp"));
        let full = either!(state = &self.state => state.full_pressure(&loads))?;
        let controls: Vec<Control> = loads.iter().map(|load| load.control(full)).collect();
        if controls.len() < 2 {
            return Err("a cycle needs two turning points at least: give more loads, with commas between".into());
        }
        either!(state = &mut self.state => state.begin(Way::Cycle(controls, settings), quantities))
    }

    /// The next state along the loads; nothing at their end.
    ///
    /// # Errors
    /// Those of the solvers.
    pub fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        either!(state = &mut self.state => state.next(observe))
    }

    /// What the last solve was asked, and whether it started from another equilibrium, which decides on its own with
    /// adhesion.
    pub fn asked(&self) -> Option<(&Map<String, Value>, bool)> {
        self.asked.as_ref().map(|(typed, started)| (typed, *started))
    }

    /// A field of the last solution.
    ///
    /// # Errors
    /// The name, if there is no such field.
    pub fn field(&self, name: &str) -> Outcome<Vec<f32>> {
        either!(state = &self.state => state.field(name))
    }

    /// The nodes of the last solution: 0 apart, 1 in contact, 2 absent, 3 attractive, 4 yielded.
    ///
    /// # Errors
    /// Without a solution.
    pub fn regions(&self) -> Outcome<Vec<u8>> {
        either!(state = &self.state => state.regions())
    }

    /// The histograms of gap and contact pressure, with as many bins.
    ///
    /// # Errors
    /// Without a solution.
    pub fn histograms(&self, bins: usize) -> Outcome<Value> {
        either!(state = &self.state => state.histograms(bins))
    }

    /// The bytes of a file to take away.
    ///
    /// # Errors
    /// The name, if there is no such file.
    pub fn file(&self, name: &str) -> Outcome<Vec<u8>> {
        match (name, &self.asked) {
            ("scene.toml", Some((typed, started))) => Ok(crate::lines::scene(typed, *started).into_bytes()),
            _ => either!(state = &self.state => state.file(name)),
        }
    }
}

/// The load that is given.
fn load(given: &mut Given) -> Outcome<Load> {
    let keys = ["mean_pressure", "mean_gap", "normal_force", "approach", "reduced_pressure", "contact_fraction"];
    let mut found = Vec::new();
    for key in keys {
        found.extend(given.number(key).and_then(|number| Load::of(key, &[number])));
    }
    let spring = [given.number("spring_stiffness"), given.number("spring_position")];
    match spring {
        [Some(stiffness), Some(position)] => found.extend(Load::of("spring", &[stiffness, position])),
        [None, None] => {}
        _ => {
            return Err(
                "a spring has a stiffness and a position: give both, spring_stiffness and spring_position".into()
            );
        }
    }
    match found[..] {
        [load] => Ok(load),
        [] => Err(format!("there is no load: give one of {} or a spring", keys.join(", ")).into()),
        _ => Err("there are several loads: give one".into()),
    }
}

/// The loads that are given, of one kind.
fn loads(given: &mut Given) -> Outcome<Vec<Load>> {
    let kinds = [
        ("mean_pressures", "mean_pressure"),
        ("mean_gaps", "mean_gap"),
        ("normal_forces", "normal_force"),
        ("approaches", "approach"),
        ("reduced_pressures", "reduced_pressure"),
    ];
    let mut found = Vec::new();
    for (list, one) in kinds {
        let loads = given.numbers(list);
        found.extend(loads.map(|loads| loads.iter().filter_map(|load| Load::of(one, &[*load])).collect::<Vec<_>>()));
    }
    if let Some(positions) = given.numbers("spring_positions") {
        let stiffness = given.number("spring_stiffness").ok_or("spring_positions needs spring_stiffness: give both")?;
        found.push(positions.iter().filter_map(|position| Load::of("spring", &[stiffness, *position])).collect());
    }
    match found.pop() {
        Some(loads) if found.is_empty() => Ok(loads),
        Some(_) => Err("there are several lists of loads: give one".into()),
        None => Err("there are no loads: give a list, as mean_pressures".into()),
    }
}

/// The surface of a map for a solve, in metres where numbers are in the SI, and the unit from which it was converted.
fn surface(
    map: &Topography,
    name: &str,
    lengths: Option<(f64, f64)>,
    absent: bool,
    si: bool,
) -> Outcome<(Surface, Option<String>)> {
    let from = map.unit.clone().filter(|unit| si && unit != LENGTH.si);
    let mut map = map.clone();
    if si {
        map = in_unit(map, LENGTH.si).map_err(|text| format!("{name} {}", reason(text)))?;
    }
    let sides = match (lengths, map.lengths) {
        (Some(given), None) => given,
        (Some(_), Some(_)) => {
            return Err(
                format!("{name} has side lengths: leave lengths out, or change them by a step of preparation").into()
            );
        }
        (None, Some(known)) => known,
        (None, None) if si => {
            return Err(format!(
                "{name}: the numbers have units, but nothing says how large the map is: give lengths, as 20um"
            )
            .into());
        }
        (None, None) => (1.0, 1.0),
    };
    let missing = map.missing();
    if missing > 0 && !absent {
        return Err(format!(
            "{name}: {missing} of {} heights are missing: fill them by the step fill, or take them for absent nodes by \
             absent_missing",
            map.heights.len()
        )
        .into());
    }
    let grid = Grid::new(map.heights.dim(), sides)?;
    let make = if absent { surface_with_absent } else { Surface::new };
    Ok((make(grid, map.heights)?, from))
}
