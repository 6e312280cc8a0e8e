//! Errors: of the discretisation and of the solver, for each choice on each grid.

use std::time::Instant;

use asperity::{ElasticOperator, Westergaard};
use ndarray::Array2;

use crate::scene::{FAMILIES, Family, Scene, State};
use common::Outcome;

/// The largest grid that has no coarser ones below it.
const COARSEST: usize = 64;
/// The largest grid for Algorithm 3: its applications grow with the number of nodes along a side.
const SLOW: usize = 256;

/// Relative root mean squares over the loads: of the displacement at the nodes in the energy norm, of the share of
/// nodes in contact, of the contact fraction corrected for its edge, and of the mean gap or mean pressure.
pub type Errors = [f64; 4];

/// A grid of a scene.
pub struct OnGrid {
    /// Its nodes along a side.
    pub n: usize,
    /// Of the solution converged on the grid, against the truth.
    pub discretisation: Errors,
    pub rows: Vec<Row>,
}

/// A choice on a grid.
pub struct Row {
    pub family: Family,
    pub tolerance: f64,
    /// In units of one application on the grid; the mean over the loads, as are the seconds.
    pub applications: f64,
    pub seconds: f64,
    /// Under all loads.
    pub converged: bool,
    /// Against the solution converged on the grid.
    pub solver: Errors,
}

/// The choices that are measured on a grid.
fn choices(n: usize, quick: bool) -> impl Iterator<Item = (Family, f64)> {
    let fits = move |(_, rey2017, _, nested): &Family| if *rey2017 { n <= SLOW } else { n > COARSEST || !nested };
    FAMILIES.into_iter().filter(fits).flat_map(move |family| {
        let (step, least) = (if quick || family.1 { 2 } else { 1 }, if family.2 { 1e-5 } else { 1e-8 });
        let tolerances = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8].into_iter().step_by(step);
        tolerances.filter(move |&tolerance| tolerance >= least).map(move |tolerance| (family, tolerance))
    })
}

/// Measures a scene on all of its grids.
pub fn on_grids(scene: &Scene, references: &[State], quick: bool) -> Outcome<Vec<OnGrid>> {
    let measured = |&n: &usize| -> Outcome<OnGrid> {
        let surface = scene.surface(n)?;
        let mut operator = Westergaard::<f64>::new(*surface.grid(), 1.0)?;
        let truths: Vec<_> = references.iter().map(|reference| scene.truth(n, reference)).collect();
        let sharp = scene.loads.iter().map(|&load| scene.converged(&surface, load, FAMILIES[0]));
        let sharp = sharp.collect::<Outcome<Vec<_>>>()?;
        let discretisation = errors(&sharp, &truths, &mut operator)?;
        let mut rows = Vec::new();
        for (family, tolerance) in choices(n, quick) {
            let (mut states, mut converged, mut applications, mut seconds) = (Vec::new(), true, 0.0, 0.0);
            for &load in &scene.loads {
                let begin = Instant::now();
                let solve = if family.2 { Scene::solve::<f32> } else { Scene::solve::<f64> };
                let (state, count, well) = solve(scene, &surface, load, (family, tolerance))?;
                (converged, applications) = (converged && well, applications + count / scene.loads.len() as f64);
                seconds += begin.elapsed().as_secs_f64() / scene.loads.len() as f64;
                states.push(state);
            }
            let solver = errors(&states, &sharp, &mut operator)?;
            rows.push(Row { family, tolerance, applications, seconds, converged, solver });
        }
        Ok(OnGrid { n, discretisation, rows })
    };
    scene.sizes.iter().map(measured).collect()
}

fn errors(found: &[State], truths: &[State], operator: &mut Westergaard<f64>) -> Outcome<Errors> {
    let mut squares = [0.0; 4];
    for (found, truth) in found.iter().zip(truths) {
        let mut pressure = Array2::zeros(truth.0.dim());
        let mut work = |u: &Array2<f64>| -> Outcome<f64> {
            operator.pressure(u.view(), pressure.view_mut())?;
            Ok((u * &pressure).sum())
        };
        let all = work(&truth.0)?;
        squares[0] += work(&(&found.0 - &truth.0))?.max(0.0) / all;
        for ((square, found), truth) in squares[1..].iter_mut().zip(found.1).zip(truth.1) {
            *square += (found / truth - 1.0).powi(2);
        }
    }
    Ok(squares.map(|sum| (sum / found.len() as f64).sqrt()))
}

fn percent(error: f64) -> String {
    let percent = 100.0 * error;
    let digits = (1.0 - percent.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    if percent == 0.0 { "0".to_owned() } else { format!("{percent:.digits$}") }
}

/// Prints the discretisation error of each grid, and the solver errors of each choice.
pub fn tell(scene: &Scene, grids: &[OnGrid]) {
    println!("\nErrors of converged solutions on the grids, that of the displacement in the energy norm\n");
    let (length, name) = scene.length;
    let errors = ["displacement", "nodes in contact", "corrected area", "mean gap or pressure"].join(", % | ");
    println!("| nodes in the {name} | nodes | μ_ρ | {errors}, % |\n|{}", "---|".repeat(7));
    for grid in grids {
        let (nodes, mu_rho) = ((10.0 * grid.n as f64 * length).round() / 10.0, scene.resolution(grid.n));
        let errors = grid.discretisation.map(percent).join(" | ");
        println!("| {nodes} | {} | {mu_rho:.2} | {errors} |", grid.n);
    }
    println!("\nErrors of the solver in %, of area that corrected for its edge; ! not converged");
    println!(
        "{:>6} {:<14} {:>9} {:>12} {:>9} | {:>12} {:>8} {:>8}",
        "nodes", "choice", "tolerance", "applications", "time/ms", "displacement", "area", "answer"
    );
    for (grid, row) in grids.iter().flat_map(|grid| grid.rows.iter().map(move |row| (grid, row))) {
        let [energy, _, area, answer] = row.solver.map(percent);
        println!(
            "{:>6} {:<14} {:>9.0e} {:>12.1} {:>9.2} | {energy:>12} {area:>8} {answer:>8} {}",
            grid.n,
            row.family.0,
            row.tolerance,
            row.applications,
            1e3 * row.seconds,
            if row.converged { "" } else { "!" },
        );
    }
}
