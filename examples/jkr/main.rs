//! How right the law without a range is: spheres, waves, and the error of its grid.
//!
//! `cargo run --release -p asperity-examples --example jkr -- TABLE`
//!
//! The law [`Jkr`](asperity::Jkr) has the range of the grid. The tables `sphere` and `wave` have it next to the exact
//! solutions of Johnson, Kendall and Roberts (1971) and Johnson (1995). `kinds` counts how often true errors are within the
//! estimates on each kind of scene, next to grids two and four times as fine. `picture` draws the pull-off over the
//! nodes, with its error.
//!
//! Lengths, E* and loads are in consistent units; figures are deterministic.

mod case;
mod kinds;
mod picture;
mod scene;
mod sphere;
mod wave;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::{Outcome, arguments};

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Table {
    /// A sphere on a free half-space, next to the theory of Johnson, Kendall and Roberts.
    Sphere,
    /// A wave on a line and on a grid, next to Johnson's theory.
    Wave,
    /// Kinds of scenes: how often the true errors are within the estimates.
    Kinds,
    /// A picture of the pull-off of a rough surface and of a sphere over the nodes.
    Picture,
}

#[derive(Parser)]
struct Arguments {
    /// The table; all of them if none is named
    table: Option<Table>,
    /// Small grids and a scene of each kind: half a minute
    #[arg(long)]
    quick: bool,
    /// The number of random scenes
    #[arg(long, value_name = "N", default_value_t = 306)]
    scenes: usize,
    /// The seed of the random scenes
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// The only kind of the table of kinds, such as "rough, strong adhesion", with the pull-off of each scene
    #[arg(long, value_name = "KIND")]
    kind: Option<String>,
    /// The folder for the picture
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { table, quick, scenes, seed, kind, out } = arguments::read(include_str!("main.rs"));
    let wants = |one: Table| table.is_none_or(|table| table == one);
    if wants(Table::Sphere) {
        sphere::table(if quick { 64 } else { 256 })?;
    }
    if wants(Table::Wave) {
        wave::table(if quick { 128 } else { 512 })?;
    }
    if wants(Table::Picture) {
        picture::draw(if quick { [64; 2] } else { [512, 256] }, &out.join("pull-off.svg"))?;
    }
    if wants(Table::Kinds) {
        kinds::table(if quick { scenes.min(18) } else { scenes }, seed, kind.as_deref())?;
    }
    Ok(())
}
