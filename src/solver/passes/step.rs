//! The passes of a step.

use super::residual::{Continued, Working, release_chunk};
use super::tally::{Tally, tally_chunk};
use super::{Fields, count, idles};
use crate::field::{CHUNK, Field, Minimum, Sums, found, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::solver::potential::{Of, Potential};
use crate::vector::{sums, vectors};

#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Attempt<T> {
    /// the multiple of z
    pub(in crate::solver) length: T,
    /// the mean of z over the working set
    pub(in crate::solver) centre: T,
    /// the multiple of the last change
    pub(in crate::solver) keep: T,
    /// the mean of the last change over the working set
    pub(in crate::solver) mean: T,
    /// whether contact nodes with a positive r' move down
    pub(in crate::solver) yields: bool,
}

found! {
    /// The sums over a clipped change c, before the scale that restores the mean gap.
    pub(in crate::solver) struct Tried {
        /// Σ c
        pub(in crate::solver) change: f64,
        pub(in crate::solver) clipped: f64,
        /// the number of clipped nodes that the gradient drives into contact
        pub(in crate::solver) blocked: f64,
        /// Σ r'·c
        pub(in crate::solver) descent: f64,
        /// Σ c²
        pub(in crate::solver) square: f64,
        /// Σ r'·g, Σ c·K⁻¹h and Σ g·K⁻¹h, under gap control
        pub(in crate::solver) gap_descent: f64,
        pub(in crate::solver) change_surface: f64,
        pub(in crate::solver) gap_surface: f64,
        /// the energy beyond the tangents of nodes that pass a corner of the local energy
        pub(in crate::solver) kink: f64,
        /// Σ t·c, with t the local traction
        pub(in crate::solver) traction: f64,
        /// Σ s·c², Σ s·c·g and Σ s·g², with s the slope of the local traction
        pub(in crate::solver) slope_change: f64,
        pub(in crate::solver) slope_mixed: f64,
        pub(in crate::solver) slope_gap: f64,
    }
}

/// A step of `length` along d = scale·(g + c) − g, with c the field of the change.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Advance<T> {
    pub(in crate::solver) length: T,
    pub(in crate::solver) scale: T,
    /// the constant b in r = p + φ'(g) + b
    pub(in crate::solver) offset: T,
    /// the level r − r' under gap control; `None` under pressure control, where it is zero
    pub(in crate::solver) level: Option<T>,
}

found! {
    /// The sums of the state after a step.
    pub(in crate::solver) struct Advanced {
        pub(in crate::solver) tally: Tally,
        /// Σ d·(r − level), with d the step of unit length; zero without law and springs
        pub(in crate::solver) product: f64,
        /// under pressure control the sums of r', in the place of r
        pub(in crate::solver) residual: Continued,
    }
}

/// The corner of the local energy at zero gap, where steps end.
#[derive(Clone, Copy)]
struct Corner {
    from_above: bool,
    from_below: bool,
}

impl Corner {
    fn of<T: Real>(local: &Potential<'_, T>) -> Self {
        Self { from_above: local.projects(), from_below: local.is_capped() }
    }

    /// The gap after a change, exactly zero where it is beyond zero, or within the rounding in Lo of it.
    #[inline(always)]
    fn moved<T: Real, Lo: Real>(self, gap: T, change: T) -> T {
        let (next, least) = (gap + change, T::lit(4.0) * cast(Lo::epsilon()) * gap);
        let lands = if self.from_below { next.abs() <= least.abs() } else { self.from_above & (next <= least) };
        if lands { T::zero() } else { next }
    }
}

/// The step d = scale·(g + c) − g of unit length at one node.
#[inline(always)]
fn whole<T: Real>(scale: T, gap: T, change: T) -> T {
    if scale == T::one() { change } else { scale * (gap + change) - gap }
}

/// The change c of a node, and whether it was clipped to the `least` or the `most` gap after a step.
#[inline(always)]
fn clipped_change<T: Real>([least, most]: [T; 2], attempt: Attempt<T>, gap: T, [r, z, change]: [T; 3]) -> (T, bool) {
    let Attempt { length, centre, keep, mean, .. } = attempt;
    let kept = if keep == T::zero() { T::zero() } else { keep * (change - mean) };
    let next = if idles(r) { gap } else { gap - length * (z - centre) + kept };
    let bounded = if next < least { least } else { next };
    let bounded = if bounded > most { most } else { bounded };
    (bounded - gap, bounded != next)
}

