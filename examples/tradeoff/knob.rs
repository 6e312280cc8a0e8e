//! The knob: the error that is asked for, the estimated and the true one, and the work, over many rough scenes.

use std::path::Path;

use asperity::accuracy::{Accuracy, GridError, Quantity};
use asperity::contact::ContactArea;
use asperity::nested::Level;
use asperity::stability::ContactStiffness;
use asperity::{
    AdhesionLaw, Amplitude, Boundary, Control, Exponential, Grid, Nested, NoAdhesion, Problem, SelfAffine, Settings,
    Solver, Surface, Westergaard,
};
use plotters::prelude::*;

use common::Outcome;

/// The shortest wave, per side; the nodes of the given map, and of the truth, along a side.
const SHORTEST: f64 = 8.0;
const GIVEN: usize = 32;
const LEVELS: [usize; 5] = [32, 64, 128, 256, 512];
const SLOPE: f64 = 0.1;
/// Work of adhesion and range: resolved on the given map.
const LAW: (f64, f64) = (4e-5, 3e-3);
const TARGETS: [f64; 5] = [0.05, 0.03, 0.02, 0.01, 0.005];
/// The choices by hand: nodes along a side, each with these tolerances.
const TOLERANCES: [f64; 2] = [1e-3, 1e-4];

/// A rough surface with its load and law.
struct Scene {
    seed: u64,
    hurst: f64,
    adhesive: bool,
    control: Control,
}

/// The quantities of a solution.
#[derive(Clone, Copy)]
struct Found {
    area: f64,
    gap: f64,
    pressure: f64,
    stiffness: f64,
}

impl Found {
    fn of(self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Gap => self.gap,
            Quantity::Pressure => self.pressure,
            Quantity::Stiffness => self.stiffness,
            _ => self.area,
        }
    }
}

fn half_space(grid: Grid) -> asperity::Result<Westergaard<f64>> {
    Westergaard::new(grid, 1.0)
}

impl Scene {
    fn surface(&self, n: usize) -> Outcome<Surface> {
        let &Self { seed, hurst, .. } = self;
        let (amplitude, random_phase) = (Amplitude::RmsSlope(SLOPE), seed.is_multiple_of(2));
        let spectrum = SelfAffine::default()
            .k_l(1.0)
            .k_r(2.0)
            .k_s(SHORTEST)
            .hurst(hurst)
            .amplitude(amplitude)
            .seed(seed)
            .random_phase(random_phase);
        Ok(spectrum.surface(Grid::square(n, 1.0)?)?)
    }

    fn law(&self) -> Outcome<Box<dyn AdhesionLaw<f64>>> {
        Ok(if self.adhesive { Box::new(Exponential::new(LAW.0, LAW.1)?) } else { Box::new(NoAdhesion) })
    }

    /// The corrected area as the tool finds it without an accuracy, with coarser grids where they pay, and the work.
    fn by_hand(&self, n: usize, tolerance: f64) -> Outcome<(f64, f64)> {
        let (surface, law) = (self.surface(n)?, self.law()?);
        let (mut solver, mut nested) = (Solver::new(Settings::default().tolerance(tolerance)), Nested::default());
        if !nested.pays::<f64>(&solver.settings, &surface, &law, self.control) {
            nested.coarsest = n;
        }
        let found = nested.solve(&mut solver, &surface, half_space, law, self.control)?;
        let area = ContactArea::of_solution(&found.solution)?;
        Ok((area.corrected_contact_fraction, work(&found.levels)))
    }

    /// The solution on a grid; its contact stiffness if it is wanted.
    fn solve(&self, n: usize, tolerance: f64, stiffness: bool) -> Outcome<Found> {
        let surface = self.surface(n)?;
        let settings = Settings::default().tolerance(tolerance);
        let mut problem = Problem::new(&surface, half_space(*surface.grid())?, self.law()?)?;
        let solution = Solver::new(settings).solve(&mut problem, self.control)?;
        let stiffness =
            if stiffness { ContactStiffness::of(&mut problem, &solution)?.pressure_per_length } else { 0.0 };
        let area = ContactArea::of_solution(&solution)?;
        let (gap, pressure) = (solution.report.mean_gap, solution.report.mean_pressure);
        Ok(Found { area: area.corrected_contact_fraction, gap, pressure, stiffness })
    }
}

