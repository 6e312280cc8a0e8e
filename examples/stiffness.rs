//! The contact stiffness of rough surfaces over the mean pressure, beside the proportionality K = p̄/(γ h_rms).
//!
//! Pastewka, Prodanov, Lorenz, Müser, Robbins and Jackson, *Phys. Rev. E* 87, 062809 (2013): on self-affine surfaces the
//! stiffness is proportional to the pressure; at light loads the few asperities of a finite surface make it larger,
//! and towards full contact it grows without limit. Counts and figures are deterministic.
//!
//! `cargo run --release --example stiffness -- [--size N] [--out FILE.svg]`

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/legend.rs"]
mod legend;

use std::error::Error;
use std::path::PathBuf;

use arguments::size_and_out;
use asperity::stability::ContactStiffness;
use asperity::{Amplitude, Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Sweep, Westergaard};
use legend::legend;
use plotters::prelude::*;

type Outcome<T> = Result<T, Box<dyn Error>>;

const SEEDS: [u64; 3] = [1, 2, 3];
const HURST: [f64; 2] = [0.5, 0.8];
const SLOPE: f64 = 0.1;

/// A curve: its Hurst exponent and seed, and (p̄/E*h', K h_rms/E*h') with the share of contact at each load.
struct Curve {
    hurst: f64,
    points: Vec<(f64, f64, f64)>,
}

fn main() -> Outcome<()> {
    let (size, out) = size_and_out(256, "target/figures/stiffness.svg")?;
    if size < 64 {
        return Err(format!("--size {size}: it must be at least 64").into());
    }
    let grid = Grid::square(size, 1.0)?;
    let pressures: Vec<f64> = (0..14).map(|k| 1e-4 * 10_f64.powf(0.3 * f64::from(k))).collect();
    let mut curves = Vec::new();
    for (hurst, seed) in HURST.iter().flat_map(|&hurst| SEEDS.map(|seed| (hurst, seed))) {
        let k_s = size as f64 / 8.0;
        let amplitude = Amplitude::RmsSlope(SLOPE);
        let surface =
            SelfAffine { k_l: 1.0, k_r: 2.0, k_s, hurst, amplitude, seed, random_phase: true }.surface(grid)?;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
        let mut solver = Solver::default();
        let loads: Vec<_> = pressures.iter().map(|p| Control::MeanPressure(SLOPE * p)).collect();
        let mut sweep = Sweep::new(&mut solver, &mut problem, loads);
        let mut points = Vec::new();
        while let Some(step) = sweep.next() {
            let (_, solution) = step?;
            let stiffness = ContactStiffness::of(sweep.problem(), &solution)?.pressure_per_length;
            let report = &solution.report;
            if stiffness.is_finite() {
                let scaled = stiffness * surface.rms_height() / SLOPE;
                points.push((report.mean_pressure / SLOPE, scaled, report.contact_fraction));
            }
        }
        curves.push(Curve { hurst, points });
    }
    println!("K = p/(gamma h_rms), over seeds {SEEDS:?}; p in units of E* h'");
    println!("{:>9} {:>9} | {:>22} | {:>22}", "p", "contact", "gamma, H = 0.5", "gamma, H = 0.8");
    for (k, p) in pressures.iter().enumerate() {
        let gammas = |hurst: f64| -> String {
            let of = curves.iter().filter(|curve| curve.hurst == hurst).filter_map(|curve| curve.points.get(k));
            of.map(|(p, stiffness, _)| format!("{:>7.3}", p / stiffness)).collect()
        };
        let contact = curves[0].points.get(k).map_or(1.0, |point| point.2);
        println!("{p:>9.1e} {:>8.2}% | {:>22} | {:>22}", 100.0 * contact, gammas(HURST[0]), gammas(HURST[1]));
    }
    if let Some(folder) = out.parent() {
        std::fs::create_dir_all(folder)?;
    }
    draw(&out, size, &curves)?;
    println!("drawn in {}", out.display());
    Ok(())
}

fn draw(path: &PathBuf, size: usize, curves: &[Curve]) -> Outcome<()> {
    let root = SVGBackend::new(path, (900, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Contact stiffness of self-affine surfaces, {size} × {size} nodes, three seeds each");
    let root = root.titled(&title, ("sans-serif", 19))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(48)
        .y_label_area_size(90)
        .build_cartesian_2d((5e-5..1.0).log_scale(), (1e-4..50.0).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("p / (E* h')")
        .y_desc("K h_rms / (E* h')")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    for (hurst, colour) in HURST.into_iter().zip([BLUE.mix(0.7), BLACK.mix(0.7)]) {
        let of = curves.iter().filter(|curve| curve.hurst == hurst).flat_map(|curve| &curve.points);
        chart
            .draw_series(of.map(|&(p, stiffness, _)| Circle::new((p, stiffness), 3, colour.filled())))?
            .label(format!("H = {hurst}"))
            .legend(move |(x, y)| Circle::new((x + 12, y), 4, colour.filled()));
    }
    let line = RED.stroke_width(2);
    chart
        .draw_series(LineSeries::new([5e-5, 1.0].map(|p| (p, 2.0 * p)), line))?
        .label("K = 2 p / h_rms")
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], line));
    legend(&mut chart, SeriesLabelPosition::UpperLeft)?;
    root.present()?;
    Ok(())
}
