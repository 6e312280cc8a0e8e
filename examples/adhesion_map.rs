//! Greenwood's adhesion map of a sphere by Lennard-Jones: the pull-off force over Tabor's parameter, on a free
//! half-space and without a wall, next to Maugis–Dugdale, JKR and DMT.
//!
//! `cargo run --release -p asperity-examples --example adhesion_map`
//!
//! Tabor parameters are left out where the grid does not resolve the adhesive zone (μ_ρ above 0.5). Lengths are in
//! units of R, pressures of E*, and forces are drawn over πwR. The constant traction of Maugis–Dugdale is the largest
//! of Lennard-Jones, 1.026 w/z₀.

use std::f64::consts::PI;
use std::path::{Path as File, PathBuf};

use asperity::exact::{self, Sphere};
use asperity::path::{Path, PathSettings};
use asperity::{Boussinesq, Control, Grid, LennardJones, NoWall, Problem, Report, Settings, Solver, Status, Surface};
use clap::Parser;
use common::legend::legend;
use common::{Outcome, arguments};
use plotters::prelude::*;

const TABOR: [f64; 9] = [0.1, 0.2, 0.35, 0.6, 1.0, 1.5, 2.0, 3.0, 4.0];
/// (wR²/E*)^(1/3), the scale of contact radii, in R: small, so that the paraboloid is flat.
const SCALE: f64 = 0.02;
/// The gap at the edge of the window over z₀: the tail beyond holds 4/3 of its inverse square, 0.2 % of w.
const EDGE: f64 = 25.0;
/// The largest traction of Lennard-Jones, in w/z₀.
const STRONGEST: f64 = 1.0264;

/// A withdrawal: approaches over the scale a²/R, forces over πwR.
struct Withdrawal {
    mu_rho: f64,
    points: Vec<(f64, f64)>,
    applications: usize,
}

impl Withdrawal {
    /// The largest tension, of the parabola through the three points about it.
    fn pull_off(&self) -> f64 {
        let least = (0..self.points.len()).min_by(|&a, &b| self.points[a].1.total_cmp(&self.points[b].1)).unwrap_or(0);
        let Some(&[(a, fa), (b, fb), (c, fc)]) =
            least.checked_sub(1).and_then(|first| self.points[first..].first_chunk())
        else {
            return self.points.get(least).map_or(f64::NAN, |point| -point.1);
        };
        let (left, right) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
        let bend = (right - left) / (c - a);
        let slope = left + bend * (b - a);
        -(fb - 0.25 * slope * slope / bend)
    }
}

