//! Fields, and passes over them: chunk by chunk, with sums that do not depend on the number of threads.

use std::borrow::Cow;
use std::ops::Deref;

use ndarray::{Array2, ArrayView2, ArrayViewMut2, CowArray, Ix2};

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

/// The numbers of the largest result of a pass.
type Numbers = [f64; 16];

/// The result of a pass over nodes: sums, [minima](Minimum), [structs](found) of them with names, or nothing.
pub(crate) trait Sums: Copy + Send + Sync {
    /// the result of no nodes
    const NONE: Self;

    /// Calls a function of each number, and of whether it is a minimum.
    fn each(&mut self, of: &mut impl FnMut(&mut f64, bool));

    fn numbers(mut self) -> Numbers {
        const { assert!(size_of::<Self>() <= size_of::<Numbers>(), "more sums than `Numbers` holds: make it larger") };
        let mut numbers = Numbers::default();
        let mut places = numbers.iter_mut();
        self.each(&mut |number, _| places.by_ref().take(1).for_each(|place| *place = *number));
        numbers
    }

    fn add(mut self, numbers: &Numbers) -> Self {
        let mut others = numbers.iter();
        self.each(&mut |number, least| {
            let other = others.next().copied().unwrap_or_default();
            *number = if least { number.min(other) } else { *number + other };
        });
        self
    }
}

impl Sums for () {
    const NONE: Self = ();
    fn each(&mut self, _: &mut impl FnMut(&mut f64, bool)) {}
}

impl Sums for f64 {
    const NONE: Self = 0.0;
    fn each(&mut self, of: &mut impl FnMut(&mut f64, bool)) {
        of(self, false);
    }
}

impl<const N: usize> Sums for [f64; N] {
    const NONE: Self = [0.0; N];
    fn each(&mut self, of: &mut impl FnMut(&mut f64, bool)) {
        self.iter_mut().for_each(|sum| of(sum, false));
    }
}

/// The least of some numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Minimum(pub(crate) f64);

impl Sums for Minimum {
    const NONE: Self = Self(f64::INFINITY);
    fn each(&mut self, of: &mut impl FnMut(&mut f64, bool)) {
        of(&mut self.0, true);
    }
}

