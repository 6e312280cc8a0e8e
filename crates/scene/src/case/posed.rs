//! A case on its maps.

use std::sync::Arc;

use asperity::adhesion::Formula;
use asperity::{Error, Grid, Surface};
use asperity_maps::warning::{Warning, WarningCode};
use asperity_maps::{Topography, surface_with_absent};
use ndarray::Array2;

use super::{Case, Map, Maps, Part, complete, sided};
use crate::account::Inputs;
use crate::key::{Boundary, Scene, Skin, Units, between, worded};
use crate::outcome::Outcome;
use crate::processes::Processes;

/// A case on its maps: the problem of a session.
pub struct Posed {
    /// The surface; of several processes each has its rows.
    pub surface: Arc<Surface>,
    /// The part of the surface that results are of.
    pub part: Part,
    /// The units of the numbers, as far as they are known.
    pub units: Units,
    /// The inputs of its reports.
    pub inputs: Inputs,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    pub(crate) scene: Scene,
    pub(crate) skin: Skin,
    pub(crate) formula: Formula,
    pub(crate) hardness: Option<Array2<f64>>,
    /// The unit of the heights, if they were converted from it.
    pub(crate) converted_from: Option<String>,
    /// The threshold of the scars that were removed from the heights.
    pub(crate) scars_removed: Option<f64>,
    /// What is doubtful about the maps themselves.
    pub(crate) doubts: Vec<Warning>,
}

impl Case {
    /// The case on its maps, on a number of threads. All processes have to ask.
    ///
    /// # Errors
    /// The key or the map and the remedy: for side lengths that contradict the heights or are unknown where numbers have
    /// units, missing points, a second surface that does not fit, a law and a hardness that are refused.
    pub fn on(&self, maps: Maps, threads: usize, processes: &Processes) -> Outcome<Posed> {
        let Self { given, scene, skin, .. } = self;
        let (skin, si, boundary) = (*skin, self.quantities.is_si(), scene.elastic.boundary);
        let Maps { heights, against, facing, hardness, works, table } = maps;
        let facing = facing.or_else(|| against.as_ref().map(|other| other.name.clone().unwrap_or("array".to_owned())));
        if facing.is_none() && given.shift().is_some() {
            let text = "{shift} is given, but there is no surface on the other side: give {against}, or leave it out";
            return Err(worded(text, skin).into());
        }
        let converted_from = heights.converted_from(si);
        let map = processes.agree(sided(heights, given, si, skin).map_err(Into::into))?;
        let doubts = doubts(&map.topography, against.as_ref().map(|other| &other.topography), boundary);
        let (source, shape) = (map.name.clone(), map.shape);
        let &Topography { lengths, original, seed, scars_removed, .. } = &map.topography;
        let unit = map.topography.unit.clone();
        let grid = processes.agree(Grid::new(shape, lengths.unwrap_or((1.0, 1.0))).map_err(Into::into))?;
        let first = surface(map, processes.share(grid)?, given.absent_missing(), skin);
        let surface = processes.agree(match (first, against) {
            (Ok(first), Some(other)) => self.between((&first, unit.as_deref(), original), other),
            (first, _) => first,
        })?;
        let is_whole = boundary == Boundary::Free || given.whole();
        let part = processes.agree(Part::new(original, *surface.grid(), is_whole))?;
        self.worded(fits("{work_of_adhesion_map}", works.as_ref(), shape))?;
        self.worded(fits("{hardness_map}", hardness.as_ref(), shape))?;
        let formula = self.formula(table.as_ref(), works.as_ref()).map_err(|error| match &works {
            Some(_) => worded(&format!("{{work_of_adhesion_map}} does not fit the law: {error}"), skin).into(),
            None => error.into(),
        });
        let formula = processes.agree(formula)?;
        let units = processes.agree(self.worded(given.units(unit.as_deref(), si)))?;
        let inputs = Inputs {
            heights: source,
            shift: facing.as_ref().map(|_| given.shift().unwrap_or_default()),
            against: facing,
            part: part.name().map(str::to_owned),
            solved_shape: part.solved(),
            length_unit: units.length.clone(),
            pressure_unit: units.pressure.clone(),
            given: self.quantities.texts(),
            ..scene.inputs(part.grid().shape(), part.grid().lengths(), threads)
        };
        let (surface, scene) = (Arc::new(surface), scene.clone());
        let posed = Posed {
            surface,
            part,
            units,
            inputs,
            seed,
            scene,
            skin,
            formula,
            hardness,
            converted_from,
            scars_removed,
            doubts,
        };
        Ok(posed)
    }

    /// The surface between a first one, with its unit and its original, and the map of the surface on the other side.
    fn between(&self, first: (&Surface, Option<&str>, Option<(usize, usize)>), other: Map) -> Outcome<Surface> {
        let (given, boundary) = (&self.given, self.scene.elastic.boundary);
        let other = other.in_metres_if(self.quantities.is_si(), self.skin)?.topography;
        let shift = given.shift().unwrap_or_default();
        self.worded(between(first, other, shift, (boundary, given.absent_missing())))
    }
}

/// What is doubtful about a map and the one on the other side, which has the side lengths of the first.
fn doubts(first: &Topography, other: Option<&Topography>, boundary: Boundary) -> Vec<Warning> {
    let other = other.into_iter().flat_map(Warning::of_source).filter(|found| found.code != WarningCode::Sides);
    let is_free = boundary == Boundary::Free;
    let counts = |found: &Warning| !(is_free && found.code == WarningCode::NotPeriodic);
    Warning::of_source(first).into_iter().chain(other).filter(counts).collect()
}

/// Refuses a field of another shape than the heights.
fn fits(key: &str, field: Option<&Array2<f64>>, (nx, ny): (usize, usize)) -> Result<(), String> {
    match field.map(|field| field.dim()) {
        Some((x, y)) if (x, y) != (nx, ny) => {
            Err(format!("{key} has {x} x {y} nodes, but the heights have {nx} x {ny}: give one value for each node"))
        }
        _ => Ok(()),
    }
}

/// The surface of a map on its grid. Missing points become absent nodes, or are refused.
fn surface(map: Map, grid: Grid, absent_missing: bool, skin: Skin) -> Outcome<Surface> {
    if !grid.is_shared() {
        complete(map.label(), (&map.topography.heights, map.shape), absent_missing, skin)?;
    }
    let name = map.label().to_owned();
    let make = if absent_missing { surface_with_absent } else { Surface::new };
    make(grid, map.topography.heights).map_err(|error| match error {
        Error::Elsewhere { .. } => error.into(),
        error => format!("{name}: {error}").into(),
    })
}
