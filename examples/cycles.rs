//! Approach and withdrawal with adhesion: a sphere, a wave and a rough surface, against exact solutions where there are
//! any.
//!
//! `cargo run --release -p asperity-examples --example cycles`
//!
//! The sphere has
//! Tabor parameters from 0.1 to 5 and is compared with Maugis' solution among its periodic images; the wave has
//! Johnson's α = 0.2, and ranges of adhesion that tend to none.

use std::f64::consts::PI;
use std::path::{Path as File, PathBuf};

use asperity::exact::{self, AdhesiveWavyLine, Periodic};
use asperity::path::{Event, Path, PathSettings};
use asperity::{
    AdhesionLaw, Control, Exponential, Grid, MaugisDugdale, Problem, SelfAffine, Settings, Solver, Status, Surface,
    Westergaard,
};
use clap::Parser;
use common::legend::legend;
use common::{Outcome, arguments};
use plotters::prelude::*;

type Points = Vec<(f64, f64)>;

/// Tabor parameters with works of adhesion in E*L for which the grid resolves the range and the cell holds the contact.
const SPHERES: [(f64, f64); 5] = [(0.1, 2e-6), (0.3, 1e-5), (1.0, 1e-4), (2.5, 2e-4), (5.0, 3e-4)];
const RADIUS: f64 = 2.0;
/// The least approach that is drawn, in units of (w²R/E*²)^(1/3).
const FARTHEST: f64 = -5.0;
/// Amplitude of the wave, Johnson's parameter, and ranges over the amplitude with numbers of nodes that resolve them.
const AMPLITUDE: f64 = 0.02;
const ALPHA: f64 = 0.2;
const WAVES: [(f64, usize); 4] = [(0.2, 512), (0.1, 1024), (0.05, 2048), (0.025, 8192)];
const COLOURS: [RGBColor; 5] = [
    RGBColor(10, 90, 200),
    RGBColor(225, 110, 20),
    RGBColor(0, 140, 100),
    RGBColor(160, 20, 30),
    RGBColor(130, 80, 170),
];

/// The colour of the way there.
fn light(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let half = |c: u8| c / 2 + 127;
    RGBColor(half(r), half(g), half(b))
}

/// A cycle, in numbers.
struct Cycle {
    approach: Points,
    withdrawal: Points,
    events: Vec<Event>,
    dissipated: f64,
    imbalance: f64,
    steps: usize,
    mu_rho: f64,
    unconverged: usize,
}

impl Cycle {
    /// The largest tension.
    fn pull_off(&self) -> f64 {
        self.withdrawal.iter().map(|point| -point.1).fold(f64::NEG_INFINITY, f64::max)
    }

    fn says(&self) -> String {
        let jumps: Vec<_> = self.events.iter().map(ToString::to_string).collect();
        let jumps = if jumps.len() > 3 { format!("{} jumps", jumps.len()) } else { jumps.join(", ") };
        let unconverged =
            if self.unconverged > 0 { format!(", {} NOT CONVERGED", self.unconverged) } else { String::new() };
        format!("{:>4} steps  {jumps}{unconverged}", self.steps)
    }
}

fn cycle(
    surface: &Surface,
    law: impl AdhesionLaw<f64> + 'static,
    gaps: [f64; 2],
    settings: PathSettings,
) -> Outcome<Cycle> {
    let mut problem = Problem::new(surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, law)?;
    let mu_rho = problem.mu_rho();
    let [far, near] = gaps.map(Control::MeanGap);
    let mut solver = Solver::new(Settings::default().tolerance(1e-5));
    let mut cycle = Cycle {
        approach: Vec::new(),
        withdrawal: Vec::new(),
        events: Vec::new(),
        dissipated: 0.0,
        imbalance: 0.0,
        steps: 0,
        mu_rho,
        unconverged: 0,
    };
    let mut path = Path::new([far, near, far], settings)?;
    while let Some(step) = path.next(&mut solver, &mut problem)? {
        let report = &step.solution.report;
        let point = (report.mean_gap, report.mean_pressure);
        if step.leg < 2 { &mut cycle.approach } else { &mut cycle.withdrawal }.push(point);
        cycle.events.extend(step.event);
        cycle.unconverged += usize::from(report.status != Status::Converged);
        (cycle.dissipated, cycle.imbalance) = (step.dissipated, step.imbalance);
        cycle.steps += 1;
    }
    Ok(cycle)
}

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the sphere's and the rough surface's grid; the waves have up to 32 times as many
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// The folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("cycles.rs"));
    std::fs::create_dir_all(&out)?;
    spheres(size, &out.join("cycle-sphere.svg"))?;
    waves(size, &out.join("cycle-wave.svg"))?;
    rough(size, &out.join("cycle-rough.svg"))?;
    println!("\ndrawn in {}", out.display());
    Ok(())
}

