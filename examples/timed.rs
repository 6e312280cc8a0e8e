//! Times solves, or operator applications, of given heights: a line of JSON for each repetition.
//!
//! ```text
//! cargo run --release --example timed -- HEIGHTS [NAME=VALUE ...]
//! ```
//!
//! `HEIGHTS` is a file of heights on a square of side 1 (or a rectangle of square cells, Lx = 1), whose
//! contact modulus is 1. One of `pressure=P`, `gap=G`, `approach=D` (the control) and `apply=N` (only the periodic
//! operator: the median of N applications, after two that do not count) must be there. Beside them:
//! `boundary=periodic|free`, `precision=f64|f32`, `tolerance=1e-6`, `work=W range=R` (the exponential law), `method=single|nested|mixed` (one grid, nested grids, or these in f32 to
//! 1e-4 and on in f64), `repeat=N`, `save=FILE.npy` (the elastic pressure p + p̄ of the last solve, in f64).
//!
//! `seconds` counts from the heights in memory to the solution in memory, `solve` only the solve without the
//! construction of operator and problem. `peak` is the largest resident memory of the process, in bytes, from before
//! the repetition to its end (Linux only). `benches/peers` runs this against other programs.

#[path = "common/memory.rs"]
mod memory;

use std::collections::HashMap;
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use asperity::io::{read_field, write_npy};
use asperity::{
    AdhesionLaw, Boussinesq, Control, ElasticOperator, Exponential, Grid, Nested, NoAdhesion, Problem, Real, Settings,
    Solution, Solver, Start, Surface, Westergaard,
};
use ndarray::Array2;
use serde_json::json;

/// The tolerance of the solve in single precision, on every grid.
const SINGLE: f64 = 1e-4;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// The arguments NAME=VALUE.
struct Options(HashMap<String, String>);

impl Options {
    const NAMES: [&str; 12] = [
        "pressure",
        "gap",
        "approach",
        "apply",
        "boundary",
        "precision",
        "tolerance",
        "work",
        "range",
        "method",
        "repeat",
        "save",
    ];

    fn new(arguments: impl Iterator<Item = String>) -> Outcome<Self> {
        let mut options = HashMap::new();
        for argument in arguments {
            let (name, value) = argument.split_once('=').ok_or_else(|| format!("{argument}: write NAME=VALUE"))?;
            if !Self::NAMES.contains(&name) {
                return Err(format!("{name}: the names are {}", Self::NAMES.join(", ")).into());
            }
            options.insert(name.to_owned(), value.to_owned());
        }
        Ok(Self(options))
    }

    fn text(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    fn number(&self, name: &str) -> Outcome<Option<f64>> {
        let parse = |text: &str| text.parse().map_err(|e| format!("{name}={text}: {e}"));
        Ok(self.text(name).map(parse).transpose()?)
    }

    fn count(&self, name: &str) -> Outcome<Option<usize>> {
        let parse = |text: &str| text.parse().map_err(|e| format!("{name}={text}: {e}"));
        Ok(self.text(name).map(parse).transpose()?)
    }
}

/// A half-space of contact modulus 1, in either precision.
trait HalfSpace {
    type Operator<T: Real>: ElasticOperator<T>;
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
    let mut arguments = std::env::args().skip(1);
    let heights = arguments.next().ok_or("the file of heights must be given")?;
    let options = Options::new(arguments)?;
    let heights = read_field(Path::new(&heights))?;
    match options.text("precision").unwrap_or("f64") {
        "f64" => time::<f64>(heights, &options),
        "f32" => time::<f32>(heights, &options),
        other => Err(format!("precision={other}: f64 or f32").into()),
    }
}

fn time<T: Real>(heights: Array2<f64>, options: &Options) -> Outcome<()> {
    let (nx, ny) = heights.dim();
    let grid = Grid::new((nx, ny), (1.0, ny as f64 / nx as f64))?;
    if let Some(count) = options.count("apply")? {
        return apply::<T>(grid, &heights, count, options.count("repeat")?.unwrap_or(1));
    }
    let surface = Surface::new(grid, heights)?;
    match options.text("boundary").unwrap_or("periodic") {
        "periodic" => stick::<T, Periodic>(&surface, options),
        "free" => stick::<T, Free>(&surface, options),
        other => Err(format!("boundary={other}: periodic or free").into()),
    }
}

fn stick<T: Real, H: HalfSpace>(surface: &Surface, options: &Options) -> Outcome<()> {
    match (options.number("work")?, options.number("range")?) {
        (Some(work), Some(range)) => solve::<T, H, _>(surface, Exponential::new(work, range)?, options),
        (None, None) => solve::<T, H, _>(surface, NoAdhesion, options),
        _ => Err("work and range must both be given, or neither".into()),
    }
}

fn solve<T: Real, H: HalfSpace, L: AdhesionLaw<T> + AdhesionLaw<f32> + Copy>(
    surface: &Surface,
    law: L,
    options: &Options,
) -> Outcome<()> {
    let held = ["pressure", "gap", "approach"].map(|name| options.number(name));
    let control = match held.into_iter().collect::<Outcome<Vec<_>>>()?[..] {
        [Some(pressure), None, None] => Control::MeanPressure(pressure),
        [None, Some(gap), None] => Control::MeanGap(gap),
        [None, None, Some(approach)] => Control::Approach(approach),
        _ => return Err("give one of pressure=P, gap=G, approach=D and apply=N".into()),
    };
    let settings = Settings { tolerance: options.number("tolerance")?, ..Settings::default() };
    let tolerance = settings.tolerance_in::<T>();
    for _ in 0..options.count("repeat")?.unwrap_or(1) {
        forget_peak();
        let begin = Instant::now();
        let (solution, seconds) = match options.text("method").unwrap_or("single") {
            "single" => run::<T, H, L>(surface, law, control, settings, None)?,
            "nested" => nested::<T, H, L>(surface, law, control, settings)?,
            // what single precision reaches is then all that is wanted
            "mixed" if T::NAME == "f32" || tolerance >= SINGLE => nested::<T, H, L>(surface, law, control, settings)?,
            "mixed" => {
                let settings_single = Settings { tolerance: Some(SINGLE), ..settings };
                let (near, seconds) = nested::<f32, H, L>(surface, law, control, settings_single)?;
                let gap = near.gap.mapv(|g| T::lit(g.widen()));
                drop(near);
                let (solution, more) = run::<T, H, L>(surface, law, control, settings, Some(gap))?;
                (solution, seconds + more)
            }
            other => return Err(format!("method={other}: single, nested or mixed").into()),
        };
        let (total, peak) = (begin.elapsed().as_secs_f64(), memory::peak());
        let report = &solution.report;
        let line = json!({
            "seconds": total,
            "solve": seconds,
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
        if let Some(path) = options.text("save") {
            write_npy(Path::new(path), &solution.pressure.mapv(Real::widen))?;
        }
    }
    Ok(())
}

/// The solution, and the seconds that the solve alone took; `near` is where it starts, if that is known.
fn run<T: Real, H: HalfSpace, L: AdhesionLaw<T>>(
    surface: &Surface,
    law: L,
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

fn nested<T: Real, H: HalfSpace, L: AdhesionLaw<T>>(
    surface: &Surface,
    law: L,
    control: Control,
    settings: Settings,
) -> Outcome<(Solution<T>, f64)> {
    let begin = Instant::now();
    let solution = Nested::new(settings).solve(surface, H::new::<T>, law, control)?.solution;
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
