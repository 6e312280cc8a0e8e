//! The case that options choose, with what its files hold.

use std::path::Path;

use asperity_maps::Topography;
use asperity_maps::io::{read_field, read_topography};
use asperity_scene::{
    After, Case, Entries, Files, Map, Maps, Objects, Outcome, Posed, Processes, Scalar, Session, Skin, read_law,
};
use ndarray::Array2;

use crate::heights::{named, rows_of, shared};
use crate::threads;

/// The case that options choose, and its files.
pub struct ProblemOptions {
    pub case: Case,
    pub files: Files,
}

/// The problem with what its files hold.
pub struct Problem {
    pub posed: Posed,
    /// The numbers of the table of the law
    pub table: Option<Array2<f64>>,
    /// The works of adhesion of the map, at all nodes
    pub works: Option<Array2<f64>>,
}

impl ProblemOptions {
    /// The problem of what is given; refuses a law, a wall and a body without their parameters.
    pub fn new(given: &Entries) -> Outcome<Self> {
        let case = Case::new(given.clone(), given.quantities(), Objects::default(), Skin::Options)?;
        Ok(Self { case, files: given.files() })
    }

    /// Reads the files, of fields the rows that this process holds, and starts the threads.
    pub fn read(&self, processes: &Processes) -> Outcome<Problem> {
        self.with(None, processes)
    }

    /// The same with heights that were `made`, if they were, instead of the heights of the file.
    pub fn with(&self, made: Option<Topography>, processes: &Processes) -> Outcome<Problem> {
        let Self { case, files } = self;
        let read = || {
            let path = &files.heights;
            let heights = if processes.count() > 1 {
                let (topography, shape) = shared(path, processes)?;
                Map { name: named(path), topography, shape }
            } else {
                Map::whole(named(path), made.map_or_else(|| read_topography(path), Ok)?)
            };
            let other = |path: &Path| Ok::<_, asperity::Error>(Map::whole(named(path), read_topography(path)?));
            let against = files.against.as_deref().map(other).transpose()?;
            let field = |path: &Option<_>| path.as_ref().map(read_field).transpose();
            let (hardness, works) = (field(&files.hardness_map)?, field(&files.work_of_adhesion_map)?);
            let (law, table) = files.law_table.as_deref().map(read_law).transpose()?.unzip();
            threads::use_threads(case.given().threads())?;
            let maps = Maps { against, hardness, works: works.clone(), table: law, ..Maps::new(heights) };
            Ok((maps, table, works))
        };
        let (maps, table, works) = processes.agree(read())?;
        Ok(Problem { posed: case.on(maps, threads::count(), processes)?, table, works })
    }

    /// The gap from which to start, if a file has it.
    pub fn start<T: Scalar>(&self, session: &mut Session<T>, processes: &Processes) -> Outcome<Option<Array2<f64>>> {
        let read = |path: &Path| {
            let grid = session.grid();
            session.start(if grid.is_shared() { rows_of(path, grid)? } else { read_field(path)? })
        };
        let start = processes.agree(self.files.initial_gap.as_deref().map(read).transpose());
        session.facts.inputs.initial_gap = self.files.initial_gap.as_deref().and_then(named);
        start
    }

    /// Refuses findings that have no form for several processes.
    pub fn check_after(&self, after: &After, processes: &Processes) -> Outcome<()> {
        let adheres = self.case.scene().adhesion.adheres();
        after.takes_whole_fields(adheres).map_or(Ok(()), |name| processes.alone(name))
    }

    /// The files of the problem but for the gap from which to start.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.of_problem()
    }
}
