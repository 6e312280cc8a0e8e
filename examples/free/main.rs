//! A free half-space against what is known of it: a sphere by force, a rough sphere, a sphere with waves, and the
//! pull-off.
//!
//! `cargo run --release -p asperity-examples --example free`

mod hertz;
mod pull_off;
mod rough_sphere;
mod wavy_sphere;

use std::path::PathBuf;

use clap::Parser;
use common::{Outcome, arguments};
use plotters::prelude::*;

#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the windows of the spheres; Hertz' table goes up to four times as many, and so does the
    /// shortest range of adhesion
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = arguments::nodes::<32>)]
    size: usize,
    /// The folder for the picture
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { size, out } = arguments::read(include_str!("main.rs"));
    std::fs::create_dir_all(&out)?;
    hertz::table(4 * size)?;
    let charts = [rough_sphere::chart(2 * size)?, wavy_sphere::chart(size)?, pull_off::chart(size)?];
    let path = out.join("free.svg");
    let root = SVGBackend::new(&path, (1200, 460)).into_drawing_area();
    root.fill(&WHITE)?;
    for (chart, area) in charts.iter().zip(root.split_evenly((1, 3))) {
        chart.draw(&area)?;
    }
    root.present()?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}
