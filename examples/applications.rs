//! Operator applications of the default method over a set of scenes, and their sum.
//!
//! `cargo run --release -p asperity-examples --example applications`
//!
//! `.ci/constants` measures by it how much the constants of the driver matter.

use std::sync::Arc;

use asperity::{
    AdhesionLaw, Branch, ContactConstraint, Control, Exponential, Grid, Hardness, Jkr, MaugisDugdale, Nested,
    NoAdhesion, Penalty, Problem, Projection, Real, Result, SelfAffine, Settings, Solver, Status, Surface, Sweep,
    Uzawa, Westergaard,
};
use clap::Parser;
use common::{arguments, rough};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the squares
    #[arg(default_value_t = 256, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// Take scenes of surfaces that yield at a hardness in the place of the others
    #[arg(long)]
    yielding: bool,
    /// Take raw maps: a law of short range sticks to a fifth of them and more
    #[arg(long, conflicts_with = "yielding")]
    sticky: bool,
}

fn main() -> Result<()> {
    let Arguments { size, yielding, sticky } = arguments::read(include_str!("applications.rs"));
    let (square, line) = (Grid::square(size, 1.0)?, Grid::line(16 * size, 1.0)?);
    if sticky {
        return raw_maps(size);
    }
    let rough = rough::rough(square, (size / 4).min(64) as i32, 1);
    let mut bowed = rough.heights().clone();
    let rms = rough.rms_height();
    bowed.indexed_iter_mut().for_each(|((i, j), height)| {
        let [x, y] = [i, j].map(|i| (std::f64::consts::TAU * i as f64 / size as f64).cos());
        *height += rms * (3.0 * x + y);
    });
    let bowed = Surface::new(square, bowed)?;
    let (sphere, wave) = (Surface::paraboloid(square, 2.0)?, Surface::wave_2d(square, 0.02, 1)?);
    let profile = rough::rough(line, 64, 1);
    let weak = Exponential::new(0.01 * rms * rms, 0.1 * rms)?;
    let strong = Exponential::new(4e-4, 2e-3)?;
    let jump = MaugisDugdale::new(1e-4, 2e-3)?;

    let mut sum = 0;
    if yielding {
        for hardness in [0.3, 1.0, 3.0] {
            let name = format!("rough, hardness {hardness}");
            for control in [Control::MeanPressure(0.0125), Control::MeanPressure(0.1), Control::MeanGap(rms)] {
                sum += solve::<f64>(&name, &rough, NoAdhesion, Hardness::new(hardness)?, control)?;
            }
        }
        println!("{:<44} {sum:>6}", "sum");
        return Ok(());
    }
    for pressure in [0.002, 0.0125, 0.2] {
        let load = Control::MeanPressure(pressure);
        sum += solve::<f64>("rough", &rough, NoAdhesion, Projection, load)?;
        sum += solve::<f64>("rough, bowed", &bowed, NoAdhesion, Projection, load)?;
        sum += nested(&rough, load)?;
    }
    for gaps in [2.0, 1.0, 0.3] {
        let gap = Control::MeanGap(gaps * rms);
        sum += solve::<f64>("rough", &rough, NoAdhesion, Projection, gap)?;
        sum += solve::<f64>("rough, bowed", &bowed, NoAdhesion, Projection, gap)?;
        sum += nested(&rough, gap)?;
    }
    for control in [Control::MeanPressure(0.002), Control::MeanPressure(0.02), Control::MeanGap(rms)] {
        sum += solve::<f64>("rough, weak adhesion", &rough, weak, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.01), Control::MeanGap(0.01), Control::MeanGap(0.03)] {
        sum += solve::<f64>("rough, strong adhesion", &rough, strong, Projection, control)?;
    }
    for (law, control) in [(jump, Control::MeanGap(0.0429)), (jump, Control::MeanPressure(-1e-4))] {
        sum += solve::<f64>("sphere, Maugis-Dugdale", &sphere, law, Projection, control)?;
    }
    for control in [Control::MeanPressure(2e-3), Control::MeanGap(0.0398)] {
        sum += solve::<f64>("sphere", &sphere, NoAdhesion, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.01), Control::MeanPressure(0.05)] {
        sum += solve::<f64>("wave", &wave, NoAdhesion, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.02), Control::MeanGap(profile.rms_height())] {
        sum += solve::<f64>("line", &profile, NoAdhesion, Projection, control)?;
    }
    sum += solve::<f64>("rough, penalty", &rough, NoAdhesion, Penalty::new(500.0)?, Control::MeanPressure(0.0125))?;
    sum += solve::<f64>("rough, Uzawa", &rough, NoAdhesion, Uzawa::<f64>::new(500.0)?, Control::MeanPressure(0.0125))?;
    sum += solve::<f32>("rough, f32", &rough, NoAdhesion, Projection, Control::MeanPressure(0.0125))?;
    sum += solve::<f32>("rough, f32", &rough, NoAdhesion, Projection, Control::MeanGap(rms))?;
    sum += sweep(&rough, weak)?;
    println!("{:<44} {sum:>6}", "sum");
    Ok(())
}

