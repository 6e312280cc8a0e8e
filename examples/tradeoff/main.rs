//! The cost of accuracy: true errors against time and operator applications.
//!
//! `cargo run --release -p asperity-examples --example tradeoff`
//!
//! Four scenes: `hertz`, a paraboloid among its images; `wave`, Westergaard's wave on a line; `rough`, a self-affine
//! hard wall; and `adhesive`, the same with an exponential law. The first two have exact solutions, the others a
//! reference converged to 1e-12 on a grid finer than all others. On each grid all that a user may choose is tried:
//! tolerance, precision, nested grids, method (`rey2017` on small grids only).
//!
//! The fifth, `knob`, is another experiment: on 120 rough scenes it compares the estimated error of the grid with the
//! true one, and asks for accuracies of the contact area, which it compares with the best choice by hand. The sixth,
//! `strips`, asks for them on surfaces whose contact edges are at few independent places: waves, scratches and ground
//! surfaces along the sides and at angles to them, and lattices. The seventh, `estimates`, counts how many true errors
//! the estimates cover, of every quantity, on band-limited maps: rough, smooth, white noise, thin strips, and lines.
//!
//! Errors are relative, and root mean squares over a few loads, as the error of an area depends on how the edge falls
//! between the nodes. The discretisation error is the difference between the solution converged to 1e-12 on the grid
//! and the truth; the solver error, between the solution found and the converged one; and the true error, between the
//! solution found and the truth. Pareto fronts and pictures take the sum of the first two: in the true error they may
//! cancel by luck.
//!
//! Counts and errors are deterministic. Times are medians of repetitions.

mod choice;
mod error;
mod estimates;
mod front;
mod knob;
mod picture;
mod scene;
mod strips;
mod table;

use std::path::PathBuf;

use choice::Choice;
use clap::Parser;
use common::{Outcome, arguments};
use rayon::ThreadPoolBuilder;
use scene::Scene;

/// The scene of many surfaces, on which accuracies are asked for.
const KNOB: &str = "knob";
/// That of strips and lattices.
const STRIPS: &str = "strips";
/// That of maps of many kinds, on which estimated errors are compared with true ones.
const ESTIMATES: &str = "estimates";

#[derive(Parser)]
struct Arguments {
    /// Small grids and some seconds; without it all takes a few minutes, most of them for the references
    #[arg(long)]
    quick: bool,
    /// One scene alone: hertz, wave, rough, adhesive, knob, strips or estimates
    #[arg(long, value_name = "NAME")]
    scene: Option<String>,
    /// The threads on which solves are timed; the references are computed on all
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
    /// Nodes along a side of the grid of the references, a power of two; 4096 unless given or --quick
    #[arg(long, value_name = "N", value_parser = arguments::power_of_two::<256>)]
    reference: Option<usize>,
    /// The folder for the pictures
    #[arg(long, value_name = "DIR", default_value = "target/figures")]
    out: PathBuf,
}

fn main() -> Outcome<()> {
    let options: Arguments = arguments::read(include_str!("main.rs"));
    let mut scenes = Scene::all(options.quick, options.reference)?;
    let names: Vec<_> = scenes.iter().map(|scene| scene.name).chain([KNOB, STRIPS, ESTIMATES]).collect();
    let [knob, strips, estimates] =
        [KNOB, STRIPS, ESTIMATES].map(|own| options.scene.as_ref().is_none_or(|name| name == own));
    if let Some(name) = &options.scene {
        scenes.retain(|scene| scene.name == name);
        if scenes.is_empty() && !knob && !strips && !estimates {
            return Err(format!("--scene {name}: the scenes are {}", names.join(", ")).into());
        }
    }
    std::fs::create_dir_all(&options.out)?;
    let pool = ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    println!("Threads: {}. Errors are root mean squares over the loads.", options.threads);
    for scene in &mut scenes {
        println!("\n== {}: {}; {} loads, lengths in {}", scene.name, scene.title, scene.loads.len(), scene.length_name);
        scene.prepare()?;
        let scene = &*scene;
        let grids = pool.install(|| error::on_grids(scene, |n| Choice::all(n, options.quick)))?;
        table::discretisation(scene, &grids);
        table::rows(scene, &grids);
        table::worth(scene, &grids);
        table::targets(scene, &grids);
        let path = options.out.join(format!("tradeoff-{}.svg", scene.name));
        picture::draw(&path, scene, &grids)?;
        println!("drawn in {}", path.display());
    }
    if knob {
        pool.install(|| knob::measure(options.quick, &options.out))?;
    }
    if strips {
        pool.install(|| strips::measure(options.quick))?;
    }
    if estimates {
        pool.install(|| estimates::measure(options.quick))?;
    }
    Ok(())
}
