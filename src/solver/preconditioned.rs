//! Conjugate gradients with the compliance as preconditioner, two operator applications a step.

use super::potential::{Buffer, Of, Potential};
use super::state::State;
use super::tally::{Tally, tally};
use crate::adhesion::AdhesionLaw;
use crate::constraint::ContactConstraint;
use crate::elastic::ElasticOperator;
use crate::error::Result;
use crate::field::{Partial, read, write};
use crate::par::IndexedParallelIterator;
use crate::problem::Control;
use crate::real::Real;

/// How many ways to find a descending step are tried before the solve has stalled.
const ATTEMPTS: usize = 24;

/// The curvature that a direction is given at least, as a share of its elastic curvature.
const LEAST_CURVATURE: f64 = 0.05;

/// A clipped step is taken whole if its best length is no shorter than this share of it: what it clipped is in
/// contact then, to the last bit.
const WHOLE: f64 = 0.7;

/// A clipped step of which a smaller share than this is good is tried anew, shorter, at most so many times.
const SHORT: f64 = 0.01;
const SHORTENINGS: usize = 8;

/// How many times its trial length a step may take: the mean gap has no elastic curvature to limit it.
const FARTHEST: f64 = 10.0;

/// How much the trial length may change from one step to the next, and what it may not exceed.
const ADAPT: (f64, f64) = (0.7, 1.3);
const LONGEST: f64 = 4.0;

/// The multiple of the last change that the next step contains.
#[derive(Clone, Copy)]
struct Momentum {
    /// what makes the step −z conjugate to it
    conjugate: f64,
    /// what minimises the energy along it
    remainder: f64,
    /// its mean over the working set
    mean: f64,
}

/// What a trial step found.
struct Trial {
    clipped: bool,
    /// whether nodes that the gradient drives into contact were clipped
    blocked: bool,
    /// ⟨r', d⟩
    slope: f64,
}