/// Pulls a sphere off at given approaches.
fn withdraw(tabor: f64, size: usize) -> Outcome<Option<Withdrawal>> {
    let (work, depth) = (SCALE.powi(3), SCALE * SCALE);
    let rest = depth / tabor;
    // the window ends where the gap is far beyond the range, and holds the contact
    let half = (2.0 * EDGE * rest).sqrt().max(3.0 * SCALE);
    let grid = Grid::square(size, 2.0 * half)?;
    let surface = Surface::paraboloid(grid, 1.0)?;
    let law = LennardJones::new(work, rest)?;
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0)?, law)?;
    let mu_rho = problem.mu_rho();
    if mu_rho > Report::RESOLVED_MU_RHO {
        return Ok(None);
    }
    let mut solver = Solver { settings: Settings::default().tolerance(1e-5), constraint: NoWall };
    let settings = PathSettings::default().steps(60).smallest_step(1e-3);
    // approaches count from touch, and the law keeps the surfaces apart by z₀
    let loads = [0.5 * depth - rest, -3.0 * depth - 2.0 * rest].map(Control::Approach);
    let mut found = Withdrawal { mu_rho, points: Vec::new(), applications: 0 };
    let mut path = Path::new(loads, settings)?;
    while let Some(step) = path.next(&mut solver, &mut problem)? {
        let report = step.solution.report;
        if report.status != Status::Converged {
            return Err(format!("Tabor parameter {tabor}: {}", report.status).into());
        }
        let force = report.normal_force / (PI * work);
        let strongest = found.points.iter().map(|point| -point.1).fold(0.0, f64::max);
        found.points.push(((report.approach.unwrap_or_default() + rest) / depth, force));
        found.applications += report.operator_applications;
        // past the pull-off
        if -force < 0.9 * strongest {
            break;
        }
    }
    Ok(Some(found))
}

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(long, value_name = "N", default_value_t = 320, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// The figure
    #[arg(long, value_name = "FILE.svg", default_value = "target/figures/adhesion-map.svg")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("adhesion_map.rs"));
    if let Some(folder) = out.parent() {
        std::fs::create_dir_all(folder)?;
    }
    println!("sphere by Lennard-Jones, free half-space, {size}²: pull-off force over πwR");
    println!("\n| μ | μ_ρ | Lennard-Jones | Maugis–Dugdale, exact | applications |\n|---|---|---|---|---|");
    let mut found = Vec::new();
    for tabor in TABOR {
        let Some(withdrawal) = withdraw(tabor, size)? else {
            println!("| {tabor} | not resolved | | | |");
            continue;
        };
        let (force, theirs) = (withdrawal.pull_off(), maugis_dugdale(tabor)?);
        let Withdrawal { mu_rho, applications, .. } = withdrawal;
        println!("| {tabor} | {mu_rho:.2} | {force:.3} | {theirs:.3} | {applications} |");
        found.push((tabor, force));
    }
    draw(&out, size, &found)?;
    println!("\ndrawn in {}", out.display());
    Ok(())
}

/// The pull-off force over πwR of the constant traction that is the largest of Lennard-Jones.
fn maugis_dugdale(tabor: f64) -> Outcome<f64> {
    let work = SCALE.powi(3);
    let range = SCALE * SCALE / tabor / STRONGEST;
    let sphere = exact::MaugisDugdale::new(1.0, 1.0, work, range)?;
    Ok(-sphere.pull_off().load() / (PI * work))
}

fn draw(path: &File, size: usize, found: &[(f64, f64)]) -> Outcome<()> {
    let root = SVGBackend::new(path, (860, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(&format!("Pull-off of a sphere by Lennard-Jones, {size}²"), ("sans-serif", 20))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(14)
        .margin_right(30)
        .x_label_area_size(50)
        .y_label_area_size(70)
        .build_cartesian_2d((0.05..10.0).log_scale(), 1.4..2.1)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("Tabor's parameter (w²R/E*²z₀³)^(1/3)")
        .y_desc("pull-off force / πwR")
        .label_style(("sans-serif", 15))
        .draw()?;
    let parameters = (0..=120).map(|i| 0.05 * 200.0_f64.powf(f64::from(i) / 120.0));
    let curve: Outcome<Vec<_>> = parameters.map(|tabor| Ok((tabor, maugis_dugdale(tabor)?))).collect();
    let (blue, orange) = (RGBColor(10, 90, 200), RGBColor(225, 110, 20));
    for (name, force) in [("DMT", 2.0), ("JKR", 1.5)] {
        let grey = RGBColor(130, 130, 130);
        chart.draw_series(LineSeries::new([(0.05, force), (10.0, force)], grey.stroke_width(1)))?;
        chart.draw_series([Text::new(name, (0.053, force + 0.03), ("sans-serif", 16).into_font().color(&grey))])?;
    }
    chart
        .draw_series(LineSeries::new(curve?, blue.stroke_width(2)))?
        .label("Maugis–Dugdale, exact")
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], blue.stroke_width(2)));
    chart
        .draw_series(found.iter().map(|&point| Circle::new(point, 5, orange.filled())))?
        .label("Lennard-Jones, asperity")
        .legend(move |(x, y)| Circle::new((x + 11, y), 5, orange.filled()));
    legend(&mut chart, SeriesLabelPosition::UpperRight)?;
    root.present()?;
    Ok(())
}
