//! A path of equilibria: small steps along a branch, with its jumps and bifurcations.
//!
//! [`Path`] is an iterator over the states of a branch. The page [`branches`](crate::guide::branches) has loading and
//! unloading worked out.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Projection};
use crate::elastic::{Boundary, ElasticOperator};
use crate::error::{Error, Result};
use crate::problem::{Control, Parts, Problem, smoothed_law};
use crate::real::Real;
use crate::solver::{
    Begin, Iteration, Observer, Solution, Solved, Solver, Start, Status, check_hardness, check_wall, refuse_springs,
};
use crate::stability::Watch;

mod account;
mod course;
mod event;
mod figures;
mod prediction;
mod quadrature;
mod saddle;
mod settings;
mod sharp;
mod step;

use account::Account;
use course::{Course, Way};
pub use event::{Event, Jump};
use figures::Mode;
pub use settings::PathSettings;
use sharp::Sharp;
pub use step::{PathCheckpoint, PathStep};

/// A path of equilibria: an iterator over the states of a branch that is followed from load to load in small steps,
/// with its jumps.
///
/// Each load is any [`Control`] that the problem has; the first one is where the path starts, and from each to the
/// next leads a *leg*. Mean gap below stands for the approach with a free boundary, and for the rest of a spring. A
/// step starts from the extrapolation of the last two states, clipped to feasible gaps; its length adapts to how much
/// the branch bends. A step to a state that has not converged is taken back and halved, unless its residual is at the
/// floor of rounding, as in `f32` in light contact: then it is taken as it is, [`Stalled`](Status::Stalled). The wall
/// is that of the solver: rigid, or [none](crate::NoWall) for a law that keeps the surfaces apart by itself.
///
/// # Jumps
///
/// Along a branch the energy changes by the work of the load, de = −p̄ dḡ. A step in which it falls by more has jumped
/// to another branch, or is too long for the quadrature of the work (by up to four states, of fourth order): it is
/// taken back and halved, down to [`PathSettings::smallest_step`]. There the missing energy is what the jump
/// dissipates, if it is more than the step could do at either end's load; the step is taken, with an [`Event`].
///
/// Where the traction of the law jumps, as that of [`MaugisDugdale`](crate::MaugisDugdale), every node that enters or
/// leaves the adhesive zone is a small jump. Unless [`PathSettings::smooth`] is off, the path and its reports are
/// therefore those of the [smoothed](crate::adhesion::Discretisation::Smooth) law, whose pull-off force converges
/// faster.
///
/// # Limit points
///
/// Under a given pressure a branch ends where dp̄/dḡ = 0. The path does not take the jump there, but goes on at given
/// mean gaps in the same direction, until the pressure comes to where the leg ends, or the surfaces to full contact or
/// out of each other's reach. At limit points under a given mean gap it jumps.
///
/// # Bifurcations
///
/// A branch may go on through saddles: of two equal asperities one alone can jump into contact earlier than both, and
/// every mirrored or periodic surface is of that kind. With adhesion, therefore, the smallest eigenvalue of the
/// energy's second derivative is watched, as in a [`StabilityTest`](crate::stability::StabilityTest) at the given mean
/// gap; that takes some five operator applications a state, unless the softest stiffness and the least φ'' prove it
/// positive. A step to a saddle is taken back and halved; at [`PathSettings::smallest_step`] the state is moved along
/// the mode by a tenth of the range of adhesion, to the side on which the gap closes at the first of the nodes where
/// the mode is largest, and minimised to a state that is no saddle.
///
/// Where the branch came to that place along the mode itself, as at a limit point, the [`Event`] is a jump, and
/// otherwise a bifurcation. Under a given pressure the path goes on from it at given mean gaps. A stretch of saddles
/// shorter than a step may be passed unnoticed: more [`steps`](PathSettings::steps) find shorter ones. A saddle from
/// which no minimum was found is followed, and left at the next state from which there is one. The first state is left
/// without an event if it is a saddle.
///
/// # Yielding
///
/// At a [`Hardness`](crate::Hardness) the path keeps the plastic depth of each state that has converged, or is at the
/// floor of rounding: unloading is elastic on the flattened surface. A mean gap that is given is that to the surface as
/// it was made, less than the mean of the gap by the mean plastic depth, and the energy has that dissipated by yielding.
/// Where the path ends the problem is left as it then is; [`Problem::flatten`] by zeros makes it new.
///
/// # Going on
///
/// A path can be interrupted, kept as a [`PathCheckpoint`], and continued, bit for bit. The page
/// [`branches`](crate::guide::branches) has a cycle with jumps.
///
/// ```
/// use asperity::path::{Path, PathSettings};
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::line(64, 1.0)?;
/// let mut problem = Problem::new(&Surface::wave(grid, 0.02, 1)?, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let (mut solver, settings) = (Solver::default(), PathSettings::default().steps(4));
/// let legs = [0.02, 0.01].map(Control::MeanGap);
/// let whole = Path::new(&mut solver, &mut problem, legs, settings)?.collect::<Result<Vec<_>, _>>()?;
/// let mut first = Path::new(&mut solver, &mut problem, legs, settings)?;
/// first.next().transpose()?;
/// let kept = first.checkpoint();
/// let rest = Path::new(&mut solver, &mut problem, legs, settings)?.continuing(kept)?.collect::<Result<Vec<_>, _>>()?;
/// assert_eq!(rest, whole[1..]);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug)]
pub struct Path<'a, T, O, L, C = Projection> {
    solver: &'a mut Solver<C>,
    problem: &'a mut Problem<T, O, L>,
    legs: Vec<Control>,
    settings: PathSettings,
    start: Option<Array2<T>>,
    course: Course,
    /// the last gaps on the grid of the operator, the latest last: at most two
    gaps: Vec<Array2<T>>,
    watch: Watch<T>,
    failed: bool,
}

