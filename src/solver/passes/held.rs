//! The passes that fit the preconditioner to nodes which the law itself holds by its repulsion.
//!
//! The compliance M knows nothing of their slopes κ = φ'', often several times the stiffness of the stiffest wave. With
//! s = 1/(1 + κ/k)² at each node, and k its stiffness among its neighbours, the preconditioner is
//! S M S + (1 − S²)/(k + κ): M where nothing repels, the compliance of the node where it is held.

use super::Fields;
use crate::field::{CHUNK, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::solver::potential::{Of, Potential};
use crate::vector::sums;

/// The share s of a node in the waves, and its compliance beside them, (1 − s²)/(k + κ). r' can be had back from s r'.
#[inline(always)]
fn share<T: Real>(slope: T, stiffness: T) -> (T, T) {
    let own = (stiffness + slope.max(T::zero())).recip();
    let s = (stiffness * own).powi(2).max(T::epsilon());
    (s, (T::one() - s * s) * own)
}

fn slopes<'a, T: Real>(local: &Potential<'_, T>, first: usize, gap: &[T], buffer: &'a mut [T; CHUNK]) -> &'a [T] {
    let slopes = &mut buffer[..gap.len()];
    local.evaluate(Of::Slope, first, gap, slopes);
    slopes
}

#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Held {
    /// k, the stiffness of one node among its neighbours
    stiffness: f64,
    /// the mean of r', weighted by s², where the mean gap is given
    level: f64,
    /// Σ s²
    shares: f64,
    /// Σ (1 − s)² (r' − level)²/κ, the certificate beside M
    pub(in crate::solver) beside: f64,
    /// Σ (1 − s²)(r' − level)²/(k + κ), of ⟨r', z⟩ beside the waves
    pub(in crate::solver) descent: f64,
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
            let mut buffer = [T::zero(); CHUNK];
            let slopes = slopes(local, first, gap, &mut buffer);
            sums!(2, [slopes, residual], [], |i| {
                let (s, _) = share(slopes[i], k);
                [(s * s).widen() * residual[i].widen(), (s * s).widen()]
            })
        });
        shares = total.sum[1];
        level = total.sum[0] / shares;
    }
    let level = T::lit(level);
    let total = local.run(reducer, read(gap).zip(write(residual)), |local, first, (gap, residual)| {
        let mut buffer = [T::zero(); CHUNK];
        let slopes = slopes(local, first, gap, &mut buffer);
        sums!(2, [slopes], [residual], |i| {
            let (slope, r, (s, own)) = (slopes[i], cast::<_, T>(residual[i]) - level, share(slopes[i], k));
            residual[i] = cast(s * r);
            let rest = ((T::one() - s) * r).widen();
            let beside = if slope > T::zero() { rest * rest / slope.widen() } else { 0.0 };
            [beside, (own * r * r).widen()]
        })
    });
    Held { stiffness, level: level.widen(), shares, beside: total.sum[0], descent: total.sum[1] }
}

/// Multiplies z by S, adds what is beside the waves, and puts r' back; returns Σ z.
pub(in crate::solver) fn release_held<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    held: Held,
) -> f64 {
    let Fields { reducer, gap, residual, preconditioned, .. } = fields;
    let (k, level) = (T::lit(held.stiffness), T::lit(held.level));
    let chunks = read(gap).zip(write(residual)).zip(write(preconditioned));
    let total = local.run(reducer, chunks, |local, first, ((gap, residual), z)| {
        let mut buffer = [T::zero(); CHUNK];
        let slopes = slopes(local, first, gap, &mut buffer);
        sums!(1, [slopes], [residual, z], |i| {
            let (s, own) = share(slopes[i], k);
            let r = cast::<_, T>(residual[i]) / s;
            let moved = s * cast(z[i]) + own * r;
            (residual[i], z[i]) = (cast(r + level), cast(moved));
            [moved.widen()]
        })
    });
    if held.shares == 0.0 {
        return total.sum[0];
    }
    // no mean, where the mean gap is given: a node that is held hardly moves
    let Fields { reducer, gap, preconditioned, .. } = fields;
    let mean = T::lit(total.sum[0] / held.shares);
    let total = local.run(reducer, read(gap).zip(write(preconditioned)), |local, first, (gap, z)| {
        let mut buffer = [T::zero(); CHUNK];
        let slopes = slopes(local, first, gap, &mut buffer);
        sums!(1, [slopes], [z], |i| {
            let (s, _) = share(slopes[i], k);
            let moved: T = cast::<_, T>(z[i]) - mean * (s * s);
            z[i] = cast(moved);
            [moved.widen()]
        })
    });
    total.sum[0]
}
