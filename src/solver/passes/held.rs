//! The passes that fit the preconditioner to nodes which springs, or a law by its repulsion, hold.
//!
//! The compliance M knows nothing of their stiffness κ, often several times the stiffness of the stiffest wave. With s
//! = 1/(1 + κ/k)² at each node, and k its stiffness among its neighbours, the preconditioner is S M S + (1 − S²)/(k +
//! κ): M where nothing holds, the compliance of the node where it is held. Of a residual that pulls, springs take no
//! more than their pressure.

use super::Fields;
use crate::field::{CHUNK, found, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::solver::potential::Potential;
use crate::vector::sums;

/// The share s of a node in the waves, if nothing limits what is held, and its own compliance, 1/(k + κ). r' can be had
/// back from s r'.
#[inline(always)]
fn share<T: Real>(slope: T, stiffness: T) -> (T, T) {
    let own = (stiffness + slope.max(T::zero())).recip();
    ((stiffness * own).powi(2).max(T::epsilon()), own)
}

/// The share s of a node in the waves: the part (1 − s) of a residual that pulls is at most the `limit`.
#[inline(always)]
fn limited<T: Real>(share: T, r: T, limit: T) -> T {
    if r < T::zero() { share.max(T::one() + limit / r) } else { share }
}

/// The residual r' before [`limited`] left s r'.
#[inline(always)]
fn whole<T: Real>(share: T, left: T, limit: T) -> T {
    let r = left / share;
    if r < T::zero() { r.max(left - limit) } else { r }
}

/// The stiffness of what holds nodes, and its limits.
fn holding<'a, T: Real>(
    local: &Potential<'_, T>,
    first: usize,
    gap: &[T],
    [slopes, limits]: &'a mut [[T; CHUNK]; 2],
) -> (&'a [T], &'a [T]) {
    let (slopes, limits) = (&mut slopes[..gap.len()], &mut limits[..gap.len()]);
    local.holds(first, gap, slopes, limits);
    (slopes, limits)
}

found! {
    pub(in crate::solver) struct Held {
        /// k, the stiffness of one node among its neighbours
        stiffness: f64,
        /// the mean of r', weighted by s², where the mean gap is given
        level: f64,
        /// Σ s²
        shares: f64,
        /// Σ (1 − s)² (r' − level)²/κ, the certificate besides M
        pub(in crate::solver) beside: f64,
        /// Σ (1 − s²)(r' − level)²/(k + κ), of ⟨r', z⟩ besides the waves
        pub(in crate::solver) descent: f64,
    }
}

/// Multiplies r' less its level by S.
pub(in crate::solver) fn hold<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    stiffness: f64,
    centred: bool,
) -> Held {
    let Fields { reducer, gap, residual, .. } = fields;
    let k = T::lit(stiffness);
    let (mut level, mut shares) = (0.0, 0.0);
    if centred {
        let total = local.run(reducer, read(gap).zip(read(residual)), |local, first, (gap, residual)| {
            let mut buffer = [[T::zero(); CHUNK]; 2];
            let (slopes, _) = holding(local, first, gap, &mut buffer);
            sums!([slopes, residual], [], |i| {
                let (s, _) = share(slopes[i], k);
            } => Held { level: (s * s).widen() * residual[i].widen(), shares: (s * s).widen() })
        });
        (level, shares) = (total.level / total.shares, total.shares);
    }
    let level = T::lit(level);
    let total = local.run(reducer, read(gap).zip(write(residual)), |local, first, (gap, residual)| {
        let mut buffer = [[T::zero(); CHUNK]; 2];
        let (slopes, limits) = holding(local, first, gap, &mut buffer);
        sums!([slopes, limits], [residual], |i| {
            let (slope, r) = (slopes[i], cast::<_, T>(residual[i]) - level);
            let (share, own) = share(slope, k);
            let s = limited(share, r, limits[i]);
            residual[i] = cast(s * r);
            let rest = ((T::one() - s) * r).widen();
            let error = if slope > T::zero() { rest * rest / slope.widen() } else { 0.0 };
        } => Held { beside: error, descent: ((T::one() - s * s) * own * r * r).widen() })
    });
    Held { stiffness, level: level.widen(), shares, ..total }
}

/// Multiplies z by S, adds what is besides the waves, and puts r' back; returns Σ z.
pub(in crate::solver) fn release_held<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    held: Held,
) -> f64 {
    let Fields { reducer, gap, residual, preconditioned, .. } = fields;
    let (k, level) = (T::lit(held.stiffness), T::lit(held.level));
    let chunks = read(gap).zip(write(residual)).zip(write(preconditioned));
    let sum = local.run(reducer, chunks, |local, first, ((gap, residual), z)| {
        let mut buffer = [[T::zero(); CHUNK]; 2];
        let (slopes, limits) = holding(local, first, gap, &mut buffer);
        sums!([slopes, limits], [residual, z], |i| {
            let (share, own) = share(slopes[i], k);
            let r = whole(share, cast(residual[i]), limits[i]);
            let s = limited(share, r, limits[i]);
            let moved = s * cast(z[i]) + (T::one() - s * s) * own * r;
            (residual[i], z[i]) = (cast(r + level), cast(moved));
            moved.widen()
        })
    });
    if held.shares == 0.0 {
        return sum;
    }
    // no mean, where the mean gap is given: a node that is held hardly moves
    let Fields { reducer, gap, preconditioned, .. } = fields;
    let mean = T::lit(sum / held.shares);
    local.run(reducer, read(gap).zip(write(preconditioned)), |local, first, (gap, z)| {
        let mut buffer = [[T::zero(); CHUNK]; 2];
        let (slopes, _) = holding(local, first, gap, &mut buffer);
        sums!([slopes], [z], |i| {
            let (s, _) = share(slopes[i], k);
            let moved: T = cast::<_, T>(z[i]) - mean * (s * s);
            z[i] = cast(moved);
            moved.widen()
        })
    })
}
