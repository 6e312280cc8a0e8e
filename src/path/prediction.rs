//! The gap from which the next state of a path is sought.

use super::Path;
use super::bench::Bench;
use crate::degrees::TWICE;
use crate::real::Real;
use crate::solver::{Begin, Nearness, Start, extrapolated};

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
                let steps = self.course.extrapolation(target).clamp(-TWICE, TWICE);
                let steps = if steps.is_finite() { steps } else { 0.0 };
                let on = (&bench.problem.flat, *bench.problem.operator.grid());
                let gap = extrapolated([&before.gap, &last.gap], steps, (bench.least(), false), on);
                Begin::Ahead { gap, last, nearness: Nearness::Loaded }
            }
            [.., last] => Begin::Found(last.clone()),
            [] => Begin::At(Start::Default),
        };
        (start, false)
    }
}
