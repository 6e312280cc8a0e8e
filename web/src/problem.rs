//! The contact problem of a page: what its keys pose on a surface, in either precision.

use asperity::contact::Original;
use asperity::{Grid, Surface};
use asperity_maps::{Topography, surface_with_absent};
use asperity_scene::outcome::Outcome;
use asperity_scene::quantity::LENGTH;
use asperity_scene::units::Units;
use asperity_scene::{
    AdhesionKeys, Boundary, Either, Given, Input, Key, LoadKeys, LoadsKeys, NestedKeys, PathKeys, Precision, Skin,
    SolverKeys, SurfaceKeys, Way, either, in_unit, without_files,
};
use ndarray::Array2;
use serde_json::{Map, Value};

use crate::given::reason;
use crate::state::State;

pub use crate::state::Observe;

/// The keys of a solve and of a cycle.
pub fn of_problem() -> impl Iterator<Item = &'static Key> {
    without_files::<(SurfaceKeys, AdhesionKeys, SolverKeys)>().chain(of_one_solve()).chain(without_files::<PathKeys>())
}

/// Those that pose no other problem.
fn of_one_solve() -> impl Iterator<Item = &'static Key> {
    without_files::<(LoadKeys, LoadsKeys, NestedKeys)>()
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
    /// The problem that keys pose on a map of a name: the problem `before`, if it is the same and solves continue from
    /// its last; or another problem, with solves that continue from there, or from `start`.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the surface, the law and the body.
    pub fn of(
        given: &Given,
        map: &Topography,
        name: &str,
        before: &mut Option<Self>,
        start: Option<Array2<f64>>,
        goes_on: bool,
    ) -> Outcome<Self> {
        let mut posed = given.typed();
        posed.retain(|name, _| of_one_solve().all(|key| key.name != name));
        if let Some(same) = before.take_if(|before| goes_on && before.posed == posed) {
            return Ok(same);
        }
        let before = before.as_ref().and_then(Self::gap).or(start);
        let (lengths, absent) = (given.lengths(map.heights.dim()), given.absent_missing());
        let (scene, si) = (given.scene()?, given.quantities().is_si());
        let units = if si { Units::si() } else { Units::of_map(map.unit.as_deref()) };
        scene.adhesion.check().and_then(|()| scene.elastic.check()).map_err(reason)?;
        scene.elastic.body()?;
        let (surface, converted_from) = surface(map, name, lengths, absent, si)?;
        let original = map.original.filter(|_| scene.elastic.boundary == Boundary::Periodic && !given.whole());
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
    pub fn solve(&mut self, given: &Given, from_last: bool, observe: Observe<'_>) -> Outcome<Value> {
        let (typed, quantities) = (given.typed(), given.quantities().given());
        let load = given.load().map_err(reason)?;
        let full = either!(state = &self.state => state.full_pressure(&[load]))?;
        let asked = given.asked(load, full).map_err(reason)?;
        let (answer, started) =
            either!(state = &mut self.state => state.solve(&asked, from_last, quantities, observe))?;
        self.asked = Some((typed, started));
        Ok(answer)
    }

    /// Begins a cycle along the loads that are given; tells the names of its columns.
    ///
    /// # Errors
    /// The key and the remedy.
    pub fn begin(&mut self, given: &Given) -> Outcome<Value> {
        let loads = given.loads().map_err(reason)?;
        let full = either!(state = &self.state => state.full_pressure(&loads))?;
        let way = Way::cycle(&loads, full, given.path())?;
        either!(state = &mut self.state => state.begin(way, given.quantities().given()))
    }

    /// The next state along the loads; nothing at their end.
    ///
    /// # Errors
    /// Errors of the solvers.
    pub fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        either!(state = &mut self.state => state.next(observe))
    }

    /// The limits of no range of the cycle at its end; nothing where no coarser grid tells them.
    ///
    /// # Errors
    /// Errors of the solvers.
    pub fn cycle_limit(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        either!(state = &mut self.state => state.cycle_limit(observe))
    }

    /// What the last solve was asked, and whether it started from another equilibrium, which decides on its own with
    /// adhesion.
    pub fn asked(&self) -> Option<(&Map<String, Value>, bool)> {
        self.asked.as_ref().map(|(typed, started)| (typed, *started))
    }

    /// The gap of the last solution on the whole grid.
    pub fn gap(&self) -> Option<Array2<f64>> {
        either!(state = &self.state => state.gap())
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

/// The surface of a map for a solve, in metres where numbers are in SI units, and the unit from which it was converted.
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
                "{name}: the numbers have units, but nothing says how large the map is: give lengths, such as 20um"
            )
            .into());
        }
        (None, None) => (1.0, 1.0),
    };
    let missing = map.missing();
    if missing > 0 && !absent {
        return Err(format!(
            "{name}: {missing} of {} heights are missing: fill them by the step fill, or treat them as absent nodes by \
             absent_missing",
            map.heights.len()
        )
        .into());
    }
    let grid = Grid::new(map.heights.dim(), sides)?;
    let make = if absent { surface_with_absent } else { Surface::new };
    Ok((make(grid, map.heights)?, from))
}
