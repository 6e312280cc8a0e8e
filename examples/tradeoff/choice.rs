//! The choices of a user, and their cost.

use std::ops::ControlFlow;
use std::time::Instant;

use asperity::{Control, Nested, Problem, Real, Settings, Solution, Solver, Start, Status, Surface, Westergaard};
use ndarray::Array2;

use crate::scene::{Scene, State};
use common::Outcome;

/// The tolerance at which `f64` takes over from `f32`: above the rounding floor of light contacts of smooth bodies, on
/// which it would stall.
const HANDOVER: f64 = 1e-3;
/// The largest grid that has no coarser ones below it.
const COARSEST: usize = 64;
/// The largest grid for Algorithm 3, whose applications grow with the number of nodes along a side.
const SLOW: usize = 256;
/// Where a solve is repeated no more, in seconds.
const LONG: f64 = 0.2;

#[derive(Clone, Copy, PartialEq)]
pub enum Precision {
    Single,
    Double,
    /// `f32` first, `f64` to finish.
    Mixed,
}

#[derive(Clone, Copy, PartialEq)]
pub struct Choice {
    /// Algorithm 3 of Rey, Anciaux and Molinari (2017), with the certified error as its criterion.
    pub rey2017: bool,
    pub precision: Precision,
    pub nested: bool,
    pub tolerance: f64,
}

impl Choice {
    /// The default, to a tolerance.
    pub fn sharp(tolerance: f64) -> Self {
        Self { rey2017: false, precision: Precision::Double, nested: false, tolerance }
    }

    /// The choices that are measured on a grid.
    pub fn all(n: usize, quick: bool) -> Vec<Self> {
        let mut all = Vec::new();
        let thin =
            |tolerances: &[f64]| tolerances.iter().copied().step_by(if quick { 2 } else { 1 }).collect::<Vec<_>>();
        for (precision, tolerances) in [
            (Precision::Double, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8][..]),
            (Precision::Single, &[1e-2, 1e-3, 1e-4, 1e-5]),
            (Precision::Mixed, &[1e-5, 1e-6]),
        ] {
            for nested in [false, true].into_iter().filter(|nested| !nested || n > COARSEST) {
                let choice = |tolerance| Self { precision, nested, ..Self::sharp(tolerance) };
                all.extend(thin(tolerances).into_iter().map(choice));
            }
        }
        if n <= SLOW {
            let choice = |tolerance| Self { rey2017: true, ..Self::sharp(tolerance) };
            all.extend(thin(&[1e-2, 1e-4, 1e-6]).into_iter().map(choice));
        }
        all
    }

    /// Its name but for the tolerance.
    pub fn family(&self) -> &'static str {
        match (self.rey2017, self.precision, self.nested) {
            (true, ..) => "rey2017, f64",
            (_, Precision::Double, false) => "default, f64",
            (_, Precision::Double, true) => "nested, f64",
            (_, Precision::Single, false) => "default, f32",
            (_, Precision::Single, true) => "nested, f32",
            (_, Precision::Mixed, false) => "default, f32 then f64",
            (_, Precision::Mixed, true) => "nested, f32 then f64",
        }
    }

    fn settings(&self, tolerance: f64) -> Settings {
        if self.rey2017 { Settings::rey2017().tolerance(tolerance) } else { Settings::default().tolerance(tolerance) }
    }
}

/// The result of a choice.
pub struct Found {
    pub state: State,
    pub status: Status,
    /// The certified relative error.
    pub certified: f64,
    /// From the heights in memory to the solution in memory.
    pub seconds: f64,
    /// Operator applications in `f32` and in `f64`, in units of one on the grid, with those that construct problems.
    pub applications: [f64; 2],
}

impl Found {
    /// Refuses a reference that has not converged.
    pub fn must_have_converged(&self, scene: &str, n: usize) -> Outcome<()> {
        if self.status == Status::Converged {
            return Ok(());
        }
        Err(format!("{scene} at {n}²: the reference ended as {} at {:.1e}", self.status, self.certified).into())
    }
}

/// Solves once.
pub fn run(scene: &Scene, surface: &Surface, control: Control, choice: Choice) -> Outcome<Found> {
    let begin = Instant::now();
    let tolerance = choice.tolerance;
    match choice.precision {
        Precision::Single => {
            let (solution, count) = solve::<f32>(scene, surface, control, choice, tolerance, None)?;
            found(surface, control, solution, begin, [count, 0.0])
        }
        Precision::Double => {
            let (solution, count) = solve::<f64>(scene, surface, control, choice, tolerance, None)?;
            found(surface, control, solution, begin, [0.0, count])
        }
        Precision::Mixed => {
            let handover = tolerance.max(HANDOVER);
            let (near, single) = solve::<f32>(scene, surface, control, choice, handover, None)?;
            let gap = near.gap.mapv(f64::from);
            drop(near);
            let (solution, double) = solve::<f64>(scene, surface, control, choice, tolerance, Some(gap))?;
            found(surface, control, solution, begin, [single, double])
        }
    }
}

/// Solves several times if that is short: the time is the median.
pub fn measure(scene: &Scene, surface: &Surface, control: Control, choice: Choice) -> Outcome<Found> {
    let mut first = run(scene, surface, control, choice)?;
    let mut times = vec![first.seconds];
    while times.len() < 5 && times.iter().sum::<f64>() < LONG {
        times.push(run(scene, surface, control, choice)?.seconds);
    }
    times.sort_by(f64::total_cmp);
    first.seconds = times[times.len() / 2];
    Ok(first)
}

fn found<T: Real>(
    surface: &Surface,
    control: Control,
    solution: Solution<T>,
    begin: Instant,
    applications: [f64; 2],
) -> Outcome<Found> {
    let seconds = begin.elapsed().as_secs_f64();
    let state = State::of(&solution, surface, control)?;
    let (status, certified) = (solution.report.status, solution.report.relative_error);
    Ok(Found { state, status, certified, seconds, applications })
}

/// The solution in one precision, from a solution `near` it if there is one, and how many applications it took.
fn solve<T: Real>(
    scene: &Scene,
    surface: &Surface,
    control: Control,
    choice: Choice,
    tolerance: f64,
    near: Option<Array2<T>>,
) -> Outcome<(Solution<T>, f64)> {
    let settings = choice.settings(tolerance);
    let half_space = |grid| Westergaard::<T>::new(grid, 1.0);
    if choice.nested && near.is_none() {
        let mut solver = Solver::new(settings);
        let nested = Nested::default().solve(&mut solver, surface, half_space, scene.law::<T>()?, control)?;
        let count = nested.equivalent_applications();
        return Ok((nested.solution, count));
    }
    let mut problem = Problem::new(surface, half_space(*surface.grid())?, scene.law::<T>()?)?;
    let mut solver = Solver::new(settings);
    let start = near.map_or(Start::Default, Start::Near);
    let solution = solver.solve_with(&mut problem, control, start, |_| ControlFlow::Continue(()))?;
    let count = solution.report.operator_applications + 1;
    Ok((solution, count as f64))
}
