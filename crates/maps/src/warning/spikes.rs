//! Single nodes that are far above or below their neighbours.

use std::ops::RangeInclusive;

use ndarray::Array2;

use super::relief::Relief;

/// The distance of a spike from the mean of its neighbours, in the rms of this distance over all nodes: Gaussian
/// heights do not reach 6 on any map.
const SPIKE: f64 = 6.0;

/// The distance of a spike from the mean of its neighbours, in the range of their heights: the tip of a smooth body,
/// however blunt or sharp, reaches 1.5.
const LONE: f64 = 2.0;

/// Single nodes that are far above or below their neighbours. Lengths are in units of the [`Relief`].
#[derive(Default)]
pub struct Spikes {
    pub count: usize,
    /// The greatest distance from the mean of the neighbours, and the node.
    pub farthest: f64,
    pub node: (usize, usize),
    /// The kurtosis of the heights about their plane.
    pub kurtosis: f64,
}

impl Spikes {
    /// The nodes whose distance from the mean of their eight neighbours (two on a line) exceeds the rms height about
    /// the plane, [`SPIKE`] times the rms of this distance, and [`LONE`] times the range of the neighbours. The edges
    /// of the map are left out.
    pub fn of(heights: &Array2<f64>, relief: &Relief) -> Self {
        let (rms, scale) = (relief.rms_about_plane(), relief.scale);
        let (nx, ny) = heights.dim();
        // from each neighbour a spike differs by more than half of its distance from their mean
        if nx > 1 && relief.greatest_single_step <= (1.0 - 1.0 / LONE) * rms {
            return Self::default();
        }
        let slope = [relief.sides[0].drop / nx as f64, relief.sides[1].drop / ny as f64];
        let centre = [0.5 * (nx as f64 - 1.0), 0.5 * (ny as f64 - 1.0)];
        let (mut fourth, mut squares, mut count, mut candidates) = (0.0, 0.0, 0.0, Vec::new());
        for ((i, j), &h) in heights.indexed_iter() {
            let plane = relief.mean + slope[0] * (i as f64 - centre[0]) + slope[1] * (j as f64 - centre[1]);
            let h = scale.of(h);
            fourth += ((h - plane) / rms).powi(4);
            let (Some(rows), Some(columns)) = (beside(i, nx), beside(j, ny)) else { continue };
            let (mut sum, mut low, mut high, mut number) = (0.0, f64::INFINITY, f64::NEG_INFINITY, 0.0);
            let window = rows.flat_map(|i| columns.clone().map(move |j| (i, j)));
            for near in window.filter(|&near| near != (i, j)).map(|near| scale.of(heights[near])) {
                (sum, number) = (sum + near, number + 1.0);
                (low, high) = (low.min(near), high.max(near));
            }
            let out = (h - sum / number).abs();
            (squares, count) = (squares + out * out, count + 1.0);
            if out > LONE * (high - low) && out > rms {
                candidates.push((out, (i, j)));
            }
        }
        let (kurtosis, usual) = (fourth / heights.len() as f64, f64::sqrt(squares / count));
        candidates.iter().filter(|(out, _)| *out > SPIKE * usual).fold(
            Self { kurtosis, ..Self::default() },
            |mut spikes, &(out, node)| {
                spikes.count += 1;
                if out > spikes.farthest {
                    (spikes.farthest, spikes.node) = (out, node);
                }
                spikes
            },
        )
    }
}

/// The numbers beside a number and itself, of a side that has so many; none at its ends. The only one is by itself.
fn beside(i: usize, n: usize) -> Option<RangeInclusive<usize>> {
    match n {
        1 => Some(0..=0),
        _ => (i > 0 && i + 1 < n).then(|| i - 1..=i + 1),
    }
}