/// The number of further solves after one that did not converge, where the step cannot be halved.
const RETRIES: usize = 3;

/// The name of the value of a checkpoint whose last field is a plastic depth.
const YIELDED: &str = "yielded";

/// The roundings that the sums of the energy may have.
const ROUNDINGS: f64 = 8.0;

impl<'a, T, O, L, C> Path<'a, T, O, L, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    C: ContactConstraint<T>,
{
    /// The path through `loads`, of which the first is the start.
    ///
    /// # Errors
    /// [`Error::Value`] for settings out of range, a load that is not finite, or a negative mean gap;
    /// [`Error::Unsuited`] for a load that the problem does not have, and a periodic surface with absent nodes;
    /// [`Error::Unsuited`] for springs, and for a law that is not made for the wall.
    pub fn new(
        solver: &'a mut Solver<C>,
        problem: &'a mut Problem<T, O, L>,
        loads: impl IntoIterator<Item = Control>,
        settings: PathSettings,
    ) -> Result<Self> {
        let (legs, wall): (Vec<_>, _) = (loads.into_iter().collect(), solver.constraint.wall());
        refuse_springs(wall)?;
        check_wall(problem.law_on_grid(), wall)?;
        for load in &legs {
            check_hardness(problem.law_on_grid(), problem.flat.load(*load, wall)?, &problem.flat, wall)?;
            if problem.flat.window.is_some() && problem.flat.boundary == Boundary::Periodic {
                let reason = "a periodic surface with absent nodes has no mean gap along which a path could be followed: \
                              solve at one load after the other, as Sweep does, or take a free half-space";
                return Err(Error::Unsuited { what: "path", reason });
            }
        }
        if settings.steps == 0 {
            return Err(Error::Value { name: "number of steps", value: 0.0, requirement: "at least 1" });
        }
        Error::positive("imbalance", settings.imbalance)?;
        if !(settings.smallest_step > 0.0 && settings.smallest_step < 1.0) {
            let (name, value) = ("smallest step", settings.smallest_step);
            return Err(Error::Value { name, value, requirement: "positive and below 1" });
        }
        let (course, watch) = (Course::on(&problem.flat), Watch::default());
        Ok(Self { solver, problem, legs, settings, start: None, course, gaps: Vec::new(), watch, failed: false })
    }

    /// The path with a gap of shape (Nx, Ny) as the start at the first load.
    pub fn starting_from(self, gap: Array2<T>) -> Self {
        Self { start: Some(gap), ..self }
    }

    /// Ends the present leg: the path heads for the next load from where it is.
    pub fn end_leg(&mut self) {
        self.course.end_leg();
    }

    /// The share of the way that is behind, from 0 to 1: all legs alike, and the present one by its load, or by its mean
    /// gap past a limit point, where the share may fall. A leg that is [ended](Self::end_leg) is behind at once.
    pub fn share(&self) -> f64 {
        self.course.share(self.legs.len())
    }

    /// The present place of the path, from which [`Path::continuing`] goes on.
    pub fn checkpoint(&self) -> PathCheckpoint<T> {
        let window = self.problem.flat.window.as_ref();
        let mode = self.watch.mode.as_ref().map(|mode| match window {
            Some(window) => window.place(&window.hold(mode.view()).into_owned(), T::zero()),
            None => mode.clone(),
        });
        let depth = self.problem.flat.yielded.as_ref().map(|yielded| yielded.depth().clone());
        let mut values = self.course.values();
        values.extend(depth.as_ref().map(|_| (YIELDED.to_owned(), vec![1.0])));
        PathCheckpoint { values, fields: self.gaps.iter().cloned().chain(mode).chain(depth).collect() }
    }

