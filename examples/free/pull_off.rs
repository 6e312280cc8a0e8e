//! The pull-off of an adhesive sphere under the law of Maugis and Dugdale, without images, over the Tabor parameter.

use std::f64::consts::PI;

use asperity::exact::{self, Sphere};
use asperity::path::{Path, PathSettings};
use asperity::{Boussinesq, Control, Grid, MaugisDugdale, Problem, Settings, Solver, Surface};
use plotters::prelude::*;

use common::Outcome;
use common::chart::{COLOURS, Chart, Series, Style};

const RADIUS: f64 = 2.0;
const WORK: f64 = 2e-5;
/// Tabor parameters, with the sides of windows that hold the adhesive zone, and the factor of nodes that resolves it.
const SPHERES: [(f64, f64, usize); 7] =
    [(0.1, 0.5, 1), (0.2, 0.45, 1), (0.5, 0.35, 1), (1.0, 0.25, 1), (2.0, 0.2, 1), (3.0, 0.18, 2), (5.0, 0.17, 4)];
/// The way over the pull-off, in units of (w²R/E*²)^(1/3) about its approach, and its steps.
const WAY: f64 = 0.3;
const STEPS: usize = 6;

pub fn chart(size: usize) -> Outcome<Chart> {
    let unit = PI * WORK * RADIUS;
    let length = (WORK * WORK * RADIUS).cbrt();
    println!("\nsphere, Maugis-Dugdale: pull-off force over πwR; JKR 1.5, DMT 2");
    println!("{:>5} {:>5} {:>6} {:>8} {:>8} {:>8} {:>7}", "μ_T", "n", "μ_ρ", "found", "Maugis", "error", "appl.");
    let (mut found, mut exact) = (Vec::new(), Vec::new());
    for (tabor, side, factor) in SPHERES {
        let (n, range) = (factor * size, length / tabor);
        let maugis = exact::MaugisDugdale::new(RADIUS, 1.0, WORK, range)?.pull_off();
        let grid = Grid::square(n, side)?;
        let surface = Surface::paraboloid(grid, RADIUS)?;
        let law = MaugisDugdale::new(WORK, range)?;
        let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0)?, law)?;
        let mu_rho = problem.mu_rho();
        let legs = [1.0, -1.0].map(|sign| Control::Approach(maugis.approach() + sign * WAY * length));
        let settings = PathSettings::default().steps(STEPS).smallest_step(0.05);
        let mut solver = Solver::new(Settings::default().tolerance(1e-5));
        let (mut strongest, mut applications) = (0.0_f64, 0);
        let mut path = Path::new(legs, settings)?;
        while let Some(step) = path.next(&mut solver, &mut problem)? {
            let report = step.solution.report;
            strongest = strongest.max(-report.normal_force);
            applications += report.operator_applications;
        }
        let (force, of_maugis) = (strongest / unit, -maugis.load() / unit);
        println!(
            "{tabor:>5} {n:>5} {mu_rho:>6.2} {force:>8.4} {of_maugis:>8.4} {:>6.2} % {applications:>7}",
            100.0 * (force / of_maugis - 1.0)
        );
        found.push((tabor.log10(), force));
    }
    for i in -24..=20 {
        let tabor = 10_f64.powf(0.05 * f64::from(i));
        let maugis = exact::MaugisDugdale::new(RADIUS, 1.0, WORK, length / tabor)?;
        exact.push((tabor.log10(), -maugis.pull_off().load() / unit));
    }
    Ok(Chart {
        title: "Sphere, Maugis-Dugdale: pull-off".to_owned(),
        axes: ["log₁₀ of the Tabor parameter", "pull-off force / πwR"],
        logarithmic: false,
        labels: SeriesLabelPosition::UpperRight,
        series: vec![
            Series { name: "Maugis".to_owned(), colour: BLACK, style: Style::Thin, points: exact },
            Series { name: "computed".to_owned(), colour: COLOURS[0], style: Style::Dots, points: found },
        ],
    })
}
