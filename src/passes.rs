//! The passes over fields that make an iteration.
//!
//! Their cost is memory traffic, so that each does all that can be done while its nodes are in cache. They are
//! compiled with this crate, once for each precision, for AVX2 too: the seams come in behind [`Local`], at one virtual
//! call for a chunk of nodes.

use ndarray::Array2;

use crate::field::{CHUNK, Partial, Reducer, read, write};
use crate::par::IndexedParallelIterator;
use crate::real::Real;
use crate::vector::{sums, vectors};

/// The fields of a solve.
#[derive(Debug)]
pub struct Fields<T> {
    pub(crate) reducer: Reducer,
    /// g
    pub(crate) gap: Array2<T>,
    /// K⁻¹(g + h), of zero mean
    pub(crate) pressure: Array2<T>,
    /// r', negative zero outside of the working set and never within; while a step is made, K⁻¹ of the change
    pub(crate) residual: Array2<T>,
    /// z = M r'; between two steps, that of the state before
    pub(crate) preconditioned: Array2<T>,
    /// the last step, up to a factor and, while the next one is made, up to the scale that restores the mean gap; the
    /// direction t of [`Method::Rey2017`](crate::Method)
    pub(crate) change: Array2<T>,
}

/// What each node feels by its own gap, of a chunk of nodes.
pub trait Local<T>: Sync {
    /// Whether there is nothing to evaluate.
    fn is_zero(&self) -> bool;
    /// Whether the gap is confined to g ≥ 0.
    fn projects(&self) -> bool;
    /// The energies, tractions or slopes of law and constraint at the nodes from `first` on.
    fn evaluate(&self, of: Of, first: usize, gaps: &[T], out: &mut [T]);
    /// Tractions and slopes at once.
    fn tractions_and_slopes(&self, first: usize, gaps: &[T], tractions: &mut [T], slopes: &mut [T]);
    /// The same of the law alone.
    fn law(&self, of: Of, gaps: &[T], out: &mut [T]);
    /// How many nodes a constraint that does not project presses, and its energy.
    fn pressed(&self, first: usize, gaps: &[T]) -> [f64; 2];
}

/// Which derivative of an energy.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    Energy,
    Traction,
    Slope,
}

/// Which nodes may move, and what their residual is.
#[derive(Clone, Copy, Debug)]
pub struct Working<T> {
    /// the mean pressure that is given, or zero
    pub(crate) offset: T,
    /// a node in contact is released where r is below it
    pub(crate) release: T,
    /// what r' is without
    pub(crate) level: T,
}

/// How a node follows the mean gap: v = √((g + least)/(g + half)).
#[derive(Clone, Copy, Debug)]
pub struct Follows<T> {
    pub(crate) half: T,
    pub(crate) least: T,
}

/// A step before it is clipped.
#[derive(Clone, Copy, Debug)]
pub struct Attempt<T> {
    /// how much of z to take
    pub(crate) length: T,
    /// the mean of z over the working set
    pub(crate) centre: T,
    /// how much of the last change to keep
    pub(crate) keep: T,
    /// its mean over the working set
    pub(crate) mean: T,
    /// whether the gap is confined to g ≥ 0
    pub(crate) projects: bool,
}

/// A step that is taken: `length` of scale·(g + change) − g.
#[derive(Clone, Copy, Debug)]
pub struct Advance<T> {
    pub(crate) length: T,
    pub(crate) scale: T,
    /// the mean pressure that is given, or zero
    pub(crate) offset: T,
    /// what r was without; nothing if r' is without nothing
    pub(crate) level: Option<T>,
}

