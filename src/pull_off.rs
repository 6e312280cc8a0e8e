//! A search: the greatest tension under which surfaces that adhere stay together.

use std::ops::ControlFlow;

use crate::constraint::{ContactConstraint, Wall};
use crate::degrees::{FIRST_STEP, HALF, LITTLE, PARTLY, ROUGHLY};
use crate::error::{Error, Result};
use crate::problem::{Control, Problem, ProblemMut, smoothed_law};
use crate::real::{Real, once};
use crate::search::MOST_SOLVES;
use crate::setters::setters;
use crate::solver::{
    Aim, Begin, Branch, Criterion, Iteration, Observer, Report, Solution, Solved, Solver, Start, Status, check_wall,
    refuse_hardness, unload,
};

mod bracket;

use bracket::{Bracket, Held};

once! {
    /// A search for a pull-off.
    search<'a, T>(
        search: PullOff, solver: &'a mut Solver<dyn ContactConstraint<T>>, problem: &'a mut Problem<T>,
        start: Start<'a, T>, observe: Observer<'a>,
    ) -> Result<FoundPullOff<T>> = [within] PullOff::search;
}

/// A search for the pull-off: the greatest tension under which surfaces that adhere stay together.
///
/// The tension grows, each solve from the gap under the greatest tension borne, until the surfaces come apart
/// ([`Status::Detached`]); then the pull-off is between the two, and their bracket is narrowed until it is `tolerance`
/// wide. A loss counts only from a state within the tolerance of the lost tension: from a farther state it may be a
/// jump that shorter steps avoid, and is tried again from a closer state. Contacts that are lost on the way are lost
/// under the load, as on a soft spring. A loss takes many times the iterations of a state that holds: a tension above
/// the peak of a parabola through the last states is tried only where its loss ends the search. Before, the surfaces
/// are pressed flat, as on the branch of unloading ([`Branch`]), or to a `preload`. On the branch of unloading the
/// pull-off is the largest tension with an equilibrium, if the traction of the law falls with the gap. Where the
/// pull-off is expected between two tensions, the search begins there. The last solve has the tolerance of the solver;
/// solves before it are rough trials.
///
/// | field | default | meaning | range |
/// |---|---|---|---|
/// | `tolerance` | 0.02 | the relative width of the bracket at which the search ends | positive, below 1 |
/// | `preload` | none | the mean pressure to which surfaces from afar were pressed before; flat if none is given | zero or positive |
/// | `expected` | none | the tensions, pressures, between which the pull-off is expected, as on a coarser grid | positive, rising |
///
/// A branch that the solver's settings name, or a given [`Start`], takes the place of these in the first solve. Where
/// the traction of the law jumps, as with [`MaugisDugdale`](crate::MaugisDugdale), the search, like a
/// [`Path`](crate::path::Path), takes the [smoothed](crate::adhesion::Discretisation::Smooth) law.
///
/// ```
/// use asperity::exact::Sphere;
/// use asperity::{Boussinesq, Exponential, Grid, Problem, PullOff, Solver, Surface, exact};
/// let grid = Grid::square(48, 0.36)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let law = Exponential::new(2e-5, 4e-3)?;
/// let mut problem = Problem::new(&sphere, Boussinesq::<f64>::new(grid, 1.0)?, law)?;
/// let found = PullOff::default().find(&mut Solver::default(), &mut problem)?;
/// assert!(found.reached);
/// let force = -found.solution.report.normal_force;
/// let jkr = -exact::Jkr::new(2.0, 1.0, 2e-5)?.pull_off().load();
/// // between the pull-offs of a stiff sphere, 2πRw, and of a soft sphere, 3πRw/2
/// assert!(jkr < force && force < jkr * 4.0 / 3.0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PullOff {
    /// The relative width of the bracket at which the search ends.
    pub tolerance: f64,
    /// The mean pressure to which the surfaces were pressed before.
    pub preload: Option<f64>,
    /// The tensions, pressures, between which the pull-off is expected: the search begins there.
    pub expected: Option<[f64; 2]>,
}

/// The end of a search for the pull-off.
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct FoundPullOff<T: Real> {
    /// The state under the greatest tension borne; its mean pressure is minus this tension. A search that is cut short ends
    /// with a rough state.
    pub solution: Solution<T>,
    /// The least tension under which the surfaces came apart, a pressure; none if they never did. If
    /// [`reached`](Self::reached), they came apart from a state within the tolerance of this tension.
    pub lost: Option<f64>,
    /// Whether the bracket is as narrow as the tolerance.
    pub reached: bool,
    /// The branch of the first solve, unless it was from a given start.
    pub branch: Option<Branch>,
    /// The number of solves.
    pub solves: usize,
    /// The operator applications of all of them.
    pub operator_applications: usize,
}

impl Default for PullOff {
    fn default() -> Self {
        Self { tolerance: 0.02, preload: None, expected: None }
    }
}

