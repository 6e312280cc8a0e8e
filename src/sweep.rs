//! A sweep: equilibria at one load after the other, each solve starting from the equilibria before it.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::constraint::ContactConstraint;
use crate::degrees::{HALF, TWICE};
use crate::error::Result;
use crate::problem::{Control, Held, Problem};
use crate::real::{Real, once};
use crate::solver::{
    Begin, Branch, Iteration, Least, Nearness, Observer, Place, Potential, Solution, Solved, Solver, Start,
    check_hardness, extrapolated, unload,
};

once! {
    /// The next load of a sweep.
    step<'a, T>(
        sweep: &'a mut Sweep<T>, solver: &'a mut Solver<dyn ContactConstraint<T>>, problem: &'a mut Problem<T>,
        load: Control, observe: Observer<'a>,
    ) -> Result<Solution<T>> = [within] Sweep::step;
}

/// A sweep of one problem through a sequence of loads, each solve from where the solves before lead.
///
/// Solver and problem are given with each load. With the feature `serde` a sweep is its own checkpoint: kept and read
/// again, it continues bit for bit, also at a problem that is made anew.
///
/// The first load starts from the default start, or from [`Sweep::starting_from`]; the others
///
/// - without adhesion, from the last two gaps, extrapolated in mean gap, approach or the rest of a spring, or in the
///   logarithm of pressure or force, and clipped to g ≥ 0;
/// - with adhesion, in the same way as long as the load continues in one direction and the two gaps before the last one
///   had led to it, which they do not across a jump;
/// - otherwise, and where loads are not of one kind, from the last gap;
/// - from the default start under a pressure or force of more than four times the last, as the last gap says little of
///   it; with adhesion only if the last load had started so on the branch of loading.
///
/// A sweep with adhesion follows its branch of equilibria up to the instability at which it jumps, and surfaces that
/// were pulled apart ([`Status::Detached`](crate::Status)) stay so until they are pressed together again.
///
/// At a [`Hardness`](crate::Hardness) each load starts from the last gap, and from the second load on the problem has the
/// plastic depth of the sweep ([`Problem::flatten`]): unloading is elastic. A solve that does not converge leaves it as it
/// was, unless rounding lets the fields be no better.
///
/// A mean gap that is given scales the start, as in [`Start::From`], or is the start where no gap is left to scale.
/// Fine steps save a third of the work without adhesion and almost half of it with adhesion; steps by half the load or
/// more save little. The page [`performance`](crate::guide::performance#sweeps) has figures. Memory, besides problem
/// and solver: a gap on the grid of the operator during a solve, and two with adhesion; a plastic depth.
///
/// A solve that does not converge is no error; the next load starts from where it ended.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Sweep, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::default();
/// let (mut sweep, mut contact) = (Sweep::default(), Vec::new());
/// for load in [1e-4, 2e-4, 4e-4].map(Control::MeanPressure) {
///     contact.push(sweep.next(&mut solver, &mut problem, load)?.report.contact_nodes);
/// }
/// assert!(contact[0] < contact[1] && contact[1] < contact[2]);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sweep<T> {
    start: Option<Array2<T>>,
    /// the loads and gaps of the next start, the latest last: at most two, and three with adhesion; on the grid of the
    /// operator, beyond a window the displacement
    history: Vec<(Control, Place<T>)>,
    /// the plastic depth after the last load, on the grid of the operator
    depth: Option<Array2<T>>,
    /// whether the last load, from a default start, was on the branch of loading
    loads: bool,
}

/// The ratio of two loads above which the second one starts anew.
pub(crate) const ANEW: f64 = 4.0;

impl<T> Default for Sweep<T> {
    fn default() -> Self {
        Self { start: None, history: Vec::new(), depth: None, loads: false }
    }
}

impl<T: Real> Sweep<T> {
    /// A sweep with a gap of shape (Nx, Ny) as the start at its first load.
    pub fn starting_from(gap: Array2<T>) -> Self {
        Self { start: Some(gap), ..Self::default() }
    }

    /// The gaps and the plastic depth from which the next load starts, on the grid of the operator: processes that share
    /// a grid gather these of a sweep that they keep.
    #[doc(hidden)]
    pub fn fields(&mut self) -> impl Iterator<Item = &mut Array2<T>> {
        self.history.iter_mut().map(|(_, place)| &mut place.gap).chain(&mut self.depth)
    }

    /// Where surfaces have not parted, of a law that attracts [next to contacts
    /// alone](crate::adhesion::Hints::touching), on the grid of the operator: processes that share a grid gather these
    /// as they do the fields.
    #[doc(hidden)]
    pub fn marks(&mut self) -> impl Iterator<Item = &mut Array2<bool>> {
        self.history.iter_mut().filter_map(|(_, place)| place.not_parted.as_mut())
    }

    /// The solution under the next load.
    ///
    /// # Errors
    /// As [`Solver::solve_with`]; [`Error::Shape`](crate::Error::Shape) for a problem on another grid than at the load
    /// before.
    pub fn next(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        load: Control,
    ) -> Result<Solution<T>> {
        self.next_observed(solver, problem, load, |_| ControlFlow::Continue(()))
    }

