//! What a path is followed with: the solver, the problem, and the states that they have.

use ndarray::Array2;

use super::balance::Balance;
use super::course::Course;
use super::settings::PathSettings;
use super::sharp::Sharp;
use crate::constraint::ContactConstraint;
use crate::degrees::{CLOSELY, LITTLE, ROUNDINGS};
use crate::error::Result;
use crate::problem::{Control, Problem, ProblemMut, smoothed_law};
use crate::real::Real;
use crate::solver::{Begin, Criterion, Least, Observer, Potential, Report, Solved, Solver, Start};

/// The number of gaps at which a law without a wall is asked whether it bears a pressure.
const CLOSEST: usize = 64;

/// What a path is followed with.
pub(crate) struct Bench<'a, T: Real> {
    pub(super) solver: &'a mut Solver<dyn ContactConstraint<T>>,
    pub(super) problem: &'a mut Problem<T>,
    pub(super) observe: Observer<'a>,
}

impl<T: Real> Bench<'_, T> {
    pub(super) fn least(&self) -> Least<T> {
        Potential::new(self.problem.law_on_grid(), &self.solver.constraint, None).least()
    }

    /// The mean gap to which surfaces are pressed together where a branch under a pressure breaks off: zero at a wall,
    /// and otherwise one at which the law alone repels flats by more than that pressure.
    pub(super) fn closest(&self, pressure: f64) -> f64 {
        let law = self.problem.law_on_grid();
        if self.solver.constraint.wall().is_rigid() {
            return 0.0;
        }
        let hints = law.hints();
        let (rest, range) = (hints.rest.unwrap_or_else(T::zero), hints.range);
        let bounded = law.energy(T::zero()).is_finite();
        let closer = |gap: &T| Some(if bounded { *gap - range } else { T::lit(0.5) * *gap });
        let gaps = std::iter::successors(Some(rest), closer).take(CLOSEST);
        let mut gaps = gaps.skip_while(|&gap| -law.traction(gap).widen() <= pressure);
        gaps.next().map_or(rest.widen(), T::widen)
    }

    /// The first state. The default start is an equilibrium of the law itself.
    pub(super) fn first(
        &mut self,
        start: Option<Array2<T>>,
        settings: &PathSettings,
        control: Control,
    ) -> Result<Solved<T>> {
        let problem = &self.problem;
        let jumps = settings.smooth && smoothed_law(problem.operator(), problem.law_on_grid()).is_some();
        match start {
            Some(start) => self.solve(settings, control, Begin::At(Start::From(&start))),
            None if jumps => {
                let (_, sharp) = self.solve(settings, control, Begin::At(Start::Default))?.with_place();
                self.solve(settings, control, Begin::Found(sharp))
            }
            None => {
                let begin = Begin::of_series(problem.law_on_grid(), &self.solver.settings);
                self.solve(settings, control, begin)
            }
        }
    }

    /// The state at a load, of the law that a path follows.
    pub(super) fn solve(
        &mut self,
        settings: &PathSettings,
        control: Control,
        begin: Begin<'_, T>,
    ) -> Result<Solved<T>> {
        let parts = self.problem.parts();
        let sharp = Sharp(parts.law);
        let smoothed = if settings.smooth { smoothed_law(&*parts.operator, parts.law) } else { None };
        let law = match &smoothed {
            _ if begin.is_default() => parts.law,
            Some(smoothed) => smoothed,
            None => &sharp,
        };
        let given = self.solver.settings;
        if given.tolerance.is_none() && given.criterion == Criterion::EnergyNorm {
            let least = given.tolerance_in::<T>();
            // an energy is wrong by the square of the error of its state, and less accurate states jump too early
            let tolerance = (LITTLE * settings.imbalance.sqrt()).clamp(least, CLOSELY.max(least));
            self.solver.settings.tolerance = Some(tolerance);
        }
        let solved = self.solver.run(ProblemMut { law, ..parts }, control, begin, &mut *self.observe);
        self.solver.settings = given;
        solved
    }

    /// The balance of a step to a state.
    pub(super) fn balance(&self, course: &Course, settings: &PathSettings, target: f64, report: &Report) -> Balance {
        let hints = self.problem.law_on_grid().hints();
        let flat = self.problem.flat.work * self.problem.flat.padding;
        // where surfaces hardly touch, the energy is the small difference of sums as large as the energy of flat
        // surfaces
        let rounding = ROUNDINGS * T::epsilon().widen() * flat;
        // the tolerance's share in it
        let left = report.tolerance.powi(2) * flat;
        let scale = (settings.imbalance, 1e-3 * hints.work_of_adhesion.widen());
        let balance = course.balance(target, report, scale, (rounding, left), hints.touches());
        // only adhesion makes surfaces jump
        let (jumped, located) = (balance.jumped && !hints.zero, balance.located && !hints.zero);
        Balance { jumped, located: located && settings.smallest_step.is_none(), ..balance }
    }
}
