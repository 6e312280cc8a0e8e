//! Heights and gaps from one grid to another: surfaces on coarser ones, starts on finer ones.

use std::iter::repeat_n;
use std::ops::Range;

use ndarray::Array2;

use crate::adhesion::AdhesionLaw;
use crate::constraint::Wall;
use crate::error::Result;
use crate::field::{Field, ordered};
use crate::grid::Grid;
use crate::par;
use crate::problem::Window;
use crate::real::Real;
use crate::surface::Surface;
use crate::vector::vectors;

/// The share of the exact ratio of gaps: the best start has a little more contact.
const WIDER: f64 = 0.77;

/// The surface on a coarser grid; nothing if all of its nodes are absent.
pub(super) fn coarsen(surface: &Surface, shape: (usize, usize)) -> Result<Option<Surface>> {
    let fine = surface.grid();
    let grid = fine.sibling(shape, fine.lengths())?;
    let (nx, ny) = fine.shape();
    let sides = [(nx, shape.0), (ny, shape.1)].map(|(from, to)| [from, to].map(Side::periodic));
    let [along_x, along_y] = sides.map(|[from, to]| places(from, to));
    let needed = |row: usize| along_x[row].nodes;
    let heights = fine.rows_for(surface.heights(), &grid, needed);
    let absent = surface.absent().map(|absent| fine.rows_for(absent, &grid, needed));
    let mut coarse = Field::zeros(grid.field_shape());
    par::for_each(par::chunks_mut(coarse.nodes_mut(), shape.1), |i, row| {
        let x = along_x[grid.rows().start + i];
        let lines = x.nodes.map(|node| heights.line(node));
        for (height, y) in row.iter_mut().zip(&along_y) {
            *height = x.cubic(|k| y.cubic(|l| lines[k][y.nodes[l]]));
        }
    });
    let coarse = Surface::new(grid, coarse.into_array())?;
    let Some(absent) = absent else { return Ok(Some(coarse)) };
    let first = grid.rows().start;
    let absent = Array2::from_shape_fn(grid.field_shape(), |(i, j)| {
        absent.row(along_x[first + i].nodes[1])[along_y[j].nodes[1]]
    });
    let some = grid.any(absent.iter().any(|absent| !absent));
    if some { coarse.with_absent(absent).map(Some) } else { Ok(None) }
}

/// The place of a node among the nodes of another grid along a side.
#[derive(Clone, Copy)]
struct Stencil {
    /// The node before the one at or before the place, that node, and the two after it.
    nodes: [usize; 4],
    weights: [f64; 4],
    /// For a contact before the place, and one after it: the ratio of the gaps of the next two nodes beyond, the
    /// farther to the nearer, from which on the place is in contact.
    edges: [f64; 2],
}

impl Stencil {
    fn is_node(&self) -> bool {
        self.weights[1] == 1.0
    }

    #[inline(always)]
    fn cubic(&self, value: impl Fn(usize) -> f64) -> f64 {
        match self.is_node() {
            true => value(1),
            false => self.weights.iter().enumerate().map(|(k, weight)| weight * value(k)).sum(),
        }
    }

    /// Whether the place is in contact, from the gaps of the four nodes.
    #[inline(always)]
    fn touches(&self, gap: impl Fn(usize) -> f64) -> bool {
        let (left, right) = (gap(1), gap(2));
        let [at_left, at_right] = [left, right].map(|gap| gap <= 0.0);
        if self.is_node() || at_left == at_right {
            return at_left;
        }
        let (near, far, edge) = if at_left { (right, gap(3), self.edges[0]) } else { (left, gap(0), self.edges[1]) };
        // up to where nothing faces the half-space
        near.is_infinite() || (far.is_finite() && far >= edge * near)
    }
}

#[derive(Clone, Copy)]
struct Side {
    window: usize,
    whole: usize,
}

impl Side {
    fn new(window: (usize, usize), whole: (usize, usize)) -> [Self; 2] {
        [Self { window: window.0, whole: whole.0 }, Self { window: window.1, whole: whole.1 }]
    }

    fn periodic(nodes: usize) -> Self {
        Self { window: nodes, whole: nodes }
    }
}

