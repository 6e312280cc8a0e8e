//! Tables 1 to 4 of Rey, Anciaux and Molinari (2017), the paper's values next to ours; and waves and limits that have
//! exact solutions.
//!
//! `cargo run --release -p asperity-examples --example tables`

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::time::Instant;

use asperity::exact::{
    AdhesiveWavyLine, Hertz, Jkr, MaugisDugdale as ExactMaugisDugdale, Periodic, PeriodicContact, Sphere, WavyLine,
    closing_pressure_2d,
};
use asperity::{
    AdhesionLaw, ContactConstraint, Control, ElasticOperator, Exponential, Grid, MaugisDugdale, NoAdhesion, Penalty,
    Problem, Projection, Result, Settings, Solution, Solver, Surface, Uzawa, Westergaard,
};
use clap::Parser;
use common::authors::RADIUS;
use common::outrun::Outrun;
use common::sharp::Sharp;
use common::{arguments, authors, rough};
use ndarray::Array2;

#[derive(Parser)]
struct Arguments {
    /// The largest grid, in nodes along a side; below 512 the tables of larger grids are shown on smaller ones
    #[arg(default_value_t = 1024, value_parser = arguments::nodes::<64>)]
    largest: usize,
}

fn main() -> Result<()> {
    let Arguments { largest } = arguments::read(include_str!("tables.rs"));
    let sizes: Vec<usize> = [64, 128, 256, 512, 1024, 2048].into_iter().filter(|&n| n <= largest).collect();
    table_1(&sizes)?;
    table_2(largest.min(512))?;
    limits()?;
    waves(largest)?;
    table_34(
        "Table 3: rho = 3e-4, w = 1e-5, mean gap 0.0405; the paper against JKR",
        &sizes,
        (3e-4, 1e-5, 0.0405),
        [36.35, 14.06, 5.47, 1.70, 0.5856, 0.2876],
    )?;
    table_34(
        "Table 4: rho = 2e-3, w = 1e-4, mean gap 0.0429; the paper against Maugis-Dugdale",
        &sizes,
        (2e-3, 1e-4, 0.0429),
        [9.52, 2.07, 0.648, 0.133, 0.0865, 0.0495],
    )
}

fn settings(tolerance: f64) -> Settings {
    Settings::default().tolerance(tolerance)
}

fn table_1(sizes: &[usize]) -> Result<()> {
    println!(
        "Table 1: Hertz, load 2e-4. eta as the authors place nodes and sum; on a periodic grid, the errors against"
    );
    println!(
        "the exact solution with periodic images at the same mean gap, 0.0398 (energy norm, and L2 of u and p).\n"
    );
    println!(
        "{:>6} {:>9} {:>11} {:>12} | {:>11} {:>11} {:>11}  remark",
        "n", "paper", "eta, ours", "mean gap", "energy", "L2 of u", "L2 of p"
    );
    let paper: [f64; 6] = [1.40e-2, 4.08e-3, 7.78e-4, 3.66e-4, 1.20e-4, 1.66e-5];
    let mut rates = Rates::default();
    for (&n, paper) in sizes.iter().zip(paper) {
        let surface = authors::surface(n)?;
        let mut problem = Problem::new(&surface, Westergaard::new(*surface.grid(), 1.0)?, NoAdhesion)?;
        let solution = Solver::new(settings(1e-11)).solve(&mut problem, Control::MeanPressure(2e-4))?;
        let (eta, _) = authors::errors(&surface, 2e-4, &solution.gap, &solution.contact_pressure)?;
        let eta = eta.sqrt();

        let periodic = Periodic::new(Hertz::new(RADIUS, 1.0)?, 1.0)?;
        let errors = periodic_errors(n, NoAdhesion, 0.0398, |mean| periodic.at_mean_gap(0.0398, mean), Start::Default)?;
        rates.push(n, errors);
        // the printed digits are cut off, not rounded
        let unit = 10_f64.powf(paper.log10().floor() - 2.0);
        let same = (eta / unit).floor() == (paper / unit).round();
        let remark = if same {
            "the printed digits".to_owned()
        } else {
            let shifted = solution.contact_pressure.mapv(|p| p + 2e-12);
            let (eta, _) = authors::errors(&surface, 2e-4, &solution.gap, &shifted)?;
            format!("differs; with the pressure 2e-12 larger it would be {:.4e}", eta.sqrt())
        };
        println!(
            "{n:>6} {paper:>9.2e} {eta:>11.4e} {:>12.8} | {:>11.2e} {:>11.2e} {:>11.2e}  {remark}",
            solution.report.mean_gap, errors[0], errors[1], errors[2]
        );
    }
    rates.print();
    println!();
    Ok(())
}

