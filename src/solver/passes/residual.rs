//! The residual r' on the working set, and the passes that use it before a step is made.

use super::{Fields, count, idles};
use crate::field::{CHUNK, found, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::solver::potential::Potential;
use crate::vector::{sums, vectors};

/// The working set by the gradient r, and the constants of r and r'.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Working<T> {
    /// the constant b in r = p + φ'(g) + b
    pub(in crate::solver) offset: T,
    /// the value of r below which a node in contact is released; beyond this and its cap it yields
    pub(in crate::solver) release: T,
    /// the mean of r over the working set under gap control, zero under pressure control: r' = r − level
    pub(in crate::solver) level: T,
}

found! {
    /// The sums over the contact nodes that are released.
    pub(in crate::solver) struct Released {
        pub(in crate::solver) count: f64,
        /// Σ r over these nodes, less the cap where they yield
        pub(in crate::solver) sum_r: f64,
        /// the number of nodes that begin to yield
        pub(in crate::solver) yielding: f64,
    }
}

found! {
    /// The sums of a residual r', and those with the change c of the last step.
    pub(in crate::solver) struct Continued {
        /// Σ|g r'|
        pub(in crate::solver) complementarity: f64,
        pub(in crate::solver) working: f64,
        /// Σ r'·c, with c the field of the change
        pub(in crate::solver) descent: f64,
        /// Σ r'·z', with z' the preconditioned residual of the state before
        pub(in crate::solver) overlap: f64,
        /// Σ c over the working set
        pub(in crate::solver) sum_change: f64,
        /// Σ (r' − r'₀)², with r'₀ the previous content of the field, if r' was computed anew
        pub(in crate::solver) difference: f64,
    }
}

/// The residual of a node of the working set.
#[inline(always)]
fn works<T: Real>(residual: T) -> T {
    // −0 + 0 = +0: negative zero marks nodes outside of the working set
    residual + T::zero()
}

/// The residual r' of a node by its gap and gradient r, [parted](Potential::parted), and whether it may move.
#[inline(always)]
fn residual_of<T: Real, Lo: Real>(touching: T, w: Working<T>, [gap, cap, r]: [T; 3]) -> (Lo, bool) {
    let may = (gap != touching) | (r < w.release);
    (if may { works(cast(r - cap - w.level)) } else { Lo::neg_zero() }, may)
}

/// The gradient r = p + φ'(g) + b of some nodes.
fn gradient<'b, T: Real>(
    local: &Potential<'_, T>,
    offset: T,
    first: usize,
    (gap, pressure): (&[T], &[T]),
    buffer: &'b mut [T; CHUNK],
) -> &'b [T] {
    let gradient = local.tractions(first, gap, buffer);
    vectors!([pressure], [gradient], |i| {
        gradient[i] = pressure[i] + gradient[i] + offset;
    });
    gradient
}

/// The contact nodes that are released.
pub(in crate::solver) fn released<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    offset: T,
    release: T,
) -> Released {
    let Fields { reducer, least_r, gap, pressure, .. } = fields;
    let (limit, capped) = (release.widen(), local.is_capped());
    local.run_where(
        reducer,
        |chunk| least_r[chunk] < limit || capped,
        read(gap).zip(read(pressure)),
        |local, first, (gap, pressure)| {
            let touching = local.touching();
            let (mut gradients, mut buffers) = ([T::zero(); CHUNK], None);
            let r = gradient(local, offset, first, (gap, pressure), &mut gradients);
            let [parted, caps] = local.parted(first, (gap, r), release, &mut buffers);
            sums!([gap, r, parted, caps], [], |i| {
                let yields = parted[i] != gap[i];
                let released = (gap[i] == touching) & (yields | (r[i] < release));
            } => Released {
                count: count(released), sum_r: if released { (r[i] - caps[i]).widen() } else { 0.0 },
                yielding: count(yields)
            })
        },
    )
}

/// Computes r' from gap and pressure.
pub(in crate::solver) fn residual<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    working: Working<T>,
) -> Continued {
    let Fields { reducer, moving, gap, pressure, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(read(pressure)).zip(write(residual)).zip(read(preconditioned)).zip(read(change));
    let total = local.run(reducer, chunks, |local, first, ((((gap, pressure), residual), z), change)| {
        let touching = local.touching();
        let (mut gradients, mut buffers) = ([T::zero(); CHUNK], None);
        let r = gradient(local, working.offset, first, (gap, pressure), &mut gradients);
        let [parted, caps] = local.parted(first, (gap, r), working.release, &mut buffers);
        sums!([gap, r, z, change, parted, caps], [residual], |i| {
            let (r, may): (Lo, _) = residual_of(touching, working, [parted[i], caps[i], r[i]]);
            let difference = (r - residual[i]).widen();
            residual[i] = r;
            let [r, d, z] = [r, change[i], z[i]].map(Lo::widen);
        } => Continued {
            working: count(may), complementarity: (gap[i].widen() * r).abs(), descent: r * d, overlap: r * z,
            sum_change: if may { d } else { 0.0 }, difference: difference * difference
        })
    });
    reducer.keep(|found: Continued| found.working, moving);
    total
}

/// The residual r' of a chunk from the gradient in its field. One constant is subtracted from gradient, release and
/// level.
pub(super) fn release_chunk<T: Real, Lo: Real>(
    local: &Potential<'_, T>,
    working: Working<T>,
    first: usize,
    gap: &[T],
    (z, change): (&[Lo], &[Lo]),
    residual: &mut [Lo],
) -> Continued {
    let (touching, mut buffers) = (local.touching(), None);
    let [parted, caps] = local.parted(first, (gap, residual), working.release, &mut buffers);
    sums!([gap, z, change, parted, caps], [residual], |i| {
        let (r, may): (Lo, _) = residual_of(touching, working, [parted[i], caps[i], cast(residual[i])]);
        residual[i] = r;
        let [r, d, z] = [r, change[i], z[i]].map(Lo::widen);
    } => Continued {
        working: count(may), complementarity: (gap[i].widen() * r).abs(), descent: r * d, overlap: r * z,
        sum_change: if may { d } else { 0.0 }
    })
}

/// The residual r' from the gradient that a step has left in its field. One constant is subtracted from gradient,
/// release and level.
pub(in crate::solver) fn release<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    working: Working<T>,
) -> Continued {
    let Fields { reducer, moving, gap, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(write(residual)).zip(read(preconditioned)).zip(read(change));
    let total = local.run(reducer, chunks, |local, first, (((gap, residual), z), change)| {
        release_chunk(local, working, first, gap, (z, change), residual)
    });
    reducer.keep(|found: Continued| found.working, moving);
    total
}

/// Σ z outside of the working set of the present residual.
pub(in crate::solver) fn idle<T: Real, Lo: Real>(fields: &mut Fields<T, Lo>) -> f64 {
    let Fields { reducer, moving, residual, preconditioned, .. } = fields;
    reducer.run_where(
        |chunk| moving[chunk] < CHUNK as f64,
        read(residual).zip(read(preconditioned)),
        |_, (residual, z)| sums!([residual, z], [], |i| if idles(residual[i]) { z[i].widen() } else { 0.0 }),
    )
}
