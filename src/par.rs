//! Parallel loops, on rayon's threads or, without rayon, on one.

use std::sync::{Mutex, MutexGuard, PoisonError};

use ndarray::{ArrayView2, ArrayViewMut2, Axis};

/// The pieces of a loop for each worker. There are several, so that a worker that starts late gets fewer of them.
const PIECES: usize = 8;

/// The least number of nodes that a worker takes at once. Fewer nodes take less time than waking another worker.
const WORTH: usize = 4096;

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

/// A sequence of parts of one field or of several, each of them the work of one thread.
pub(crate) trait Parts: Sized + Send {
    type Part;

    fn count(&self) -> usize;

    /// The number of nodes of a part.
    fn nodes(&self) -> usize;

    /// The first `at` parts, and the others.
    fn divide(self, at: usize) -> (Self, Self);

    fn next(&mut self) -> Option<Self::Part>;

    fn zip<B: Parts>(self, other: B) -> (Self, B) {
        (self, other)
    }
}

impl<A: Parts, B: Parts> Parts for (A, B) {
    type Part = (A::Part, B::Part);

    fn count(&self) -> usize {
        self.0.count().min(self.1.count())
    }

    fn nodes(&self) -> usize {
        self.0.nodes().max(self.1.nodes())
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.divide(at), self.1.divide(at));
        ((a, b), (c, d))
    }

    fn next(&mut self) -> Option<Self::Part> {
        match (self.0.next(), self.1.next()) {
            (Some(a), Some(b)) => Some((a, b)),
            _ => None,
        }
    }
}

impl<A: Parts> Parts for Vec<A> {
    type Part = Vec<A::Part>;

    fn count(&self) -> usize {
        self.iter().map(A::count).min().unwrap_or(0)
    }

    fn nodes(&self) -> usize {
        self.iter().map(A::nodes).sum()
    }

    fn divide(self, at: usize) -> (Self, Self) {
        self.into_iter().map(|parts| parts.divide(at)).unzip()
    }

    fn next(&mut self) -> Option<Self::Part> {
        if self.is_empty() { None } else { self.iter_mut().map(A::next).collect() }
    }
}

/// Runs of `size` nodes, the last of which may be shorter.
pub(crate) struct Chunks<'a, T>(&'a [T], usize);

impl<'a, T: Sync> Parts for Chunks<'a, T> {
    type Part = &'a [T];

    fn count(&self) -> usize {
        self.0.len().div_ceil(self.1)
    }

    fn nodes(&self) -> usize {
        self.1
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let (first, others) = self.0.split_at(self.0.len().min(at * self.1));
        (Self(first, self.1), Self(others, self.1))
    }

    fn next(&mut self) -> Option<Self::Part> {
        let (first, others) = self.0.split_at(self.0.len().min(self.1));
        self.0 = others;
        (!first.is_empty()).then_some(first)
    }
}

pub(crate) struct ChunksMut<'a, T>(&'a mut [T], usize);

impl<'a, T: Send> Parts for ChunksMut<'a, T> {
    type Part = &'a mut [T];

    fn count(&self) -> usize {
        self.0.len().div_ceil(self.1)
    }

    fn nodes(&self) -> usize {
        self.1
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let end = self.0.len().min(at * self.1);
        let (first, others) = self.0.split_at_mut(end);
        (Self(first, self.1), Self(others, self.1))
    }

    fn next(&mut self) -> Option<Self::Part> {
        let nodes = std::mem::take(&mut self.0);
        let end = nodes.len().min(self.1);
        let (first, others) = nodes.split_at_mut(end);
        self.0 = others;
        (!first.is_empty()).then_some(first)
    }
}

/// Tiles of `size` rows, or of `size` columns, the last of which may be narrower.
pub(crate) struct Tiles<'a, T>(ArrayView2<'a, T>, Axis, usize);

impl<'a, T: Sync> Parts for Tiles<'a, T> {
    type Part = ArrayView2<'a, T>;

    fn count(&self) -> usize {
        self.0.len_of(self.1).div_ceil(self.2)
    }

    fn nodes(&self) -> usize {
        self.2 * self.0.len() / self.0.len_of(self.1).max(1)
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let end = self.0.len_of(self.1).min(at * self.2);
        let (first, others) = self.0.split_at(self.1, end);
        (Self(first, self.1, self.2), Self(others, self.1, self.2))
    }

    fn next(&mut self) -> Option<Self::Part> {
        let end = self.0.len_of(self.1).min(self.2);
        let (first, others) = self.0.split_at(self.1, end);
        self.0 = others;
        (end > 0).then_some(first)
    }
}

pub(crate) struct TilesMut<'a, T>(ArrayViewMut2<'a, T>, Axis, usize);

impl<'a, T: Send> Parts for TilesMut<'a, T> {
    type Part = ArrayViewMut2<'a, T>;

    fn count(&self) -> usize {
        self.0.len_of(self.1).div_ceil(self.2)
    }

    fn nodes(&self) -> usize {
        self.2 * self.0.len() / self.0.len_of(self.1).max(1)
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let end = self.0.len_of(self.1).min(at * self.2);
        let (first, others) = self.0.split_at(self.1, end);
        (Self(first, self.1, self.2), Self(others, self.1, self.2))
    }

