//! The cost of accuracy: true errors against time and operator applications.
//!
//! ```text
//! cargo run --release --example tradeoff -- [--quick] [--scene NAME] [--threads N] [--reference N] [--out DIR]
//! ```
//!
//! Four scenes: `hertz`, a paraboloid among its images; `wave`, Westergaard's wave on a line; `rough`, a self-affine
//! hard wall; and `adhesive`, the same with an exponential law. The first two have exact solutions, the others a
//! reference converged to 1e-12 on a grid finer than all others. On each grid all that a user may choose is tried:
//! tolerance, precision, nested grids, preset (`rey2017` on small grids only).
//!
//! The fifth, `knob`, is another experiment: on 120 rough scenes it compares the estimated error of the grid with the true
//! one, and asks for accuracies of the contact area, which it compares with the best choice by hand.
//!
//! Errors are relative, and root mean squares over a few loads, as the error of an area depends on how the edge falls
//! between the nodes. The discretisation error is the difference between the solution converged to 1e-12 on the grid
//! and the truth; the solver error, between the solution found and the converged one; and the true error, between the
//! solution found and the truth. Pareto fronts and pictures take the sum of the first two: in the true error they may
//! cancel by luck.
//!
//! Counts and errors are deterministic. Times are medians of repetitions, on one thread unless `--threads` says
//! otherwise; the references are computed on all. `--quick` takes small grids and some seconds; without it all takes a
//! few minutes, most of them for the references, whose grid `--reference` chooses (4096 unless given). The pictures go
//! to `target/figures` unless `--out` says where.

mod choice;
mod error;
mod front;
mod knob;
mod picture;
mod scene;
mod table;

use std::path::PathBuf;

use choice::Choice;
use rayon::ThreadPoolBuilder;
use scene::Scene;

/// The scene of many surfaces, on which accuracies are asked for.
const KNOB: &str = "knob";

type Outcome<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

struct Options {
    quick: bool,
    scene: Option<String>,
    threads: usize,
    reference: Option<usize>,
    out: PathBuf,
}

impl Options {
    fn read() -> Outcome<Self> {
        let mut options = Self { quick: false, scene: None, threads: 1, reference: None, out: "target/figures".into() };
        let mut arguments = std::env::args().skip(1);
        while let Some(name) = arguments.next() {
            if name == "--quick" {
                options.quick = true;
                continue;
            }
            let value = arguments.next().ok_or_else(|| format!("{name}: a value must follow"))?;
            match name.as_str() {
                "--scene" => options.scene = Some(value),
                "--threads" => options.threads = value.parse().map_err(|e| format!("--threads {value}: {e}"))?,
                "--reference" => {
                    let n: usize = value.parse().map_err(|e| format!("--reference {value}: {e}"))?;
                    if !n.is_power_of_two() || n < 256 {
                        return Err(format!("--reference {value}: must be a power of two, and no less than 256").into());
                    }
                    options.reference = Some(n);
                }
                "--out" => options.out = value.into(),
                _ => {
                    return Err(
                        format!("{name}: the options are --quick, --scene, --threads, --reference and --out").into()
                    );
                }
            }
        }
        Ok(options)
    }
}

fn main() -> Outcome<()> {
    let options = Options::read()?;
    let mut scenes = Scene::all(options.quick, options.reference)?;
    let names: Vec<_> = scenes.iter().map(|scene| scene.name).chain([KNOB]).collect();
    let knob = options.scene.as_ref().is_none_or(|name| name == KNOB);
    if let Some(name) = &options.scene {
        scenes.retain(|scene| scene.name == name);
        if scenes.is_empty() && !knob {
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
    Ok(())
}
