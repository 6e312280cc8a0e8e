//! A case to solve, and the account of its solve: the result, its stability and its cost.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::time::Instant;

use asperity::accuracy::{Accuracy, AccurateSolution, GridError};
use asperity::contact::ContactStatistics;
use asperity::nested::{Level, NestedSolution};
use asperity::search::FoundContact;
use asperity::stability::{ContactStiffness, Departure, Stability, StabilityTest, Verdict};
use asperity::{
    AdhesionLaw, ContactSearch, Control, Iteration, Nested, Problem, Report, Settings, Solution, Solver, Start, Surface,
};
use asperity_scene::{HalfSpace, Wall};
use ndarray::Array2;
use serde_json::Value;

use crate::accuracy::Reached;
use crate::numbers::percent;
use crate::options::Scalar;
use crate::outcome::Outcome;
use crate::progress::Progress;

/// The case to solve: the material, the load and the settings; the surface and the law are apart.
pub struct Case {
    pub half_space: HalfSpace,
    /// The load; of no meaning where a contact fraction is wanted.
    pub control: Control,
    /// The contact fraction for which a load is to be found, if one is.
    pub fraction: Option<f64>,
    pub settings: Settings,
    /// What keeps the surfaces apart.
    pub wall: Wall,
    /// Whether to test the stability of the solution.
    pub stability: bool,
    /// Whether to go on from an unstable solution.
    pub leave: bool,
    /// Whether to find the contact stiffness of the solution.
    pub stiffness: bool,
    /// Whether to solve on nested grids; where it is not said, if that is faster.
    pub nested: Option<bool>,
}

impl Case {
    /// The relative error to which the contact stiffness is to be found, if it is.
    pub fn stiffness_to(&self) -> Option<f64> {
        self.stiffness.then_some(ContactStiffness::TOLERANCE)
    }

    /// Whether to solve on coarser grids first: if that is asked for, or faster from the default start.
    fn nests<T: Scalar>(&self, surface: &Surface, law: &dyn AdhesionLaw<T>, started: bool) -> bool {
        let pays = || Nested::new(self.settings).pays(surface, law, self.control);
        let may = || !started && !self.stability && self.wall == Wall::Hard && self.fraction.is_none();
        self.nested.unwrap_or_else(|| may() && pays())
    }

    /// The case on the other branch than that of a solution, without what is asked for beside it.
    pub fn on_other_branch(&self, report: &Report) -> Outcome<Self> {
        let Some(branch) = report.branch else {
            return Err("--branch both: without adhesion there is but one equilibrium".into());
        };
        let settings = self.settings.branch(branch.other());
        Ok(Self { settings, stability: false, leave: false, stiffness: false, ..*self })
    }

    /// The solver.
    pub fn solver(&self) -> Solver<Wall> {
        Solver { settings: self.settings, constraint: self.wall }
    }
}

/// The stability of a solution; see [`asperity::stability::Stability`].
pub struct Steadiness {
    pub verdict: Verdict,
    pub eigenvalue: f64,
    pub residual: f64,
    pub lower_bound: f64,
    pub error_bound: Option<f64>,
    pub smoothed: bool,
    pub operator_applications: usize,
    pub mode: Array2<f64>,
}

/// An unstable equilibrium that was left; see [`asperity::stability::Departure`].
pub struct Left {
    pub eigenvalue: f64,
    pub energy_drop: f64,
    pub distance: f64,
}

/// The solution on the other branch of equilibria.
pub struct Other {
    pub report: Report,
    /// Its distance in the energy norm; see [`asperity::Solution::distance`].
    pub distance: f64,
    /// Whether the equilibrium is one.
    pub same: bool,
}

/// The search for the load of a contact fraction; see [`asperity::search::FoundContact`].
pub struct Search {
    pub wanted: f64,
    pub reached: bool,
    pub below: Option<f64>,
    pub above: Option<f64>,
    pub solves: usize,
    pub operator_applications: usize,
}

impl Search {
    /// The search for a fraction.
    pub fn of<T>(wanted: f64, found: &FoundContact<T>) -> Self {
        let &FoundContact { reached, below, above, solves, operator_applications, .. } = found;
        Self { wanted, reached, below, above, solves, operator_applications }
    }

    /// Where it ended, if the fraction was not reached by a solve that has converged.
    pub fn told(&self) -> String {
        let share =
            |fraction: Option<f64>| fraction.map_or("nothing".to_owned(), |share| format!("{} %", percent(share)));
        format!(
            "no load was found with {} % contact: it jumps from {} to {}, and the nearer one is written",
            percent(self.wanted),
            share(self.below),
            share(self.above)
        )
    }
}

