//! The relief of a surface: its figures for the warnings.

use asperity::along_sides;
use asperity::surface::squared_steps;
use ndarray::{Array2, ArrayView2, Axis};

use super::extremes::Extremes;

/// Sides of fewer nodes tell nothing of tilt and edges: a few nodes may rise one after the other by chance.
const LEAST_NODES: usize = 16;

/// One of the two directions of a map: its lines are the rows for x, the columns for y. Lengths are in units of the
/// [`Relief`].
pub struct Side {
    nodes: usize,
    /// The rise of the least-squares plane over the length of the side.
    pub drop: f64,
    /// The mean height of the first line less the mean of the last.
    pub mean_edge: f64,
    /// The greatest difference of mean heights between neighbouring lines inside.
    pub greatest_mean_step: f64,
    /// The fall of mean height to the first line and to the last, from the lines next to them.
    pub falls: [f64; 2],
    /// The greatest difference between the mean steps before and after a step inside: the edge, across which the falls
    /// meet, is such a place.
    pub greatest_bend: f64,
    /// The rms step from the last line to the first.
    pub edge: f64,
    /// The greatest rms step between neighbouring lines inside.
    pub greatest_step: f64,
    /// The rms step between neighbours inside, over all lines.
    pub rms_step: f64,
}

impl Side {
    fn along(axis: Axis, heights: ArrayView2<'_, f64>) -> Self {
        let (n, across) = (heights.len_of(axis), Axis(1 - axis.index()));
        let means = heights.mean_axis(across).unwrap_or_default();
        // the mean square of the steps from each line of a range to another one
        let squares = |from: [usize; 2], to: [usize; 2]| {
            let [from, to] = [from, to].map(|[first, end]| heights.slice_axis(axis, (first..end).into()));
            squared_steps(from, to, axis) / heights.len_of(across) as f64
        };
        let steps = squares([0, n - 1], [1, n]);
        let mean_steps: Vec<f64> = means.windows(2).into_iter().map(|pair| pair[1] - pair[0]).collect();
        let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, v| most.max(v.abs()));
        let x = |i: usize| (i as f64 - 0.5 * (n as f64 - 1.0)) / n as f64;
        let products: f64 = means.iter().enumerate().map(|(i, mean)| x(i) * mean).sum();
        let moment: f64 = (0..n).map(|i| x(i) * x(i)).sum();
        Self {
            nodes: n,
            drop: if n > 1 { products / moment } else { 0.0 },
            mean_edge: means[0] - means[n - 1],
            greatest_mean_step: greatest(&mut mean_steps.iter().copied()),
            falls: mean_steps.first().zip(mean_steps.last()).map_or([0.0; 2], |(first, last)| [*first, -last]),
            greatest_bend: greatest(&mut mean_steps.windows(3).map(|steps| steps[2] - steps[0])),
            edge: squares([n - 1, n], [0, 1]).sum().sqrt(),
            greatest_step: greatest(&mut steps.iter().copied()).sqrt(),
            rms_step: steps.mean().unwrap_or_default().sqrt(),
        }
    }

    /// Whether the side has enough nodes for a statement on tilt and edges.
    pub fn tells(&self) -> bool {
        self.nodes >= LEAST_NODES
    }

    /// The mean square of the plane's rise about its middle.
    fn plane_square(&self) -> f64 {
        let n = self.nodes as f64;
        self.drop * self.drop * (1.0 - 1.0 / (n * n)) / 12.0
    }
}

/// Heights about the middle between the lowest and the highest, in units of half of their distance: so no square
/// leaves the range of `f64`.
pub struct Relief {
    /// The unit of all lengths here, in the unit of the heights.
    pub unit: f64,
    pub heights: Array2<f64>,
    /// Along x and along y.
    pub sides: [Side; 2],
    /// The mean height.
    pub mean: f64,
    /// The rms height about the least-squares plane.
    pub rms: f64,
}

impl Relief {
    /// The relief of heights that are not flat.
    pub fn measure(heights: &Array2<f64>, extremes: &Extremes) -> Self {
        let middle = 0.5 * extremes.high + 0.5 * extremes.low;
        let inverse = (0.5 * extremes.high - 0.5 * extremes.low).recip().min(f64::MAX);
        let heights = heights.mapv(|h| (h - middle) * inverse);
        let sides = along_sides(heights.len(), |axis| Side::along(Axis(axis), heights.view()));
        let mean = heights.mean().unwrap_or_default();
        let square = heights.fold(0.0, |sum, h| sum + h * h) / heights.len() as f64;
        let plane: f64 = sides.iter().map(Side::plane_square).sum();
        let rms = (square - mean * mean - plane).max(0.0).sqrt();
        Self { unit: inverse.recip(), heights, sides, mean, rms }
    }

    /// The rms slope between neighbours at a spacing along x and along y, from the steps that are known anyway.
    pub fn rms_slope(&self, (dx, dy): (f64, f64)) -> f64 {
        let along = |side: &Side, spacing: f64| side.rms_step * (self.unit / spacing);
        along(&self.sides[0], dx).hypot(along(&self.sides[1], dy))
    }
}
