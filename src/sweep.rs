//! A sweep: equilibria at one load after the other, each solve starting from the equilibria before it.

use std::ops::ControlFlow;

use ndarray::Array2;

use crate::adhesion::AdhesionLaw;
use crate::constraint::{ContactConstraint, Projection};
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::problem::{Control, Problem};
use crate::real::Real;
use crate::solver::{Begin, Iteration, Potential, Solution, Solved, Solver, Start, extrapolated};

/// A sweep of one problem through a sequence of loads, each solve from where the ones before lead: an iterator over the
/// solutions.
///
/// The first load starts from the default start, or from [`Sweep::starting_from`]; the others
///
/// - without adhesion, from the last two gaps, extrapolated in mean gap, approach or the rest of a spring, or in the
///   logarithm of pressure or force, and clipped to g ≥ 0;
/// - with adhesion, in the same way as long as the load goes on in one direction and the two gaps before the last one
///   had led to it, which they do not across a jump;
/// - otherwise, and where loads are not of one kind, from the last gap.
///
/// A sweep with adhesion follows its branch of equilibria up to the instability at which it jumps, and surfaces that
/// were pulled apart ([`Status::Detached`](crate::Status)) stay so until they are pressed together again.
///
/// At a [`Hardness`](crate::Hardness) each load starts from the last gap, and the problem keeps the plastic depth
/// ([`Problem::flatten`]): unloading is elastic. A solve that does not converge leaves it as it was, unless rounding lets
/// the fields be no better. A sweep that is continued needs the [depth](Problem::plastic_depth) that it left there.
///
/// A mean gap that is given scales the start, as in [`Start::From`], or is the start where no gap is left to scale.
/// Fine steps save a third of the work without adhesion and almost half of it with adhesion; steps by half the load or
/// more save little. The page [`performance`](crate::guide::performance#sweeps) has figures. Memory, beside problem and
/// solver: a gap on the grid of the operator during a solve, and two with adhesion.
///
/// A solve that does not converge is no error; the next load starts from where it ended. After an error the sweep ends.
///
/// ```
/// use asperity::{Control, Grid, NoAdhesion, Problem, Solver, Surface, Sweep, Westergaard};
/// let grid = Grid::square(64, 1.0)?;
/// let surface = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let mut solver = Solver::default();
/// let mut contact = Vec::new();
/// for step in Sweep::new(&mut solver, &mut problem, [1e-4, 2e-4, 4e-4].map(Control::MeanPressure)) {
///     contact.push(step?.report.contact_nodes);
/// }
/// assert!(contact[0] < contact[1] && contact[1] < contact[2]);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Debug)]
pub struct Sweep<'a, T, O, L, I, C = Projection> {
    solver: &'a mut Solver<C>,
    problem: &'a mut Problem<T, O, L>,
    loads: I,
    start: Option<Array2<T>>,
    history: Vec<(Control, Array2<T>)>,
    failed: bool,
}

/// The most gaps of a history.
const MOST: usize = 3;

/// The farthest extrapolation of the last step, in steps.
pub(crate) const MOST_STEPS: f64 = 2.0;

/// The distance of a gap from that which the two before it foretold, over that from the one before it, from which on it
/// may have jumped.
const FORETOLD: f64 = 0.5;

