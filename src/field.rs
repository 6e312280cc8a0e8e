//! Passes over fields: chunk by chunk, with sums that do not depend on the number of threads.

use ndarray::Array2;

use crate::par::{self, IndexedParallelIterator};

/// The nodes of a chunk, which are summed one after the other. The rounding of sums of sums grows with the length of a
/// run, not with the number of nodes.
pub(crate) const CHUNK: usize = 256;

/// Chunks that a worker takes at once.
const BATCH: usize = 8;

/// The number of sums of a pass.
pub(crate) const SUMS: usize = 13;

/// The result of a pass over a chunk: sums, and a minimum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partial {
    pub(crate) sum: [f64; SUMS],
    pub(crate) min: f64,
}

impl Partial {
    pub(crate) const NONE: Self = Self { sum: [0.0; SUMS], min: f64::INFINITY };

    fn add(mut self, other: &Self) -> Self {
        self.sum.iter_mut().zip(other.sum).for_each(|(sum, other)| *sum += other);
        self.min = self.min.min(other.min);
        self
    }
}

/// The reducer: runs passes over fields of one size, and adds up the results of the chunks in their order.
#[derive(Debug)]
pub(crate) struct Reducer(Vec<Partial>);

impl Reducer {
    pub(crate) fn new(nodes: usize) -> Self {
        Self(vec![Partial::NONE; nodes.div_ceil(CHUNK)])
    }

    /// Runs `f(first node, chunk)` over the chunks.
    pub(crate) fn run<A: IndexedParallelIterator>(
        &mut self,
        chunks: A,
        f: impl Fn(usize, A::Item) -> Partial + Sync + Send,
    ) -> Partial {
        par::update(chunks, &mut self.0, BATCH, |i, chunk, part| *part = f(i * CHUNK, chunk));
        self.total()
    }

    /// Runs `f(first node, chunk)` over the chunks whose kept number is `wanted`.
    pub(crate) fn run_where<A: IndexedParallelIterator>(
        &mut self,
        kept: &[f64],
        wanted: impl Fn(f64) -> bool + Sync + Send,
        chunks: A,
        f: impl Fn(usize, A::Item) -> Partial + Sync + Send,
    ) -> Partial {
        par::update(chunks, &mut self.0, BATCH, |i, chunk, part| {
            *part = if wanted(kept[i]) { f(i * CHUNK, chunk) } else { Partial::NONE };
        });
        self.total()
    }

    /// Keeps a number of each chunk of the last pass, for a later one.
    pub(crate) fn keep(&self, of: impl Fn(&Partial) -> f64, kept: &mut [f64]) {
        kept.iter_mut().zip(&self.0).for_each(|(kept, part)| *kept = of(part));
    }

    /// The number of chunks.
    pub(crate) fn chunks(&self) -> usize {
        self.0.len()
    }

    fn total(&self) -> Partial {
        // the sums of chunks are summed as nodes are: in runs, and then the runs
        self.0
            .chunks(CHUNK)
            .map(|run| run.iter().fold(Partial::NONE, Partial::add))
            .fold(Partial::NONE, |a, b| a.add(&b))
    }
}

/// The nodes of a field that this crate made, in row-major order.
pub(crate) fn flat<T>(field: &Array2<T>) -> &[T] {
    field.as_slice().unwrap_or_default()
}

/// The nodes of a field that this crate made, in row-major order.
pub(crate) fn flat_mut<T>(field: &mut Array2<T>) -> &mut [T] {
    field.as_slice_mut().unwrap_or_default()
}

/// The chunks of a field, to read.
pub(crate) fn read<T: Sync>(field: &Array2<T>) -> impl IndexedParallelIterator<Item = &[T]> {
    par::chunks(flat(field), CHUNK)
}

/// The chunks of a field, to write.
pub(crate) fn write<T: Send>(field: &mut Array2<T>) -> impl IndexedParallelIterator<Item = &mut [T]> {
    par::chunks_mut(flat_mut(field), CHUNK)
}
