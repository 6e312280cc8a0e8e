//! A search: the greatest tension under which surfaces that adhere stay together.

use std::ops::ControlFlow;

use crate::constraint::{ContactConstraint, Wall};
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::problem::{Control, Problem, ProblemMut, smoothed_law};
use crate::real::{Real, once};
use crate::setters::setters;
use crate::solver::{
    Begin, Branch, Criterion, Iteration, Observer, Report, STRONGEST, Solution, Solved, Solver, Start, Status,
    check_wall, refuse_hardness, unload,
};

once! {
    /// A search for a pull-off.
    search<'a, T>(
        search: PullOff, solver: &'a mut Solver<dyn ContactConstraint<T>>, problem: &'a mut Problem<T>,
        start: Start<'a, T>, observe: Observer<'a>,
    ) -> Result<FoundPullOff<T>> = [within] PullOff::search;
}

/// The most solves of a search; a bracket is halved at least with every other one.
const MOST: usize = 60;

/// The first tension, over the attraction of the surfaces under no load.
const FIRST: f64 = 1.0 / 16.0;

/// The attraction of surfaces at rest, over their energy of adhesion and its range: a tension that is tried.
const AT_REST: f64 = 0.1;

/// The least and the largest next tension over the last tension borne, as long as no tension is too large.
const GROWTH: (f64, f64) = (1.2, 2.5);

/// The share of a bracket that a tension leaves to both sides at least, and the share below a tension that is tried without a
/// peak: a state that holds costs less than surfaces that come apart.
const MARGIN: f64 = 0.1;
const BELOW: f64 = 0.35;

/// The tolerance of a rough solve, over the change of the tension, and the largest tolerance.
const ROUGHLY: (f64, f64) = (0.01, 1e-3);

/// A search for the pull-off: the greatest tension under which surfaces that adhere stay together.
///
/// The tension grows, each solve from the gap under the greatest tension borne, until the surfaces come apart
/// ([`Status::Detached`]); then the pull-off is between the two, and their bracket is narrowed until it is `tolerance`
/// wide. A loss counts only from a state within the tolerance of the lost tension: from a farther state it may be a
/// jump that shorter steps avoid, and is tried again from a closer state. Contacts that are lost on the way are lost
/// under the load, as on a soft spring. Before, the surfaces are pressed flat, as on the branch of unloading
/// ([`Branch`]), or to a `preload`. On the branch of unloading the pull-off is the largest tension with an equilibrium,
/// if the traction of the law falls with the gap. Where the pull-off is expected between two tensions, the search begins there,
/// with rough solves; the last solve has the tolerance of the solver.
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
    /// The state under the greatest tension borne; its mean pressure is minus this tension.
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
        let bracket = Bracket { expected: self.expected, ..Bracket::default() };
        let (solves, operator_applications, tolerance) = (0, 0, self.tolerance);
        let is_rough = self.expected.is_some() && solver.settings.criterion == Criterion::EnergyNorm;
        let mut search =
            Search { solver, problem, observe, branch, tolerance, is_rough, bracket, solves, operator_applications };
        let preload = self.preload.unwrap_or(0.0);
        let pressed = search.solve(Control::MeanPressure(preload), begin)?;
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
        let first = FIRST * search.attraction(&released.solution.report)?;
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
        if problem.law_on_grid().hints().zero {
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
        self.solve_to(self.roughly(1.0), load, begin)
    }

    /// The tolerance of a solve, by the relative change of the load.
    fn roughly(&self, change: f64) -> f64 {
        let (own, (share, most)) = (self.solver.settings.tolerance_in::<T>(), ROUGHLY);
        if self.is_rough { own.max(most.min(share * change)) } else { own }
    }

    fn solve_to(&mut self, tolerance: f64, load: Control, begin: Begin<'_, T>) -> Result<Solved<T>> {
        let parts = self.problem.parts();
        let smoothed = smoothed_law(&*parts.operator, parts.law);
        let parts = ProblemMut { law: smoothed.as_deref().unwrap_or(parts.law), ..parts };
        let observe = &mut *self.observe;
        let solved = self.solver.to(tolerance, |solver| solver.run(parts, load, begin, observe))?;
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
        let at_rest = AT_REST * stored / hints.range.widen();
        let at_rest = if stored < STRONGEST * node || !at_rest.is_finite() { 0.0 } else { at_rest };
        let attraction = report.mean_contact_pressure.max(at_rest);
        if attraction > 0.0 {
            return Ok(attraction);
        }
        let reason = "the surfaces do not attract each other under no load: give a law of a longer range, or a preload";
        Err(Error::Unsuited { what: "pull-off", reason })
    }

    /// Narrows the bracket from a state that holds, with the first tension to try if none is expected.
    fn narrow(mut self, mut held: Solved<T>, first: f64) -> Result<FoundPullOff<T>> {
        while self.solves < MOST && !self.bracket.is_narrow(self.tolerance) {
            let tension = self.bracket.next(first, self.tolerance);
            let tolerance = self.roughly(1.0 - self.bracket.greatest() / tension);
            let solved = self.solve_to(tolerance, Control::MeanPressure(-tension), Begin::Found(held.place()))?;
            if solved.is_settled() {
                self.bracket.bear(Held { tension, ..Held::of(&solved.solution.report) });
                held = solved;
            } else if solved.solution.report.status == Status::Detached {
                self.bracket.lose(tension);
            } else {
                held.solution.report.status = solved.solution.report.status;
                return Ok(self.end(held, false));
            }
        }
        let is_narrow = self.bracket.is_narrow(self.tolerance);
        if self.bracket.expected.is_none() {
            return Ok(self.end(held, is_narrow));
        }
        // solves were rough
        let own = self.solver.settings.tolerance_in::<T>();
        let load = Control::MeanPressure(-self.bracket.greatest());
        let solved = self.solve_to(own, load, Begin::Found(held.place()))?;
        if solved.solution.report.status == Status::Detached && self.solves < MOST {
            // rough states hold where exact ones do not
            self.is_rough = false;
            self.bracket.give_back();
            return self.narrow(held, first);
        }
        let reached = is_narrow && solved.is_settled();
        Ok(self.end(solved, reached))
    }

    fn end(self, held: Solved<T>, reached: bool) -> FoundPullOff<T> {
        let Self { branch, bracket, solves, operator_applications, .. } = self;
        FoundPullOff { solution: held.solution, lost: bracket.lost, reached, branch, solves, operator_applications }
    }
}

