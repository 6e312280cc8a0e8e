//! The engine: a map, the surface that is made of it, and the solves on that.

use asperity::Grid;
use asperity::contact::bulk_range;
use asperity_maps::io::{Reading, channels, check_memory, map_as_npz};
use asperity_maps::warning::Warning;
use asperity_maps::{Topography, knee_wavelength};
use asperity_scene::{
    Case, CutOffKeys, FormKeys, GridKeys, Keys, Log, NewLengthsKeys, Objects, Outcome, RoughnessKeys, Skin, StepKeys,
    Units, statistics,
};
use ndarray::Array2;
use serde_json::{Value, json};

use crate::entries::{read, reason};
use crate::lines::{Origin, Source};
use crate::problem::{KEYS, Observe, Problem};
use crate::state::{NOT_BEGUN, extremes, histogram};

/// A map, the surface that is made of it, and the solves on that.
#[derive(Default)]
pub struct Engine {
    /// The map as it was opened or made.
    map: Option<Topography>,
    /// The surface, if a step was taken.
    prepared: Option<Topography>,
    /// Where they come from.
    origin: Origin,
    /// The last problem, with its solutions.
    problem: Option<Problem>,
    /// The gap from which the first problem starts, of another engine.
    start: Option<Array2<f64>>,
}

impl Engine {
    /// The surface.
    ///
    /// # Errors
    /// The remedy, where there is none.
    pub fn surface(&self) -> Outcome<&Topography> {
        Ok(self.prepared.as_ref().or(self.map.as_ref()).ok_or("there is no surface yet: open a map, or make one")?)
    }

    /// The problem that was solved last.
    ///
    /// # Errors
    /// The remedy, where there is none.
    pub fn problem(&self) -> Outcome<&Problem> {
        Ok(self.problem.as_ref().ok_or("nothing is solved yet: solve first")?)
    }

    /// Reads a map, or tells the channels of a file of which one has to be chosen; `masked` points of a `.gwy` file are
    /// missing.
    ///
    /// # Errors
    /// As [`Reading::read_bytes`].
    pub fn open(&mut self, name: &str, bytes: &[u8], channel: Option<String>, masked: bool) -> Outcome<Value> {
        let mut reading = Reading::default();
        (reading.channel, reading.masked) = (channel.clone(), masked);
        let read = reading.read_bytes(name, bytes);
        // what has one map alone has nothing else
        let is_one = read.as_ref().is_ok_and(|map| map.unread.is_empty());
        let channels = if is_one { Vec::new() } else { channels(name, bytes)? };
        let told: Vec<_> = channels.iter().map(|found| format!("{}: {}", found.number, found.title)).collect();
        if read.is_err() && channel.is_none() && channels.len() > 1 {
            return Ok(json!({ "name": name, "channels": told, "heights": null }));
        }
        let map = read?;
        check_memory("a map", map.heights.dim(), 32)?;
        let chosen = [("channel", channel.map(Value::from)), ("masked", masked.then_some(true.into()))];
        let reading = chosen.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect();
        self.origin = Origin { source: Source::Opened { name: name.to_owned(), reading }, steps: None };
        let mut found = self.take(map, None);
        found["channels"] = told.into();
        Ok(found)
    }

    /// Makes a surface by the options of `asperity surface`.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the surface.
    pub fn make(&mut self, given: &str) -> Outcome<Value> {
        let given = read(given, &[FormKeys::KEYS, RoughnessKeys::KEYS, GridKeys::KEYS])?;
        let (typed, si) = (given.typed(), given.quantities().is_si());
        let shape = given.shape().map_err(reason)?;
        let sides = given.sides(shape, si).map_err(reason)?;
        let (body, roughness): (FormKeys, RoughnessKeys) = (given.keys(), given.keys());
        body.check().map_err(reason)?;
        let rough = roughness.self_affine();
        if rough.is_none() && (roughness.rms_height.is_some() || body.form == Default::default()) {
            return Err("roughness: give rms_height or rms_slope, one of the two".into());
        }
        check_memory("a surface", shape, if rough.is_some() { 40 } else { 24 })?;
        let grid = Grid::new(shape, sides)?;
        let surface = body.surface(grid, rough.map(|rough| rough.surface(grid)).transpose()?)?;
        let mut map = Topography::from(surface);
        map.unit = si.then(|| "m".to_owned());
        map.seed = rough.map(|rough| rough.seed);
        self.origin = Origin { source: Source::Made(typed), steps: None };
        Ok(self.take(map, None))
    }

    /// Makes the surface of the map by the steps of `asperity prepare`; without any it is the map.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the steps; then the surface stays as it was.
    pub fn prepare(&mut self, given: &str) -> Outcome<Value> {
        let given = read(given, &[StepKeys::KEYS, NewLengthsKeys::KEYS, CutOffKeys::KEYS])?;
        let map = self.map.as_ref().ok_or("there is no map yet: open or make one")?;
        let typed = given.typed();
        let steps = given.steps(map.heights.dim(), given.quantities().is_si(), map.unit.as_deref()).map_err(reason)?;
        // a step has the map before and after it
        check_memory("a step of preparation", map.heights.dim(), 32)?;
        let mut log = Log::default();
        let prepared = steps.run(map.clone(), &mut log)?;
        self.origin.steps = (!typed.is_empty()).then_some(typed);
        self.problem = None;
        self.prepared = self.origin.steps.is_some().then_some(prepared);
        Ok(self.describe_surface(Some(log)))
    }

    /// Takes a map as the surface.
    fn take(&mut self, map: Topography, log: Option<Log>) -> Value {
        (self.map, self.prepared, self.problem) = (Some(map), None, None);
        self.describe_surface(log)
    }

