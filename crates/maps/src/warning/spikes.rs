//! Single nodes that are far above or below their neighbours.

use ndarray::{Array2, Axis, Zip};

use super::extremes::range;
use super::relief::Relief;

/// The distance of a spike from the mean of its neighbours, in the rms of this distance over all nodes: Gaussian
/// heights do not reach 6 on any map.
const SPIKE: f64 = 6.0;

/// The distance of a spike from the mean of its neighbours, in the range of their heights: the tip of a smooth body,
/// however blunt or sharp, reaches 1.5.
const LONE: f64 = 2.0;

/// Single nodes that are far above or below their neighbours. Lengths are in units of the [`Relief`].
pub struct Spikes {
    pub count: usize,
    /// The greatest distance from the mean of the neighbours, and the node.
    pub farthest: f64,
    pub node: (usize, usize),
}

impl Spikes {
    /// The nodes at a distance from the mean of their eight neighbours (two on a line) that exceeds the rms height
    /// about the plane, [`SPIKE`] times the rms of this distance, and [`LONE`] times the range of the neighbours;
    /// nothing if there are none. The edges of the map are left out.
    pub fn find(relief: &Relief) -> Option<Self> {
        let Relief { heights, rms, .. } = relief;
        let (nx, ny) = heights.dim();
        // from each neighbour a spike differs by more than half of its distance from their mean
        if nx > 1 && !any_stands_out(heights, (1.0 - 1.0 / LONE) * rms) {
            return None;
        }
        // the only one of a side is by itself
        let size = [nx, ny].map(|n| if n == 1 { 1 } else { 3 });
        let (mut squares, mut count, mut candidates) = (0.0, 0.0, Vec::new());
        Zip::indexed(heights.windows(size)).for_each(|(i, j), around| {
            let node = (i + size[0] / 2, j + size[1] / 2);
            let beside = || around.iter().enumerate().filter(|(k, _)| *k != around.len() / 2).map(|(_, h)| *h);
            let (low, high) = range(beside());
            let out = (heights[node] - beside().sum::<f64>() / (around.len() - 1) as f64).abs();
            (squares, count) = (squares + out * out, count + 1.0);
            if out > LONE * (high - low) && out > *rms {
                candidates.push((out, node));
            }
        });
        candidates.retain(|(out, _)| *out > SPIKE * f64::sqrt(squares / count));
        let (farthest, node) =
            candidates.iter().copied().reduce(|most, next| if next.0 > most.0 { next } else { most })?;
        Some(Self { count: candidates.len(), farthest, node })
    }
}

/// Whether any node is above both nodes next to it along x, or below both, by more than this height.
fn any_stands_out(heights: &Array2<f64>, by: f64) -> bool {
    heights.axis_windows(Axis(0), 3).into_iter().any(|rows| {
        let out = |out: bool, before: &f64, own: &f64, after: &f64| {
            let (up, down) = ((own - before, own - after), (before - own, after - own));
            out | ((up.0 > by) & (up.1 > by)) | ((down.0 > by) & (down.1 > by))
        };
        Zip::from(rows.row(0)).and(rows.row(1)).and(rows.row(2)).fold(false, out)
    })
}
