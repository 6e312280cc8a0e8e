//! A path of equilibria: small steps along a branch, with its jumps and bifurcations.
//!
//! [`Path`] goes from state to state of a branch. The page [`branches`](crate::guide::branches) has loading and
//! unloading worked out.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::constraint::ContactConstraint;
use crate::error::{Error, Result};
use crate::problem::{Control, Problem};
use crate::real::{Real, once};
use crate::solver::{
    Begin, Iteration, Place, Solution, Solved, Solver, Status, check_hardness, check_wall, refuse_springs,
};
use crate::stability::Watch;

mod account;
mod balance;
mod bench;
mod bracket;
mod course;
mod event;
mod figures;
mod prediction;
mod quadrature;
mod saddle;
mod settings;
mod sharp;
mod step;
mod trial;

use account::Account;
pub use account::PathEnd;
use bench::Bench;
use course::{Course, Way};
pub use event::{Event, Jump};
pub use settings::PathSettings;
pub use step::PathStep;
use trial::{Judgement, Trial};

once! {
    /// The next state of a path.
    follow<'a, T>(path: &'a mut Path<T>, bench: &'a mut Bench<'a, T>) -> Result<Option<PathStep<T>>> =
        [within] Path::advance;
}

/// A path of equilibria: the states of a branch that is followed from load to load in small steps, with its jumps.
///
/// Each load is any [`Control`] that the problem has; the first one is where the path starts, and from each to the
/// next leads a *leg*. Mean gap below stands for the approach with a free boundary, and for the rest of a spring. A
/// step starts from the extrapolation of the last two states, clipped to feasible gaps; its length adapts to how much
/// the branch bends. A step to a state that has not converged is taken back and halved, unless its residual is at the
/// floor of rounding, as in `f32` in light contact: then it is taken as it is, [`Stalled`](Status::Stalled). The solver
/// has the wall: rigid, or [none](crate::NoWall) for a law that keeps the surfaces apart by itself.
///
/// # Jumps
///
/// Along a branch the energy changes by the work of the load, de = −p̄ dḡ. A step in which it falls by more has jumped
/// to another branch, or is too long for the quadrature of the work (by up to four states, of fourth order): it is
/// taken back and halved. A jump is located once the work of the load in the step is known to a fifth of the energy
/// that the jump dissipates, which has to be as large as in twice the step, and the largest tension to a hundredth; or
/// at [`PathSettings::smallest_step`], if it is given. The step is then taken, with an [`Event`]. As the jump may be
/// anywhere in it, the mean of the loads at its ends does the work, and the [standard error](PathStep::work_error) of
/// that is told. A step is also halved where the tension breaks off a tenth below what it was to reach, or more.
///
/// Where the traction of the law jumps, as with [`MaugisDugdale`](crate::MaugisDugdale), every node that enters or
/// leaves the adhesive zone is a small jump. Unless [`PathSettings::smooth`] is off, the path and its reports therefore
/// take the [smoothed](crate::adhesion::Discretisation::Smooth) law: its pull-off force converges faster.
///
/// # Limit points
///
/// Under a given pressure a branch ends where dp̄/dḡ = 0. The path does not take the jump there, but continues at given
/// mean gaps in the same direction, until the pressure comes to where the leg ends, or the surfaces to full contact or
/// out of each other's reach. At limit points under a given mean gap it jumps.
///
/// # Bifurcations
///
/// A branch may continue through saddles: of two equal asperities one alone can jump into contact earlier than both,
/// and every mirrored or periodic surface is of that kind. With adhesion, therefore, the smallest eigenvalue of the
/// energy's second derivative is watched, as in a [`StabilityTest`](crate::stability::StabilityTest) at the given mean
/// gap; that takes some five operator applications a state, unless the softest stiffness and the least φ'' prove it
/// positive. A step to a saddle is taken back and halved; at [`PathSettings::smallest_step`] the state is moved along
/// the mode by a tenth of the range of adhesion, to the side on which the gap closes at the first of the nodes where
/// the mode is largest, and minimised to a state that is no saddle.
///
/// Where the branch came to that place along the mode itself, as at a limit point, the [`Event`] is a jump, and
/// otherwise a bifurcation. Under a given pressure the path continues from it at given mean gaps. A stretch of saddles
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
/// Solver and problem are given with each step. A path keeps three gaps at most, the softest mode with the random field
/// in which it is sought, and the plastic depth if there is one. It is its own checkpoint: a copy, or with the feature
/// `serde` one that was kept and read again, continues bit for bit, also at a problem that is made anew. The page
/// [`branches`](crate::guide::branches) has a cycle with jumps.
///
/// ```
/// use asperity::path::{Path, PathSettings};
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Westergaard};
/// let grid = Grid::line(64, 1.0)?;
/// let mut problem = Problem::new(&Surface::wave(grid, 0.02, 1)?, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let (mut solver, settings) = (Solver::default(), PathSettings::default().steps(4));
/// let legs = [0.02, 0.01].map(Control::MeanGap);
/// let mut path = Path::new(legs, settings)?;
/// path.next(&mut solver, &mut problem)?;
/// let mut kept = path.clone();
/// while let Some(step) = path.next(&mut solver, &mut problem)? {
///     assert_eq!(kept.next(&mut solver, &mut problem)?, Some(step));
/// }
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Path<T> {
    legs: Vec<Control>,
    settings: PathSettings,
    start: Option<Array2<T>>,
    course: Course,
    /// the last gaps on the grid of the operator, the latest last: at most two
    places: Vec<Place<T>>,
    /// the gap at the end of the shortest step that was taken back, from which the state there is found anew
    ahead: Option<Place<T>>,
    /// the plastic depth of the last state, on the grid of the operator
    depth: Option<Array2<T>>,
    watch: Watch<T>,
    failed: bool,
}

