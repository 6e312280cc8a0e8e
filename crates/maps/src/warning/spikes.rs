//! Single nodes that are far above or below their neighbours.

use ndarray::{Array2, Axis, Zip};

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
        if nx > 1 && !any_stands_out(heights, (1.0 - 1.0 / LONE) * rms * relief.unit) {
            return Self::default();
        }
        let slope = [relief.sides[0].drop / nx as f64, relief.sides[1].drop / ny as f64];
        let centre = [0.5 * (nx as f64 - 1.0), 0.5 * (ny as f64 - 1.0)];
        let (mut fourth, mut squares, mut count, mut candidates) = (0.0, 0.0, 0.0, Vec::new());
        // the only one of a side is by itself
        let is_inside = |i: usize, n: usize| n == 1 || i > 0 && i + 1 < n;
        for i in 0..nx {
            let around = [i.saturating_sub(1), i, (i + 1).min(nx - 1)];
            let [before, own, after] = around.map(|i| heights.row(i).mapv(|h| scale.of(h)).to_vec());
            for (j, &h) in own.iter().enumerate() {
                let plane = relief.mean + slope[0] * (i as f64 - centre[0]) + slope[1] * (j as f64 - centre[1]);
                fourth += ((h - plane) / rms).powi(4);
                if !is_inside(i, nx) || !is_inside(j, ny) {
                    continue;
                }
                let (sum, low, high, number) = match (nx, ny) {
                    (1, _) => figures([own[j - 1], own[j + 1]]),
                    (_, 1) => figures([before[j], after[j]]),
                    _ => figures([
                        before[j - 1],
                        before[j],
                        before[j + 1],
                        own[j - 1],
                        own[j + 1],
                        after[j - 1],
                        after[j],
                        after[j + 1],
                    ]),
                };
                let out = (h - sum / number).abs();
                (squares, count) = (squares + out * out, count + 1.0);
                if out > LONE * (high - low) && out > rms {
                    candidates.push((out, (i, j)));
                }
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

/// Whether any node is above both nodes beside it along x, or below both, by more than this height.
fn any_stands_out(heights: &Array2<f64>, by: f64) -> bool {
    let triples = heights.axis_windows(Axis(0), 3);
    triples.into_iter().any(|rows| {
        let out = |out: bool, before: &f64, own: &f64, after: &f64| {
            let (up, down) = ((own - before, own - after), (before - own, after - own));
            out | ((up.0 > by) & (up.1 > by)) | ((down.0 > by) & (down.1 > by))
        };
        Zip::from(rows.row(0)).and(rows.row(1)).and(rows.row(2)).fold(false, out)
    })
}

/// The sum of some numbers, the lowest and the highest, and how many they are.
fn figures<const N: usize>(numbers: [f64; N]) -> (f64, f64, f64, f64) {
    let sum = numbers.iter().fold(0.0, |sum, number| sum + number);
    let low = numbers.iter().fold(f64::INFINITY, |low, &number| if number < low { number } else { low });
    let high = numbers.iter().fold(f64::NEG_INFINITY, |high, &number| if number > high { number } else { high });
    (sum, low, high, N as f64)
}
