//! Passes over fields: chunk by chunk, with sums that do not depend on the number of threads.

use ndarray::{Array2, ArrayView2};

use crate::error::{Error, Result};
use crate::par::{self, Parts};
use crate::ranks::Shares;
use crate::real::Real;
pub(crate) use crate::slab::CHUNK;
use crate::slab::Slab;

pub(crate) fn all_finite<T: Real>(name: &'static str, field: ArrayView2<'_, T>) -> Result<()> {
    // without places, and without an end within a chunk, the pass is many times as fast
    let all = |values: &[T]| values.chunks(CHUNK).all(|chunk| chunk.iter().fold(true, |all, v| all & v.is_finite()));
    if field.as_slice_memory_order().map_or_else(|| field.iter().all(|value| value.is_finite()), all) {
        return Ok(());
    }
    let mut wrong = field.indexed_iter().filter(|(_, value)| !value.is_finite());
    wrong.next().map_or(Ok(()), |(first, value)| {
        let (count, nodes, value) = (1 + wrong.count(), field.len(), value.widen());
        Err(Error::NotFinite { name, count, nodes, first, value })
    })
}

/// Refuses a field that is not finite in some slab: the process that has the first such node has the error.
pub(crate) fn all_finite_in<T: Real>(slab: Slab, name: &'static str, field: ArrayView2<'_, T>) -> Result<()> {
    let mut found = all_finite(name, field);
    let own = if let Err(Error::NotFinite { count, .. }) = &found { *count } else { 0 };
    let all = slab.each(own).iter().sum();
    if let Err(Error::NotFinite { count, nodes, first, .. }) = &mut found {
        (*count, *nodes, first.0) = (all, slab.nodes(), first.0 + slab.rows().start);
    }
    slab.agreed(found)
}

pub(crate) const SUMS: usize = 13;

/// The result of a pass over a chunk: sums, and a minimum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partial {
    pub(crate) sum: [f64; SUMS],
    pub(crate) min: f64,
}

impl Partial {
    pub(crate) const NONE: Self = Self { sum: [0.0; SUMS], min: f64::INFINITY };

    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut part = Self::NONE;
        part.sum[0] = values.sum();
        part
    }

    pub(crate) fn add(mut self, other: &Self) -> Self {
        self.sum.iter_mut().zip(other.sum).for_each(|(sum, other)| *sum += other);
        self.min = self.min.min(other.min);
        self
    }
}

/// The reducer of passes over fields in a slab: adds up the results of the chunks in their order, and those of slabs.
#[derive(Debug)]
pub(crate) struct Reducer {
    chunks: Vec<Partial>,
    slab: Slab,
    /// the sums of the bands of this process, and of all
    shares: Shares,
    own: Vec<[f64; NUMBERS]>,
    all: Vec<[f64; NUMBERS]>,
}

const NUMBERS: usize = SUMS + 1;

impl Reducer {
    pub(crate) fn new(slab: Slab) -> Self {
        let (rows, columns) = slab.held();
        let chunks = vec![Partial::NONE; (rows * columns).div_ceil(CHUNK)];
        let shares = slab.shares(|rank| NUMBERS * slab.bands_of(rank).len());
        let [own, all] =
            [slab.bands_of(slab.ranks().rank()).len(), slab.bands()].map(|bands| vec![[0.0; NUMBERS]; bands]);
        Self { chunks, slab, shares, own, all }
    }

    /// Runs `f(first node, chunk)` over the chunks; nodes count on the whole grid.
    pub(crate) fn run<A: Parts>(&mut self, chunks: A, f: impl Fn(usize, A::Part) -> Partial + Sync + Send) -> Partial {
        let first = self.slab.first_node();
        par::update(chunks, &mut self.chunks, |i, chunk, part| *part = f(first + i * CHUNK, chunk));
        self.total()
    }

    /// Runs `f(first node, chunk)` over the chunks whose kept number is `wanted`.
    pub(crate) fn run_where<A: Parts>(
        &mut self,
        kept: &[f64],
        wanted: impl Fn(f64) -> bool + Sync + Send,
        chunks: A,
        f: impl Fn(usize, A::Part) -> Partial + Sync + Send,
    ) -> Partial {
        let first = self.slab.first_node();
        par::update(chunks, &mut self.chunks, |i, chunk, part| {
            *part = if wanted(kept[i]) { f(first + i * CHUNK, chunk) } else { Partial::NONE };
        });
        self.total()
    }

    /// Keeps a number of each chunk of the last pass, for a later one.
    pub(crate) fn keep(&self, of: impl Fn(&Partial) -> f64, kept: &mut [f64]) {
        kept.iter_mut().zip(&self.chunks).for_each(|(kept, part)| *kept = of(part));
    }

    pub(crate) fn chunks(&self) -> usize {
        self.chunks.len()
    }

    fn total(&mut self) -> Partial {
        // the sums of chunks are summed as nodes are: in runs, and then the runs
        let add = |a: Partial, b: Partial| a.add(&b);
        let run = |run: &[Partial]| run.iter().fold(Partial::NONE, Partial::add);
        let bands = self.chunks.chunks(self.slab.chunks_of_a_band());
        let bands = bands.map(|band| band.chunks(CHUNK).map(run).fold(Partial::NONE, add));
        // bands beyond a window have no nodes
        for (numbers, Partial { sum, min }) in self.own.iter_mut().zip(bands.chain(std::iter::repeat(Partial::NONE))) {
            numbers[..SUMS].copy_from_slice(&sum);
            numbers[SUMS] = min;
        }
        self.slab.ranks().gather(self.own.as_flattened(), &self.shares, self.all.as_flattened_mut());
        let all = self.all.iter();
        let all = all.map(|numbers| Partial { sum: std::array::from_fn(|i| numbers[i]), min: numbers[SUMS] });
        all.fold(Partial::NONE, add)
    }
}

/// The nodes of a field that this crate made, in row-major order; none in another layout.
pub(crate) fn flat<T>(field: &Array2<T>) -> &[T] {
    field.as_slice().unwrap_or_default()
}

pub(crate) fn flat_mut<T>(field: &mut Array2<T>) -> &mut [T] {
    field.as_slice_mut().unwrap_or_default()
}

pub(crate) fn read<T: Sync>(field: &Array2<T>) -> impl Parts<Part = &[T]> {
    par::chunks(flat(field), CHUNK)
}

pub(crate) fn write<T: Send>(field: &mut Array2<T>) -> impl Parts<Part = &mut [T]> {
    par::chunks_mut(flat_mut(field), CHUNK)
}