/// The passes, as what a precision brings with it: so they are compiled with this crate, and not again with each that uses it.
pub trait Passes: Sized {
    /// Of the present gap and pressure; see [`Tally`].
    fn tally(fields: &mut Fields<Self>, local: &dyn Local<Self>, offset: Self, surface: &Array2<Self>) -> Partial;
    /// How many contact nodes are released, and Σ r over them, after a pass that took the tally.
    fn released(fields: &mut Fields<Self>, at_contact: Self, release: Self) -> Partial;
    /// r' from gap and pressure: Σ|g r'|, how many nodes may move, and Σ of the squares of what changed in r'.
    fn residual(fields: &mut Fields<Self>, local: &dyn Local<Self>, working: Working<Self>) -> Partial;
    /// r' from the r that a step has left in its place: Σ|g r'|, how many nodes may move, Σ r'·change, Σ r'·z with the
    /// z of the state before, and Σ change over the working set.
    fn release(fields: &mut Fields<Self>, projects: bool, working: Working<Self>) -> Partial;
    /// Σ v and Σ v·r' for how nodes follow the mean gap.
    fn lift_sums(fields: &mut Fields<Self>, follows: Follows<Self>) -> [f64; 2];
    /// Adds `scale`·v to z.
    fn lift(fields: &mut Fields<Self>, follows: Follows<Self>, scale: Self);
    /// Σ z outside of the working set, after a pass for r'.
    fn idle(fields: &mut Fields<Self>) -> f64;
    /// The change that a step makes, clipped: Σ change, how many nodes were clipped, and how many that the gradient drives
    /// into contact, Σ r'·change; of the local traction Σ traction·change, and of its slope Σ slope·change²; with the pressure of the surface
    /// also Σ r'·g, and its products with change and g, and Σ slope·change·g and Σ slope·g². The least is how many times the
    /// change a gap can take.
    fn trial(
        fields: &mut Fields<Self>,
        local: &dyn Local<Self>,
        attempt: Attempt<Self>,
        surface: Option<&Array2<Self>>,
    ) -> Partial;
    /// Σ of the local energy after a step.
    fn energy_after(fields: &mut Fields<Self>, local: &dyn Local<Self>, length: Self, scale: Self) -> f64;
    /// Takes a step: gap, pressure, r, and the tally of the new state. Beside it Σ change·r, less the level; under pressure control,
    /// where the level is zero, r' in the place of r, Σ|g r'|, how many nodes may move, Σ r'·change and Σ r'·z.
    fn advance(
        fields: &mut Fields<Self>,
        local: &dyn Local<Self>,
        step: Advance<Self>,
        surface: &Array2<Self>,
    ) -> Partial;
}

/// Where the sums of a tally are among those of its pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tally {
    /// how many nodes are apart
    pub(crate) free: f64,
    /// Σ r over these
    pub(crate) sum_r: f64,
    /// the least r in contact
    pub(crate) min_r: f64,
    pub(crate) sum_gap: f64,
    /// Σ g·p
    pub(crate) sum_gp: f64,
    /// how many nodes are in contact
    pub(crate) contact: f64,
    /// Σ φ' of the law
    pub(crate) traction: f64,
    /// Σ φ of the law
    pub(crate) adhesive: f64,
    /// Σ of the constraint's energy
    pub(crate) penalty: f64,
    /// Σ g·(p + K⁻¹h), which with Σ h·K⁻¹h makes Σ u·p
    pub(crate) work: f64,
}

impl Tally {
    pub(crate) fn new(total: &Partial) -> Self {
        let [free, sum_r, sum_gap, sum_gp, contact, traction, adhesive, penalty, surface, ..] = total.sum;
        let work = sum_gp + surface;
        Self { free, sum_r, min_r: total.min, sum_gap, sum_gp, contact, traction, adhesive, penalty, work }
    }
}

