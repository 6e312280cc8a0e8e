//! Figures 1 to 4 of Rey, Anciaux and Molinari (2017): spheres without and with adhesion, against exact solutions.
//!
//! `cargo run --release -p asperity-examples --example figures`
//!
//! R = 2L, E* = 1, and the apex on a node. The exact solutions among periodic images are at the given mean gap, over
//! the discrete mean of the heights; the lone Hertzian sphere is at their load.
//!
//! With adhesion there are several discrete equilibria, and the start chooses among them. Each grid is solved from the
//! default start, shown in figures 2 and 3, and from the exact gap without smoothing the law's jump, to tell the start's
//! part of the error.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use asperity::exact::{Contact, Hertz, Jkr, MaugisDugdale as Maugis, Periodic, PeriodicContact, Sphere};
use asperity::{
    AdhesionLaw, Control, ElasticOperator, Grid, MaugisDugdale, NoAdhesion, Problem, Settings, Solution, Solver,
    Status, Surface, Westergaard,
};
use clap::Parser;
use common::legend::legend;
use common::sharp::Sharp;
use common::{Outcome, arguments};
use ndarray::{Array2, Zip};
use plotters::coord::Shift;
use plotters::prelude::*;

type Panel<'a> = DrawingArea<SVGBackend<'a>, Shift>;

const RADIUS: f64 = 2.0;
const MODULUS: f64 = 1.0;
const SMALLEST: usize = 64;

/// Of the lines of figure 4: without adhesion, and from each start with the first and with the second law.
const COLOURS: [RGBColor; 5] =
    [BLACK, RGBColor(140, 20, 10), RGBColor(245, 150, 90), RGBColor(10, 30, 130), RGBColor(110, 175, 240)];

/// Where a solve starts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Start {
    Default,
    Exact,
}

impl Start {
    fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Exact => "exact gap",
        }
    }
}

/// A solution and how far it is from the exact one.
struct Run {
    n: usize,
    start: Start,
    /// relative L² error of the displacement, means removed
    l2: f64,
    /// relative error in the energy norm
    energy: f64,
    solution: Solution<f64>,
    exact: PeriodicContact,
    surface: Surface,
}

#[derive(Parser)]
struct Arguments {
    /// The largest grid, in nodes along a side: a power of two from 128 on, in the paper 2048
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = arguments::power_of_two::<{ 2 * SMALLEST }>)]
    size: usize,
    /// The folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("figures.rs"));
    std::fs::create_dir_all(&out)?;
    println!("{:>16} {:>5} {:>10} {:>10} {:>10} {:>5} {:>11}", "case", "n", "start", "L2", "energy", "appl.", "p/E*");

    let hertz = Hertz::new(RADIUS, MODULUS)?;
    let bare = sweep("Hertz", hertz, NoAdhesion, 0.0398, size, &[Start::Default])?;
    let shown = bare.iter().rfind(|run| run.n <= 512).ok_or("no solution of the sphere without adhesion")?;
    let alone = hertz.at_load(shown.exact.contact().load())?;
    let title = format!("Figure 1: sphere without adhesion, R = 2 L, mean gap 0.0398 L, {0} × {0} nodes", shown.n);
    let other = ("Hertz, at the same load", profile_of(&alone));
    profiles(&out.join("figure1.svg"), &title, shown, "Hertz among images", other, 0.0)?;

    let starts = [Start::Default, Start::Exact];
    let mut sticky = Vec::new();
    for (figure, work, range, gap) in [(2, 1e-5, 3e-4, 0.0405), (3, 1e-4, 2e-3, 0.0429)] {
        let name = format!("MD, ρ = {range:e} L");
        let sphere = Maugis::new(RADIUS, MODULUS, work, range)?;
        let runs = sweep(&name, sphere, MaugisDugdale::new(work, range)?, gap, size, &starts)?;
        let shown = runs.iter().rfind(|run| run.start == Start::Default).ok_or("no solution with adhesion")?;
        let title = format!(
            "Figure {figure}: sphere, Maugis–Dugdale adhesion, R = 2 L, w = {work:e} E*L, ρ = {range:e} L, mean gap {gap} L, \
             {0} × {0} nodes",
            shown.n
        );
        let jkr = Periodic::new(Jkr::new(RADIUS, MODULUS, work)?, 1.0)?.at_mean_gap(gap, shown.surface.mean())?;
        let other = ("JKR among images", profile_among_images(&jkr)?);
        let floor = -1.8 * work / range;
        let path = out.join(format!("figure{figure}.svg"));
        profiles(&path, &title, shown, "Maugis–Dugdale among images", other, floor)?;
        sticky.push((name, runs));
    }

    let mut cases = vec![("Hertz".to_owned(), bare.iter().collect::<Vec<_>>())];
    for (name, runs) in &sticky {
        for start in starts {
            let chosen = runs.iter().filter(|run| run.start == start).collect();
            cases.push((format!("{name}, {}", start.name()), chosen));
        }
    }
    convergence(&out.join("figure4.svg"), &cases)?;
    println!("figures 1 to 4 are in {}", out.display());
    Ok(())
}

