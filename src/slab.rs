//! The slab of a grid that a process holds: consecutive rows of nodes. A single process holds all rows.

use std::collections::BTreeSet;
use std::ops::Range;

use ndarray::{Array2, ArrayView1, ArrayView2, Axis, CowArray, Ix2, Slice};

use crate::error::{Error, Result};
use crate::ranks::{Ranks, Sent, Shares};

/// The nodes of a chunk, which are summed one by one. The rounding of a sum of such sums grows with the length of a
/// chunk, not of the field.
pub(crate) const CHUNK: usize = 256;

/// Rows that are transformed together.
pub(crate) const TILE: usize = 32;

/// The memory below which no request is made before an allocation, in bytes: 64 MiB.
pub(crate) const SMALL: f64 = 67_108_864.0;

/// The largest number of bands of a grid; a band has a chunk of chunks at least.
const BANDS: usize = 1024;

/// The slab of a grid that this process holds, and the slabs of the others. A slab consists of whole bands, or is empty.
///
/// A band consists of whole tiles of the transform and whole chunks of the sums. It does not depend on the number of
/// processes. Sums go band by band, in the order of the bands. They are therefore the same, bit for bit, for any
/// distribution of the bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slab {
    /// of the whole grid
    shape: (usize, usize),
    /// rows of a band
    band: usize,
    /// the number of bands that the ranks share
    bands: usize,
    ranks: Ranks,
}

/// The rows of a field that a process has, and the rows of other slabs that it needs.
pub(crate) struct Rows<'a, A> {
    held: CowArray<'a, A, Ix2>,
    /// the number of the first of them
    first: usize,
    /// the numbers of the rows of other slabs, in their order
    others: Vec<usize>,
    fetched: Array2<A>,
}

impl<A> Rows<'_, A> {
    /// A row, by its number in the whole field.
    pub(crate) fn row(&self, row: usize) -> ArrayView1<'_, A> {
        match row.checked_sub(self.first).filter(|&own| own < self.held.nrows()) {
            Some(own) => self.held.row(own),
            None => self.fetched.row(self.others.partition_point(|&other| other < row)),
        }
    }

    /// A row of a field that this crate made, which is contiguous by construction.
    pub(crate) fn line(&self, row: usize) -> &[A] {
        let line = self.row(row).to_slice();
        assert!(line.is_some(), "a row is not in the order of its construction");
        line.unwrap_or_default()
    }
}

impl Slab {
    pub(crate) fn new(shape: (usize, usize), ranks: Ranks) -> Self {
        Self::of_window(shape, shape.1, ranks)
    }

    /// The slab of a grid with a window of this width. Its bands are whole chunks of the window as well.
    fn of_window(shape: (usize, usize), width: usize, ranks: Ranks) -> Self {
        let (nx, ny) = shape;
        let band = if ny < 2 {
            // the transform of a line has no slabs
            nx
        } else {
            let rows = |ny: usize| CHUNK >> ny.trailing_zeros().min(CHUNK.ilog2());
            let unit = TILE.max(rows(ny)).max(rows(width));
            (CHUNK * CHUNK).div_ceil(ny).max(nx.div_ceil(BANDS)).next_multiple_of(unit)
        };
        let band = band.max(1);
        Self { shape, band, bands: nx.div_ceil(band), ranks }
    }

    pub(crate) fn whole(shape: (usize, usize)) -> Self {
        Self::new(shape, Ranks::ALONE)
    }

    /// The slab of another grid that this process holds.
    pub(crate) fn for_grid(&self, shape: (usize, usize)) -> Self {
        Self::new(shape, self.ranks)
    }

    /// The slab of a larger grid that this process holds, for which this grid is a [`window`](Self::window).
    pub(crate) fn around(&self, shape: (usize, usize)) -> Self {
        Self::of_window(shape, self.shape.1, self.ranks)
    }

    /// The slab of a window on the first nodes along both sides, with the rows of this slab.
    pub(crate) fn window(&self, shape: (usize, usize)) -> Self {
        Self { shape, ..*self }
    }

    pub(crate) fn shape(&self) -> (usize, usize) {
        self.shape
    }

    pub(crate) fn nodes(&self) -> usize {
        self.shape.0 * self.shape.1
    }

    pub(crate) fn ranks(&self) -> Ranks {
        self.ranks
    }

    pub(crate) fn is_shared(&self) -> bool {
        self.ranks.count() > 1
    }

    /// The result of this process, or an error that names another process. The latter is returned if a process of a
    /// smaller number has an error, or if this process has none and another one has. All processes have to call it.
    pub(crate) fn agreed<T>(&self, result: Result<T>) -> Result<T> {
        match self.each(result.is_err()).iter().position(|&refused| refused) {
            Some(rank) if rank != self.ranks.rank() => Err(Error::Elsewhere { rank }),
            _ => result,
        }
    }

