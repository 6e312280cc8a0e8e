//! Loops on vector instructions, with sums that do not depend on their width.

use pulp::{Arch, Simd, WithSimd};

/// The modes of a spectrum whose terms are stored before they are summed: a loop without sums vectorises.
pub(crate) const BLOCK: usize = 64;

/// The nodes whose terms `sums!` stores before it sums them: few, as each chunk clears their place. Sums are the same.
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

/// Sums the terms of a chunk's nodes. With `least name`, the loop sets `name[i]` too, of which the least is found.
macro_rules! sums {
    ($count:literal, [$($read:ident),*], [$($write:ident),*], $(least $low:ident,)? |$i:ident| $terms:expr) => {{
        let mut total = $crate::field::Partial::NONE;
        let part = &mut total;
        $(let $read = &$read[..];)*
        $(let $write = &mut *$write;)*
        // the closure holds copies: a value behind a reference would be read anew for every node
        $crate::vector::vectorised(
            #[inline(always)]
            move || {
                use $crate::vector::{Aligned, LANES, NODES};
                let len = usize::MAX$(.min($read.len()))*$(.min($write.len()))*;
                let (mut lanes, mut block) = ([[0.0_f64; LANES]; $count], Aligned([[0.0_f64; NODES]; $count]));
                $(let (mut least, mut $low) = ([f64::INFINITY; LANES], Aligned([f64::INFINITY; NODES]));)?
                let mut start = 0;
                while start < len {
                    let size = NODES.min(len - start);
                    $(let $read = &$read[start..start + size];)*
                    $(let $write = &mut $write[start..start + size];)*
                    let block = &mut block.0;
                    $(let $low = &mut $low.0;)?
                    for $i in 0..size {
                        let terms: [f64; $count] = $terms;
                        for s in 0..$count {
                            block[s][$i] = terms[s];
                        }
                    }
                    if size < NODES {
                        for s in 0..$count {
                            block[s][size..].fill(0.0);
                        }
                        $($low[size..].fill(f64::INFINITY);)?
                    }
                    for s in 0..$count {
                        for k in 0..NODES / LANES {
                            for l in 0..LANES {
                                lanes[s][l] += block[s][k * LANES + l];
                            }
                        }
                    }
                    $(for k in 0..NODES / LANES {
                        for l in 0..LANES {
                            let low = $low[k * LANES + l];
                            least[l] = if low < least[l] { low } else { least[l] };
                        }
                    })?
                    start += size;
                }
                for s in 0..$count {
                    let l = &lanes[s];
                    part.sum[s] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
                }
                $(for $low in least {
                    part.min = if $low < part.min { $low } else { part.min };
                })?
            },
        );
        total
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
