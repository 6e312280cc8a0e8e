//! One solve for any command, with its stability and its warnings.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use asperity::contact::ContactStatistics;
use asperity::picture::{Colouring, Map};
use asperity::stability::{Departure, Stability, StabilityTest, Verdict};
use asperity::{
    AdhesionLaw, Control, Error, Grid, Level, Nested, NestedSolution, NoAdhesion, Problem, Real, Report, Result,
    Settings, Solution, Solver, Start, Surface, Westergaard,
};
use ndarray::Array2;
use ndarray_npy::WritableElement;
use serde_json::Value;

use crate::Outcome;
use crate::numbers::percent;
use crate::progress::Progress;

/// A scalar in which one can solve, and that can be written.
pub trait Scalar: Real + WritableElement {}
impl<T: Real + WritableElement> Scalar for T {}

/// The case to solve, beside the surface and the law.
pub struct Case {
    pub modulus: f64,
    pub control: Control,
    pub settings: Settings,
    /// Whether to find out if the solution is stable.
    pub stability: bool,
    /// Whether to go on from a solution that is not.
    pub leave: bool,
}

/// Whether a solution is stable; see [`asperity::stability::Stability`].
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

/// After so many departures something is wrong.
const MOST_DEPARTURES: usize = 10;

/// The account of a solve, for the table and the report.
pub struct Account {
    pub report: Report,
    pub nodes: usize,
    /// Contact and its edge; what attracts is left out.
    pub contact: ContactStatistics,
    /// The least (most tensile) and the greatest elastic pressure.
    pub pressures: (f64, f64),
    /// The nested grids, if they were used, and their applications in units of one on the finest.
    pub grids: Option<(Vec<Level>, f64)>,
    /// The time for setting up and solving, stability included, without that for files and pictures.
    pub seconds: f64,
    pub stability: Option<Steadiness>,
    /// What was left on the way to the solution, the first first.
    pub departures: Vec<Left>,
    /// What is probably a mistake, as a report has it.
    pub warnings: Value,
}

/// Solves, and drops the surface as soon as it is not needed.
pub fn solve<T: Scalar, L: AdhesionLaw<T>>(
    surface: Surface,
    law: L,
    case: &Case,
    start: Option<Array2<T>>,
    mut progress: Progress,
) -> Outcome<(Solution<T>, Account)> {
    let clock = Instant::now();
    let grid = *surface.grid();
    let mut problem = Problem::new(&surface, Westergaard::new(grid, case.modulus)?, law)?;
    drop(surface);
    let start = start.as_ref().map_or(Start::Default, |start| Start::From(start));
    let mut solver = Solver::new(case.settings);
    let mut solution = solver.solve_with(&mut problem, case.control, start, |state| {
        progress.update(state);
        ControlFlow::Continue(())
    })?;
    let mut departures = Vec::new();
    let stability = loop {
        if !case.stability {
            break None;
        }
        let found = StabilityTest::default().run(&mut problem, case.control, &solution)?;
        let leaves = case.leave && found.verdict == Verdict::Unstable && departures.len() < MOST_DEPARTURES;
        let left = if leaves { found.leave(&mut solver, &mut problem, case.control, &solution)? } else { None };
        let Some(left) = left.filter(|left| left.energy_drop > 0.0) else {
            break Some(steadiness(found));
        };
        let Departure { energy_drop, distance, .. } = left;
        departures.push(Left { eigenvalue: found.eigenvalue, energy_drop, distance });
        solution = left.solution;
    };
    let (solution, account) = account(solution, &grid, None, clock)?;
    Ok((solution, Account { stability, departures, ..account }))
}

/// Solves on coarser grids first.
pub fn solve_nested<T: Scalar, L: AdhesionLaw<T>>(
    surface: &Surface,
    law: L,
    case: &Case,
    mut progress: Progress,
) -> Outcome<(Solution<T>, Account)> {
    let clock = Instant::now();
    let half_space = |grid| Westergaard::new(grid, case.modulus);
    let found = Nested::new(case.settings).solve_observed(surface, half_space, law, case.control, |grid, state| {
        progress.update_on(grid, state);
        ControlFlow::Continue(())
    })?;
    let applications = found.equivalent_applications();
    let NestedSolution { solution, levels, .. } = found;
    account(solution, surface.grid(), Some((levels, applications)), clock)
}