/// Where a solve starts.
#[derive(Clone, Copy)]
enum Start {
    Default,
    /// a uniform gap, without smoothing the law's jump
    Uniform,
    /// the same from the exact gap
    Exact,
}

/// Relative errors of a solution against an exact one on a periodic grid: in energy norm, and in L² of displacement
/// (without mean) and pressure.
fn periodic_errors(
    n: usize,
    law: impl AdhesionLaw<f64> + 'static,
    mean_gap: f64,
    exact: impl Fn(f64) -> Result<PeriodicContact>,
    start: Start,
) -> Result<[f64; 3]> {
    let grid = Grid::square(n, 1.0)?;
    let surface = Surface::paraboloid(grid, RADIUS)?;
    let exact = exact(surface.mean())?;
    let (u_exact, p_exact) = (exact.displacement_field(&grid)?, exact.pressure_field(&grid)?);
    let law: Box<dyn AdhesionLaw<f64>> = if let Start::Default = start { Box::new(law) } else { Box::new(Sharp(law)) };
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
    let start = match start {
        Start::Default => None,
        Start::Uniform => Some(Array2::from_elem(grid.shape(), mean_gap)),
        Start::Exact => Some((&u_exact - surface.heights()).mapv(|g| if g < 1e-7 { 0.0 } else { g })),
    };
    let start = start.as_ref().map_or(asperity::Start::Default, |gap| asperity::Start::From(gap));
    let solution = Solver::new(settings(1e-7))
        .solve_with(&mut problem, Control::MeanGap(mean_gap), start, |_| std::ops::ControlFlow::Continue(()))?;
    let u = &solution.gap + surface.heights();
    let centred = |u: Array2<f64>| {
        let mean = u.sum() / u.len() as f64;
        u - mean
    };
    let (difference, u_exact) = (centred(&u - &u_exact), centred(u_exact));
    let mut operator = Westergaard::<f64>::new(grid, 1.0)?;
    let mut energy = |u: &Array2<f64>| -> Result<f64> {
        let mut p = Array2::zeros(u.dim());
        operator.pressure(u.view(), p.view_mut())?;
        Ok((u * &p).sum())
    };
    let square = |field: &Array2<f64>| field.iter().map(|x| x * x).sum::<f64>();
    Ok([
        (energy(&difference)? / energy(&u_exact)?).sqrt(),
        (square(&difference) / square(&u_exact)).sqrt(),
        (square(&(&solution.pressure - &p_exact)) / square(&p_exact)).sqrt(),
    ])
}

/// The errors of a refinement, and the rates at which they fall.
#[derive(Default)]
struct Rates(Vec<(f64, [f64; 3])>);

impl Rates {
    fn push(&mut self, n: usize, errors: [f64; 3]) {
        self.0.push(((n as f64).log2(), errors.map(f64::log2)));
    }

    /// The slopes of the least-squares lines through the logarithms.
    fn print(&self) {
        let count = self.0.len() as f64;
        let mean = self.0.iter().map(|(n, _)| n).sum::<f64>() / count;
        let spread = self.0.iter().map(|(n, _)| (n - mean).powi(2)).sum::<f64>();
        let slope = |k: usize| -self.0.iter().map(|(n, e)| (n - mean) * e[k]).sum::<f64>() / spread;
        if self.0.len() > 1 {
            println!(
                "rates: energy norm {:.2}, L2 of u {:.2}, L2 of p {:.2}; the paper's fit of eta: 1.8 without and 1.5 with adhesion",
                slope(0),
                slope(1),
                slope(2)
            );
        }
    }
}

