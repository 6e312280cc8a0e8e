//! The session of a contact problem: it is posed, solved under one load or along many, and stopped.

pub(crate) mod course;
pub mod fall;
pub(crate) mod limit;
mod one_grid;
pub mod pace;
mod posed;
mod rows;
mod solves;
pub(crate) mod way;

use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::contact::{ContactStatistics, Region};
use asperity::solver::Iteration;
use asperity::{AdhesionLaw, Control, Grid, Real, Result, Solver, Status, Surface};
use asperity_maps::warning::WarningCode;
use ndarray::Array2;
use serde_json::json;

pub use self::one_grid::OneGrid;
pub use self::rows::{Next, Rows, TableFile};
use crate::Either;
use crate::account::row::Kind;
use crate::account::{Account, Answer, Inputs, PulledOff, Row, Slopes, check_finite, warnings_of, warnings_of_input};
use crate::case::{Part, Posed};
use crate::key::{After, Constraint, Notice, Precision, Scalar, Scene, Skin, Units, worded};
use crate::outcome::Outcome;
use crate::processes::{Processes, WHOLE};
use crate::session::limit::Chosen;
use crate::table::Format;
use crate::table::warnings::Warnings;

/// The observer of a solve: it sees each iteration with the grid and the tolerance of the solve on it, and may end the
/// solve.
pub type Observe<'a> = &'a mut (dyn FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> + Send);

/// What sees the states of a solve along loads, and may stop it.
pub type Watch<'a> = &'a mut (dyn FnMut(&Iteration) -> ControlFlow<()> + Send);

/// The session of a contact problem in one precision, before it is solved: a solve, a pull-off and the rows of a table take
/// it along, and heights that nothing else holds leave as soon as they can.
#[derive(Clone)]
pub struct Session<T: Scalar> {
    /// The facts that its accounts have in common.
    pub facts: Facts,
    surface: Arc<Surface>,
    law: Arc<dyn AdhesionLaw<T>>,
    /// The grid that was chosen for the accuracy of a cycle
    chosen: Option<Box<Chosen>>,
}

/// The facts that all accounts of a session have in common.
#[derive(Clone)]
pub struct Facts {
    /// The inputs of its reports.
    pub inputs: Inputs,
    /// The seed of a random surface.
    pub seed: Option<u64>,
    /// The warnings so far.
    pub warnings: Warnings,
    /// The scene.
    pub scene: Scene,
    /// The units of its numbers, as far as they are known.
    pub units: Units,
    part: Part,
    /// The node with the largest work of adhesion, where that varies.
    strongest: Option<(usize, usize)>,
    hardness: Option<Arc<Array2<f64>>>,
    scars_removed: Option<f64>,
    skin: Skin,
    processes: Processes,
}

/// A solution with its account.
pub struct Solved<T: Real> {
    /// The findings.
    pub found: Answer<T>,
    /// The account, which a look completes.
    pub account: Account,
    /// The facts of its session.
    pub facts: Facts,
}

/// A session in either precision.
pub type AnySession = Either<Session<f32>, Session<f64>>;

/// Rows in either precision.
pub type AnyRows = Either<Rows<f32>, Rows<f64>>;

