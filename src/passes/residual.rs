use super::tally::tractions;
use super::{Fields, Follows, Local, Working, count, idles};
use crate::field::{CHUNK, Partial, read, write};
use crate::par::IndexedParallelIterator;
use crate::real::Real;
use crate::vector::{sums, vectors};

/// The residual of a node of the working set.
#[inline(always)]
fn works<T: Real>(residual: T) -> T {
    // no negative zero
    residual + T::zero()
}

/// r' of a node, and whether it may move.
#[inline(always)]
fn residual_of<T: Real>(projects: bool, w: Working<T>, gap: T, r: T) -> (T, bool) {
    let may = !projects | (gap > T::zero()) | (r < w.release);
    (if may { works(r - w.level) } else { T::neg_zero() }, may)
}

pub(super) fn residual<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, working: Working<T>) -> Partial {
    let Fields { reducer, gap, pressure, residual, .. } = fields;
    let projects = local.projects();
    reducer.run(read(gap).zip(read(pressure)).zip(write(residual)), |first, ((gap, pressure), residual)| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = tractions(local, first, gap, &mut buffer);
        sums!(3, [gap, pressure, tractions], [residual], |i| {
            let r = pressure[i] + tractions[i] + working.offset;
            let (r, may) = residual_of(projects, working, gap[i], r);
            let difference = (r - residual[i]).widen();
            residual[i] = r;
            ([(gap[i] * r).abs().widen(), count(may), difference * difference], f64::INFINITY)
        })
    })
}

/// What [`Passes::release`](super::Passes::release) does to a chunk.
pub(super) fn release_chunk<T: Real>(
    projects: bool,
    working: Working<T>,
    (gap, z, change): (&[T], &[T], &[T]),
    residual: &mut [T],
) -> Partial {
    sums!(5, [gap, z, change], [residual], |i| {
        let (r, may) = residual_of(projects, working, gap[i], residual[i]);
        residual[i] = r;
        let orthogonality = (gap[i] * r).abs().widen();
        let [r, d, z] = [r, change[i], z[i]].map(T::widen);
        ([orthogonality, count(may), r * d, r * z, if may { d } else { 0.0 }], f64::INFINITY)
    })
}

pub(super) fn release<T: Real>(fields: &mut Fields<T>, projects: bool, working: Working<T>) -> Partial {
    let Fields { reducer, gap, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(write(residual)).zip(read(preconditioned)).zip(read(change));
    reducer
        .run(chunks, |_, (((gap, residual), z), change)| release_chunk(projects, working, (gap, z, change), residual))
}

#[inline(always)]
fn follow<T: Real>(follows: Follows<T>, gap: T) -> T {
    ((gap + follows.least) / (gap + follows.half)).sqrt()
}

pub(super) fn lift_sums<T: Real>(fields: &mut Fields<T>, follows: Follows<T>) -> [f64; 2] {
    let Fields { reducer, gap, residual, .. } = fields;
    let total = reducer.run(read(gap).zip(read(residual)), |_, (gap, residual)| {
        sums!(2, [gap, residual], [], |i| {
            let v = follow(follows, gap[i]).widen();
            ([v, v * residual[i].widen()], f64::INFINITY)
        })
    });
    [total.sum[0], total.sum[1]]
}

pub(super) fn lift<T: Real>(fields: &mut Fields<T>, follows: Follows<T>, scale: T) {
    let Fields { reducer, gap, preconditioned, .. } = fields;
    reducer.run(read(gap).zip(write(preconditioned)), |_, (gap, z)| {
        vectors!([gap], [z], |i| {
            z[i] += scale * follow(follows, gap[i]);
        });
        Partial::NONE
    });
}

pub(super) fn idle<T: Real>(fields: &mut Fields<T>) -> f64 {
    let Fields { reducer, residual, preconditioned, .. } = fields;
    let total = reducer.run_where(
        |residual| residual.sum[1] < CHUNK as f64,
        read(residual).zip(read(preconditioned)),
        |_, (residual, z)| {
            sums!(1, [residual, z], [], |i| { ([if idles(residual[i]) { z[i].widen() } else { 0.0 }], f64::INFINITY) })
        },
    );
    total.sum[0]
}
