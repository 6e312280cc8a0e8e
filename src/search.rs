//! A search: the load under which a given share of the surface is in contact.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::constraint::ContactConstraint;
use crate::degrees::{ROUGHLY, TWICE};
use crate::error::{Error, Result};
use crate::problem::Problem;
use crate::real::{Real, once};
use crate::solver::{Begin, Branch, Iteration, Method, Observer, Place, Solution, Solved, Solver, Start, Status};
use crate::sweep::ANEW;

mod axis;
mod bracket;

use axis::Axis;
use bracket::{Bracket, Point};

once! {
    /// A search for a contact fraction.
    find<'a, T>(
        search: &'a mut ContactSearch<T>, solver: &'a mut Solver<dyn ContactConstraint<T>>,
        problem: &'a mut Problem<T>, fraction: f64, observe: Observer<'a>,
    ) -> Result<FoundContact<T>> = [within] ContactSearch::find;
}

/// The most solves of a search; a bracket is halved at least with every other one.
pub(crate) const MOST_SOLVES: usize = 60;

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

/// A solve of a search.
struct Trial<T: Real> {
    point: Point,
    solved: Solved<T>,
    /// whether it ended early, far from the wanted contact
    rough: bool,
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
    #[doc(hidden)]
    pub fn fields(&mut self) -> impl Iterator<Item = &mut Array2<T>> {
        self.place.iter_mut().map(|place| &mut place.gap)
    }

    /// Where surfaces have not parted, of a law that attracts [next to contacts
    /// alone](crate::adhesion::Hints::touching), on the grid of the operator: processes that share a grid gather
    /// these as they do the fields.
    #[doc(hidden)]
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
        find(self, solver, problem, fraction, &mut observe)
    }

    fn find(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        fraction: f64,
        observe: Observer<'_>,
    ) -> Result<FoundContact<T>> {
        if !solver.constraint.wall().keeps_apart() {
            let reason = "without a wall there is no contact to be counted: give a pressure or a gap";
            return Err(Error::Unsuited { what: "contact-fraction", reason });
        }
        if let Some(place) = &self.place {
            problem.operator.grid().fits("gap of the search", place.gap.dim())?;
        }
        let mut bracket = Bracket::of(problem, solver.constraint.wall(), fraction)?;
        let branch = self.branch(solver).filter(|_| bracket.axis.adheres());
        let mut x = bracket.first(&self.points, branch);
        let (mut nearest, mut solves, mut applications) = (None::<Trial<T>>, 0, 0);
        let (reached, Trial { point, mut solved, rough }) = loop {
            let trial = self.solve_at(x, (&bracket, branch), solver, problem, &mut *observe)?;
            solves += 1;
            applications += trial.solved.solution.report.operator_applications;
            let converged = trial.rough || trial.solved.solution.report.status == Status::Converged;
            let hit = converged && bracket.target.is_met_by(trial.point);
            if hit || !converged {
                break (hit, trial);
            }
            if bracket.add(trial.point) {
                (self.start, self.place) = (None, Some(trial.solved.place()));
            }
            self.remember(trial.point);
            let off = |trial: &Trial<T>| bracket.target.off(trial.point.nodes);
            let near = nearest.take().filter(|kept| off(kept) < off(&trial)).unwrap_or(trial);
            match bracket.trial(&self.points).filter(|_| solves < MOST_SOLVES) {
                Some(next) => (x, nearest) = (next, Some(near)),
                None => break (false, near),
            }
        };
        if rough {
            let begin = Begin::Found(solved.place());
            solved = solver.run(problem.parts(), bracket.axis.control(point.x), begin, &mut *observe)?;
            solves += 1;
            applications += solved.solution.report.operator_applications;
        }
        self.remember(point);
        let (mut solution, place) = solved.with_place();
        solution.report.branch = branch;
        (self.start, self.place) = (None, Some(place));
        let (below, above) = bracket.shares();
        Ok(FoundContact { solution, reached, below, above, solves, operator_applications: applications })
    }

    /// Solves at a place on the axis, and only roughly where the contact is far from the wanted one.
    fn solve_at(
        &self,
        x: f64,
        (bracket, branch): (&Bracket, Option<Branch>),
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        observe: Observer<'_>,
    ) -> Result<Trial<T>> {
        let Bracket { axis, target, .. } = *bracket;
        let wall = solver.constraint.wall();
        let anew = axis.starts_anew(wall) || self.is_long_way(x, axis);
        let begin = match (&self.start, &self.place) {
            (Some(gap), _) => Begin::At(Start::From(gap)),
            (None, Some(place)) if !anew => Begin::Found(place.clone()),
            (None, _) => branch.map_or(Begin::At(Start::Default), Begin::On),
        };
        // the phases before a solution have another law, or wall
        let of_solution = wall.is_rigid() && !(axis.adheres() && begin.is_default());
        let mut rough = false;
        let mut watch = |state: &Iteration| {
            let next = observe(state);
            let roughly = state.relative_error.max(state.load_error) <= ROUGHLY && !state.smoothed;
            rough = roughly && of_solution && target.off(state.contact_nodes) > TWICE && next.is_continue();
            if rough { ControlFlow::Break(()) } else { next }
        };
        let solved = solver.run(problem.parts(), axis.control(x), begin, &mut watch)?;
        Ok(Trial { point: target.point(x, solved.solution.report.contact_nodes), solved, rough })
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
    fn is_long_way(&self, x: f64, axis: Axis) -> bool {
        !axis.adheres() && self.points.last().is_some_and(|last| x - last.x > ANEW.ln())
    }

    fn remember(&mut self, point: Point) {
        self.points.retain(|known| known.x != point.x);
        self.points.push(point);
        self.points.drain(..self.points.len().saturating_sub(2));
    }
}
