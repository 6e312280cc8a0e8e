//! The limit of no range of a cycle, by the same cycle on coarser grids, and the grid on which it has an accuracy.

use std::sync::Arc;

use asperity::accuracy::{LoopGrid, LoopLimit};
use asperity::path::{PathEnd, PathSettings};
use asperity::{AdhesionLaw, Control, Real, Status, Surface};
use ndarray::Array2;
use serde::Serialize;

use crate::account::{Refinement, bytes};
use crate::case::Part;
use crate::key::{After, ENERGY_PER_AREA, Goal, PRESSURE, Request, Scalar, Scene, Skin, record, worded};
use crate::numbers::percent;
use crate::outcome::Outcome;
use crate::session::course::Course;
use crate::session::way::Way;
use crate::session::{Facts, Observe, Rows, Session, Watch};
use crate::table::warnings::Warnings;

record! {
    /// The limits of no range of what a cycle tells.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize)]
    CycleLimit of (limit: LoopLimit) {
        /// With `law` `jkr`, the limit of no range of the work done by the load, per area of the map.
        work_limit: f64 [ENERGY_PER_AREA] = limit.work.value,
        /// Estimated error of the limit of the work.
        work_limit_error: f64 [ENERGY_PER_AREA] = limit.work.error,
        /// With `law` `jkr`, the limit of no range of the greatest tension.
        tension_limit: f64 [PRESSURE] = limit.tension.value,
        /// Estimated error of the limit of the tension.
        tension_limit_error: f64 [PRESSURE] = limit.tension.error,
    }
}

/// The limits of no range of a cycle, with the grids that tell them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CycleLimits {
    /// The limits.
    #[serde(flatten)]
    pub limit: CycleLimit,
    /// The cycle on each grid, the finest last.
    pub levels: Vec<CycleLevel>,
    /// The end of a cycle to an accuracy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Refinement>,
    #[serde(skip)]
    told: LoopLimit,
}

/// The cycle on one grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CycleLevel {
    /// The nodes (Nx, Ny) of the grid.
    pub shape: (usize, usize),
    /// The work done by the load, per area of the map.
    pub work: f64,
    /// The standard error of the work.
    pub work_error: f64,
    /// The greatest tension.
    pub greatest_tension: f64,
}

/// A grid, and the end of a cycle on it.
type Level = ((usize, usize), PathEnd);

/// What tells the limits of a cycle.
pub(super) enum Coarser<T: Scalar> {
    /// The cycle on the coarser grid, which is followed after the last row.
    Ahead(Box<(Session<T>, Course<T>)>),
    /// The cycle on coarser grids, which was followed before the first row, and chose the grid for an accuracy.
    Behind(Box<Chosen>),
}

/// The grid that was chosen for an accuracy.
#[derive(Clone)]
pub(super) struct Chosen {
    levels: Vec<Level>,
    accuracy: Refinement,
    pub surface: Arc<Surface>,
}

impl CycleLimits {
    /// The limits by a cycle on some grids, the finest last, to an accuracy, if one was asked for.
    fn from_levels(levels: &[Level], accuracy: Option<Refinement>) -> Option<Self> {
        let [.., (_, coarse), (shape, fine)] = levels else { return None };
        let told = LoopLimit::of(*shape, fine, coarse);
        let level = |&(shape, PathEnd { work, work_error, greatest_tension, .. }): &Level| CycleLevel {
            shape,
            work,
            work_error,
            greatest_tension,
        };
        let reached = |of| told.get(of).relative_error();
        Some(Self {
            limit: CycleLimit::record(told),
            levels: levels.iter().map(level).collect(),
            accuracy: accuracy.map(|asked| Refinement { reached: reached(asked.of) <= asked.wanted, ..asked }),
            told,
        })
    }