/// The most further solves at a load: after one that did not converge, where the step cannot be halved, and from a saddle.
const RETRIES: usize = 4;

impl<T: Real> Path<T> {
    /// The path through `loads`, from the first on.
    ///
    /// # Errors
    /// [`Error::Value`] for settings out of range.
    pub fn new(loads: impl IntoIterator<Item = Control>, settings: PathSettings) -> Result<Self> {
        if settings.steps == 0 {
            return Err(Error::Value { name: "number of steps", value: 0.0, requirement: "at least 1" });
        }
        Error::positive("imbalance", settings.imbalance)?;
        if let Some(value) = settings.smallest_step.filter(|share| !(*share > 0.0 && *share < 1.0)) {
            return Err(Error::Value { name: "smallest step", value, requirement: "positive and below 1" });
        }
        Ok(Self {
            legs: loads.into_iter().collect(),
            settings,
            start: None,
            course: Course::default(),
            places: Vec::new(),
            ahead: None,
            depth: None,
            watch: Watch::default(),
            failed: false,
        })
    }

    /// The path with a gap of shape (Nx, Ny) as the start at the first load.
    pub fn starting_from(self, gap: Array2<T>) -> Self {
        Self { start: Some(gap), ..self }
    }

    /// Ends the present leg: the path heads for the next load from where it is.
    pub fn end_leg(&mut self) {
        self.course.end_leg();
    }

    /// The figures of the path so far.
    pub fn end(&self) -> PathEnd {
        let Account { work, dissipated, variance, tension, touches, .. } = self.course.account;
        PathEnd { work, work_error: variance.sqrt(), dissipated, greatest_tension: tension.max(0.0), touches }
    }

    /// The share of the way that is behind, from 0 to 1: all legs alike, and the present one by its load, or by its mean
    /// gap past a limit point, where the share may fall. A leg that is [ended](Self::end_leg) is behind at once.
    pub fn share(&self) -> f64 {
        self.course.share(self.legs.len())
    }

    /// The last gaps, one ahead and the plastic depth, on the grid of the operator, and the softest mode, on the grid
    /// of the surface: processes that share a grid gather these of a path that they keep.
    #[doc(hidden)]
    pub fn fields(&mut self) -> impl Iterator<Item = &mut Array2<T>> {
        let gaps = self.places.iter_mut().chain(&mut self.ahead).map(|place| &mut place.gap);
        gaps.chain(&mut self.depth).chain(&mut self.watch.mode)
    }

    /// Where surfaces have not parted, on the grid of the operator: processes that share a grid gather these, too.
    #[doc(hidden)]
    pub fn marks(&mut self) -> impl Iterator<Item = &mut Array2<bool>> {
        self.places.iter_mut().chain(&mut self.ahead).filter_map(|place| place.not_parted.as_mut())
    }

