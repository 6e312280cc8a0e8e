//! A search: the greatest tension under which surfaces that adhere stay together.

use std::ops::ControlFlow;

use crate::constraint::{ContactConstraint, Wall};
use crate::elastic::Boundary;
use crate::error::{Error, Result};
use crate::problem::{Control, Problem, ProblemMut, smoothed_law};
use crate::real::Real;
use crate::setters::setters;
use crate::solver::{
    Begin, Branch, Iteration, Observer, Report, STRONGEST, Solution, Solved, Solver, Start, Status, check_wall,
    refuse_hardness, unload,
};

/// The most solves of a search; a bracket is halved at least with every other one.
const MOST: usize = 60;

/// The first tension, over the attraction of the surfaces under no load.
const FIRST: f64 = 1.0 / 16.0;

/// The attraction of surfaces at rest, over their energy of adhesion and its range: a tension that is tried.
const AT_REST: f64 = 0.1;

/// The least and the largest next tension over the last tension borne, as long as no tension is too large.
const GROWTH: (f64, f64) = (1.2, 2.5);

/// The share of a bracket that a tension leaves to both sides at least.
const MARGIN: f64 = 0.1;

/// A search for the pull-off: the greatest tension under which surfaces that adhere stay together.
///
/// The tension grows, each solve from the gap under the greatest tension borne, until the surfaces come apart
/// ([`Status::Detached`]); then the pull-off is between the two, and their bracket is narrowed until it is `tolerance`
/// wide. A loss counts only from a state within the tolerance of the lost tension: from a farther state it may be a
/// jump that shorter steps avoid, and is tried again from a closer state. Contacts that are lost on the way are lost
/// under the load, as on a soft spring. Before, the surfaces are pressed flat, as on the branch of unloading
/// ([`Branch`]), or to a `preload`. On the branch of unloading the pull-off is the largest tension with an equilibrium,
/// if the traction of the law falls with the gap.
///
/// | field | default | meaning | range |
/// |---|---|---|---|
/// | `tolerance` | 0.02 | the relative width of the bracket at which the search ends | positive, below 1 |
/// | `preload` | none | the mean pressure to which surfaces from afar were pressed before; flat if none is given | zero or positive |
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
        Self { tolerance: 0.02, preload: None }
    }
}

impl PullOff {
    setters! { tolerance: f64, preload: Option<f64> }

