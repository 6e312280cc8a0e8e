//! Missing heights, filled by a membrane: the discrete Laplace equation, solved by multigrid.

use ndarray::{Array2, Axis, Slice};

use asperity::surface::mean_of_finite;
use asperity::{Error, Grid, Result, Surface};

use super::Topography;

/// The number of a neighbour beyond the edge of the map.
const NONE: usize = usize::MAX;
/// The relative residual at which the solve ends, in the norm of the preconditioner, if cells are square.
const ACCURACY: f64 = 1e-12;
/// The factor of coarse corrections. Values that are constant on the points of a coarser level have steps between
/// these, which make the energy of slopes twice too large and the correction too small; 1.8 is best by experience (D.
/// Braess, Computing 55, 1995).
const OVERCORRECTION: f64 = 1.8;

/// Fills missing heights, NaN or infinite, with a membrane that spans the hole from its edge. `spacing` is (Δx, Δy).
///
/// The heights of the membrane obey the discrete Laplace equation
///
/// ```math
/// (h(i+1, j) − 2h(i, j) + h(i−1, j))/Δx² + (h(i, j+1) − 2h(i, j) + h(i, j−1))/Δy² = 0
/// ```
///
/// at every missing point, without the terms of neighbours that are beyond the edge of the map, which is not taken
/// as periodic. There is one solution for any pattern of holes. It lies between the least and the greatest height
/// around each hole: there are no new peaks, nor the roughness that was there. Measured heights stay as they are.
/// A plane fills its own holes, but not at the edge of the map: remove a tilt first.
///
/// By conjugate gradients, preconditioned by multigrid cycles, to a residual of 1e-12, and to a smaller one by as much
/// as cells are longer than wide: the slopes along their longer side have so small a part in it.
///
/// ```
/// use asperity_maps::fill;
/// let heights = ndarray::array![[1.0, 2.0, 3.0], [2.0, f64::NAN, 4.0], [3.0, 4.0, 5.0]];
/// assert_eq!(fill(heights, (1.0, 1.0))?[[1, 1]], 3.0);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Value`] if all heights are missing.
pub fn fill(mut heights: Array2<f64>, spacing: (f64, f64)) -> Result<Array2<f64>> {
    let mean = mean_of_finite(&heights);
    if !mean.is_finite() {
        let requirement = "at least 1: there is nothing to fill from";
        return Err(Error::Value { name: "number of measured heights", value: 0.0, requirement });
    }
    let weights = weights(spacing);
    let (levels, right) = Level::hierarchy(&heights, weights, mean);
    let (values, _) = solve(&levels, &right, weights);
    for (node, value) in levels[0].nodes.iter().zip(values) {
        heights[*node] = mean + value;
    }
    Ok(heights)
}

/// A surface from heights: NaN are [absent nodes](Surface::with_absent), with the heights of [`fill()`] there.
///
/// # Errors
/// As [`Surface::new`] and [`Surface::with_absent`].
pub fn surface_with_absent(grid: Grid, mut heights: Array2<f64>) -> Result<Surface> {
    let absent = heights.mapv(f64::is_nan);
    heights.mapv_inplace(|height| if height.is_nan() { 0.0 } else { height });
    let level = Surface::new(grid, heights)?.with_absent(absent)?;
    let Some(absent) = level.absent().cloned() else { return Ok(level) };
    // holes are filled as on the whole map, by every process
    let filled = Topography::from(level.whole().into_owned()).fill()?.heights;
    let held = filled.slice_axis(Axis(0), Slice::from(grid.rows())).to_owned();
    Surface::new(grid, held)?.with_absent(absent)
}

/// The weights of neighbours along x and y, the greater one 1.
fn weights((dx, dy): (f64, f64)) -> (f64, f64) {
    // relative, so that no unit leaves the range of `f64`; and bounded, as Ly has no meaning on a line
    let ratio = (dx / dy).powi(2).clamp(1e-12, 1e12);
    if ratio <= 1.0 { (1.0, ratio) } else { (1.0 / ratio, 1.0) }
}

/// A level of the multigrid: the equation Σ w (h − h') = 0 at each of its points, the sum over the neighbours h'. On
/// the finest level this is the Laplace equation at missing points. A point of a coarser level stands for up to 2 × 2
/// of the finer, or for 4 along the stronger links, and its equation is Galerkin's, for values that are the same on all
/// of these.
struct Level {
    nodes: Vec<(usize, usize)>,
    /// the missing neighbours of each point, and their weights
    neighbours: Vec<[usize; 4]>,
    links: Vec<[f64; 4]>,
    /// the sum of the weights of known neighbours, for each point
    known: Vec<f64>,
    /// the sum of all weights
    diagonal: Vec<f64>,
    /// for each point, the point of the next level that contains it
    parents: Vec<usize>,
}

