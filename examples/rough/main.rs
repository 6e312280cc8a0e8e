//! Figures 5 to 8 of Rey, Anciaux and Molinari (2017): a rough surface, pressed without and with adhesion.
//!
//! `cargo run --release -p asperity-examples --example rough`
//!
//! The surface is the paper's, H = 0.8 and k from 4 to 64 periods a side, but of rms slope 0.1: with the paper's 0.001
//! the load of Figures 6 and 7 presses it flat. The range of adhesion is one that the grid resolves; the paper's own is
//! shown too. Two loads are told apart: the external mean pressure p̄, which is the one that is given, and the mean
//! contact pressure ⟨λ⟩ = p̄ + ⟨φ'⟩, which exceeds it by the adhesive traction.

mod figure8;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use asperity::contact::ContactStatistics;
use asperity::{
    Amplitude, Control, Exponential, Grid, Problem, SelfAffine, Solution, Solver, Start, Status, Surface, Sweep,
    Westergaard,
};
use asperity_plot::{Colouring, DPI, Map};
use clap::Parser;
use common::{Outcome, arguments};
use ndarray::Array2;

use figure8::{Load, extrapolate, figure8, slope_without_adhesion, tangent};

const SLOPE: f64 = 0.1;
/// The load of Figures 6 and 7, in units of E*.
const LOAD: f64 = 0.003;
/// The range of adhesion in units of L, and the work of adhesion of Figures 6 and 7 in units of E*L.
const RANGE: f64 = 2e-4;
const WORK: f64 = 2e-6;
/// The value that the paper states for the range and for the work of adhesion.
const PAPER: f64 = 2e-5;
/// The works of adhesion of Figure 8.
const WORKS: [f64; 4] = [0.0, 5e-7, WORK, 8e-6];
/// Its loads p̄/(E* h'_rms), in the order of the sweep: unloading. Without adhesion there is no contact at the last.
const LOADS: [f64; 11] = [0.05, 0.04, 0.03, 0.02, 0.01, 0.007, 0.005, 0.003, 0.002, 0.001, 0.0];
/// The loads from which the tangents at the origin are found: those above zero and up to this.
const SMALL: f64 = 0.01;

/// One load, in numbers. Loads are in units of E* h'_rms, areas are shares of the nominal area.
#[derive(Clone, Copy, Debug)]
struct Point {
    external: f64,
    contact: f64,
    nodes: f64,
    corrected: f64,
}

/// Contact areas on one grid, for one work of adhesion.
struct Curve {
    work: f64,
    n: usize,
    points: Vec<Point>,
    /// the solution under the load of Figures 6 and 7
    shown: Option<Solution<f64>>,
}

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side, in the paper 1024; the surface is the same on every grid, so it must be above 2 k_s = 128
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = arguments::nodes::<129>)]
    size: usize,
    /// The folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("main.rs"));
    let surface = rough(size, SLOPE)?;
    std::fs::create_dir_all(&out)?;
    figure5(&out, &surface)?;
    println!(
        "loads and pressures in units of E*; areas in % of the nominal area; attraction: traction above 1 % of w/ρ"
    );
    println!(
        "{:>20} {:>5} {:>5} {:>9} {:>9} {:>8} {:>9} {:>8} {:>8} {:>5}  status",
        "case", "n", "μ_ρ", "p̄", "⟨λ⟩", "contact", "corrected", "attract.", "clusters", "appl."
    );
    let mut failures = 0;

    let mut curves = Vec::new();
    for work in WORKS {
        curves.push(sweep(&surface, work, &mut failures)?);
    }
    let coarser: Vec<usize> = [size / 4, size / 2].into_iter().filter(|n| rough(*n, SLOPE).is_ok()).collect();
    let mut grids = Vec::new();
    for &n in &coarser {
        grids.push(sweep(&rough(n, SLOPE)?, 0.0, &mut failures)?);
    }

    let law = Exponential::new(WORK, RANGE)?;
    let (bare, sticky) = (&curves[0], &curves[2]);
    let (bare, sticky) = bare.shown.as_ref().zip(sticky.shown.as_ref()).ok_or("no solution to be shown")?;
    let same_contact = at_contact_pressure(&surface, law, &curves[2], &mut failures)?;
    let none = Exponential::new(0.0, RANGE)?;
    maps(&out, "without", "No adhesion", bare, &none)?;
    maps(&out, "with", "Adhesion, same external pressure", sticky, &law)?;
    maps(&out, "with-same-contact-pressure", "Adhesion, same contact pressure", &same_contact, &law)?;

    papers_own(&out, &surface, &mut failures)?;

    println!(
        "\nslope κ of the tangent at the origin, area over load/(E* h'_rms), from loads p̄ up to {SMALL} E* h'_rms"
    );
    let limit = extrapolate(&curves[0], grids.last());
    for curve in grids.iter().chain(&curves) {
        let [external, contact] = [Load::External, Load::Contact].map(|load| {
            [|p: &Point| p.nodes, |p: &Point| p.corrected].map(|area| tangent(&curve.points, load, area, curve.work).1)
        });
        println!(
            "  {:<12} {:>4}²: over p̄ {:.2}, corrected for the edge {:.2}; over ⟨λ⟩ {:.2}, {:.2}",
            named(curve.work),
            curve.n,
            external[0],
            external[1],
            contact[0],
            contact[1]
        );
    }
    let [persson, bush] = [(8.0 / PI).sqrt(), (2.0 * PI).sqrt()];
    match &limit {
        Some([nodes, corrected]) => println!(
            "  w = 0, extrapolated to Δx = 0: from nodes {:.2}, from corrected areas {:.2}",
            slope_without_adhesion(nodes),
            slope_without_adhesion(corrected)
        ),
        None => println!("  no extrapolation to Δx = 0: half of {size} nodes do not resolve the surface"),
    }
    println!("  Persson {persson:.2}, Bush, Gibson and Thomas {bush:.2}");
    figure8(&out.join("figure8.svg"), size, &curves, limit.as_ref().map(|[nodes, _]| &nodes[..]))?;

    println!("\nfigures 5 to 8 are in {}", out.display());
    match failures {
        0 => println!("every solve has converged"),
        count => println!("{count} solves have NOT converged: see the table"),
    }
    Ok(())
}

