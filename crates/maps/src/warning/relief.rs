//! The relief of a surface: its figures for the warnings, from one pass over the heights.

use ndarray::Array2;

use super::extremes::Extremes;

/// Sides of fewer nodes tell nothing of tilt and edges: a few nodes may rise one after the other by chance.
const LEAST_NODES: usize = 16;

/// One of the two directions of a map: its lines are the rows for x, the columns for y. Lengths are in units of the
/// [`Relief`].
pub struct Side {
    nodes: usize,
    /// The rise of the least-squares plane over the length of the side.
    pub drop: f64,
    /// The mean height of the first line less that of the last.
    pub mean_edge: f64,
    /// The greatest difference of mean heights between neighbouring lines inside.
    pub greatest_mean_step: f64,
    /// The fall of mean height to the first line and to the last, from the lines beside them.
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
    /// From the mean heights of the lines, the mean square steps between them, and that from the last to the first.
    fn new(means: &[f64], steps: &[f64], edge: f64) -> Self {
        let n = means.len();
        let x = |i: usize| (i as f64 - 0.5 * (n as f64 - 1.0)) / n as f64;
        let squares: f64 = (0..n).map(|i| x(i) * x(i)).sum();
        let products: f64 = means.iter().enumerate().map(|(i, mean)| x(i) * mean).sum();
        let mean_steps: Vec<f64> = means.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let greatest_of = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, v| most.max(v.abs()));
        let greatest = steps.iter().copied().fold(0.0, f64::max);
        let mean_square = if steps.is_empty() { 0.0 } else { steps.iter().sum::<f64>() / steps.len() as f64 };
        Self {
            nodes: n,
            drop: if n > 1 { products / squares } else { 0.0 },
            mean_edge: means.first().zip(means.last()).map_or(0.0, |(first, last)| first - last),
            greatest_mean_step: greatest_of(&mut mean_steps.iter().copied()),
            falls: mean_steps.first().zip(mean_steps.last()).map_or([0.0; 2], |(first, last)| [*first, -last]),
            greatest_bend: greatest_of(&mut mean_steps.windows(3).map(|steps| steps[2] - steps[0])),
            edge: edge.sqrt(),
            greatest_step: greatest.sqrt(),
            rms_step: mean_square.sqrt(),
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
    /// The unit of all lengths here, in that of the heights.
    pub unit: f64,
    /// Along x and along y.
    pub sides: [Side; 2],
    /// The mean height.
    pub mean: f64,
    pub scale: Scale,
    mean_square: f64,
}

impl Relief {
    /// The relief of heights that are not flat. A row has the sums of its heights, of their squares, and of the squared
    /// steps from the row before, which of the first is the last.
    pub fn of(heights: &Array2<f64>, extremes: &Extremes) -> Self {
        let scale = Scale::new(extremes);
        let ((nx, ny), nodes) = (heights.dim(), heights.len() as f64);
        let mut rows = Vec::with_capacity(nx);
        // of each column the mean height, and the mean square of the steps to the one after, of the last to the first
        let [mut column_means, mut column_steps] = [(); 2].map(|()| vec![0.0; ny]);
        for i in 0..nx {
            let (here, before) = (heights.row(i), heights.row((i + nx - 1) % nx));
            let (last, first) = (scale.of(here[ny - 1]), scale.of(here[0]));
            let mut sums = [0.0; 3];
            let mut previous = last;
            for (j, (&h, &before)) in here.iter().zip(before).enumerate() {
                let (h, before) = (scale.of(h), scale.of(before));
                let step = h - before;
                sums = [sums[0] + h, sums[1] + h * h, sums[2] + step * step];
                column_means[j] += h;
                if j > 0 {
                    column_steps[j - 1] += (h - previous).powi(2);
                }
                previous = h;
            }
            column_steps[ny - 1] += (first - last).powi(2);
            rows.push(sums);
        }
        column_means.iter_mut().chain(&mut column_steps).for_each(|sum| *sum /= nx as f64);
        let row_means: Vec<f64> = rows.iter().map(|row| row[0] / ny as f64).collect();
        let row_steps: Vec<f64> = rows.iter().skip(1).map(|row| row[2] / ny as f64).collect();
        let squares: f64 = rows.iter().map(|row| row[1]).sum();
        let (edge, column_edge) = (rows[0][2] / ny as f64, column_steps.pop().unwrap_or_default());
        let mean = row_means.iter().sum::<f64>() / nx as f64;
        let sides = [Side::new(&row_means, &row_steps, edge), Side::new(&column_means, &column_steps, column_edge)];
        Self { unit: scale.inverse.recip(), sides, mean, scale, mean_square: squares / nodes - mean * mean }
    }

    /// Whether there is but one row, or one column, of nodes.
    pub fn is_line(&self) -> bool {
        self.sides.iter().any(|side| side.nodes == 1)
    }

    /// The rms slope between neighbours at a spacing along x and along y, from the steps that are known anyway.
    pub fn rms_slope(&self, (dx, dy): (f64, f64)) -> f64 {
        let along = |side: &Side, spacing: f64| side.rms_step * (self.unit / spacing);
        along(&self.sides[0], dx).hypot(along(&self.sides[1], dy))
    }

    /// The rms height about the least-squares plane.
    pub fn rms_about_plane(&self) -> f64 {
        let plane = self.sides[0].plane_square() + self.sides[1].plane_square();
        (self.mean_square - plane).max(0.0).sqrt()
    }
}

/// One over the unit of heights, and where they count from.
#[derive(Clone, Copy)]
pub struct Scale {
    inverse: f64,
    middle: f64,
}

impl Scale {
    fn new(extremes: &Extremes) -> Self {
        let unit = 0.5 * extremes.high - 0.5 * extremes.low;
        Self { inverse: unit.recip().min(f64::MAX), middle: 0.5 * extremes.high + 0.5 * extremes.low }
    }

    #[inline(always)]
    pub fn of(self, height: f64) -> f64 {
        (height - self.middle) * self.inverse
    }
}