    /// Refuses `what` where several processes share the slab.
    pub(crate) fn alone(&self, what: &'static str) -> Result<()> {
        let reason = "that has no form for slabs: take the whole grid in one process";
        if self.is_shared() { Err(Error::Shared { what, reason }) } else { Ok(()) }
    }

    /// Refuses a solve that takes more memory than this process gets for its rows. The memory is requested as a whole and
    /// given back, since a failed allocation of a part would end the process.
    pub(crate) fn afford(&self, what: &str, bytes_per_node: usize) -> Result<()> {
        let ((nx, ny), (rows, _)) = (self.shape, self.held());
        let bytes = rows as f64 * ny as f64 * bytes_per_node as f64;
        let given = bytes <= SMALL || Vec::<u8>::new().try_reserve_exact(bytes as usize).is_ok();
        let refused = || Error::Memory { what: format!("{what} on {nx} x {ny} nodes"), bytes };
        self.agreed(given.then_some(()).ok_or_else(refused))
    }

    /// The rows that this process holds.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.rows_of(self.ranks.rank())
    }

    pub(crate) fn held(&self) -> (usize, usize) {
        (self.rows().len(), self.shape.1)
    }

    pub(crate) fn rows_of(&self, rank: usize) -> Range<usize> {
        let bands = self.bands_of(rank);
        (bands.start * self.band).min(self.shape.0)..(bands.end * self.band).min(self.shape.0)
    }

    /// The share of a process of `count` objects, such as the columns of a spectrum, in proportion to its bands.
    pub(crate) fn share_of(&self, count: usize, rank: usize) -> Range<usize> {
        let (Range { start, end }, bands) = (self.bands_of(rank), self.bands());
        count * start / bands..count * end / bands
    }

    /// The number of the first node that this process holds: nodes count along the rows of the whole grid.
    pub(crate) fn first_node(&self) -> usize {
        self.rows().start * self.shape.1
    }

    /// The rows of a field that the rows of another slab need, by `needs` for each row. All processes have to call it.
    pub(crate) fn rows_for<'a, A: Sent, I: IntoIterator<Item = usize>>(
        &self,
        held: impl Into<CowArray<'a, A, Ix2>>,
        to: &Self,
        needs: impl Fn(usize) -> I,
    ) -> Rows<'a, A> {
        let (held, first) = (held.into(), self.rows().start);
        let of = |rank: usize| {
            let own = self.rows_of(rank);
            let needed: BTreeSet<_> = to.rows_of(rank).flat_map(&needs).filter(|row| !own.contains(row)).collect();
            needed.into_iter().collect::<Vec<_>>()
        };
        let mut needed: Vec<_> = (0..self.ranks.count()).map(of).collect();
        let fetched = self.fetch(held.view(), &needed);
        Rows { held, first, others: needed.swap_remove(self.ranks.rank()), fetched }
    }

    /// The rows of a field that are `wanted` of each process, none of its own; `held` are the rows of this slab.
    fn fetch<A: Sent>(&self, held: ArrayView2<'_, A>, wanted: &[Vec<usize>]) -> Array2<A> {
        let (own, ranks) = (self.ranks.rank(), 0..self.ranks.count());
        // the rows of one process that another needs, in the order in which it needs them
        let passed = |from: usize, to: usize| {
            let rows = self.rows_of(from);
            wanted[to].iter().enumerate().filter(move |(_, row)| rows.contains(row))
        };
        let (start, width) = (self.rows().start, held.ncols());
        let mut sent = Vec::new();
        for to in ranks.clone() {
            passed(own, to).for_each(|(_, row)| sent.extend(held.row(row - start)));
        }
        let mut received = vec![A::default(); wanted[own].len() * width];
        let of = |from: usize, to: usize| passed(from, to).count() * width;
        self.ranks.exchange(&sent, &self.shares(|to| of(own, to)), &mut received, &self.shares(|from| of(from, own)));
        let mut rows = Array2::default((wanted[own].len(), width));
        let mut next = received.chunks(width.max(1));
        for (k, _) in ranks.flat_map(|from| passed(from, own)) {
            rows.row_mut(k).iter_mut().zip(next.next().unwrap_or_default()).for_each(|(to, &from)| *to = from);
        }
        rows
    }

    /// A field in the rows of another slab of the same grid. All processes have to call it.
    pub(crate) fn moved<'a, A: Sent>(&self, field: CowArray<'a, A, Ix2>, to: &Self) -> CowArray<'a, A, Ix2> {
        if !self.is_shared() || self == to {
            return field;
        }
        let mut moved = Array2::default((to.rows().len(), field.ncols()));
        let rows = self.rows_for(field, to, |row| [row]);
        to.rows().zip(moved.rows_mut()).for_each(|(row, mut moved)| moved.assign(&rows.row(row)));
        moved.into()
    }

    /// The field of the whole grid, on every process, from the rows that each slab `held`. All processes have to call
    /// it.
    pub(crate) fn whole_of<'a, A: Sent>(&self, held: impl Into<CowArray<'a, A, Ix2>>) -> CowArray<'a, A, Ix2> {
        let held = held.into();
        if !self.is_shared() {
            return held;
        }
        let ranks = 0..self.ranks.count();
        let mut whole = Array2::default(self.shape);
        // a band of each process at a time, as MPI counts no more than 2³¹ numbers
        for turn in 0..ranks.clone().map(|rank| self.bands_of(rank).len()).max().unwrap_or_default() {
            let rows = |rank: usize| {
                let Range { start, end } = self.bands_of(rank);
                let [first, last] = [turn, turn + 1].map(|band| self.shape.0.min((start + band).min(end) * self.band));
                first..last
            };
            let (own, start) = (rows(self.ranks.rank()), self.rows().start);
            let sent = held.slice_axis(Axis(0), Slice::from(own.start - start..own.end - start));
            let mut received = self.ranks.lists(sent.iter().copied().collect()).into_iter();
            for rank in ranks.clone() {
                let mut of_rank = whole.slice_axis_mut(Axis(0), Slice::from(rows(rank)));
                of_rank.iter_mut().zip(received.by_ref()).for_each(|(to, from)| *to = from);
            }
        }
        whole.into()
    }

    /// The value of each process, in their order. All processes have to call it.
    pub(crate) fn each<E: Sent>(&self, own: E) -> Vec<E> {
        self.ranks.each(own)
    }

    pub(crate) fn bands_of(&self, rank: usize) -> Range<usize> {
        let (bands, count) = (self.bands(), self.ranks.count());
        (rank * bands).div_ceil(count)..((rank + 1) * bands).div_ceil(count)
    }

    /// The number of bands that the processes share: the bands of the grid, or for a window the bands of the larger
    /// grid.
    pub(crate) fn bands(&self) -> usize {
        self.bands
    }

    pub(crate) fn chunks_of_a_band(&self) -> usize {
        (self.band * self.shape.1).div_ceil(CHUNK).max(1)
    }

    /// The parts of a buffer, one for each rank, by their lengths.
    pub(crate) fn shares(&self, of: impl Fn(usize) -> usize) -> Shares {
        Shares::new((0..self.ranks.count()).map(of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs_are_whole_tiles_and_whole_chunks_and_cover_the_grid() {
        for shape in [(1, 1), (40, 40), (512, 512), (1000, 257), (999, 260), (4096, 4096), (65536, 65536), (70_000, 1)]
        {
            for count in [1, 2, 3, 4, 7, 2000] {
                let slab = Slab::new(shape, Ranks::of(0, count));
                assert!(slab.bands() <= BANDS + 1, "{shape:?}");
                let (mut row, mut column) = (0, 0);
                for rank in 0..count {
                    let (rows, columns) = (slab.rows_of(rank), slab.share_of(shape.1 / 2 + 1, rank));
                    assert_eq!((rows.start, columns.start), (row, column), "{shape:?} {count}");
                    (row, column) = (rows.end, columns.end);
                    if rows.end < shape.0 {
                        assert!(rows.end.is_multiple_of(TILE) && (rows.end * shape.1).is_multiple_of(CHUNK));
                    }
                }
                assert_eq!((row, column), (shape.0, shape.1 / 2 + 1), "{shape:?} {count}");
            }
        }
        // as many as there are, of the same size
        let slab = Slab::new((512, 512), Ranks::of(0, 4));
        assert_eq!([0, 1, 2, 3].map(|rank| slab.rows_of(rank)), [0..128, 128..256, 256..384, 384..512]);
    }

    #[test]
    fn memory_that_no_system_has_is_refused() {
        let asked = |shape| Slab::whole(shape).afford("a solve", 40);
        // more than the addresses of a process, and more bytes than there are numbers for them
        for shape in [(1 << 22, 1 << 22), (1 << 40, 1 << 40)] {
            let text = asked(shape).unwrap_err().to_string();
            assert!(text.starts_with(&format!("a solve on {} x {} nodes takes", shape.0, shape.1)), "{text}");
        }
        assert_eq!(asked((1 << 11, 1 << 11)), Ok(()));
    }
}
