//! The contact problem that options choose, with what its files hold.

use std::path::Path;
use std::sync::Arc;

use asperity::{Error, Surface};
use asperity_maps::Topography;
use asperity_maps::io::{read_field, read_topography};
pub use asperity_scene::Scalar;
use asperity_scene::{After, Branches, Files, Given, Load, Scene, between};
use ndarray::Array2;

use crate::adhesion::Adhesion;
use crate::heights::{self, Origin, map_in};
use crate::outcome::Outcome;
use crate::part::Part;
use crate::printing::{Warn, in_options, warn};
use crate::processes::Processes;
use crate::threads::use_threads;
use crate::units::Units;

/// The contact problem that options choose, and its solver.
pub struct ProblemOptions {
    pub given: Given,
    pub scene: Scene,
    pub files: Files,
}

/// The problem with what its files hold.
pub struct Problem {
    pub surface: Arc<Surface>,
    pub adhesion: Adhesion,
    /// The entries of the file of the surface besides its heights
    pub origin: Origin,
    /// The part of the surface that results are of
    pub part: Part,
    /// The gap from which to start, if there is one
    pub start: Option<Array2<f64>>,
    /// The units of the numbers, as far as they are known
    pub units: Units,
}

impl ProblemOptions {
    /// The problem of several lists of keys; refuses a law, a wall and a body without their parameters.
    pub fn of<'a>(parts: impl IntoIterator<Item = &'a Given>) -> Outcome<Self> {
        let given = Given::all(parts);
        let (scene, files) = (given.scene()?, given.files());
        in_options(scene.adhesion.check().and_then(|()| scene.elastic.check()))?;
        Ok(Self { given, scene, files })
    }

    /// Reads the files, with all in metres if numbers are in SI units, of fields the rows that this process holds, and
    /// starts the threads.
    pub fn read(&self, si: bool, processes: &Processes) -> Outcome<Problem> {
        self.with(None, si, processes, &mut warn)
    }

    /// The same with heights that were `made`, if they were, in the place of those of their file, and with a listener to
    /// warnings.
    pub fn with(&self, made: Option<Topography>, si: bool, processes: &Processes, warn: Warn<'_>) -> Outcome<Problem> {
        let Self { given, scene, files } = self;
        let (path, absent, boundary) = (&files.heights, given.absent_missing(), scene.elastic.boundary);
        let (surface, origin) = if processes.count() > 1 {
            heights::shared(path, given, (si, absent), processes, warn)?
        } else {
            let map = made.map_or_else(|| read_topography(path), Ok)?;
            let (map, origin) = heights::with_sides(path, map, given, si)?;
            (heights::surface_or_absent(path, map, absent, warn)?, origin)
        };
        let surface = processes.agree(match &files.against {
            Some(against) => map_in(si, against).and_then(|(map, _)| {
                let (first, shift) = ((&surface, origin.unit.as_deref(), origin.original), given.shift());
                in_options(between(first, map, shift.unwrap_or_default(), (boundary, absent)))
            }),
            None => Ok(surface),
        })?;
        let part = processes.agree(Part::of(&origin, *surface.grid(), boundary, given.whole()))?;
        let adhesion = Adhesion::read(&scene.adhesion, files, surface.grid(), processes)?;
        let start = processes.agree(self.start(&surface, &part))?;
        processes.agree(use_threads(given.threads()))?;
        let units = processes.agree(in_options(given.units(origin.unit.as_deref(), si)))?;
        Ok(Problem { surface: Arc::new(surface), adhesion, origin, part, start, units })
    }

    /// The gap from which to start, if it is given, of the whole surface or of the `part` of which results are.
    fn start(&self, surface: &Surface, part: &Part) -> Outcome<Option<Array2<f64>>> {
        let Some(path) = &self.files.initial_gap else { return Ok(None) };
        let grid = surface.grid();
        // a mirrored map, which one process has as a whole, may start from the gap of its original
        let start = if part.has_original() {
            let start = part.whole_of(read_field(path)?)?;
            let (found, expected) = (start.dim(), grid.shape());
            if found != expected {
                return Err(Error::Shape { name: "--initial-gap", found, expected }.into());
            }
            start
        } else {
            heights::rows_on("--initial-gap", path, grid)?
        };
        let first = grid.rows().start;
        // the library refuses what is not finite, but for nodes without a gap
        let is_absent = |node: (usize, usize)| surface.absent().is_some_and(|absent| absent[node]);
        let unknown = |(node, gap): &((usize, usize), &f64)| !gap.is_finite() && !is_absent(*node);
        if let Some(((i, j), gap)) = start.indexed_iter().find(unknown) {
            return Err(format!(
                "{}: the gap at index [{}, {j}] is {gap}, where the surface has a height: only absent nodes may have none",
                path.display(),
                first + i
            )
            .into());
        }
        Ok(Some(start))
    }

    /// Refuses both branches of equilibria where each state starts from the one before.
    pub fn check_table(&self) -> Outcome<()> {
        match self.scene.branch {
            Some(Branches::Both) => {
                Err("--branch both compares two solves under one load: use asperity solve, or give one branch".into())
            }
            _ => Ok(()),
        }
    }

    /// Refuses loads that the boundary does not have.
    pub fn check_loads(&self, loads: &[Load]) -> Outcome<()> {
        let Scene { elastic, adhesion, .. } = &self.scene;
        in_options(
            loads.iter().try_for_each(|load| load.check(elastic.boundary, elastic.has_approach(), adhesion.adheres())),
        )
    }

    /// Refuses findings that the problem does not have, and those that have no form for several processes.
    pub fn check_after(&self, after: &After, processes: &Processes) -> Outcome<()> {
        let Scene { elastic, adhesion, .. } = &self.scene;
        in_options(after.check(elastic, adhesion))?;
        after.takes_whole_fields(adhesion.adheres()).map_or(Ok(()), |name| processes.alone(name))
    }

    /// Refuses a surface that yields, for a reason.
    pub fn check_elastic(&self, reason: &str) -> Outcome<()> {
        in_options(self.scene.adhesion.check_elastic(reason))
    }

    /// The pressure E* h'rms, of which a reduced pressure is a part; 1 where none of the loads is one.
    pub fn full_pressure(&self, surface: &Surface, loads: &[Load]) -> Outcome<f64> {
        match loads.iter().any(|load| matches!(load, Load::Reduced(_))) {
            true => Ok(self.scene.elastic.full_pressure(surface)?),
            false => Ok(1.0),
        }
    }

    /// The files of the problem but for the gap from which to start.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.of_problem()
    }
}
