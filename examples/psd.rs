//! The power spectral density of generated surfaces, of one and averaged over many, on their target.
//!
//! `cargo run --release --example psd -- [--size N] [--out FILE.svg]`

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/legend.rs"]
mod legend;

use std::error::Error;
use std::f64::consts::TAU;
use std::path::PathBuf;

use arguments::size_and_out;
use asperity::{Grid, Psd, SelfAffine};
use legend::legend;
use plotters::prelude::*;

type Outcome<T> = Result<T, Box<dyn Error>>;

const SURFACES: u64 = 32;

fn main() -> Outcome<()> {
    let (size, out) = arguments()?;
    let grid = Grid::square(size, 1.0)?;
    let rough = SelfAffine { k_l: 2.0, k_r: 8.0, k_s: 0.4 * size as f64, ..SelfAffine::default() };
    let target = rough.spectrum(grid)?.radial_psd();
    let one = rough.surface(grid)?.spectrum().radial_psd();
    let mut mean = one.clone();
    mean.densities.fill(0.0);
    for seed in 0..SURFACES {
        let psd = SelfAffine { seed, ..rough }.surface(grid)?.spectrum().radial_psd();
        mean.densities.iter_mut().zip(psd.densities).for_each(|(mean, density)| *mean += density / SURFACES as f64);
    }
    println!("{:>6} {:>12} {:>12} {:>12}", "k", "target", "one surface", "mean");
    for i in (0..target.densities.len()).filter(|i| target.densities[*i] > 0.0 && (i + 1).is_power_of_two()) {
        let k = target.wave_numbers[i] / TAU;
        println!("{k:>6.1} {:>12.4e} {:>12.4e} {:>12.4e}", target.densities[i], one.densities[i], mean.densities[i]);
    }
    println!("variance of the heights: target {:.6e}, one surface {:.6e}", target.total(), one.total());
    if let Some(folder) = out.parent() {
        std::fs::create_dir_all(folder)?;
    }
    draw(&out, size, &target, &one, &mean)?;
    println!("drawn in {}", out.display());
    Ok(())
}

fn arguments() -> Outcome<(usize, PathBuf)> {
    let (size, out) = size_and_out(512, "target/figures/psd.svg")?;
    if size < 64 {
        return Err(format!("--size {size}: it must be at least 64").into());
    }
    Ok((size, out))
}

/// Draws the densities over k = qL/2π, both logarithmic.
fn draw(path: &PathBuf, size: usize, target: &Psd, one: &Psd, mean: &Psd) -> Outcome<()> {
    let points = |psd: &Psd| -> Vec<(f64, f64)> {
        let points = psd.wave_numbers.iter().map(|q| q / TAU).zip(psd.densities.iter().copied());
        points.zip(&target.densities).filter(|(_, target)| **target > 0.0).map(|(point, _)| point).collect()
    };
    let ends =
        |psd: &Psd| points(psd).iter().fold((f64::INFINITY, 0.0), |m: (f64, f64), p| (m.0.min(p.1), m.1.max(p.1)));
    let (low, high) = [target, one, mean]
        .map(ends)
        .into_iter()
        .fold((f64::INFINITY, 0.0), |m: (f64, f64), e| (m.0.min(e.0), m.1.max(e.1)));
    let root = SVGBackend::new(path, (900, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Radially averaged PSD of self-affine surfaces: H = 0.8, rms slope 0.1, {size} × {size} nodes");
    let root = root.titled(&title, ("sans-serif", 19))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(48)
        .y_label_area_size(90)
        .build_cartesian_2d((1.0..size as f64 / 2.0).log_scale(), (0.3 * low..3.0 * high).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("k = |q| L / 2π")
        .y_desc("Φ / L⁴")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    let (blue, red) = (BLUE.mix(0.7), RED.stroke_width(2));
    chart
        .draw_series(points(one).into_iter().map(|p| Circle::new(p, 2, blue.filled())))?
        .label("one surface")
        .legend(move |(x, y)| Circle::new((x + 12, y), 3, blue.filled()));
    chart
        .draw_series(points(mean).into_iter().step_by(2).map(|p| Circle::new(p, 4, BLACK)))?
        .label(format!("mean of {SURFACES} surfaces"))
        .legend(|(x, y)| Circle::new((x + 12, y), 4, BLACK));
    chart
        .draw_series(LineSeries::new(points(target), red))?
        .label("target: plateau from 2 to 8, then k^−3.6")
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], red));
    legend(&mut chart, SeriesLabelPosition::LowerLeft)?;
    root.present()?;
    Ok(())
}
