//! Estimated and true errors of the grid, on band-limited maps of many kinds.

use asperity::accuracy::{Accuracy, GridError, Quantity};
use asperity::nested::Level;
use asperity::surface::resample;
use asperity::{Boundary, Control, Grid, NoAdhesion, Settings, Solver, Surface, Westergaard};
use ndarray::Array2;

use crate::strips::Draw;
use common::Outcome;

/// The bytes of the finest grid, which is the truth, and the least factor by which it is finer along the sides.
const MEMORY: f64 = 1.3e7;
const FINER: usize = 8;
/// The most grids of a scene that are looked at.
const GRIDS: usize = 3;
const SLOPE: f64 = 0.1;
/// An accuracy that no grid reaches, which the solver is to be far below.
const NEVER: f64 = 1e-5;

/// The map as it is given, with waves up to a share of those that its grid has, and the power by which they fall.
struct Kind {
    name: &'static str,
    shapes: &'static [(usize, usize)],
    share: (f64, f64),
    falls: (f64, f64),
}

const KINDS: [Kind; 5] = [
    Kind { name: "rough", shapes: &[(32, 32)], share: (0.3, 0.6), falls: (1.2, 2.0) },
    Kind { name: "smooth", shapes: &[(32, 32), (16, 16)], share: (0.05, 0.25), falls: (0.0, 3.0) },
    Kind { name: "white noise", shapes: &[(16, 16), (12, 20), (8, 8)], share: (1.0, 1.0), falls: (0.0, 0.0) },
    Kind { name: "strips", shapes: &[(256, 8), (128, 4), (6, 96), (64, 8)], share: (0.3, 1.0), falls: (0.0, 1.5) },
    Kind { name: "lines", shapes: &[(64, 1), (1, 128), (256, 1)], share: (0.1, 1.0), falls: (0.0, 1.5) },
];

impl Kind {
    /// Side lengths are those of square cells, with the longer side 1.
    fn surface(&self, draw: &mut Draw) -> Outcome<Surface> {
        let (nx, ny) = self.shapes[draw.whole(0, self.shapes.len() as i32 - 1) as usize];
        let longest = nx.max(ny) as f64;
        let grid = Grid::new((nx, ny), (nx as f64 / longest, ny as f64 / longest))?;
        let (share, falls) = (draw.between(self.share.0, self.share.1), draw.between(self.falls.0, self.falls.1));
        // no more than the waves of the share, each of a random phase
        let (mx, my) = ((nx as f64 * share).ceil() as usize, (ny as f64 * share).ceil() as usize);
        let noise = Array2::from_shape_simple_fn((mx.max(3).min(nx), my.max(3).min(ny)), || draw.normal());
        let mut heights = resample(noise, (nx, ny))?;
        for _ in 0..falls.round() as usize {
            // a smaller share of shorter waves
            heights = smoothed(&heights);
        }
        let surface = Surface::new(grid, heights)?;
        let slope = surface.spectrum().rms_slope();
        Ok(Surface::new(grid, surface.heights() * (SLOPE / slope))?)
    }
}

/// The mean of each node and its neighbours.
fn smoothed(heights: &Array2<f64>) -> Array2<f64> {
    let (nx, ny) = heights.dim();
    Array2::from_shape_fn((nx, ny), |(i, j)| {
        let at = |i: usize, j: usize| heights[[i % nx, j % ny]];
        (2.0 * at(i, j) + at(i + 1, j) + at(i + nx - 1, j) + at(i, j + 1) + at(i, j + ny - 1)) / 6.0
    })
}

fn value(quantity: Quantity, level: &Level) -> f64 {
    match quantity {
        Quantity::Area => level.area.corrected_contact_fraction,
        Quantity::Gap => level.mean_gap,
        Quantity::Pressure => level.mean_pressure,
        _ => level.stiffness.map_or(f64::NAN, |stiffness| stiffness.pressure_per_length),
    }
}

/// Compares estimated with true errors, of all quantities.
pub fn measure(quick: bool) -> Outcome<()> {
    let count = if quick { 4 } else { 60 };
    println!("\n== estimates: true errors within the estimate, and the median of estimated over true errors");
    println!("{:>23} {:>21} {:>21}", "", "sure", "rough");
    for kind in KINDS {
        // the ratios of estimated to true errors, of sure and of rough estimates
        let mut ratios: [[Vec<f64>; 2]; 4] = Default::default();
        let mut draw = Draw(23);
        for _ in 0..count {
            let surface = kind.surface(&mut draw)?;
            let waves = surface.nodes_per_wave(Boundary::Periodic);
            let pressure = Control::MeanPressure(SLOPE * draw.log(0.004, 0.6));
            let half_space = |grid| Westergaard::<f64>::new(grid, 1.0);
            let solve = |control| {
                let mut solver = Solver::new(Settings::default().tolerance(0.02 * NEVER));
                let wanted = Accuracy::new(NEVER, Quantity::Stiffness).memory(MEMORY);
                wanted.solve(&mut solver, &surface, half_space, NoAdhesion, control)
            };
            let mut found = solve(pressure)?;
            if draw.unit() < 0.4 {
                let gap = found.levels.last().map_or(0.0, |level| level.mean_gap);
                found = solve(Control::MeanGap(gap))?;
            }
            let levels = found.levels;
            let (truth, longest) = (&levels[levels.len() - 1], |level: &Level| level.shape.0.max(level.shape.1));
            let given = levels.iter().position(|level| level.shape == surface.grid().shape()).unwrap_or_default();
            for at in (given..levels.len() - 1).take(GRIDS) {
                let finer = longest(truth) / longest(&levels[at]);
                if finer < FINER {
                    break;
                }
                let waves = waves * (longest(&levels[at]) / longest(&levels[given])) as f64;
                let estimates = GridError::of_all(&levels[..=at], &found.solution.report, waves);
                let periodic = estimates.into_iter().filter(|(quantity, _)| *quantity != Quantity::Approach);
                for ((quantity, estimate), ratios) in periodic.zip(&mut ratios) {
                    let error = (value(quantity, &levels[at]) / value(quantity, truth) - 1.0).abs();
                    if let Some(estimate) = estimate.filter(|_| error.is_finite()) {
                        ratios[usize::from(estimate.rough)].push(estimate.relative / error);
                    }
                }
            }
        }
        for (quantity, ratios) in ["area", "gap", "pressure", "stiffness"].into_iter().zip(ratios) {
            let told = ratios.map(|mut ratios| {
                ratios.sort_by(f64::total_cmp);
                let covered = ratios.iter().filter(|ratio| **ratio >= 1.0).count();
                let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
                format!("{:>14} {median:>6.2}", format!("{covered} of {}", ratios.len()))
            });
            println!("{:>12} {:>10} {} {}", kind.name, quantity, told[0], told[1]);
        }
    }
    Ok(())
}
