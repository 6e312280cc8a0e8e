//! The gap from which the next state of a path is sought.

use super::{Bench, Path};
use crate::real::Real;
use crate::solver::{Begin, Least, Nearness, Potential, Start, extrapolated};
use crate::sweep::MOST_STEPS;

/// The number of gaps at which a law without a wall is asked whether it bears a pressure.
const CLOSEST: usize = 64;

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
}

impl<T: Real> Path<T> {
    /// The start at `target`: the state that was found there, or a gap extrapolated from the last two; and whether surfaces
    /// touched at new places on the way to it.
    pub(super) fn predict(&self, bench: &Bench<'_, T>, target: f64) -> (Begin<'_, T>, bool) {
        if let (Some(ahead), Some(end)) = (&self.ahead, self.course.taken_back())
            && end == target
        {
            return (Begin::Found(ahead.clone()), ahead.touches);
        }
        let start = match &self.places[..] {
            [before, last] => {
                let steps = self.course.extrapolation(target).clamp(-MOST_STEPS, MOST_STEPS);
                let steps = if steps.is_finite() { steps } else { 0.0 };
                let on = (bench.problem.flat.window.as_ref(), *bench.problem.operator.grid());
                let gap = extrapolated([&before.gap, &last.gap], steps, (bench.least(), false), on);
                Begin::Ahead { gap, last, nearness: Nearness::Loaded }
            }
            [.., last] => Begin::Found(last.clone()),
            [] => Begin::At(Start::Default),
        };
        (start, false)
    }
}