    /// Refuses loads that the problem does not have, as the first step does.
    ///
    /// # Errors
    /// [`Error::Value`] for a load that is not finite, or a negative mean gap; [`Error::Unsuited`] for a load or a law that
    /// does not fit, springs, and a periodic surface with absent nodes.
    #[doc(hidden)]
    pub fn check(&self, solver: &Solver<dyn ContactConstraint<T>>, problem: &Problem<T>) -> Result<()> {
        let (law, flat, wall) = (problem.law_on_grid(), &problem.flat, solver.constraint.wall());
        refuse_springs(wall)?;
        check_wall(law, wall)?;
        for &load in &self.legs {
            check_hardness(law, flat.load(load, wall)?, flat, wall)?;
        }
        if !flat.faces_all() && flat.boundary.is_periodic() {
            let reason = "a periodic surface with absent nodes has no mean gap along which a path could be followed: \
                          solve at one load after the other, as Sweep does, or take a free half-space";
            return Err(Error::Unsuited { what: "path", reason });
        }
        Ok(())
    }

    /// The next state; none at the end.
    ///
    /// # Errors
    /// As [`Self::check`] and [`Solver::solve_with`], after which the path ends; [`Error::Shape`] for a problem on
    /// another grid than the state before.
    pub fn next(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
    ) -> Result<Option<PathStep<T>>> {
        self.next_observed(solver, problem, |_| ControlFlow::Continue(()))
    }