#[inline(always)]
fn count(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

/// Whether a node is outside of the working set, by its residual.
#[inline(always)]
pub(crate) fn idles<T: Real>(residual: T) -> bool {
    (residual == T::zero()) & residual.is_sign_negative()
}

/// The residual of a node of the working set.
#[inline(always)]
fn works<T: Real>(residual: T) -> T {
    // no negative zero
    residual + T::zero()
}

/// The gap after a change, zero where only rounding keeps it from that.
#[inline(always)]
fn moved<T: Real>(projects: bool, gap: T, change: T) -> T {
    let next = gap + change;
    if projects & (next <= T::lit(4.0) * T::epsilon() * gap) { T::zero() } else { next }
}

/// The step of unit length.
#[inline(always)]
fn whole<T: Real>(scale: T, gap: T, change: T) -> T {
    if scale == T::one() { change } else { scale * (gap + change) - gap }
}

/// The part of a tally that gap, pressure and traction of a chunk give.
fn tally_of<T: Real>(projects: bool, offset: T, gap: &[T], pressure: &[T], traction: &[T]) -> Partial {
    sums!(5, [gap, pressure, traction], [], |i| {
        let (g, p) = (gap[i], pressure[i]);
        let r = (p + traction[i] + offset).widen();
        let touches = projects & (g <= T::zero());
        let free = count(!touches);
        let terms = [free, if touches { 0.0 } else { r }, g.widen(), g.widen() * p.widen(), 1.0 - free];
        (terms, if touches { r } else { f64::INFINITY })
    })
}

/// Adds the energies and tractions of law and constraint.
fn tally_local<T: Real>(
    part: &mut Partial,
    local: &dyn Local<T>,
    first: usize,
    gaps: &[T],
    tractions: &[T],
    energies: bool,
) {
    let mut buffer = [T::zero(); CHUNK];
    let out = &mut buffer[..gaps.len()];
    let sum = |values: &[T]| sums!(1, [values], [], |i| ([values[i].widen()], f64::INFINITY)).sum[0];
    if local.projects() {
        part.sum[5] = sum(tractions);
    } else {
        local.law(Of::Traction, gaps, out);
        part.sum[5] = sum(out);
        [part.sum[4], part.sum[7]] = local.pressed(first, gaps);
    }
    if energies {
        local.law(Of::Energy, gaps, out);
        part.sum[6] = sum(out);
    }
}

fn tally<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, offset: T, surface: &Array2<T>) -> Partial {
    let Fields { reducer, gap, pressure, .. } = fields;
    reducer.run(read(gap).zip(read(pressure)).zip(read(surface)), |first, ((gap, pressure), surface)| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = &mut buffer[..gap.len()];
        if !local.is_zero() {
            local.evaluate(Of::Traction, first, gap, tractions);
        }
        let mut part = tally_of(local.projects(), offset, gap, pressure, tractions);
        if !local.is_zero() {
            tally_local(&mut part, local, first, gap, tractions, true);
        }
        let product = sums!(1, [gap, surface], [], |i| ([gap[i].widen() * surface[i].widen()], f64::INFINITY));
        part.sum[8] = product.sum[0];
        part
    })
}

fn released<T: Real>(fields: &mut Fields<T>, at_contact: T, release: T) -> Partial {
    let Fields { reducer, gap, pressure, .. } = fields;
    let limit = release.widen();
    reducer.run_where(
        |tally| tally.min < limit,
        read(gap).zip(read(pressure)),
        |_, (gap, pressure)| {
            sums!(2, [gap, pressure], [], |i| {
                let r = pressure[i] + at_contact;
                let released = (gap[i] <= T::zero()) & (r < release);
                ([count(released), if released { r.widen() } else { 0.0 }], f64::INFINITY)
            })
        },
    )
}

/// r' of a node, and whether it may move.
#[inline(always)]
fn residual_of<T: Real>(projects: bool, w: Working<T>, gap: T, r: T) -> (T, bool) {
    let may = !projects | (gap > T::zero()) | (r < w.release);
    (if may { works(r - w.level) } else { T::neg_zero() }, may)
}

