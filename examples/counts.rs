//! Operator applications of the default and of the paper's Algorithm 3, on the same cases.
//!
//! `cargo run --release -p asperity-examples --example counts`

use asperity::{
    AdhesionLaw, Control, Criterion, Grid, MaugisDugdale, NoAdhesion, Problem, Result, Settings, Solver, Surface,
    Westergaard,
};
use clap::Parser;
use common::arguments;
use common::rough::rough;

#[derive(Parser)]
struct Arguments {
    /// The largest grid, in nodes along a side
    #[arg(default_value_t = 512, value_parser = arguments::nodes::<128>)]
    largest: usize,
}

fn main() -> Result<()> {
    let Arguments { largest } = arguments::read(include_str!("counts.rs"));
    println!("Applications of the operator until the certified error is below 1e-6 (default), and until");
    println!("the paper's eps is below 1e-9 (Algorithm 3), with the one that constructs the problem.\n");
    println!("{:<37} {:>5} {:>8} {:>11} {:>9}  contact nodes", "case", "n", "default", "Algorithm 3", "ratio");
    for n in [128, 256, 512, 1024, 2048].into_iter().filter(|&n| n <= largest) {
        let grid = Grid::square(n, 1.0)?;
        let sphere = Surface::paraboloid(grid, 2.0)?;
        compare("Hertz, mean gap 0.0398", &sphere, NoAdhesion, Control::MeanGap(0.0398))?;
        let law = MaugisDugdale::new(1e-4, 2e-3)?;
        compare("Maugis-Dugdale, mean gap 0.0429", &sphere, law, Control::MeanGap(0.0429))?;
        let surface = rough(grid, if n < 256 { 63 } else { 64 }, 1);
        for (share, pressure) in [(3, 0.0125), (40, 0.205)] {
            let name = format!("rough, {share} % contact, mean pressure");
            let gap = compare(&name, &surface, NoAdhesion, Control::MeanPressure(pressure))?;
            let name = format!("rough, {share} % contact, mean gap");
            compare(&name, &surface, NoAdhesion, Control::MeanGap(gap))?;
        }
    }
    Ok(())
}

/// Prints the counts of both methods, and returns the mean gap.
fn compare<L: AdhesionLaw<f64>>(name: &str, surface: &Surface, law: L, control: Control) -> Result<f64> {
    let grid = *surface.grid();
    let mut problem = Problem::new(surface, Westergaard::new(grid, 1.0)?, law)?;
    let default = Solver::default().solve(&mut problem, control)?.report;
    let paper = Solver::new(Settings::rey2017().criterion(Criterion::Complementarity).max_iterations(5000))
        .solve(&mut problem, control)?
        .report;
    let (ours, theirs) = (default.operator_applications + 1, paper.operator_applications + 1);
    let ended = |status: asperity::Status| if status == asperity::Status::Converged { "" } else { "!" };
    println!(
        "{name:<37} {:>5} {:>8} {:>11} {:>9.1}  {} / {}",
        grid.shape().0,
        format!("{ours}{}", ended(default.status)),
        format!("{theirs}{}", ended(paper.status)),
        theirs as f64 / ours as f64,
        default.contact_nodes,
        paper.contact_nodes,
    );
    Ok(default.mean_gap)
}