/// Spheres under the law of Maugis and Dugdale.
fn spheres(size: usize, path: &File) -> Outcome<()> {
    let grid = Grid::square(size, 1.0)?;
    let surface = Surface::paraboloid(grid, RADIUS)?;
    println!("sphere, {size}²: pull-off force over πwR");
    println!("{:>5} {:>8} {:>6} {:>8} {:>8} {:>7}", "μ_T", "w", "μ_ρ", "found", "exact", "error");
    let settings = PathSettings::default().smallest_step(1e-3);
    let mut curves = Vec::new();
    for ((tabor, work), colour) in SPHERES.into_iter().zip(COLOURS) {
        let length = (work * work * RADIUS).cbrt();
        let range = length / tabor;
        let periodic = Periodic::new(exact::MaugisDugdale::new(RADIUS, 1.0, work, range)?, 1.0)?;
        let (unit, touch) = (PI * work * RADIUS, -surface.mean());
        let at = |gap: f64, pressure: f64| ((touch - gap) / length, pressure / unit);
        let loaded = periodic.at_load(0.5 * unit)?;
        let pulled = periodic.pull_off()?;
        let gaps = [touch + 1.6 * range + 1.5 * length, loaded.mean_gap(surface.mean())];
        let found = cycle(&surface, MaugisDugdale::new(work, range)?, gaps, settings)?;
        let (force, exact) = (found.pull_off() / unit, -pulled.mean_pressure() / unit);
        println!(
            "{tabor:>5} {work:>8.0e} {:>6.2} {force:>8.4} {exact:>8.4} {:>6.2} %  {}",
            found.mu_rho,
            100.0 * (force / exact - 1.0),
            found.says()
        );
        let largest = loaded.contact().contact_radius();
        let radii = (1..=400).map(|i| largest * f64::from(i) / 400.0);
        let states = radii.filter_map(|radius| periodic.at_contact_radius(radius).ok());
        let exact = states.map(|state| at(state.mean_gap(surface.mean()), state.mean_pressure())).collect();
        let scaled = |points: &Points| -> Points {
            points.iter().map(|&(gap, pressure)| at(gap, pressure)).filter(|point| point.0 > FARTHEST).collect()
        };
        curves.push((format!("μ_T = {tabor}"), colour, true, scaled(&found.withdrawal)));
        curves.push((String::new(), light(colour), true, scaled(&found.approach)));
        curves.push((String::new(), BLACK, false, exact));
    }
    let title = format!("Sphere, Maugis-Dugdale, {size}²: withdrawal dark, approach light, exact thin black");
    draw(path, &title, "approach / (w²R/E*²)^(1/3)", "force / πwR", SeriesLabelPosition::LowerLeft, &curves)
}

