//! Estimated and true errors of the grid, on band-limited maps of many kinds.

use std::f64::consts::TAU;

use asperity::accuracy::{Accuracy, GridError, Quantity};
use asperity::nested::Level;
use asperity::surface::resample;
use asperity::{Boundary, Control, Grid, NoAdhesion, Settings, Solver, Surface};
use ndarray::Array2;

use crate::knob::half_space;
use common::{Draw, Outcome};

/// The bytes of the finest grid, which is the truth, and the least factor by which it is finer along the sides.
const MEMORY: f64 = 1.3e7;
const FINER: usize = 8;
/// The most grids of a scene that are looked at.
const GRIDS: usize = 3;
const SLOPE: f64 = 0.1;
/// An accuracy that no grid reaches, which the solver is to be far below.
const NEVER: f64 = 1e-5;
/// The error of the stiffness on each grid.
const STIFFNESS: f64 = 1e-4;

/// Maps by name: their shapes, the waves as shares of those that the grid has, and how often they are smoothed.
type Kind = (&'static str, &'static [(usize, usize)], (f64, f64), (f64, f64));

const KINDS: [Kind; 5] = [
    ("rough", &[(32, 32)], (0.3, 0.6), (1.2, 2.0)),
    ("smooth", &[(32, 32), (16, 16)], (0.05, 0.25), (0.0, 3.0)),
    ("white noise", &[(16, 16), (12, 20), (8, 8)], (1.0, 1.0), (0.0, 0.0)),
    ("narrow maps, such as 256 × 8", &[(256, 8), (128, 4), (6, 96), (64, 8)], (0.3, 1.0), (0.0, 1.5)),
    ("lines", &[(64, 1), (1, 128), (256, 1)], (0.1, 1.0), (0.0, 1.5)),
];

/// A random map with square cells, and the longer side 1.
fn surface((_, shapes, share, falls): Kind, draw: &mut Draw) -> Outcome<Surface> {
    let (nx, ny) = shapes[draw.between((0.0, shapes.len() as f64)) as usize];
    let longest = nx.max(ny) as f64;
    let grid = Grid::new((nx, ny), (nx as f64 / longest, ny as f64 / longest))?;
    let (share, falls) = (draw.between(share), draw.between(falls));
    // no more than the waves of the share, each of a random phase
    let few = |n: usize| ((n as f64 * share).ceil() as usize).max(3).min(n);
    let normal = || (-2.0 * (1.0 - draw.share()).ln()).sqrt() * (TAU * draw.share()).cos();
    let mut heights = resample(Array2::from_shape_simple_fn((few(nx), few(ny)), normal), (nx, ny))?;
    for _ in 0..falls.round() as usize {
        // the mean of each node and its neighbours has a smaller share of shorter waves
        heights = Array2::from_shape_fn((nx, ny), |(i, j)| {
            let at = |i: usize, j: usize| heights[[i % nx, j % ny]];
            (2.0 * at(i, j) + at(i + 1, j) + at(i + nx - 1, j) + at(i, j + 1) + at(i, j + ny - 1)) / 6.0
        });
    }
    let surface = Surface::new(grid, heights)?;
    let slope = surface.spectrum().rms_slope();
    Ok(Surface::new(grid, surface.heights() * (SLOPE / slope))?)
}

fn values(level: &Level) -> [f64; 4] {
    let stiffness = level.stiffness.map_or(f64::NAN, |stiffness| stiffness.pressure_per_length);
    [level.area.corrected_contact_fraction, level.mean_gap, level.mean_pressure, stiffness]
}

/// Compares estimated with true errors, of all quantities.
pub fn measure(quick: bool) -> Outcome<()> {
    println!("\n== estimates: true errors within the estimate, and the median of estimated over true errors\n");
    println!("| map | area | gap | pressure | stiffness |\n|---|---|---|---|---|");
    for kind in KINDS {
        // of estimated to true errors
        let mut ratios: [Vec<f64>; 4] = Default::default();
        let mut draw = Draw(23);
        for _ in 0..if quick { 4 } else { 60 } {
            let surface = surface(kind, &mut draw)?;
            let solve = |control| {
                let mut solver = Solver::new(Settings::default().tolerance(0.02 * NEVER));
                let wanted = Accuracy::new(NEVER, Quantity::Area).memory(MEMORY);
                let wanted = wanted.nested(wanted.nested.stiffness(STIFFNESS));
                wanted.solve(&mut solver, &surface, half_space, NoAdhesion, control)
            };
            let mut found = solve(Control::MeanPressure(SLOPE * 0.004 * 150_f64.powf(draw.share())))?;
            if draw.share() < 0.4 {
                found = solve(Control::MeanGap(found.solution.report.mean_gap))?;
            }
            let (levels, waves) = (&found.levels, surface.nodes_per_wave(Boundary::Periodic));
            let (truth, longest) = (&levels[levels.len() - 1], |level: &Level| level.shape.0.max(level.shape.1));
            let given = levels.iter().position(|level| level.shape == surface.grid().shape()).unwrap_or_default();
            let coarse = (given..levels.len() - 1).take(GRIDS);
            for at in coarse.take_while(|&at| longest(truth) / longest(&levels[at]) >= FINER) {
                let waves = waves * (longest(&levels[at]) / longest(&levels[given])) as f64;
                let estimates = GridError::of_all(&levels[..=at], &found.solution.report, waves);
                let periodic = estimates.into_iter().filter(|(quantity, _)| *quantity != Quantity::Approach);
                let stiffness = levels[at].stiffness.and_then(|stiffness| stiffness.error());
                let estimates = periodic.map(|(_, error)| error.map(|error| error.relative)).chain([stiffness]);
                let both = values(&levels[at]).into_iter().zip(values(truth));
                for ((estimate, (value, truth)), ratios) in estimates.zip(both).zip(&mut ratios) {
                    let error = (value / truth - 1.0).abs();
                    ratios.extend(estimate.filter(|_| error.is_finite()).map(|estimate| estimate / error));
                }
            }
        }
        let told = ratios.map(|mut ratios| {
            ratios.sort_by(f64::total_cmp);
            let covered = ratios.iter().filter(|ratio| **ratio >= 1.0).count();
            let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
            format!("{covered} of {}, {median:.1}", ratios.len())
        });
        println!("| {} | {} |", kind.0, told.join(" | "));
    }
    Ok(())
}