/// The surface of the figures, of side 1, on n × n nodes.
fn rough(n: usize, slope: f64) -> Outcome<Surface> {
    let rough = SelfAffine::default().amplitude(Amplitude::RmsSlope(slope));
    Ok(rough.surface(Grid::square(n, 1.0)?)?)
}

fn named(work: f64) -> String {
    if work > 0.0 { format!("w = {work:e} E*L") } else { "w = 0".to_owned() }
}

/// Solves under all loads of Figure 8, from the largest to the least.
fn sweep(surface: &Surface, work: f64, failures: &mut usize) -> Outcome<Curve> {
    let (grid, law) = (*surface.grid(), Exponential::new(work, RANGE)?);
    let mut problem = Problem::new(surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
    let loads = LOADS.iter().filter(|load| work > 0.0 || **load > 0.0).map(|load| load * SLOPE);
    let (mut solver, mut points, mut shown) = (Solver::default(), Vec::new(), None);
    let name = named(work);
    let mut sweep = Sweep::default();
    for load in loads.map(Control::MeanPressure) {
        let solution = sweep.next(&mut solver, &mut problem, load)?;
        points.push(tell(&name, &solution, failures)?);
        if (solution.report.mean_pressure / LOAD - 1.0).abs() < 1e-9 {
            shown = Some(solution);
        }
    }
    Ok(Curve { work, n: grid.shape().0, points, shown })
}

/// Prints the row of a solve, and counts it if it has not converged.
fn tell(name: &str, solution: &Solution<f64>, failures: &mut usize) -> Outcome<Point> {
    let (report, found) = (&solution.report, ContactStatistics::of(solution)?);
    *failures += usize::from(report.status != Status::Converged);
    println!(
        "{name:>20} {:>5} {:>5.2} {:>9.6} {:>9.6} {:>8.4} {:>9.4} {:>8.4} {:>8} {:>5}  {}{}",
        solution.grid.shape().0,
        report.mu_rho,
        report.mean_pressure,
        report.mean_contact_pressure,
        100.0 * found.contact_fraction,
        100.0 * found.corrected_contact_fraction,
        100.0 * found.attractive_fraction,
        found.cluster_sizes.len(),
        report.operator_applications,
        report.status,
        if report.under_resolved { ", under-resolved" } else { "" }
    );
    Ok(Point {
        external: report.mean_pressure / SLOPE,
        contact: report.mean_contact_pressure / SLOPE,
        nodes: found.contact_fraction,
        corrected: found.corrected_contact_fraction,
    })
}

/// The solution with adhesion at which the mean contact pressure is the load, by the secant method over external
/// pressures.
fn at_contact_pressure(
    surface: &Surface,
    law: Exponential,
    curve: &Curve,
    failures: &mut usize,
) -> Outcome<Solution<f64>> {
    let goal = LOAD / SLOPE;
    let mut problem = Problem::new(surface, Westergaard::<f64>::new(*surface.grid(), 1.0)?, law)?;
    let above = curve.points.iter().position(|p| p.contact < goal).ok_or("the load is below those of Figure 8")?;
    let [mut before, mut last] = [above - 1, above].map(|i| (curve.points[i].external, curve.points[i].contact));
    let mut gap = curve.shown.as_ref().ok_or("no solution to start from")?.gap.clone();
    for _ in 0..8 {
        let load = last.0 + (goal - last.1) * (last.0 - before.0) / (last.1 - before.1);
        let control = Control::MeanPressure(load * SLOPE);
        let solution =
            Solver::default().solve_with(&mut problem, control, Start::From(&gap), |_| ControlFlow::Continue(()))?;
        (before, last) = (last, (load, solution.report.mean_contact_pressure / SLOPE));
        if (last.1 / goal - 1.0).abs() < 1e-5 {
            tell("same ⟨λ⟩", &solution, failures)?;
            return Ok(solution);
        }
        gap = solution.gap;
    }
    Err(format!("no external pressure found for a mean contact pressure of {LOAD} E*").into())
}

/// The case that the paper states: on the surface of the figures, where it depends on the start and on the grid, and on
/// the flatter one, which is pressed flat.
fn papers_own(out: &Path, surface: &Surface, failures: &mut usize) -> Outcome<()> {
    let size = surface.grid().shape().0;
    let law = Exponential::new(PAPER, PAPER)?;
    let flat = rough(size, 0.001)?;
    let mut problem = Problem::new(&flat, Westergaard::<f64>::new(*flat.grid(), 1.0)?, Exponential::new(0.0, PAPER)?)?;
    let solution = Solver::default().solve(&mut problem, Control::MeanPressure(LOAD))?;
    tell("rms slope 1e-3, w = 0", &solution, failures)?;
    let coarse = rough(size / 2, SLOPE).ok();
    for surface in coarse.iter().chain([surface]) {
        let (grid, shape) = (*surface.grid(), surface.grid().shape());
        let mut problem = Problem::new(surface, Westergaard::<f64>::new(grid, 1.0)?, law)?;
        let apart = Array2::from_elem(shape, 5.0 * surface.rms_height());
        for (name, start) in [("from full contact", None), ("from far apart", Some(&apart))] {
            let control = Control::MeanPressure(LOAD);
            let given = start.map_or(Start::Default, |gap| Start::From(gap));
            let solution = Solver::default().solve_with(&mut problem, control, given, |_| ControlFlow::Continue(()))?;
            tell(name, &solution, failures)?;
            if shape.0 == size && start.is_some() {
                maps(out, "papers-own", "Not resolved: the paper's adhesion", &solution, &law)?;
            }
        }
    }
    println!(
        "warning: with w = {PAPER:e} E*L and ρ = {PAPER:e} L, as in the paper, adhesion is under-resolved, μ_ρ = {:.1} exceeds 0.5: \
         the answer depends on the grid and on the start",
        (PAPER / size as f64).sqrt() / PAPER
    );
    Ok(())
}

fn figure5(out: &Path, surface: &Surface) -> Outcome<()> {
    let (grid, found) = (*surface.grid(), surface.statistics());
    let map = Map {
        title: "Figure 5: the rough surface",
        caption: &format!("rms slope {:.3}, rms height {:.3e} L", found.rms_slope, found.rms_height),
        length_unit: Some("L"),
        label: "height",
        unit: Some("L"),
        ..Map::new(surface.heights().view(), grid, Colouring::Sequential)
    };
    Ok(map.draw(DPI)?.write(out.join("figure5.png"))?)
}

/// Figures 6 and 7 of one solution.
fn maps(out: &Path, file: &str, title: &str, solution: &Solution<f64>, law: &Exponential) -> Outcome<()> {
    let (grid, report) = (solution.grid, &solution.report);
    let adhesion = if law.work_of_adhesion() == 0.0 {
        String::new()
    } else {
        format!("w = {:e} E*L, range {:e} L, ", law.work_of_adhesion(), law.range())
    };
    let loads =
        format!("external pressure {:.4} E*, contact {:.4} E*", report.mean_pressure, report.mean_contact_pressure);
    // without adhesion, the pressure outside of the contact is a remainder of the error
    let pressure = if law.work_of_adhesion() == 0.0 { &solution.contact_pressure } else { &solution.pressure };
    let map = Map {
        title: &format!("Figure 6: {title}"),
        caption: &loads,
        length_unit: Some("L"),
        label: "pressure",
        unit: Some("E*"),
        ..Map::new(pressure.view(), grid, Colouring::Diverging)
    };
    map.draw(DPI)?.write(out.join(format!("figure6-{file}.png")))?;

    let found = ContactStatistics::of(solution)?;
    let regions = solution.regions().mapv(f64::from);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let map = Map {
        title: &format!("Figure 7: {title}"),
        caption: &format!(
            "{adhesion}{} contact, {} attraction",
            percent(found.contact_fraction),
            percent(found.attractive_fraction)
        ),
        length_unit: Some("L"),
        ..Map::new(regions.view(), grid, Colouring::Contact)
    };
    Ok(map.draw(DPI)?.write(out.join(format!("figure7-{file}.png")))?)
}
