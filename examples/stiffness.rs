//! The contact stiffness of rough surfaces over the mean pressure, next to the proportionality K = p̄/(γ h_rms).
//!
//! Pastewka, Prodanov, Lorenz, Müser, Robbins and Jackson, *Phys. Rev. E* 87, 062809 (2013): on self-affine surfaces
//! the stiffness is proportional to the pressure; at light loads the few asperities of a finite surface make it larger,
//! and towards full contact it grows without limit. Counts and figures are deterministic.
//!
//! `cargo run --release -p asperity-examples --example stiffness`

use std::path::PathBuf;

use asperity::stability::ContactStiffness;
use asperity::{Amplitude, Control, Grid, NoAdhesion, Problem, SelfAffine, Solver, Sweep, Westergaard};
use clap::Parser;
use common::chart::{COLOURS, Chart, Series, Style};
use common::{Outcome, arguments};
use plotters::prelude::{BLACK, SeriesLabelPosition};

const SEEDS: [u64; 3] = [1, 2, 3];
const HURST: [f64; 2] = [0.5, 0.8];
const SLOPE: f64 = 0.1;

/// A curve: its Hurst exponent and seed, and (p̄/E*h', K h_rms/E*h') with the share of contact at each load.
struct Curve {
    hurst: f64,
    points: Vec<(f64, f64, f64)>,
}

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = arguments::nodes::<64>)]
    size: usize,
    /// The figure
    #[arg(long, value_name = "FILE.svg", default_value = "target/figures/stiffness.svg")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("stiffness.rs"));
    let grid = Grid::square(size, 1.0)?;
    let pressures: Vec<f64> = (0..14).map(|k| 1e-4 * 10_f64.powf(0.3 * f64::from(k))).collect();
    let mut curves = Vec::new();
    for (hurst, seed) in HURST.iter().flat_map(|&hurst| SEEDS.map(|seed| (hurst, seed))) {
        let k_s = size as f64 / 8.0;
        let amplitude = Amplitude::RmsSlope(SLOPE);
        let surface = SelfAffine::default()
            .k_l(1.0)
            .k_r(2.0)
            .k_s(k_s)
            .hurst(hurst)
            .amplitude(amplitude)
            .seed(seed)
            .random_phase(true)
            .surface(grid)?;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0)?, NoAdhesion)?;
        let (mut solver, mut sweep, mut points) = (Solver::default(), Sweep::default(), Vec::new());
        for load in pressures.iter().map(|p| Control::MeanPressure(SLOPE * p)) {
            let solution = sweep.next(&mut solver, &mut problem, load)?;
            let stiffness = ContactStiffness::of(&mut problem, &solution)?.pressure_per_length;
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
    chart(size, &curves).save(&out)?;
    println!("drawn in {}", out.display());
    Ok(())
}

fn chart(size: usize, curves: &[Curve]) -> Chart {
    let points = |hurst: f64| {
        let curves = curves.iter().filter(|curve| curve.hurst == hurst);
        curves.flat_map(|curve| &curve.points).map(|&(p, stiffness, _)| (p, stiffness)).collect()
    };
    let found = HURST.into_iter().zip(COLOURS).map(|(hurst, colour)| Series {
        name: format!("H = {hurst}"),
        colour,
        style: Style::Dots,
        points: points(hurst),
    });
    let line = [5e-5, 1.0].map(|p| (p, 2.0 * p)).to_vec();
    let line = Series { name: "K = 2 p / h_rms".to_owned(), colour: BLACK, style: Style::Thin, points: line };
    Chart {
        title: format!("Contact stiffness of self-affine surfaces, {size} × {size} nodes, three seeds each"),
        axes: ["p / (E* h')", "K h_rms / (E* h')"],
        logarithmic: true,
        labels: SeriesLabelPosition::UpperLeft,
        series: found.chain([line]).collect(),
    }
}