fn account<T: Scalar>(
    solution: Solution<T>,
    grid: &Grid,
    grids: Option<(Vec<Level>, f64)>,
    clock: Instant,
) -> Outcome<(Solution<T>, Account)> {
    let seconds = clock.elapsed().as_secs_f64();
    check_finite(&solution)?;
    let pressures = solution
        .pressure
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.widen()), high.max(p.widen())));
    let account = Account {
        report: solution.report.clone(),
        nodes: solution.gap.len(),
        contact: ContactStatistics::of(&solution, grid, &NoAdhesion)?,
        pressures,
        grids,
        seconds,
        stability: None,
        departures: Vec::new(),
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
    let Solution { gap, pressure, contact_pressure, report, .. } = solution;
    let fields = [("gap", gap), ("pressure", pressure), ("contact pressure", contact_pressure)];
    for (name, field) in fields {
        let count = field.iter().filter(|value| !value.is_finite()).count();
        if count > 0 {
            let other = if T::NAME == "f32" { "--precision f64" } else { "another start by --initial-gap" };
            return Err(format!(
                "the solve ran away: after {} iterations in {} the {name} is not finite at {count} of {} nodes; use {other}, or \
                 units in which the numbers are moderate",
                report.iterations,
                T::NAME,
                field.len()
            )
            .into());
        }
    }
    Ok(())
}

/// Makes every solve of this process use so many threads.
#[cfg(feature = "parallel")]
pub fn use_threads(threads: Option<usize>) -> Outcome<usize> {
    if let Some(threads) = threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        pool.map_err(|e| format!("{threads} threads cannot be started ({e}): use fewer --threads"))?;
    }
    Ok(rayon::current_num_threads())
}

/// Refuses more threads than one, the only one there is.
#[cfg(not(feature = "parallel"))]
pub fn use_threads(threads: Option<usize>) -> Outcome<usize> {
    match threads {
        Some(threads) if threads > 1 => {
            Err(format!("--threads is {threads}: this tool was built without threads, leave the option out").into())
        }
        _ => Ok(1),
    }
}

/// The grid of a map with the given `--lengths`: one of them means square cells, none the unit square.
pub fn grid((nx, ny): (usize, usize), lengths: Option<&[f64]>) -> Result<Grid> {
    let lengths = match lengths {
        Some([lx, ly, ..]) => (*lx, *ly),
        Some([lx]) => (*lx, lx / nx as f64 * ny as f64),
        _ => (1.0, 1.0),
    };
    Grid::new((nx, ny), lengths)
}

/// The units that pictures have on their axes.
#[derive(Clone, Copy)]
pub struct Units<'a> {
    pub length: Option<&'a str>,
    pub pressure: Option<&'a str>,
}

/// Draws the nodes in contact, black on white.
pub fn draw_contact(path: &Path, grid: Grid, title: &str, units: Units<'_>, contact: &Array2<bool>) -> Result<()> {
    let contact = contact.mapv(|touches| f64::from(u8::from(touches)));
    let caption = format!("{} % contact", percent(contact.sum() / contact.len() as f64));
    let map = Map {
        title,
        caption: &caption,
        length_unit: units.length,
        label: "contact",
        ..Map::new(contact.view(), grid, Colouring::Binary)
    };
    map.write_png(path)
}

/// The pressure that a map should show: without adhesion, what there is outside of the contact is only what remains of
/// the error, and would look like attraction on a scale of its own.
pub fn pressure_to_draw<T>(solution: &Solution<T>, adhesive: bool) -> &Array2<T> {
    if adhesive { &solution.pressure } else { &solution.contact_pressure }
}

/// Draws a pressure, compression red and attraction blue.
pub fn draw_pressure<T: Scalar>(
    path: &Path,
    grid: Grid,
    title: &str,
    caption: &str,
    units: Units<'_>,
    pressure: &Array2<T>,
) -> Result<()> {
    let pressure = pressure.mapv(T::widen);
    let map = Map {
        title,
        caption,
        length_unit: units.length,
        label: "pressure",
        unit: units.pressure,
        ..Map::new(pressure.view(), grid, Colouring::Diverging)
    };
    map.write_png(path)
}

/// Names the place where a file would have appeared, and not the hidden one where it could not be written.
pub fn at_destination(error: Error, folder: &Path) -> Error {
    match error {
        Error::File { path, reason } => {
            Error::File { path: path.file_name().map_or_else(|| folder.to_owned(), |name| folder.join(name)), reason }
        }
        other => other,
    }
}
