//! The passes of a step.

use ndarray::Array2;

use super::residual::{Continued, Working, release_chunk};
use super::tally::{PRODUCT, Tally, tally_chunk};
use super::{Fields, count, idles};
use crate::field::{CHUNK, Partial, SUMS, read, write};
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

/// The sums over a clipped change c, before the scale that restores the mean gap.
#[derive(Clone, Copy, Debug)]
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

/// The sums of the state after a step.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct Advanced {
    pub(in crate::solver) tally: Tally,
    /// Σ d·(r − level), with d the step of unit length; zero without law and springs
    pub(in crate::solver) product: f64,
    /// the sums of r', in the place of r, under pressure control
    pub(in crate::solver) residual: Option<Continued>,
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
    let (low, high) = (next < least, next > most);
    let bound = if low { least } else { most };
    ((if low | high { bound } else { next }) - gap, low | high)
}

/// Whether a clipped node is driven to zero by the gradient itself.
#[inline(always)]
fn is_blocked<T: Real>(clipped: bool, gap: T, r: T) -> bool {
    let (from_above, from_below) = ((r > T::zero()) & (gap > T::zero()), (r < T::zero()) & (gap < T::zero()));
    clipped & (from_above | from_below)
}

const BLOCKED: usize = 2;
const KINK: usize = 8;

/// Writes the clipped change c of a step; `surface` is K⁻¹h under gap control.
pub(in crate::solver) fn trial<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    attempt: Attempt<T>,
    surface: Option<&Array2<T>>,
) -> Tried {
    let Fields { reducer, gap, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change));
    let finish = |local: &Potential<'_, T>, part: &mut Partial, first, gap: &[T], change: &[Lo]| {
        if !local.projects() {
            part.sum[BLOCKED] = 0.0;
        }
        if local.is_zero() {
            return;
        }
        let (mut tractions, mut slopes) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (tractions, slopes) = (&mut tractions[..gap.len()], &mut slopes[..gap.len()]);
        local.tractions_and_slopes(first, gap, tractions, slopes);
        part.sum[KINK] = local.yielding(first, gap, change, tractions, slopes);
        let found = sums!(4, [gap, change, tractions, slopes], [], |i| {
            let ([g, t, s], c) = ([gap[i], tractions[i], slopes[i]].map(T::widen), change[i].widen());
            [t * c, s * c * c, s * c * g, s * g * g]
        });
        part.sum[SUMS - 4..].copy_from_slice(&found.sum[..4]);
    };
    let total = match surface {
        None => local.run(reducer, chunks, |local, first, (((gap, residual), z), change)| {
            let mut bounds = None;
            let [least, most] = local.bounds(first, (gap, residual), attempt.yields, &mut bounds);
            let mut part = sums!(5, [gap, residual, z, least, most], [change], |i| {
                let (g, r): (_, T) = (gap[i], cast(residual[i]));
                let trial = [r, cast(z[i]), cast(change[i])];
                let (c, clipped) = clipped_change([least[i], most[i]], attempt, g, trial);
                change[i] = cast(c);
                let blocked = is_blocked(clipped, g, r);
                let (r, c) = (r.widen(), change[i].widen());
                [c, count(clipped), count(blocked), r * c, c * c]
            });
            finish(local, &mut part, first, gap, change);
            part
        }),
        Some(surface) => {
            let chunks = chunks.zip(read(surface));
            local.run(reducer, chunks, |local, first, ((((gap, residual), z), change), surface)| {
                let mut bounds = None;
                let [least, most] = local.bounds(first, (gap, residual), attempt.yields, &mut bounds);
                let mut part = sums!(8, [gap, residual, z, surface, least, most], [change], |i| {
                    let (g, r): (_, T) = (gap[i], cast(residual[i]));
                    let trial = [r, cast(z[i]), cast(change[i])];
                    let (c, clipped) = clipped_change([least[i], most[i]], attempt, g, trial);
                    change[i] = cast(c);
                    let blocked = is_blocked(clipped, g, r);
                    let ([g, h, r], c) = ([g, surface[i], r].map(T::widen), change[i].widen());
                    [c, count(clipped), count(blocked), r * c, c * c, r * g, c * h, g * h]
                });
                finish(local, &mut part, first, gap, change);
                part
            })
        }
    };
    let [change, clipped, blocked, descent, square, gap_descent, change_surface, gap_surface, ..] = total.sum;
    let [.., traction, slope_change, slope_mixed, slope_gap] = total.sum;
    Tried {
        change,
        clipped,
        blocked,
        descent,
        square,
        gap_descent,
        change_surface,
        gap_surface,
        kink: total.sum[KINK],
        traction,
        slope_change,
        slope_mixed,
        slope_gap,
    }
}