/// A tension that is borne, and how far the bodies are there: the mean gap, with a free boundary minus the approach.
#[derive(Clone, Copy, Debug)]
struct Held {
    distance: f64,
    tension: f64,
}

impl Held {
    fn of(report: &Report) -> Self {
        let free = report.boundary != Boundary::Periodic;
        let distance = report.approach.filter(|_| free).map_or(report.mean_gap, |approach| -approach);
        Self { distance, tension: -report.mean_pressure }
    }
}

/// The tensions that are borne, in their order, and the least tension that is not.
#[derive(Debug, Default)]
struct Bracket {
    borne: Vec<Held>,
    lost: Option<f64>,
    /// the tension that was borne before the loss
    from: f64,
    /// the tensions between which the pull-off is expected
    expected: Option<[f64; 2]>,
}

impl Bracket {
    fn bear(&mut self, place: Held) {
        self.lost = self.lost.filter(|&lost| lost > place.tension);
        self.borne.push(place);
    }

    fn lose(&mut self, tension: f64) {
        (self.lost, self.from) = (Some(tension), self.greatest());
    }

    /// Takes the greatest tension as the one that is not borne.
    fn give_back(&mut self) {
        if let Some(last) = self.borne.pop() {
            self.lose(last.tension);
        }
    }

    fn greatest(&self) -> f64 {
        self.borne.last().map_or(0.0, |place| place.tension)
    }

    fn is_narrow(&self, tolerance: f64) -> bool {
        self.lost.is_some_and(|lost| lost - self.from <= tolerance * lost)
    }

