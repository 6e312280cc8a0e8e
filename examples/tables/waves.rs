//! Limits of Maugis' sphere, and waves with exact solutions.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use asperity::exact::{
    AdhesiveWavyLine, Hertz, Jkr, MaugisDugdale as ExactMaugisDugdale, Periodic, Sphere, WavyLine, closing_pressure_2d,
};
use asperity::{Control, Exponential, Grid, NoAdhesion, Problem, Result, Solver, Surface, Westergaard};
use common::authors::RADIUS;
use ndarray::Array2;

use crate::settings;

/// Maugis' sphere between its limits, of R = 2, E* = 1 and w = 1e-5.
pub fn limits() -> Result<()> {
    let work = 1e-5;
    let (jkr, unit) = (Jkr::new(RADIUS, 1.0, work)?, PI * work * RADIUS);
    let radius = 0.08;
    println!(
        "Limits of the exact solutions: Maugis-Dugdale's pull-off, 2 (DMT) to 1.5 (JKR), and how far its load at a = 0.08"
    );
    println!("is from JKR's and from DMT's, Hertz' less 2; all in pi w R.\n");
    println!("{:>8} {:>9} {:>11} {:>11}", "mu_T", "pull-off", "less JKR", "less DMT");
    let dmt = Hertz::new(RADIUS, 1.0)?.at_contact_radius(radius)?.load() - 2.0 * unit;
    for tabor in [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3] {
        let range = (work * work * RADIUS).cbrt() / tabor;
        let sphere = ExactMaugisDugdale::new(RADIUS, 1.0, work, range)?;
        let load = sphere.at_contact_radius(radius)?.load();
        println!(
            "{tabor:>8} {:>9.5} {:>11.2e} {:>11.2e}",
            -sphere.pull_off().load() / unit,
            (load - jkr.at_contact_radius(radius)?.load()) / unit,
            (load - dmt) / unit
        );
    }
    println!();
    Ok(())
}