    /// The same with an observer of the iterations; if it stops a solve, the path ends with the state before.
    ///
    /// # Errors
    /// As [`Self::next`].
    pub fn next_observed(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<Option<PathStep<T>>> {
        if self.failed {
            return Ok(None);
        }
        let step = follow(self, &mut Bench { solver, problem, observe: &mut observe });
        self.failed |= step.is_err();
        step
    }

    fn advance(&mut self, bench: &mut Bench<'_, T>) -> Result<Option<PathStep<T>>> {
        if !self.course.solved {
            let Some(&load) = self.legs.first() else { return Ok(None) };
            self.check(bench.solver, bench.problem)?;
            return self.begin(bench, load);
        }
        for field in self.places.iter().chain(&self.ahead).map(|place| &place.gap).chain(&self.depth) {
            bench.problem.operator.grid().fits("field of the path", field.dim())?;
        }
        self.watch.check(bench.problem.grid())?;
        bench.problem.yield_to(self.depth.as_ref())?;
        while !self.failed {
            while self.course.is_at_end() {
                let next = self.course.leg + 1;
                let Some(&load) = self.legs.get(next) else { return Ok(None) };
                self.course.enter(next, load, &self.settings);
            }
            if let Some(step) = self.attempt(bench)? {
                return Ok(Some(step));
            }
        }
        Ok(None)
    }

    /// The first step, unless it was stopped.
    fn begin(&mut self, bench: &mut Bench<'_, T>, control: Control) -> Result<Option<PathStep<T>>> {
        self.course = Course::on(&bench.problem.flat);
        let mut solved = bench.first(self.start.take(), &self.settings, control)?;
        let mut on_saddle = solved.is_settled() && self.saddle(bench, &solved.solution)?.is_some();
        if on_saddle {
            let (left, _) = self.leave(bench, &solved.solution, control)?;
            if self.failed {
                return Ok(None);
            }
            (solved, on_saddle) = left.map_or((solved, true), |left| (left, false));
        }
        self.course.begin(&solved.solution.report);
        self.course.on_saddle = on_saddle;
        let solution = self.keep(bench.problem, solved)?;
        Ok(Some(self.step(solution, None)))
    }

    /// One step, unless its trial is not taken.
    fn attempt(&mut self, bench: &mut Bench<'_, T>) -> Result<Option<PathStep<T>>> {
        let Some(trial) = self.try_step(bench)? else { return Ok(None) };
        match trial.judge(&self.course) {
            Judgement::Take => return self.take(bench, trial),
            Judgement::Halve => {
                self.course.halve(&trial.solved.solution.report, trial.balance, &self.settings);
                // the place of the jump does matter where it is asked for, and at the largest tension
                let kept = trial.settled() && self.settings.smallest_step.is_none() && !trial.balance.peaks;
                self.ahead = kept.then(|| trial.solved.with_place().1);
            }
            Judgement::Turn { limit_point } => {
                let range = bench.problem.law_on_grid().hints().range.widen();
                let far = 2.0 * (bench.problem.flat.height_span + 10.0 * range);
                let close = bench.closest(self.course.end());
                self.course.leave_pressure_control((close, far), limit_point, &self.settings);
            }
        }
        Ok(None)
    }

    /// Solves at the next target; the path has failed where the observer stopped the solve.
    fn try_step(&mut self, bench: &mut Bench<'_, T>) -> Result<Option<Trial<T>>> {
        let (target, smallest) = self.course.next_target(&self.settings);
        let control = self.course.control(target);
        let (start, came_there) = self.predict(bench, target);
        let mut solved = bench.solve(&self.settings, control, start)?;
        // a long way after a jump may need another run-up
        for _ in 0..RETRIES {
            let short = matches!(solved.solution.report.status, Status::Stalled | Status::IterationLimit);
            if smallest && short && !solved.is_settled() {
                solved = bench.solve(&self.settings, control, Begin::Found(solved.with_place().1))?;
            }
        }
        if solved.solution.report.status == Status::Stopped {
            self.failed = true;
            return Ok(None);
        }
        let balance = bench.balance(&self.course, &self.settings, target, &solved.solution.report);
        let touches = solved.touches || came_there;
        let mut trial = Trial { target, smallest, touches, solved, balance, saddle: None };
        if trial.may_be_taken() {
            trial.saddle = self.saddle(bench, &trial.solved.solution)?;
        }
        Ok(Some(trial))
    }

    /// Takes a step, from a saddle on to a state that is none; nothing if it is shortened instead, or was stopped.
    fn take(&mut self, bench: &mut Bench<'_, T>, trial: Trial<T>) -> Result<Option<PathStep<T>>> {
        let (good, target) = (trial.is_good(), trial.target);
        let Trial { mut solved, mut balance, saddle, touches, .. } = trial;
        let mut way = Way { jumped: balance.jumped && !good, touches, bifurcation: None };
        let mut on_saddle = saddle.is_some();
        if let Some(saddle) = saddle {
            let (left, drawn) = self.leave(bench, &solved.solution, self.course.control(target))?;
            if self.failed {
                return Ok(None);
            }
            if let Some(left) = left {
                (solved, on_saddle) = (left, false);
                balance = bench.balance(&self.course, &self.settings, target, &solved.solution.report);
                way.jumped |= balance.jumped && !balance.balanced;
                way.bifurcation = (good && !drawn).then_some(saddle.eigenvalue);
            }
        }
        let report = &solved.solution.report;
        if self.course.overshoots(report, &self.settings) {
            return Ok(None);
        }
        let event = self.course.accept(target, report, balance, way, &self.settings);
        self.course.on_saddle = on_saddle;
        if way.is_new() {
            self.places.clear();
        } else if self.places.len() == 2 {
            self.places.remove(0);
        }
        if self.course.taken_back().is_none() {
            self.ahead = None;
        }
        let solution = self.keep(bench.problem, solved)?;
        Ok(Some(self.step(solution, event)))
    }

    /// Keeps the gap of a state, and how far the surface has yielded: gaps are to the surface as it is now.
    fn keep(&mut self, problem: &mut Problem<T>, solved: Solved<T>) -> Result<Solution<T>> {
        let stays = solved.is_settled();
        let (solution, mut place) = solved.with_place();
        if let Some(depth) = &solution.plastic_depth {
            let lowered = problem.lower(depth.view(), stays, &mut place.gap)?;
            self.places.iter_mut().chain(&mut self.ahead).for_each(|place| place.gap += &lowered);
        }
        self.depth = problem.yielded().cloned();
        self.places.push(place);
        Ok(solution)
    }

    fn step(&self, solution: Solution<T>, event: Option<Event>) -> PathStep<T> {
        let Account { work, dissipated, imbalance, variance, .. } = self.course.account;
        PathStep { solution, leg: self.course.leg, work, dissipated, imbalance, work_error: variance.sqrt(), event }
    }
}