impl PullOff {
    setters! { tolerance: f64, preload: Option<f64>, expected: Option<[f64; 2]> }

    /// The pull-off of a problem.
    ///
    /// # Errors
    /// [`Error::Unsuited`] without adhesion, and where surfaces under no load do not attract each other;
    /// [`Error::Value`] for a tolerance, a preload or an expected
    /// tension out of their ranges; [`Error::Unsuited`] for springs; errors of
    /// [`Solver::solve_with`].
    pub fn find<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
    ) -> Result<FoundPullOff<T>> {
        self.find_from(solver, problem, Start::Default, |_| ControlFlow::Continue(()))
    }

    /// The same from a start, with an observer of the iterations; where it breaks off the search ends.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn find_from<T: Real>(
        &self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        start: Start<'_, T>,
        mut observe: impl FnMut(&Iteration) -> ControlFlow<()> + Send,
    ) -> Result<FoundPullOff<T>> {
        search(*self, solver, problem, start, &mut observe)
    }

    fn search<T: Real>(
        self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        start: Start<'_, T>,
        observe: Observer<'_>,
    ) -> Result<FoundPullOff<T>> {
        self.check(solver, problem)?;
        let usual = if self.preload.is_some() { Branch::Loading } else { Branch::Unloading };
        let branch = solver.settings.branch.unwrap_or(usual);
        let begin = if let Start::Default = start { Begin::On(branch) } else { Begin::At(start) };
        let branch = begin.is_default().then_some(branch);
        let bracket = Bracket::new(self.expected);
        let (solves, operator_applications, tolerance) = (0, 0, self.tolerance);
        let is_rough = solver.settings.criterion == Criterion::EnergyNorm;
        let mut search =
            Search { solver, problem, observe, branch, tolerance, is_rough, bracket, solves, operator_applications };
        let preload = self.preload.unwrap_or(0.0);
        // where surfaces have touched under the preload need not be known to a node
        let tolerance = search.rough(if preload > 0.0 { LITTLE } else { ROUGHLY });
        let pressed = search.solve_to(tolerance, Control::MeanPressure(preload), begin)?;
        if !pressed.is_settled() {
            return Ok(search.end(pressed, false));
        }
        if let Some(held) = search.pull_at_once(&pressed)? {
            return search.narrow(held, 0.0);
        }
        let released = search.release(preload, pressed)?;
        if !released.is_settled() {
            return Ok(search.end(released, false));
        }
        let first = FIRST_STEP * search.attraction(&released.solution.report)?;
        search.bracket.borne.push(Held::of(&released.solution.report));
        search.narrow(released, first)
    }

    fn check<T: Real>(&self, solver: &Solver<dyn ContactConstraint<T>>, problem: &Problem<T>) -> Result<()> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            let requirement = "positive, and less than 1";
            return Err(Error::Value { name: "tolerance of the pull-off", value: self.tolerance, requirement });
        }
        if let Some(preload) = self.preload {
            Error::non_negative("preload", preload)?;
        }
        if let Some([least, most]) = self.expected {
            Error::positive("least expected tension", least)?;
            Error::positive("range of expected tensions", most - least)?;
        }
        if !problem.adheres() {
            let reason = "without adhesion surfaces bear no tension: give a law";
            return Err(Error::Unsuited { what: "pull-off", reason });
        }
        if let Wall::Springs(_) = solver.constraint.wall() {
            let reason = "surfaces that sink into springs come apart while these become hard: take a rigid wall, or none \
                          with a law that repels";
            return Err(Error::Unsuited { what: "springs", reason });
        }
        let yields = "a surface that yields bears another tension after each load: follow a path, as Path does";
        refuse_hardness(solver.constraint.wall(), yields)?;
        check_wall(problem.law_on_grid(), solver.constraint.wall())
    }
}

/// A search under way.
struct Search<'a, T: Real> {
    solver: &'a mut Solver<dyn ContactConstraint<T>>,
    problem: &'a mut Problem<T>,
    observe: Observer<'a>,
    branch: Option<Branch>,
    tolerance: f64,
    /// whether solves before the last one are rough
    is_rough: bool,
    bracket: Bracket,
    solves: usize,
    operator_applications: usize,
}