/// The largest a with g + a·c of the sign of g at all confined nodes, for a change c that was not clipped.
pub(in crate::solver) fn reach<T: Real, Lo: Real>(fields: &mut Fields<T, Lo>, local: &Potential<'_, T>) -> f64 {
    let Fields { reducer, gap, change, .. } = fields;
    let total = local.run(reducer, read(gap).zip(read(change)), |local, _, (gap, change)| {
        let mut part = Partial::NONE;
        if local.least().depth == T::zero() {
            let capped = local.is_capped();
            for (&gap, &change) in gap.iter().zip(change) {
                let (closes, opens) = (change < Lo::zero(), capped && change > Lo::zero() && gap < T::zero());
                if closes && !(capped && gap <= T::zero()) || opens {
                    part.min = part.min.min((gap / -cast::<_, T>(change)).widen());
                }
            }
        }
        part
    });
    total.min
}

/// The sum of the local energy after a step.
pub(in crate::solver) fn energy_after<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    length: T,
    scale: T,
) -> f64 {
    let Fields { reducer, gap, change, .. } = fields;
    let total = local.run(reducer, read(gap).zip(read(change)), |local, first, (gap, change)| {
        let corner = Corner::of(local);
        let (mut next, mut buffer) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (next, energies) = (&mut next[..gap.len()], &mut buffer[..gap.len()]);
        vectors!([gap, change], [next], |i| {
            next[i] = corner.moved::<T, Lo>(gap[i], length * whole(scale, gap[i], cast(change[i])));
        });
        local.evaluate(Of::Energy, first, next, energies);
        sums!(1, [energies], [], |i| [energies[i].widen()])
    });
    total.sum[0]
}

/// Takes a step: gap, pressure, r less the level in the place of the residual, and the tally of the new state.
pub(in crate::solver) fn advance<T: Real, Lo: Real>(
    fields: &mut Fields<T, Lo>,
    local: &Potential<'_, T>,
    step: Advance<T>,
    surface: &Array2<T>,
) -> Advanced {
    let Advance { length, scale, offset, level } = step;
    let Fields { reducer, least_r, gap, pressure, residual: response, preconditioned, change, .. } = fields;
    let before = level.unwrap_or(T::zero());
    // r less the level takes the place of K⁻¹c; then the tally
    let finish = |local: &Potential<'_, T>, first, gap: &[T], pressure: &[T], step: &[Lo], residual: &mut [Lo]| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = &mut buffer[..gap.len()];
        let mut part = tally_chunk(local, offset, first, (gap, pressure), tractions);
        vectors!([pressure, tractions], [residual], |i| {
            residual[i] = cast(pressure[i] + tractions[i] + offset - before);
        });
        if !local.is_straight() {
            let product = sums!(1, [step, residual], [], |i| [step[i].widen() * residual[i].widen()]);
            part.sum[PRODUCT] = product.sum[0] - local.landed(first, gap, step);
        }
        part
    };
    let take = |corner: Corner, gap: &mut [T], pressure: &mut [T], change: &[Lo], response: &[Lo]| {
        vectors!([change, response], [gap, pressure], |i| {
            gap[i] = corner.moved::<T, Lo>(gap[i], length * cast(change[i]));
            pressure[i] += length * cast(response[i]);
        });
    };
    let rest = scale - T::one();
    let chunks = write(gap).zip(write(pressure)).zip(write(response));
    if level.is_none() {
        let working = Working { offset, release: T::zero(), level: T::zero() };
        let total = local.run(
            reducer,
            chunks.zip(read(change)).zip(read(preconditioned)),
            |local, first, ((((gap, pressure), response), change), z)| {
                take(Corner::of(local), gap, pressure, change, response);
                let mut part = finish(local, first, gap, pressure, change, response);
                let new = release_chunk(local, working, first, gap, (z, change), response);
                part.sum[SUMS - 4..].copy_from_slice(&new.sum[..4]);
                part
            },
        );
        reducer.keep(|part| part.min, least_r);
        let [.., working, complementarity, descent, overlap] = total.sum;
        let residual = Continued { complementarity, working, descent, overlap, sum_change: 0.0 };
        return Advanced { tally: Tally::new(&total), product: total.sum[PRODUCT], residual: Some(residual) };
    }
    let total = if rest == T::zero() {
        local.run(reducer, chunks.zip(read(change)), |local, first, (((gap, pressure), response), change)| {
            take(Corner::of(local), gap, pressure, change, response);
            finish(local, first, gap, pressure, change, response)
        })
    } else {
        let chunks = chunks.zip(write(change)).zip(read(surface));
        local.run(reducer, chunks, |local, first, ((((gap, pressure), response), change), surface)| {
            let corner = Corner::of(local);
            vectors!([response, surface], [gap, pressure, change], |i| {
                let (g, p) = (gap[i], pressure[i]);
                let d = whole(scale, g, cast(change[i]));
                change[i] = cast(d);
                gap[i] = corner.moved::<T, Lo>(g, length * d);
                pressure[i] = p + length * (scale * cast(response[i]) + rest * (p - surface[i]));
            });
            finish(local, first, gap, pressure, change, response)
        })
    };
    reducer.keep(|part| part.min, least_r);
    Advanced { tally: Tally::new(&total), product: total.sum[PRODUCT], residual: None }
}
