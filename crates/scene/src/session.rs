//! The session of a contact problem: it is posed, solved under one load or along many, and stopped.

pub(crate) mod course;
pub mod fall;
mod filled;
pub(crate) mod limit;
pub mod pace;
mod posed;
mod solves;
pub(crate) mod way;

use std::ops::ControlFlow;
use std::sync::{Arc, Weak};

use asperity::contact::{ContactStatistics, Region};
use asperity::solver::Iteration;
use asperity::{AdhesionLaw, Grid, PullOff, Real, Result, Solver, Status, Surface};
use asperity_maps::warning::WarningCode;
use ndarray::Array2;
use serde_json::json;

pub use self::filled::{Next, TableFile};
use crate::Either;
use crate::account::row::Kind;
use crate::account::{Account, Found, Inputs, PulledOff, Row, Slopes, check_finite, warnings_of, warnings_of_input};
use crate::case::{Part, Posed};
use crate::key::{After, Constraint, Goal, Notice, Precision, Request, Scalar, Scene, Skin, Units, worded};
use crate::outcome::Outcome;
use crate::processes::{Processes, WHOLE};
use crate::session::course::Course;
use crate::session::limit::Coarser;
use crate::session::posed::Body;
use crate::table::warnings::Warnings;
use crate::table::{Format, Table};

/// The observer of a solve: it sees each iteration with the grid and the tolerance of the solve on it, and may end the
/// solve.
pub type Observe<'a> = &'a mut (dyn FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> + Send);

/// The session of a contact problem in one precision: the problem with its solver, the inputs of its reports, its
/// warnings, and the table that is filled.
pub struct Session<T: Scalar> {
    /// The inputs of its reports.
    pub inputs: Inputs,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    /// The warnings so far.
    pub warnings: Warnings,
    facts: Facts,
    surface: Weak<Surface>,
    body: Body<T>,
    law: Arc<dyn AdhesionLaw<T>>,
    solver: Solver<Constraint<T>>,
    /// The grid of the surface.
    grid: Grid,
    /// Whether no solve follows the next one.
    last: bool,
    course: Option<Course<T>>,
    table: Option<Table>,
    /// What tells the limits of a cycle
    coarser: Option<Coarser<T>>,
}

/// What all solves of a session have in common besides the problem.
#[derive(Clone)]
struct Facts {
    scene: Scene,
    part: Part,
    units: Units,
    /// The node with the largest work of adhesion, where that varies.
    strongest: Option<(usize, usize)>,
    hardness: Option<Array2<f64>>,
    scars_removed: Option<f64>,
    skin: Skin,
    processes: Processes,
}

/// A solution with its account.
pub struct Solved<T: Real> {
    /// The findings.
    pub found: Found<T>,
    /// The account, which a look completes.
    pub account: Account,
}

/// A session in either precision.
pub type AnySession = Either<Session<f32>, Session<f64>>;

impl AnySession {
    /// The session of a case on its maps in the precision of its scene, with the slopes of the surface; see
    /// [`Session::new`].
    ///
    /// # Errors
    /// Those of [`Session::new`].
    pub fn of(posed: Posed, processes: &Processes) -> Outcome<Self> {
        Ok(match posed.scene.precision {
            Precision::F32 => Self::F32(Session::new(posed, false, processes)?.with_slopes()?),
            Precision::F64 => Self::F64(Session::new(posed, false, processes)?.with_slopes()?),
        })
    }
}

impl<T: Real> Solved<T> {
    /// Looks at the fields: fills in the keys of the account that are found of them.
    ///
    /// # Errors
    /// As [`Sight::look`](crate::Sight::look).
    pub fn look(&mut self) -> Result<ContactStatistics> {
        self.found.sight.look_at(&mut self.account, &self.found.solution)
    }
}

impl<T: Scalar> Session<T> {
    /// The session of a case on its maps, on processes; warnings are errors if it `is_strict`.
    ///
    /// # Errors
    /// Those of the wall and the hardness, and warnings, if they are errors.
    pub fn new(posed: Posed, is_strict: bool, processes: &Processes) -> Outcome<Self> {
        let Posed { surface, part, units, inputs, seed, scene, skin, formula, hardness, converted_from, .. } = posed;
        let (grid, strongest, law) = (*surface.grid(), formula.strongest(), T::law(formula));
        let warn = || match is_whole(&grid) {
            true => {
                let surface = (&*surface.whole(), converted_from.as_deref());
                let found = warnings_of_input(surface, &scene.elastic, &*law, &units);
                Warnings::new(posed.doubts.iter().map(|doubt| units.describe(doubt)).chain(found).collect(), is_strict)
            }
            false if is_strict => Err("--strict has no form for several processes and more than 4096 x 4096 nodes: \
                                       leave it out"
                .into()),
            false => Warnings::new(Vec::new(), is_strict),
        };
        let warnings = processes.agree(warn())?;
        let constraint = scene.adhesion.constraint(hardness.as_ref().map(|hardness| hardness.view()))?;
        let solver = Solver { settings: scene.settings(), constraint };
        let (processes, scars_removed) = (processes.clone(), posed.scars_removed);
        let facts = Facts { scene, part, units, strongest, hardness, scars_removed, skin, processes };
        let (surface, body) = (Arc::downgrade(&surface), Body::Surface(surface));
        let (last, course, table, coarser) = (false, None, None, None);
        Ok(Self { inputs, seed, warnings, facts, surface, body, law, solver, grid, last, course, table, coarser })
    }