impl<T: Real> Search<'_, T> {
    /// Solves under a load that differs much from the one before.
    fn solve(&mut self, load: Control, begin: Begin<'_, T>) -> Result<Solved<T>> {
        self.solve_to(self.rough(ROUGHLY), load, begin)
    }

    /// The tolerance of a rough solve, or the solver's own where this is larger, or no solve is rough.
    fn rough(&self, tolerance: f64) -> f64 {
        let own = self.solver.settings.tolerance_in::<T>();
        if self.is_rough { own.max(tolerance) } else { own }
    }

    fn solve_to(&mut self, tolerance: f64, load: Control, begin: Begin<'_, T>) -> Result<Solved<T>> {
        let is_rough = tolerance > self.solver.settings.tolerance_in::<T>();
        let aim = if is_rough { Aim::Trial } else { Aim::Solution };
        let parts = self.problem.parts();
        let smoothed = smoothed_law(&*parts.operator, parts.law);
        let parts = ProblemMut { law: smoothed.as_deref().unwrap_or(parts.law), ..parts };
        let observe = &mut *self.observe;
        let solved = self.solver.to(tolerance, |solver| solver.run_for(aim, parts, load, begin, observe))?;
        self.solves += 1;
        self.operator_applications += solved.solution.report.operator_applications;
        Ok(solved)
    }

    /// Pulls surfaces from under the preload to the least expected tension at once; none if they come apart.
    fn pull_at_once(&mut self, pressed: &Solved<T>) -> Result<Option<Solved<T>>> {
        let Some([least, _]) = self.bracket.expected else { return Ok(None) };
        let solved = self.solve(Control::MeanPressure(-least), Begin::Found(pressed.place()))?;
        if solved.is_settled() {
            self.bracket.bear(Held { tension: least, ..Held::of(&solved.solution.report) });
            return Ok(Some(solved));
        }
        if solved.solution.report.status == Status::Detached {
            self.bracket.lose(least);
        }
        Ok(None)
    }

    /// Takes the preload away.
    fn release(&mut self, preload: f64, pressed: Solved<T>) -> Result<Solved<T>> {
        if preload == 0.0 {
            return Ok(pressed);
        }
        let place = pressed.place();
        let released = self.solve(Control::MeanPressure(0.0), Begin::Found(place.clone()))?;
        let touched = pressed.solution.report.contact_nodes > 0;
        if !touched || !released.is_settled() || released.solution.report.contact_nodes > 0 {
            return Ok(released);
        }
        let held = unload(|load, begin| self.solve(load, begin), Control::MeanPressure(preload), place)?;
        Ok(held.unwrap_or(released))
    }

    /// The attraction of surfaces under no load, a pressure.
    fn attraction(&self, report: &Report) -> Result<f64> {
        // flat surfaces at rest have the energy of adhesion, and no traction
        let hints = self.problem.law_on_grid().hints();
        let stored = 0.0 - report.adhesive_energy;
        let node = hints.work_of_adhesion.widen() / self.problem.grid().nodes() as f64;
        let at_rest = PARTLY * stored / hints.range.widen();
        let at_rest = if stored < HALF * node || !at_rest.is_finite() { 0.0 } else { at_rest };
        let attraction = report.mean_contact_pressure.max(at_rest);
        if attraction > 0.0 {
            return Ok(attraction);
        }
        let reason = "the surfaces do not attract each other under no load: give a law of a longer range, or a preload";
        Err(Error::Unsuited { what: "pull-off", reason })
    }

    /// Narrows the bracket from a state that holds, with the first tension to try if none is expected.
    fn narrow(mut self, mut held: Solved<T>, first: f64) -> Result<FoundPullOff<T>> {
        let mut is_exact = !self.is_rough;
        loop {
            while self.solves < MOST_SOLVES && !self.bracket.is_narrow(self.tolerance) {
                let tension = self.bracket.next(first, self.tolerance);
                let change = 1.0 - self.bracket.greatest() / tension;
                let tolerance = self.rough(ROUGHLY.min(LITTLE * change));
                let solved = self.solve_to(tolerance, Control::MeanPressure(-tension), Begin::Found(held.place()))?;
                if solved.is_settled() {
                    self.bracket.bear(Held { tension, ..Held::of(&solved.solution.report) });
                    (held, is_exact) = (solved, !self.is_rough);
                    continue;
                }
                match solved.solution.report.status {
                    Status::Detached => self.bracket.lose(tension),
                    // a contact that is about to be lost may weigh more in a light load than in the energy
                    Status::Stalled if self.is_rough => self.is_rough = false,
                    status => {
                        held.solution.report.status = status;
                        return Ok(self.end(held, false));
                    }
                }
            }
            let is_narrow = self.bracket.is_narrow(self.tolerance);
            if is_exact {
                return Ok(self.end(held, is_narrow));
            }
            let own = self.solver.settings.tolerance_in::<T>();
            let load = Control::MeanPressure(-self.bracket.greatest());
            let solved = self.solve_to(own, load, Begin::Found(held.place()))?;
            match solved.solution.report.status {
                _ if solved.is_settled() => return Ok(self.end(solved, is_narrow)),
                // rough states hold where exact ones do not
                Status::Detached if self.solves < MOST_SOLVES => {
                    self.is_rough = false;
                    self.bracket.give_back();
                }
                status => {
                    held.solution.report.status = status;
                    return Ok(self.end(held, false));
                }
            }
        }
    }

    fn end(self, held: Solved<T>, reached: bool) -> FoundPullOff<T> {
        let Self { branch, bracket, solves, operator_applications, .. } = self;
        FoundPullOff { solution: held.solution, lost: bracket.lost, reached, branch, solves, operator_applications }
    }
}