/// The largest number of departures from unstable equilibria; a sane case takes a few.
const MOST_DEPARTURES: usize = 10;

/// The account of a solve, for the table and the report.
pub struct Account {
    pub report: Report,
    /// The search for the load, if there was one.
    pub search: Option<Search>,
    pub nodes: usize,
    /// The contact and its edge, without statistics of the attraction.
    pub contact: ContactStatistics,
    /// The least (most tensile) and the greatest elastic pressure.
    pub pressures: (f64, f64),
    /// The nested grids, if they were used, and their applications in units of one on the finest.
    pub grids: Option<(Vec<Level>, f64)>,
    /// The time for setting up and solving, stability included, without that for files and pictures.
    pub seconds: f64,
    pub stability: Option<Steadiness>,
    /// The contact stiffness, if it was asked for.
    pub stiffness: Option<ContactStiffness>,
    /// The nodes of the shortest wave of the surface, for the error of the grid; zero where that is not asked for.
    pub nodes_per_wave: f64,
    /// What became of an accuracy, if one was asked for.
    pub reached: Option<Reached>,
    /// The solution on the other branch, if both are asked for.
    pub other: Option<Other>,
    /// The unstable equilibria on the way to the solution, in order.
    pub departures: Vec<Left>,
    /// The node with the largest work of adhesion, where that varies.
    pub strongest: Option<(usize, usize)>,
    /// The warnings, as a report lists them.
    pub warnings: Value,
}

/// Solves a case on nested grids or on one, and frees the surface as soon as the problem has its heights.
pub fn solve<T: Scalar, L: AdhesionLaw<T>>(
    surface: Surface,
    law: L,
    case: &Case,
    start: Option<Array2<T>>,
    mut progress: Progress,
) -> Outcome<(Solution<T>, Account)> {
    if case.nests(&surface, &law, start.is_some()) {
        return solve_nested(&surface, law, case, progress);
    }
    let clock = Instant::now();
    let grid = *surface.grid();
    let mut problem = Problem::new(&surface, case.half_space.operator(grid)?, law)?;
    drop(surface);
    let start = start.as_ref().map_or(Start::Default, |start| Start::From(start));
    let mut solver = case.solver();
    let observe = |state: &Iteration| {
        progress.update(state);
        ControlFlow::Continue(())
    };
    let (mut solution, search) = match case.fraction {
        Some(fraction) => {
            let mut search = ContactSearch::new(&mut solver, &mut problem)?;
            if let Start::From(gap) = start {
                search = search.starting_from(gap.to_owned());
            }
            let found = search.at_observed(fraction, observe)?;
            let search = Search::of(fraction, &found);
            (found.solution, Some(search))
        }
        None => (solver.solve_with(&mut problem, case.control, start, observe)?, None),
    };
    let mut departures = Vec::new();
    let stability = loop {
        if !case.stability {
            break None;
        }
        let found = StabilityTest::default().run_with(&mut problem, &case.wall, &solution)?;
        let leaves = case.leave && found.verdict == Verdict::Unstable && departures.len() < MOST_DEPARTURES;
        let left = if leaves { found.leave(&mut solver, &mut problem, &solution)? } else { None };
        let Some(left) = left.filter(|left| left.energy_drop > 0.0) else {
            break Some(steadiness(found));
        };
        let Departure { energy_drop, distance, .. } = left;
        departures.push(Left { eigenvalue: found.eigenvalue, energy_drop, distance });
        solution = left.solution;
    };
    let find = || ContactStiffness::of_constrained(&mut problem, &case.wall, &solution, ContactStiffness::TOLERANCE);
    let stiffness = case.stiffness.then(find).transpose()?;
    let (solution, account) = account(solution, problem.law(), None, clock)?;
    Ok((solution, Account { search, stability, stiffness, departures, ..account }))
}

/// Solves a case on nested grids.
fn solve_nested<T: Scalar, L: AdhesionLaw<T>>(
    surface: &Surface,
    law: L,
    case: &Case,
    mut progress: Progress,
) -> Outcome<(Solution<T>, Account)> {
    let clock = Instant::now();
    let half_space = |grid| case.half_space.operator(grid);
    let tolerance = case.settings.tolerance_in::<T>();
    let found = Nested::with_solver(case.solver())
        .coarse_tolerance(GridError::COARSE_TOLERANCE)
        .stiffness(case.stiffness_to())
        .solve_observed(surface, half_space, &law, case.control, |grid, state| {
            let finest = grid.nodes() == surface.grid().nodes();
            progress.update_on(
                grid,
                state,
                if finest { tolerance } else { tolerance.max(GridError::COARSE_TOLERANCE) },
            );
            ControlFlow::Continue(())
        })?;
    let applications = found.equivalent_applications();
    let NestedSolution { solution, levels, .. } = found;
    let stiffness = levels.last().and_then(|finest| finest.stiffness);
    let (solution, account) = account(solution, &law, Some((levels, applications)), clock)?;
    let nodes_per_wave = surface.nodes_per_wave(account.report.boundary);
    Ok((solution, Account { stiffness, nodes_per_wave, ..account }))
}