/// All scenes: seeds, Hurst exponents, laws and loads; a mean gap is that under a pressure. The factors of the
/// estimates were fitted to other seeds and exponents, those of the area to these as well.
fn scenes(quick: bool) -> Outcome<Vec<Scene>> {
    let (seeds, hursts): (&[u64], &[f64]) = if quick { (&[11], &[0.8]) } else { (&[11, 12, 13, 14], &[0.3, 0.6, 0.9]) };
    let loads = [
        (false, true, &[0.003, 0.02, 0.08, 0.3][..]),
        (false, false, &[0.02, 0.08]),
        (true, true, &[0.0, 0.02]),
        (true, false, &[0.02, 0.1]),
    ];
    let mut all = Vec::new();
    for (&seed, &hurst) in seeds.iter().flat_map(|seed| hursts.iter().map(move |hurst| (seed, hurst))) {
        for (adhesive, pressed, pressures) in loads {
            for pressure in pressures {
                let control = Control::MeanPressure(SLOPE * pressure);
                let mut scene = Scene { seed, hurst, adhesive, control };
                if !pressed {
                    scene.control = Control::MeanGap(scene.solve(4 * GIVEN, 1e-6, false)?.gap);
                }
                all.push(scene);
            }
        }
    }
    Ok(all)
}

/// The operator applications times the nodes that they are on, in millions.
fn work(levels: &[Level]) -> f64 {
    let of = |level: &Level| level.operator_applications as f64 * (level.shape.0 * level.shape.1) as f64;
    1e-6 * levels.iter().map(of).sum::<f64>()
}

