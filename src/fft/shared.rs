//! The spectrum of a field that several processes share: its way to those that transform the columns, and back.

use std::marker::PhantomData;

use asperity_fft::num_complex::Complex;

use super::{Layout, Sums};
use crate::par::{self, Chunks};
use crate::ranks::{Ranks, Shares};
use crate::real::{Compiled, Real};
use crate::slab::Slab;

/// The columns of a spectrum that this process transforms, where it has the rows of a slab alone.
/// The half spectrum is stored by columns: each process gets one piece of it, and sends one back, with all columns and
/// its rows. A column is put together where it is transformed.
pub(super) struct Shared<T> {
    slab: Slab,
    layout: Layout,
    /// what the others get of the spectrum of this slab, and what comes from them
    sent: Shares,
    received: Shares,
    pieces: Vec<Complex<T>>,
    /// the sums over the columns of each process, and of all
    sums: Shares,
    all: Vec<Sums>,
}

impl<T: Real> Shared<T> {
    pub(super) fn new(slab: Slab, layout: Layout) -> Self {
        let (columns, _) = layout.spectrum();
        let (own, rows) = (layout.columns_of(&slab).len(), slab.rows().len());
        Self {
            slab,
            layout,
            sent: slab.shares(|rank| slab.share_of(columns, rank).len() * rows),
            received: slab.shares(|rank| slab.rows_of(rank).len() * own),
            pieces: Vec::new(),
            sums: slab.shares(|rank| 3 * slab.share_of(columns, rank).len()),
            all: vec![[0.0; 3]; columns],
        }
    }

    /// Whether columns come in pieces: not if one process has all of them.
    pub(super) fn is_in_pieces(&self) -> bool {
        self.slab.is_shared() && self.slab.bands() > 1
    }

    pub(super) fn release_memory(&mut self) {
        self.pieces = Vec::new();
    }

    fn take_memory(&mut self) {
        if self.is_in_pieces() && self.pieces.is_empty() {
            self.pieces = vec![Complex::default(); self.layout.columns_of(&self.slab).len() * self.slab.shape().0];
        }
    }

    pub(super) fn come(&mut self, spectrum: &[Complex<T>]) {
        self.take_memory();
        if self.is_in_pieces() {
            let Self { slab, sent, received, pieces, .. } = self;
            T::call::<Exchange<'_>>((slab.ranks(), (spectrum, sent), (pieces, received)));
        }
    }

    pub(super) fn go(&mut self, spectrum: &mut [Complex<T>]) {
        if self.is_in_pieces() {
            let Self { slab, sent, received, pieces, .. } = self;
            T::call::<Exchange<'_>>((slab.ranks(), (pieces, received), (spectrum, sent)));
        }
    }

    /// The first `count` of the columns, each in its pieces; nothing if they are whole.
    pub(super) fn pieces(&mut self, count: usize) -> Option<Vec<Chunks<&mut [Complex<T>]>>> {
        self.take_memory();
        if !self.is_in_pieces() {
            return None;
        }
        let own = self.layout.columns_of(&self.slab).len();
        let (mut rest, slab) = (&mut self.pieces[..], self.slab);
        let rows = (0..slab.ranks().count()).map(|rank| slab.rows_of(rank).len()).filter(|&rows| rows > 0);
        Some(
            rows.map(|rows| {
                let (piece, others) = std::mem::take(&mut rest).split_at_mut(rows * own);
                rest = others;
                par::chunks_mut(&mut piece[..rows * count], rows)
            })
            .collect(),
        )
    }

    pub(super) fn gather(&mut self, own: &[Sums]) -> &[Sums] {
        self.slab.ranks().gather(own.as_flattened(), &self.sums, self.all.as_flattened_mut());
        &self.all
    }

    fn mode(&self, column: usize, row: usize) -> Complex<T> {
        let own = self.layout.columns_of(&self.slab);
        let rows = (0..self.slab.ranks().count()).map(|rank| self.slab.rows_of(rank)).find(|rows| rows.contains(&row));
        let rows = rows.unwrap_or_default();
        self.pieces[own.len() * rows.start + (column - own.start) * rows.len() + (row - rows.start)]
    }
}

struct Exchange<'a>(PhantomData<&'a ()>);

impl<'a> Compiled for Exchange<'a> {
    type Input<T: Real> = (Ranks, (&'a [Complex<T>], &'a Shares), (&'a mut [Complex<T>], &'a Shares));
    type Output<T: Real> = ();
    fn single((ranks, (from, sent), (into, received)): Self::Input<f32>) {
        ranks.exchange(from, sent, into, received);
    }
    fn double((ranks, (from, sent), (into, received)): Self::Input<f64>) {
        ranks.exchange(from, sent, into, received);
    }
}

pub(crate) struct Modes<'a, T> {
    pub(super) n0: usize,
    pub(super) spectrum: &'a [Complex<T>],
    pub(super) shared: &'a Shared<T>,
}

impl<T: Real> Modes<'_, T> {
    pub(super) fn own(&self, column: usize, row: usize) -> Complex<T> {
        match self.shared.is_in_pieces() {
            true => self.shared.mode(column, row),
            false => self.spectrum[column * self.n0 + row],
        }
    }

    /// The modes at some places, column and row, sorted by their columns.
    pub(crate) fn read(&self, places: impl Iterator<Item = (usize, usize)> + Clone, modes: &mut [Complex<f64>]) {
        let widened = |mode: Complex<T>| Complex::new(mode.re.widen(), mode.im.widen());
        let &Shared { slab, layout, .. } = self.shared;
        if !slab.is_shared() {
            let found = places.map(|(column, row)| self.spectrum[column * self.n0 + row]);
            return modes.iter_mut().zip(found).for_each(|(mode, found)| *mode = widened(found));
        }
        let (columns, _) = layout.spectrum();
        let of = |rank: usize| {
            let own = slab.share_of(columns, rank);
            places.clone().filter(move |(column, _)| own.contains(column))
        };
        let own: Vec<_> = of(slab.ranks().rank()).map(|(column, row)| widened(self.own(column, row))).collect();
        slab.ranks().gather(&own, &slab.shares(|rank| of(rank).count()), modes);
    }
}
