//! Operator applications of the default and of the paper's Algorithm 3, on the same cases.
//!
//! `cargo run --release -p asperity-examples --example counts`

use std::collections::BTreeMap;

use asperity::solver::Criterion;
use asperity::{
    AdhesionLaw, Control, Grid, MaugisDugdale, NoAdhesion, Problem, Report, Result, Settings, Solver, Status, Surface,
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
    /// The largest grid of Algorithm 3: its applications grow with the grid
    #[arg(long, value_name = "N", default_value_t = 512)]
    algorithm_3: usize,
}

fn main() -> Result<()> {
    let Arguments { largest, algorithm_3 } = arguments::read(include_str!("counts.rs"));
    println!("Applications of the operator until the certified error is below 1e-6 (default), and until");
    println!("the paper's eps is below 1e-9 (Algorithm 3), with the one that constructs the problem.");
    let sizes: Vec<_> = [128, 256, 512, 1024, 2048].into_iter().filter(|&n| n <= largest).collect();
    let mut counts: BTreeMap<_, String> = BTreeMap::new();
    for &n in &sizes {
        println!("\n| {n}² | default | Algorithm 3 | ratio | contact nodes |\n|---|---|---|---|---|");
        let mut compare = |name: &'static str, surface: &Surface, law: Box<dyn AdhesionLaw<f64>>, control| {
            let mut problem = Problem::new(surface, Westergaard::new(*surface.grid(), 1.0)?, law)?;
            let ours = Solver::default().solve(&mut problem, control)?.report;
            let (mut theirs, mut ratio, mut nodes) = Default::default();
            if n <= algorithm_3 {
                let settings = Settings::rey2017().criterion(Criterion::Complementarity).max_iterations(5000);
                let report = Solver::new(settings).solve(&mut problem, control)?.report;
                (theirs, ratio) = (count(&report), format!("{:.1}", applications(&report) / applications(&ours)));
                nodes = format!(" / {}", report.contact_nodes);
            }
            println!("| {name} | {} | {theirs} | {ratio} | {}{nodes} |", count(&ours), ours.contact_nodes);
            *counts.entry(name).or_default() += &format!(" {} |", count(&ours));
            Result::Ok(ours.mean_gap)
        };
        let grid = Grid::square(n, 1.0)?;
        let sphere = Surface::paraboloid(grid, 2.0)?;
        compare("Hertz, mean gap", &sphere, Box::new(NoAdhesion), Control::MeanGap(0.0398))?;
        let law = MaugisDugdale::new(1e-4, 2e-3)?;
        compare("Maugis–Dugdale, mean gap", &sphere, Box::new(law), Control::MeanGap(0.0429))?;
        let surface = rough(grid, if n < 256 { 63 } else { 64 }, 1);
        for (by_pressure, by_gap, pressure) in [
            ("rough, 3 % contact, mean pressure", "rough, 3 % contact, mean gap", 0.0125),
            ("rough, 40 % contact, mean pressure", "rough, 40 % contact, mean gap", 0.205),
        ] {
            let gap = compare(by_pressure, &surface, Box::new(NoAdhesion), Control::MeanPressure(pressure))?;
            compare(by_gap, &surface, Box::new(NoAdhesion), Control::MeanGap(gap))?;
        }
    }
    println!("\n| default |{}", sizes.iter().map(|n| format!(" {n}² |")).collect::<String>());
    println!("|---|{}", "---|".repeat(sizes.len()));
    counts.iter().for_each(|(name, row)| println!("| {name} |{row}"));
    Ok(())
}

fn applications(report: &Report) -> f64 {
    (report.operator_applications + 1) as f64
}

/// The applications of a solve, with a mark if it has not converged.
fn count(report: &Report) -> String {
    format!("{}{}", applications(report), if report.status == Status::Converged { "" } else { "!" })
}
