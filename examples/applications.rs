//! Operator applications of the default method over a set of scenes, and their sum.
//!
//! `cargo run --release -p asperity-examples --example applications`
//!
//! `.ci/constants` measures by it how much the constants of the driver matter.

use asperity::{
    AdhesionLaw, ContactConstraint, Control, Exponential, Grid, Hardness, MaugisDugdale, Nested, NoAdhesion, Penalty,
    Problem, Projection, Real, Result, Settings, Solver, Status, Surface, Sweep, Uzawa, Westergaard,
};
use clap::Parser;
use common::{arguments, rough};

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the squares
    #[arg(default_value_t = 256, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// Take scenes of surfaces that yield at a hardness in the place of the others
    #[arg(long)]
    yielding: bool,
}

fn main() -> Result<()> {
    let Arguments { size, yielding } = arguments::read(include_str!("applications.rs"));
    let (square, line) = (Grid::square(size, 1.0)?, Grid::line(16 * size, 1.0)?);
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
                sum += count(&name, &rough, NoAdhesion, Hardness::new(hardness)?, control)?;
            }
        }
        println!("{:<44} {sum:>6}", "sum");
        return Ok(());
    }
    for pressure in [0.002, 0.0125, 0.2] {
        let load = Control::MeanPressure(pressure);
        sum += count("rough", &rough, NoAdhesion, Projection, load)?;
        sum += count("rough, bowed", &bowed, NoAdhesion, Projection, load)?;
        sum += nested(&rough, NoAdhesion, load)?;
    }
    for gaps in [2.0, 1.0, 0.3] {
        let gap = Control::MeanGap(gaps * rms);
        sum += count("rough", &rough, NoAdhesion, Projection, gap)?;
        sum += count("rough, bowed", &bowed, NoAdhesion, Projection, gap)?;
        sum += nested(&rough, NoAdhesion, gap)?;
    }
    for control in [Control::MeanPressure(0.002), Control::MeanPressure(0.02), Control::MeanGap(rms)] {
        sum += count("rough, weak adhesion", &rough, weak, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.01), Control::MeanGap(0.01), Control::MeanGap(0.03)] {
        sum += count("rough, strong adhesion", &rough, strong, Projection, control)?;
    }
    for (law, control) in [(jump, Control::MeanGap(0.0429)), (jump, Control::MeanPressure(-1e-4))] {
        sum += count("sphere, Maugis-Dugdale", &sphere, law, Projection, control)?;
    }
    for control in [Control::MeanPressure(2e-3), Control::MeanGap(0.0398)] {
        sum += count("sphere", &sphere, NoAdhesion, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.01), Control::MeanPressure(0.05)] {
        sum += count("wave", &wave, NoAdhesion, Projection, control)?;
    }
    for control in [Control::MeanPressure(0.02), Control::MeanGap(profile.rms_height())] {
        sum += count("line", &profile, NoAdhesion, Projection, control)?;
    }
    sum += count("rough, penalty", &rough, NoAdhesion, Penalty::new(500.0)?, Control::MeanPressure(0.0125))?;
    sum += count("rough, Uzawa", &rough, NoAdhesion, Uzawa::<f64>::new(500.0)?, Control::MeanPressure(0.0125))?;
    sum += of::<f32, _, _>("rough, f32", &rough, NoAdhesion, Projection, Control::MeanPressure(0.0125))?;
    sum += of::<f32, _, _>("rough, f32", &rough, NoAdhesion, Projection, Control::MeanGap(rms))?;
    sum += sweep(&rough, weak)?;
    println!("{:<44} {sum:>6}", "sum");
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

fn of<T: Real, L: AdhesionLaw<T>, C: ContactConstraint<T>>(
    name: &str,
    surface: &Surface,
    law: L,
    constraint: C,
    control: Control,
) -> Result<usize> {
    let mut problem = Problem::new(surface, Westergaard::<T>::new(*surface.grid(), 1.0)?, law)?;
    let report = Solver { settings: Settings::default(), constraint }.solve(&mut problem, control)?.report;
    Ok(show(name, control, report.operator_applications, report.status))
}

fn count<L: AdhesionLaw<f64>, C: ContactConstraint<f64>>(
    name: &str,
    surface: &Surface,
    law: L,
    constraint: C,
    control: Control,
) -> Result<usize> {
    of::<f64, L, C>(name, surface, law, constraint, control)
}

/// The applications on the finest of nested grids.
fn nested<L: AdhesionLaw<f64>>(surface: &Surface, law: L, control: Control) -> Result<usize> {
    let solution = Nested::default().solve(surface, |grid| Westergaard::<f64>::new(grid, 1.0), law, control)?.solution;
    Ok(show("rough, nested", control, solution.report.operator_applications, solution.report.status))
}

/// The applications of the steps of a sweep together.
fn sweep<L: AdhesionLaw<f64>>(surface: &Surface, law: L) -> Result<usize> {
    let mut problem = Problem::new(surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, law)?;
    let mut solver = Solver::default();
    let loads = (1..=8).map(|k| Control::MeanPressure(0.01 * f64::from(k)));
    let mut sum = 0;
    for step in Sweep::new(&mut solver, &mut problem, loads) {
        sum += step?.report.operator_applications;
    }
    Ok(show("rough, eight loads", Control::MeanPressure(0.08), sum, Status::Converged))
}