fn residual<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, working: Working<T>) -> Partial {
    let Fields { reducer, gap, pressure, residual, .. } = fields;
    let projects = local.projects();
    reducer.run(read(gap).zip(read(pressure)).zip(write(residual)), |first, ((gap, pressure), residual)| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = &mut buffer[..gap.len()];
        if !local.is_zero() {
            local.evaluate(Of::Traction, first, gap, tractions);
        }
        sums!(3, [gap, pressure, tractions], [residual], |i| {
            let r = pressure[i] + tractions[i] + working.offset;
            let (r, may) = residual_of(projects, working, gap[i], r);
            let difference = (r - residual[i]).widen();
            residual[i] = r;
            ([(gap[i] * r).abs().widen(), count(may), difference * difference], f64::INFINITY)
        })
    })
}

fn release<T: Real>(fields: &mut Fields<T>, projects: bool, working: Working<T>) -> Partial {
    let Fields { reducer, gap, residual, preconditioned, change, .. } = fields;
    let chunks = read(gap).zip(write(residual)).zip(read(preconditioned)).zip(read(change));
    reducer.run(chunks, |_, (((gap, residual), z), change)| {
        sums!(5, [gap, z, change], [residual], |i| {
            let (r, may) = residual_of(projects, working, gap[i], residual[i]);
            residual[i] = r;
            let orthogonality = (gap[i] * r).abs().widen();
            let [r, d, z] = [r, change[i], z[i]].map(T::widen);
            ([orthogonality, count(may), r * d, r * z, if may { d } else { 0.0 }], f64::INFINITY)
        })
    })
}

#[inline(always)]
fn follow<T: Real>(follows: Follows<T>, gap: T) -> T {
    ((gap + follows.least) / (gap + follows.half)).sqrt()
}

fn lift_sums<T: Real>(fields: &mut Fields<T>, follows: Follows<T>) -> [f64; 2] {
    let Fields { reducer, gap, residual, .. } = fields;
    let total = reducer.run(read(gap).zip(read(residual)), |_, (gap, residual)| {
        sums!(2, [gap, residual], [], |i| {
            let v = follow(follows, gap[i]).widen();
            ([v, v * residual[i].widen()], f64::INFINITY)
        })
    });
    [total.sum[0], total.sum[1]]
}

fn lift<T: Real>(fields: &mut Fields<T>, follows: Follows<T>, scale: T) {
    let Fields { reducer, gap, preconditioned, .. } = fields;
    reducer.run(read(gap).zip(write(preconditioned)), |_, (gap, z)| {
        vectors!([gap], [z], |i| {
            z[i] += scale * follow(follows, gap[i]);
        });
        Partial::NONE
    });
}

