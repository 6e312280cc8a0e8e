//! The departure from an unstable equilibrium: minimisation from a gap perturbed along the softest mode.

use std::ops::ControlFlow;

use super::Stability;
use crate::constraint::ContactConstraint;
use crate::degrees::PARTLY;
use crate::error::{Error, Result};
use crate::problem::{Load, Problem};
use crate::real::{Real, once};
use crate::solver::{
    Begin, Iteration, Observer, Potential, Solution, Solved, Solver, Start, Status, bounded, refuse_hardness,
    refuse_springs,
};

once! {
    /// The departure from a saddle.
    depart<'a, T>(
        stability: &'a Stability<T>, solver: &'a mut Solver<dyn ContactConstraint<T>>, problem: &'a mut Problem<T>,
        from: &'a Solution<T>, observe: Observer<'a>,
    ) -> Result<Option<Departure<T>>> = [within] Stability::depart;
}

/// The departure from an equilibrium: the end of a minimisation that left it along its softest mode.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Departure<T: Real> {
    /// The state in which the minimisation ended.
    pub solution: Solution<T>,
    /// The drop of the energy (under pressure control with the load's) per area; zero or less if there is none.
    pub energy_drop: f64,
    /// The root mean square of the change of the gap.
    pub distance: f64,
    /// 1 if it left along the mode, −1 if against it.
    pub direction: f64,
}

impl<T: Real> Stability<T> {
    /// Leaves an equilibrium: perturbs its gap along the mode both ways, minimises on under the control of the test
    /// and with the solver's wall, and returns the end of lower energy.
    ///
    /// The perturbation is a tenth of the range of adhesion at most; a stable equilibrium comes back within that
    /// distance. `None` if the mode is zero, as where all nodes are in contact, or without adhesion. Where `observe`
    /// stops a solve, the departure ends there, [stopped](Status::Stopped).
    ///
    /// # Errors
    /// [`Error::Shape`], [`Error::Value`] or [`Error::Unsuited`] if the solution is of another problem,
    /// [`Error::Unsuited`] for springs; otherwise as [`Solver::solve_with`].
    ///
    /// ```
    /// use asperity::stability::StabilityTest;
    /// use asperity::{Control, Exponential, Grid, Problem, Solver, Surface, Westergaard};
    /// let grid = Grid::line(64, 1.0)?;
    /// let flat = Surface::from_fn(grid, |_, _| 0.0)?;
    /// let mut problem = Problem::new(&flat, Westergaard::<f64>::new(grid, 1.0)?, Exponential::new(1e-3, 1e-2)?)?;
    /// let mut solver = Solver::default();
    /// let even = solver.solve(&mut problem, Control::MeanGap(0.011))?; // a uniform gap, which does not last
    /// let stability = StabilityTest::default().run(&mut problem, &even)?;
    /// let on = |_: &_| std::ops::ControlFlow::Continue(());
    /// let left = stability.leave(&mut solver, &mut problem, &even, on)?.expect("there is a mode");
    /// assert!(left.energy_drop > 0.0 && left.solution.report.contact_nodes > 0);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn leave(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        from: &Solution<T>,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<Option<Departure<T>>> {
        depart(self, solver, problem, from, &mut observe)
    }

    fn depart(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        from: &Solution<T>,
        observe: Observer<'_>,
    ) -> Result<Option<Departure<T>>> {
        refuse_springs(solver.constraint.wall())?;
        let yields = "the way from a saddle is one of an energy, and a surface that yields has none";
        refuse_hardness(solver.constraint.wall(), yields)?;
        from.check(&problem.parts(), &solver.constraint)?;
        let (grid, control) = (from.grid, self.control);
        let largest = self.mode.iter().fold(T::zero(), |largest, value| largest.max(value.abs()));
        let largest = T::lit(grid.greatest(largest.widen()));
        let amplitude = T::lit(PARTLY) * problem.law_on_grid().hints().range / largest;
        if !(amplitude > T::zero() && amplitude.is_finite()) {
            return Ok(None);
        }
        if !problem.flat.faces_all() && from.report.approach.is_none() {
            let reason = "the energy of a load on a periodic surface with absent nodes is not in its report";
            return Err(Error::Unsuited { what: "departure", reason });
        }
        let area = problem.flat.area;
        let energy = |solution: &Solution<T>| {
            let report = &solution.report;
            // what the load works on
            let position = report.approach.map_or(report.mean_gap, |approach| -approach);
            let load = match control.on_position(report.approach.is_some(), area) {
                Load::Gap(_) => 0.0,
                Load::Pressure(pressure) => pressure * position,
                Load::Spring { stiffness, rest } => 0.5 * stiffness / area * (position - rest).powi(2),
            };
            report.elastic_energy + report.adhesive_energy + load
        };
        let mut best: Option<Departure<T>> = None;
        for direction in [1.0, -1.0] {
            let step = T::lit(direction) * amplitude;
            let mut start = from.gap.clone();
            let least = Potential::new(problem.law_on_grid(), &solver.constraint, None).least();
            start.zip_mut_with(&self.mode, |gap, &mode| *gap = bounded(least, *gap, *gap + step * mode));
            let begin = Begin::At(Start::From(&start));
            let Solved { solution, .. } = solver.run(problem.parts(), control, begin, &mut *observe)?;
            let energy_drop = energy(from) - energy(&solution);
            let stopped = solution.report.status == Status::Stopped;
            if stopped || best.as_ref().is_none_or(|best| energy_drop > best.energy_drop) {
                let square = |a: T, b: T| if a == b { 0.0 } else { (a - b).widen().powi(2) };
                let distance = grid.mean_of_both(solution.gap.view(), from.gap.view(), square).sqrt();
                best = Some(Departure { solution, energy_drop, distance, direction });
            }
            if stopped {
                break;
            }
        }
        Ok(best)
    }
}
