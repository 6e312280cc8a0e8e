//! The share of a solve outside of operator applications, and the gain of single precision, as medians over rounds.
//!
//! `RAYON_NUM_THREADS=1 cargo run --release --example budget -- [size [case]]`; 1024 if nothing is given, and of a case
//! a part of its name.

use std::ops::ControlFlow;
use std::time::Instant;

use asperity::{
    AdhesionLaw, Amplitude, CoarseSpace, Control, ElasticOperator, Exponential, Foundation, Grid, NoAdhesion,
    Preconditioned, Problem, Real, Result, SelfAffine, Settings, Solver, Start, Surface, Westergaard,
};
use ndarray::{ArrayView2, ArrayViewMut2};

const ROUNDS: usize = 5;

/// The half-space with a clock that runs while it is applied.
struct Timed<T: Real> {
    half_space: Westergaard<T>,
    seconds: f64,
}

impl<T: Real> Timed<T> {
    fn time<R>(&mut self, apply: impl FnOnce(&mut Westergaard<T>) -> R) -> R {
        let begin = Instant::now();
        let result = apply(&mut self.half_space);
        self.seconds += begin.elapsed().as_secs_f64();
        result
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
    fn surface_pressure(&mut self, heights: ArrayView2<'_, f64>, p: ArrayViewMut2<'_, T>) -> Result<f64> {
        self.half_space.surface_pressure(heights, p)
    }
    fn coarse_space(&self, dimension: usize) -> Option<CoarseSpace> {
        self.half_space.coarse_space(dimension)
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

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let size = std::env::args().nth(1).map_or(Ok(1024), |size| size.parse())?;
    let case = std::env::args().nth(2).unwrap_or_default();
    let grid = Grid::square(size, 1.0)?;
    let surface =
        SelfAffine { k_s: 64.0, amplitude: Amplitude::RmsSlope(1.0), ..SelfAffine::default() }.surface(grid)?;
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
    let half_space = Timed { half_space: Westergaard::<f64>::new(grid, 1.0)?, seconds: 0.0 };
    let mut problem = Problem::new(surface, half_space, law)?;
    let mut problem_single = Problem::new(surface, Westergaard::<f32>::new(grid, 1.0)?, law)?;
    let loose = Settings { tolerance: Some(1e-4), ..Settings::default() };
    let mut figures: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        let before = problem.operator().seconds;
        let begin = Instant::now();
        Solver::default().solve(&mut problem, control)?;
        let whole = begin.elapsed().as_secs_f64();
        let share = 1.0 - (problem.operator().seconds - before) / whole;

        let begin = Instant::now();
        let (mut solver, mut iterations) = (Solver::new(loose), [0.0; 2]);
        iterations[0] = solver.solve(&mut problem, control)?.report.iterations as f64;
        let double = begin.elapsed().as_secs_f64();

        let begin = Instant::now();
        let near = solver.solve(&mut problem_single, control)?;
        iterations[1] = near.report.iterations as f64;
        let first = begin.elapsed().as_secs_f64();
        let near = Start::Near(near.gap.mapv(f64::from));
        Solver::default().solve_with(&mut problem, control, near, |_| ControlFlow::Continue(()))?;
        let both = begin.elapsed().as_secs_f64();
        let found = [whole, 100.0 * share, (double / iterations[0]) / (first / iterations[1]), whole / both];
        figures.iter_mut().zip(found).for_each(|(figures, found)| figures.push(found));
    }
    println!("{name}:");
    for (what, figures) in
        ["seconds of a solve", "% beside applications", "f64 / f32, an iteration", "f64 / f32 then f64"]
            .iter()
            .zip(&mut figures)
    {
        figures.sort_by(f64::total_cmp);
        println!("  {what:<24} {:.3} ({:.3}-{:.3})", figures[ROUNDS / 2], figures[0], figures[ROUNDS - 1]);
    }
    Ok(())
}