/// Solves a case to an accuracy; returns the surface on the grid of the answer, too.
pub fn solve_to<T: Scalar, L: AdhesionLaw<T>>(
    surface: &Surface,
    law: L,
    case: &Case,
    wanted: &mut Accuracy<Wall>,
    mut progress: Progress,
) -> Outcome<(Surface, Solution<T>, Account)> {
    let clock = Instant::now();
    let half_space = |grid| case.half_space.operator(grid);
    let tolerance = wanted.tolerance()?;
    let found = wanted.solve_observed(surface, half_space, &law, case.control, |grid, state| {
        progress.update_on(grid, state, tolerance);
        ControlFlow::Continue(())
    })?;
    let applications = found.equivalent_applications();
    let AccurateSolution { solution, surface, levels, error, reached, refinable, unaffordable, .. } = found;
    let stiffness = levels.last().and_then(|finest| finest.stiffness);
    let reached = Reached { accuracy: wanted.target, of: wanted.of, reached, error, unaffordable, refinable };
    let (solution, account) = account(solution, &law, Some((levels, applications)), clock)?;
    let nodes_per_wave = surface.nodes_per_wave(account.report.boundary);
    Ok((surface, solution, Account { stiffness, nodes_per_wave, reached: Some(reached), ..account }))
}

fn account<T: Scalar>(
    solution: Solution<T>,
    law: &impl AdhesionLaw<T>,
    grids: Option<(Vec<Level>, f64)>,
    clock: Instant,
) -> Outcome<(Solution<T>, Account)> {
    let seconds = clock.elapsed().as_secs_f64();
    check_finite(&solution)?;
    let least = (f64::INFINITY, f64::NEG_INFINITY);
    let pressures = solution.pressure.iter().fold(least, |(low, high), p| (low.min(p.widen()), high.max(p.widen())));
    let pressures = solution.grid.extremes(pressures);
    let account = Account {
        report: solution.report.clone(),
        search: None,
        nodes: solution.grid.nodes(),
        contact: ContactStatistics::of(&solution, law)?,
        pressures,
        grids,
        seconds,
        stability: None,
        stiffness: None,
        nodes_per_wave: 0.0,
        reached: None,
        other: None,
        departures: Vec::new(),
        strongest: None,
        warnings: Value::Array(Vec::new()),
    };
    Ok((solution, account))
}

fn steadiness<T: Scalar>(found: Stability<T>) -> Steadiness {
    Steadiness {
        verdict: found.verdict,
        eigenvalue: found.eigenvalue,
        residual: found.residual,
        lower_bound: found.lower_bound,
        error_bound: found.error_bound,
        smoothed: found.smoothed,
        operator_applications: found.operator_applications + found.bound_applications,
        mode: found.mode.mapv_into_any(T::widen),
    }
}

/// Refuses fields that are not finite, as of a solve that has run away.
pub fn check_finite<T: Scalar>(solution: &Solution<T>) -> Outcome<()> {
    let Solution { gap, pressure, contact_pressure, grid, report, .. } = solution;
    let fields = [("gap", gap), ("pressure", pressure), ("contact pressure", contact_pressure)];
    for (name, field) in fields {
        let count = grid.total(field.iter().filter(|value| !value.is_finite()).count());
        // at absent nodes the gap is infinite
        let absent = if name == "gap" { report.absent_nodes } else { 0 };
        if count != absent {
            let other = if T::NAME == "f32" { "--precision f64" } else { "another start by --initial-gap" };
            return Err(format!(
                "the solve ran away: after {} iterations in {} the {name} is not finite at {count} of {} nodes; use {other}, or \
                 units in which the numbers are moderate",
                report.iterations,
                T::NAME,
                grid.nodes()
            )
            .into());
        }
    }
    Ok(())
}

/// The gap as files have it: NaN at absent nodes, where there is none.
pub fn gap_to_write<T: Scalar>(solution: &Solution<T>) -> Cow<'_, Array2<T>> {
    if solution.report.absent_nodes == 0 {
        return Cow::Borrowed(&solution.gap);
    }
    Cow::Owned(solution.gap.mapv(|gap| if gap.is_finite() { gap } else { T::nan() }))
}
