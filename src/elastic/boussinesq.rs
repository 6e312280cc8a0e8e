//! The free elastic half-space, loaded on a window: Love's kernel, on a padded grid.

use std::f64::consts::PI;

use super::*;
use crate::fft::even_modes;
use crate::par;

/// The homogeneous elastic half-space under loads on a window alone: nothing repeats, and beyond the window the surface
/// of the half-space is free.
///
/// A constant pressure on each cell, of half widths a and b, displaces the surface at the distance (x, y) from its
/// centre by
///
/// ```math
/// K(x, y) = [f(x+a; y+b, y−b) + f(y+b; x+a, x−a) + f(x−a; y−b, y+b) + f(y−b; x−a, x+a)] / πE* ,
/// f(t; s, s') = t (asinh(s/|t|) − asinh(s'/|t|)) .
/// ```
///
/// Boussinesq (1885); Love (1929). The displacement tends to zero far away.
///
/// The [`grid`](ElasticOperator::grid) of the operator has at least 2N − 1 nodes a side, the next even product of 2, 3
/// and 5, and the compliance is that of the periodic grid on which every node has the kernel at the shorter distance:
/// between nodes of the window it is Love's. In a [`Problem`](crate::Problem) the surface has the window's grid, as
/// have the fields of a solution; the other nodes are its own concern.
///
/// A flat-ended body may fill the window. What is curved, or attracts the half-space from afar, should end well within
/// it: [`Report::edge_traction`](crate::Report::edge_traction) says how far it does.
///
/// Memory per node of the operator's grid: 1 scalar for the spectrum, and a quarter in `f64` for the stiffness; two
/// fields in `f64` while it is made. A clone shares the stiffness.
///
/// ```
/// use asperity::{Boussinesq, Control, Grid, NoAdhesion, Problem, Solver, Surface};
/// // a sphere of radius 2, pressed against a half-space of contact modulus 1 by a force: a³ = 3FR/4E*
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
    /// or if a compliance leaves the range of T or is not positive, as rounding could make it on cells far from square.
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
        let grid = Grid::new(padded, (padded.0 as f64 * dx, padded.1 as f64 * dy))?.shared_around(&window)?;
        let modes = even_modes(grid.slab(), kernel(&grid, (0.5 * dx, 0.5 * dy), modulus).view());
        let mean_compliance = grid.slab().first(modes.first().copied().unwrap_or_default());
        let spectral = Spectral::of_compliance(grid, modulus, modes)?;
        Ok(Self { spectral, boundary: Boundary::Free { window, mean_compliance } })
    }
}

impl<T: Real> ElasticOperator<T> for Boussinesq<T> {
    fn boundary(&self) -> Boundary {
        self.boundary
    }
    delegate!(this => this.spectral; applications);
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
fn kernel(grid: &Grid, (a, b): (f64, f64), modulus: f64) -> Array2<f64> {
    let (shape, first) = (grid.shape(), grid.rows().start);
    let mut kernel = Array2::zeros(grid.field_shape());
    par::for_each(par::chunks_mut(field::flat_mut(&mut kernel), shape.1), |i, row| {
        let i = first + i;
        let x = 2.0 * a * i.min(shape.0 - i) as f64;
        for (j, value) in row.iter_mut().enumerate() {
            let y = 2.0 * b * j.min(shape.1 - j) as f64;
            *value = love((x, y), (a, b)) / (PI * modulus);
        }
    });
    kernel
}

/// The sum of Love's four terms, for x ≥ 0 and y ≥ 0.
fn love((x, y): (f64, f64), (a, b): (f64, f64)) -> f64 {
    let term = |t: f64, high: f64, low: f64| if t == 0.0 { 0.0 } else { t * asinh_difference(high, low, t.abs()) };
    (term(x + a, y + b, y - b) - term(x - a, y + b, y - b)) + (term(y + b, x + a, x - a) - term(y - b, x + a, x - a))
}

/// asinh(s/t) − asinh(s'/t) for s > s' and t > 0, without cancellation.
fn asinh_difference(high: f64, low: f64, t: f64) -> f64 {
    if low <= 0.0 {
        return (high / t).asinh() - (low / t).asinh();
    }
    let (far, near) = (high.hypot(t), low.hypot(t));
    let width = high - low;
    ((width + width * (high + low) / (far + near)) / (low + near)).ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padded_sides_are_fast_and_hold_two_windows() {
        assert_eq!([2, 3, 7, 8, 12, 33, 65, 100, 512].map(padded), [4, 6, 16, 16, 24, 72, 144, 200, 1024]);
    }

    #[test]
    fn the_kernel_is_that_of_a_point_force_far_away_and_of_a_square_at_its_centre() {
        // the next term of the far field is of second order in a/r, and vanishes on the diagonal of square cells
        let far = love((3e4, 4e4), (0.5, 0.5));
        assert!((far * 5e4 - 1.0).abs() < 1e-10, "{far}");
        let far = love((3e4, 3e4), (0.5, 0.5));
        assert!((far * 3e4 * 2f64.sqrt() - 1.0).abs() < 1e-10, "{far}");
        let centre = love((0.0, 0.0), (0.5, 0.5));
        assert!((centre - 4.0 * (1.0 + 2f64.sqrt()).ln()).abs() < 1e-15, "{centre}");
    }

    #[test]
    fn pieces_of_a_cell_displace_as_the_cell_does() {
        // a cell of 2a × 2b in four, at points inside, at its corner and outside
        let (a, b) = (0.7, 0.2);
        for (x, y) in [(0.0, 0.0), (0.3, 0.1), (0.7, 0.2), (3.0, 0.0), (0.0, 5.0), (40.0, 30.0)] {
            let pieces: f64 = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
                .iter()
                .map(|(sx, sy): &(f64, f64)| {
                    love(((x - 0.5 * sx * a).abs(), (y - 0.5 * sy * b).abs()), (0.5 * a, 0.5 * b))
                })
                .sum();
            let whole = love((x, y), (a, b));
            assert!((pieces / whole - 1.0).abs() < 1e-12, "{pieces} {whole}");
        }
    }
}
