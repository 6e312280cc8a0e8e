//! How right the law without a range is: spheres, waves, rough surfaces, its shape, and the error of its grid.
//!
//! `cargo run --release -p asperity-examples --example jkr -- TABLE`
//!
//! The law [`Jkr`](asperity::Jkr) has the range of the grid. The tables `sphere` and `wave` have it next to the exact
//! solutions of Johnson, Kendall and Roberts (1971) and Johnson (1995); `shapes`, laws of other shapes and steepness;
//! `rough`, self-affine surfaces on grids from coarse to fine; and `errors`, random scenes, with what a grid and one of
//! half as many nodes along the sides say of the limit, next to what grids two and four times as fine say; `kinds`, how
//! often true errors are within the estimates on each kind of scene. `picture` draws the pull-off over the nodes, with
//! its error.
//! The table `held` has the laws with a range: with which work of adhesion they act where the grid holds the edges of
//! contacts.
//!
//! Lengths, E* and loads are in consistent units; counts and figures are deterministic. The random scenes take four
//! minutes on one thread, all else two.

mod case;
mod errors;
mod estimate;
mod held;
mod kinds;
mod law;
mod picture;
mod rough;
mod scene;
mod shapes;
mod sphere;
mod wave;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::{Outcome, arguments};
use rayon::ThreadPoolBuilder;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Table {
    /// A sphere on a free half-space, next to the theory of Johnson, Kendall and Roberts.
    Sphere,
    /// A wave on a line and on a grid, next to Johnson's theory.
    Wave,
    /// Other shapes of the law, and other steepest slopes.
    Shapes,
    /// Self-affine surfaces: the pull-off, and the area.
    Rough,
    /// Laws with a range that the grid does not resolve: with which work of adhesion they act.
    Held,
    /// Random scenes: what two grids say of the limit.
    Errors,
    /// Kinds of scenes: how often the true errors are within the estimates.
    Kinds,
    /// A picture of the pull-off of a rough surface and of a sphere over the nodes.
    Picture,
}

#[derive(Parser)]
struct Arguments {
    /// The table; all of them if none is named
    table: Option<Table>,
    /// Small grids and a few scenes: some seconds
    #[arg(long)]
    quick: bool,
    /// Nodes along a side of the finest grid of the rough surfaces
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = arguments::power_of_two::<128>)]
    largest: usize,
    /// The number of random scenes
    #[arg(long, value_name = "N", default_value_t = 200)]
    scenes: usize,
    /// The seed of the random scenes
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// The only kind of the table of kinds, such as "rough, strong adhesion", with the pull-off of each scene
    #[arg(long, value_name = "KIND")]
    kind: Option<String>,
    /// The threads of all solves
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// The folder for the picture and for the values of the random scenes
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let Arguments { table, quick, largest, scenes, seed, kind, threads, out } =
        arguments::read(include_str!("main.rs"));
    let wants = |one: Table| table.is_none_or(|table| table == one);
    ThreadPoolBuilder::new().num_threads(threads).build()?.install(|| {
        if wants(Table::Sphere) {
            sphere::tables(quick)?;
        }
        if wants(Table::Wave) {
            wave::tables(quick)?;
        }
        if wants(Table::Shapes) {
            shapes::tables(quick)?;
        }
        if wants(Table::Rough) {
            rough::tables(quick, if quick { 128 } else { largest })?;
        }
        if wants(Table::Held) {
            held::tables(quick)?;
        }
        std::fs::create_dir_all(&out)?;
        if wants(Table::Picture) {
            picture::draw(quick, &out.join("pull-off.svg"))?;
        }
        if wants(Table::Errors) {
            let path = out.join(format!("jkr-errors-{seed}.csv"));
            errors::tables(if quick { scenes.min(6) } else { scenes }, seed, quick, &path)?;
        }
        if wants(Table::Kinds) {
            kinds::tables(scenes, seed, quick, kind.as_deref())?;
            if kind.is_none() {
                kinds::spheres(if quick { 6 } else { 60 })?;
                kinds::weak(if quick { 2 } else { 20 }, seed)?;
            }
        }
        Ok(())
    })
}