impl Level {
    fn new(nodes: Vec<(usize, usize)>) -> Self {
        let n = nodes.len();
        let [known, diagonal] = [vec![0.0; n], vec![0.0; n]];
        Self { nodes, neighbours: vec![[NONE; 4]; n], links: vec![[0.0; 4]; n], known, diagonal, parents: Vec::new() }
    }

    /// All levels, down to one without neighbours, and the right-hand side of the finest: the weighted sum of the known
    /// neighbours, about the mean.
    fn hierarchy(heights: &Array2<f64>, (along_x, along_y): (f64, f64), mean: f64) -> (Vec<Self>, Vec<f64>) {
        let (nx, ny) = heights.dim();
        let missing = heights.indexed_iter().filter(|(_, h)| !h.is_finite()).map(|(node, _)| node);
        let (index, nodes) = numbered((nx, ny), missing);
        let mut finest = Self::new(nodes);
        let mut right = vec![0.0; finest.nodes.len()];
        for (k, &(i, j)) in finest.nodes.iter().enumerate() {
            let around = [
                (i + 1 < nx).then(|| (i + 1, j)),
                (i > 0).then(|| (i - 1, j)),
                (j + 1 < ny).then(|| (i, j + 1)),
                (j > 0).then(|| (i, j - 1)),
            ];
            for (side, node) in around.into_iter().enumerate() {
                let (Some(node), weight) = (node, if side < 2 { along_x } else { along_y }) else { continue };
                if index[node] == NONE {
                    finest.known[k] += weight;
                    right[k] += weight * (heights[node] - mean);
                } else {
                    finest.neighbours[k][side] = index[node];
                    finest.links[k][side] = weight;
                }
            }
        }
        drop(index);
        finest.complete();
        let mut levels = vec![finest];
        while let Some(coarser) = levels.last_mut().and_then(Self::coarser) {
            levels.push(coarser);
        }
        (levels, right)
    }

    fn complete(&mut self) {
        for ((diagonal, known), links) in self.diagonal.iter_mut().zip(&self.known).zip(&self.links) {
            *diagonal = known + links.iter().sum::<f64>();
        }
    }

    /// The next level, if there are neighbours to be taken together.
    fn coarser(&mut self) -> Option<Self> {
        if self.neighbours.iter().flatten().all(|near| *near == NONE) {
            return None;
        }
        // along links that are much weaker nothing is smooth yet
        let [x, y] =
            [0..2, 2..4].map(|sides| self.links.iter().flat_map(|l| &l[sides.clone()]).copied().fold(0.0, f64::max));
        let (by_x, by_y) = if y > 4.0 * x {
            (1, 4)
        } else if x > 4.0 * y {
            (4, 1)
        } else {
            (2, 2)
        };
        let parent = |&(i, j): &(usize, usize)| (i / by_x, j / by_y);
        let shape = self.nodes.iter().map(parent).fold((0, 0), |(nx, ny), (i, j)| (nx.max(i + 1), ny.max(j + 1)));
        let (index, nodes) = numbered(shape, self.nodes.iter().map(parent));
        self.parents = self.nodes.iter().map(|node| index[parent(node)]).collect();
        let mut coarser = Self::new(nodes);
        for (k, &parent) in self.parents.iter().enumerate() {
            coarser.known[parent] += self.known[k];
            for side in 0..4 {
                let near = self.neighbours[k][side];
                // a link within the point is no difference
                if near != NONE && self.parents[near] != parent {
                    coarser.neighbours[parent][side] = self.parents[near];
                    coarser.links[parent][side] += self.links[k][side];
                }
            }
        }
        coarser.complete();
        Some(coarser)
    }

    /// The weighted sum of a function of the values x at the missing neighbours of a point.
    fn pull(&self, x: &[f64], k: usize, of: impl Fn(f64) -> f64) -> f64 {
        let near = self.neighbours[k].iter().zip(&self.links[k]).filter(|(near, _)| **near != NONE);
        near.map(|(near, link)| link * of(x[*near])).sum()
    }

    /// By differences: weak links keep their digits next to strong ones.
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        y.iter_mut().enumerate().for_each(|(k, y)| *y = self.known[k] * x[k] + self.pull(x, k, |near| x[k] - near));
    }

    fn relax(&self, right: &[f64], x: &mut [f64], points: impl Iterator<Item = usize>) {
        points.for_each(|k| x[k] = (right[k] + self.pull(x, k, |near| near)) / self.diagonal[k]);
    }
}

/// Nodes without repetition, and a map of their numbers.
fn numbered(
    shape: (usize, usize),
    nodes: impl Iterator<Item = (usize, usize)>,
) -> (Array2<usize>, Vec<(usize, usize)>) {
    let mut index = Array2::from_elem(shape, NONE);
    let mut numbered = Vec::new();
    for node in nodes {
        if index[node] == NONE {
            index[node] = numbered.len();
            numbered.push(node);
        }
    }
    (index, numbered)
}

