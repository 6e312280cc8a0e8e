//! The power spectral density of generated surfaces, of one and averaged over many, on their target.
//!
//! `cargo run --release -p asperity-examples --example psd`

use std::f64::consts::TAU;
use std::path::PathBuf;

use asperity::surface::Psd;
use asperity::{Grid, SelfAffine};
use clap::Parser;
use common::chart::{COLOURS, Chart, Series, Style};
use common::{Outcome, arguments};
use plotters::prelude::{BLACK, SeriesLabelPosition};

const SURFACES: u64 = 32;

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = arguments::nodes::<64>)]
    size: usize,
    /// The figure
    #[arg(long, value_name = "FILE.svg", default_value = "target/figures/psd.svg")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("psd.rs"));
    let grid = Grid::square(size, 1.0)?;
    let rough = SelfAffine::default().k_l(2.0).k_r(8.0).k_s(0.4 * size as f64);
    let target = rough.spectrum(grid)?.radial_psd();
    let one = rough.surface(grid)?.spectrum().radial_psd();
    let mut mean = one.clone();
    mean.densities.fill(0.0);
    for seed in 0..SURFACES {
        let psd = rough.seed(seed).surface(grid)?.spectrum().radial_psd();
        mean.densities.iter_mut().zip(psd.densities).for_each(|(mean, density)| *mean += density / SURFACES as f64);
    }
    println!("{:>6} {:>12} {:>12} {:>12}", "k", "target", "one surface", "mean");
    for i in (0..target.densities.len()).filter(|i| target.densities[*i] > 0.0 && (i + 1).is_power_of_two()) {
        let k = target.wave_numbers[i] / TAU;
        println!("{k:>6.1} {:>12.4e} {:>12.4e} {:>12.4e}", target.densities[i], one.densities[i], mean.densities[i]);
    }
    println!("variance of the heights: target {:.6e}, one surface {:.6e}", target.total(), one.total());
    chart(size, &target, &one, &mean).save(&out)?;
    println!("drawn in {}", out.display());
    Ok(())
}

/// The densities over k = qL/2π, both logarithmic.
fn chart(size: usize, target: &Psd, one: &Psd, mean: &Psd) -> Chart {
    let points = |psd: &Psd| -> Vec<(f64, f64)> {
        let points = psd.wave_numbers.iter().map(|q| q / TAU).zip(psd.densities.iter().copied());
        points.zip(&target.densities).filter(|(_, target)| **target > 0.0).map(|(point, _)| point).collect()
    };
    let series = |name: &str, colour, style, points| Series { name: name.to_owned(), colour, style, points };
    let of_mean = points(mean).into_iter().step_by(2).collect();
    Chart {
        title: format!("Radially averaged PSD of self-affine surfaces: H = 0.8, rms slope 0.1, {size} × {size} nodes"),
        axes: ["k = |q| L / 2π", "Φ / L⁴"],
        logarithmic: true,
        labels: SeriesLabelPosition::LowerLeft,
        series: vec![
            series("one surface", COLOURS[0], Style::Specks, points(one)),
            series(&format!("mean of {SURFACES} surfaces"), COLOURS[1], Style::Rings, of_mean),
            series("target: plateau from 2 to 8, then k^−3.6", BLACK, Style::Thin, points(target)),
        ],
    }
}
