//! The share of a solve outside of operator applications, and the gain of single precision, as medians over rounds.
//!
//! `RAYON_NUM_THREADS=1 cargo run --release -p asperity-examples --example budget`
//!
//! An application is timed alone, in `f32` and in `f64`. A solve in `f64` has two applications in each iteration in
//! `f32`, and the others in `f64`.

use std::ops::ControlFlow;
use std::time::Instant;

use asperity::{
    AdhesionLaw, Amplitude, Control, ElasticOperator, Exponential, Grid, NoAdhesion, Problem, Real, Result, SelfAffine,
    Settings, Solution, Solver, Start, Surface, Westergaard,
};
use clap::Parser;
use common::{Outcome, arguments, quantile};
use ndarray::Array2;

const ROUNDS: usize = 5;
/// The applications in a round, in each precision.
const APPLICATIONS: usize = 20;

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(default_value_t = 1024, value_parser = arguments::nodes::<129>)]
    size: usize,
    /// A part of the name of the cases that are measured, of all unless given
    #[arg(default_value = "", hide_default_value = true)]
    case: String,
}

fn main() -> Outcome<()> {
    let Arguments { size, case } = arguments::read(include_str!("budget.rs"));
    let grid = Grid::square(size, 1.0)?;
    let surface = SelfAffine::default().k_s(64.0).amplitude(Amplitude::RmsSlope(1.0)).surface(grid)?;
    let range = 0.1 * surface.rms_height();
    let law = Exponential::new(0.1 * range, range)?;
    println!("{size} x {size} nodes; medians of {ROUNDS} rounds, least and largest in brackets");
    let (pressure, gap) = (Control::MeanPressure(0.02), Control::MeanGap(0.02));
    for (name, control) in [("hard wall, mean pressure", pressure), ("hard wall, mean gap", gap)] {
        if name.contains(&case) {
            measure(name, &surface, NoAdhesion, control)?;
        }
    }
    let name = "exponential law, mean gap";
    if name.contains(&case) {
        measure(name, &surface, law, gap)?;
    }
    Ok(())
}

fn measure(
    name: &str,
    surface: &Surface,
    law: impl AdhesionLaw<f64> + AdhesionLaw<f32> + Copy + 'static,
    control: Control,
) -> Result<()> {
    let grid = *surface.grid();
    let mut double = Problem::<f64>::new(surface, Westergaard::new(grid, 1.0)?, law)?;
    let mut single = Problem::<f32>::new(surface, Westergaard::new(grid, 1.0)?, law)?;
    let loose = Settings::default().tolerance(1e-4);
    let mut figures: [Vec<f64>; 5] = Default::default();
    for _ in 0..ROUNDS {
        let [in_single, in_double] = application(surface)?;
        let (solution, time) = solve(&mut double, control, Settings::default(), Start::Default)?;
        let (near, time_single) = solve(&mut single, control, loose, Start::Default)?;
        let start = Start::Near(near.gap.mapv(f64::from));
        let (_, time_near) = solve(&mut double, control, Settings::default(), start)?;
        let corrections = 2 * solution.report.iterations;
        let others = solution.report.operator_applications.saturating_sub(corrections);
        let applied = corrections as f64 * in_single + others as f64 * in_double;
        let iteration = |time: f64, iterations: usize| time / iterations as f64;
        let found = [
            time,
            100.0 * (1.0 - applied / time),
            in_single / in_double,
            iteration(time_single, near.report.iterations) / iteration(time, solution.report.iterations),
            (time_single + time_near) / time,
        ];
        figures.iter_mut().zip(found).for_each(|(figures, found)| figures.push(found));
    }
    println!("{name}:");
    let names = [
        "seconds of a solve",
        "% besides applications",
        "an application in f32 / f64",
        "an iteration in f32 / f64",
        "in f32, then on / a solve",
    ];
    for (what, figures) in names.iter().zip(&mut figures) {
        let median = quantile(figures, 0.5);
        println!("  {what:<28} {median:.3} ({:.3}-{:.3})", figures[0], figures[ROUNDS - 1]);
    }
    Ok(())
}

/// The seconds of an operator application in `f32` and in `f64`, timed in turn.
fn application(surface: &Surface) -> Result<[f64; 2]> {
    let (mut single, mut double) = (applied::<f32>(surface)?, applied::<f64>(surface)?);
    let mut times: [Vec<f64>; 2] = Default::default();
    for _ in 0..APPLICATIONS {
        times[0].push(single()?);
        times[1].push(double()?);
    }
    Ok(times.map(|mut times| quantile(&mut times, 0.5)))
}

/// Applies the half-space to the heights whenever it is called, and tells the seconds.
fn applied<T: Real>(surface: &Surface) -> Result<impl FnMut() -> Result<f64>> {
    let mut half_space = Westergaard::<T>::new(*surface.grid(), 1.0)?;
    let displacement = surface.heights().mapv(T::lit);
    let mut pressure = Array2::zeros(displacement.dim());
    Ok(move || {
        let begin = Instant::now();
        half_space.pressure(displacement.view(), pressure.view_mut())?;
        Ok(begin.elapsed().as_secs_f64())
    })
}

/// A solution, and the seconds that it took.
fn solve<T: Real>(
    problem: &mut Problem<T>,
    control: Control,
    settings: Settings,
    start: Start<'_, T>,
) -> Result<(Solution<T>, f64)> {
    let begin = Instant::now();
    let solution = Solver::new(settings).solve_with(problem, control, start, |_| ControlFlow::Continue(()))?;
    Ok((solution, begin.elapsed().as_secs_f64()))
}
