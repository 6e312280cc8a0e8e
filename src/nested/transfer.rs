//! Heights and gaps from one grid to another: a surface on a coarser one, and the solution there as a start on the
//! finer.

use ndarray::{Array2, ArrayView2};

use crate::error::Result;
use crate::field::flat_mut;
use crate::grid::Grid;
use crate::par;
use crate::real::Real;
use crate::surface::Surface;

/// The share of the exact ratio of gaps: the best start has a little more contact.
const WIDER: f64 = 0.77;

/// The surface on a coarser grid; nothing if all of its nodes are absent.
pub(super) fn coarsen(surface: &Surface, shape: (usize, usize)) -> Result<Option<Surface>> {
    let grid = Grid::new(shape, surface.grid().lengths())?.shared_as(surface.grid())?;
    let (nx, ny) = surface.grid().shape();
    let [mut along_x, along_y] = [(nx, shape.0), (ny, shape.1)].map(|(from, to)| places(from, to, true));
    let needed = fetched(surface.heights().view(), surface.grid(), &grid, &mut along_x);
    let heights = needed.as_ref().unwrap_or(surface.heights());
    let fetch_absent = |absent: &Array2<bool>| {
        let flags = absent.mapv(f64::from);
        fetched(flags.view(), surface.grid(), &grid, &mut places(nx, shape.0, true)).unwrap_or(flags)
    };
    let absent = surface.absent().map(fetch_absent);
    let faces = |i, j| absent.as_ref().is_none_or(|absent| absent[[i, j]] == 0.0);
    let heights = Array2::from_shape_fn(grid.field_shape(), |(i, j)| {
        let ([x, y], here) = ([&along_x[i], &along_y[j]], (along_x[i].nodes[1], along_y[j].nodes[1]));
        match faces(here.0, here.1) {
            false => f64::NAN,
            true => x.cubic(|i| y.cubic(|j| heights[[i, j]])),
        }
    });
    let some = grid.slab().has(heights.iter().any(|h| !h.is_nan()));
    if some { Surface::with_absent(grid, heights).map(Some) } else { Ok(None) }
}

/// The rows of a field on one grid that this process needs for its rows of another one, where several processes share
/// them, and the places of these rows among them.
fn fetched(field: ArrayView2<'_, f64>, from: &Grid, to: &Grid, places: &mut Vec<Place>) -> Option<Array2<f64>> {
    if !from.is_shared() {
        return None;
    }
    let nx = from.shape().0;
    // from the node before the first place to the second one after the last
    let needed = |rank| {
        let rows = to.slab().rows_of(rank);
        let at = |k: usize| k * nx / to.shape().0;
        let (first, count) =
            if rows.is_empty() { (0, 0) } else { (at(rows.start), at(rows.end - 1) - at(rows.start) + 4) };
        (first + nx - 1..).map(move |row| row % nx).take(count)
    };
    let first = needed(to.slab().ranks().rank()).next().unwrap_or_default();
    *places = places.drain(..).skip(to.rows().start).take(to.rows().len()).collect();
    for place in &mut *places {
        place.nodes.iter_mut().for_each(|node| *node = (*node + nx - first) % nx);
    }
    Some(from.slab().fetch(field, needed))
}

/// The place of a node among those of another grid along a side.
struct Place {
    /// The node before the one at or before the place, that node, and the two after it.
    nodes: [usize; 4],
    /// The weights of the cubic through these.
    weights: [f64; 4],
    /// The ratios of the gaps of two nodes beyond an edge, the farther to the nearer, from which on the place is within
    /// the contact: for a contact before the place, and after it.
    edges: [f64; 2],
}

impl Place {
    /// Whether the place is that of a node.
    fn is_node(&self) -> bool {
        self.weights[1] == 1.0
    }

    /// The cubic through values at the four nodes.
    fn cubic(&self, value: impl Fn(usize) -> f64) -> f64 {
        match self.is_node() {
            true => value(self.nodes[1]),
            false => self.nodes.iter().zip(self.weights).map(|(&node, weight)| weight * value(node)).sum(),
        }
    }

    /// Whether the place is in contact, from the gaps of the four nodes.
    fn touches(&self, gap: impl Fn(usize) -> f64) -> bool {
        let [before, left, right, after] = self.nodes.map(gap);
        match (left <= 0.0, right <= 0.0) {
            _ if self.is_node() => left <= 0.0,
            (true, true) => true,
            (true, false) => after.is_finite() && after >= self.edges[0] * right,
            (false, true) => before.is_finite() && before >= self.edges[1] * left,
            (false, false) => false,
        }
    }
}

/// The places of `to` nodes among `from` nodes along a side; beyond a free boundary is the last node again.
fn places(from: usize, to: usize, periodic: bool) -> Vec<Place> {
    let place = |k: usize| {
        let (i, t) = (k * from / to, (k * from % to) as f64 / to as f64);
        let node = |shift: usize| match periodic {
            true => (i + from + shift - 1) % from,
            false => (i + shift).clamp(1, from) - 1,
        };
        let weights = [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ];
        // gaps grow with the power 3/2 of the distance to an edge at the place
        let edge = |t: f64| WIDER * ((2.0 - t) / (1.0 - t)).powf(1.5);
        Place { nodes: [0, 1, 2, 3].map(node), weights, edges: [edge(t), edge(1.0 - t)] }
    };
    (0..to).map(place).collect()
}