/// Waves, which have exact periodic solutions, of amplitude 0.02, unit wavelength and modulus.
pub fn waves(largest: usize) -> Result<()> {
    let amplitude = 0.02;
    let line = |n: usize| -> Result<Surface> { Surface::wave(Grid::line(n, 1.0)?, amplitude, 1) };

    println!("Westergaard's wavy line at 19 mean gaps, p/p* from 0.05 to 0.95: errors of the mean pressure, in p*.\n");
    println!("{:>6} {:>9} {:>9}", "n", "largest", "rms");
    let exact = WavyLine::new(amplitude, 1.0, 1.0)?;
    let closing = exact.closing_pressure();
    let mut last = (0.0, 0.0);
    for n in [64_usize, 256, 1024, 4096].into_iter().filter(|&n| n <= 8 * largest) {
        let surface = line(n)?;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, NoAdhesion)?;
        let (mut largest, mut square) = (0.0_f64, 0.0);
        for i in 1..20 {
            let state = exact.at_mean_pressure(f64::from(i) / 20.0 * closing)?;
            let report = Solver::new(settings(1e-11)).solve(&mut problem, Control::MeanGap(state.mean_gap()))?.report;
            let error = (report.mean_pressure - state.mean_pressure()) / closing;
            largest = largest.max(error.abs());
            square += error * error / 19.0;
        }
        let now = ((n as f64).log2(), square.sqrt().log2());
        let rate =
            if last.0 > 0.0 { format!("rate {:.2}", (last.1 - now.1) / (now.0 - last.0)) } else { String::new() };
        println!("{n:>6} {largest:>9.1e} {:>9.1e}  {rate}", square.sqrt());
        last = now;
    }

    let n = (32 * largest).min(16384);
    println!(
        "\nJohnson's adhesive wavy line, n = {n}, by an exponential law of rho = 0.025 h0, at the exact mean gap: errors of"
    );
    println!(
        "the mean pressure in p*, from a uniform gap and from the exact one. (A small contact is lost from a uniform gap.)\n"
    );
    println!("{:>6} {:>7} {:>9} {:>9} {:>9} {:>9}", "alpha", "mu_rho", "a", "p/p*", "uniform", "exact");
    let surface = line(n)?;
    let grid = *surface.grid();
    for alpha in [0.2, 0.3] {
        let work = 0.5 * (alpha * PI * amplitude).powi(2);
        let exact = AdhesiveWavyLine::new(amplitude, 1.0, 1.0, work)?;
        let law = Exponential::new(work, 0.025 * amplitude)?;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
        for half_width in [0.05, 0.1, 0.2, 0.3, 0.35] {
            let state = exact.at_half_width(half_width)?;
            let start = grid.sample(|x, _| state.gap(x));
            let mut error = |start: Option<&Array2<f64>>| -> Result<f64> {
                let control = Control::MeanGap(state.mean_gap());
                let start = start.map_or(asperity::Start::Default, |gap| asperity::Start::From(gap));
                let report = Solver::new(settings(1e-8))
                    .solve_with(&mut problem, control, start, |_| ControlFlow::Continue(()))?
                    .report;
                Ok((report.mean_pressure - state.mean_pressure()) / closing)
            };
            let (uniform, warm) = (error(None)?, error(Some(&start))?);
            println!(
                "{alpha:>6} {:>7.2} {half_width:>9} {:>9.4} {uniform:>9.1e} {warm:>9.1e}",
                problem.mu_rho(),
                state.mean_pressure() / closing
            );
        }
    }

    let n = largest.min(256);
    println!(
        "\nThe two-dimensional wave h0 cos cos, {n}, about the pressure p* that closes it: the share apart, and near closing"
    );
    println!("its limit (3/2 pi)(1 - p/p*); in full contact the largest error of the pressure, in p*.\n");
    println!("{:>7} {:>10} {:>10} {:>10}", "p/p*", "apart", "limit", "error");
    let grid = Grid::square(n, 1.0)?;
    let surface = Surface::wave_2d(grid, amplitude, 1)?;
    let closing = closing_pressure_2d(amplitude, 1.0, 1.0)?;
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    for share in [0.8, 0.9, 0.95, 0.98, 1.0, 1.1] {
        let solution = Solver::new(settings(1e-9)).solve(&mut problem, Control::MeanPressure(share * closing))?;
        let exact = grid.sample(|x, y| closing * (share + (TAU * x).cos() * (TAU * y).cos()));
        let error = (&solution.pressure - &exact).iter().fold(0.0_f64, |m, e| m.max(e.abs())) / closing;
        let error = if share < 1.0 { "-".to_owned() } else { format!("{error:.0e}") };
        let limit = (1.5 / PI * (1.0 - share)).max(0.0);
        println!("{share:>7} {:>10.5} {limit:>10.5} {error:>10}", 1.0 - solution.report.contact_fraction);
    }

    let n = largest.min(512);
    println!(
        "\nHertz among its periodic images, {n}: relative errors of the load at given mean gaps, against the exact solution"
    );
    println!("over the mean height of the nodes, and over that of the paraboloid.\n");
    println!("{:>9} {:>8} {:>9} {:>9}", "mean gap", "a", "nodes'", "cont.");
    let grid = Grid::square(n, 1.0)?;
    let surface = Surface::paraboloid(grid, RADIUS)?;
    let periodic = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?;
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
    for gap in [0.037, 0.038, 0.0385, 0.039, 0.0395, 0.0398, 0.04] {
        let found = Solver::new(settings(1e-8)).solve(&mut problem, Control::MeanGap(gap))?.report.mean_pressure;
        let exact = periodic.at_mean_gap(gap, surface.mean())?;
        let continuous = periodic.at_mean_gap(gap, -1.0 / (12.0 * RADIUS))?;
        println!(
            "{gap:>9} {:>8.4} {:>9.1e} {:>9.1e}",
            exact.contact().contact_radius(),
            found / exact.mean_pressure() - 1.0,
            found / continuous.mean_pressure() - 1.0
        );
    }
    println!();
    Ok(())
}