/// A map as an instrument has it: noise, a step, spikes, and missing points that the mean has filled. With its rms height
/// and slope without these.
fn raw_map(size: usize, seed: u64) -> Result<(Surface, [f64; 2])> {
    let grid = Grid::square(size, 1.0)?;
    let clean = SelfAffine::default().k_s((size / 8) as f64).seed(seed).surface(grid)?;
    let statistics = clean.statistics();
    let rms = statistics.rms_height;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut heights = clean.heights().clone();
    heights.indexed_iter_mut().for_each(|((i, _), height)| {
        *height += rms * (random.random_range(-0.02..0.02) + if i > size / 3 { 0.7 } else { 0.0 });
    });
    for _ in 0..size * size / 1000 {
        let [i, j] = [0; 2].map(|_: usize| random.random_range(0..size));
        heights[[i, j]] += rms * random.random_range(-1.0..2.0);
    }
    let mean = heights.mean().unwrap_or_default();
    for _ in 0..10 {
        let [i, j] = [0; 2].map(|_: usize| random.random_range(0..size));
        let side = random.random_range(2..size / 16 + 3);
        let inside = |start: usize, at: usize| (start..start + side).contains(&at);
        heights
            .indexed_iter_mut()
            .filter(|((k, l), _)| inside(i, *k) && inside(j, *l))
            .for_each(|(_, height)| *height = mean);
    }
    Ok((Surface::new(grid, heights)?, [rms, statistics.rms_slope]))
}

/// The ways in which raw maps are solved; a nested solve is one on loading, its applications equivalent ones.
const RAW_WAYS: [&str; 3] = ["loading", "nested", "unloading"];

/// Loading and unloading of raw maps, by the law of the grid, by one that the grid just resolves, and by a shorter one.
fn raw_maps(size: usize) -> Result<()> {
    let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
    let mut counts = [const { Vec::new() }; 3];
    for seed in 1..=4 {
        let (map, [rms, slope]) = raw_map(size, seed)?;
        let load = Control::MeanPressure(1e-3 * slope);
        for work in [0.2, 0.5, 0.7].map(|share| 0.5 * share * rms * slope) {
            for mu_rho in [None, Some(0.5), Some(1.0)] {
                let range = |mu_rho: f64| (work / size as f64).sqrt() / mu_rho;
                let law: Arc<dyn AdhesionLaw<f64>> = match mu_rho {
                    None => Arc::new(Jkr::new(work)?),
                    Some(mu_rho) => Arc::new(Exponential::new(work, range(mu_rho))?),
                };
                let of_law = mu_rho.map_or("jkr".to_owned(), |mu_rho| format!("μ_ρ {mu_rho}"));
                let mut problem = Problem::new(&map, half_space(*map.grid())?, law.clone())?;
                let mut on_one_grid = |branch| {
                    let report = Solver::new(Settings::default().branch(branch)).solve(&mut problem, load)?.report;
                    Ok((report.operator_applications, report))
                };
                let nested = Nested::default().solve(&mut Solver::default(), &map, half_space, law, load)?;
                let ways = [
                    on_one_grid(Branch::Loading)?,
                    (nested.equivalent_applications().round() as usize, nested.solution.report),
                    on_one_grid(Branch::Unloading)?,
                ];
                for ((way, (applications, report)), counts) in RAW_WAYS.iter().zip(ways).zip(&mut counts) {
                    let name = format!("{of_law}, {way}, {:.2} %", 100.0 * report.contact_fraction);
                    counts.push(show(&name, load, applications, report.status));
                }
            }
        }
    }
    for (way, counts) in RAW_WAYS.iter().zip(counts) {
        let worst = counts.iter().max().copied().unwrap_or_default();
        println!("{way:<44} {:>6}, worst {worst}", counts.iter().sum::<usize>());
    }
    Ok(())
}

fn show(name: &str, control: Control, applications: usize, status: Status) -> usize {
    let control = match control {
        Control::MeanGap(gap) => format!("mean gap {gap:.4}"),
        Control::MeanPressure(pressure) => format!("mean pressure {pressure}"),
        other => format!("{} {}", other.name(), other.value()),
    };
    let ended = if status == Status::Converged { String::new() } else { format!("  {status}") };
    println!("{name:<23} {control:<20} {applications:>6}{ended}");
    applications
}

fn solve<T: Real>(
    name: &str,
    surface: &Surface,
    law: impl AdhesionLaw<T> + 'static,
    constraint: impl ContactConstraint<T> + 'static,
    control: Control,
) -> Result<usize> {
    let mut problem = Problem::new(surface, Westergaard::<T>::new(*surface.grid(), 1.0)?, law)?;
    let report = Solver { settings: Settings::default(), constraint }.solve(&mut problem, control)?.report;
    Ok(show(name, control, report.operator_applications, report.status))
}

/// The applications on the finest of nested grids.
fn nested(surface: &Surface, control: Control) -> Result<usize> {
    let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
    let found = Nested::default().solve(&mut Solver::default(), surface, half_space, NoAdhesion, control)?;
    let report = &found.solution.report;
    Ok(show("rough, nested", control, report.operator_applications, report.status))
}

/// The applications of the steps of a sweep together.
fn sweep(surface: &Surface, law: Exponential) -> Result<usize> {
    let mut problem = Problem::new(surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, law)?;
    let (mut solver, mut sweep, mut sum) = (Solver::default(), Sweep::default(), 0);
    for load in (1..=8).map(|k| Control::MeanPressure(0.01 * f64::from(k))) {
        sum += sweep.next(&mut solver, &mut problem, load)?.report.operator_applications;
    }
    Ok(show("rough, eight loads", Control::MeanPressure(0.08), sum, Status::Converged))
}