    /// The pull-off of a problem.
    ///
    /// # Errors
    /// [`Error::Unsuited`] without adhesion, and where surfaces under no load do not attract each other;
    /// [`Error::Value`] for a tolerance or a preload out of their ranges; [`Error::Unsuited`] for springs; errors of
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
        T::pull_off(*self, solver, problem, start, &mut observe)
    }

    pub(crate) fn search<T: Real>(
        self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        start: Start<'_, T>,
        observe: Observer<'_>,
    ) -> Result<FoundPullOff<T>> {
        let Self { tolerance, preload } = self;
        self.check(solver, problem)?;
        let mut search = Search { branch: None, solves: 0, operator_applications: 0, observe };
        let first = Control::MeanPressure(preload.unwrap_or(0.0));
        let usual = if preload.is_some() { Branch::Loading } else { Branch::Unloading };
        let branch = solver.settings.branch.unwrap_or(usual);
        let begin = if let Start::Default = start { Begin::On(branch) } else { Begin::At(start) };
        search.branch = begin.is_default().then_some(branch);
        let mut held = search.solve(solver, problem, first, begin)?;
        if preload.is_some_and(|preload| preload != 0.0) && held.is_settled() {
            let (pressed, touched) = (held.place(), held.solution.report.contact_nodes > 0);
            held = search.solve(solver, problem, Control::MeanPressure(0.0), Begin::Found(pressed.clone()))?;
            if touched && held.is_settled() && held.solution.report.contact_nodes == 0 {
                let solve = |control, begin: Begin<'_, T>| search.solve(solver, problem, control, begin);
                held = unload(solve, first, pressed)?.unwrap_or(held);
            }
        }
        if !held.is_settled() {
            return Ok(search.end(held, None, false));
        }
        // flat surfaces at rest have the energy of adhesion, and no traction
        let hints = problem.law_on_grid().hints();
        let stored = 0.0 - held.solution.report.adhesive_energy;
        let node = hints.work_of_adhesion.widen() / problem.grid().nodes() as f64;
        let at_rest = AT_REST * stored / hints.range.widen();
        let at_rest = if stored < STRONGEST * node || !at_rest.is_finite() { 0.0 } else { at_rest };
        let attraction = held.solution.report.mean_contact_pressure.max(at_rest);
        if attraction <= 0.0 {
            let reason =
                "the surfaces do not attract each other under no load: give a law of a longer range, or a preload";
            return Err(Error::Unsuited { what: "pull-off", reason });
        }
        let mut bracket = Bracket { borne: vec![Held::of(&held.solution.report)], lost: None, from: 0.0 };
        while !bracket.is_narrow(tolerance) && search.solves < MOST {
            let tension = bracket.next(FIRST * attraction, tolerance);
            let begin = Begin::Found(held.place());
            let solved = search.solve(solver, problem, Control::MeanPressure(-tension), begin)?;
            let report = &solved.solution.report;
            if solved.is_settled() {
                bracket.bear(Held { tension, ..Held::of(report) });
                held = solved;
            } else if report.status == Status::Detached {
                bracket.lose(tension);
            } else {
                break;
            }
        }
        Ok(search.end(held, bracket.lost, bracket.is_narrow(tolerance)))
    }

    fn check<T: Real>(&self, solver: &Solver<dyn ContactConstraint<T>>, problem: &Problem<T>) -> Result<()> {
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            let requirement = "positive, and less than 1";
            return Err(Error::Value { name: "tolerance of the pull-off", value: self.tolerance, requirement });
        }
        if let Some(preload) = self.preload {
            Error::non_negative("preload", preload)?;
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

/// The solves of a search.
struct Search<'a> {
    branch: Option<Branch>,
    solves: usize,
    operator_applications: usize,
    observe: Observer<'a>,
}

impl Search<'_> {
    fn solve<T: Real>(
        &mut self,
        solver: &mut Solver<dyn ContactConstraint<T>>,
        problem: &mut Problem<T>,
        control: Control,
        begin: Begin<'_, T>,
    ) -> Result<Solved<T>> {
        let parts = problem.parts();
        let smoothed = smoothed_law(&*parts.operator, parts.law);
        let parts = ProblemMut { law: smoothed.as_deref().unwrap_or(parts.law), ..parts };
        let solved = solver.run(parts, control, begin, &mut *self.observe)?;
        self.solves += 1;
        self.operator_applications += solved.solution.report.operator_applications;
        Ok(solved)
    }

    fn end<T: Real>(self, held: Solved<T>, lost: Option<f64>, reached: bool) -> FoundPullOff<T> {
        let Self { branch, solves, operator_applications, .. } = self;
        FoundPullOff { solution: held.solution, lost, reached, branch, solves, operator_applications }
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
#[derive(Debug)]
struct Bracket {
    borne: Vec<Held>,
    lost: Option<f64>,
    /// the tension that was borne before the loss
    from: f64,
}

impl Bracket {
    fn bear(&mut self, place: Held) {
        self.lost = self.lost.filter(|&lost| lost > place.tension);
        self.borne.push(place);
    }

    fn lose(&mut self, tension: f64) {
        (self.lost, self.from) = (Some(tension), self.greatest());
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
            return if low > 0.0 && lost > 2.0 * low { (low * lost).sqrt() } else { 0.5 * (low + lost) };
        };
        // the side of the peak on which the bracket is wider
        let side = if lost - peak > peak - low { 0.25 } else { -0.25 };
        (peak * (1.0 + side * tolerance)).clamp(low + inside, lost - inside)
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
        let mut bracket = Bracket { borne: places.to_vec(), lost: None, from: 0.0 };
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
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.0 }], lost: None, from: 0.0 };
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
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.6 }], lost: None, from: 0.0 };
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