/// The residual beyond which a node continues from above through the corner at which it would yield is the cap over
/// this.
const PASSES: f64 = 0.3;

/// The least and the greatest gap after a step at the corner where the surface yields: a node stops there from the side
/// on which it is, or to which the gradient drives it.
#[inline(always)]
fn bounds_of_yielding<T: Real>(yields: bool, [cap, gap, r]: [T; 3]) -> [T; 2] {
    let below = (gap < T::zero()) | ((gap == T::zero()) & (r > T::zero()) & yields);
    // beyond the corner the gradient is another one by the cap: a node stops if that might drive it back
    let against = if gap > T::zero() { T::lit(PASSES) * r } else { -r };
    let stops = (gap == T::zero()) | (against <= cap);
    let least = if stops & !below { T::zero() } else { T::neg_infinity() };
    [least, if stops & below { T::zero() } else { T::infinity() }]
}

/// Writes the clipped change of a chunk within `bounds` by cap, gap and residual: compiled for caps, and for none.
#[inline(always)]
fn try_chunk<T: Real, Lo: Real, C: Copy>(
    attempt: Attempt<T>,
    (gap, surface): (&[T], Option<&[T]>),
    (residual, z, change): (&[Lo], &[Lo], &mut [Lo]),
    (caps, bounds): (&[C], impl Fn(C, T, T) -> [T; 2] + Copy),
) -> Tried {
    let Some(surface) = surface else {
        return sums!([gap, residual, z, caps], [change], |i| {
            let (g, r): (_, T) = (gap[i], cast(residual[i]));
            let (c, clipped) = clipped_change(bounds(caps[i], g, r), attempt, g, [r, cast(z[i]), cast(change[i])]);
            change[i] = cast(c);
            let (r, c) = (r.widen(), change[i].widen());
        } => Tried {
            change: c, clipped: count(clipped), blocked: count(clipped & (r * c < 0.0)), descent: r * c, square: c * c
        });
    };
    sums!([gap, residual, z, surface, caps], [change], |i| {
        let (g, r): (_, T) = (gap[i], cast(residual[i]));
        let (c, clipped) = clipped_change(bounds(caps[i], g, r), attempt, g, [r, cast(z[i]), cast(change[i])]);
        change[i] = cast(c);
        let ([g, h, r], c) = ([g, surface[i], r].map(T::widen), change[i].widen());
    } => Tried {
        change: c, clipped: count(clipped), blocked: count(clipped & (r * c < 0.0)), descent: r * c, square: c * c,
        gap_descent: r * g, change_surface: c * h, gap_surface: g * h
    })
}

/// Writes the clipped change c of a step; `surface` is K⁻¹h, and `held` whether the mean gap is given.
pub(in crate::solver) fn trial<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    attempt: Attempt<T>,
    (held, surface): (bool, &Field<T>),
) -> Tried {
    let Fields { reducer, gap, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change)).zip(read(surface));
    local.run(reducer, chunks, |local, first, ((((gap, residual), z), change), surface)| {
        let (least, surface, yields) = (local.least(), held.then_some(surface), attempt.yields);
        let mut tried = if local.is_capped() {
            let (caps, bounds) =
                (local.caps(first, gap.len()), move |cap, g, r| bounds_of_yielding(yields, [cap, g, r]));
            try_chunk(attempt, (gap, surface), (residual, z, change), (&caps, bounds))
        } else {
            let bounds = move |(), gap, _| [least.after(gap), T::infinity()];
            try_chunk(attempt, (gap, surface), (residual, z, change), (&[(); CHUNK], bounds))
        };
        if !local.projects() {
            tried.blocked = 0.0;
        }
        if local.is_zero() {
            return tried;
        }
        let [mut tractions, mut slopes] = [[T::zero(); CHUNK]; 2];
        let (tractions, slopes) = (&mut tractions[..gap.len()], &mut slopes[..gap.len()]);
        local.tractions_and_slopes(first, gap, tractions, slopes);
        tried.kink = local.yielding(first, gap, change, tractions, slopes);
        let found = sums!([gap, change, tractions, slopes], [], |i| {
            let ([g, t, s], c) = ([gap[i], tractions[i], slopes[i]].map(T::widen), change[i].widen());
        } => Tried { traction: t * c, slope_change: s * c * c, slope_mixed: s * c * g, slope_gap: s * g * g });
        tried.add(&found.numbers())
    })
}

