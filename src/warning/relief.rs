//! The relief of a surface: its figures for the warnings, from a few passes over the heights. Sums are in `f64` and in
//! the order of the nodes, whatever the number of threads.

use ndarray::Array2;

use super::extremes::Extremes;
use crate::field::flat;
use crate::par;
use crate::vector::{LANES, vectorised};

/// Bands of rows at most, and rows of a band at least, which a thread takes at once.
const BANDS: usize = 64;
const LEAST_ROWS: usize = 16;

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
    /// The greatest step between neighbours along x.
    pub greatest_single_step: f64,
    pub scale: Scale,
    mean_square: f64,
}

impl Relief {
    /// The relief of heights that are not flat.
    pub fn of(heights: &Array2<f64>, extremes: &Extremes) -> Self {
        let scale = Scale::new(extremes);
        let ((nx, ny), nodes, all) = (heights.dim(), heights.len() as f64, flat(heights));
        let rows_of_band = nx.div_ceil(BANDS).max(LEAST_ROWS);
        let mut bands = vec![Band::default(); nx.div_ceil(rows_of_band)];
        par::update(par::chunks(all, rows_of_band * ny), &mut bands, |band, within, found| {
            let before = (band * rows_of_band + nx - 1) % nx;
            *found = Band::of(within, &all[before * ny..][..ny], scale);
        });
        let rows: Vec<[f64; 4]> = bands.iter().flat_map(|band| band.rows.iter().copied()).collect();
        let column = |of: fn(&Band) -> &Vec<f64>| {
            let mut sums = vec![0.0; ny];
            for band in &bands {
                sums.iter_mut().zip(of(band)).for_each(|(sum, part)| *sum += part);
            }
            sums.iter_mut().for_each(|sum| *sum /= nx as f64);
            sums
        };
        let (column_means, mut column_steps) = (column(|band| &band.sums), column(|band| &band.steps));
        let row_means: Vec<f64> = rows.iter().map(|row| row[0] / ny as f64).collect();
        let row_steps: Vec<f64> = rows.iter().skip(1).map(|row| row[2] / ny as f64).collect();
        let squares: f64 = rows.iter().map(|row| row[1]).sum();
        let (edge, column_edge) = (rows[0][2] / ny as f64, column_steps.pop().unwrap_or_default());
        let mean = row_means.iter().sum::<f64>() / nx as f64;
        let sides = [Side::new(&row_means, &row_steps, edge), Side::new(&column_means, &column_steps, column_edge)];
        Self {
            unit: scale.inverse.recip(),
            sides,
            mean,
            greatest_single_step: rows.iter().fold(0.0, |greatest: f64, row| greatest.max(row[3])),
            scale,
            mean_square: squares / nodes - mean * mean,
        }
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

/// The sums over a band of rows.
#[derive(Clone, Default)]
struct Band {
    /// of each row the sums of the heights, of their squares, and of the squared steps from the row before, which of
    /// the first is the last; and the greatest step
    rows: Vec<[f64; 4]>,
    /// of each column the sum of the heights, and of the squared steps to the one after, of the last to the first
    sums: Vec<f64>,
    steps: Vec<f64>,
}

impl Band {
    /// That of some rows after the one before them.
    fn of<'a>(rows: &'a [f64], mut before: &'a [f64], scale: Scale) -> Self {
        let ny = before.len();
        let [mut sums, mut steps] = [(); 2].map(|()| vec![0.0; ny]);
        let across = |row| across(row, std::mem::replace(&mut before, row), scale, [&mut sums, &mut steps]);
        let rows = rows.chunks(ny).map(across).collect();
        Self { rows, sums, steps }
    }
}

/// What a row adds to its band: its own sums, and those of each column.
fn across(row: &[f64], before: &[f64], scale: Scale, [sums, steps]: [&mut [f64]; 2]) -> [f64; 4] {
    let ny = row.len();
    let whole = (ny - 1) / LANES * LANES;
    let mut lanes = [[0.0; LANES]; 4];
    let (total, column_sums, column_steps) = (&mut lanes, &mut sums[..whole], &mut steps[..whole]);
    vectorised(
        #[inline(always)]
        move || {
            let [mut sum, mut squares, mut steps, mut greatest] = [[0.0; LANES]; 4];
            let columns =
                column_sums.as_chunks_mut::<LANES>().0.iter_mut().zip(column_steps.as_chunks_mut::<LANES>().0);
            let heights = row.as_chunks::<LANES>().0.iter().zip(row[1..].as_chunks::<LANES>().0);
            let heights = heights.zip(before.as_chunks::<LANES>().0);
            for ((column_sums, column_steps), ((here, after), before)) in columns.zip(heights) {
                let [mut h, mut step, mut along] = [[0.0; LANES]; 3];
                for l in 0..LANES {
                    h[l] = scale.of(here[l]);
                    step[l] = h[l] - scale.of(before[l]);
                    along[l] = scale.of(after[l]) - h[l];
                }
                for l in 0..LANES {
                    sum[l] += h[l];
                    squares[l] += h[l] * h[l];
                }
                for l in 0..LANES {
                    steps[l] += step[l] * step[l];
                    greatest[l] = if step[l].abs() > greatest[l] { step[l].abs() } else { greatest[l] };
                }
                // in two loops: the sums may be one in memory, as far as a compiler can tell
                for l in 0..LANES {
                    column_sums[l] += h[l];
                }
                for l in 0..LANES {
                    column_steps[l] += along[l] * along[l];
                }
            }
            *total = [sum, squares, steps, greatest];
        },
    );
    let [sum, squares, row_steps, greatest] = lanes;
    let mut found = [sum, squares, row_steps].map(|lanes| lanes.iter().sum::<f64>());
    let mut greatest = greatest.into_iter().fold(0.0, f64::max);
    for j in whole..ny {
        let [h, after, before] = [row[j], row[(j + 1) % ny], before[j]].map(|h| scale.of(h));
        let step = h - before;
        found = [found[0] + h, found[1] + h * h, found[2] + step * step];
        greatest = f64::max(greatest, step.abs());
        sums[j] += h;
        steps[j] += (after - h) * (after - h);
    }
    [found[0], found[1], found[2], greatest]
}
