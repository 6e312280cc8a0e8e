//! Heights on other grids: by Fourier interpolation, and with their mirror images.

use std::f64::consts::{PI, TAU};

use asperity_fft::num_complex::Complex;
use ndarray::{Array2, Zip};

#[cfg(doc)]
use super::Surface;
use super::mean_of_finite;
#[cfg(doc)]
use crate::error::Error;
use crate::error::Result;
use crate::field::all_finite;
use crate::grid::Grid;

/// Heights on `nodes` = (Mx, My) nodes of the same sides, finer or coarser, by Fourier interpolation.
///
/// The heights are values, at the new nodes, of the trigonometric polynomial through the Nx × Ny nodes:
///
/// ```math
/// h(x, y) = Σₖ Σₗ ĥₖₗ exp(2πi(kx/Lx + ly/Ly)) ,   |k| ≤ Nx/2 , |l| ≤ Ny/2
/// ```
///
/// The shortest wave of an even number of nodes, which the nodes cannot tell from its mirror image, counts half
/// for k = N/2 and half for k = −N/2. Nodes are in the middle of their cells, and the cells of both grids fill the same
/// sides: new node i is at ((i + ½)/Mx − ½/Nx)Lx from old node 0. So a map that is turned over or [mirrored](mirror) is
/// resampled as it is before, and surfaces that face each other ([`Surface::against`]) still do. With Mx and My odd
/// multiples of Nx and Ny all old nodes are among the new ones, and keep their heights. Coarser grids lose the waves
/// that they do not resolve, which is no sampling of every second node. The mean height stays, and so do all waves that
/// both grids resolve. The polynomial is periodic: edges that do not meet make it ring. Peaks between the nodes of a
/// coarse grid may be higher than any node.
///
/// ```
/// use asperity::surface::resample;
/// use asperity::{Grid, Surface};
/// let coarse = Surface::wave(Grid::new((8, 1), (1.0, 1.0))?, 0.1, 3)?;
/// let fine = resample(coarse.heights().clone(), (24, 1))?;
/// for (i, h) in coarse.heights().iter().enumerate() {
///     assert!((fine[[3 * i + 1, 0]] - h).abs() < 1e-15);
/// }
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Value`] if a number of nodes is zero; [`Error::Memory`] if they take more than there is;
/// [`Error::NotFinite`] if heights are missing.
pub fn resample(heights: Array2<f64>, nodes: (usize, usize)) -> Result<Array2<f64>> {
    on_nodes(heights, nodes, |n, m| 0.5 / m as f64 - 0.5 / n as f64)
}

/// [`resample`], with node 0 in its place: all old nodes are among the nodes of grids that are finer by whole numbers.
pub(crate) fn refine(heights: Array2<f64>, nodes: (usize, usize)) -> Result<Array2<f64>> {
    on_nodes(heights, nodes, |_, _| 0.0)
}

/// Heights on other nodes; the first node has moved by a share of the side.
fn on_nodes(heights: Array2<f64>, nodes: (usize, usize), moved: impl Fn(usize, usize) -> f64) -> Result<Array2<f64>> {
    Grid::new(nodes, (1.0, 1.0))?.afford("a resampled map", 32)?;
    all_finite("heights", heights.view())?;
    let resampled = |rows: &Array2<f64>, m: usize| {
        let by = moved(rows.ncols(), m);
        if rows.ncols() == m { rows.clone() } else { changed(rows, m, |from, to| spread(from, to, by)) }
    };
    Ok(by_lines(heights, |lines| resampled(lines, nodes.0), |lines| resampled(lines, nodes.1)))
}

/// Heights with changed lines along y, then along x, the rows of a field each, about the mean height: a large datum
/// costs no digits.
pub(super) fn by_lines(
    mut heights: Array2<f64>,
    along_x: impl FnOnce(&Array2<f64>) -> Array2<f64>,
    along_y: impl FnOnce(&Array2<f64>) -> Array2<f64>,
) -> Array2<f64> {
    let mean = mean_of_finite(&heights);
    heights.mapv_inplace(|h| h - mean);
    let transposed = |field: Array2<f64>| field.reversed_axes().as_standard_layout().into_owned();
    let mut heights = transposed(along_x(&transposed(along_y(&heights))));
    heights.mapv_inplace(|h| h + mean);
    heights
}

/// Heights and their mirror images along both axes, 2Nx × 2Ny nodes: row Nx + i is a copy of row Nx − 1 − i, and columns
/// likewise.
///
/// A single node along a side is already its own image.
pub fn mirror(heights: &Array2<f64>) -> Array2<f64> {
    let (nx, ny) = heights.dim();
    let (mx, my) = (if nx == 1 { 1 } else { 2 * nx }, if ny == 1 { 1 } else { 2 * ny });
    let image = |i: usize, n: usize| if i < n { i } else { 2 * n - 1 - i };
    Array2::from_shape_fn((mx, my), |(i, j)| heights[[image(i, nx), image(j, ny)]])
}

/// Every row on `m` nodes, by a change of its waves that keeps it real. Two rows ride in one complex line.
pub(super) fn changed(
    field: &Array2<f64>,
    m: usize,
    change: impl Fn(&[Complex<f64>], &mut [Complex<f64>]),
) -> Array2<f64> {
    let (rows, n) = field.dim();
    let (forward, inverse) = (asperity_fft::double(n).forward, asperity_fft::double(m).inverse);
    let mut scratch =
        vec![Complex::default(); forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len())];
    let (mut line, mut fine) = (vec![Complex::default(); n], vec![Complex::default(); m]);
    let mut result = Array2::zeros((rows, m));
    for first in (0..rows).step_by(2) {
        let second = (first + 1).min(rows - 1);
        Zip::from(&mut line[..])
            .and(field.row(first))
            .and(field.row(second))
            .for_each(|z, &a, &b| *z = Complex::new(a, b));
        forward.process_with_scratch(&mut line, &mut scratch);
        change(&line, &mut fine);
        inverse.process_with_scratch(&mut fine, &mut scratch);
        for (row, part) in [(second, 1), (first, 0)] {
            let values = fine.iter().map(|z| if part == 0 { z.re } else { z.im } / n as f64);
            result.row_mut(row).iter_mut().zip(values).for_each(|(h, value)| *h = value);
        }
    }
    result
}

/// The modes of a line of other length with a first node that has moved by a share of the side: modes that both
/// resolve, with the shortest of the two shared between k and −k.
fn spread(from: &[Complex<f64>], to: &mut [Complex<f64>], moved: f64) {
    let (n, m) = (from.len(), to.len());
    let shorter = n.min(m);
    to.fill(Complex::default());
    to[0] = from[0];
    for k in 1..shorter.div_ceil(2) {
        let turn = Complex::cis(TAU * k as f64 * moved);
        to[k] = from[k] * turn;
        to[m - k] = from[n - k] * turn.conj();
    }
    if shorter.is_multiple_of(2) {
        let (k, turn) = (shorter / 2, Complex::cis(PI * shorter as f64 * moved));
        if n < m {
            to[k] = from[k] * turn.scale(0.5);
            to[m - k] = from[k] * turn.conj().scale(0.5);
        } else {
            // the nodes cannot tell the two apart
            to[k] = from[k] * turn + from[n - k] * turn.conj();
        }
    }
}
