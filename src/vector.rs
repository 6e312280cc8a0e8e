//! Loops on vector instructions, with sums that do not depend on their width.

use pulp::{Arch, Simd, WithSimd};

use crate::field::found;

/// The number of modes of a spectrum with terms that are stored before they are summed: a loop without sums vectorises.
pub(crate) const BLOCK: usize = 64;

/// The number of nodes with terms that `sums!` stores before it sums: few, as each chunk clears their place.
pub(crate) const NODES: usize = 32;

/// Sums that run side by side.
pub(crate) const LANES: usize = 8;

/// The terms of a block, where no vector of them crosses a line of the cache.
#[repr(align(64))]
pub(crate) struct Aligned<T>(pub(crate) T);

/// A closure to run on vector instructions. Held in a struct it is inlined; called by value it would be compiled as a
/// function of its own, without them.
struct Vectorised<F>(F);

impl<F: FnMut()> WithSimd for Vectorised<F> {
    type Output = ();
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        (self.0)();
    }
}

/// Runs a closure, which has to be `#[inline(always)]` and to change something, on vector instructions.
#[inline(always)]
pub(crate) fn vectorised(f: impl FnMut()) {
    Arch::new().dispatch(Vectorised(f));
}

/// The lowest and the highest of no values.
pub(crate) const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// The lowest and the highest of some values, those left out that are not a number.
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    let (whole, rest) = values.as_chunks::<LANES>();
    let (mut low, mut high) = ([NOTHING.0; LANES], [NOTHING.1; LANES]);
    let (lows, highs) = (&mut low, &mut high);
    vectorised(
        #[inline(always)]
        move || {
            let (mut low, mut high) = ([NOTHING.0; LANES], [NOTHING.1; LANES]);
            for values in whole {
                for l in 0..LANES {
                    low[l] = if values[l] < low[l] { values[l] } else { low[l] };
                    high[l] = if values[l] > high[l] { values[l] } else { high[l] };
                }
            }
            (*lows, *highs) = (low, high);
        },
    );
    let (low, high) = (low.into_iter().chain(rest.iter().copied()), high.into_iter().chain(rest.iter().copied()));
    (low.fold(NOTHING.0, f64::min), high.fold(NOTHING.1, f64::max))
}

found! {
    /// The result of a loop that sums one term.
    pub(crate) struct Single { pub(crate) sum: f64 }
}

/// Sums terms of a chunk's nodes: `|i| term`, or several that go to the fields of a struct of `Sums`, and one with a
/// least value, `|i| { let … } => Name { field: term, …; least field: term }`. Other fields have no nodes.
macro_rules! sums {
    ([$($read:ident),*], [$($write:ident),*], |$i:ident| { $($body:tt)* } => $Name:ident {
        $($field:ident: $term:expr),* $(; least $least:ident: $low:expr)?
    }) => {{
        let mut found = <$Name as $crate::field::Sums>::NONE;
        let part = &mut found;
        $(let $read = &$read[..];)*
        $(let $write = &mut *$write;)*
        // the closure holds copies: a value behind a reference would be read anew for every node
        $crate::vector::vectorised(
            #[inline(always)]
            move || {
                use $crate::vector::{Aligned, LANES, NODES};
                const COUNT: usize = [$(stringify!($field)),*].len();
                let len = usize::MAX$(.min($read.len()))*$(.min($write.len()))*;
                let (mut lanes, mut block) = ([[0.0_f64; LANES]; COUNT], Aligned([[0.0_f64; NODES]; COUNT]));
                $(let (mut least, mut $least) = ([f64::INFINITY; LANES], Aligned([f64::INFINITY; NODES]));)?
                let mut start = 0;
                while start < len {
                    let size = NODES.min(len - start);
                    $(let $read = &$read[start..start + size];)*
                    $(let $write = &mut $write[start..start + size];)*
                    let block = &mut block.0;
                    $(let $least = &mut $least.0;)?
                    for $i in 0..size {
                        $($body)*
                        let terms: [f64; COUNT] = [$($term),*];
                        $($least[$i] = $low;)?
                        for s in 0..COUNT {
                            block[s][$i] = terms[s];
                        }
                    }
                    if size < NODES {
                        for s in 0..COUNT {
                            block[s][size..].fill(0.0);
                        }
                        $($least[size..].fill(f64::INFINITY);)?
                    }
                    for s in 0..COUNT {
                        for k in 0..NODES / LANES {
                            for l in 0..LANES {
                                lanes[s][l] += block[s][k * LANES + l];
                            }
                        }
                    }
                    $(for k in 0..NODES / LANES {
                        for l in 0..LANES {
                            let low = $least[k * LANES + l];
                            least[l] = if low < least[l] { low } else { least[l] };
                        }
                    })?
                    start += size;
                }
                let mut sums = [0.0; COUNT];
                for s in 0..COUNT {
                    let l = &lanes[s];
                    sums[s] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
                }
                [$(part.$field),*] = sums;
                $(for low in least {
                    part.$least.0 = if low < part.$least.0 { low } else { part.$least.0 };
                })?
            },
        );
        found
    }};
    ([$($read:ident),*], [$($write:ident),*], |$i:ident| $term:expr) => {{
        use $crate::vector::Single;
        sums!([$($read),*], [$($write),*], |$i| {} => Single { sum: $term }).sum
    }};
}

/// Runs a loop that sums nothing on vector instructions.
macro_rules! vectors {
    ([$($read:ident),*], [$($write:ident),*], |$i:ident| $body:block) => {{
        $(let $read = &$read[..];)*
        $(let $write = &mut *$write;)*
        $crate::vector::vectorised(
            #[inline(always)]
            move || {
                let len = usize::MAX$(.min($read.len()))*$(.min($write.len()))*;
                $(let $read = &$read[..len];)*
                $(let $write = &mut $write[..len];)*
                for $i in 0..len $body
            },
        );
    }};
}

pub(crate) use {sums, vectors};