    /// The surface in figures.
    fn describe_surface(&self, log: Option<Log>) -> Value {
        let Ok(map) = self.surface() else { return Value::Null };
        let of_map = || {
            let units = Units::of_map(map.unit.as_deref());
            Warning::of_topography(map).iter().map(|warning| units.describe(warning)).collect()
        };
        let lines = log.as_ref().map(|log| log.lines.clone());
        let warnings = log.map_or_else(of_map, |log| log.warnings);
        let (low, high) = extremes(map.heights.iter().copied());
        json!({
            "name": self.origin.name(),
            "shape": map.heights.dim(),
            "lengths": map.lengths,
            "unit": map.unit,
            "original": map.original,
            "missing": map.missing(),
            "unread": map.unread,
            "channels": [],
            "mean": map.mean(),
            "lowest": low,
            "highest": high,
            "limits": bulk_range(map.heights.iter().copied()).unwrap_or_default(),
            "warnings": warnings,
            "log": lines,
        })
    }

    /// The heights of the surface about their mean.
    ///
    /// # Errors
    /// As [`Engine::surface`].
    pub fn heights(&self) -> Outcome<Vec<f32>> {
        let map = self.surface()?;
        let mean = map.mean();
        Ok(map.heights.iter().map(|height| (height - mean) as f32).collect())
    }

    /// The statistics of the surface, its spectrum, and the histogram of its heights.
    ///
    /// # Errors
    /// As [`Topography::statistics`].
    pub fn statistics(&self) -> Outcome<Value> {
        let map = self.surface()?;
        check_memory("the statistics of a map", map.heights.dim(), 40)?;
        let histogram = histogram(map.heights.iter().copied(), 60, map.unit.as_deref());
        let surface = map.lengths.filter(|_| map.missing() == 0).map(|_| map.clone().surface()).transpose()?;
        let found = match &surface {
            Some(surface) => Some((surface.statistics(), knee_wavelength(surface))),
            None if map.missing() == 0 => Some((map.statistics()?, None)),
            None => None,
        };
        let spectrum = surface.map(|surface| {
            let psd = surface.spectrum().radial_psd();
            json!({ "wave_numbers": psd.wave_numbers, "densities": psd.densities })
        });
        let name = self.origin.name();
        Ok(json!({
            "figures": found.as_ref().map(|found| statistics::figures(map, found, name.as_ref())),
            "rows": found.map(|found| statistics::rows(map, &found, Skin::Keywords)),
            "spectrum": spectrum,
            "histogram": histogram,
        }))
    }

    /// Solves under a load.
    ///
    /// # Errors
    /// The key and the remedy, and errors of the solvers.
    pub fn solve(&mut self, given: &str, from_last: bool, observe: Observe<'_>) -> Outcome<Value> {
        let case = case(given)?;
        self.pose(&case, from_last)?.solve(&case, from_last, observe)
    }

    /// The gap of the last solution, for [`Engine::start_from`] of another engine with the same surface.
    ///
    /// # Errors
    /// As [`Engine::problem`].
    pub fn gap(&self) -> Outcome<Vec<f64>> {
        Ok(self.problem()?.gap().ok_or("nothing is solved yet: solve first")?.into_iter().collect())
    }

    /// Starts the first solve from a gap.
    ///
    /// # Errors
    /// Without a surface of as many nodes.
    pub fn start_from(&mut self, gap: Vec<f64>) -> Outcome<()> {
        self.start = Some(Array2::from_shape_vec(self.surface()?.heights.dim(), gap)?);
        Ok(())
    }

    /// Begins a cycle along loads.
    ///
    /// # Errors
    /// The key and the remedy.
    pub fn begin(&mut self, given: &str) -> Outcome<Value> {
        let case = case(given)?;
        self.pose(&case, false)?.begin(&case)
    }

    /// The problem that keys pose; the one before stays where they are refused.
    fn pose(&mut self, case: &Case, goes_on: bool) -> Outcome<&mut Problem> {
        let mut before = self.problem.take();
        let start = self.start.take();
        let problem = Problem::new(case, self.surface()?, self.origin.name(), &mut before, start, goes_on);
        self.problem = before;
        Ok(self.problem.insert(problem?))
    }

    /// The next state along the loads; nothing at their end.
    ///
    /// # Errors
    /// Errors of the solvers.
    pub fn next(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        self.problem.as_mut().ok_or(NOT_BEGUN)?.next(observe)
    }

    /// The limits of no range of the cycle at its end; nothing where no coarser grid tells them.
    ///
    /// # Errors
    /// Errors of the solvers.
    pub fn cycle_limit(&mut self, observe: Observe<'_>) -> Outcome<Option<Value>> {
        self.problem.as_mut().map_or(Ok(None), |problem| problem.cycle_limit(observe))
    }

    /// The bytes of a file to take away.
    ///
    /// # Errors
    /// The name, if there is no such file, and errors of the file.
    pub fn file(&self, name: &str) -> Outcome<Vec<u8>> {
        match name {
            "heights.npz" => Ok(map_as_npz(self.surface()?)?),
            name => self.problem()?.file(name),
        }
    }

    /// The lines that give the same answer in a shell and in Python.
    ///
    /// # Errors
    /// As [`Engine::problem`].
    pub fn lines(&self) -> Outcome<Value> {
        let (typed, started) = self.problem()?.request().ok_or("nothing is solved yet: solve first")?;
        Ok(json!({
            "shell": self.origin.shell(typed, started),
            "python": self.origin.python(typed, started),
        }))
    }
}

/// The case of the keys of a solve or a cycle.
fn case(given: &str) -> Outcome<Case> {
    let given = read(given, &KEYS)?;
    let quantities = given.quantities();
    Case::new(given, quantities, Objects::default(), Skin::Keywords)
}
