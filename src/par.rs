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

/// Nodes of one field or of several, which can be divided.
pub(crate) trait Nodes: Sized {
    /// The number of nodes.
    fn count(&self) -> usize;

    /// The first `at` nodes, and the others.
    fn divide(self, at: usize) -> (Self, Self);
}

impl<T> Nodes for &[T] {
    fn count(&self) -> usize {
        self.len()
    }
    fn divide(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl<T> Nodes for &mut [T] {
    fn count(&self) -> usize {
        self.len()
    }
    fn divide(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<A: Nodes, B: Nodes> Nodes for (A, B) {
    fn count(&self) -> usize {
        self.0.count()
    }
    fn divide(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.divide(at), self.1.divide(at));
        ((a, b), (c, d))
    }
}

/// Rows, or columns, of a field.
pub(crate) struct Tile<V>(pub(crate) V, Axis);

impl<T> Nodes for Tile<ArrayView2<'_, T>> {
    fn count(&self) -> usize {
        self.0.len_of(self.1)
    }
    fn divide(self, at: usize) -> (Self, Self) {
        let (first, others) = self.0.split_at(self.1, at);
        (Self(first, self.1), Self(others, self.1))
    }
}

impl<T> Nodes for Tile<ArrayViewMut2<'_, T>> {
    fn count(&self) -> usize {
        self.0.len_of(self.1)
    }
    fn divide(self, at: usize) -> (Self, Self) {
        let (first, others) = self.0.split_at(self.1, at);
        (Self(first, self.1), Self(others, self.1))
    }
}

/// Runs of `size` nodes, or tiles of `size` rows or columns; the last may be shorter.
pub(crate) struct Chunks<N> {
    rest: Option<N>,
    size: usize,
    /// the nodes of a row or a column
    width: usize,
}

impl<N: Nodes> Chunks<N> {
    fn new(nodes: N, size: usize, width: usize) -> Self {
        Self { rest: Some(nodes), size: size.max(1), width }
    }
}

impl<N: Nodes + Send> Parts for Chunks<N> {
    type Part = N;

    fn count(&self) -> usize {
        self.rest.as_ref().map_or(0, N::count).div_ceil(self.size)
    }

    fn nodes(&self) -> usize {
        self.size * self.width
    }

    fn divide(self, at: usize) -> (Self, Self) {
        let rest = self.rest.map(|nodes| {
            let end = nodes.count().min(at * self.size);
            nodes.divide(end)
        });
        let (first, others) = rest.unzip();
        (Self { rest: first, ..self }, Self { rest: others, ..self })
    }

    fn next(&mut self) -> Option<N> {
        let nodes = self.rest.take().filter(|nodes| nodes.count() > 0)?;
        let end = nodes.count().min(self.size);
        let (first, others) = nodes.divide(end);
        self.rest = Some(others);
        Some(first)
    }
}

pub(crate) fn chunks<T: Sync>(field: &[T], size: usize) -> Chunks<&[T]> {
    Chunks::new(field, size, 1)
}

pub(crate) fn chunks_mut<T: Send>(field: &mut [T], size: usize) -> Chunks<&mut [T]> {
    Chunks::new(field, size, 1)
}

/// The tiles of `size` rows (axis 0) or columns (axis 1) of a field.
pub(crate) fn tiles<T: Sync>(field: ArrayView2<'_, T>, axis: usize, size: usize) -> Chunks<Tile<ArrayView2<'_, T>>> {
    let width = field.len_of(Axis(1 - axis));
    Chunks::new(Tile(field, Axis(axis)), size, width)
}

pub(crate) fn tiles_mut<T: Send>(
    field: ArrayViewMut2<'_, T>,
    axis: usize,
    size: usize,
) -> Chunks<Tile<ArrayViewMut2<'_, T>>> {
    let width = field.len_of(Axis(1 - axis));
    Chunks::new(Tile(field, Axis(axis)), size, width)
}

pub(crate) fn for_each<P: Parts>(parts: P, f: impl Fn(usize, P::Part) + Sync) {
    let most = most(&parts);
    piece(parts, 0, most, &f);
}

pub(crate) fn update<P: Parts, R: Send>(parts: P, results: &mut [R], f: impl Fn(usize, P::Part, &mut R) + Sync) {
    for_each((parts, chunks_mut(results, 1)), |i, (part, result)| {
        if let [result] = result {
            f(i, part, result);
        }
    });
}

/// The most parts that a worker takes at once.
fn most<P: Parts>(parts: &P) -> usize {
    match workers() {
        1 => parts.count(),
        workers => parts.count().div_ceil(PIECES * workers).max(WORTH.div_ceil(parts.nodes().max(1))),
    }
}

/// Runs `f` on the parts, from the index `first` on. A few parts run one after the other. The call of `f` is not
/// inlined, so that the loop is compiled once for each kind of parts.
fn piece<P: Parts>(mut parts: P, first: usize, most: usize, f: &(dyn Fn(usize, P::Part) + Sync)) {
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

/// What is found along both sides of a map of so many nodes, by the axes, side by side if that is worth a worker.
pub fn along_sides<R: Send>(nodes: usize, find: impl Fn(usize) -> R + Sync) -> [R; 2] {
    #[cfg(feature = "parallel")]
    if nodes > WORTH && workers() > 1 {
        return rayon::join(|| find(0), || find(1)).into();
    }
    let _ = nodes;
    [0, 1].map(find)
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
            for_each(
                tiles(field.view(), axis, 4).zip(tiles_mut(copy.view_mut(), axis, 4)),
                |i, (Tile(from, _), Tile(mut to, _))| {
                    assert_eq!(from[[0, 0]], 4 * i * [9, 1][axis]);
                    to.assign(&from);
                },
            );
            assert_eq!(field, copy);
        }
    }
}
