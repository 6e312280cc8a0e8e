//! The contact problem of a page: what its keys pose on a surface, in either precision.

use asperity_maps::Topography;
use asperity_scene::{
    AdhesionKeys, AnySession, Case, Either, Key, Keys, LoadKeys, LoadsKeys, Map, Maps, NestedKeys, Outcome, PathKeys,
    Processes, SolverKeys, SurfaceKeys, either,
};
use ndarray::Array2;
use serde_json::{Map as KeyValues, Value};

use crate::state::State;

pub use crate::state::Observe;

/// The keys of a solve and of a cycle.
pub const KEYS: [&[Key]; 7] =
    [SurfaceKeys::KEYS, AdhesionKeys::KEYS, SolverKeys::KEYS, OF_LOADS[0], OF_LOADS[1], OF_LOADS[2], PathKeys::KEYS];

/// The keys that pose no other problem.
const OF_LOADS: [&[Key]; 3] = [LoadKeys::KEYS, LoadsKeys::KEYS, NestedKeys::KEYS];

/// A contact problem on a surface, with its solutions.
pub struct Problem {
    /// What poses it, as it was typed.
    posed: KeyValues<String, Value>,
    state: Either<State<f32>, State<f64>>,
    /// What the last solve was asked, as it was typed, and whether it started from another solution.
    asked: Option<(KeyValues<String, Value>, bool)>,
}

impl Problem {
    /// The problem that keys pose on a map of a name: the problem `before`, if it is the same and solves continue from
    /// its last; or another problem, with solves that continue from there, or from `start`.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the surface, the law and the body.
    pub fn new(
        case: &Case,
        map: &Topography,
        name: &str,
        before: &mut Option<Self>,
        start: Option<Array2<f64>>,
        goes_on: bool,
    ) -> Outcome<Self> {
        let mut keys = case.given().typed();
        keys.retain(|name, _| OF_LOADS.into_iter().flatten().all(|key| key.name != name));
        if let Some(same) = before.take_if(|before| goes_on && before.posed == keys) {
            return Ok(same);
        }
        let before = before.as_ref().and_then(Self::gap).or(start);
        let processes = Processes::start()?;
        let posed = case.on(Maps::new(Map::whole(Some(name.to_owned()), map.clone())), 1, &processes)?;
        let (surface, part) = (posed.surface.clone(), posed.part);
        let state = match AnySession::new(posed, &processes)? {
            Either::F32(session) => Either::F32(State::new(session, surface, part, before)),
            Either::F64(session) => Either::F64(State::new(session, surface, part, before)),
        };
        Ok(Self { posed: keys, state, asked: None })
    }

    /// Solves under the load that is given.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the solvers.
    pub fn solve(&mut self, case: &Case, from_last: bool, observe: Observe<'_>) -> Outcome<Value> {
        let (answer, started) = either!(state = &mut self.state => state.solve(case, from_last, observe))?;
        self.asked = Some((case.given().typed(), started));
        Ok(answer)
    }

    /// Begins a cycle along the loads that are given; tells the names of its columns.
    ///
    /// # Errors
    /// The key and the remedy.
    pub fn begin(&mut self, case: &Case) -> Outcome<Value> {
        either!(state = &mut self.state => state.begin(case))
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
    pub fn request(&self) -> Option<(&KeyValues<String, Value>, bool)> {
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