    /// The tension to try.
    fn next(&self, first: f64, tolerance: f64) -> f64 {
        let (low, peak) = (self.greatest(), self.peak());
        if let Some(tension) = self.next_as_expected() {
            return tension;
        }
        let Some(lost) = self.lost else {
            let (least, most) = GROWTH;
            let beyond = peak.map_or(f64::INFINITY, |peak| peak * (1.0 + 0.25 * tolerance));
            return if low > 0.0 { beyond.clamp(least * low, most * low) } else { first };
        };
        if lost - low <= tolerance * lost {
            // lost from farther off
            return lost;
        }
        let inside = MARGIN * (lost - low);
        let Some(peak) = peak.filter(|&peak| low < peak && peak < lost) else {
            return if low > 0.0 && lost > 2.0 * low { (low * lost).sqrt() } else { low + BELOW * (lost - low) };
        };
        // the side of the peak on which the bracket is wider
        let side = if lost - peak > peak - low { 0.25 } else { -0.25 };
        (peak * (1.0 + side * tolerance)).clamp(low + inside, lost - inside)
    }

    /// The tension to try while the pull-off is not enclosed: the ends of the expected tensions, then ever farther beyond.
    fn next_as_expected(&self) -> Option<f64> {
        let ([least, most], low) = (self.expected?, self.greatest());
        let beyond = match self.lost {
            None if low < least => least,
            None if low < most => most,
            None => (2.0 * low - least).min(GROWTH.1 * low),
            Some(lost) => 2.0 * lost - most,
        };
        let is_beyond = self.lost.is_none_or(|lost| lost <= least);
        (is_beyond && beyond > low).then_some(beyond)
    }

    /// The largest tension of the parabola over the distance through the last three places, if it has one.
    fn peak(&self) -> Option<f64> {
        let [.., a, b, c] = self.borne[..] else { return None };
        let slope = |from: Held, to: Held| (to.tension - from.tension) / (to.distance - from.distance);
        let bend = (slope(b, c) - slope(a, b)) / (c.distance - a.distance);
        let there = slope(b, c) + bend * (c.distance - b.distance);
        Some(c.tension - there * there / (4.0 * bend)).filter(|peak| bend < 0.0 && peak.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_parabola_is_found_and_enclosed() {
        let curve = |x: f64| 3.0 - (x - 2.0).powi(2);
        let places = [0.3, 0.8, 1.1].map(|distance| Held { distance, tension: curve(distance) });
        let mut bracket = Bracket { borne: places.to_vec(), ..Bracket::default() };
        assert!((bracket.peak().unwrap() - 3.0).abs() < 1e-12);
        let mut tries = 0;
        while !bracket.is_narrow(0.02) {
            let tension = bracket.next(0.1, 0.02);
            match tension <= 3.0 {
                true => bracket.bear(Held { distance: 2.0 - (3.0 - tension).sqrt(), tension }),
                false => bracket.lose(tension),
            }
            tries += 1;
        }
        assert!(tries <= 4 && bracket.greatest() <= 3.0 && bracket.lost > Some(3.0), "{tries}: {bracket:?}");
    }

    #[test]
    fn a_curve_of_teeth_is_enclosed_by_halving() {
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.0 }], ..Bracket::default() };
        let mut tries = 0;
        while !bracket.is_narrow(1e-3) {
            let tension = bracket.next(1e-3, 1e-3);
            match tension <= 0.7 {
                true => bracket.bear(Held { distance: 1.0 + (f64::from(tries) * 0.7).fract(), tension }),
                false => bracket.lose(tension),
            }
            tries += 1;
        }
        assert!(tries < 40 && bracket.greatest() <= 0.7 && bracket.lost > Some(0.7), "{tries}: {bracket:?}");
    }

    #[test]
    fn a_loss_by_a_long_step_is_tried_again_from_close_by() {
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.6 }], ..Bracket::default() };
        let (mut tries, mut early) = (0, 0);
        while !bracket.is_narrow(0.02) {
            let tension = bracket.next(0.6, 0.02);
            // a step longer than 0.2 jumps
            match tension <= 1.0 && tension <= bracket.greatest() + 0.2 {
                true => bracket.bear(Held { distance: tension, tension }),
                false => bracket.lose(tension),
            }
            early += usize::from(bracket.lost.is_some_and(|lost| lost <= 1.0));
            tries += 1;
        }
        assert!(
            early > 0 && tries < 40 && bracket.greatest() <= 1.0 && bracket.lost > Some(1.0),
            "{tries}: {bracket:?}"
        );
    }
}
