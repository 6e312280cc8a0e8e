//! A search: the load under which a given share of the surface is in contact.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use ndarray::Array2;

use crate::constraint::{ContactConstraint, Wall};
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::problem::{Control, PressedFlat, Problem};
use crate::real::Real;
use crate::solver::{Begin, Branch, Iteration, Method, Observer, Place, Solution, Solved, Solver, Start, Status};

/// The relative error of the contact fraction at which a search ends.
const TOLERANCE: f64 = 0.01;

/// The error to which a state is solved that is this many times the tolerance from the wanted one.
const ROUGHLY: f64 = 1e-3;
const FAR: f64 = 2.0;

/// The growth of the logarithm of the load above which a solve without adhesion starts anew.
const LONG: f64 = 0.7;

/// The most solves of a search; a bracket is halved at least with every other one.
const MOST: usize = 60;

/// The width of a bracket in which the contact jumps, in the logarithm of the load or relative to the approach.
const WIDTH: f64 = 1e-5;

/// The share of a bracket that a step leaves to both sides at least.
const MARGIN: f64 = 0.02;

/// The largest step outside of a bracket, in the same units, and the most that it grows to.
const STEP: (f64, f64) = (1.4, 8.0);

/// The least mean gap of a search, over the rms height, where surfaces yield: it is to the surface as it was made, and
/// the contact may grow on below zero.
const CLOSEST: f64 = 0.01;

/// The load under which a given share of the nodes is in contact, found by solves.
///
/// Without adhesion the search is for the mean pressure, from Persson's A = erf(p/(√2 p_rms)) on, with p_rms the rms
/// pressure that presses the surface flat: by the secant of ln(−ln(1 − A)) over ln p, nearly straight for rough
/// surfaces, and by a bracket as soon as there is one. At a [`Hardness`](crate::Hardness) H it ends at A·H, under which
/// no less is in contact.
///
/// With adhesion the contact jumps, and the search is for the mean gap, with a free boundary for the approach, under
/// which more states are equilibria. It goes from its start towards the fraction, and never on from a state beyond it,
/// to stay on its [branch](Branch): loading, if the settings name none.
///
/// The fraction is reached within one node or 1 %. Where the contact jumps past it, the state on the nearer side is
/// returned, [`reached`](FoundContact::reached) is false, and [`below`](FoundContact::below) and
/// [`above`](FoundContact::above) are the ends of the jump. At a rigid wall a state that is 2 % off or more, once its
/// error is 1e-3, is not solved further. A search continues from where the last one ended; with the feature `serde` it is
/// its own checkpoint.
///
/// Memory: four fields besides the fields of a solve, on a free half-space five, two of them on the grid of the
/// operator.
///
/// ```
/// use asperity::{ContactSearch, Grid, NoAdhesion, Problem, SelfAffine, Solver, Westergaard};
/// let grid = Grid::square(128, 1.0)?;
/// let surface = SelfAffine::default().k_s(16.0).surface(grid)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::default();
/// let mut search = ContactSearch::default();
/// for fraction in [0.05, 0.1, 0.2] {
///     let found = search.at(&mut solver, &mut problem, fraction)?;
///     assert!(found.reached && (found.solution.report.contact_fraction / fraction - 1.0).abs() < 0.01);
/// }
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactSearch<T> {
    /// The given gap from which solves start until one replaces it, on the grid of the surface.
    start: Option<Array2<T>>,
    /// The place from which they start otherwise; beyond a window its gap is the displacement.
    place: Option<Place<T>>,
    /// The last two results, the latest last.
    points: Vec<Point>,
}

/// The result of a search for a contact fraction.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct FoundContact<T: Real> {
    /// The state, the wanted one if reached, under a mean pressure, with adhesion a mean gap or an approach.
    pub solution: Solution<T>,
    /// Whether the solve has converged, and its contact fraction is the wanted one to the tolerance.
    pub reached: bool,
    /// The contact fraction found next below the wanted one, if any.
    pub below: Option<f64>,
    /// The contact fraction found next above the wanted one, if any.
    pub above: Option<f64>,
    /// The number of solves of the search.
    pub solves: usize,
    /// The operator applications of all of them.
    pub operator_applications: usize,
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Point {
    x: f64,
    /// ln(−ln(1 − A)) of the contact fraction A
    level: f64,
    nodes: usize,
}

fn level(fraction: f64) -> f64 {
    (-(-fraction).ln_1p()).ln()
}