/// A share in percent.
fn share<T>(of: &[T], is: impl Fn(&T) -> bool) -> f64 {
    100.0 * of.iter().filter(|item| is(item)).count() as f64 / of.len().max(1) as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Measures estimates and the knob, and draws the picture.
pub fn measure(quick: bool, out: &Path) -> Outcome<()> {
    let scenes = scenes(quick)?;
    let finest = if quick { 256 } else { 1024 };
    println!(
        "\n== knob: {} rough scenes, the shortest wave 1/{SHORTEST} of a side, truth from {finest}²",
        scenes.len()
    );
    let mut truths = Vec::new();
    for scene in &scenes {
        let [coarse, fine] = [finest / 2, finest];
        let (coarse, fine) = (scene.solve(coarse, 1e-6, true)?, scene.solve(fine, 1e-6, true)?);
        // the error of the area is of second order; all others are of either sign from grid to grid
        let area = fine.area + (fine.area - coarse.area) / 3.0;
        truths.push(Found { area, ..fine });
    }
    estimates(&scenes, &truths, quick)?;
    coarse(&scenes, quick)?;
    knob(&scenes, &truths, quick, out)
}

/// How good the estimates are: the finest of some grids against the truth.
fn estimates(scenes: &[Scene], truths: &[Found], quick: bool) -> Outcome<()> {
    println!("\nEstimated over true error of the grid; rough ones in brackets");
    println!(
        "{:>10} {:>6} {:>7} {:>7} | {:>12} {:>12} {:>12} {:>8}",
        "quantity", "nodes", "scenes", "rough", "in factor 3", "below third", "above three", "median"
    );
    for quantity in [Quantity::Area, Quantity::Stiffness, Quantity::Gap, Quantity::Pressure] {
        let mut all = Vec::new();
        for n in [64, 128, 256].into_iter().take(if quick { 1 } else { 3 }) {
            let mut ratios = Vec::new();
            for (scene, truth) in scenes.iter().zip(truths) {
                if quantity.check(scene.control).is_err() {
                    continue;
                }
                let surface = scene.surface(n)?;
                // as the tool does: the solver leaves next to nothing on the finest grid
                let stiffness = (quantity != Quantity::Area).then_some(ContactStiffness::TOLERANCE);
                let nested = Nested::default().coarse_tolerance(1e-3).coarsest(GIVEN).stiffness(stiffness);
                let mut solver = Solver::default();
                let found = nested.solve(&mut solver, &surface, half_space, scene.law()?, scene.control)?;
                let waves = surface.nodes_per_wave(Boundary::Periodic);
                let mu_rho = found.solution.report.mu_rho;
                let (Some(error), Some(level)) =
                    (GridError::of(&found.levels, quantity, waves, mu_rho), found.levels.last())
                else {
                    continue;
                };
                let value = match quantity {
                    Quantity::Gap => level.mean_gap,
                    Quantity::Pressure => level.mean_pressure,
                    Quantity::Stiffness => level.stiffness.map_or(f64::NAN, |found| found.pressure_per_length),
                    _ => level.area.corrected_contact_fraction,
                };
                let truth = truth.of(quantity);
                ratios.push((error.relative / (value / truth - 1.0).abs(), error.rough));
            }
            row(quantity, &format!("{n}²"), &ratios);
            all.extend(ratios);
        }
        row(quantity, "all", &all);
    }
    Ok(())
}

/// What tighter coarse grids cost: the applications on all nested grids, in units of one on the finest.
fn coarse(scenes: &[Scene], quick: bool) -> Outcome<()> {
    let n = if quick { 64 } else { 256 };
    println!(
        "\nApplications of nested grids at {n}², the mean, by the tolerances of the finest and of the coarser ones"
    );
    for fine in [1e-3, 1e-6] {
        for coarse_tolerance in [1e-2, 1e-3, 1e-4] {
            let mut sum = 0.0;
            for scene in scenes {
                let mut solver = Solver::new(Settings::default().tolerance(fine));
                let nested = Nested::default().coarse_tolerance(coarse_tolerance).coarsest(GIVEN);
                let surface = scene.surface(n)?;
                let found = nested.solve(&mut solver, &surface, half_space, scene.law()?, scene.control)?;
                sum += found.equivalent_applications();
            }
            println!("  {fine:.0e}, {coarse_tolerance:.0e}: {:.1}", sum / scenes.len() as f64);
        }
    }
    Ok(())
}

fn row(quantity: Quantity, nodes: &str, ratios: &[(f64, bool)]) {
    let sure: Vec<_> = ratios.iter().filter(|(_, rough)| !rough).copied().collect();
    println!(
        "{:>10} {nodes:>6} {:>7} {:>6.0}% | {:>11.0}% {:>6.1}% ({:.1}%) {:>11.0}% {:>8.2}",
        quantity.name(),
        ratios.len(),
        share(ratios, |(_, rough)| *rough),
        share(ratios, |(ratio, _)| (1.0 / 3.0..=3.0).contains(ratio)),
        share(&sure, |(ratio, _)| *ratio < 1.0 / 3.0),
        share(ratios, |(ratio, _)| *ratio < 1.0 / 3.0),
        share(ratios, |(ratio, _)| *ratio > 3.0),
        median(ratios.iter().map(|(ratio, _)| *ratio).collect()),
    );
}

/// What becomes of an accuracy of the area that is asked for, beside what the same grids cost by hand.
fn knob(scenes: &[Scene], truths: &[Found], quick: bool, out: &Path) -> Outcome<()> {
    // by hand: one grid and tolerance for all scenes
    let mut by_hand = Vec::new();
    for n in LEVELS.into_iter().take(if quick { 3 } else { 5 }) {
        for tolerance in TOLERANCES {
            let mut found = Vec::new();
            for (scene, truth) in scenes.iter().zip(truths) {
                let (area, work) = scene.by_hand(n, tolerance)?;
                found.push((work, (area / truth.area - 1.0).abs()));
            }
            by_hand.push((n, tolerance, found));
        }
    }
    println!("\nAn accuracy of the area that is asked for, on maps of {GIVEN}² nodes, and the best choice by hand");
    println!(
        "that is one for all scenes and right in nine of ten; work is operator applications times nodes, in millions"
    );
    println!(
        "\n| asked for | reached | right | true error: median | nine in ten | work | grid by hand | tolerance | right by hand \
         | work by hand | work over by hand |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut points = Vec::new();
    for target in TARGETS.into_iter().take(if quick { 1 } else { TARGETS.len() }) {
        let (mut errors, mut taken, mut reached) = (Vec::new(), Vec::new(), 0);
        for (scene, truth) in scenes.iter().zip(truths) {
            let surface = scene.surface(GIVEN)?;
            let wanted = Accuracy::new(target, Quantity::Area).memory(2e8);
            let found = wanted.solve(&mut Solver::default(), &surface, half_space, scene.law()?, scene.control)?;
            let Some(level) = found.levels.last().filter(|_| found.reached) else { continue };
            reached += 1;
            let error = (level.area.corrected_contact_fraction / truth.area - 1.0).abs();
            errors.push(error);
            taken.push(work(&found.levels));
            points.push((target, error.max(1e-6)));
        }
        let hits = share(&errors, |error| *error <= target);
        let mean = |taken: &[f64]| taken.iter().sum::<f64>() / taken.len().max(1) as f64;
        let of = |found: &[(f64, f64)]| share(found, |(_, error)| *error <= target);
        let cost = |found: &[(f64, f64)]| found.iter().map(|(work, _)| work).sum::<f64>() / found.len() as f64;
        let good = by_hand.iter().filter(|(_, _, found)| of(found) >= 90.0);
        let best = good.min_by(|a, b| cost(&a.2).total_cmp(&cost(&b.2)));
        let mut sorted = errors.clone();
        sorted.sort_by(f64::total_cmp);
        let at_90 = sorted.get(sorted.len() * 9 / 10).copied().unwrap_or(f64::NAN);
        let knob = mean(&taken);
        let hand = best.map_or("a finer grid | | | |".to_owned(), |(n, tolerance, found)| {
            let hand = cost(found);
            format!("{n}² | {tolerance:.0e} | {:.0} % | {hand:.1} | {:.1}", of(found), knob / hand)
        });
        println!(
            "| {} % | {} % | {hits:.0} % | {:.2} % | {:.2} % | {knob:.1} | {hand} |",
            100.0 * target,
            100 * reached / scenes.len(),
            100.0 * median(errors),
            100.0 * at_90,
        );
    }
    let path = out.join("tradeoff-knob.svg");
    draw(&path, &points)?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}

/// Draws the true error over the one that was asked for.
fn draw(path: &Path, points: &[(f64, f64)]) -> Outcome<()> {
    let root = SVGBackend::new(path, (760, 560)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled("Contact area: true error over the one asked for", ("sans-serif", 19))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(48)
        .y_label_area_size(80)
        .build_cartesian_2d((0.003..0.08).log_scale(), (1e-5..0.2).log_scale())?;
    let percent = |x: &f64| format!("{} %", (1e5 * x).round() / 1e3);
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("error asked for")
        .y_desc("true error")
        .x_label_formatter(&percent)
        .y_label_formatter(&percent)
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    // one beside the other, in the order of the scenes
    let mut seen = 0;
    let mut last = 0.0;
    let spread = points.iter().map(|&(target, error)| {
        seen = if target == last { seen + 1 } else { 0 };
        last = target;
        (target * (1.0 + 0.002 * (f64::from(seen % 60) - 30.0)), error)
    });
    chart.draw_series(spread.map(|point| Circle::new(point, 2, BLUE.mix(0.6).filled())))?;
    chart.draw_series(LineSeries::new([(0.003, 0.003), (0.08, 0.08)], RED.stroke_width(2)))?;
    root.present()?;
    Ok(())
}
