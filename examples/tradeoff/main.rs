//! The cost of accuracy: true errors against time and operator applications.
//!
//! `cargo run --release -p asperity-examples --example tradeoff`
//!
//! Three scenes: `hertz`, a paraboloid among its images; `rough`, a self-affine hard wall; and `adhesive`, the same
//! with an exponential law. The truth is a reference converged to 1e-12 on a grid finer than all others. On each grid
//! all that a user may choose is tried: tolerance, precision, nested grids, method (`rey2017` on small grids only).
//!
//! The fourth, `knob`, asks for accuracies of the contact area on 120 rough scenes, and compares them with the best
//! choice by hand. The fifth, `estimates`, counts how many true errors the estimates cover, of every quantity, on
//! band-limited maps: rough, smooth, white noise, thin strips, lines.
//!
//! Errors are relative, and root mean squares over a few loads, as the error of an area depends on how the edge falls
//! between the nodes. The discretisation error is the difference between the solution converged to 1e-12 on the grid
//! and the truth, and the solver error that between the solution found and the converged one. Pictures have their sum:
//! in the difference of the solution found from the truth they may cancel by luck.
//!
//! Counts and errors are deterministic. Times count one solve, from the heights to the figures, on as many threads as
//! `RAYON_NUM_THREADS` says.

mod error;
mod estimates;
mod knob;
mod picture;
mod scene;

use std::path::PathBuf;

use clap::Parser;
use common::{Outcome, arguments};
use scene::Scene;

#[derive(Parser)]
struct Arguments {
    /// Small grids and some seconds; without it all takes a few minutes, most of them for the references
    #[arg(long)]
    quick: bool,
    /// One scene alone
    #[arg(long, value_name = "NAME")]
    #[arg(value_parser = ["hertz", "rough", "adhesive", "knob", "estimates"])]
    scene: Option<String>,
    /// Nodes along a side of the grid of the references, a power of two; 4096 unless given or --quick
    #[arg(long, value_name = "N", value_parser = arguments::power_of_two::<256>)]
    reference: Option<usize>,
    /// The folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let options: Arguments = arguments::read(include_str!("main.rs"));
    let wanted = |name: &str| options.scene.as_ref().is_none_or(|scene| scene == name);
    std::fs::create_dir_all(&options.out)?;
    for scene in Scene::all(options.quick, options.reference).iter().filter(|scene| wanted(scene.name)) {
        println!("\n== {}: the length is the {}; {} loads", scene.name, scene.length.1, scene.loads.len());
        let references = scene.references()?;
        let grids = error::on_grids(scene, &references, options.quick)?;
        error::tell(scene, &grids);
        let path = options.out.join(format!("tradeoff-{}.svg", scene.name));
        picture::draw(&path, scene, &grids)?;
    }
    if wanted("knob") {
        knob::measure(options.quick)?;
    }
    if wanted("estimates") { estimates::measure(options.quick) } else { Ok(()) }
}