    /// The path continued from the checkpoint of another one with the same problem, loads and settings.
    ///
    /// # Errors
    /// [`Error::Shape`] if the fields are of another grid, [`Error::Value`] if the values are not a checkpoint's.
    pub fn continuing(mut self, from: PathCheckpoint<T>) -> Result<Self> {
        let grid = *self.problem.operator.grid();
        let PathCheckpoint { mut values, mut fields } = from;
        for field in &mut fields {
            grid.fits("field of the checkpoint", field.dim())?;
            if !field.is_standard_layout() {
                *field = field.as_standard_layout().into_owned();
            }
        }
        let depth = values.remove(YIELDED).and_then(|_| fields.pop());
        let course = Course::of_values(&values, Course::on(&self.problem.flat)).filter(|course| {
            let gaps = course.at.len();
            course.leg < self.legs.len().max(1)
                && course.solved != fields.is_empty()
                && (gaps..=gaps + 1).contains(&fields.len())
        });
        let Some(course) = course else {
            let (name, value) = ("number of values in the checkpoint", values.len() as f64);
            return Err(Error::Value { name, value, requirement: "as in PathCheckpoint, with all of its fields" });
        };
        let mode = fields.drain(course.at.len()..).next();
        self.watch = Watch::from_mode(match &self.problem.flat.window {
            Some(window) => mode.map(|mode| window.crop(&mode, T::zero())),
            None => mode,
        });
        if let Some(depth) = depth {
            self.problem.flatten_on_grid(depth)?;
        }
        (self.course, self.gaps) = (course, fields);
        Ok(self)
    }