fn table_2(n: usize) -> Result<()> {
    println!("Table 2: three ways to keep the gap from becoming negative; Hertz {n}, load 2e-4, the authors' nodes.");
    println!(
        "The printed eta and theta are eta2 and theta2. Constrained CG finds the mean gap of that load; all three are then"
    );
    println!(
        "solved at this gap, to a certified error of 1e-8. The pressure is recovered from its mean where the surfaces are"
    );
    println!(
        "apart; then eta2 by other recoveries: -min q, as the paper says; -max q; and that of q with the contact pressure"
    );
    println!(
        "counted twice, which gives the printed 10. The printed 54 would take a mean pressure of -0.23, eleven times the"
    );
    println!("largest pressure: how it came about was not found.\n");
    println!(
        "{:<21} {:>7} {:>9} {:>9} {:>9} | {:>6} {:>6} {:>5} | {:>8} {:>7} {:>7} | {:>5} {:>6} {:>6} {:>7}",
        "method",
        "k L/E*",
        "eta2",
        "theta2",
        "min gap",
        "paper",
        "",
        "",
        "(-min q)",
        "(-max)",
        "(twice)",
        "outer",
        "steps",
        "appl.",
        "seconds"
    );
    let surface = authors::surface(n)?;
    let load = 2e-4;
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, NoAdhesion)?;
    let at_load = Solver::new(settings(1e-11)).solve(&mut problem, Control::MeanPressure(load))?;
    let control = Control::MeanGap(at_load.report.mean_gap);
    let row = |name: &str, k: Option<f64>, printed: [&str; 3], run: &mut Run<'_>| -> Result<()> {
        let mut problem = Problem::new(&surface, Westergaard::new(*surface.grid(), 1.0)?, NoAdhesion)?;
        let clock = Instant::now();
        let (solution, outer) = run(&mut problem)?;
        let seconds = clock.elapsed().as_secs_f64();
        let report = &solution.report;
        // the elastic pressure without its mean, from which the paper recovers the mean
        let centred = solution.pressure.mapv(|p| p - report.mean_pressure);
        let recovered = |p0: f64| authors::errors(&surface, load, &solution.gap, &centred.mapv(|p| p + p0));
        let (low, high) = centred.iter().fold((0.0_f64, 0.0_f64), |(a, b), &p| (a.min(p), b.max(p)));
        let twice = (&centred + &solution.contact_pressure).iter().copied().fold(0.0, f64::max);
        let (eta, theta) = recovered(report.mean_pressure)?;
        let k = k.map_or_else(|| "-".to_owned(), |k| k.to_string());
        println!(
            "{name:<21} {k:>7} {eta:>9.3e} {theta:>9.3e} {:>9.1e} | {:>6} {:>6} {:>5} | {:>8.1e} {:>7.2} {:>7.2} | {outer:>5} {:>6} {:>6} {seconds:>7.2}  {}",
            report.min_gap,
            printed[0],
            printed[1],
            printed[2],
            recovered(-low)?.0,
            recovered(-high)?.0,
            recovered(-twice)?.0,
            report.iterations,
            report.operator_applications,
            report.status
        );
        Ok(())
    };
    row("constrained gradient", None, ["1.3e-7", "1.5e-4", "0"], &mut |problem| {
        with(problem, Projection, control).map(|(s, _)| (s, 0))
    })?;
    for k in [500.0, 5000.0, 50_000.0] {
        let printed = if k == 5000.0 { ["10", "2e-4", "-4e-6"] } else { [""; 3] };
        row("penalty", Some(k), printed, &mut |problem| with(problem, Penalty::new(k)?, control).map(|(s, _)| (s, 0)))?;
    }
    for k in [500.0, 5000.0] {
        let printed = if k == 5000.0 { ["54", "1.9e-4", "0"] } else { [""; 3] };
        row("Uzawa", Some(k), printed, &mut |problem| {
            with(problem, Uzawa::new(k)?, control).map(|(s, uzawa)| (s, uzawa.rounds()))
        })?;
    }
    table_2_rough(n.min(256))
}

/// Penalty and Uzawa on a rough surface with an exponential law.
fn table_2_rough(n: usize) -> Result<()> {
    println!(
        "\nThe same on a rough surface of rms slope 0.1 with an exponential law (w = 2e-6, rho = 3e-4), {n}, mean gap 0.0035,"
    );
    println!("where the paper says that penalty and Uzawa diverge. Certified error 1e-6, at most 2000 steps.\n");
    let grid = Grid::square(n, 1.0)?;
    let unit = rough::rough(grid, 32, 1);
    let rough = Surface::new(grid, unit.heights().mapv(|h| 0.1 * h))?;
    let law = Exponential::new(2e-6, 3e-4)?;
    let mut problem = Problem::new(&rough, Westergaard::new(grid, 1.0)?, law)?;
    println!(
        "{:<21} {:>7} {:<15} {:>8} {:>12} {:>9} {:>9} | {:>5} {:>6} {:>6}",
        "method", "k L/E*", "ended", "error", "mean p", "contact %", "min gap", "outer", "steps", "appl."
    );
    let print = |name: &str, k: &str, solution: &Solution<f64>, outer: usize| {
        let r = &solution.report;
        println!(
            "{name:<21} {k:>7} {:<15} {:>8.1e} {:>12.5e} {:>9.2} {:>9.1e} | {outer:>5} {:>6} {:>6}",
            r.status.name(),
            r.relative_error,
            r.mean_pressure,
            100.0 * r.contact_fraction,
            r.min_gap,
            r.iterations,
            r.operator_applications
        );
    };
    let control = Control::MeanGap(0.0035);
    print("constrained gradient", "-", &Solver::default().solve(&mut problem, control)?, 0);
    for k in [50.0, 500.0, 5000.0, 50_000.0] {
        let name = k.to_string();
        let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(k)? };
        print("penalty", &name, &solver.solve(&mut problem, control)?, 0);
        let mut solver = Solver { settings: Settings::default(), constraint: Outrun(Penalty::new(k)?, law) };
        print("  no tangent", &name, &solver.solve(&mut problem, control)?, 0);
    }
    for k in [50.0, 500.0, 5000.0, 50_000.0] {
        let name = k.to_string();
        let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(k)? };
        let solution = solver.solve(&mut problem, control)?;
        print("Uzawa", &name, &solution, solver.constraint.rounds());
        let mut solver = Solver { settings: Settings::default(), constraint: Outrun(Uzawa::new(k)?, law) };
        let solution = solver.solve(&mut problem, control)?;
        print("  no tangent", &name, &solution, solver.constraint.0.rounds());
    }
    let highest = rough.heights().iter().copied().fold(f64::NEG_INFINITY, f64::max);
    println!(
        "\nThey diverge if the exponential is evaluated at negative gaps (no tangent), where it outruns any springs. A first step"
    );
    println!(
        "from a uniform gap that leaves the half-space flat lands {:.1} rho deep; the barrier, k|g| = phi'(g), is at {:.1} rho for",
        (highest - rough.mean() - 0.0035) / law.range(),
        barrier(5e3 * law.range() / law.traction(0.0))
    );
    println!(
        "k = 5000 and at {:.1} rho for 50 000, with which both converge all the same. With the law's tangent there is no barrier.\n",
        barrier(5e4 * law.range() / law.traction(0.0))
    );
    Ok(())
}

