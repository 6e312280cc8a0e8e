//! The relief of a surface: its figures for the warnings, from a few passes over the heights. Sums are in `f64` and in
//! the order of the nodes, whatever the number of threads.

use ndarray::{Array2, ArrayView1};

use super::{CODES, FAR, LONE, SPIKE};

/// Sides of fewer nodes tell nothing of tilt and edges: a few nodes may rise one after the other by chance.
const LEAST_NODES: usize = 16;

/// The lowest and the highest of the heights that are not missing, their counts, and the range of all others.
pub struct Extremes {
    pub low: f64,
    pub high: f64,
    pub low_count: usize,
    pub high_count: usize,
    /// The lowest and the highest of the other heights; ∞ and −∞ if there are none.
    pub rest: (f64, f64),
}

impl Extremes {
    pub fn of(heights: &Array2<f64>) -> Self {
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        let known = || heights.iter().filter(|h| h.is_finite());
        let (low, high) = known().fold((low, high), |(low, high), &h| (low.min(h), high.max(h)));
        let mut found = Self { low, high, low_count: 0, high_count: 0, rest: (f64::INFINITY, f64::NEG_INFINITY) };
        for &h in known() {
            if h == low {
                found.low_count += 1;
            } else if h == high {
                found.high_count += 1;
            } else {
                found.rest = (found.rest.0.min(h), found.rest.1.max(h));
            }
        }
        found
    }

    /// The highest less the lowest height; infinite if the difference is beyond `f64`.
    pub fn span(&self) -> f64 {
        self.high - self.low
    }

    /// The extreme values that stand for missing points, and at how many nodes.
    pub fn codes(&self) -> Vec<(f64, usize)> {
        let ends = [(self.low, self.low_count), (self.high, self.high_count)];
        ends.into_iter().filter(|&(value, count)| self.is_code(value, count)).collect()
    }