/// Solves one case on all grids, from each of the starts.
fn sweep<S: Sphere + Copy, L: AdhesionLaw<f64> + Copy + 'static>(
    name: &str,
    sphere: S,
    law: L,
    gap: f64,
    size: usize,
    starts: &[Start],
) -> Outcome<Vec<Run>> {
    let mut runs: Vec<Run> = Vec::new();
    let sizes = std::iter::successors(Some(SMALLEST), |n| Some(2 * n)).take_while(|&n| n <= size);
    for n in sizes {
        let grid = Grid::square(n, 1.0)?;
        let surface = Surface::paraboloid(grid, RADIUS)?;
        let exact = Periodic::new(sphere, 1.0)?.at_mean_gap(gap, surface.mean())?;
        let reference = exact.displacement_field(&grid)?;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, MODULUS)?, law)?;
        for &start in starts {
            let given = match start {
                Start::Default => None,
                Start::Exact => Some((&reference - surface.heights()).mapv(|g| g.max(0.0))),
            };
            if given.is_some() {
                problem.set_law(Sharp(law))?;
            }
            let given = given.as_ref().map_or(asperity::Start::Default, |gap| asperity::Start::From(gap));
            let mut solver = Solver::new(Settings::default().tolerance(1e-7));
            let solution =
                solver.solve_with(&mut problem, Control::MeanGap(gap), given, |_| ControlFlow::Continue(()))?;
            let report = &solution.report;
            if report.status != Status::Converged {
                return Err(format!("{name}, {n} × {n}, {} start: {}", start.name(), report.status).into());
            }
            let (l2, energy) = errors(&(&solution.gap + surface.heights()), &reference, &grid)?;
            println!(
                "{name:>16} {n:>5} {:>10} {l2:>10.3e} {energy:>10.3e} {:>5} {:>11.4e}",
                start.name(),
                report.operator_applications,
                report.mean_pressure
            );
            runs.push(Run { n, start, l2, energy, solution, exact, surface: surface.clone() });
        }
    }
    Ok(runs)
}

/// The relative errors of a displacement, in L² with the means removed and in the energy norm.
fn errors(found: &Array2<f64>, exact: &Array2<f64>, grid: &Grid) -> Outcome<(f64, f64)> {
    let mut half_space = Westergaard::<f64>::new(*grid, MODULUS)?;
    let mut norms = |field: &Array2<f64>| -> Outcome<(f64, f64)> {
        let mean = field.sum() / field.len() as f64;
        let field = field.mapv(|u| u - mean);
        let mut pressure = Array2::zeros(field.dim());
        half_space.pressure(field.view(), pressure.view_mut())?;
        let product = |other: &Array2<f64>| Zip::from(&field).and(other).fold(0.0, |sum, u, v| sum + u * v);
        Ok((product(&field).sqrt(), product(&pressure).max(0.0).sqrt()))
    };
    let ((l2, energy), (whole_l2, whole_energy)) = (norms(&(found - exact))?, norms(exact)?);
    Ok((l2 / whole_l2, energy / whole_energy))
}

/// Pressure and displacement along y = 0, x ≥ 0.
struct Profile {
    pressure: Vec<(f64, f64)>,
    displacement: Vec<(f64, f64)>,
}

/// The points of the exact profiles.
fn abscissae() -> Outcome<Grid> {
    Ok(Grid::line(1 << 13, 1.0)?)
}