/// The solution by conjugate gradients with a cycle of the levels as preconditioner, and the number of steps.
fn solve(levels: &[Level], right: &[f64], weights: (f64, f64)) -> (Vec<f64>, usize) {
    let level = &levels[0];
    let n = right.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut x = vec![0.0; n];
    let mut residual = right.to_vec();
    let mut direction = cycle(levels, &residual);
    let mut product = vec![0.0; n];
    let mut rho = dot(&residual, &direction);
    // an energy, in which heights that hang by weak links alone have as small a share as these
    let enough = ACCURACY * ACCURACY * weights.0.min(weights.1) * rho;
    let mut steps = 0;
    // in exact arithmetic n steps are enough
    while rho > enough && steps < 10 * n {
        level.apply(&direction, &mut product);
        let step = rho / dot(&direction, &product);
        x.iter_mut().zip(&direction).for_each(|(x, d)| *x += step * d);
        residual.iter_mut().zip(&product).for_each(|(r, p)| *r -= step * p);
        let z = cycle(levels, &residual);
        let next = dot(&residual, &z);
        let beta = next / rho;
        direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + beta * *d);
        rho = next;
        steps += 1;
    }
    (x, steps)
}

/// An approximate solution: a sweep forwards, two cycles of the coarser levels for what remains, a sweep backwards.
fn cycle(levels: &[Level], right: &[f64]) -> Vec<f64> {
    let (Some((level, coarser)), n) = (levels.split_first(), right.len()) else { return Vec::new() };
    let mut x = vec![0.0; n];
    level.relax(right, &mut x, 0..n);
    if let Some(next) = coarser.first() {
        let mut rest = vec![0.0; n];
        level.apply(&x, &mut rest);
        let mut coarse = vec![0.0; next.nodes.len()];
        level.parents.iter().zip(right.iter().zip(&rest)).for_each(|(parent, (b, ax))| coarse[*parent] += b - ax);
        let mut correction = cycle(coarser, &coarse);
        let mut image = vec![0.0; coarse.len()];
        next.apply(&correction, &mut image);
        coarse.iter_mut().zip(&image).for_each(|(r, image)| *r -= image);
        correction.iter_mut().zip(cycle(coarser, &coarse)).for_each(|(c, more)| *c += more);
        x.iter_mut().zip(&level.parents).for_each(|(x, parent)| *x += OVERCORRECTION * correction[*parent]);
        level.relax(right, &mut x, (0..n).rev());
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: [(f64, f64); 3] = [(1.0, 1.0), (1e3, 1.0), (1.0, 1e3)];

    #[test]
    fn holes_in_cells_of_any_shape_keep_their_digits() {
        // a strip across the map, which hangs by its two sides, next to single points among rough heights
        let heights = |along: usize, across: usize| match across {
            0..20 if (along * along + 5 * across).is_multiple_of(7) => f64::NAN,
            0..20 => ((along * 31 + across * across * 17) as f64).sin(),
            20 => 1.0,
            21..40 => f64::NAN,
            _ => 3.0,
        };
        for (spacing, turned) in CELLS.iter().flat_map(|cell| [(*cell, false), (*cell, true)]) {
            let map = |(i, j)| if turned { heights(j, i) } else { heights(i, j) };
            let filled = fill(Array2::from_shape_fn((48, 48), map), spacing).unwrap();
            for across in 20..=40 {
                let (h, exact) = (filled[if turned { [across, 3] } else { [3, across] }], 0.1 * across as f64 - 1.0);
                assert!((h - exact).abs() < 1e-11, "{h} for {exact} in cells {spacing:?}");
            }
        }
    }

    #[test]
    fn steps_hardly_grow_with_the_holes() {
        let missing: [fn(usize, usize, usize) -> bool; 4] = [
            // a square with a margin of one, all but a corner, half of the map, every third point
            |i, j, n| i > 0 && j > 0 && i + 1 < n && j + 1 < n,
            |i, j, _| i + j > 0,
            |i, _, n| 2 * i > n,
            |i, j, _| (i * i + 5 * j) % 3 != 0,
        ];
        for (missing, spacing) in missing.iter().flat_map(|missing| CELLS.map(|spacing| (missing, spacing))) {
            let steps = [33, 65, 130, 260].map(|n| {
                let rough = |i: usize, j: usize| ((i * 31 + j * j * 17) as f64).sin();
                let heights = |(i, j)| if missing(i, j, n) { f64::NAN } else { rough(i, j) };
                let weights = weights(spacing);
                let (levels, right) = Level::hierarchy(&Array2::from_shape_fn((n, n), heights), weights, 0.1);
                let (values, steps) = solve(&levels, &right, weights);
                let mut image = vec![0.0; right.len()];
                levels[0].apply(&values, &mut image);
                let worst = image.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(worst < 1e-10, "{worst} at {n}");
                steps
            });
            // long cells are solved to more digits
            let most = if spacing == CELLS[0] { 20 } else { 60 };
            assert!(steps.iter().all(|steps| *steps <= most), "{steps:?}");
        }
    }
}
