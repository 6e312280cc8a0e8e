//! The relief of a surface: its figures for the warnings, from a few passes over the heights. Sums are in `f64` and in
//! the order of the nodes, whatever the number of threads.

use ndarray::Array2;

use super::{CODES, FAR, LONE, SPIKE};
use crate::field::flat;
use crate::par;
use crate::vector::{LANES, vectorised};

/// Nodes of a chunk, rows of a block, and bands of rows at most, which a thread takes at once.
const CHUNK: usize = 1 << 14;
const BLOCK: usize = 16;
const BANDS: usize = 64;

/// Nodes that are looked at once for heights beyond all others.
const LOOK: usize = 1 << 10;

/// Sides of fewer nodes tell nothing of tilt and edges: a few nodes may rise one after the other by chance.
const LEAST_NODES: usize = 16;

/// The lowest and the highest of no heights.
const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// The lowest and the highest of the heights that are not missing, their counts, and the range of all others.
#[derive(Clone, Copy)]
pub struct Extremes {
    pub low: f64,
    pub high: f64,
    pub low_count: usize,
    pub high_count: usize,
    /// The lowest and the highest of the other heights; ∞ and −∞ if there are none.
    pub rest: (f64, f64),
}

/// The lowest of some values, how often it is there, and the lowest of the others.
#[derive(Clone, Copy)]
struct End {
    value: f64,
    count: usize,
    next: f64,
}

impl End {
    const NONE: Self = Self { value: f64::INFINITY, count: 0, next: f64::INFINITY };

    /// That of one more value, which is there so often.
    fn with(self, value: f64, count: usize) -> Self {
        if value < self.value {
            Self { value, count, next: self.value }
        } else if value == self.value {
            Self { count: self.count + count, ..self }
        } else if value < self.next {
            Self { next: value, ..self }
        } else {
            self
        }
    }

    /// That of the values of both.
    fn join(self, other: Self) -> Self {
        self.with(other.value, other.count).with(other.next, 0)
    }

    /// Those of some heights of this range and of the heights with their signs changed, the missing ones left out.
    fn of(heights: &[f64], (lowest, highest): (f64, f64)) -> [Self; 2] {
        let bounded = lowest.is_finite() && highest.is_finite();
        let (whole, rest) = if bounded { heights.as_chunks::<LANES>() } else { (&[][..], heights) };
        let mut ends = [(lowest, 1.0), (highest, -1.0)].map(|(end, sign)| {
            let (mut count, mut next) = ([0.0; LANES], [f64::INFINITY; LANES]);
            let (counts, nexts) = (&mut count, &mut next);
            vectorised(
                #[inline(always)]
                move || {
                    let (mut count, mut next) = ([0.0; LANES], [f64::INFINITY; LANES]);
                    for heights in whole {
                        for l in 0..LANES {
                            let value = sign * heights[l];
                            count[l] += if heights[l] == end { 1.0 } else { 0.0 };
                            let value = if heights[l] == end { f64::INFINITY } else { value };
                            next[l] = if value < next[l] { value } else { next[l] };
                        }
                    }
                    (*counts, *nexts) = (count, next);
                },
            );
            let count = count.iter().sum::<f64>() as usize;
            Self {
                value: if bounded { sign * end } else { f64::INFINITY },
                count,
                next: next.into_iter().fold(f64::INFINITY, f64::min),
            }
        });
        for &h in rest.iter().filter(|h| h.is_finite()) {
            ends = [ends[0].with(h, 1), ends[1].with(-h, 1)];
        }
        ends
    }
}