fn half(grid: &Grid, value: impl Fn(usize) -> f64) -> Vec<(f64, f64)> {
    let n = grid.shape().0;
    // and the first node of the next period, which is the first of this one
    (n / 2..n).map(|i| (grid.x(i), value(i))).chain([(-grid.x(0), value(0))]).collect()
}

fn profile_among_images(state: &PeriodicContact) -> Outcome<Profile> {
    let line = abscissae()?;
    let (p, u) = (state.pressure_field(&line)?, state.displacement_field(&line)?);
    Ok(Profile { pressure: half(&line, |i| p[[i, 0]]), displacement: half(&line, |i| u[[i, 0]]) })
}

fn profile_of(contact: &Contact) -> Profile {
    let at = |value: &dyn Fn(f64) -> f64| (0..=4096).map(|i| f64::from(i) / 8192.0).map(|x| (x, value(x))).collect();
    Profile { pressure: at(&|x| contact.pressure(x)), displacement: at(&|x| contact.displacement(x)) }
}

fn profile_computed(run: &Run) -> Profile {
    let (grid, solution) = (run.surface.grid(), &run.solution);
    let (j, heights) = (run.n / 2, run.surface.heights());
    Profile {
        pressure: half(grid, |i| solution.pressure[[i, j]]),
        displacement: half(grid, |i| solution.gap[[i, j]] + heights[[i, j]]),
    }
}

/// Draws the two panels of figures 1 to 3; `floor` is the lowest pressure to show.
fn profiles(path: &Path, title: &str, run: &Run, name: &str, other: (&str, Profile), floor: f64) -> Outcome<()> {
    let (computed, exact) = (profile_computed(run), profile_among_images(&run.exact)?);
    let end = 1.5 * run.exact.contact().adhesion_radius();
    let far = if floor < 0.0 { 2.0 * end } else { 0.5 };
    let root = SVGBackend::new(path, (1000, 460)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(title, ("sans-serif", 18))?;
    let (left, right) = root.split_horizontally(500);
    let names = [name, other.0, "computed"];
    // where the curves leave room
    use SeriesLabelPosition::{LowerLeft, LowerRight, UpperRight};
    let corners = if floor < 0.0 { (LowerLeft, LowerRight) } else { (UpperRight, UpperRight) };
    let lowest = if floor < 0.0 { floor } else { -0.05 * computed.pressure[0].1 };
    let curves = [&exact.pressure, &other.1.pressure, &computed.pressure];
    panel(&left, "p / E*", end, lowest, names, curves, corners.0)?;
    let curves = [&exact.displacement, &other.1.displacement, &computed.displacement];
    panel(&right, "u / L", far, f64::NEG_INFINITY, names, curves, corners.1)?;
    root.present()?;
    Ok(())
}

/// Draws the exact profile, the other one and the computed one, between 0 and `end`, within limits of the ordinate.
fn panel(
    area: &Panel<'_>,
    ordinate: &str,
    end: f64,
    lowest: f64,
    names: [&str; 3],
    curves: [&Vec<(f64, f64)>; 3],
    labels: SeriesLabelPosition,
) -> Outcome<()> {
    // (JKR's pressure falls to −∞ at the edge, and is cut off at the end of the panel)
    let curves = curves.map(|c| c.iter().copied().filter(|p| p.0 <= end && p.1 >= lowest).collect::<Vec<_>>());
    let values = || curves.iter().flatten().map(|p| p.1);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.05 * (high - low);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(80)
        .build_cartesian_2d(0.0..end, low - margin..high + margin)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("x / L")
        .y_desc(ordinate)
        .x_labels(8)
        .y_labels(9)
        .x_label_formatter(&|x| format!("{x:.2}"))
        .y_label_formatter(&|y| format!("{:.4}", (1e4 * y).round() / 1e4 + 0.0))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    let [exact, other, computed] = curves;
    let (red, blue) = (RED.stroke_width(2), BLUE.stroke_width(2));
    chart
        .draw_series(LineSeries::new(exact, red))?
        .label(names[0])
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], red));
    // in two pieces where something was left out
    let step = other.windows(2).map(|w| w[1].0 - w[0].0).fold(f64::INFINITY, f64::min);
    let cut = other.windows(2).position(|w| w[1].0 - w[0].0 > 1.5 * step).map_or(other.len(), |i| i + 1);
    let (before, after) = other.split_at(cut);
    chart.draw_series(DashedLineSeries::new(after.to_vec(), 8, 5, blue))?;
    chart.draw_series(DashedLineSeries::new(before.to_vec(), 8, 5, blue))?.label(names[1]).legend(move |(x, y)| {
        EmptyElement::at((x, y)) + PathElement::new([(0, 0), (9, 0)], blue) + PathElement::new([(14, 0), (23, 0)], blue)
    });
    let stride = (computed.len() / 80).max(1);
    chart
        .draw_series(computed.into_iter().step_by(stride).map(|p| Circle::new(p, 3, BLACK)))?
        .label(names[2])
        .legend(|(x, y)| Circle::new((x + 12, y), 3, BLACK));
    legend(&mut chart, labels)?;
    Ok(())
}