/// The places of the nodes of one grid among the nodes of another along a side. Beyond the window, nodes in the first
/// half keep their distance from its end, nodes in the second half from its start.
fn places(from: Side, to: Side) -> Vec<Stencil> {
    let place = |k: usize| {
        // in nodes, times the nodes of the window
        let place = match 2 * k <= to.window + to.whole {
            true => k * from.window,
            false => (from.whole * to.window).saturating_sub((to.whole - k) * from.window),
        };
        let (i, t) = (place / to.window, (place % to.window) as f64 / to.window as f64);
        let nodes = [0, 1, 2, 3].map(|shift| (i + from.whole + shift - 1) % from.whole);
        let weights = [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ];
        // gaps grow with the power 3/2 of the distance to an edge at the place
        let edge = |t: f64| WIDER * ((2.0 - t) / (1.0 - t)).powf(1.5);
        Stencil { nodes, weights, edges: [edge(t), edge(1.0 - t)] }
    };
    (0..to.whole).map(place).collect()
}

/// What nodes keep where a gap is interpolated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    /// whether any gap is feasible
    free: bool,
    /// whether nodes between nodes that yield may have a gap below zero; nodes in contact have a gap of zero otherwise
    yields: bool,
    /// the least gap of nodes that do not touch
    least: f64,
}

impl Touching {
    /// A rigid wall alone.
    #[cfg(test)]
    const ZERO: Self = Self { free: false, yields: false, least: 0.0 };

    pub(crate) fn new<T: Real>(wall: Wall<'_, T>, law: &dyn AdhesionLaw<T>) -> Self {
        Self {
            free: wall.is_soft(),
            yields: wall.hardness().is_some(),
            // surfaces stick where they touch
            // above zero, and none in either precision
            least: if law.hints().touches() { f32::MIN_POSITIVE.into() } else { 0.0 },
        }
    }

    /// The gap at a place, from that by interpolation, and the gaps of the four nodes about it.
    #[inline(always)]
    fn gap(self, place: &Stencil, interpolated: f64, gap: impl Fn(usize) -> f64) -> f64 {
        if self.free {
            return interpolated;
        }
        if !place.touches(&gap) {
            return interpolated.max(self.least);
        }
        let yields = self.yields && gap(1) < 0.0 && (place.is_node() || gap(2) < 0.0);
        if yields { interpolated.min(0.0) } else { 0.0 }
    }
}

/// A solution on one grid as the start on another: the deformed half-space.
pub(crate) struct Deformed<T> {
    window: (usize, usize),
    /// the grid of the operator
    grid: Grid,
    /// the displacement u = g + h
    displacement: Array2<f64>,
    /// infinite where nothing faces the half-space
    gap: Array2<T>,
}

impl<T: Real> Deformed<T> {
    /// The half-space under a surface, from the gap, and that on the operator's grid if it is another.
    pub(crate) fn new(surface: &Surface, gap: Array2<T>, whole: Option<(Grid, Array2<T>)>) -> Self {
        let (grid, mut gap) = whole.unwrap_or((*surface.grid(), gap));
        let mut displacement = gap.mapv(T::widen);
        match Window::new(surface, &grid) {
            Some(window) => {
                displacement += &window.extend(surface.heights().view());
                gap = window.place(&window.cut(&Field::of(gap), T::infinity()), T::infinity()).into_array();
            }
            None => displacement += surface.heights(),
        }
        Self { window: surface.grid().shape(), grid, displacement, gap }
    }