impl Extremes {
    pub fn of(heights: &Array2<f64>) -> Self {
        let none = [End::NONE; 2];
        let mut ends = vec![none; heights.len().div_ceil(CHUNK)];
        par::update(par::chunks(flat(heights), CHUNK), &mut ends, |_, chunk, ends| {
            for heights in chunk.chunks(LOOK) {
                let ([low, high], (lowest, highest)) = (*ends, range(heights));
                // most heights are within those that were there before
                if lowest < low.next || -highest < high.next {
                    let [least, greatest] = End::of(heights, (lowest, highest));
                    *ends = [low.join(least), high.join(greatest)];
                }
            }
        });
        let [low, high] = ends.into_iter().fold(none, |[low, high], [a, b]| [low.join(a), high.join(b)]);
        // of two levels nothing is left
        let rest = if low.next < -high.value { (low.next, -high.next) } else { NOTHING };
        Self { low: low.value, high: -high.value, low_count: low.count, high_count: high.count, rest }
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
    /// NaN where there are no spikes.
    pub kurtosis: f64,
    mean_square: f64,
}

impl Relief {
    /// The relief of heights that are not flat.
    pub fn of(heights: &Array2<f64>, extremes: &Extremes) -> Self {
        let scale = Scale::new(extremes);
        let ((nx, ny), nodes, all) = (heights.dim(), heights.len() as f64, flat(heights));
        let rows_of_band = nx.div_ceil(BANDS).max(BLOCK);
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
        let mut relief = Self {
            unit: scale.inverse.recip(),
            sides,
            spikes: Spikes::default(),
            kurtosis: f64::NAN,
            mean_square: squares / nodes - mean * mean,
        };
        // from each neighbour a spike differs by more than half of its distance from their mean
        let greatest = rows.iter().fold(0.0, |greatest: f64, row| greatest.max(row[3]));
        if nx == 1 || greatest > (1.0 - 1.0 / LONE) * relief.rms_about_plane() {
            relief.look_for_spikes(heights, mean, scale);
        }
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
    fn look_for_spikes(&mut self, heights: &Array2<f64>, mean: f64, scale: Scale) {
        let rms = self.rms_about_plane();
        let (nx, ny) = heights.dim();
        let slope = [self.sides[0].drop / nx as f64, self.sides[1].drop / ny as f64];
        let centre = [0.5 * (nx as f64 - 1.0), 0.5 * (ny as f64 - 1.0)];
        let mut blocks = vec![Block::default(); nx.div_ceil(BLOCK)];
        par::update(par::chunks(flat(heights), BLOCK * ny), &mut blocks, |block, within, found| {
            let mut around = Around::default();
            for i in (0..within.len() / ny).map(|i| block * BLOCK + i) {
                around.of_row(heights, i, scale);
                let fourth = |(j, h): (usize, &f64)| {
                    let plane = mean + slope[0] * (i as f64 - centre[0]) + slope[1] * (j as f64 - centre[1]);
                    ((h - plane) / rms).powi(4)
                };
                found.fourth.push(around.here.iter().enumerate().map(fourth).sum());
                let mut squares = 0.0;
                for (k, (&(sum, low, high), &h)) in
                    around.neighbours.iter().zip(&around.here[around.first..]).enumerate()
                {
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
        self.kurtosis = total(|block| &block.fourth) / heights.len() as f64;
        let count: usize = blocks.iter().map(|block| block.count).sum();
        let usual = f64::sqrt(total(|block| &block.squares) / count as f64);
        let candidates = blocks.iter().flat_map(|block| &block.candidates);
        for &(out, node) in candidates.filter(|(out, _)| *out > SPIKE * usual) {
            self.spikes.count += 1;
            if out > self.spikes.farthest {
                (self.spikes.farthest, self.spikes.node) = (out, node);
            }
        }
    }
}

/// One over the unit of heights, and where they count from.
#[derive(Clone, Copy)]
struct Scale {
    inverse: f64,
    middle: f64,
}

impl Scale {
    fn new(extremes: &Extremes) -> Self {
        let unit = 0.5 * extremes.high - 0.5 * extremes.low;
        Self { inverse: unit.recip().min(f64::MAX), middle: 0.5 * extremes.high + 0.5 * extremes.low }
    }

    #[inline(always)]
    fn of(self, height: f64) -> f64 {
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

/// The lowest and the highest of some heights, the missing ones left out.
fn range(heights: &[f64]) -> (f64, f64) {
    let (whole, rest) = heights.as_chunks::<LANES>();
    let (mut low, mut high) = ([NOTHING.0; LANES], [NOTHING.1; LANES]);
    let (lows, highs) = (&mut low, &mut high);
    vectorised(
        #[inline(always)]
        move || {
            let (mut low, mut high) = ([NOTHING.0; LANES], [NOTHING.1; LANES]);
            for heights in whole {
                for l in 0..LANES {
                    low[l] = if heights[l] < low[l] { heights[l] } else { low[l] };
                    high[l] = if heights[l] > high[l] { heights[l] } else { high[l] };
                }
            }
            (*lows, *highs) = (low, high);
        },
    );
    let (low, high) = (low.into_iter().chain(rest.iter().copied()), high.into_iter().chain(rest.iter().copied()));
    (low.fold(NOTHING.0, f64::min), high.fold(NOTHING.1, f64::max))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_those_of_the_sorted_heights() {
        // few levels, so that the extremes are repeated, and the range of a look is that of another one
        let level = |i: usize| ((i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) % 97;
        let bowl = |i: usize| if (3000..3500).contains(&i) { -1.0 } else { level(i) as f64 };
        let infinite =
            |i: usize| [bowl(i), f64::NAN, f64::INFINITY, f64::NEG_INFINITY][(level(i) as usize / 24).min(3)];
        let flat = |_| 2.0;
        let maps: [&dyn Fn(usize) -> f64; 4] = [&|i| level(i) as f64, &bowl, &infinite, &flat];
        for of in maps {
            for shape in [(1, 1), (3, 5), (40, 50), (150, 133)] {
                let heights = Array2::from_shape_fn(shape, |(i, j)| of(i * shape.1 + j));
                let mut sorted: Vec<f64> = heights.iter().copied().filter(|h| h.is_finite()).collect();
                sorted.sort_by(f64::total_cmp);
                let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { continue };
                let count = |value: f64| sorted.iter().filter(|&&h| h == value).count();
                let rest: Vec<f64> = sorted.iter().copied().filter(|&h| h != low && h != high).collect();
                let found = Extremes::of(&heights);
                assert_eq!(
                    (found.low, found.low_count, found.high, found.high_count),
                    (low, count(low), high, count(high))
                );
                let expected = rest.first().map_or(NOTHING, |&first| (first, rest[rest.len() - 1]));
                assert_eq!(found.rest, expected, "{shape:?}");
            }
        }
    }
}
