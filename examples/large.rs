//! One large solve: how long it takes, and how much memory the whole process needs.
//!
//! `cargo run --release -p asperity-examples --example large`
//!
//! A rough surface of 4 to 64 waves a side at the pressure of 0.02 times modulus and rms slope, 5 % contact without
//! adhesion; 16384² needs 15 GiB in f64 and 8 GiB in f32.

use std::ops::ControlFlow;
use std::time::Instant;

use asperity::{
    AdhesionLaw, Amplitude, Control, Exponential, Grid, NoAdhesion, Problem, Real, SelfAffine, Solver, Start,
    Westergaard,
};
use clap::{Parser, ValueEnum};
use common::arguments::{self, Precision};
use common::{Outcome, memory};

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(default_value_t = 4096, value_parser = arguments::nodes::<129>)]
    size: usize,
    #[arg(default_value = "f64")]
    precision: Precision,
    /// The law of adhesion
    #[arg(default_value = "none")]
    law: Law,
}

#[derive(Clone, ValueEnum)]
enum Law {
    None,
    Exponential,
}

fn main() -> Outcome<()> {
    let Arguments { size, precision, law } = arguments::read(include_str!("large.rs"));
    match (precision, law) {
        (Precision::F64, Law::None) => run::<f64, _>(size, |_| Ok(NoAdhesion)),
        (Precision::F32, Law::None) => run::<f32, _>(size, |_| Ok(NoAdhesion)),
        (Precision::F64, Law::Exponential) => run::<f64, _>(size, exponential),
        (Precision::F32, Law::Exponential) => run::<f32, _>(size, exponential),
    }
}

/// The law of a surface with the given rms height, the rms slope being one.
fn exponential(rms_height: f64) -> asperity::Result<Exponential> {
    let range = 0.1 * rms_height;
    Exponential::new(0.1 * range, range)
}

fn run<T: Real, L: AdhesionLaw<T> + 'static>(size: usize, law: impl Fn(f64) -> asperity::Result<L>) -> Outcome<()> {
    let clock = Instant::now();
    let grid = Grid::square(size, 1.0)?;
    let surface = SelfAffine::default().k_s(64.0).amplitude(Amplitude::RmsSlope(1.0)).surface(grid)?;
    let law = law(surface.rms_height())?;
    let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, 1.0)?, law)?;
    drop(surface);
    println!("{size} x {size} nodes in {}: the problem stands after {:.1} s", T::NAME, clock.elapsed().as_secs_f64());
    let clock = Instant::now();
    let solution =
        Solver::default().solve_with(&mut problem, Control::MeanPressure(0.02), Start::Default, |state| {
            let (seconds, error) = (clock.elapsed().as_secs_f64(), state.relative_error);
            eprintln!("iteration {:3}: {error:.1e} after {seconds:.1} s", state.iteration);
            ControlFlow::Continue(())
        })?;
    let report = &solution.report;
    println!(
        "{} to {:.1e} in {:.1} s, {} applications; contact {:.3} %",
        report.status,
        report.relative_error,
        clock.elapsed().as_secs_f64(),
        report.operator_applications,
        100.0 * report.contact_fraction
    );
    if let Some(bytes) = memory::peak() {
        let bytes = bytes as f64;
        let fields = bytes / (size * size * size_of::<T>()) as f64;
        println!("most memory of the process: {:.2} GiB, {fields:.2} fields", bytes / (1_u64 << 30) as f64);
    }
    Ok(())
}