    /// The session with the slopes of its surface among the inputs, where a process has all of it.
    ///
    /// # Errors
    /// [`Error::Unsuited`](asperity::Error::Unsuited) after the first solve.
    pub fn with_slopes(mut self) -> Result<Self> {
        if is_whole(&self.grid) {
            self.inputs.slopes = Slopes::on(&*self.surface()?, self.facts.scene.elastic.boundary);
        }
        Ok(self)
    }

    /// The session of one solve: heights that nothing else holds leave before the solve on the finest grid, and the
    /// problem after it.
    pub fn for_one_solve(self) -> Self {
        Self { last: true, ..self }
    }

    /// Poses the problem anew on its surface, which something else holds, as one that has solved nothing yet.
    ///
    /// # Errors
    /// [`Error::Unsuited`](asperity::Error::Unsuited) where nothing does.
    pub fn renew(&mut self) -> Result<()> {
        let hardness = self.facts.hardness.as_ref().map(|hardness| hardness.view());
        self.solver.constraint = self.facts.scene.adhesion.constraint(hardness)?;
        (self.body, self.course, self.table, self.coarser) = (Body::Surface(self.surface()?), None, None, None);
        Ok(())
    }

    /// The grid of the surface.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.facts.scene
    }

    /// The units of its numbers, as far as they are known.
    pub fn units(&self) -> &Units {
        &self.facts.units
    }

    /// The equilibrium under a load, from a gap or the default start, with all that is asked for with it, and its
    /// account.
    ///
    /// # Errors
    /// Errors of the solvers of the library, a solve that ran away, and warnings, if they are errors.
    pub fn solve(&mut self, asked: &Request, start: Option<Array2<T>>, observe: Observe<'_>) -> Outcome<Solved<T>> {
        let asked = Request { control: self.on_whole(asked.control), ..*asked };
        let found = self.find(&asked, start, observe)?;
        self.solved("solve", found)
    }

    /// The pull-off, to an accuracy if one is asked for, from a gap or the default start, with the last state that
    /// holds.
    ///
    /// # Errors
    /// As [`Session::solve`].
    pub fn pull_off(
        &mut self,
        asked: PullOff,
        goal: Option<Goal>,
        start: Option<Array2<T>>,
        observe: Observe<'_>,
    ) -> Outcome<(Solved<T>, PulledOff)> {
        let (found, pulled_off) = self.find_pull_off(asked, goal, start, observe)?;
        Ok((self.solved("pull-off", found)?, pulled_off))
    }

    /// The text of a table of one row, of a solution and of what is asked for after it, or of the pull-off that ends
    /// with it. Looks at the fields.
    ///
    /// # Errors
    /// As [`Solved::look`].
    pub fn table_of(
        &self,
        solved: &mut Solved<T>,
        after: &After,
        pulled_off: Option<&PulledOff>,
        format: Format,
    ) -> Result<String> {
        let sizes = solved.look()?.cluster_sizes;
        let Solved { found, account } = solved;
        let kind = match pulled_off {
            Some(_) => Kind::PullOff,
            None if found.search.is_some() => Kind::Search,
            None => Kind::Sweep,
        };
        let names = kind.columns(after, &self.facts.scene.adhesion);
        let mut cells = Row::of(found, account, &sizes, None, self.seed).cells(&names);
        for (name, value) in json!(pulled_off).as_object().into_iter().flatten() {
            cells.get_mut(name).into_iter().for_each(|cell| *cell = value.clone());
        }
        let header = self.facts.units.columns(&names, account.control, self.grid.is_line());
        Ok(format.header(&header) + &format.line(&cells) + "\n")
    }

    /// What a command found, with its account; a solve that an observer ended may be anywhere.
    fn solved(&mut self, command: &'static str, found: Found<T>) -> Outcome<Solved<T>> {
        if self.last {
            self.body = Body::Spent;
        }
        if found.solution.report.status != Status::Stopped {
            self.worded(check_finite(&found.solution))?;
        }
        let warnings = self.look(&found);
        let warnings = self.facts.processes.agree(warnings)?;
        let account = found.account(command, &self.inputs, self.facts.strongest, warnings)?;
        Ok(Solved { found, account })
    }

    /// The warnings of the input and of a state.
    fn look(&mut self, found: &Found<T>) -> Outcome<Vec<Notice>> {
        let mut new = Vec::new();
        if is_whole(&self.grid) {
            let (solution, of_input) = (found.solution.whole(), (self.warnings.of_input(), self.facts.scars_removed));
            new = warnings_of(&*solution, found.sight.original, of_input)?;
            // a cycle goes from afar to afar, where the force is a small part of that in contact
            let is_apart = || solution.regions().iter().all(|region| matches!(region, Region::Apart | Region::Absent));
            if found.step.is_some() && solution.report.contact_nodes == 0 && is_apart() {
                new.retain(|warning| warning.code != WarningCode::WindowEdge);
            }
        }
        self.warnings.add(new.iter().map(|warning| self.facts.units.describe(warning)).collect())
    }

    /// A result with a reason that has keys in braces.
    fn worded<V>(&self, result: std::result::Result<V, String>) -> Outcome<V> {
        Ok(result.map_err(|reason| worded(&reason, self.facts.skin))?)
    }
}

/// Whether a process has, or may have, the whole of the fields on a grid.
fn is_whole(grid: &Grid) -> bool {
    !grid.is_shared() || grid.nodes() <= WHOLE
}