    /// Whether an extreme value stands for missing points: far outside the rest, and repeated or well known.
    fn is_code(&self, value: f64, count: usize) -> bool {
        let (low, high) = self.rest;
        let (span, distance) = (high - low, (low - value).max(value - high));
        // of two or three levels none is a code
        span > 0.0 && distance > FAR * span && (count > 1 || CODES.contains(&value))
    }
}

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
        let mean_steps = means.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let greatest = steps.iter().copied().fold(0.0, f64::max);
        let mean_square = if steps.is_empty() { 0.0 } else { steps.iter().sum::<f64>() / steps.len() as f64 };
        Self {
            nodes: n,
            drop: if n > 1 { products / squares } else { 0.0 },
            mean_edge: means.first().zip(means.last()).map_or(0.0, |(first, last)| first - last),
            greatest_mean_step: mean_steps.fold(0.0, f64::max),
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

/// Single nodes that are far above or below their neighbours.
#[derive(Default)]
pub struct Spikes {
    pub count: usize,
    pub farthest: f64,
    pub node: (usize, usize),
}

/// Heights about the middle between the lowest and the highest, in units of half of their distance: so no square
/// leaves the range of `f64`.
pub struct Relief {
    /// The unit of all lengths here, in that of the heights.
    pub unit: f64,
    /// Along x and along y.
    pub sides: [Side; 2],
    pub spikes: Spikes,
    pub kurtosis: f64,
    mean_square: f64,
}

impl Relief {
    /// The relief of heights that are not flat.
    pub fn of(heights: &Array2<f64>, extremes: &Extremes) -> Self {
        let unit = 0.5 * extremes.high - 0.5 * extremes.low;
        let middle = 0.5 * extremes.high + 0.5 * extremes.low;
        let scaled = |row: ArrayView1<'_, f64>, into: &mut Vec<f64>| {
            into.clear();
            into.extend(row.iter().map(|h| (h - middle) / unit));
        };
        let ((nx, ny), nodes) = (heights.dim(), heights.len() as f64);
        let (mut row_means, mut row_steps) = (Vec::with_capacity(nx), Vec::with_capacity(nx));
        let (mut column_means, mut column_steps) = (vec![0.0; ny], vec![0.0; ny]);
        let mut squares = 0.0;
        let [mut first, mut before, mut here] = [const { Vec::new() }; 3];
        for (i, row) in heights.rows().into_iter().enumerate() {
            scaled(row, &mut here);
            row_means.push(here.iter().sum::<f64>() / ny as f64);
            squares += here.iter().map(|h| h * h).sum::<f64>();
            column_means.iter_mut().zip(&here).for_each(|(mean, h)| *mean += h / nx as f64);
            // the last is the step across the edge
            let after = here.iter().skip(1).chain(here.first());
            let steps = here.iter().zip(after).map(|(h, after)| (after - h).powi(2) / nx as f64);
            column_steps.iter_mut().zip(steps).for_each(|(sum, step)| *sum += step);
            if i == 0 {
                first.clone_from(&here);
            } else {
                row_steps.push(mean_square_step(&before, &here));
            }
            std::mem::swap(&mut before, &mut here);
        }
        let edge = mean_square_step(&before, &first);
        let column_edge = column_steps.pop().unwrap_or_default();
        let mean = row_means.iter().sum::<f64>() / nx as f64;
        let sides = [Side::new(&row_means, &row_steps, edge), Side::new(&column_means, &column_steps, column_edge)];
        let mut relief = Self {
            unit,
            sides,
            spikes: Spikes::default(),
            kurtosis: f64::NAN,
            mean_square: squares / nodes - mean * mean,
        };
        relief.look_for_spikes(heights, mean, &scaled);
        relief
    }

    /// Whether there is but one row, or one column, of nodes.
    pub fn is_line(&self) -> bool {
        self.sides.iter().any(|side| side.nodes == 1)
    }

    /// The rms height about the least-squares plane.
    pub fn rms_about_plane(&self) -> f64 {
        let plane = self.sides[0].plane_square() + self.sides[1].plane_square();
        (self.mean_square - plane).max(0.0).sqrt()
    }

    /// Counts the spikes: nodes whose distance from the mean of their eight neighbours (two on a line) exceeds the rms
    /// height about the plane, [`SPIKE`] times the rms of this distance, and [`LONE`] times the range of the
    /// neighbours. The edges of the map are left out.
    fn look_for_spikes(
        &mut self,
        heights: &Array2<f64>,
        mean: f64,
        scaled: &impl Fn(ArrayView1<'_, f64>, &mut Vec<f64>),
    ) {
        let rms = self.rms_about_plane();
        let mut fourth = 0.0;
        let mut squares = 0.0;
        let mut count = 0.0;
        let mut candidates = Vec::new();
        let (nx, ny) = heights.dim();
        let slope = [self.sides[0].drop / nx as f64, self.sides[1].drop / ny as f64];
        let centre = [0.5 * (nx as f64 - 1.0), 0.5 * (ny as f64 - 1.0)];
        for_each_three(heights, scaled, |i, rows| {
            let (mut row_squares, mut row_fourth) = (0.0, 0.0);
            for (j, h) in rows[1].iter().enumerate() {
                let plane = mean + slope[0] * (i as f64 - centre[0]) + slope[1] * (j as f64 - centre[1]);
                row_fourth += ((h - plane) / rms).powi(4);
                let Some((around, range)) = neighbours(rows, j) else { continue };
                let out = (h - around).abs();
                row_squares += out * out;
                count += 1.0;
                if out > LONE * range && out > rms {
                    candidates.push((out, (i, j)));
                }
            }
            squares += row_squares;
            fourth += row_fourth;
        });
        self.kurtosis = fourth / heights.len() as f64;
        let usual = f64::sqrt(squares / count);
        for (out, node) in candidates.into_iter().filter(|(out, _)| *out > SPIKE * usual) {
            self.spikes.count += 1;
            if out > self.spikes.farthest {
                (self.spikes.farthest, self.spikes.node) = (out, node);
            }
        }
    }
}

fn mean_square_step(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| (b - a).powi(2)).sum::<f64>() / from.len() as f64
}

/// Hands out each row with the one before and the one after it, which are empty at the edges of the map.
fn for_each_three(
    heights: &Array2<f64>,
    scaled: impl Fn(ArrayView1<'_, f64>, &mut Vec<f64>),
    mut f: impl FnMut(usize, &[Vec<f64>; 3]),
) {
    let nx = heights.nrows();
    let mut rows = [const { Vec::new() }; 3];
    scaled(heights.row(0), &mut rows[2]);
    for i in 0..nx {
        rows.rotate_left(1);
        if i + 1 < nx {
            scaled(heights.row(i + 1), &mut rows[2]);
        } else {
            rows[2].clear();
        }
        f(i, &rows);
    }
}

/// The mean of the neighbours of a node, and their highest less their lowest; nothing at the edges of the map.
fn neighbours(rows: &[Vec<f64>; 3], j: usize) -> Option<(f64, f64)> {
    let [before, here, after] = rows;
    let (mut sum, mut count, mut low, mut high) = (0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY);
    let mut add = |h: f64| {
        sum += h;
        count += 1.0;
        low = low.min(h);
        high = high.max(h);
    };
    match (before.get(j), after.get(j)) {
        // a line along y
        (None, None) => [j.checked_sub(1), Some(j + 1)].into_iter().try_for_each(|j| here.get(j?).map(|h| add(*h)))?,
        (before, after) if here.len() == 1 => {
            add(*before?);
            add(*after?);
        }
        (Some(_), Some(_)) => {
            let around = j.checked_sub(1)?..j + 2;
            before.get(around.clone())?.iter().chain(after.get(around)?).for_each(|h| add(*h));
            add(here[j - 1]);
            add(here[j + 1]);
        }
        _ => return None,
    }
    Some((sum / count, high - low))
}