/// The larger x with `stiffness` x = exp x.
fn barrier(stiffness: f64) -> f64 {
    (0..60).fold(10.0, |x: f64, _| (stiffness * x).ln())
}

/// A solve, with the number of its rounds.
type Run<'a> = dyn FnMut(&mut Problem<f64>) -> Result<(Solution<f64>, usize)> + 'a;

fn with<C: ContactConstraint<f64> + 'static>(
    problem: &mut Problem<f64>,
    constraint: C,
    control: Control,
) -> Result<(Solution<f64>, C)> {
    let mut solver = Solver { settings: settings(1e-8), constraint };
    let solution = solver.solve(problem, control)?;
    Ok((solution, solver.constraint))
}

/// Maugis' sphere between its limits, of R = 2, E* = 1 and w = 1e-5.
fn limits() -> Result<()> {
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
fn waves(largest: usize) -> Result<()> {
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

fn table_34(title: &str, sizes: &[usize], (range, work, gap): (f64, f64, f64), paper: [f64; 6]) -> Result<()> {
    println!("{title}.");
    println!(
        "Ours against the exact Maugis-Dugdale solution with periodic images at that mean gap, from three starts: the default,"
    );
    println!(
        "and without smoothing a uniform gap and the exact gap. mu_rho above 0.5: the grid does not resolve the adhesive zone."
    );
    println!("In each: energy norm, L2 of u, L2 of p.\n");
    let sphere = ExactMaugisDugdale::new(RADIUS, 1.0, work, range)?;
    let exact = Periodic::new(sphere, 1.0)?;
    let state = exact.at_mean_gap(gap, -1.0 / (12.0 * RADIUS))?;
    let jkr = Periodic::new(Jkr::new(RADIUS, 1.0, work)?, 1.0)?.at_mean_gap(gap, -1.0 / (12.0 * RADIUS));
    println!(
        "Tabor parameter {:.2}; exact: a = {:.5}, c = {:.5}, mean pressure {:.4e}{}",
        sphere.tabor_parameter(),
        state.contact().contact_radius(),
        state.contact().adhesion_radius(),
        state.mean_pressure(),
        jkr.map_or_else(
            |_| String::new(),
            |s| format!("; JKR: a = {:.5}, {:.4e}", s.contact().contact_radius(), s.mean_pressure())
        ),
    );
    println!(
        "{:>6} {:>8} {:>9} | {:<28} | {:<28} | {:<28}",
        "n", "mu_rho", "eta paper", "default", "a uniform gap", "the exact gap"
    );
    let mut rates = [(); 3].map(|()| Rates::default());
    for (&n, paper) in sizes.iter().zip(paper) {
        let law = MaugisDugdale::new(work, range)?;
        print!("{n:>6} {:>8.2} {paper:>9}", (work / n as f64).sqrt() / range);
        for (start, rates) in [Start::Default, Start::Uniform, Start::Exact].into_iter().zip(&mut rates) {
            let errors = periodic_errors(n, law, gap, |mean| exact.at_mean_gap(gap, mean), start)?;
            rates.push(n, errors);
            print!(" | {:>8.2e} {:>9.2e} {:>9.2e}", errors[0], errors[1], errors[2]);
        }
        println!();
    }
    for (name, rates) in ["the default", "a uniform gap", "the exact gap"].into_iter().zip(&rates) {
        print!("from {name}, ");
        rates.print();
    }
    println!();
    Ok(())
}
