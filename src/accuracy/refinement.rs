//! A refinement: solves on finer and finer grids until an accuracy is reached.

use super::fitted::COST;
use super::goal::{is_refinable, on_twice};
use super::refine::{is_of_interpolation, overshoots, refined, twice};
use super::{Accuracy, AccurateSolution, GridError, resolves_adhesion};
use crate::adhesion::SharedLaw;
use crate::constraint::ContactConstraint;
use crate::elastic::OnGrids;
use crate::error::Result;
use crate::nested::{Deformed, GridObserver, Level, Touching};
use crate::problem::{Control, Problem};
use crate::real::Real;
use crate::solver::{Begin, Solved, Solver, Status};
use crate::surface::Surface;

/// A refinement of a given surface, with the means to solve on each of its grids.
struct Refinement<'a, T: Real> {
    wanted: &'a Accuracy,
    solver: &'a mut Solver<dyn ContactConstraint<T>>,
    surface: &'a Surface,
    operators: &'a mut dyn OnGrids<T>,
    law: &'a SharedLaw<T>,
    control: Control,
    observe: GridObserver<'a>,
}

/// The finest grid so far, with the levels that led there.
struct Finest<T: Real> {
    surface: Surface,
    law: SharedLaw<T>,
    solved: Solved<T>,
    levels: Vec<Level>,
    nodes_per_wave: f64,
    /// Whether finer grids change the surface alone: the adhesion of a law with the range of the grid, or of a law that
    /// the given grid does not resolve, changes with the grid too.
    is_resolved: bool,
}

/// What follows a grid.
enum Next {
    /// The surface on twice as many nodes along its sides.
    Finer(Surface),
    /// Nothing, since the heights in between are a guess.
    Guess,
    /// Nothing, since a grid of so many nodes takes too many bytes.
    TooLarge((usize, usize), f64),
    /// Nothing, since the accuracy is reached, or cannot be.
    End { is_reached: bool },
}

impl Accuracy {
    pub(crate) fn refine<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        surface: &Surface,
        operators: &mut dyn OnGrids<T>,
        law: &SharedLaw<T>,
        control: Control,
        observe: GridObserver<'_>,
    ) -> Result<AccurateSolution<T>> {
        Refinement { wanted: self, solver, surface, operators, law, control, observe }.run()
    }
}

impl<T: Real> Refinement<'_, T> {
    fn run(mut self) -> Result<AccurateSolution<T>> {
        let mut refinable = is_refinable(self.surface, &**self.law);
        let mut finest = self.on_given()?;
        self.wanted.of.check_in(finest.solved.solution.report.boundary)?;
        loop {
            let error = finest.error(self.wanted);
            let (reached, unaffordable) = match finest.next(self.wanted, error, refinable)? {
                Next::Finer(surface) => {
                    finest = match self.on_finer(finest, surface)? {
                        Some(finer) => finer,
                        None => {
                            refinable = false;
                            self.on_given()?
                        }
                    };
                    continue;
                }
                Next::Guess => {
                    refinable = false;
                    (false, None)
                }
                Next::TooLarge(shape, bytes) => (false, Some((shape, bytes))),
                Next::End { is_reached } => (is_reached, None),
            };
            let Finest { surface, solved: Solved { solution, .. }, levels, .. } = finest;
            return Ok(AccurateSolution { solution, surface, levels, error, reached, refinable, unaffordable });
        }
    }

    /// The given grid, by way of coarser ones.
    fn on_given(&mut self) -> Result<Finest<T>> {
        let Self { wanted, surface, law, control, .. } = *self;
        let heights = Box::new(surface);
        let (solved, levels) =
            wanted.nested.run(self.solver, heights, self.operators, law, control, &mut *self.observe)?;
        let report = &solved.solution.report;
        Ok(Finest {
            surface: surface.clone(),
            law: law.clone(),
            nodes_per_wave: surface.nodes_per_wave(report.boundary),
            is_resolved: !law.hints().of_grid && resolves_adhesion(report.mu_rho, 1.0),
            solved,
            levels,
        })
    }

    /// The next finer grid; none where its contact is of the interpolation and not of the given surface.
    fn on_finer(&mut self, coarse: Finest<T>, surface: Surface) -> Result<Option<Finest<T>>> {
        let (wanted, control, observe) = (self.wanted, self.control, &mut *self.observe);
        let law = on_twice(coarse.law, &coarse.surface, &surface);
        let nodes_per_wave = 2.0 * coarse.nodes_per_wave;
        let is_resolved = coarse.is_resolved;
        if law.hints().touches() {
            // what touches on this grid at its adhesion may not touch on a finer one, and would stick there
            let (solved, levels) =
                wanted.nested.run(self.solver, Box::new(&surface), self.operators, &law, control, observe)?;
            return Ok(Some(Finest { surface, law, solved, levels, nodes_per_wave, is_resolved }));
        }
        let half_space = self.operators.on(*surface.grid())?;
        let touching = Touching::new(self.solver.constraint.wall(), &*law);
        let Solved { solution, whole, .. } = coarse.solved;
        let deformed = Deformed::new(&coarse.surface, solution.gap, whole);
        let start = deformed.prolonged(&surface, half_space.grid(), touching);
        let mut problem = Problem::of(&surface, half_space, law.clone())?;
        let grid = *surface.grid();
        let begin = Begin::Prolonged(start);
        let solved = self.solver.run(problem.parts(), control, begin, &mut |iteration| observe(&grid, iteration))?;
        let stiffness = wanted.nested.stiffness_of(self.solver, &mut problem, &solved.solution)?;
        let mut levels = coarse.levels;
        levels.push(Level { stiffness, ..Level::of(&solved.solution)? });
        let is_first = coarse.surface.grid().shape() == self.surface.grid().shape();
        let is_guess =
            is_resolved && is_first && matches!(&levels[..], [.., given, fine] if is_of_interpolation(fine, given));
        Ok((!is_guess).then_some(Finest { surface, law, solved, levels, nodes_per_wave, is_resolved }))
    }
}

impl<T: Real> Finest<T> {
    fn error(&self, wanted: &Accuracy) -> Option<GridError> {
        GridError::of(&self.levels, wanted.of, self.nodes_per_wave, self.solved.solution.report.mu_rho)
    }

    fn next(&self, wanted: &Accuracy, error: Option<GridError>, is_refinable: bool) -> Result<Next> {
        let Self { surface, solved: Solved { solution, whole, .. }, .. } = self;
        let report = &solution.report;
        let is_enough = error.is_some_and(|error| error.relative + report.relative_error <= wanted.target);
        let is_converged = report.status == Status::Converged;
        if !is_converged || !is_refinable || is_enough {
            return Ok(Next::End { is_reached: is_converged && is_enough });
        }
        let shape = twice(surface.grid().shape());
        // the operator's grid grows as the grid of the surface
        let nodes = whole.as_ref().map_or(surface.grid(), |(grid, _)| grid).nodes() as f64;
        let bytes = 8.0 * COST.numbers * nodes * (shape.0 * shape.1) as f64 / surface.grid().nodes() as f64;
        if bytes > wanted.memory {
            return Ok(Next::TooLarge(shape, bytes));
        }
        let fine = refined(surface, report.boundary.is_periodic())?;
        let is_guess = !self.is_resolved && overshoots(&fine, surface);
        Ok(if is_guess { Next::Guess } else { Next::Finer(fine) })
    }
}
