//! The columns of a half spectrum that this process transforms, whole or in pieces from several processes.

use std::ops::Range;

use asperity_fft::num_complex::Complex;
use ndarray::Array2;

use super::shared::{Modes, Shared};
use super::{Sums, Workspace};
use crate::field::{flat, flat_mut};
use crate::par::{self, Pool};
use crate::real::Real;

pub(super) struct ColumnsOf<'a, T: Real> {
    pub(super) own: Range<usize>,
    pub(super) spectrum: &'a mut Array2<Complex<T>>,
    pub(super) shared: &'a mut Shared<T>,
    pub(super) pool: &'a Pool<Workspace<T>>,
    pub(super) sums: &'a mut [Sums],
    pub(super) n0: usize,
}

impl<T: Real> ColumnsOf<'_, T> {
    pub(super) fn come(&mut self) {
        self.shared.come(flat_mut(self.spectrum));
    }

    pub(super) fn go(&mut self) {
        self.shared.go(flat_mut(self.spectrum));
    }

    /// Runs `f(index, column, scratch)` over the columns below `end`, and keeps what it returns as their sums.
    pub(super) fn each(
        &mut self,
        end: usize,
        f: impl Fn(usize, &mut [Complex<T>], &mut [Complex<T>]) -> Sums + Sync + Send,
    ) {
        let (first, pool) = (self.own.start, self.pool);
        let count = end.clamp(first, self.own.end) - first;
        let sums = &mut self.sums[..count];
        if let Some(pieces) = self.shared.pieces(count) {
            return par::update(pieces, sums, |k, mut pieces: Vec<&mut [_]>, sum| {
                let Workspace { column, scratch, .. } = &mut *pool.get();
                let mut rest = &mut column[..];
                for piece in &pieces {
                    let (to, others) = rest.split_at_mut(piece.len());
                    to.copy_from_slice(piece);
                    rest = others;
                }
                *sum = f(first + k, column, scratch);
                let mut rest = &column[..];
                for piece in &mut pieces {
                    let (from, others) = rest.split_at(piece.len());
                    piece.copy_from_slice(from);
                    rest = others;
                }
            });
        }
        let columns = flat_mut(self.spectrum).get_mut(..count * self.n0).unwrap_or_default();
        par::update(par::chunks_mut(columns, self.n0), sums, |k, column, sum| {
            *sum = f(first + k, column, &mut pool.get().scratch);
        });
    }

    pub(super) fn modes(&self) -> Modes<'_, T> {
        Modes { n0: self.n0, spectrum: flat(self.spectrum), shared: self.shared }
    }

    pub(super) fn sums(&mut self) -> Sums {
        let add = |a: Sums, b: &Sums| std::array::from_fn(|i| a[i] + b[i]);
        self.shared.gather(self.sums).iter().fold([0.0; 3], add)
    }
}