impl<T, O, L, C> State<'_, T, O, L, C>
where
    T: Real,
    O: ElasticOperator<T>,
    L: AdhesionLaw<T>,
    C: ContactConstraint<T>,
{
    /// A step along the projected, conjugate, preconditioned residual; `false` if no step lowers the energy.
    pub(super) fn preconditioned_step(&mut self) -> Result<bool> {
        let (mut centre, mut momentum) = self.direction();
        for _ in 0..SHORTENINGS {
            let trial_length = self.step_length;
            let Some(trial) = self.descend(&mut centre, momentum.take()) else { return Ok(false) };
            self.problem.operator.pressure(self.change.view(), self.response.view_mut())?;
            self.applications += 1;
            let Some(length) = self.search(&trial) else { return Ok(false) };
            if !trial.blocked || length >= SHORT {
                self.advance(length);
                return Ok(true);
            }
            // so short a part would leave the nodes that should land hanging: clip a shorter step instead
            self.step_length = trial_length * length.max(1e-3);
        }
        Ok(false)
    }

    /// The mean of z over the working set, and how much of the last change to keep.
    fn direction(&mut self) -> (f64, Option<Momentum>) {
        let Some(curvature) = self.momentum.filter(|&curvature| curvature > 0.0) else {
            return (self.centre(), None);
        };
        let projects = self.constraint.projects();
        let Self { reducer, gap, residual, preconditioned, change, response, .. } = self;
        let fields = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(read(change)).zip(read(response));
        let total = reducer.run(fields, |_, ((((gap, residual), z), d), y)| {
            let mut part = Partial::NONE;
            for ((((&gap, &r), &z), &d), &y) in gap.iter().zip(residual).zip(z).zip(d).zip(y) {
                if works(projects, gap, r) {
                    let [z, d, y, r] = [z, d, y, r].map(T::widen);
                    part.sum[0] += z;
                    part.sum[1] += d;
                    part.sum[2] += y;
                    part.sum[3] += z * y;
                    part.sum[4] += r * d;
                }
            }
            part
        });
        let [z, d, y, zy, rd, ..] = total.sum;
        let share = if self.is_gap_controlled() && self.working > 0.0 { 1.0 / self.working } else { 0.0 };
        let (centre, mean) = (z * share, d * share);
        let conjugate = ((zy - centre * y) / curvature).max(0.0);
        (centre, Some(Momentum { conjugate, remainder: (-rd / curvature).min(FARTHEST), mean }))
    }

    /// The mean of z over the working set, under gap control.
    fn centre(&mut self) -> f64 {
        if !self.is_gap_controlled() || self.working == 0.0 {
            return 0.0;
        }
        let projects = self.constraint.projects();
        let Self { reducer, gap, residual, preconditioned, .. } = self;
        let total = reducer.run(read(gap).zip(read(residual)).zip(read(preconditioned)), |_, ((gap, residual), z)| {
            let mut part = Partial::NONE;
            for ((&gap, &r), &z) in gap.iter().zip(residual).zip(z) {
                part.sum[0] += if works(projects, gap, r) { z.widen() } else { 0.0 };
            }
            part
        });
        total.sum[0] / self.working
    }

    /// Puts a feasible change into `change` along which the energy falls.
    ///
    /// Clipping and scaling can turn a step uphill. Then it is tried without the last change; then the nodes that
    /// the gradient drives into contact are put there, alone; or, if there are none, nodes that the gradient releases
    /// but the preconditioner presses are held, and the step is shortened.
    fn descend(&mut self, centre: &mut f64, mut momentum: Option<Momentum>) -> Option<Trial> {
        for _ in 0..ATTEMPTS {
            let trial = self.trial(*centre, momentum);
            if trial.slope < 0.0 {
                return Some(trial);
            }
            if momentum.take().is_some() {
                continue;
            }
            if trial.blocked {
                let slope = self.land(*centre);
                return (slope < 0.0).then_some(Trial { slope, ..trial });
            }
            self.hold(*centre);
            *centre = 0.0;
            self.step_length *= 0.25;
        }
        None
    }

    /// The change that a step of the trial length makes, clipped and of unchanged mean gap.
    fn trial(&mut self, centre: f64, momentum: Option<Momentum>) -> Trial {
        let projects = self.constraint.projects();
        let length = T::lit(self.step_length);
        let centre = T::lit(centre);
        let (keep, mean) = momentum
            .map_or((T::zero(), T::zero()), |m| (T::lit(self.step_length * m.conjugate + m.remainder), T::lit(m.mean)));
        let Self { reducer, gap, residual, preconditioned, change, .. } = self;
        let fields = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change));
        let total = reducer.run(fields, |_, (((gap, residual), z), change)| {
            let mut part = Partial::NONE;
            for (((&gap, &r), &z), d) in gap.iter().zip(residual).zip(z).zip(change) {
                let mut next = gap;
                if works(projects, gap, r) {
                    next -= length * (z - centre);
                    if keep != T::zero() {
                        next += keep * (*d - mean);
                    }
                }
                if projects && next < T::zero() {
                    next = T::zero();
                    part.sum[1] += 1.0;
                    part.sum[2] += f64::from(u8::from(r > T::zero() && gap > T::zero()));
                }
                part.sum[0] += next.widen();
                *d = next;
            }
            part
        });
        let [sum, clipped, blocked, ..] = total.sum;
        // the present mean, not the one that is given: a long step would multiply the rounding of their difference
        let scale = match self.control {
            Control::MeanGap(_) => self.tally.sum_gap / sum,
            Control::MeanPressure(_) => 1.0,
        };
        let slope = if scale.is_finite() && scale > 0.0 { self.subtract_gap(scale) } else { f64::INFINITY };
        Trial { clipped: clipped > 0.0, blocked: blocked > 0.0, slope }
    }

    /// `change` becomes the scaled gap that it holds less the present one; returns ⟨r', d⟩.
    fn subtract_gap(&mut self, scale: f64) -> f64 {
        let scale = T::lit(scale);
        let Self { reducer, gap, residual, change, .. } = self;
        let total = reducer.run(read(gap).zip(read(residual)).zip(write(change)), |_, ((gap, residual), change)| {
            let mut part = Partial::NONE;
            for ((&gap, &r), d) in gap.iter().zip(residual).zip(change) {
                *d = scale * *d - gap;
                part.sum[0] += r.widen() * d.widen();
            }
            part
        });
        total.sum[0]
    }

    /// A change that puts the blocked nodes into contact and lifts the others evenly; both lower the energy.
    fn land(&mut self, centre: f64) -> f64 {
        let (length, centre) = (T::lit(self.step_length), T::lit(centre));
        let projects = self.constraint.projects();
        let lands = move |gap: T, r: T, z: T| gap > T::zero() && r > T::zero() && gap < length * (z - centre);
        let Self { reducer, gap, residual, preconditioned, change, .. } = self;
        let total = reducer.run(read(gap).zip(read(residual)).zip(read(preconditioned)), |_, ((gap, residual), z)| {
            let mut part = Partial::NONE;
            for ((&gap, &r), &z) in gap.iter().zip(residual).zip(z) {
                if lands(gap, r, z) {
                    part.sum[0] += gap.widen();
                } else if works(projects, gap, r) {
                    part.sum[1] += 1.0;
                }
            }
            part
        });
        let [landed, others, ..] = total.sum;
        let lift = T::lit(if matches!(self.control, Control::MeanGap(_)) { landed / others } else { 0.0 });
        let fields = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change));
        let total = reducer.run(fields, |_, (((gap, residual), z), change)| {
            let mut part = Partial::NONE;
            for (((&gap, &r), &z), d) in gap.iter().zip(residual).zip(z).zip(change) {
                *d = if lands(gap, r, z) {
                    -gap
                } else if works(projects, gap, r) {
                    lift
                } else {
                    T::zero()
                };
                part.sum[0] += r.widen() * d.widen();
            }
            part
        });
        total.sum[0]
    }

    /// Takes the mean from z, and takes nodes in contact that z would press out of the step.
    fn hold(&mut self, centre: f64) {
        let (centre, projects, centred) = (T::lit(centre), self.constraint.projects(), self.is_gap_controlled());
        let Self { reducer, gap, residual, preconditioned, .. } = self;
        let moves = move |gap: T, r: T, z: T| works(projects, gap, r) && (gap > T::zero() || z < centre);
        let total = reducer.run(read(gap).zip(read(residual)).zip(read(preconditioned)), |_, ((gap, residual), z)| {
            let mut part = Partial::NONE;
            for ((&gap, &r), &z) in gap.iter().zip(residual).zip(z) {
                if moves(gap, r, z) {
                    part.sum[0] += (z - centre).widen();
                    part.sum[1] += 1.0;
                }
            }
            part
        });
        let [sum, count, ..] = total.sum;
        let mean = T::lit(if centred && count > 0.0 { sum / count } else { 0.0 });
        reducer.run(read(gap).zip(read(residual)).zip(write(preconditioned)), |_, ((gap, residual), z)| {
            for ((&gap, &r), z) in gap.iter().zip(residual).zip(z) {
                *z = if moves(gap, r, *z) { *z - centre - mean } else { T::zero() };
            }
            Partial::NONE
        });
    }

    /// How much of `change` to take, with its elastic response known; nothing if the energy rises all the same.
    fn search(&mut self, trial: &Trial) -> Option<f64> {
        let shift = T::lit(self.offset() - self.level);
        let projects = self.constraint.projects();
        let noise = self.energy_noise() * self.nodes();
        let Self { reducer, gap, pressure, change, response, problem, constraint, .. } = self;
        let potential = Potential { law: &problem.law, constraint: &**constraint };
        let local = !potential.is_zero::<T>();
        let fields = read(gap).zip(read(pressure)).zip(read(change)).zip(read(response));
        let total = reducer.run(fields, |first, (((gap, pressure), change), response)| {
            let mut part = Partial::NONE;
            for (((&gap, &p), &d), &response) in gap.iter().zip(pressure).zip(change).zip(response) {
                part.sum[0] += d.widen() * response.widen();
                part.sum[1] += d.widen() * (p + shift).widen();
                if d < T::zero() {
                    part.min = part.min.min(gap.widen() / -d.widen());
                }
            }
            if local {
                let mut slopes = [T::zero(); _];
                let slopes = potential.evaluate(Of::Slope, first, gap, &mut slopes);
                part.sum[2] = slopes.iter().zip(change).map(|(s, d)| s.widen() * d.widen().powi(2)).sum();
            }
            part
        });
        let [elastic, work, slopes, ..] = total.sum;
        // a uniform change has none, but for rounding
        let elastic = elastic.max(0.0);
        let stiff = elastic + slopes > LEAST_CURVATURE * elastic;
        let curvature = if stiff { elastic + slopes } else { LEAST_CURVATURE * elastic };
        let best = (-trial.slope / curvature).min(FARTHEST);
        let reach = if projects { total.min.max(1.0) } else { f64::INFINITY };
        let mut length = match trial.clipped {
            true if best >= WHOLE => 1.0,
            true => best,
            false => best.min(reach),
        };
        let rise = |length: f64, local: f64| length * work + 0.5 * length * length * elastic + local;
        if local {
            let falls = |rise: f64| rise.is_finite() && rise <= noise;
            while !falls(rise(length, self.local_rise(length))) {
                length *= 0.5;
                if length < 1e-12 {
                    return None;
                }
            }
        }
        // near the solution the best lengths scatter about their mean, and only that is of use
        let change = if self.given { best.sqrt() } else { best };
        self.step_length = (self.step_length * change.clamp(ADAPT.0, ADAPT.1)).min(LONGEST);
        (length > 0.0).then_some(length)
    }

    /// Σ φ(g + ℓd) − φ(g).
    fn local_rise(&mut self, length: f64) -> f64 {
        let (length, projects) = (T::lit(length), self.constraint.projects());
        let Self { reducer, gap, change, problem, constraint, .. } = self;
        let potential = Potential { law: &problem.law, constraint: &**constraint };
        let total = reducer.run(read(gap).zip(read(change)), |first, (gap, change)| {
            let mut next: Buffer<T> = [T::zero(); _];
            let (mut before, mut after) = ([T::zero(); _], [T::zero(); _]);
            for ((next, &gap), &d) in next.iter_mut().zip(gap).zip(change) {
                *next = moved(projects, gap, length * d);
            }
            let before = potential.evaluate(Of::Energy, first, gap, &mut before);
            let after = potential.evaluate(Of::Energy, first, &next[..gap.len()], &mut after);
            let mut part = Partial::NONE;
            part.sum[0] = after.iter().zip(before).map(|(after, before)| after.widen() - before.widen()).sum();
            part
        });
        total.sum[0]
    }

    /// Takes `length` of the change: gap, pressure, what the step changed in r, and the tally of the new state.
    fn advance(&mut self, length: f64) {
        let (length, offset) = (T::lit(length), T::lit(self.offset()));
        let projects = self.constraint.projects();
        let Self { reducer, gap, pressure, change, response, problem, constraint, .. } = self;
        let potential = Potential { law: &problem.law, constraint: &**constraint };
        let local = !potential.is_zero::<T>();
        let fields = write(gap).zip(write(pressure)).zip(write(change)).zip(write(response));
        let fields = fields.zip(read(&problem.surface_pressure));
        let total = reducer.run(fields, |first, ((((gap, pressure), change), response), surface)| {
            let (mut before, mut after, mut buffer) = ([T::zero(); _], [T::zero(); _], [T::zero(); _]);
            if local {
                potential.evaluate(Of::Traction, first, gap, &mut before);
            }
            for (((gap, p), d), y) in
                gap.iter_mut().zip(pressure.iter_mut()).zip(change.iter_mut()).zip(response.iter_mut())
            {
                *d *= length;
                *y *= length;
                *gap = moved(projects, *gap, *d);
                *p += *y;
            }
            let tractions: &[T] = if local { potential.evaluate(Of::Traction, first, gap, &mut after) } else { &[] };
            for ((y, &after), &before) in response.iter_mut().zip(tractions).zip(&before) {
                *y += after - before;
            }
            let mut part = tally(&potential, offset, first, (gap, pressure, surface), tractions, &mut buffer);
            part.sum[8] = change.iter().zip(response).map(|(d, y)| d.widen() * y.widen()).sum();
            part
        });
        self.tally = Tally::new(&total);
        self.momentum = Some(total.sum[8]);
        self.age += 1;
    }
}

/// Whether a node may move: it is apart, or its residual says that it is released.
fn works<T: Real>(projects: bool, gap: T, residual: T) -> bool {
    !projects || gap > T::zero() || residual != T::zero()
}

/// The gap after a change, zero where only rounding keeps it from that.
fn moved<T: Real>(projects: bool, gap: T, change: T) -> T {
    let next = gap + change;
    if projects && next <= T::lit(4.0) * T::epsilon() * gap { T::zero() } else { next }
}
