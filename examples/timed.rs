//! Times solves, or operator applications, of given heights: a line of JSON for each repetition.
//!
//! `cargo run --release -p asperity-examples --example timed`
//!
//! `seconds` counts from the heights in memory to the solution in memory, `solve` only the solve without the
//! construction of operator and problem; `processor` is the time of all threads in `seconds`. `peak` is the largest
//! resident memory of the process, in bytes, from before the repetition to its end (Linux only). `benches/peers` runs
//! this against other programs.

use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use asperity::{
    AdhesionLaw, Boussinesq, Control, ElasticOperator, Exponential, Grid, Nested, NoAdhesion, Problem, Real, Settings,
    Solution, Solver, Start, Surface, Westergaard,
};
use asperity_maps::io::{read_field, write_npy};
use clap::{ArgGroup, Parser, ValueEnum};
use common::arguments::{self, Precision};
use common::{Outcome, memory};
use cpu_time::ProcessTime;
use ndarray::Array2;
use serde_json::json;

/// The tolerance of the solve in single precision, on every grid.
const SINGLE: f64 = 1e-4;

#[derive(Parser)]
#[command(group(ArgGroup::new("job").required(true)))]
struct Options {
    /// Heights on a square of side 1 (or a rectangle of square cells, Lx = 1), with a contact modulus of 1
    heights: PathBuf,
    /// The mean pressure that is held
    #[arg(long, value_name = "P", group = "job", allow_negative_numbers = true)]
    pressure: Option<f64>,
    /// The mean gap that is held
    #[arg(long, value_name = "G", group = "job", allow_negative_numbers = true)]
    gap: Option<f64>,
    /// The approach that is held
    #[arg(long, value_name = "D", group = "job", allow_negative_numbers = true)]
    approach: Option<f64>,
    /// No solve, but the periodic operator: the median of N applications, after two that do not count
    #[arg(long, value_name = "N", group = "job", value_parser = arguments::nodes::<1>)]
    apply: Option<usize>,
    #[arg(long, default_value = "periodic")]
    boundary: Boundary,
    #[arg(long, default_value = "f64")]
    precision: Precision,
    /// The certified relative error at which the solve ends; of the precision unless given
    #[arg(long)]
    tolerance: Option<f64>,
    /// The work of adhesion of the exponential law; no adhesion unless given
    #[arg(long, value_name = "W", requires = "range")]
    work: Option<f64>,
    /// Its range
    #[arg(long, value_name = "R", requires = "work")]
    range: Option<f64>,
    /// Nested grids where they pay, one grid, nested grids, or these in f32 to 1e-4 and on in f64
    #[arg(long, default_value = "default")]
    method: Method,
    /// How often
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeat: usize,
    /// A file for the elastic pressure p + p̄ of the last solve, in f64
    #[arg(long, value_name = "FILE.npy")]
    save: Option<PathBuf>,
}

#[derive(Clone, ValueEnum)]
enum Boundary {
    Periodic,
    Free,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    Default,
    Single,
    Nested,
    Mixed,
}

/// A half-space of contact modulus 1, in either precision.
trait HalfSpace {
    type Operator<T: Real>: ElasticOperator<T> + 'static;
    fn new<T: Real>(grid: Grid) -> asperity::Result<Self::Operator<T>>;
}

struct Periodic;

impl HalfSpace for Periodic {
    type Operator<T: Real> = Westergaard<T>;
    fn new<T: Real>(grid: Grid) -> asperity::Result<Westergaard<T>> {
        Westergaard::new(grid, 1.0)
    }
}

struct Free;

impl HalfSpace for Free {
    type Operator<T: Real> = Boussinesq<T>;
    fn new<T: Real>(grid: Grid) -> asperity::Result<Boussinesq<T>> {
        Boussinesq::new(grid, 1.0)
    }
}

fn main() -> Outcome<()> {
    let options: Options = arguments::read(include_str!("timed.rs"));
    let heights = read_field(&options.heights)?;
    match options.precision {
        Precision::F64 => time::<f64>(heights, &options),
        Precision::F32 => time::<f32>(heights, &options),
    }
}

fn time<T: Real>(heights: Array2<f64>, options: &Options) -> Outcome<()> {
    let (nx, ny) = heights.dim();
    let grid = Grid::new((nx, ny), (1.0, ny as f64 / nx as f64))?;
    if let Some(count) = options.apply {
        return apply::<T>(grid, &heights, count, options.repeat);
    }
    let surface = Surface::new(grid, heights)?;
    match options.boundary {
        Boundary::Periodic => stick::<T, Periodic>(&surface, options),
        Boundary::Free => stick::<T, Free>(&surface, options),
    }
}