#[derive(Clone, Copy, Debug)]
enum Axis {
    /// the logarithm of the mean pressure
    Pressure { flat: f64 },
    /// minus the logarithm of the mean gap
    Gap { rms_height: f64 },
    /// the approach over the span of the heights
    Approach { span: f64 },
}

impl Axis {
    fn of<T: Real>(flat: &PressedFlat<T>, adhesion: bool) -> Result<Self> {
        let &PressedFlat { rms_height, stiffness, height_span: span, .. } = flat;
        Error::positive("rms height of the surface", rms_height)?;
        match (adhesion, flat.boundary) {
            // the waves of free heights begin and end at the edge of the window, waves of the padding do not count
            (false, _) => Ok(Self::Pressure { flat: stiffness * rms_height }),
            (true, Boundary::Periodic) if flat.window.is_some() => Err(Error::Unsuited {
                what: "contact-fraction",
                reason: "with adhesion it is searched for by the mean gap, which a periodic surface with absent nodes \
                         does not have: give a pressure",
            }),
            (true, Boundary::Periodic) => Ok(Self::Gap { rms_height }),
            (true, _) => Ok(Self::Approach { span }),
        }
    }

    fn control(self, x: f64) -> Control {
        match self {
            Self::Pressure { .. } => Control::MeanPressure(x.exp()),
            Self::Gap { .. } => Control::MeanGap((-x).exp()),
            Self::Approach { span } => Control::Approach(x * span),
        }
    }

    fn first(self, fraction: f64) -> f64 {
        match self {
            // the inverse of Persson's error function, exact at small and at large loads
            Self::Pressure { flat } => {
                let depth = -(-fraction).ln_1p();
                (FRAC_PI_2.sqrt() * flat * depth / (1.0 + depth).sqrt()).ln()
            }
            // as the contact of rough surfaces falls off with the gap
            Self::Gap { rms_height } => -(-0.5 * rms_height * fraction.ln()).ln(),
            // as the contact of a paraboloid grows with the approach
            Self::Approach { .. } => fraction,
        }
    }

    fn slope(self, x: f64) -> f64 {
        match self {
            Self::Pressure { .. } => 1.0,
            Self::Gap { rms_height } => (2.0 * (-x).exp() / rms_height).clamp(0.1, 10.0),
            Self::Approach { .. } => self.scale(x).recip(),
        }
    }

    /// The length along the axis that is one in ln(load).
    fn scale(self, x: f64) -> f64 {
        if let Self::Approach { .. } = self { x.abs().max(1e-3) } else { 1.0 }
    }
}

impl<T> Default for ContactSearch<T> {
    fn default() -> Self {
        Self { start: None, place: None, points: Vec::new() }
    }
}

impl<T: Real> ContactSearch<T> {
    /// A search from a gap of shape (Nx, Ny), in the place of the default start.
    pub fn starting_from(gap: Array2<T>) -> Self {
        Self { start: Some(gap), ..Self::default() }
    }

    /// The gap from which the next search starts, on the grid of the operator: processes that share a grid gather this of
    /// a search that they keep.
    pub fn fields(&mut self) -> impl Iterator<Item = &mut Array2<T>> {
        self.place.iter_mut().map(|place| &mut place.gap)
    }

    /// Where surfaces have not parted, of a law that attracts [next to contacts alone](crate::adhesion::Hints::touching), on the
    /// grid of the operator: processes that share a grid gather these as they do the fields.
    pub fn marks(&mut self) -> impl Iterator<Item = &mut Array2<bool>> {
        self.place.iter_mut().filter_map(|place| place.not_parted.as_mut())
    }

    /// The state in which a share of the nodes is in contact.
    ///
    /// # Errors
    /// [`Error::Value`] for a fraction that is not between 0 and 1, or less than a node, and for a flat surface;
    /// [`Error::Unsuited`] without a wall, where nothing is in contact, and with adhesion on a periodic surface with
    /// absent nodes; errors of [`Solver::solve_with`].
    pub fn at(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        fraction: f64,
    ) -> Result<FoundContact<T>> {
        self.at_observed(solver, problem, fraction, |_| ControlFlow::Continue(()))
    }