impl<'a, T, O, L, I, C> Sweep<'a, T, O, L, I, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    I: Iterator<Item = Control>,
    C: ContactConstraint<T>,
{
    /// A sweep over `loads`, in their order.
    pub fn new(
        solver: &'a mut Solver<C>,
        problem: &'a mut Problem<T, O, L>,
        loads: impl IntoIterator<Item = Control, IntoIter = I>,
    ) -> Self {
        Self { solver, problem, loads: loads.into_iter(), start: None, history: Vec::new(), failed: false }
    }

    /// The sweep with a gap of shape (Nx, Ny) as the start at its next load.
    pub fn starting_from(self, gap: Array2<T>) -> Self {
        Self { start: Some(gap), ..self }
    }

    /// The loads and gaps of the next start, the latest last: at most two, and three with adhesion. The gaps are on the
    /// grid of the operator; beyond a window they are the displacement.
    pub fn history(&self) -> &[(Control, Array2<T>)] {
        &self.history
    }

    /// The [`Sweep::history`] of a sweep that ends here, without a copy of its gaps.
    pub fn into_history(self) -> Vec<(Control, Array2<T>)> {
        self.history
    }

    /// The problem.
    pub fn problem(&mut self) -> &mut Problem<T, O, L> {
        self.problem
    }

    /// The sweep continued with another one's [`Sweep::history`], bit for bit.
    pub fn continuing(self, mut history: Vec<(Control, Array2<T>)>) -> Self {
        history.drain(..history.len().saturating_sub(MOST));
        Self { history, ..self }
    }

    /// The next solution, as [`Iterator::next`], with an observer as in [`Solver::solve_with`].
    ///
    /// # Errors
    /// Those of [`Solver::solve_with`]; after one there is no next load.
    pub fn next_observed(
        &mut self,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Option<Result<Solution<T>>> {
        if self.failed {
            return None;
        }
        let control = self.loads.next()?;
        let start = self.start.take();
        let begin = match (&start, self.next_start(control)) {
            (Some(gap), _) => Begin::At(Start::From(gap)),
            (None, Some(begin)) => begin,
            (None, None) => Begin::At(Start::Default),
        };
        let solved = self.solver.run(self.problem.parts(), control, begin, &mut observe);
        let kept = solved.and_then(|solved| self.keep(control, solved));
        self.failed = kept.is_err();
        Some(kept)
    }

    /// Keeps a solution's gap for the next start, and how far the surface has yielded.
    fn keep(&mut self, control: Control, solved: Solved<T>) -> Result<Solution<T>> {
        let stays = solved.is_settled();
        let (solution, mut gap) = solved.with_gap();
        if let Some(depth) = &solution.plastic_depth {
            self.problem.lower(depth.view(), stays, &mut gap)?;
            self.history.clear();
        }
        self.history.push((control, gap));
        Ok(solution)
    }

    /// The start under a load to which the history leads; of its gaps only those stay that the start after it needs.
    fn next_start(&mut self, control: Control) -> Option<Begin<'static, T>> {
        let adheres = !self.problem.law_on_grid().hints().zero;
        let (_, last) = self.history.last()?;
        let ahead = match &self.history[..] {
            [.., earlier, before, last] if adheres && self.foretells([earlier, before], last) => {
                self.ahead([before, last], control)
            }
            [.., before, last] if !adheres => self.ahead([before, last], control),
            _ => None,
        };
        let start = ahead.map_or_else(|| Begin::Found(last.clone()), Begin::Ahead);
        let kept = if adheres { 2 } else { 1 };
        self.history.drain(..self.history.len().saturating_sub(kept));
        Some(start)
    }

    /// The gap under a load, extrapolated from two; with adhesion only if the load goes on in the same direction.
    fn ahead(&self, [before, last]: [&(Control, Array2<T>); 2], control: Control) -> Option<Array2<T>> {
        let steps = match (before.0, last.0, control) {
            (Control::MeanGap(a), Control::MeanGap(b), Control::MeanGap(c))
            | (Control::Approach(a), Control::Approach(b), Control::Approach(c)) => (c - b) / (b - a),
            (Control::MeanPressure(a), Control::MeanPressure(b), Control::MeanPressure(c))
            | (Control::Force(a), Control::Force(b), Control::Force(c)) => {
                // linear across a pressure of zero, where no logarithm is
                let of_logarithms = (c / b).ln() / (b / a).ln();
                if of_logarithms.is_nan() { (c - b) / (b - a) } else { of_logarithms }
            }
            (
                Control::Spring { stiffness: k, rest: a },
                Control::Spring { stiffness: l, rest: b },
                Control::Spring { stiffness: m, rest: c },
            ) if k == l && l == m => (c - b) / (b - a),
            _ => f64::NAN,
        };
        let (before, last) = (&before.1, &last.1);
        let on_branch = self.problem.law_on_grid().hints().zero || steps >= 0.0;
        if !(steps.is_finite() && on_branch && before.dim() == last.dim()) {
            return None;
        }
        let least = Potential::new(self.problem.law_on_grid(), &self.solver.constraint, None).least();
        let on = (self.problem.flat.window.as_ref(), *self.problem.operator.grid());
        Some(extrapolated([before, last], steps.clamp(-MOST_STEPS, MOST_STEPS), (least, true), on))
    }

    /// Whether two gaps have led to the next one, without a jump: their extrapolation is closer to it than the second.
    fn foretells(&self, [earlier, before]: [&(Control, Array2<T>); 2], last: &(Control, Array2<T>)) -> bool {
        let foretold = self.ahead([earlier, before], last.0).filter(|gap| gap.dim() == last.1.dim());
        let Some(foretold) = foretold else { return false };
        let apart = |gap: &Array2<T>| {
            let square = |a: T, b: T| (a - b).widen().powi(2);
            self.problem.operator.grid().mean_of_both(gap.view(), last.1.view(), square).sqrt()
        };
        apart(&foretold) < FORETOLD * apart(&before.1)
    }
}

impl<T, O, L, I, C> Iterator for Sweep<'_, T, O, L, I, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    I: Iterator<Item = Control>,
    C: ContactConstraint<T>,
{
    type Item = Result<Solution<T>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_observed(|_| ControlFlow::Continue(()))
    }
}