/// The gap prolonged to the grid of a finer surface.
pub(crate) fn prolong<T: Real>(
    surface: &Surface,
    coarse: &Surface,
    gap: Array2<T>,
    (projects, periodic): (bool, bool),
) -> Array2<T> {
    let ((cx, cy), (nx, ny)) = (coarse.grid().shape(), surface.grid().shape());
    let (mut along_x, along_y, coarse_y) = (places(cx, nx, periodic), places(cy, ny, periodic), places(ny, cy, true));
    let heights = surface.heights();
    let grids = (coarse.grid(), surface.grid());
    let coarse_heights = fetched(coarse.heights().view(), grids.0, grids.1, &mut places(cx, nx, periodic));
    let coarse_heights = coarse_heights.as_ref().unwrap_or(coarse.heights());
    let gap = match grids.0.is_shared() {
        true => fetched(gap.mapv(T::widen).view(), grids.0, grids.1, &mut along_x).map(|gap| gap.mapv(T::lit)),
        false => None,
    }
    .unwrap_or(gap);
    // where nothing faces the half-space, a start need not be good
    let gap_at = |i: usize, j: usize| Some(gap[[i, j]].widen()).filter(|gap| gap.is_finite()).unwrap_or(0.0);
    let mut fine = Array2::zeros(surface.grid().field_shape());
    par::for_each(par::chunks_mut(flat_mut(&mut fine), ny), |i, row| {
        let x = &along_x[i];
        // displacement and gap along the row, at the coarse nodes of y
        let mut line = vec![(0.0, 0.0); cy];
        for (j, node) in line.iter_mut().enumerate() {
            let u = x.cubic(|k| gap_at(k, j) + coarse_heights[[k, j]]);
            let height = coarse_y[j].cubic(|k| heights[[i, k]]);
            let apart = if projects { (u - height).max(0.0) } else { u - height };
            let touches = projects && x.touches(|k| gap[[k, j]].widen());
            *node = if touches { (height, 0.0) } else { (apart + height, apart) };
        }
        for (k, (g, y)) in row.iter_mut().zip(&along_y).enumerate() {
            let apart = y.cubic(|j| line[j].0) - heights[[i, k]];
            *g = match projects {
                true if y.touches(|j| line[j].1) => T::zero(),
                true => T::lit(apart.max(0.0)),
                false => T::lit(apart),
            };
        }
    });
    fine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_where_gaps_open_with_the_power_three_halves() {
        let place = &places(4, 8, false)[3]; // half-way between nodes 1 and 2
        // with the share of the ratio that is asked for, the place touches if the edge is not farther than 0.16 before
        // it
        for edge in [1.05, 1.2, 1.3, 1.4, 1.6, 1.75, 1.95] {
            let gap = |x: f64| (x - edge).max(0.0).powf(1.5);
            assert_eq!(place.touches(|i| gap(i as f64)), edge > 1.34, "{edge}");
            assert_eq!(place.touches(|i| gap(3.0 - i as f64)), edge > 1.34, "{edge}");
        }
    }

    #[test]
    fn a_wave_is_prolonged_to_fourth_order() {
        for (shape, half) in [((64, 64), (32, 32)), ((64, 32), (32, 16)), ((64, 1), (32, 1)), ((65, 63), (33, 32))] {
            let grid = Grid::new(shape, (1.0, 1.0)).unwrap();
            let surface = Surface::wave(grid, 1e-3, 3).unwrap();
            let coarse = coarsen(&surface, half).unwrap().unwrap();
            // the first nodes of both grids are at one place
            let wave = |grid: &Grid| {
                let turn = |i: usize, n: usize| std::f64::consts::TAU * i as f64 / n as f64;
                let (nx, ny) = grid.shape();
                Array2::from_shape_fn((nx, ny), |(i, j)| 2.0 + turn(i, nx).sin() * turn(j, ny).cos())
            };
            let (gap, exact) = (wave(coarse.grid()) - coarse.heights(), wave(&grid) - surface.heights());
            let fine = prolong(&surface, &coarse, gap, (true, true));
            // the error of the cubic in the middle, 3/128 of the fourth derivative, along both sides
            let spacing = std::f64::consts::TAU / 16.0;
            let worst = (&fine - &exact).iter().fold(0.0_f64, |worst, e| worst.max(e.abs()));
            assert!(worst < 2.1 * 3.0 / 128.0 * spacing.powi(4), "{worst}");
        }
    }

    #[test]
    fn nodes_between_nodes_in_contact_are_in_contact() {
        let grid = Grid::square(16, 1.0).unwrap();
        let surface = Surface::wave_2d(grid, 0.1, 3).unwrap();
        let coarse = coarsen(&surface, (8, 8)).unwrap().unwrap();
        let gap = Array2::from_shape_fn((8, 8), |(i, _)| if i < 4 { 0.0_f32 } else { 1.0 });
        let fine = prolong(&surface, &coarse, gap, (true, true));
        assert!(fine.rows().into_iter().take(7).all(|row| row.iter().all(|&g| g == 0.0)));
        assert!(fine.rows().into_iter().skip(8).step_by(2).all(|row| row.iter().all(|&g| g > 0.0)));
    }
}
