use std::f64::consts::PI;
use std::ops::Range;

use super::*;
use crate::fft::even_modes;
use crate::par;
use crate::slab::TILE;

/// The homogeneous elastic half-space under loads on a window alone, with a free surface beyond it.
///
/// A constant pressure on a cell of half widths a and b displaces the surface at the distance (x, y) from its centre by
///
/// ```math
/// K(x, y) = [f(x+a; y+b, y−b) + f(y+b; x+a, x−a) + f(x−a; y−b, y+b) + f(y−b; x−a, x+a)] / πE* ,
/// f(t; s, s') = t (asinh(s/|t|) − asinh(s'/|t|)) .
/// ```
///
/// Boussinesq (1885); Love (1929). The displacement tends to zero far away.
///
/// The [`grid`](ElasticOperator::grid) of the operator has at least 2N − 1 nodes a side, the next even product of 2, 3
/// and 5, each with the kernel at the shorter distance; surfaces and solutions are on the window.
///
/// A curved or attracting body should end well within the window:
/// [`Report::edge_traction`](crate::Report::edge_traction). A flat-ended one may fill it.
///
/// Memory per node of the operator's grid: 1 scalar, and a quarter in `f64` that clones share; at first two in `f64`.
///
/// ```
/// use asperity::{Boussinesq, Control, Grid, NoAdhesion, Problem, Solver, Surface};
/// // a sphere of radius 2 on a half-space: a³ = 3FR/4E*
/// let grid = Grid::square(64, 0.4)?;
/// let sphere = Surface::paraboloid(grid, 2.0)?;
/// let mut problem = Problem::new(&sphere, Boussinesq::<f64>::new(grid, 1.0)?, NoAdhesion)?;
/// let report = Solver::default().solve(&mut problem, Control::Force(1e-3))?.report;
/// let a = (0.75 * 1e-3 * 2.0_f64).cbrt();
/// assert!((report.approach.unwrap() / (a * a / 2.0) - 1.0).abs() < 0.01);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Boussinesq<T: Real> {
    spectral: Spectral<T>,
    boundary: Boundary,
}

impl<T: Real> Boussinesq<T> {
    /// The half-space of contact modulus E*, loaded on the cells of the nodes of `window`.
    ///
    /// # Errors
    /// [`Error::Value`] if the window has one row or column of nodes alone, if the modulus is not positive and finite,
    /// or if a compliance leaves the range of T or is not positive, as by rounding on cells far from square;
    /// [`Error::Memory`] if there is too little for the kernel.
    pub fn new(window: Grid, modulus: f64) -> Result<Self> {
        Error::positive("contact modulus", modulus)?;
        let (shape, (dx, dy)) = (window.shape(), window.spacing());
        for (name, nodes) in [("number of nodes Nx of a free half-space", shape.0), ("number of nodes Ny", shape.1)] {
            if nodes < 2 {
                let requirement = "at least 2: a free half-space is loaded on an area, not on a line";
                return Err(Error::Value { name, value: nodes as f64, requirement });
            }
        }
        let padded = (padded(shape.0), padded(shape.1));
        let grid =
            Grid::new(padded, (padded.0 as f64 * dx, padded.1 as f64 * dy))?.within(window.slab().around(padded))?;
        grid.slab().afford("a free half-space", 16)?;
        let modes = even_modes(grid.slab(), kernel(&grid, (0.5 * dx, 0.5 * dy), modulus).view());
        let mean_compliance = grid.each(modes.first().copied().unwrap_or_default())[0];
        let spectral = Spectral::of_compliance(grid, modulus, modes)?;
        Ok(Self { spectral, boundary: Boundary::Free { window: window.alone(), mean_compliance } })
    }

    /// The free boundary, with the window on which the half-space is loaded.
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }
}

impl<T: Real> ElasticOperator<T> for Boussinesq<T> {
    delegate!(this => this.spectral, this.boundary, Some(&mut this.spectral));
}

/// The nodes of the padded grid along a side of n: at least 2n − 1, even, and a product of 2, 3 and 5.
fn padded(n: usize) -> usize {
    let is_fast = |m: &usize| {
        let without =
            |m: usize, prime: usize| (0..m.ilog2()).fold(m, |m, _| if m % prime == 0 { m / prime } else { m });
        [2, 3, 5].into_iter().fold(*m, without) == 1
    };
    let least = (2 * n - 1).next_multiple_of(2);
    (least..).step_by(2).find(is_fast).unwrap_or(least)
}

