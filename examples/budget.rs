//! The share of a solve outside of operator applications, and the gain of single precision, for the corrections or for
//! all, as medians over rounds.
//!
//! `RAYON_NUM_THREADS=1 cargo run --release -p asperity-examples --example budget`

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use asperity::elastic::{Abilities, CoarseSpace, Foundation, Preconditioned, Waves};
use asperity::{
    AdhesionLaw, Amplitude, Control, ElasticOperator, Exponential, Grid, NoAdhesion, Problem, Real, Result, SelfAffine,
    Settings, Solver, Start, Surface, Westergaard,
};
use clap::Parser;
use common::{Outcome, arguments};
use ndarray::{Array2, ArrayView2, ArrayViewMut2};

const ROUNDS: usize = 5;

/// The half-space with a clock that runs while it is applied.
struct Timed<T: Real> {
    half_space: Westergaard<T>,
    nanoseconds: Arc<AtomicU64>,
    /// whether it may be had in single precision
    splits: bool,
}

impl<T: Real> Timed<T> {
    fn new(grid: Grid, splits: bool) -> Result<Self> {
        Ok(Self { half_space: Westergaard::new(grid, 1.0)?, nanoseconds: Arc::default(), splits })
    }

    fn time<R>(&mut self, apply: impl FnOnce(&mut Westergaard<T>) -> R) -> R {
        let begin = Instant::now();
        let result = apply(&mut self.half_space);
        self.nanoseconds.fetch_add(begin.elapsed().as_nanos() as u64, Ordering::Relaxed);
        result
    }

    fn seconds(&self) -> f64 {
        self.nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }
}

impl<T: Real> Waves<T> for Timed<T> {
    fn coarse_space(&mut self, dimension: usize) -> Option<CoarseSpace> {
        self.half_space.abilities().waves?.coarse_space(dimension)
    }
    fn in_single(&mut self) -> Option<Box<dyn ElasticOperator<f32>>> {
        let half_space = Westergaard::<f32>::new(*self.half_space.grid(), 1.0).ok()?;
        let nanoseconds = Arc::clone(&self.nanoseconds);
        Some(Box::new(Timed { half_space, nanoseconds, splits: false }))
    }
    fn surface_pressure(&mut self, heights: ArrayView2<'_, f64>, p: ArrayViewMut2<'_, T>) -> Result<f64> {
        self.half_space.abilities().waves.map_or(Ok(0.0), |waves| waves.surface_pressure(heights, p))
    }
    fn release_memory(&mut self) {
        self.half_space.abilities().waves.into_iter().for_each(Waves::release_memory);
    }
}

impl<T: Real> ElasticOperator<T> for Timed<T> {
    fn grid(&self) -> &Grid {
        self.half_space.grid()
    }
    fn pressure(&mut self, u: ArrayView2<'_, T>, p: ArrayViewMut2<'_, T>) -> Result<()> {
        self.time(|half_space| half_space.pressure(u, p))
    }
    fn pressure_and_work(&mut self, u: ArrayView2<'_, T>, p: ArrayViewMut2<'_, T>) -> Result<f64> {
        self.time(|half_space| half_space.pressure_and_work(u, p))
    }
    fn displacement(&mut self, p: ArrayView2<'_, T>, u: ArrayViewMut2<'_, T>) -> Result<()> {
        self.time(|half_space| half_space.displacement(p, u))
    }
    fn stiffness_range(&self) -> (f64, f64) {
        self.half_space.stiffness_range()
    }
    fn modulus(&self) -> f64 {
        self.half_space.modulus()
    }
    fn abilities(&mut self) -> Abilities<'_, T> {
        let mut abilities = Abilities::default();
        abilities.single = self.splits;
        abilities.waves = Some(self);
        abilities
    }
    fn precondition(
        &mut self,
        residual: ArrayView2<'_, T>,
        foundation: Foundation<'_>,
        preconditioned: ArrayViewMut2<'_, T>,
    ) -> Result<Preconditioned> {
        self.time(|half_space| half_space.precondition(residual, foundation, preconditioned))
    }
}

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

fn measure<L: AdhesionLaw<f64> + AdhesionLaw<f32> + Copy>(
    name: &str,
    surface: &Surface,
    law: L,
    control: Control,
) -> Result<()> {
    let grid = *surface.grid();
    let mut both = Problem::new(surface, Timed::<f64>::new(grid, true)?, law)?;
    let mut double = Problem::new(surface, Timed::<f64>::new(grid, false)?, law)?;
    let mut single = Problem::new(surface, Timed::<f32>::new(grid, false)?, law)?;
    let loose = Settings::default().tolerance(1e-4);
    let mut figures: [Vec<f64>; 6] = Default::default();
    for _ in 0..ROUNDS {
        let before = both.operator().seconds();
        let (time, iteration) = solve(&mut both, control, Settings::default(), Start::Default)?.0;
        let share = 1.0 - (both.operator().seconds() - before) / time;
        let (time_double, iteration_double) = solve(&mut double, control, Settings::default(), Start::Default)?.0;
        let ((time_single, iteration_single), near) = solve(&mut single, control, loose, Start::Default)?;
        let near = Start::Near(near.mapv(f64::from));
        let ((time_near, _), _) = solve(&mut both, control, Settings::default(), near)?;
        let found = [
            time,
            100.0 * share,
            iteration / iteration_double,
            iteration_single / iteration_double,
            time / time_double,
            (time_single + time_near) / time,
        ];
        figures.iter_mut().zip(found).for_each(|(figures, found)| figures.push(found));
    }
    println!("{name}:");
    let names = [
        "seconds of a solve",
        "% beside applications",
        "an iteration / in f64 alone",
        "in f32 / in f64 alone",
        "a solve / in f64 alone",
        "in f32, then on / a solve",
    ];
    for (what, figures) in names.iter().zip(&mut figures) {
        figures.sort_by(f64::total_cmp);
        println!("  {what:<28} {:.3} ({:.3}-{:.3})", figures[ROUNDS / 2], figures[0], figures[ROUNDS - 1]);
    }
    Ok(())
}

/// The seconds of a solve and of one of its iterations, and the gap.
fn solve<T: Real, L: AdhesionLaw<T>>(
    problem: &mut Problem<T, Timed<T>, L>,
    control: Control,
    settings: Settings,
    start: Start<'_, T>,
) -> Result<((f64, f64), Array2<T>)> {
    let begin = Instant::now();
    let solution = Solver::new(settings).solve_with(problem, control, start, |_| ControlFlow::Continue(()))?;
    let time = begin.elapsed().as_secs_f64();
    Ok(((time, time / solution.report.iterations as f64), solution.gap))
}