/// The largest a with g + a·c of the sign of g at all confined nodes, for a change c that was not clipped.
pub(in crate::solver) fn reach<T: Real, Lo: Real>(fields: &mut Fields<T, Lo>, local: &Potential<'_, T>) -> f64 {
    let Fields { reducer, gap, change, .. } = fields;
    let reach = local.run(reducer, read(gap).zip(read(change)), |local, _, (gap, change)| {
        let mut reach = f64::INFINITY;
        if local.least().depth == T::zero() {
            let capped = local.is_capped();
            for (&gap, &change) in gap.iter().zip(change) {
                let (closes, opens) = (change < Lo::zero(), capped && change > Lo::zero() && gap < T::zero());
                if closes && !(capped && gap <= T::zero()) || opens {
                    reach = reach.min((gap / -cast::<_, T>(change)).widen());
                }
            }
        }
        Minimum(reach)
    });
    reach.0
}

/// The sum of the local energy after a step.
pub(in crate::solver) fn energy_after<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    length: T,
    scale: T,
) -> f64 {
    let Fields { reducer, gap, change, .. } = fields;
    local.run(reducer, read(gap).zip(read(change)), |local, first, (gap, change)| {
        let corner = Corner::of(local);
        let (mut next, mut buffer) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (next, energies) = (&mut next[..gap.len()], &mut buffer[..gap.len()]);
        vectors!([gap, change], [next], |i| {
            next[i] = corner.moved::<T, Lo>(gap[i], length * whole(scale, gap[i], cast(change[i])));
        });
        local.evaluate(Of::Energy, first, next, energies);
        sums!([energies], [], |i| energies[i].widen())
    })
}

/// Takes a step: gap, pressure, r less the level in the place of the residual, and the tally of the new state.
pub(in crate::solver) fn advance<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    step: Advance<T>,
    surface: &Field<T>,
) -> Advanced {
    let Advance { length, scale, offset, level } = step;
    let Fields { reducer, least_r, gap, pressure, residual: response, preconditioned, change, .. } = fields;
    let (before, rest) = (level.unwrap_or(T::zero()), scale - T::one());
    let working = Working { offset, release: T::zero(), level: T::zero() };
    let chunks = write(gap).zip(write(pressure)).zip(write(response)).zip(write(change));
    let chunks = chunks.zip(read(preconditioned)).zip(read(surface));
    let total = local.run(reducer, chunks, |local, first, (((((gap, pressure), response), change), z), surface)| {
        let corner = Corner::of(local);
        if rest == T::zero() {
            vectors!([change, response], [gap, pressure], |i| {
                gap[i] = corner.moved::<T, Lo>(gap[i], length * cast(change[i]));
                pressure[i] += length * cast(response[i]);
            });
        } else {
            vectors!([response, surface], [gap, pressure, change], |i| {
                let (g, p) = (gap[i], pressure[i]);
                let d = whole(scale, g, cast(change[i]));
                change[i] = cast(d);
                gap[i] = corner.moved::<T, Lo>(g, length * d);
                pressure[i] = p + length * (scale * cast(response[i]) + rest * (p - surface[i]));
            });
        }
        let mut buffer = [T::zero(); CHUNK];
        let tractions = &mut buffer[..gap.len()];
        let mut found = Advanced::NONE;
        found.tally = tally_chunk(local, offset, first, (gap, pressure), tractions);
        // r less the level takes the place of K⁻¹c
        vectors!([pressure, tractions], [response], |i| {
            response[i] = cast(pressure[i] + tractions[i] + offset - before);
        });
        if !local.is_straight() {
            let product = sums!([change, response], [], |i| change[i].widen() * response[i].widen());
            found.product = product - local.landed(first, gap, change);
        }
        if level.is_none() {
            found.residual = release_chunk(local, working, first, gap, (z, change), response);
        }
        found
    });
    reducer.keep(|found: Advanced| found.tally.min_r.0, least_r);
    total
}
