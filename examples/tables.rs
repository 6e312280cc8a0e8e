//! Tables 1 to 4 of Rey, Anciaux and Molinari (2017), the paper's values beside ours.
//!
//! `cargo run --release --example tables [largest size]`, 1024 unless given.

#[path = "../tests/common/authors.rs"]
mod authors;
#[path = "../tests/common/rough.rs"]
mod rough;

use std::time::Instant;

use asperity::exact::{Hertz, Jkr, MaugisDugdale as ExactMaugisDugdale, Periodic, PeriodicContact};
use asperity::{
    AdhesionLaw, ContactConstraint, Control, ElasticOperator, Exponential, Grid, MaugisDugdale, NoAdhesion, Penalty,
    Problem, Projection, Result, Settings, Solution, Solver, Surface, Uzawa, Westergaard,
};
use authors::RADIUS;
use ndarray::Array2;

fn main() -> Result<()> {
    let largest = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1024);
    let sizes: Vec<usize> = [64, 128, 256, 512, 1024, 2048].into_iter().filter(|&n| n <= largest).collect();
    table_1(&sizes)?;
    table_2()?;
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
    Settings { tolerance, ..Settings::default() }
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
    /// a uniform gap that is given, so that the law's jump is not smoothed for it
    Uniform,
    Exact,
}

/// Relative errors of a solution against an exact one on a periodic grid: in energy norm, and in L² of displacement
/// (without mean) and pressure.
fn periodic_errors<L: AdhesionLaw<f64>>(
    n: usize,
    law: L,
    mean_gap: f64,
    exact: impl Fn(f64) -> Result<PeriodicContact>,
    start: Start,
) -> Result<[f64; 3]> {
    let grid = Grid::square(n, 1.0)?;
    let surface = Surface::paraboloid(grid, RADIUS)?;
    let exact = exact(surface.mean())?;
    let (u_exact, p_exact) = (exact.displacement_field(&grid)?, exact.pressure_field(&grid)?);
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
    let start = match start {
        Start::Default => None,
        Start::Uniform => Some(Array2::from_elem(grid.shape(), mean_gap)),
        Start::Exact => Some((&u_exact - surface.heights()).mapv(|g| if g < 1e-7 { 0.0 } else { g })),
    };
    let start = start.as_ref().map(|gap| gap.view());
    let solution = Solver::new(settings(1e-7))
        .solve_from(&mut problem, Control::MeanGap(mean_gap), start, |_| std::ops::ControlFlow::Continue(()))?;
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

fn table_2() -> Result<()> {
    let n = 512;
    println!("Table 2: three ways to keep the gap from becoming negative; Hertz 512, load 2e-4, the authors' nodes.");
    println!(
        "The printed eta and theta are eta2 and theta2. Certified error 1e-8. The pressure is recovered from its mean where"
    );
    println!("the surfaces are apart; in brackets eta2 with -min q, as the paper says, and with -max q.\n");
    println!(
        "{:<22} {:>9} {:>9} {:>9} {:>9} | {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>6} {:>6} {:>8}",
        "method",
        "k L/E*",
        "eta2",
        "theta2",
        "min gap",
        "paper",
        "paper",
        "paper",
        "(-min q)",
        "(-max q)",
        "outer",
        "steps",
        "appl.",
        "seconds"
    );
    let surface = authors::surface(n)?;
    let control = Control::MeanPressure(2e-4);
    let row = |name: &str, k: Option<f64>, printed: [&str; 3], run: &mut Run<'_>| -> Result<()> {
        let mut problem = Problem::new(&surface, Westergaard::new(*surface.grid(), 1.0)?, NoAdhesion)?;
        let clock = Instant::now();
        let (solution, outer) = run(&mut problem)?;
        let seconds = clock.elapsed().as_secs_f64();
        let report = &solution.report;
        let (eta, theta) = authors::errors(&surface, 2e-4, &solution.gap, &solution.contact_pressure)?;
        // the elastic pressure without its mean, from which the paper recovers the mean
        let centred = solution.pressure.mapv(|p| p - report.mean_pressure);
        let (low, high) = centred.iter().fold((0.0_f64, 0.0_f64), |(a, b), &p| (a.min(p), b.max(p)));
        let by_min = authors::errors(&surface, 2e-4, &solution.gap, &centred.mapv(|p| p - low))?.0;
        let by_max = authors::errors(&surface, 2e-4, &solution.gap, &centred.mapv(|p| p - high))?.0;
        let k = k.map_or_else(|| "-".to_owned(), |k| k.to_string());
        println!(
            "{name:<22} {k:>9} {eta:>9.3e} {theta:>9.3e} {:>9.1e} | {:>9} {:>9} {:>9} {by_min:>9.2e} {by_max:>9.2e} {outer:>6} {:>6} {:>6} {seconds:>8.2}  {}",
            report.min_gap,
            printed[0],
            printed[1],
            printed[2],
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
            with(problem, Uzawa::new(k)?, control).map(|(s, uzawa)| (s, uzawa.outer_iterations()))
        })?;
    }

    println!(
        "\nThe same on a rough surface of rms slope 0.1 with an exponential law (w = 2e-6, rho = 3e-4), 256, mean gap 0.0035,"
    );
    println!("where the paper says that penalty and Uzawa diverge. Certified error 1e-6, at most 2000 steps.\n");
    let grid = Grid::square(256, 1.0)?;
    let unit = rough::rough(grid, 32, 1);
    let rough = Surface::new(grid, unit.heights().mapv(|h| 0.1 * h))?;
    let law = Exponential::new(2e-6, 3e-4)?;
    let mut problem = Problem::new(&rough, Westergaard::new(grid, 1.0)?, law)?;
    let control = Control::MeanGap(0.0035);
    let print = |name: &str, solution: &Solution<f64>| {
        let r = &solution.report;
        println!(
            "{name:<22} {:<15} error {:>8.1e} contact {:>5.2} % min gap {:>9.1e} steps {:>5} applications {:>5}",
            r.status.name(),
            r.relative_error,
            100.0 * r.contact_fraction,
            r.min_gap,
            r.iterations,
            r.operator_applications
        );
    };
    print("constrained gradient", &Solver::default().solve(&mut problem, control)?);
    for k in [50.0, 500.0, 5000.0] {
        let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(k)? };
        print(&format!("penalty, k = {k}"), &solver.solve(&mut problem, control)?);
        let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(k)? };
        print(&format!("Uzawa, k = {k}"), &solver.solve(&mut problem, control)?);
    }
    println!();
    Ok(())
}

type Hard = Problem<f64, Westergaard<f64>, NoAdhesion>;

/// A solve, with the number of its outer iterations.
type Run<'a> = dyn FnMut(&mut Hard) -> Result<(Solution<f64>, usize)> + 'a;

fn with<C: ContactConstraint<f64>>(problem: &mut Hard, constraint: C, control: Control) -> Result<(Solution<f64>, C)> {
    let mut solver = Solver { settings: settings(1e-8), constraint };
    let solution = solver.solve(problem, control)?;
    Ok((solution, solver.constraint))
}

fn table_34(title: &str, sizes: &[usize], (range, work, gap): (f64, f64, f64), paper: [f64; 6]) -> Result<()> {
    println!("{title}.");
    println!(
        "Ours against the exact Maugis-Dugdale solution with periodic images at that mean gap, from three starts: the default,"
    );
    println!("a uniform gap, and the exact gap. mu_rho above 0.5: the grid does not resolve the adhesive zone.");
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
