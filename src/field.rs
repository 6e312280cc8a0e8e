//! Passes over fields: chunk by chunk, with sums that do not depend on the number of threads.

use ndarray::Array2;

use crate::par::{self, IndexedParallelIterator};

/// Nodes that one work item treats: a few of its fields and two buffers stay in a core's cache.
pub(crate) const CHUNK: usize = 2048;

/// How many numbers a pass can sum at once.
const SUMS: usize = 9;

/// What a pass over a chunk found: sums, and a minimum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partial {
    pub(crate) sum: [f64; SUMS],
    pub(crate) min: f64,
}

impl Partial {
    pub(crate) const NONE: Self = Self { sum: [0.0; SUMS], min: f64::INFINITY };
}

/// Runs the passes over fields of one size, and adds up what the chunks return, in their order.
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
        par::map_into(chunks, &mut self.0, |i, chunk| f(i * CHUNK, chunk));
        self.0.iter().fold(Partial::NONE, |mut total, part| {
            total.sum.iter_mut().zip(part.sum).for_each(|(total, part)| *total += part);
            total.min = total.min.min(part.min);
            total
        })
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