    fn next(&mut self) -> Option<Self::Part> {
        let end = self.0.len_of(self.1).min(self.2);
        let nodes = std::mem::replace(&mut self.0, ArrayViewMut2::from_shape((0, 0), &mut []).ok()?);
        let (first, others) = nodes.split_at(self.1, end);
        self.0 = others;
        (end > 0).then_some(first)
    }
}

struct Results<'a, R>(&'a mut [R]);

impl<'a, R: Send> Parts for Results<'a, R> {
    type Part = &'a mut R;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn nodes(&self) -> usize {
        1
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let (first, others) = self.0.split_at_mut(at);
        (Self(first), Self(others))
    }

    fn next(&mut self) -> Option<Self::Part> {
        self.0.split_off_first_mut()
    }
}

pub(crate) fn chunks<T: Sync>(field: &[T], size: usize) -> Chunks<'_, T> {
    Chunks(field, size.max(1))
}

pub(crate) fn chunks_mut<T: Send>(field: &mut [T], size: usize) -> ChunksMut<'_, T> {
    ChunksMut(field, size.max(1))
}

/// The tiles of `size` rows (axis 0) or columns (axis 1) of a field.
pub(crate) fn tiles<T: Sync>(field: ArrayView2<'_, T>, axis: usize, size: usize) -> Tiles<'_, T> {
    Tiles(field, Axis(axis), size.max(1))
}

pub(crate) fn tiles_mut<T: Send>(field: ArrayViewMut2<'_, T>, axis: usize, size: usize) -> TilesMut<'_, T> {
    TilesMut(field, Axis(axis), size.max(1))
}

pub(crate) fn for_each<P: Parts>(parts: P, f: impl Fn(usize, P::Part) + Sync) {
    let most = most(&parts);
    piece(parts, 0, most, &f);
}

pub(crate) fn update<P: Parts, R: Send>(parts: P, results: &mut [R], f: impl Fn(usize, P::Part, &mut R) + Sync) {
    for_each((parts, Results(results)), |i, (part, result): (_, &mut R)| f(i, part, result));
}

/// The most parts that a worker takes at once.
fn most<P: Parts>(parts: &P) -> usize {
    match workers() {
        1 => parts.count(),
        workers => parts.count().div_ceil(PIECES * workers).max(WORTH.div_ceil(parts.nodes().max(1))),
    }
}

/// Runs `f` on the parts, the first of which has the index `first`. A few parts run one after the other.
fn piece<P: Parts>(mut parts: P, first: usize, most: usize, f: &(impl Fn(usize, P::Part) + Sync)) {
    let count = parts.count();
    if count > most {
        let half = count / 2;
        let (left, right) = parts.divide(half);
        let (mut left, mut right) = (Some(left), Some(right));
        let mut left = || {
            if let Some(parts) = left.take() {
                piece(parts, first, most, f);
            }
        };
        let mut right = || {
            if let Some(parts) = right.take() {
                piece(parts, first + half, most, f);
            }
        };
        return both(&mut left, &mut right);
    }
    let mut index = first;
    while let Some(part) = parts.next() {
        f(index, part);
        index += 1;
    }
}

/// Runs work of many loops on one of the workers, where each loop starts at once. From another thread each loop would
/// have to wake a worker first.
#[cfg(feature = "parallel")]
pub(crate) fn within<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    rayon::scope(|_| work())
}

/// Runs both, side by side if a worker is idle. Rayon's part is compiled once, since it sees no types of closures.
#[cfg(feature = "parallel")]
#[inline(never)]
fn both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    rayon::join(a, b);
}

#[cfg(feature = "parallel")]
fn workers() -> usize {
    rayon::current_num_threads()
}

#[cfg(feature = "parallel")]
fn worker() -> usize {
    rayon::current_thread_index().unwrap_or(0)
}

#[cfg(not(feature = "parallel"))]
pub(crate) fn within<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    work()
}

#[cfg(not(feature = "parallel"))]
fn both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    a();
    b();
}

#[cfg(not(feature = "parallel"))]
fn workers() -> usize {
    1
}

#[cfg(not(feature = "parallel"))]
fn worker() -> usize {
    0
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    #[test]
    fn every_part_is_visited_once_with_its_index() {
        for (nodes, size) in [(0, 3), (1, 3), (9, 3), (10, 3), (1000, 7)] {
            let (input, mut output) = ((0..nodes).collect::<Vec<_>>(), vec![usize::MAX; nodes]);
            let mut lengths = vec![0; input.len().div_ceil(size)];
            update(chunks(&input, size).zip(chunks_mut(&mut output, size)), &mut lengths, |i, (from, to), length| {
                assert_eq!(from[0], i * size);
                to.copy_from_slice(from);
                *length = to.len();
            });
            assert_eq!(input, output);
            assert_eq!(lengths.iter().sum::<usize>(), nodes);
        }
    }

    #[test]
    fn tiles_cover_a_field_along_either_axis() {
        for axis in [0, 1] {
            let field = Array2::from_shape_fn((13, 9), |(i, j)| 9 * i + j);
            let mut copy = Array2::zeros((13, 9));
            for_each(tiles(field.view(), axis, 4).zip(tiles_mut(copy.view_mut(), axis, 4)), |i, (from, mut to)| {
                assert_eq!(from[[0, 0]], 4 * i * [9, 1][axis]);
                to.assign(&from);
            });
            assert_eq!(field, copy);
        }
    }
}
