//! Single nodes that are far above or below their neighbours.

use ndarray::Array2;

use super::relief::{Relief, Scale};
use crate::field::flat;
use crate::par;

/// The distance of a spike from the mean of its neighbours, in the rms of this distance over all nodes: Gaussian
/// heights do not reach 6 on any map.
const SPIKE: f64 = 6.0;

/// The distance of a spike from the mean of its neighbours, in the range of their heights: the tip of a smooth body,
/// however blunt or sharp, reaches 1.5.
const LONE: f64 = 2.0;

/// Rows that a thread takes at once.
const BLOCK: usize = 16;

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
        let mut blocks = vec![Block::default(); nx.div_ceil(BLOCK)];
        par::update(par::chunks(flat(heights), BLOCK * ny), &mut blocks, |block, within, found| {
            let mut around = Around::default();
            for i in (0..within.len() / ny).map(|i| block * BLOCK + i) {
                around.of_row(heights, i, scale);
                let fourth = |(j, h): (usize, &f64)| {
                    let plane = relief.mean + slope[0] * (i as f64 - centre[0]) + slope[1] * (j as f64 - centre[1]);
                    ((h - plane) / rms).powi(4)
                };
                found.fourth.push(around.here.iter().enumerate().map(fourth).sum());
                let mut squares = 0.0;
                let nodes = around.neighbours.iter().zip(&around.here[around.first..]);
                for (k, (&(sum, low, high), &h)) in nodes.enumerate() {
                    let out = (h - sum / around.count).abs();
                    squares += out * out;
                    if out > LONE * (high - low) && out > rms {
                        found.candidates.push((out, (i, around.first + k)));
                    }
                }
                found.squares.push(squares);
                found.count += around.neighbours.len();
            }
        });
        // row by row
        let total = |of: fn(&Block) -> &Vec<f64>| blocks.iter().flat_map(of).sum::<f64>();
        let kurtosis = total(|block| &block.fourth) / heights.len() as f64;
        let count: usize = blocks.iter().map(|block| block.count).sum();
        let usual = f64::sqrt(total(|block| &block.squares) / count as f64);
        let candidates = blocks.iter().flat_map(|block| &block.candidates);
        candidates.filter(|(out, _)| *out > SPIKE * usual).fold(
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

/// What the search for spikes finds in a block of rows.
#[derive(Clone, Default)]
struct Block {
    /// of each row the fourth powers of the heights about the plane, and the squares of the distances from neighbours
    fourth: Vec<f64>,
    squares: Vec<f64>,
    /// the nodes that have all their neighbours
    count: usize,
    candidates: Vec<(f64, (usize, usize))>,
}

/// A row of scaled heights with the ones beside it, and of its nodes from `first` on that have all their `count`
/// neighbours these neighbours' sum, lowest and highest. The edges of the map are left out.
#[derive(Default)]
struct Around {
    before: Vec<f64>,
    here: Vec<f64>,
    after: Vec<f64>,
    first: usize,
    count: f64,
    neighbours: Vec<(f64, f64, f64)>,
}

impl Around {
    fn of_row(&mut self, heights: &Array2<f64>, i: usize, scale: Scale) {
        let (nx, ny) = heights.dim();
        let inside = i > 0 && i + 1 < nx;
        let rows =
            [(i.saturating_sub(1), &mut self.before), (i, &mut self.here), ((i + 1).min(nx - 1), &mut self.after)];
        for (i, row) in rows {
            row.clear();
            row.extend(flat(heights)[i * ny..][..ny].iter().map(|&h| scale.of(h)));
        }
        let Self { before, here, after, .. } = self;
        self.neighbours.clear();
        match (nx, ny) {
            // a line along y
            (1, 3..) => {
                (self.first, self.count) = (1, 2.0);
                self.neighbours.extend(here.windows(3).map(|h| gathered([h[0], h[2]])));
            }
            (_, 1) if inside => {
                (self.first, self.count) = (0, 2.0);
                self.neighbours.push(gathered([before[0], after[0]]));
            }
            (_, 3..) if inside => {
                (self.first, self.count) = (1, 8.0);
                let of = |((b, h), a): ((&[f64], &[f64]), &[f64])| {
                    gathered([b[0], b[1], b[2], a[0], a[1], a[2], h[0], h[2]])
                };
                self.neighbours.extend(before.windows(3).zip(here.windows(3)).zip(after.windows(3)).map(of));
            }
            _ => {}
        }
    }
}

/// The sum of some heights, the lowest and the highest.
fn gathered<const N: usize>(heights: [f64; N]) -> (f64, f64, f64) {
    heights.into_iter().fold((0.0, f64::INFINITY, f64::NEG_INFINITY), |(sum, low, high), h| {
        (sum + h, if h < low { h } else { low }, if h > high { h } else { high })
    })
}