    /// The same with an observer of the iterations; where it breaks off the search ends, short of the wanted state.
    ///
    /// # Errors
    /// As [`Self::at`].
    pub fn at_observed(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        fraction: f64,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<FoundContact<T>> {
        T::search(self, solver, problem, fraction, &mut observe)
    }

    pub(crate) fn find(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        fraction: f64,
        observe: Observer<'_>,
    ) -> Result<FoundContact<T>> {
        if let Wall::None = solver.constraint.wall() {
            let reason = "without a wall there is no contact to be counted: give a pressure or a gap";
            return Err(Error::Unsuited { what: "contact-fraction", reason });
        }
        if let Some(place) = &self.place {
            problem.operator.grid().fits("gap of the search", place.gap.dim())?;
        }
        let adhesion = !problem.law_on_grid().hints().zero;
        let axis = Axis::of(&problem.flat, adhesion)?;
        let nodes = problem.grid().nodes();
        let facing = problem.flat.window.as_ref().map_or(nodes, |window| window.facing()) as f64;
        let wanted = fraction * facing;
        if !(wanted >= 1.0 && fraction < 1.0) {
            let requirement = "at least one node, and less than 1";
            return Err(Error::Value { name: "contact fraction", value: fraction, requirement });
        }
        let (goal, allowed) = (level(fraction), (TOLERANCE * wanted).max(1.0));
        let mut bracket = Bracket::default();
        let (end, anew) = match (axis, solver.constraint.wall().hardness()) {
            // surfaces that yield bear no more with fewer nodes in contact
            (Axis::Pressure { .. }, Some(hardness)) => {
                ((facing / nodes as f64 * hardness.bears(fraction.min(1.0 - facing.recip()))).ln(), false)
            }
            // to so much less of the mean gap no scaled gap of surfaces that have yielded leads
            (Axis::Gap { rms_height }, Some(_)) => (-(CLOSEST * rms_height).ln(), true),
            _ => (f64::INFINITY, false),
        };
        let mut x = axis.first(fraction).min(end);
        if let [.., last] = self.points[..] {
            bracket.add(last, wanted);
            x = bracket.next(axis, goal, self.slope(axis)).min(end);
        }
        let branch = self.branch(solver).filter(|_| adhesion);
        // the side from which the path comes
        let mut from_below = match self.points.last() {
            Some(last) => Some((last.nodes as f64) < wanted),
            None => branch.map(|branch| branch == Branch::Loading),
        };
        let mut nearest: Option<(Point, Solved<T>)> = None;
        let (mut solves, mut applications, mut stopped) = (0, 0, false);
        let rigid = solver.constraint.wall().is_rigid();
        let reached = loop {
            let begin = match (&self.start, &self.place) {
                (Some(gap), _) => Begin::At(Start::From(gap)),
                (None, Some(place)) if !anew && !self.is_long_way(x, adhesion) => Begin::Found(place.clone()),
                (None, _) => branch.map_or(Begin::At(Start::Default), Begin::On),
            };
            let distance = |nodes: usize| (nodes as f64 - wanted).abs();
            // the phases before a solution have another law, or wall
            let of_solution = rigid && (!adhesion || !begin.is_default());
            let mut is_far = false;
            let mut watch = |state: &Iteration| {
                let next = observe(state);
                let roughly = state.relative_error.max(state.load_error) <= ROUGHLY && !state.smoothed;
                is_far = roughly && of_solution && distance(state.contact_nodes) > FAR * allowed && next.is_continue();
                if is_far { ControlFlow::Break(()) } else { next }
            };
            let solved = solver.run(problem.parts(), axis.control(x), begin, &mut watch)?;
            let report = &solved.solution.report;
            solves += 1;
            applications += report.operator_applications;
            let (count, converged) = (report.contact_nodes, is_far || report.status == Status::Converged);
            let point = Point { x, level: level(count as f64 / facing), nodes: count };
            let hit = converged && count > 0 && (count as f64) < facing && distance(count) <= allowed;
            if hit || !converged {
                stopped = report.status == Status::Stopped;
                nearest = Some((point, solved));
                break hit;
            }
            let below = (count as f64) < wanted;
            // with adhesion a state beyond the wanted one is on the way back already
            if !adhesion || *from_below.get_or_insert(below) == below {
                (self.start, self.place) = (None, Some(solved.place()));
            }
            bracket.add(point, wanted);
            if nearest.as_ref().is_none_or(|(kept, _)| distance(count) <= distance(kept.nodes)) {
                nearest = Some((point, solved));
            }
            self.remember(point);
            x = bracket.next(axis, goal, self.slope(axis)).min(end);
            if solves == MOST || bracket.is_narrow(axis) || bracket.below.is_some_and(|below| below.x == x) {
                break false;
            }
        };
        let Some((point, mut solved)) = nearest else {
            // the loop ends with a solution
            return Err(Error::Value { name: "contact fraction", value: fraction, requirement: "found by a solve" });
        };
        if solved.solution.report.status == Status::Stopped && !stopped {
            let begin = Begin::Found(solved.place());
            solved = solver.run(problem.parts(), axis.control(point.x), begin, &mut *observe)?;
            solves += 1;
            applications += solved.solution.report.operator_applications;
        }
        self.remember(point);
        let (mut solution, place) = solved.with_place();
        solution.report.branch = branch;
        (self.start, self.place) = (None, Some(place));
        let share = |point: Point| point.nodes as f64 / facing;
        Ok(FoundContact {
            solution,
            reached,
            below: bracket.below.map(share),
            above: bracket.above.map(share),
            solves,
            operator_applications: applications,
        })
    }

    /// The branch of the default start with adhesion: loading, if the settings name none, but for the paper's method
    /// and where springs stand for the wall.
    fn branch(&self, solver: &Solver<dyn ContactConstraint<T>>) -> Option<Branch> {
        let Solver { settings, constraint } = solver;
        let begins = self.points.is_empty() && self.start.is_none() && self.place.is_none();
        let usual = settings.method != Method::Rey2017 && constraint.wall().is_rigid();
        settings.branch.or(usual.then_some(Branch::Loading)).filter(|_| begins)
    }

    /// Whether a load without adhesion presses so much more than the last one that its gap says little.
    fn is_long_way(&self, x: f64, adhesion: bool) -> bool {
        !adhesion && self.points.last().is_some_and(|last| x - last.x > LONG)
    }

    fn remember(&mut self, point: Point) {
        self.points.retain(|known| known.x != point.x);
        self.points.push(point);
        self.points.drain(..self.points.len().saturating_sub(2));
    }

    /// How much the level changes along the axis: as between the last two results, if credible.
    fn slope(&self, axis: Axis) -> f64 {
        let Some(last) = self.points.last() else { return 1.0 };
        let usual = axis.slope(last.x);
        let [before, last] = self.points[..] else { return usual };
        let secant = (last.level - before.level) / (last.x - before.x);
        if secant.is_finite() { secant.clamp(0.2 * usual, 5.0 * usual) } else { usual }
    }
}

/// The bracket of the wanted place.
#[derive(Clone, Copy, Debug, Default)]
struct Bracket {
    below: Option<Point>,
    above: Option<Point>,
    widths: [Option<f64>; 2],
    /// How often the end was sought outside of what is known
    widened: i32,
}

impl Bracket {
    fn add(&mut self, point: Point, wanted: f64) {
        let width = self.width();
        *(if (point.nodes as f64) < wanted { &mut self.below } else { &mut self.above }) = Some(point);
        self.widths = [width, self.widths[0]];
    }