    /// The shortfall of an accuracy that was not reached, with a remedy, in the words of a skin.
    pub fn shortfall(&self, skin: Skin) -> Option<String> {
        let accuracy = self.accuracy.filter(|accuracy| !accuracy.reached)?;
        let estimate = format!("{} %", percent(self.told.get(accuracy.of).relative_error()));
        Some(worded(&accuracy.missed(&estimate, "give a smaller {accuracy}, which takes a finer grid"), skin))
    }
}

impl Goal {
    /// The grid of a cycle to the accuracy in words.
    fn chosen<T: Real>(&self, found: &LoopGrid<T>) -> String {
        let (Self { accuracy, of, .. }, (nx, ny)) = (self, found.surface.grid().shape());
        let coarser: Vec<_> = found.levels.iter().map(|((nx, ny), _)| format!("{nx} x {ny}")).collect();
        let (size, coarser) = (bytes(found.bytes), coarser.join(", "));
        let expected = match found.expected.is_finite() {
            true => format!("an error of {} % is expected", percent(found.expected)),
            false => "one coarser grid tells no error before the last row".to_owned(),
        };
        format!("accuracy {accuracy} of the {of}: {nx} x {ny} nodes, {size}, by the cycle on {coarser}; {expected}")
    }
}

/// The nodes of a map from which on a grid is chosen in much less time than a cycle on the whole map takes.
const MANY: usize = 1 << 14;

impl<T: Scalar> Session<T> {
    /// Whether an accuracy could take a cycle from the default start to a coarser grid, in much less time.
    pub fn may_choose_grid(&self) -> bool {
        let (elastic, whole) = (!self.facts.scene.adhesion.yields(), !self.grid().is_shared());
        self.law.hints().touches() && elastic && whole && self.grid().nodes() >= MANY
    }

    /// Puts the session on the grid on which a cycle is likely to have an accuracy, by the cycle on coarser grids, from the
    /// default start, unless one is given; returns the grid in words. To be called before [`Session::begin`].
    ///
    /// # Errors
    /// A start or a hardness, a cycle that was stopped, those of
    /// [`Accuracy::loop_grid`](asperity::accuracy::Accuracy::loop_grid) and of the solvers of the library.
    pub fn refine(&mut self, way: &Way, goal: Goal, is_started: bool, observe: Observe<'_>) -> Outcome<String> {
        let Way::Cycle(loads, settings) = way else { return Err("an accuracy of a table is of a cycle".into()) };
        let Scene { adhesion, method, .. } = &self.facts.scene;
        let asked = Request { goal: Some(goal), ..Request::under(way.control(&self.facts.scene)) };
        self.facts.worded(asked.check(adhesion, *method, is_started))?;
        self.facts.processes.alone("the accuracy of a cycle")?;
        let tolerance = self.tolerance(None)?;
        let mut operator = self.facts.scene.elastic.operator::<T>(*self.grid())?;
        let follow = |surface: &Surface, law: &Arc<dyn AdhesionLaw<T>>| -> Outcome<_> {
            let (grid, surface) = (*surface.grid(), Arc::new(surface.clone()));
            let (session, course) = self.on_grid(surface, law.clone(), loads, *settings, None)?;
            session.follow(course)?.end(&mut |state| observe(&grid, state, tolerance))
        };
        let wanted = goal.wanted(false);
        let found = wanted.loop_grid(&self.surface, &mut operator, Arc::clone(&self.law), follow)?;
        let found = found.ok_or("the cycle was stopped before its first row")?;
        let chosen = goal.chosen(&found);
        let LoopGrid { surface, law, levels, refinable, unaffordable, .. } = found;
        let surface = Arc::new(surface);
        self.facts.part = self.facts.part.on(*surface.grid())?;
        (self.surface, self.law) = (surface.clone(), law);
        let accuracy = Refinement { wanted: goal.accuracy, of: goal.of, reached: false, refinable, unaffordable };
        self.chosen = Some(Box::new(Chosen { levels, accuracy, surface }));
        Ok(chosen)
    }