/// Prints the fitted exponents and draws figure 4.
fn convergence(path: &Path, cases: &[(String, Vec<&Run>)]) -> Outcome<()> {
    let root = SVGBackend::new(path, (1240, 620)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled(
        "Figure 4: errors against the exact solutions among images at the same mean gap, and fitted rates",
        ("sans-serif", 18),
    )?;
    let (left, right) = root.split_horizontally(620);
    println!("{:>32} {:>8} {:>8}", "rates", "L2", "energy");
    let l2 = rates(&left, "relative L² error of u, means removed", cases, |run| run.l2)?;
    let energy = rates(&right, "relative error in the energy norm", cases, |run| run.energy)?;
    for ((name, _), (l2, energy)) in cases.iter().zip(l2.into_iter().zip(energy)) {
        println!("{name:>32} {l2:>8.2} {energy:>8.2}");
    }
    root.present()?;
    Ok(())
}

/// Draws one measure of the errors of all cases, and returns the fitted exponents.
fn rates(
    area: &Panel<'_>,
    ordinate: &str,
    cases: &[(String, Vec<&Run>)],
    error: impl Fn(&Run) -> f64,
) -> Outcome<Vec<f64>> {
    let points = |runs: &[&Run]| runs.iter().map(|run| ((run.n as f64).log2(), error(run))).collect::<Vec<_>>();
    let all: Vec<_> = cases.iter().flat_map(|(_, runs)| points(runs)).collect();
    let smallest = all.iter().fold(f64::INFINITY, |m, p| m.min(p.1));
    let largest = all.iter().fold(0.0f64, |m, p| m.max(p.1));
    let finest = all.iter().fold(0.0f64, |m, p| m.max(p.0));
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(80)
        .build_cartesian_2d(5.8..finest + 0.2, (0.02 * smallest..2.0 * largest).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("nodes along a side, n")
        .y_desc(ordinate)
        .x_labels(6)
        .x_label_formatter(&|x| if x.fract() == 0.0 { format!("{:.0}", x.exp2()) } else { String::new() })
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    let mut exponents = Vec::new();
    for (k, (name, runs)) in cases.iter().enumerate() {
        let points = points(runs);
        let (level, exponent) = fit(&points);
        exponents.push(-exponent);
        let colour = COLOURS[k % COLOURS.len()];
        let (first, last) = ((SMALLEST as f64).log2(), finest);
        let line = [first, last].map(|x| (x, (level + exponent * x).exp2()));
        chart.draw_series(LineSeries::new(line, colour.stroke_width(1)))?;
        // rings, so that points below them show
        let ring = name.ends_with(Start::Exact.name());
        let (radius, style) = if ring { (7, colour.stroke_width(2)) } else { (4, colour.filled()) };
        chart
            .draw_series(points.into_iter().map(|p| Circle::new(p, radius, style)))?
            .label(format!("{name}: n^−{:.2}", -exponent))
            .legend(move |(x, y)| Circle::new((x + 12, y), radius, style));
    }
    legend(&mut chart, SeriesLabelPosition::LowerLeft)?;
    Ok(exponents)
}

/// log₂ y = level + exponent·x, by least squares.
fn fit(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let (mean_x, mean_y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1.log2() / count));
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| {
        let dx = p.0 - mean_x;
        (xx + dx * dx, xy + dx * (p.1.log2() - mean_y))
    });
    let exponent = xy / xx;
    (mean_y - exponent * mean_x, exponent)
}
