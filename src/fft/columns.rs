//! The half spectrum of a field that one process has, or several share.

use std::ops::Range;

use asperity_fft::num_complex::Complex;

use super::{Layout, Products, Workspace};
use crate::field::Field;
use crate::par::{self, Chunks, Pool};
use crate::ranks::{Ranks, Shares};
use crate::real::{Real, once};
use crate::slab::Slab;

once! {
    /// The exchange of a spectrum between processes.
    exchange<'a, T>(
        ranks: Ranks, from: &'a [Complex<T>], sent: &'a Shares, into: &'a mut [Complex<T>], received: &'a Shares,
    ) -> () = Ranks::exchange;
}

/// The half spectrum, stored by columns. Where processes share the field, each has the rows of its slab of all columns,
/// and transforms some columns: it gets one piece of these from every process, and sends one back. A column is put
/// together where it is transformed.
pub(crate) struct HalfSpectrum<T> {
    slab: Slab,
    layout: Layout,
    /// all columns, of the rows in the slab
    pub(super) modes: Field<Complex<T>>,
    /// the columns that this process transforms
    pub(super) own: Range<usize>,
    /// these columns of all rows, by the processes from which they come
    pieces: Vec<Complex<T>>,
    /// what the others get of the modes, and what comes from them
    sent: Shares,
    received: Shares,
    /// the sums over the own columns, and over the columns of each process
    sums: Vec<Products>,
    shares: Shares,
    all: Vec<Products>,
}

impl<T: Real> HalfSpectrum<T> {
    pub(super) fn new(slab: Slab, layout: Layout) -> Self {
        let ((columns, _), own, rows) = (layout.spectrum(), layout.columns_of(&slab), slab.rows().len());
        Self {
            slab,
            layout,
            modes: Field::default(),
            pieces: Vec::new(),
            sent: slab.shares(|rank| slab.share_of(columns, rank).len() * rows),
            received: slab.shares(|rank| slab.rows_of(rank).len() * own.len()),
            sums: vec![[0.0; 3]; own.len()],
            shares: slab.shares(|rank| 3 * slab.share_of(columns, rank).len()),
            all: vec![[0.0; 3]; columns],
            own,
        }
    }

    /// Whether columns come in pieces: not if one process has all of them.
    pub(super) fn is_in_pieces(&self) -> bool {
        self.slab.is_shared() && self.slab.bands() > 1
    }

    pub(super) fn take_memory(&mut self) {
        if self.modes.is_empty() {
            self.modes = Field::zeros(self.layout.spectrum_of(&self.slab));
        }
        if self.is_in_pieces() && self.pieces.is_empty() {
            self.pieces = vec![Complex::default(); self.own.len() * self.slab.shape().0];
        }
    }

    pub(super) fn release_memory(&mut self) {
        (self.modes, self.pieces) = (Field::default(), Vec::new());
    }

    /// Brings the columns to the processes that transform them.
    pub(super) fn come(&mut self) {
        if self.is_in_pieces() {
            let Self { slab, modes, sent, received, pieces, .. } = self;
            exchange(slab.ranks(), modes.nodes(), sent, pieces, received);
        }
    }

    /// Brings the columns back.
    pub(super) fn go(&mut self) {
        if self.is_in_pieces() {
            let Self { slab, modes, sent, received, pieces, .. } = self;
            exchange(slab.ranks(), pieces, received, modes.nodes_mut(), sent);
        }
    }

    /// Runs `f(index, column, scratch)` over the columns below `end`, and keeps what it returns as their sums.
    pub(super) fn each(
        &mut self,
        pool: &Pool<Workspace<T>>,
        end: usize,
        f: impl Fn(usize, &mut [Complex<T>], &mut [Complex<T>]) -> Products + Sync + Send,
    ) {
        let (first, n0) = (self.own.start, self.layout.plane().0);
        let count = end.clamp(first, self.own.end) - first;
        if self.is_in_pieces() {
            let pieces = in_pieces(&mut self.pieces, self.slab, (self.own.len(), count));
            return par::update(pieces, &mut self.sums[..count], |k, mut pieces: Vec<&mut [_]>, sum| {
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
        let columns = &mut self.modes.nodes_mut()[..count * n0];
        par::update(par::chunks_mut(columns, n0), &mut self.sums[..count], |k, column, sum| {
            *sum = f(first + k, column, &mut pool.get().scratch);
        });
    }

    /// The sum over all columns, in their order.
    pub(super) fn sums(&mut self) -> Products {
        self.slab.ranks().gather(self.sums.as_flattened(), &self.shares, self.all.as_flattened_mut());
        self.all.iter().fold([0.0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]))
    }

    /// A mode of the own columns.
    pub(super) fn mode(&self, column: usize, row: usize) -> Complex<T> {
        if !self.is_in_pieces() {
            return self.modes.nodes()[column * self.layout.plane().0 + row];
        }
        let rows = (0..self.slab.ranks().count()).map(|rank| self.slab.rows_of(rank)).find(|rows| rows.contains(&row));
        let rows = rows.unwrap_or_default();
        self.pieces[self.own.len() * rows.start + (column - self.own.start) * rows.len() + (row - rows.start)]
    }

    /// The modes at some places, column and row, sorted by their columns.
    pub(crate) fn read(&self, places: impl Iterator<Item = (usize, usize)> + Clone, modes: &mut [Complex<f64>]) {
        let read = |(column, row)| {
            let mode = self.mode(column, row);
            Complex::new(mode.re.widen(), mode.im.widen())
        };
        if !self.slab.is_shared() {
            return modes.iter_mut().zip(places).for_each(|(mode, place)| *mode = read(place));
        }
        let of = |rank: usize| {
            let own = self.slab.share_of(self.all.len(), rank);
            places.clone().filter(move |(column, _)| own.contains(column))
        };
        let own: Vec<_> = of(self.slab.ranks().rank()).map(read).collect();
        self.slab.ranks().gather(&own, &self.slab.shares(|rank| of(rank).count()), modes);
    }
}

/// The first `count` of the `own` columns, each in its pieces.
fn in_pieces<E: Send>(pieces: &mut [E], slab: Slab, (own, count): (usize, usize)) -> Vec<Chunks<&mut [E]>> {
    let mut rest = pieces;
    let rows = (0..slab.ranks().count()).map(|rank| slab.rows_of(rank).len()).filter(|&rows| rows > 0);
    rows.map(|rows| {
        let (piece, others) = std::mem::take(&mut rest).split_at_mut(rows * own);
        rest = others;
        par::chunks_mut(&mut piece[..rows * count], rows)
    })
    .collect()
}