    /// The same cycle on the coarser grid, from the gap there of a start that is given, by laws that attract next to contacts
    /// alone; none where there is no such grid, and where a start is given and nodes are absent, whose gap is infinite.
    pub(super) fn coarser(
        &self,
        loads: &[Control],
        settings: PathSettings,
        start: Option<&Array2<f64>>,
    ) -> Outcome<Option<Coarser<T>>> {
        let surface = &self.surface;
        if !self.law.hints().touches() || start.is_some() && surface.absent_nodes() > 0 {
            return Ok(None);
        }
        let on_coarser = |surface: &Surface| LoopLimit::coarser(surface, Arc::clone(&self.law));
        let Some((coarse, law)) = on_coarser(surface)? else { return Ok(None) };
        // a field of the grid, as heights are one
        let start =
            start.map(|start| on_coarser(&Surface::new(*surface.grid(), start.clone())?)).transpose()?.flatten();
        let start = start.map(|(start, _)| start.heights().to_owned());
        let ahead = self.on_grid(Arc::new(coarse), law, loads, settings, start)?;
        Ok(Some(Coarser::Ahead(Box::new(ahead))))
    }

    /// The session and the course of the same cycle on another grid, from a gap there or the default start.
    fn on_grid(
        &self,
        surface: Arc<Surface>,
        law: Arc<dyn AdhesionLaw<T>>,
        loads: &[Control],
        settings: PathSettings,
        start: Option<Array2<f64>>,
    ) -> Outcome<(Self, Course<T>)> {
        let loads: Vec<_> = loads.iter().map(|load| self.facts.on_whole(*load)).collect();
        let (part, warnings) = (Part::all(*surface.grid()), Warnings::new(Vec::new(), false)?);
        let facts = Facts { part, warnings, seed: None, strongest: None, scars_removed: None, ..self.facts.clone() };
        let session = Self { facts, surface, law, chosen: None };
        let start = start.or_else(|| session.start_afar(&loads)).map(T::field);
        let course = Course::new(Way::Cycle(loads, settings), After::default(), None, |load| load)?;
        Ok((session, course.starting_from(start)))
    }
}

impl<T: Scalar> Rows<T> {
    /// The end of the cycle, which is followed to there; none if an observer ends a solve.
    fn end(&mut self, observe: Watch<'_>) -> Outcome<Option<PathEnd>> {
        while let Some((found, _)) = self.next(&mut *observe)? {
            if found.solution.report.status == Status::Stopped {
                return Ok(None);
            }
        }
        Ok(self.course.end())
    }

    /// The number of nodes along the sides of the coarser grid on which the cycle is followed after its last row, for its
    /// limits, if it is.
    pub fn coarser_shape(&self) -> Option<(usize, usize)> {
        if let Some(Coarser::Ahead(coarser)) = &self.coarser { Some(coarser.0.grid().shape()) } else { None }
    }

    /// The limits of no range of a cycle whose last state is kept; none where no coarser grid tells them, and if an observer
    /// ends a solve. They are told once.
    ///
    /// # Errors
    /// Errors of the solvers of the library.
    pub fn cycle_limit(&mut self, observe: Watch<'_>) -> Outcome<Option<CycleLimits>> {
        let (mut levels, accuracy) = match self.coarser.take() {
            None => return Ok(None),
            Some(Coarser::Behind(chosen)) => (chosen.levels, Some(chosen.accuracy)),
            Some(Coarser::Ahead(ahead)) => {
                let (session, course) = *ahead;
                let shape = session.grid().shape();
                let Some(end) = session.follow(course)?.end(observe)? else { return Ok(None) };
                (vec![(shape, end)], None)
            }
        };
        levels.extend(self.course.end().map(|end| (self.one.problem.grid().shape(), end)));
        Ok(CycleLimits::from_levels(&levels, accuracy))
    }
}