fn idle<T: Real>(fields: &mut Fields<T>) -> f64 {
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

/// The change that a step makes at one node, and whether that was clipped.
#[inline(always)]
fn clipped_change<T: Real>(attempt: Attempt<T>, gap: T, residual: T, z: T, change: T) -> (T, bool) {
    let Attempt { length, centre, keep, mean, projects } = attempt;
    let kept = if keep == T::zero() { T::zero() } else { keep * (change - mean) };
    let next = if idles(residual) { gap } else { gap - length * (z - centre) + kept };
    let clipped = projects & (next < T::zero());
    (if clipped { -gap } else { next - gap }, clipped)
}

/// How many times a change a gap can take.
#[inline(always)]
fn reach<T: Real>(gap: T, change: T) -> f64 {
    if change < T::zero() { (gap / -change).widen() } else { f64::INFINITY }
}

fn trial<T: Real>(
    fields: &mut Fields<T>,
    local: &dyn Local<T>,
    attempt: Attempt<T>,
    surface: Option<&Array2<T>>,
) -> Partial {
    let Fields { reducer, gap, residual, preconditioned, change, .. } = fields;
    let nothing_local = local.is_zero();
    let chunks = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change));
    let slopes = |part: &mut Partial, first, gap: &[T], change: &[T]| {
        if nothing_local {
            return;
        }
        let (mut tractions, mut slopes) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (tractions, slopes) = (&mut tractions[..gap.len()], &mut slopes[..gap.len()]);
        local.tractions_and_slopes(first, gap, tractions, slopes);
        let found = sums!(4, [gap, change, tractions, slopes], [], |i| {
            let [g, c, t, s] = [gap[i], change[i], tractions[i], slopes[i]].map(T::widen);
            ([t * c, s * c * c, s * c * g, s * g * g], f64::INFINITY)
        });
        part.sum[7..11].copy_from_slice(&found.sum[..4]);
    };
    match surface {
        None => reducer.run(chunks, |first, (((gap, residual), z), change)| {
            let mut part = sums!(4, [gap, residual, z], [change], |i| {
                let (g, r) = (gap[i], residual[i]);
                let (c, clipped) = clipped_change(attempt, g, r, z[i], change[i]);
                change[i] = c;
                let blocked = clipped & (r > T::zero()) & (g > T::zero());
                ([c.widen(), count(clipped), count(blocked), r.widen() * c.widen()], reach(g, c))
            });
            slopes(&mut part, first, gap, change);
            part
        }),
        Some(surface) => reducer.run(chunks.zip(read(surface)), |first, ((((gap, residual), z), change), surface)| {
            let mut part = sums!(7, [gap, residual, z, surface], [change], |i| {
                let (g, r) = (gap[i], residual[i]);
                let (c, clipped) = clipped_change(attempt, g, r, z[i], change[i]);
                change[i] = c;
                let blocked = count(clipped & (r > T::zero()) & (g > T::zero()));
                let low = reach(g, c);
                let [g, r, c, h] = [g, r, c, surface[i]].map(T::widen);
                ([c, count(clipped), blocked, r * c, r * g, c * h, g * h], low)
            });
            slopes(&mut part, first, gap, change);
            part
        }),
    }
}

fn energy_after<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, length: T, scale: T) -> f64 {
    let Fields { reducer, gap, change, .. } = fields;
    let projects = local.projects();
    let total = reducer.run(read(gap).zip(read(change)), |first, (gap, change)| {
        let (mut next, mut buffer) = ([T::zero(); CHUNK], [T::zero(); CHUNK]);
        let (next, energies) = (&mut next[..gap.len()], &mut buffer[..gap.len()]);
        vectors!([gap, change], [next], |i| {
            next[i] = moved(projects, gap[i], length * whole(scale, gap[i], change[i]));
        });
        local.evaluate(Of::Energy, first, next, energies);
        sums!(1, [energies], [], |i| ([energies[i].widen()], f64::INFINITY))
    });
    total.sum[0]
}

