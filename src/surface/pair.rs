//! Two surfaces that face each other.

use std::f64::consts::{PI, TAU};

use asperity_fft::num_complex::Complex;
use ndarray::Array2;

use super::Surface;
use super::resample::{by_lines, changed};
use crate::degrees::ALIKE;
use crate::error::{Error, Result};

/// The relative difference of numbers that may be the same: texts have some seven digits.
pub(super) const SAME: f64 = 1e-6;

impl Surface {
    /// The surface between this one and another that faces it: the heights add.
    ///
    /// The other surface lies face up when it is measured, and is turned over about the y axis, so that its x axis runs
    /// backwards. Then it is shifted by a length along both axes of this surface:
    ///
    /// ```math
    /// h[i, j] = h₁[i, j] + h₂'[i − sx/Δx, j − sy/Δy] ,   h₂'[i, j] = h₂[Nx − 1 − i, j]
    /// ```
    ///
    /// Johnson, *Contact Mechanics* (1985), section 4.1. A shift turns the phases of the waves of h₂', h₂' continued
    /// periodically, by (qx sx + qy sy); the shortest wave of an even number of nodes, which is its own mirror image,
    /// becomes what it is at the nodes, cos(πs/Δ) times itself. Whole nodes are moved as they are. Nodes that are
    /// absent in either are absent.
    ///
    /// ```
    /// use asperity::{Grid, SelfAffine};
    /// let rough = |seed| SelfAffine::default().k_s(8.0).seed(seed).surface(Grid::square(64, 1.0)?);
    /// let (one, other) = (rough(1)?, rough(2)?);
    /// let between = one.against(&other, (0.25, 0.0))?;
    /// // 16 nodes further along x, where its x axis runs backwards
    /// assert_eq!(between.heights()[[20, 3]], one.heights()[[20, 3]] + other.heights()[[59, 3]]);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Shape`] or [`Error::Value`] if the numbers of nodes or the side lengths differ, or a shift is not
    /// finite, or none of whole nodes where the other surface has absent nodes.
    pub fn against(&self, other: &Self, (sx, sy): (f64, f64)) -> Result<Self> {
        let (grid, (nx, ny)) = (self.grid, self.grid.shape());
        Error::shape("surface on the other side", other.grid.shape(), (nx, ny))?;
        let (ours, theirs, (dx, dy)) = (grid.lengths(), other.grid.lengths(), grid.spacing());
        let sides = [("side length Lx of the other surface", ours.0, theirs.0), ("side length Ly", ours.1, theirs.1)];
        if let Some(&(name, _, value)) = sides.iter().find(|(_, our, their)| (their / our - 1.0).abs() > SAME) {
            return Err(Error::Value { name, value, requirement: "as on the surface on this side" });
        }
        let (x, y) = (in_nodes("shift along x", sx, dx, nx)?, in_nodes("shift along y", sy, dy, ny)?);
        grid.afford("the surface between two", 24)?;
        let other = other.whole();
        let mut facing = turned_over(other.heights(), (x.0, y.0));
        let absent = other.absent().map(|absent| turned_over(absent, (x.0, y.0)));
        if (x.1, y.1) != (0.0, 0.0) {
            if absent.is_some() {
                let (name, value) = if x.1 == 0.0 { ("shift along y", sy) } else { ("shift along x", sx) };
                let requirement = "a whole number of nodes, since the other surface has absent nodes";
                return Err(Error::Value { name, value, requirement });
            }
            facing = by_lines(facing, |lines| shifted(lines, x.1), |lines| shifted(lines, y.1));
        }
        let first = grid.rows().start;
        let mut heights = self.heights().clone();
        heights.indexed_iter_mut().for_each(|((i, j), h)| *h += facing[(first + i, j)]);
        let has = |absent: Option<&Array2<bool>>, node| absent.is_some_and(|absent| absent[node]);
        let absent = Array2::from_shape_fn(heights.dim(), |(i, j)| {
            has(self.absent(), (i, j)) || has(absent.as_ref(), (first + i, j))
        });
        Self::new(grid, heights)?.with_absent(absent)
    }
}

/// A length as whole nodes along a periodic side of n, and the fraction of a node that is left.
fn in_nodes(name: &'static str, length: f64, spacing: f64, n: usize) -> Result<(usize, f64)> {
    let nodes = (Error::finite(name, length)? / spacing).rem_euclid(n as f64);
    let fraction = nodes - nodes.round();
    Ok((nodes.round() as usize % n, if fraction.abs() < ALIKE { 0.0 } else { fraction }))
}

/// A field turned over about the y axis, and moved by whole nodes.
fn turned_over<A: Copy>(field: &Array2<A>, (kx, ky): (usize, usize)) -> Array2<A> {
    let (nx, ny) = field.dim();
    Array2::from_shape_fn((nx, ny), |(i, j)| field[[(nx - 1 + kx - i) % nx, (ny + j - ky) % ny]])
}

/// Every row moved by less than a node.
fn shifted(rows: &Array2<f64>, nodes: f64) -> Array2<f64> {
    let n = rows.ncols();
    let turn = |k: usize| {
        let (wave, middle) = (if 2 * k < n { k as f64 } else { k as f64 - n as f64 }, 2 * k == n);
        // the nodes cannot tell the two directions of the wave in the middle apart
        if middle { Complex::from((PI * nodes).cos()) } else { Complex::cis(-TAU * nodes * wave / n as f64) }
    };
    let turns: Vec<_> = (0..n).map(turn).collect();
    let change = |from: &[Complex<f64>], to: &mut [Complex<f64>]| {
        to.iter_mut().zip(from).zip(&turns).for_each(|((to, from), turn)| *to = from * turn);
    };
    if nodes == 0.0 { rows.clone() } else { changed(rows, n, change) }
}