    /// The same with an observer of the iterations, as in [`Solver::solve_with`].
    ///
    /// # Errors
    /// As [`Self::next`].
    pub fn next_observed(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        load: Control,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<Solution<T>> {
        step(self, solver, problem, load, &mut observe)
    }

    fn step(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        load: Control,
        observe: Observer<'_>,
    ) -> Result<Solution<T>> {
        for gap in self.history.iter().map(|(_, place)| &place.gap).chain(&self.depth) {
            problem.operator.grid().fits("field of the sweep", gap.dim())?;
        }
        // a load that is refused leaves the sweep as it is
        let (law, wall) = (problem.law_on_grid(), solver.constraint.wall());
        check_hardness(law, problem.flat.load(load, wall)?, &problem.flat, wall)?;
        let least = Potential::new(law, &solver.constraint, None).least();
        problem.yield_to(self.depth.as_ref())?;
        let given = self.start.take();
        let first = given.as_ref().map_or_else(
            || Begin::of_series(problem.law_on_grid(), &solver.settings),
            |gap| Begin::At(Start::From(gap)),
        );
        let begin = self.next_start(problem, least, load).unwrap_or(first);
        let solved = solver.run(problem.parts(), load, begin, &mut *observe);
        if solved.is_err() {
            self.start = given;
        }
        let mut solved = solved?;
        if let Some((before, place)) = self.history.last()
            && self.depth.is_none()
            && is_last_unloading(*before, load)
            && problem.adheres()
            && solved.is_settled()
            && solved.solution.report.contact_nodes == 0
        {
            let solve = |control, begin: Begin<'_, T>| solver.run(problem.parts(), control, begin, &mut *observe);
            solved = unload(solve, *before, place.clone())?.unwrap_or(solved);
        }
        self.keep(problem, load, solved)
    }

    /// Keeps a solution's gap for the next start, and how far the surface has yielded.
    fn keep(&mut self, problem: &mut Problem<T>, load: Control, solved: Solved<T>) -> Result<Solution<T>> {
        let stays = solved.is_settled();
        let (solution, mut place) = solved.with_place();
        self.loads = solution.report.branch == Some(Branch::Loading);
        if let Some(depth) = &solution.plastic_depth {
            problem.lower(depth.view(), stays, &mut place.gap)?;
            self.history.clear();
        }
        self.depth = problem.yielded().cloned();
        self.history.push((load, place));
        Ok(solution)
    }

    /// The start under a load by the history, which keeps only the gaps that the next start needs.
    fn next_start(&mut self, problem: &Problem<T>, least: Least<T>, load: Control) -> Option<Begin<'_, T>> {
        let adheres = problem.adheres();
        let ahead = |two, load| ahead(problem, least, two, load);
        let (before, _) = self.history.last()?;
        let anew = (self.loads || !adheres) && self.depth.is_none() && is_far(*before, load);
        let ahead = match &self.history[..] {
            _ if anew => None,
            [.., earlier, before, last] if adheres => {
                let foretold = ahead([earlier, before], last.0);
                if foretold.is_some_and(|gap| foretells(problem, &gap, [before, last])) {
                    ahead([before, last], load)
                } else {
                    None
                }
            }
            [.., before, last] if !adheres => ahead([before, last], load),
            _ => None,
        };
        let kept = if adheres { 2 } else { 1 };
        self.history.drain(..self.history.len().saturating_sub(kept));
        let (_, last) = self.history.last()?;
        Some(match ahead {
            Some(gap) => Begin::Ahead { gap, last, nearness: Nearness::Ahead },
            None if anew => Begin::At(Start::Default),
            None => Begin::Found(last.clone()),
        })
    }
}

/// The gap under a load, extrapolated from two; with adhesion only if the load continues in the same direction.
fn ahead<T: Real>(
    problem: &Problem<T>,
    least: Least<T>,
    [before, last]: [&(Control, Place<T>); 2],
    load: Control,
) -> Option<Array2<T>> {
    let [a, b, c] = [before.0, last.0, load].map(Control::value);
    let of_logarithms = (c / b).ln() / (b / a).ln();
    // linear from and across a pressure of zero, where no logarithm is
    let linear = load.holds() != Held::Load || a == 0.0 || of_logarithms.is_nan();
    let steps = if linear { (c - b) / (b - a) } else { of_logarithms };
    let alike = before.0.is_like(last.0) && last.0.is_like(load);
    let on_branch = !problem.adheres() || steps >= 0.0;
    if !(alike && steps.is_finite() && on_branch) {
        return None;
    }
    let on = (&problem.flat, *problem.operator.grid());
    Some(extrapolated([&before.1.gap, &last.1.gap], steps.clamp(-TWICE, TWICE), (least, true), on))
}

/// Whether two controls are pressures, or forces.
fn loads(before: Control, load: Control) -> bool {
    load.holds() == Held::Load && before.is_like(load)
}

/// Whether a load presses so much more than the load before that the last gap says little.
fn is_far(before: Control, load: Control) -> bool {
    loads(before, load) && before.value() >= 0.0 && load.value() > ANEW * before.value()
}

/// Whether a load that presses is taken away.
fn is_last_unloading(before: Control, load: Control) -> bool {
    loads(before, load) && before.value() > 0.0 && load.value() == 0.0
}

/// Whether a gap was foretold, without a jump: the extrapolation is closer to it than the gap before.
fn foretells<T: Real>(problem: &Problem<T>, foretold: &Array2<T>, [before, last]: [&(Control, Place<T>); 2]) -> bool {
    let apart = |gap: &Array2<T>| {
        let square = |a: T, b: T| (a - b).widen().powi(2);
        problem.operator.grid().mean_of_both(gap.view(), last.1.gap.view(), square).sqrt()
    };
    apart(foretold) < HALF * apart(&before.1.gap)
}