fn advance<T: Real>(fields: &mut Fields<T>, local: &dyn Local<T>, step: Advance<T>, surface: &Array2<T>) -> Partial {
    let Advance { length, scale, offset, level } = step;
    let Fields { reducer, gap, pressure, residual: response, preconditioned, change, .. } = fields;
    let (projects, nothing_local) = (local.projects(), local.is_zero());
    // r into the place of the response, and the tally
    let finish = |first, gap: &[T], pressure: &[T], step: &[T], residual: &mut [T]| {
        let mut buffer = [T::zero(); CHUNK];
        let tractions = &mut buffer[..gap.len()];
        if !nothing_local {
            local.evaluate(Of::Traction, first, gap, tractions);
        }
        let mut part = tally_of(projects, offset, gap, pressure, tractions);
        vectors!([pressure, tractions], [residual], |i| {
            residual[i] = pressure[i] + tractions[i] + offset;
        });
        if !nothing_local {
            tally_local(&mut part, local, first, gap, tractions, !projects);
            let level = level.unwrap_or(T::zero());
            let product = sums!(1, [step, residual], [], |i| {
                ([step[i].widen() * (residual[i] - level).widen()], f64::INFINITY)
            });
            part.sum[8] = product.sum[0];
        }
        part
    };
    let rest = scale - T::one();
    let chunks = write(gap).zip(write(pressure)).zip(write(response));
    if level.is_none() {
        let working = Working { offset, release: T::zero(), level: T::zero() };
        return reducer.run(
            chunks.zip(read(change)).zip(read(preconditioned)),
            |first, ((((gap, pressure), response), change), z)| {
                vectors!([change, response], [gap, pressure], |i| {
                    gap[i] = moved(projects, gap[i], length * change[i]);
                    pressure[i] += length * response[i];
                });
                let mut part = finish(first, gap, pressure, change, response);
                let residual = response;
                let new = sums!(4, [gap, change, z], [residual], |i| {
                    let (r, may) = residual_of(projects, working, gap[i], residual[i]);
                    residual[i] = r;
                    let orthogonality = (gap[i] * r).abs().widen();
                    let [r, d, z] = [r, change[i], z[i]].map(T::widen);
                    ([orthogonality, count(may), r * d, r * z], f64::INFINITY)
                });
                part.sum[9..13].copy_from_slice(&new.sum[..4]);
                part
            },
        );
    }
    if rest == T::zero() {
        return reducer.run(chunks.zip(read(change)), |first, (((gap, pressure), response), change)| {
            vectors!([change, response], [gap, pressure], |i| {
                gap[i] = moved(projects, gap[i], length * change[i]);
                pressure[i] += length * response[i];
            });
            finish(first, gap, pressure, change, response)
        });
    }
    let chunks = chunks.zip(write(change)).zip(read(surface));
    reducer.run(chunks, |first, ((((gap, pressure), response), change), surface)| {
        vectors!([response, surface], [gap, pressure, change], |i| {
            let (g, p) = (gap[i], pressure[i]);
            let d = whole(scale, g, change[i]);
            change[i] = d;
            gap[i] = moved(projects, g, length * d);
            pressure[i] = p + length * (scale * response[i] + rest * (p - surface[i]));
        });
        finish(first, gap, pressure, change, response)
    })
}

macro_rules! passes {
    ($($float:ty),*) => {$(
        impl Passes for $float {
            fn tally(fields: &mut Fields<Self>, local: &dyn Local<Self>, offset: Self, surface: &Array2<Self>) -> Partial {
                tally(fields, local, offset, surface)
            }
            fn released(fields: &mut Fields<Self>, at_contact: Self, release: Self) -> Partial {
                released(fields, at_contact, release)
            }
            fn residual(fields: &mut Fields<Self>, local: &dyn Local<Self>, working: Working<Self>) -> Partial {
                residual(fields, local, working)
            }
            fn release(fields: &mut Fields<Self>, projects: bool, working: Working<Self>) -> Partial {
                release(fields, projects, working)
            }
            fn lift_sums(fields: &mut Fields<Self>, follows: Follows<Self>) -> [f64; 2] {
                lift_sums(fields, follows)
            }
            fn lift(fields: &mut Fields<Self>, follows: Follows<Self>, scale: Self) {
                lift(fields, follows, scale)
            }
            fn idle(fields: &mut Fields<Self>) -> f64 {
                idle(fields)
            }
            fn trial(
                fields: &mut Fields<Self>,
                local: &dyn Local<Self>,
                attempt: Attempt<Self>,
                surface: Option<&Array2<Self>>,
            ) -> Partial {
                trial(fields, local, attempt, surface)
            }
            fn energy_after(fields: &mut Fields<Self>, local: &dyn Local<Self>, length: Self, scale: Self) -> f64 {
                energy_after(fields, local, length, scale)
            }
            fn advance(
                fields: &mut Fields<Self>,
                local: &dyn Local<Self>,
                step: Advance<Self>,
                surface: &Array2<Self>,
            ) -> Partial {
                advance(fields, local, step, surface)
            }
        }
    )*};
}
passes!(f32, f64);
