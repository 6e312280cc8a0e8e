//! Tables 1, 3 and 4: the errors against exact solutions on periodic grids.

use asperity::exact::{Hertz, Jkr, MaugisDugdale as ExactMaugisDugdale, Periodic, PeriodicContact};
use asperity::{
    AdhesionLaw, Control, ElasticOperator, Grid, MaugisDugdale, NoAdhesion, Problem, Result, Solver, Surface,
    Westergaard,
};
use common::authors;
use common::authors::RADIUS;
use common::sharp::Sharp;
use ndarray::Array2;

use crate::settings;

pub fn table_1(sizes: &[usize]) -> Result<()> {
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

pub fn table_34(title: &str, sizes: &[usize], (range, work, gap): (f64, f64, f64), paper: [f64; 6]) -> Result<()> {
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
