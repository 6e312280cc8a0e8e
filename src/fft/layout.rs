//! The layout of a field for its transform.

use std::f64::consts::TAU;
use std::ops::Range;

use asperity_fft::num_complex::Complex;
use ndarray::{ArrayView2, ArrayViewMut2, CowArray, Ix2};

use crate::field::{Field, contiguous};
use crate::real::Real;
use crate::slab::{Slab, TILE};
use crate::vector::vectorised;

/// The layout of a field: the plane as which it is transformed, and the places of its modes in the half spectrum.
///
/// A plane keeps its shape, or has its axes exchanged where its columns do not fill a tile. A line of A·B nodes, A the
/// largest divisor up to √(AB), is the plane `(B, A)`: node aB + b is row b, column a. With the rows transformed and
/// row b of column k multiplied by exp(−2πi bk/AB), the transform of column k holds the modes k + A·i of the line.
/// Columns k ≤ A/2 suffice, and all transforms fit the cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    shape: (usize, usize),
    plane: (usize, usize),
    exchanged: bool,
    folded: bool,
}

impl Layout {
    pub(crate) fn new(shape: (usize, usize)) -> Self {
        let (n0, n1) = shape;
        let exchanged = n0 < n1.min(TILE);
        let (long, short) = if exchanged { (n1, n0) } else { (n0, n1) };
        let divisor = if short == 1 { divisor(long) } else { 1 };
        let folded = divisor > 1;
        let plane = if folded { (long / divisor, divisor) } else { (long, short) };
        Self { shape, plane, exchanged, folded }
    }

    /// The layout without exchange of axes and without folding.
    pub(super) fn plain(shape: (usize, usize)) -> Self {
        Self { shape, plane: shape, exchanged: false, folded: false }
    }

    pub(super) fn shape(&self) -> (usize, usize) {
        self.shape
    }

    pub(crate) fn plane(&self) -> (usize, usize) {
        self.plane
    }

    pub(crate) fn is_folded(&self) -> bool {
        self.folded
    }

    /// The shape of the half spectrum: its columns, which are contiguous, and the modes in each.
    pub(crate) fn spectrum(&self) -> (usize, usize) {
        (self.plane.1 / 2 + 1, self.plane.0)
    }

    /// The shape of the part of the half spectrum that belongs to the rows of a slab.
    pub(super) fn spectrum_of(&self, slab: &Slab) -> (usize, usize) {
        let (columns, modes) = self.spectrum();
        let (rows, _) = slab.held();
        // a plane that is not the field is in one piece
        (columns, if rows == slab.shape().0 { modes } else { rows })
    }

    /// The columns of the half spectrum that the process of a slab has.
    pub(crate) fn columns_of(&self, slab: &Slab) -> Range<usize> {
        slab.share_of(self.spectrum().0, slab.ranks().rank())
    }

    /// The indices of a mode along both axes of the field.
    pub(crate) fn mode(&self, column: usize, i: usize) -> (usize, usize) {
        let (long, short) = if self.folded { (column + self.plane.1 * i, 0) } else { (i, column) };
        if self.exchanged { (short, long) } else { (long, short) }
    }

    /// The number of columns of the whole spectrum for which a column of the half stands.
    pub(crate) fn weight(&self, column: usize) -> f64 {
        if column == 0 || 2 * column == self.plane.1 { 1.0 } else { 2.0 }
    }

    /// A field as the plane; a copy only of a line that is not contiguous.
    pub(super) fn view<'a, T: Clone>(&self, field: &'a ArrayView2<'_, T>) -> CowArray<'a, T, Ix2> {
        let plane = if self.folded {
            field.to_shape((self.plane.1, self.plane.0)).unwrap_or_else(|_| CowArray::from(field.view()))
        } else {
            CowArray::from(field.view())
        };
        if self.folded || self.exchanged { plane.reversed_axes() } else { plane }
    }

    /// A field as the plane to write to; nothing if it is a line that is not contiguous.
    pub(super) fn view_mut<'a, T>(&self, field: ArrayViewMut2<'a, T>) -> Option<ArrayViewMut2<'a, T>> {
        let plane = if self.folded { field.into_shape_with_order((self.plane.1, self.plane.0)).ok()? } else { field };
        Some(if self.folded || self.exchanged { plane.reversed_axes() } else { plane })
    }
}

/// The largest divisor up to the square root.
fn divisor(n: usize) -> usize {
    (1..=n.isqrt()).rev().find(|&divisor| n.is_multiple_of(divisor)).unwrap_or(1)
}

/// The twiddles exp(−2πi bk/n) of row b, column k, for a line's half spectrum: the first [`TILE`] of each column, and
/// behind them the factors from one run to the next.
#[derive(Debug)]
pub(super) struct Twiddles<T>(Field<Complex<T>>);

impl<T: Real> Twiddles<T> {
    pub(super) fn new(layout: &Layout) -> Option<Self> {
        let ((columns, rows), n) = (layout.spectrum(), layout.shape.0 * layout.shape.1);
        layout.folded.then(|| {
            Self(Field::from_fn((columns, TILE + rows.div_ceil(TILE)), |(k, i)| {
                let row = if i < TILE { i } else { TILE * (i - TILE) };
                let (sin, cos) = (TAU * ((row * k) % n) as f64 / n as f64).sin_cos();
                Complex::new(T::lit(cos), T::lit(-sin))
            }))
        })
    }

    /// Multiplies column `k` by its twiddles, or divides it by them.
    pub(super) fn turn(&self, k: usize, column: &mut [Complex<T>], back: bool) {
        let (run, runs) = contiguous(self.0.row(k).to_slice()).split_at(TILE);
        let sign = if back { -T::one() } else { T::one() };
        vectorised(
            #[inline(always)]
            move || {
                for (modes, &first) in column.chunks_mut(TILE).zip(runs) {
                    for (z, &by) in modes.iter_mut().zip(run) {
                        let turn = first * by;
                        *z *= Complex::new(turn.re, sign * turn.im);
                    }
                }
            },
        );
    }
}