/// The displacement of every node by a unit pressure on the cell of node (0, 0), at the shorter distance.
fn kernel(grid: &Grid, cell: (f64, f64), modulus: f64) -> Field<f64> {
    let ((nx, ny), rows) = (grid.shape(), grid.rows());
    let distance = |i: usize| i.min(nx - i);
    let nearest = rows.clone().map(distance).min().unwrap_or_default();
    let farthest = rows.clone().map(distance).max().unwrap_or_default();
    let quadrant = quadrant(nearest..farthest + 1, ny / 2 + 1, cell);
    let mut kernel = Field::zeros(grid.field_shape());
    par::for_each(par::chunks_mut(kernel.nodes_mut(), ny), |i, row| {
        let quadrant = quadrant.row(distance(rows.start + i) - nearest);
        row.iter_mut().enumerate().for_each(|(j, value)| *value = quadrant[j.min(ny - j)] / (PI * modulus));
    });
    kernel
}

/// The sum of Love's four terms in rows of the first quadrant; each term is also a term of the next cell, negative.
fn quadrant(rows: Range<usize>, columns: usize, (a, b): (f64, f64)) -> Field<f64> {
    let (x, y) = (|i: usize| (2 * i + 1) as f64 * a, |j: usize| (2 * j + 1) as f64 * b);
    // the farthest corners of the cells of a row from the origin, and the terms of the edges that end there along y
    let edges = |i: usize, edges: &mut [(f64, f64)]| {
        let mut near = 0.0;
        for (j, edge) in edges.iter_mut().enumerate() {
            let far = x(i).hypot(y(j));
            *edge = (far, term(x(i), (y(j), 2.0 * b), (far, near)));
            near = far;
        }
    };
    let mut quadrant = Field::zeros((rows.len(), columns));
    par::for_each(par::chunks_mut(quadrant.nodes_mut(), TILE * columns), |tile, values| {
        let first = rows.start + tile * TILE;
        let (mut before, mut here) = (vec![(0.0, 0.0); columns], vec![(0.0, 0.0); columns]);
        if first > 0 {
            edges(first - 1, &mut before);
        }
        for (i, row) in (first..).zip(values.chunks_mut(columns)) {
            edges(i, &mut here);
            let mut last = 0.0;
            for (j, value) in row.iter_mut().enumerate() {
                let ((far, along_y), (near, opposite_y)) = (here[j], before[j]);
                let along_x = term(y(j), (x(i), 2.0 * a), (far, near));
                // the cells at an axis have their opposite edges beyond it
                let opposite_y = if i == 0 { -along_y } else { opposite_y };
                let opposite_x = if j == 0 { -along_x } else { last };
                *value = (along_y - opposite_y) + (along_x - opposite_x);
                last = along_x;
            }
            std::mem::swap(&mut before, &mut here);
        }
    });
    quadrant
}

/// Love's term f(t; s, s − width) without cancellation, for an edge that begins beyond the axis and lies between the
/// distances `near` and `far` from the origin, or one with the axis in its middle.
fn term(t: f64, (s, width): (f64, f64), (far, near): (f64, f64)) -> f64 {
    let low = s - width;
    match low > 0.0 {
        true => t * ((width + width * (s + low) / (far + near)) / (low + near)).ln_1p(),
        false => 2.0 * t * (s / t).asinh(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padded_sides_are_fast_and_hold_two_windows() {
        assert_eq!([2, 3, 7, 8, 12, 33, 65, 100, 512].map(padded), [4, 6, 16, 16, 24, 72, 144, 200, 1024]);
    }

    fn love((i, j): (usize, usize), cell: (f64, f64)) -> f64 {
        quadrant(i..i + 1, j + 1, cell)[[0, j]]
    }

    #[test]
    fn the_kernel_is_that_of_a_point_force_far_away_and_of_a_square_at_its_centre() {
        // the next term of the far field is of second order in a/r, and vanishes on the diagonal of square cells
        let far = love((30_000, 40_000), (0.5, 0.5));
        assert!((far * 5e4 - 1.0).abs() < 1e-10, "{far}");
        let far = love((30_000, 30_000), (0.5, 0.5));
        assert!((far * 3e4 * 2f64.sqrt() - 1.0).abs() < 1e-10, "{far}");
        let centre = love((0, 0), (0.5, 0.5));
        assert!((centre - 4.0 * (1.0 + 2f64.sqrt()).ln()).abs() < 1e-15, "{centre}");
    }

    #[test]
    fn pieces_of_a_cell_displace_as_the_cell_does() {
        let (a, b) = (0.7, 0.2);
        let (whole, pieces) = (quadrant(0..50, 70, (a, b)), quadrant(0..150, 210, (a / 3.0, b / 3.0)));
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (0, 69), (49, 0), (31, 7), (32, 7), (49, 69)] {
            let near = |i: usize| [(3 * i).abs_diff(1), 3 * i, 3 * i + 1];
            let sum: f64 = near(i).iter().flat_map(|&p| near(j).map(|q| pieces[[p, q]])).sum();
            assert!((sum / whole[[i, j]] - 1.0).abs() < 1e-12, "{i} {j}: {sum} {}", whole[[i, j]]);
        }
        assert!(quadrant(17..50, 70, (a, b)).rows().into_iter().eq(whole.rows().into_iter().skip(17)));
    }
}