    fn width(&self) -> Option<f64> {
        Some(self.above?.x - self.below?.x)
    }

    /// Whether the contact jumps within it.
    fn is_narrow(&self, axis: Axis) -> bool {
        let ends = self.below.zip(self.above);
        ends.is_some_and(|(below, above)| above.x - below.x <= WIDTH * axis.scale(above.x))
    }

    fn next(&mut self, axis: Axis, goal: f64, slope: f64) -> f64 {
        match (self.below, self.above) {
            (Some(below), Some(above)) => {
                let share = (goal - below.level) / (above.level - below.level);
                // a secant that does not halve the bracket in two steps gives way to the middle
                let slow = self.widths[1].zip(self.width()).is_some_and(|(before, now)| now > 0.5 * before);
                let share = if slow || !share.is_finite() { 0.5 } else { share.clamp(MARGIN, 1.0 - MARGIN) };
                below.x + share * (above.x - below.x)
            }
            (Some(end), None) | (None, Some(end)) => {
                let way = if self.below.is_some() { 1.0 } else { -1.0 };
                let most = axis.scale(end.x) * (STEP.0 * 2f64.powi(self.widened)).min(STEP.1);
                self.widened += 1;
                let step = ((goal - end.level) / slope).abs();
                end.x + way * if step.is_finite() { step.clamp(MARGIN * most, most) } else { most }
            }
            (None, None) => 0.0,
        }
    }
}
