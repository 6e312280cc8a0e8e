//! Time against the number of nodes, from the medians that the benches leave in `target/criterion`.
//!
//! ```text
//! RAYON_NUM_THREADS=1 ASPERITY_BENCH=all cargo bench
//! cargo run --release -p asperity-examples --example scaling
//! ```
//!
//! One operator application, and solves of a rough surface at 3 % contact and given mean pressure, to a certified error
//! of 1e-6 in `f64` and 1e-4 in `f32`, by the default, nested grids, and Algorithm 3. The legend has the exponent of
//! the number of nodes, by least squares; it includes the misses of the caches. Grids that were not measured are left
//! out.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use common::legend::legend;
use common::{Outcome, arguments};
use plotters::prelude::*;
use serde_json::Value;

/// The lines of the figure: the folder in criterion's data, the name in the legend, and the colour.
const LINES: [(&str, &str, RGBColor); 7] = [
    ("solve rey2017 f64", "Algorithm 3, f64", RGBColor(200, 30, 20)),
    ("solve default f64", "default, f64", RGBColor(10, 40, 140)),
    ("solve nested f64", "nested grids, f64", RGBColor(0, 130, 80)),
    ("solve default f32", "default, f32", RGBColor(110, 160, 240)),
    ("solve nested f32", "nested grids, f32", RGBColor(110, 200, 140)),
    ("application f64", "one application, f64", BLACK),
    ("application f32", "one application, f32", RGBColor(150, 150, 150)),
];

#[derive(Parser)]
struct Arguments {
    /// The figure
    #[arg(value_name = "FILE.svg", default_value = "target/figures/scaling.svg")]
    path: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { path } = arguments::read(include_str!("scaling.rs"));
    let target = PathBuf::from(std::env::var_os("CARGO_TARGET_DIR").unwrap_or("target".into()));
    let lines: Vec<_> = LINES.iter().map(|(group, ..)| medians(&target.join("criterion").join(group))).collect();
    if lines.iter().all(|points| points.len() < 2) {
        return Err(format!("there are no results in {}/criterion: run cargo bench", target.display()).into());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    for ((_, name, _), points) in LINES.iter().zip(&lines) {
        let times: Vec<_> = points.iter().map(|(n, seconds)| format!("{n}²: {seconds:.3e} s")).collect();
        println!("{name:<20} {}", times.join("  "));
    }
    draw(&path, &lines)?;
    println!("drawn in {}", path.display());
    Ok(())
}

/// The nodes along a side, in order, and the median time in seconds, for each size measured in a group.
fn medians(group: &Path) -> Vec<(usize, f64)> {
    let side = |n: &str| n.parse::<usize>().ok();
    let entries = fs::read_dir(group).into_iter().flatten().flatten();
    let sides = entries.filter_map(|entry| side(entry.file_name().to_str()?));
    let median = |n: usize| {
        let text = fs::read_to_string(group.join(n.to_string()).join("new/estimates.json")).ok()?;
        let estimates: Value = serde_json::from_str(&text).ok()?;
        Some((n, estimates["median"]["point_estimate"].as_f64()? * 1e-9))
    };
    let mut points: Vec<_> = sides.filter_map(median).collect();
    points.sort_by_key(|point| point.0);
    points
}

fn draw(path: &Path, lines: &[Vec<(usize, f64)>]) -> Outcome<()> {
    let all = || lines.iter().flatten();
    let sides = (all().map(|p| p.0).min().unwrap_or(1) as f64, all().map(|p| p.0).max().unwrap_or(2) as f64);
    let (low, high) = all().fold((f64::INFINITY, 0.0_f64), |(low, high), p| (low.min(p.1), high.max(p.1)));
    // room for the legend
    let (low, high) = (0.5 * low, 50.0 * high);
    let root = SVGBackend::new(path, (900, 760)).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.titled("Time against the number of nodes, one thread", ("sans-serif", 18))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(80)
        .build_cartesian_2d(sides.0.log2() - 0.1..sides.1.log2() + 0.1, (low..high).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("nodes, n × n")
        .y_desc("median time / s")
        .x_labels(8)
        .x_label_formatter(&|x| if x.fract() == 0.0 { format!("{:.0}²", x.exp2()) } else { String::new() })
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .axis_desc_style(("sans-serif", 17))
        .draw()?;
    for ((_, name, colour), points) in LINES.iter().zip(lines).filter(|(_, points)| points.len() > 1) {
        let points: Vec<_> = points.iter().map(|&(n, seconds)| ((n as f64).log2(), seconds)).collect();
        let style = colour.stroke_width(2);
        chart
            .draw_series(LineSeries::new(points.clone(), style))?
            .label(format!("{name}: N^{:.2}", exponent(&points)))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 24, y)], style));
        chart.draw_series(points.into_iter().map(|p| Circle::new(p, 4, colour.filled())))?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)?;
    root.present()?;
    Ok(())
}

/// The exponent of the time over the number of nodes n², from points (log₂ n, time).
fn exponent(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + 2.0 * p.0 / count, y + p.1.log2() / count));
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| {
        let dx = 2.0 * p.0 - x;
        (xx + dx * dx, xy + dx * (p.1.log2() - y))
    });
    xy / xx
}