/// A wave on a line, under ranges of adhesion that become short.
fn waves(size: usize, path: &File) -> Outcome<()> {
    let work = 0.5 * (ALPHA * PI * AMPLITUDE).powi(2);
    let exact = AdhesiveWavyLine::new(AMPLITUDE, 1.0, 1.0, work)?;
    let closing = exact.closing_pressure();
    let pulled = exact.pull_off()?;
    println!("\nwave, α = {ALPHA}: pull-off stress over p*; Johnson {:.4}", -pulled.mean_pressure() / closing);
    println!("{:>6} {:>6} {:>6} {:>8} {:>12} {:>10}", "ρ/h₀", "n", "μ_ρ", "found", "dissipated", "missing");
    let mut curves = Vec::new();
    for ((share, n), colour) in WAVES.into_iter().filter(|(_, n)| *n <= 32 * size).zip(COLOURS) {
        let grid = Grid::line(n, 1.0)?;
        let surface = Surface::wave(grid, AMPLITUDE, 1)?;
        let law = Exponential::new(work, share * AMPLITUDE)?;
        let found = cycle(&surface, law, [0.034, 0.014], PathSettings::default())?;
        println!(
            "{share:>6} {n:>6} {:>6.2} {:>8.4} {:>10.4} w {:>8.0e} w  {}",
            found.mu_rho,
            found.pull_off() / closing,
            found.dissipated / work,
            found.imbalance.abs() / work,
            found.says()
        );
        let scaled = |points: &Points| points.iter().map(|&(gap, p)| (gap / AMPLITUDE, p / closing)).collect();
        curves.push((format!("ρ/h₀ = {share}, n = {n}"), colour, true, scaled(&found.withdrawal)));
        curves.push((String::new(), light(colour), true, scaled(&found.approach)));
    }
    let widths = (1..=400).map(|i| 0.25 * f64::from(i) / 400.0);
    let states: Result<Vec<_>, _> = widths.map(|width| exact.at_half_width(width)).collect();
    let states = states?.into_iter().map(|state| (state.mean_gap() / AMPLITUDE, state.mean_pressure() / closing));
    curves.push(("Johnson".to_owned(), BLACK, false, states.filter(|(gap, _)| *gap > 0.69).collect()));
    let title = format!("Adhesive wave, α = {ALPHA}: withdrawal dark, approach light");
    draw(path, &title, "mean gap / h₀", "mean pressure / p*", SeriesLabelPosition::LowerRight, &curves)
}

/// A rough surface.
fn rough(size: usize, path: &File) -> Outcome<()> {
    let grid = Grid::square(size, 1.0)?;
    let surface = SelfAffine::default().k_l(2.0).k_r(2.0).k_s(8.0).surface(grid)?;
    println!("\nrough surface, {size}², rms slope 0.1, k from 2 to 8; pressures in E*");
    println!("{:>8} {:>8} {:>6} {:>12} {:>12}", "w", "ρ", "μ_ρ", "pull-off", "dissipated");
    let mut curves = Vec::new();
    for ((work, range), colour) in [(2e-5, 1e-3), (5e-5, 1e-3), (1e-4, 1e-3)].into_iter().zip(COLOURS) {
        let gaps = [0.022, 0.005];
        // dozens of jumps: the default takes twice the iterations, for 1 % of the dissipated energy
        let settings = PathSettings::default().smallest_step(1e-3);
        let found = cycle(&surface, Exponential::new(work, range)?, gaps, settings)?;
        println!(
            "{work:>8.0e} {range:>8.0e} {:>6.2} {:>12.3e} {:>10.4} w  {}",
            found.mu_rho,
            found.pull_off(),
            found.dissipated / work,
            found.says()
        );
        curves.push((format!("w = {work:e} E*L, ρ = {range:e} L"), colour, true, found.withdrawal.clone()));
        curves.push((String::new(), light(colour), true, found.approach));
    }
    let title = format!("Rough surface, exponential law, {size}²: withdrawal dark, approach light");
    draw(path, &title, "mean gap / L", "mean pressure / E*", SeriesLabelPosition::LowerRight, &curves)
}

/// Draws curves, each with its name, its colour, whether it is wide, and its points.
fn draw(
    path: &File,
    title: &str,
    across: &str,
    upwards: &str,
    labels: SeriesLabelPosition,
    curves: &[(String, RGBColor, bool, Points)],
) -> Outcome<()> {
    let all = || curves.iter().flat_map(|(_, _, _, points)| points);
    let ends = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let (low, high) = all().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |m, v| (m.0.min(v), m.1.max(v)));
        (low - 0.04 * (high - low))..(high + 0.04 * (high - low))
    };
    let root = SVGBackend::new(path, (960, 660)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(title, ("sans-serif", 20))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(14)
        .margin_right(30)
        .x_label_area_size(50)
        .y_label_area_size(90)
        .build_cartesian_2d(ends(&|p| p.0), ends(&|p| p.1))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc(across)
        .y_desc(upwards)
        .label_style(("sans-serif", 15))
        .draw()?;
    for (name, colour, wide, points) in curves {
        let style = colour.stroke_width(if *wide { 3 } else { 1 });
        let series = chart.draw_series(LineSeries::new(points.iter().copied(), style))?;
        if !name.is_empty() {
            series.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], style));
        }
    }
    legend(&mut chart, labels)?;
    root.present()?;
    Ok(())
}