/// Declares a struct of [`Sums`] with names, which is one itself.
macro_rules! found {
    ($(#[$about:meta])* $see:vis struct $Name:ident {
        $($(#[$meta:meta])* $of:vis $field:ident: $kind:ty),* $(,)?
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        $see struct $Name { $($(#[$meta])* $of $field: $kind),* }

        impl $crate::field::Sums for $Name {
            const NONE: Self = Self { $($field: <$kind as $crate::field::Sums>::NONE),* };
            fn each(&mut self, of: &mut impl FnMut(&mut f64, bool)) {
                $($crate::field::Sums::each(&mut self.$field, of);)*
            }
        }
    };
}
pub(crate) use found;

/// The reducer of passes over fields in a slab: adds up the results of the chunks in their order, then the results of
/// slabs.
#[derive(Debug)]
pub(crate) struct Reducer {
    chunks: Vec<Numbers>,
    slab: Slab,
    /// the sums of the bands of this process, and of all
    shares: Shares,
    own: Vec<Numbers>,
    all: Vec<Numbers>,
}

impl Reducer {
    pub(crate) fn new(slab: Slab) -> Self {
        let (rows, columns) = slab.held();
        let chunks = vec![Numbers::default(); (rows * columns).div_ceil(CHUNK)];
        let shares = slab.shares(|rank| Numbers::default().len() * slab.bands_of(rank).len());
        let [own, all] =
            [slab.bands_of(slab.ranks().rank()).len(), slab.bands()].map(|bands| vec![Numbers::default(); bands]);
        Self { chunks, slab, shares, own, all }
    }

    /// The reducer of a whole field of this shape.
    pub(crate) fn whole(shape: (usize, usize)) -> Self {
        Self::new(Slab::whole(shape))
    }

    /// Runs `f(first node, chunk)` over the chunks; nodes count on the whole grid.
    pub(crate) fn run<A: Parts, S: Sums>(&mut self, chunks: A, f: impl Fn(usize, A::Part) -> S + Sync + Send) -> S {
        self.run_where(|_| true, chunks, f)
    }

    /// Runs `f(first node, chunk)` over the chunks with a `wanted` number.
    pub(crate) fn run_where<A: Parts, S: Sums>(
        &mut self,
        wanted: impl Fn(usize) -> bool + Sync + Send,
        chunks: A,
        f: impl Fn(usize, A::Part) -> S + Sync + Send,
    ) -> S {
        self.each(chunks, &|i, first, chunk| if wanted(i) { f(first, chunk) } else { S::NONE }.numbers());
        self.total()
    }

    /// Keeps the numbers `f(number of the chunk, first node, chunk)`: a loop that is compiled once for each kind of chunks.
    fn each<A: Parts>(&mut self, chunks: A, f: &(dyn Fn(usize, usize, A::Part) -> Numbers + Sync)) {
        let first = self.slab.first_node();
        par::update(chunks, &mut self.chunks, |i, chunk, numbers| *numbers = f(i, first + i * CHUNK, chunk));
    }

    /// Keeps a number of each chunk of the last pass, for a later one.
    pub(crate) fn keep<S: Sums>(&self, of: impl Fn(S) -> f64, kept: &mut [f64]) {
        kept.iter_mut().zip(&self.chunks).for_each(|(kept, numbers)| *kept = of(S::NONE.add(numbers)));
    }

    pub(crate) fn chunks(&self) -> usize {
        self.chunks.len()
    }

    fn total<S: Sums>(&mut self) -> S {
        if size_of::<S>() == 0 {
            return S::NONE;
        }
        // the sums of chunks are summed as nodes are: in runs, and then the runs
        let run = |run: &[Numbers]| run.iter().fold(S::NONE, S::add).numbers();
        let band = |band: &[Numbers]| band.chunks(CHUNK).map(run).fold(S::NONE, |sum, run| sum.add(&run)).numbers();
        let bands = self.chunks.chunks(self.slab.chunks_of_a_band()).map(band);
        // bands beyond a window have no nodes
        let bands = bands.chain(std::iter::repeat(S::NONE.numbers()));
        self.own.iter_mut().zip(bands).for_each(|(own, band)| *own = band);
        self.slab.ranks().gather(self.own.as_flattened(), &self.shares, self.all.as_flattened_mut());
        self.all.iter().fold(S::NONE, S::add)
    }
}

/// A field of the crate's own, contiguous in row-major order. It is read as an array.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Field<T>(Array2<T>);

impl<T> Deref for Field<T> {
    type Target = Array2<T>;
    fn deref(&self) -> &Array2<T> {
        &self.0
    }
}

impl<T: Clone + Default + 'static> Field<T> {
    /// The field of an array, which is copied if it is borrowed or in another order.
    pub(crate) fn of<'a>(array: impl Into<CowArray<'a, T, Ix2>>) -> Self {
        let array = array.into();
        Self(if array.is_standard_layout() { array.into_owned() } else { array.as_standard_layout().into_owned() })
    }

    pub(crate) fn zeros(shape: (usize, usize)) -> Self {
        Self::filled(shape, T::default())
    }

    pub(crate) fn filled(shape: (usize, usize), value: T) -> Self {
        Self(Array2::from_elem(shape, value))
    }
}

impl<T> Field<T> {
    pub(crate) fn from_fn(shape: (usize, usize), f: impl FnMut((usize, usize)) -> T) -> Self {
        Self(Array2::from_shape_fn(shape, f))
    }

    pub(crate) fn nodes(&self) -> &[T] {
        contiguous(self.0.as_slice())
    }

    pub(crate) fn nodes_mut(&mut self) -> &mut [T] {
        contiguous(self.0.as_slice_mut())
    }

    pub(crate) fn view_mut(&mut self) -> ArrayViewMut2<'_, T> {
        self.0.view_mut()
    }

    pub(crate) fn into_array(self) -> Array2<T> {
        self.0
    }
}

/// The nodes of an array that is contiguous by construction.
pub(crate) fn contiguous<S: Default>(nodes: Option<S>) -> S {
    assert!(nodes.is_some(), "an array is not in the order of its construction");
    nodes.unwrap_or_default()
}

/// The nodes of an array in row-major order, copied if it is in another one.
pub(crate) fn ordered<T: Clone>(array: ArrayView2<'_, T>) -> Cow<'_, [T]> {
    array.to_slice().map_or_else(|| array.iter().cloned().collect(), Cow::Borrowed)
}

pub(crate) fn read<T: Sync>(field: &Field<T>) -> impl Parts<Part = &[T]> {
    par::chunks(field.nodes(), CHUNK)
}

pub(crate) fn write<T: Send>(field: &mut Field<T>) -> impl Parts<Part = &mut [T]> {
    par::chunks_mut(field.nodes_mut(), CHUNK)
}
