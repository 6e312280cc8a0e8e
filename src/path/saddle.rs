//! The departure of a path from a branch of saddles.

use super::bench::Bench;
use super::{Path, RETRIES};
use crate::degrees::PARTLY;
use crate::error::Result;
use crate::problem::{Control, ProblemMut, smoothed_law};
use crate::real::Real;
use crate::solver::{Begin, Place, Solution, Solved, Start, Status};
use crate::stability::{Near, Saddle};

impl<T: Real> Path<T> {
    /// Whether a state is a saddle at its mean gap, of the law that the path follows.
    pub(super) fn saddle(&mut self, bench: &mut Bench<'_, T>, solution: &Solution<T>) -> Result<Option<Saddle>> {
        let load = self.course.held(&bench.problem.flat);
        let ProblemMut { operator, law, flat, .. } = bench.problem.parts();
        let smoothed = if self.settings.smooth { smoothed_law(&*operator, law) } else { None };
        let followed = smoothed.as_deref().unwrap_or(law);
        let gap = (&solution.gap, Near::Of(solution.touched.as_ref()), flat);
        self.watch.look(operator, (followed, &bench.solver.constraint), gap, load)
    }

    /// Descends from a saddle along its mode to a state that is none, if there is one; and whether the branch led
    /// along the mode itself. The path has failed where the observer stopped a solve.
    pub(super) fn leave(
        &mut self,
        bench: &mut Bench<'_, T>,
        from: &Solution<T>,
        control: Control,
    ) -> Result<(Option<Solved<T>>, bool)> {
        let grid = *bench.problem.grid();
        let moved = self.places.last().map(|Place { gap: last, .. }| {
            let last = bench.problem.flat.crop(last, T::infinity());
            let mut moved = from.gap.clone();
            // absent nodes are infinitely far, and stay there
            moved.zip_mut_with(&last, |gap, &last| *gap = if *gap == last { T::zero() } else { *gap - last });
            moved
        });
        let share = moved.map_or(0.0, |moved| self.watch.share(&moved, &grid));
        let drawn = share.abs() > PARTLY;
        let mut gap = from.gap.clone();
        for _ in 0..RETRIES {
            let amplitude = PARTLY * bench.problem.law_on_grid().hints().range.widen();
            let least = bench.least();
            self.watch.displace((&mut gap, &grid), least, amplitude, drawn.then_some(share));
            let left = bench.solve(&self.settings, control, Begin::At(Start::From(&gap)))?;
            if !left.is_settled() {
                self.failed |= left.solution.report.status == Status::Stopped;
                break;
            }
            if self.saddle(bench, &left.solution)?.is_none() {
                return Ok((Some(left), drawn));
            }
            gap = left.solution.gap;
        }
        Ok((None, drawn))
    }
}