impl AnySession {
    /// The session of a case on its maps in the precision of its scene, with the slopes of the surface; see
    /// [`Session::new`].
    ///
    /// # Errors
    /// Those of [`Session::new`].
    pub fn new(posed: Posed, processes: &Processes) -> Outcome<Self> {
        Ok(match posed.scene.precision {
            Precision::F32 => Self::F32(Session::new(posed, false, processes)?.with_slopes()),
            Precision::F64 => Self::F64(Session::new(posed, false, processes)?.with_slopes()),
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

    /// The text of a table of one row, with what is asked for after it, or of the pull-off that ends with it. Looks at the
    /// fields.
    ///
    /// # Errors
    /// As [`Solved::look`].
    pub fn table(&mut self, after: &After, pulled_off: Option<&PulledOff>, format: Format) -> Result<String> {
        let sizes = self.look()?.cluster_sizes;
        let Self { found, account, facts } = self;
        let kind = match pulled_off {
            Some(_) => Kind::PullOff,
            None if found.search.is_some() => Kind::Search,
            None => Kind::Sweep,
        };
        let names = kind.columns(after, &facts.scene.adhesion);
        let mut cells = Row::record(found, account, &sizes, None, facts.seed).cells(&names);
        for (name, value) in json!(pulled_off).as_object().into_iter().flatten() {
            cells.get_mut(name).into_iter().for_each(|cell| *cell = value.clone());
        }
        let header = facts.units.columns(&names, account.control, found.solution.grid.is_line());
        Ok(format.header(&header) + &format.line(&cells) + "\n")
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
        let (processes, scars_removed, hardness) = (processes.clone(), posed.scars_removed, hardness.map(Arc::new));
        let facts =
            Facts { inputs, seed, warnings, scene, units, part, strongest, hardness, scars_removed, skin, processes };
        // a wall and a hardness are refused before anything is solved
        facts.solver::<T>()?;
        Ok(Self { facts, surface, law, chosen: None })
    }

    /// The session with the slopes of its surface among the inputs, where a process has all of it.
    pub fn with_slopes(mut self) -> Self {
        if is_whole(self.grid()) {
            self.facts.inputs.slopes = Slopes::on(&self.surface, self.facts.scene.elastic.boundary);
        }
        self
    }

    /// The grid of the surface.
    pub fn grid(&self) -> &Grid {
        self.surface.grid()
    }
}

impl Facts {
    /// A solver of the scene that has solved nothing yet.
    fn solver<T: Real>(&self) -> Result<Solver<Constraint<T>>> {
        let constraint = self.scene.adhesion.constraint(self.hardness.as_ref().map(|hardness| hardness.view()))?;
        Ok(Solver { settings: self.scene.settings(), constraint })
    }

    /// The load on the whole map that is a load on the part of it that results are of.
    fn on_whole(&self, load: Control) -> Control {
        self.part.wanted().map_or(load, |original| original.load(load))
    }

    /// What a command found, with its account.
    fn solved<T: Scalar>(mut self, command: &'static str, found: Answer<T>) -> Outcome<Solved<T>> {
        let account = self.account(command, &found)?;
        Ok(Solved { found, account, facts: self })
    }

    /// The account of what a command found; a solve that an observer ended may be anywhere.
    fn account<T: Scalar>(&mut self, command: &'static str, found: &Answer<T>) -> Outcome<Account> {
        if found.solution.report.status != Status::Stopped {
            self.worded(check_finite(&found.solution))?;
        }
        let warnings = self.look(found);
        let warnings = self.processes.agree(warnings)?;
        Ok(found.account(command, &self.inputs, self.strongest, warnings)?)
    }

    /// The warnings of the input and of a state.
    fn look<T: Scalar>(&mut self, found: &Answer<T>) -> Outcome<Vec<Notice>> {
        let mut new = Vec::new();
        if is_whole(&found.solution.grid) {
            let (solution, of_input) = (found.solution.whole(), (self.warnings.of_input(), self.scars_removed));
            new = warnings_of(&*solution, found.sight.original, of_input)?;
            // a cycle goes from afar to afar, where the force is a small part of that in contact
            let is_apart = || solution.regions().iter().all(|region| matches!(region, Region::Apart | Region::Absent));
            if found.step.is_some() && solution.report.contact_nodes == 0 && is_apart() {
                new.retain(|warning| warning.code != WarningCode::WindowEdge);
            }
        }
        self.warnings.add(new.iter().map(|warning| self.units.describe(warning)).collect())
    }

    /// A result with a reason that has keys in braces.
    fn worded<V>(&self, result: std::result::Result<V, String>) -> Outcome<V> {
        Ok(result.map_err(|reason| worded(&reason, self.skin))?)
    }
}

/// Whether a process has, or may have, the whole of the fields on a grid.
fn is_whole(grid: &Grid) -> bool {
    !grid.is_shared() || grid.nodes() <= WHOLE
}