    /// The next state, with an observer of the iterations; if it stops a solve, the path ends with the state before.
    ///
    /// # Errors
    /// Those of [`Solver::solve_with`]; after one the path ends.
    pub fn next_observed(
        &mut self,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Option<Result<PathStep<T>>> {
        if self.failed {
            return None;
        }
        let step = self.advance(&mut observe);
        self.failed = matches!(step, Some(Err(_)));
        step
    }

    fn advance(&mut self, observe: Observer<'_>) -> Option<Result<PathStep<T>>> {
        if !self.course.solved {
            let control = *self.legs.first()?;
            let start = self.start.take();
            return self.begin(control, start, observe).transpose();
        }
        while !self.failed {
            while self.course.is_at_end() {
                let next = self.course.leg + 1;
                self.course.enter(next, *self.legs.get(next)?, &self.settings);
            }
            match self.attempt(observe) {
                Ok(Some(step)) => return Some(Ok(step)),
                Ok(None) => {}
                Err(error) => return Some(Err(error)),
            }
        }
        None
    }

    /// The first step, unless it was stopped.
    fn begin(
        &mut self,
        control: Control,
        start: Option<Array2<T>>,
        observe: Observer<'_>,
    ) -> Result<Option<PathStep<T>>> {
        let mut solved = self.first(control, start, observe)?;
        let mut on_saddle = solved.is_settled() && self.saddle(&solved.solution)?.is_some();
        if on_saddle {
            let (left, _) = self.leave(&solved.solution, control, observe)?;
            if self.failed {
                return Ok(None);
            }
            (solved, on_saddle) = left.map_or((solved, true), |left| (left, false));
        }
        self.course.begin(&solved.solution.report);
        self.course.on_saddle = on_saddle;
        let solution = self.keep(solved)?;
        Ok(Some(self.step(solution, None)))
    }

    /// The first state. The default start is an equilibrium of the law itself.
    fn first(&mut self, control: Control, start: Option<Array2<T>>, observe: Observer<'_>) -> Result<Solved<T>> {
        let jumps = self.settings.smooth && smoothed_law(&self.problem.operator, self.problem.law_on_grid()).is_some();
        match start {
            Some(start) => self.solve(control, Begin::At(Start::From(&start)), observe),
            None if jumps => {
                let (_, sharp) = self.solve(control, Begin::At(Start::Default), observe)?.with_gap();
                self.solve(control, Begin::Found(sharp), observe)
            }
            None => self.solve(control, Begin::At(Start::Default), observe),
        }
    }

    fn solve(&mut self, control: Control, begin: Begin<'_, T>, observe: Observer<'_>) -> Result<Solved<T>> {
        let Parts { operator, law, flat } = self.problem.parts();
        let sharp = Sharp(law);
        let smoothed = if self.settings.smooth { smoothed_law(&*operator, law) } else { None };
        let law = match &smoothed {
            _ if begin.is_default() => law,
            Some(smoothed) => smoothed,
            None => &sharp,
        };
        let parts = Parts { operator, law, flat };
        self.solver.run(parts, control, begin, observe)
    }

    /// One step; `None` if it has to be taken back and halved.
    fn attempt(&mut self, observe: Observer<'_>) -> Result<Option<PathStep<T>>> {
        let (target, smallest) = self.course.next_target(&self.settings);
        let control = self.course.control(target);
        let start = self.predict(target);
        let mut solved = self.solve(control, Begin::Found(start), observe)?;
        // a long way after a jump may need another run-up
        for _ in 0..RETRIES {
            let short = matches!(solved.solution.report.status, Status::Stalled | Status::IterationLimit);
            if smallest && short && !solved.is_settled() {
                solved = self.solve(control, Begin::Found(solved.with_gap().1), observe)?;
            }
        }
        let (settled, report) = (solved.is_settled(), &solved.solution.report);
        if report.status == Status::Stopped {
            self.failed = true;
            return Ok(None);
        }
        let w = self.problem.law_on_grid().hints().work_of_adhesion.widen();
        let flat = self.problem.flat.work * self.problem.flat.padding;
        // where surfaces hardly touch, the energy is the small difference of sums as large as that of flat surfaces
        let rounding = ROUNDINGS * T::epsilon().widen() * flat;
        // the tolerance's share in the energy of surfaces that are apart: only adhesion makes them jump
        let left = if self.problem.law_on_grid().hints().zero { report.tolerance.powi(2) * flat } else { 0.0 };
        let noise = (rounding, left);
        let scale = (self.settings.imbalance, 1e-3 * w);
        let mut trial = self.course.judge(target, report, scale, noise);
        let good = trial.balanced && settled;
        let saddle = if settled && (good || smallest) { self.saddle(&solved.solution)? } else { None };
        let lost = good && saddle.is_some() && !self.course.on_saddle;
        if (!good || lost) && !smallest {
            self.course.halve(&self.settings);
            return Ok(None);
        }
        let detached = report.status == Status::Detached;
        if self.course.mode == Mode::Pressure && (trial.jumped && !good || detached || lost) {
            let far = 2.0 * (self.problem.flat.height_span + 10.0 * self.problem.law_on_grid().hints().range.widen());
            let close = self.closest(self.course.end());
            self.course.leave_pressure_control((close, far), !lost, &self.settings);
            return Ok(None);
        }
        let mut way = Way { jumped: trial.jumped && !good, bifurcation: None };
        let mut on_saddle = saddle.is_some();
        if let Some(saddle) = saddle {
            let (left, drawn) = self.leave(&solved.solution, control, observe)?;
            if self.failed {
                return Ok(None);
            }
            if let Some(left) = left {
                (solved, on_saddle) = (left, false);
                trial = self.course.judge(target, &solved.solution.report, scale, noise);
                way.jumped |= trial.jumped && !trial.balanced;
                way.bifurcation = (good && !drawn).then_some(saddle.eigenvalue);
            }
        }
        let report = &solved.solution.report;
        if self.course.overshoots(report, &self.settings) {
            return Ok(None);
        }
        let event = self.course.accept(target, report, trial, way, &self.settings);
        self.course.on_saddle = on_saddle;
        if way.is_new() {
            self.gaps.clear();
        } else if self.gaps.len() == 2 {
            self.gaps.remove(0);
        }
        let solution = self.keep(solved)?;
        Ok(Some(self.step(solution, event)))
    }

    /// Keeps the gap of a state, and how far the surface has yielded: gaps are to the surface as it is now.
    fn keep(&mut self, solved: Solved<T>) -> Result<Solution<T>> {
        let stays = solved.is_settled();
        let (solution, mut gap) = solved.with_gap();
        if let Some(depth) = &solution.plastic_depth {
            let lowered = self.problem.lower(depth.view(), stays, &mut gap)?;
            self.gaps.iter_mut().for_each(|gap| *gap += &lowered);
        }
        self.gaps.push(gap);
        Ok(solution)
    }

    fn step(&self, solution: Solution<T>, event: Option<Event>) -> PathStep<T> {
        let Account { work, dissipated, imbalance, .. } = self.course.account;
        PathStep { solution, leg: self.course.leg, work, dissipated, imbalance, event }
    }
}

impl<T, O, L, C> Iterator for Path<'_, T, O, L, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    C: ContactConstraint<T>,
{
    type Item = Result<PathStep<T>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_observed(|_| ControlFlow::Continue(()))
    }
}