    /// The start on the grid of another surface and its operator: a gap on the latter.
    pub(crate) fn prolonged(self, surface: &Surface, grid: &Grid, touching: Touching) -> Array2<T> {
        let Self { window, grid: coarse, displacement, gap } = self;
        let facing = Window::new(surface, grid);
        let extended = facing.as_ref().map(|facing| facing.extend(surface.heights().view()));
        let heights = ordered(extended.as_ref().unwrap_or(surface.heights()).view());
        let [from, to] = [Side::new(window, coarse.shape()), Side::new(surface.grid().shape(), grid.shape())];
        let (along_x, along_y, back_y) = (places(from[0], to[0]), places(from[1], to[1]), places(to[1], from[1]));
        let needed = |row: usize| along_x[row].nodes;
        let displacement = coarse.rows_for(displacement, grid, needed);
        let gap = coarse.rows_for(gap, grid, needed);
        let (width, first) = (grid.shape().1, grid.first_node());
        let facing_in = |nodes: Range<usize>| match &facing {
            None => vec![true; nodes.len()],
            Some(facing) => facing.pieces(nodes).flat_map(|(len, own)| repeat_n(own.is_some(), len)).collect(),
        };
        let mut fine = Field::zeros(grid.field_shape());
        par::for_each(par::chunks_mut(fine.nodes_mut(), width), |i, row| {
            let (x, faces) = (along_x[grid.rows().start + i], facing_in(first + i * width..first + (i + 1) * width));
            let heights = &heights[i * width..][..width];
            // displacement and gap along the row, at the coarse nodes of y
            let [mut displaced, mut apart] = [(); 2].map(|()| vec![0.0; back_y.len()]);
            let at: Vec<f64> = back_y.iter().map(|y| y.cubic(|l| heights[y.nodes[l]])).collect();
            let facing: Vec<bool> = back_y.iter().map(|y| faces[y.nodes[1]]).collect();
            let [u0, u1, u2, u3] = x.nodes.map(|node| displacement.line(node));
            let [g0, g1, g2, g3] = x.nodes.map(|node| gap.line(node));
            vectors!([u0, u1, u2, u3, g0, g1, g2, g3, at, facing], [displaced, apart], |j| {
                let (u, height) = (x.cubic(|k| [u0[j], u1[j], u2[j], u3[j]][k]), at[j]);
                let gap = touching.gap(&x, u - height, |k| [g0[j], g1[j], g2[j], g3[j]][k].widen());
                (displaced[j], apart[j]) = if facing[j] { (gap + height, gap) } else { (u, f64::INFINITY) };
            });
            for (((g, y), height), faces) in row.iter_mut().zip(&along_y).zip(heights).zip(faces) {
                let gap = y.cubic(|l| displaced[y.nodes[l]]) - height;
                *g = T::lit(if faces { touching.gap(y, gap, |l| apart[y.nodes[l]]) } else { gap });
            }
        });
        fine.into_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_where_gaps_open_with_the_power_three_halves() {
        let place = &places(Side::periodic(4), Side::periodic(8))[3]; // half-way between nodes 1 and 2
        // with its share of the ratio the place touches if the edge is not farther than 0.16 before it
        for edge in [1.05, 1.2, 1.3, 1.4, 1.6, 1.75, 1.95] {
            let gap = |x: f64| (x - edge).max(0.0).powf(1.5);
            assert_eq!(place.touches(|k| gap(k as f64)), edge > 1.34, "{edge}");
            assert_eq!(place.touches(|k| gap(3.0 - k as f64)), edge > 1.34, "{edge}");
        }
    }

    #[test]
    fn nodes_beyond_the_window_keep_their_distance_from_its_end_or_start() {
        let (coarse, fine) = (Side { window: 10, whole: 24 }, Side { window: 20, whole: 45 });
        for (k, place) in places(coarse, fine).iter().enumerate() {
            // from the start of the window, or of the next one
            let (start, distance) = if k <= 32 { (0.0, 0.5 * k as f64) } else { (24.0, 0.5 * (k as f64 - 45.0)) };
            let [before, at, ..] = place.nodes;
            let unwrapped = |shift: usize| (at + shift) as f64 - 1.0;
            let found: f64 = place.weights.iter().enumerate().map(|(shift, weight)| weight * unwrapped(shift)).sum();
            assert!((found - start - distance).abs() < 1e-13, "{k}: {found}");
            assert_eq!((before + 1) % 24, at);
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
            let fine = Deformed::new(&coarse, gap, None).prolonged(&surface, &grid, Touching::ZERO);
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
        let fine = Deformed::new(&coarse, gap, None).prolonged(&surface, &grid, Touching::ZERO);
        assert!(fine.rows().into_iter().take(7).all(|row| row.iter().all(|&g| g == 0.0)));
        assert!(fine.rows().into_iter().skip(8).step_by(2).all(|row| row.iter().all(|&g| g > 0.0)));
    }
}
