//! Parallel loops, on rayon's threads or, without rayon, on one.

use std::sync::{Mutex, MutexGuard, PoisonError};

#[cfg(feature = "parallel")]
pub(crate) use parallel::*;
#[cfg(not(feature = "parallel"))]
pub(crate) use serial::*;

/// One workspace per worker, made once: the hot loop never allocates.
#[derive(Debug)]
pub(crate) struct Pool<W>(Vec<Mutex<W>>);

impl<W> Pool<W> {
    pub(crate) fn new(make: impl Fn() -> W) -> Self {
        Self((0..workers()).map(|_| Mutex::new(make())).collect())
    }

    /// The workspace of this worker. It may be dirty.
    pub(crate) fn get(&self) -> MutexGuard<'_, W> {
        self.0[worker() % self.0.len()].lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(feature = "parallel")]
mod parallel {
    pub(crate) use rayon::iter::IndexedParallelIterator;
    use rayon::iter::{IntoParallelIterator, ParallelIterator};
    use rayon::slice::{Chunks, ChunksMut, ParallelSlice, ParallelSliceMut};

    pub(super) fn workers() -> usize {
        rayon::current_num_threads()
    }

    pub(super) fn worker() -> usize {
        rayon::current_thread_index().unwrap_or(0)
    }

    pub(crate) fn chunks<T: Sync>(field: &[T], size: usize) -> Chunks<'_, T> {
        field.par_chunks(size)
    }

    pub(crate) fn chunks_mut<T: Send>(field: &mut [T], size: usize) -> ChunksMut<'_, T> {
        field.par_chunks_mut(size)
    }

    /// Runs `f` on the pairs of two sequences.
    pub(crate) fn for_each<A, B>(a: A, b: B, f: impl Fn(A::Item, B::Item) + Sync + Send)
    where
        A: IntoParallelIterator<Iter: IndexedParallelIterator>,
        B: IntoParallelIterator<Iter: IndexedParallelIterator>,
    {
        (a, b).into_par_iter().for_each(|(a, b)| f(a, b));
    }

    /// Runs `f(index, item, result)` on every item; a worker takes at least `batch` of them at once.
    pub(crate) fn update<A, R: Send>(
        items: A,
        results: &mut [R],
        batch: usize,
        f: impl Fn(usize, A::Item, &mut R) + Sync + Send,
    ) where
        A: IndexedParallelIterator,
    {
        items.zip(results).enumerate().with_min_len(batch).for_each(|(i, (item, result))| f(i, item, result));
    }
}

#[cfg(not(feature = "parallel"))]
mod serial {
    /// The trait with `zip`, by its name in rayon.
    pub(crate) use Iterator as IndexedParallelIterator;
    use std::slice::{Chunks, ChunksMut};

    pub(super) fn workers() -> usize {
        1
    }

    pub(super) fn worker() -> usize {
        0
    }

    pub(crate) fn chunks<T>(field: &[T], size: usize) -> Chunks<'_, T> {
        field.chunks(size)
    }

    pub(crate) fn chunks_mut<T>(field: &mut [T], size: usize) -> ChunksMut<'_, T> {
        field.chunks_mut(size)
    }

    /// Runs `f` on the pairs of two sequences.
    pub(crate) fn for_each<A: IntoIterator, B: IntoIterator>(a: A, b: B, f: impl Fn(A::Item, B::Item)) {
        std::iter::zip(a, b).for_each(|(a, b)| f(a, b));
    }

    /// Runs `f(index, item, result)` on every item.
    pub(crate) fn update<A: Iterator, R>(items: A, results: &mut [R], _: usize, f: impl Fn(usize, A::Item, &mut R)) {
        items.zip(results).enumerate().for_each(|(i, (item, result))| f(i, item, result));
    }
}