fn stick<T: Real, H: HalfSpace>(surface: &Surface, options: &Options) -> Outcome<()> {
    match options.work.zip(options.range) {
        Some((work, range)) => solve::<T, H, _>(surface, Exponential::new(work, range)?, options),
        None => solve::<T, H, _>(surface, NoAdhesion, options),
    }
}

fn solve<T: Real, H: HalfSpace, L: AdhesionLaw<T> + AdhesionLaw<f32> + Copy + 'static>(
    surface: &Surface,
    law: L,
    options: &Options,
) -> Outcome<()> {
    let pressure = options.pressure.map(Control::MeanPressure);
    let held = pressure.or(options.gap.map(Control::MeanGap)).or(options.approach.map(Control::Approach));
    let control = held.ok_or("nothing is held")?;
    let settings = Settings::default().tolerance(options.tolerance);
    let tolerance = settings.tolerance_in::<T>();
    let method = match options.method {
        Method::Default if Nested::default().pays::<T>(&settings, surface, &law, control) => Method::Nested,
        Method::Default => Method::Single,
        method => method,
    };
    for _ in 0..options.repeat {
        forget_peak();
        let (begin, busy) = (Instant::now(), ProcessTime::now());
        let (solution, seconds) = match method {
            Method::Default | Method::Single => run::<T, H>(surface, law, control, settings, None)?,
            Method::Nested => nested::<T, H>(surface, law, control, settings)?,
            // what single precision reaches is then all that is wanted
            Method::Mixed if T::NAME == "f32" || tolerance >= SINGLE => {
                nested::<T, H>(surface, law, control, settings)?
            }
            Method::Mixed => {
                let settings_single = settings.tolerance(SINGLE);
                let (near, seconds) = nested::<f32, H>(surface, law, control, settings_single)?;
                let gap = near.gap.mapv(|g| T::lit(g.widen()));
                drop(near);
                let (solution, more) = run::<T, H>(surface, law, control, settings, Some(gap))?;
                (solution, seconds + more)
            }
        };
        let (total, processor, peak) = (begin.elapsed(), busy.elapsed(), memory::peak());
        let report = &solution.report;
        let line = json!({
            "seconds": total.as_secs_f64(),
            "solve": seconds,
            "processor": processor.as_secs_f64(),
            "area": report.contact_fraction,
            "mean_gap": report.mean_gap,
            "mean_pressure": report.mean_pressure,
            "approach": report.approach,
            "applications": report.operator_applications,
            "relative_error": report.relative_error,
            "status": report.status.name(),
            "peak": peak,
        });
        println!("{line}");
        if let Some(path) = &options.save {
            write_npy(path, &solution.pressure.mapv(Real::widen))?;
        }
    }
    Ok(())
}

/// The solution, and the seconds that the solve alone took; `near` is where it starts, if that is known.
fn run<T: Real, H: HalfSpace>(
    surface: &Surface,
    law: impl AdhesionLaw<T> + 'static,
    control: Control,
    settings: Settings,
    near: Option<Array2<T>>,
) -> Outcome<(Solution<T>, f64)> {
    let mut problem = Problem::new(surface, H::new::<T>(*surface.grid())?, law)?;
    let begin = Instant::now();
    let mut solver = Solver::new(settings);
    let start = near.map_or(Start::Default, Start::Near);
    let solution = solver.solve_with(&mut problem, control, start, |_| ControlFlow::Continue(()))?;
    Ok((solution, begin.elapsed().as_secs_f64()))
}

fn nested<T: Real, H: HalfSpace>(
    surface: &Surface,
    law: impl AdhesionLaw<T> + 'static,
    control: Control,
    settings: Settings,
) -> Outcome<(Solution<T>, f64)> {
    let begin = Instant::now();
    let solution = Nested::default().solve(&mut Solver::new(settings), surface, H::new::<T>, law, control)?.solution;
    Ok((solution, begin.elapsed().as_secs_f64()))
}

fn apply<T: Real>(grid: Grid, heights: &Array2<f64>, count: usize, repeat: usize) -> Outcome<()> {
    let displacement = heights.mapv(T::lit);
    let mut pressure = Array2::zeros(grid.shape());
    let mut operator = Westergaard::<T>::new(grid, 1.0)?;
    for _ in 0..repeat {
        let mut seconds = Vec::new();
        for _ in 0..count + 2 {
            let begin = Instant::now();
            operator.pressure(displacement.view(), pressure.view_mut())?;
            seconds.push(begin.elapsed().as_secs_f64());
        }
        let counted = &mut seconds[2..];
        counted.sort_by(f64::total_cmp);
        let check = pressure.iter().map(|p| p.widen().powi(2)).sum::<f64>();
        println!("{}", json!({"seconds": counted.get(count / 2), "check": check}));
    }
    Ok(())
}

/// Lets the kernel count the largest resident memory from here on.
fn forget_peak() {
    // where there is no such file there is no peak either
    let _ = fs::write("/proc/self/clear_refs", "5");
}
