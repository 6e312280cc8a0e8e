//! A free half-space beside what is known of it: a sphere by force, a rough sphere, a sphere with waves, and the pull-off.
//!
//! ```text
//! cargo run --release --example free -- [--size N] [--out DIR]
//! ```
//!
//! `--size` is the number of nodes along a side of the windows of the spheres (256 unless given); the table of Hertz goes
//! up to four times as many, and so does the shortest range of adhesion. `--out` is the folder of the picture
//! (`target/figures`).

#[path = "../common/arguments.rs"]
mod arguments;
mod chart;
mod hertz;
#[path = "../common/legend.rs"]
mod legend;
mod pull_off;
mod rough_sphere;
mod wavy_sphere;

use arguments::size_and_out;
use plotters::prelude::*;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let (size, out) = size_and_out(256, "target/figures")?;
    std::fs::create_dir_all(&out)?;
    hertz::table(4 * size)?;
    let charts = [rough_sphere::chart(2 * size)?, wavy_sphere::chart(size)?, pull_off::chart(size)?];
    let path = out.join("free.svg");
    let root = SVGBackend::new(&path, (1650, 600)).into_drawing_area();
    root.fill(&WHITE)?;
    for (chart, area) in charts.iter().zip(root.split_evenly((1, 3))) {
        chart.draw(&area)?;
    }
    root.present()?;
    println!("\ndrawn in {}", path.display());
    Ok(())
}
