//! Conjugate gradients with the compliance as preconditioner, two operator applications a step.

use super::Descent;
use crate::degrees::{FAR, HALF, LITTLE, MOSTLY};
use crate::error::Result;
use crate::field::{CHUNK, Sums, read, write};
use crate::par::Parts;
use crate::real::{Real, cast};
use crate::solver::iterate::Iterate;
use crate::solver::minimisation::{Nearness, Next, Step};
use crate::solver::passes::{self, Attempt, Fields, Tried, idles};

/// The least best length, as a share of a clipped step, for which the whole is taken, to land its clipped nodes.
const WHOLE: f64 = 0.7;

/// The least and largest ratio of two successive trial lengths.
const ADAPT: (f64, f64) = (0.7, 1.3);

/// The same where the surface yields: nodes that yield or stop doing so change the curvature by more.
const ADAPT_YIELDING: (f64, f64) = (0.5, 2.0);

/// The multiple of the last change c₀ in the next step.
#[derive(Clone, Copy)]
struct Momentum {
    /// the multiple that makes −z conjugate to c₀
    conjugate: f64,
    /// the multiple that minimises the energy along c₀, or continues along it where the energy is concave
    remainder: f64,
    /// the mean of c₀ over the working set
    mean: f64,
}

/// A trial step d = scale·(g + c) − g, with the sums of its change c.
struct Trial {
    tried: Tried,
    scale: f64,
    /// ⟨r', d⟩
    slope: f64,
    /// the energy beyond the tangents of nodes that pass a corner of the local energy
    kink: f64,
    /// Σ φ''·d²
    slopes: f64,
}

impl Trial {
    /// Whether nodes ended at the wall, or passed a corner.
    fn is_clipped(&self) -> bool {
        self.tried.clipped > 0.0 || self.kink > 0.0
    }
}

impl<T: Real, Lo: Real> Descent<'_, T, Lo> {
    /// A step along the projected, conjugate, preconditioned residual; nothing if no step lowers the energy.
    pub(super) fn preconditioned_step(&mut self) -> Result<Option<Next>> {
        // with the waves at rest
        let waits = self.iterate.hangs_on_spring()
            && self.proof().relative_error() <= self.iterate.posed.settings.tolerance_in::<T>();
        if waits && self.shift()? {
            return Ok(Some(Next::Compute));
        }
        let length = self.step_length;
        let next = self.try_step()?;
        if next.is_some() || length >= 1.0 || self.proof().is_at_floor() {
            return Ok(next);
        }
        // a step shorter than the last digit of the gaps changes nothing: begin anew at full length
        self.step_length = 1.0;
        self.iterate.residual();
        self.certify()?;
        self.try_step()
    }

    /// A step of the mean gap alone, as long as the spring's and without the rounding of a response. `false` if it ends
    /// at a wall, or does not lower the energy.
    fn shift(&mut self) -> Result<bool> {
        let imbalance = self.iterate.imbalance();
        let length = std::mem::replace(&mut self.step_length, 1.0);
        self.iterate.fields.preconditioned.nodes_mut().fill(Lo::zero());
        let mut trial = self.trial(-imbalance / self.iterate.posed.load.stiffness(), None);
        // the sum of r', which is of Lo, has the rounding of the waves
        trial.slope = trial.tried.change * imbalance;
        trial.tried.descent = trial.slope;
        let step = if trial.is_clipped() || trial.slope >= 0.0 { None } else { self.search(&trial, 0.0) };
        self.step_length = length;
        let Some(step) = step else {
            self.iterate.residual();
            self.certify()?;
            return Ok(false);
        };
        self.iterate.fields.residual.nodes_mut().fill(Lo::zero());
        self.iterate.advance(step);
        // the last change is of the waves
        self.iterate.take_momentum();
        Ok(true)
    }

    fn try_step(&mut self) -> Result<Option<Next>> {
        let (centre, mut momentum) = self.direction();
        loop {
            let trial_length = self.step_length;
            let Some(trial) = self.falling(centre, &mut momentum) else { return Ok(None) };
            let Fields { change, residual: response, .. } = &mut self.iterate.fields;
            let elastic =
                self.iterate.posed.operators.corrections().pressure_and_work(change.view(), response.view_mut())?;
            self.iterate.applied();
            let Some(step) = self.search(&trial, elastic * self.iterate.posed.nodes()) else { return Ok(None) };
            if trial.tried.blocked == 0.0 || self.iterate.has_yielded() || step.length >= LITTLE {
                return Ok(Some(self.iterate.advance(step)));
            }
            // so short a part leaves the blocked nodes apart: drop the last change, or shorten the step
            let shorter = if momentum.is_some() { 1.0 } else { step.length };
            self.step_length = trial_length * shorter;
            momentum = None;
            self.iterate.residual();
        }
    }

    /// The mean of z over the working set, and the multiple of the last change.
    fn direction(&mut self) -> (f64, Option<Momentum>) {
        let share = if self.iterate.posed.is_gap_controlled() && self.iterate.sums_of_residual().working > 0.0 {
            1.0 / self.iterate.sums_of_residual().working
        } else {
            0.0
        };
        let centre =
            if share > 0.0 { (self.preconditioned.sum - passes::idle(&mut self.iterate.fields)) * share } else { 0.0 };
        let momentum = self.iterate.take_momentum().and_then(|made| {
            let (conjugate, remainder) = if made.curvature > 0.0 {
                let overlap = self.preconditioned.descent - made.overlap;
                // the mean gap has no elastic curvature that would limit a step
                ((overlap / made.curvature).max(0.0), (-made.factor * made.descent / made.curvature).min(FAR))
            } else if made.factor * made.descent < 0.0 {
                (0.0, MOSTLY)
            } else {
                return None;
            };
            let [conjugate, remainder] = [conjugate, remainder].map(|multiple| made.factor * multiple);
            Some(Momentum { conjugate, remainder, mean: made.sum * share })
        });
        (centre, momentum)
    }

    /// Puts a feasible change into `change` along which the energy falls. A step that clipping and scaling turn uphill
    /// is tried without the last change; then the blocked nodes alone are put into contact, or, without any, it is
    /// shortened down to its rounding.
    fn falling(&mut self, centre: f64, momentum: &mut Option<Momentum>) -> Option<Trial> {
        loop {
            let trial = self.trial(centre, *momentum);
            if trial.slope < 0.0 {
                return Some(trial);
            }
            if momentum.take().is_some() {
                continue;
            }
            if trial.tried.blocked > 0.0 {
                return Some(self.land(centre, trial)).filter(|trial| trial.slope < 0.0);
            }
            self.step_length *= 0.5;
            if self.step_length < T::epsilon().widen() {
                return None;
            }
        }
    }

    /// The clipped change of a step of the trial length; scaled, it leaves the mean gap as it is.
    fn trial(&mut self, centre: f64, momentum: Option<Momentum>) -> Trial {
        let length = self.step_length;
        let (keep, mean) = momentum.map_or((0.0, 0.0), |m| (length * m.conjugate + m.remainder, m.mean));
        let [length, centre, keep, mean] = [length, centre, keep, mean].map(T::lit);
        let yields = self.iterate.sums_of_residual().yields;
        let attempt = Attempt { length, centre, keep, mean, yields };
        let surface = (self.iterate.posed.is_gap_controlled(), &self.iterate.posed.flat.pressure);
        let local = self.iterate.posed.potential();
        let tried = passes::trial(&mut self.iterate.fields, &local, attempt, surface);
        // the given mean would let a long step multiply the rounding of their difference
        let present = self.iterate.tally().sum_gap;
        let scales = self.iterate.posed.is_gap_controlled() && tried.clipped > 0.0;
        let scale = if scales { present / (present + tried.change) } else { 1.0 };
        let possible = scale.is_finite() && scale > 0.0;
        // rounded as in the passes
        let scale = T::lit(scale).widen();
        let rest = scale - 1.0;
        let Tried { slope_change, slope_mixed, slope_gap, .. } = tried;
        let trial = Trial {
            tried,
            scale,
            slope: if possible { scale * tried.descent + rest * tried.gap_descent } else { f64::INFINITY },
            kink: if possible { scale * tried.kink } else { 0.0 },
            slopes: scale * scale * slope_change + 2.0 * scale * rest * slope_mixed + rest * rest * slope_gap,
        };
        let of_both_signs = self.iterate.has_yielded() || yields && self.iterate.tally().contact > 0.0;
        if of_both_signs && scales { self.scale_apart(trial) } else { trial }
    }

    /// A change that scales only the gaps above zero: all gaps, of both signs, may have hardly any mean.
    fn scale_apart(&mut self, trial: Trial) -> Trial {
        let local = self.iterate.posed.potential();
        let Fields { reducer, gap, change, .. } = &mut self.iterate.fields;
        let next = |gap: T, change: Lo| gap + cast::<_, T>(change);
        let apart = local.run(reducer, read(gap).zip(read(change)), |_, _, (gap, change)| {
            gap.iter().zip(change).map(|(&gap, &c)| next(gap, c).max(T::zero()).widen()).sum::<f64>()
        });
        let scale = 1.0 - trial.tried.change / apart;
        if !(scale.is_finite() && scale > 0.0) {
            return Trial { slope: f64::INFINITY, ..trial };
        }
        let scale = T::lit(scale);
        self.remake(trial, move |_, gap, [_, _, change]| match next(gap, change) {
            next if next > T::zero() => cast(scale * next - gap),
            _ => change,
        })
    }

    /// A change that puts the blocked nodes into contact and lifts the others; both lower the energy.
    fn land(&mut self, centre: f64, trial: Trial) -> Trial {
        let (length, centre) = (T::lit(self.step_length), T::lit(centre));
        let held = self.iterate.posed.is_gap_controlled();
        let local = self.iterate.posed.potential();
        let capped = self.iterate.sums_of_residual().yields;
        let lands = move |gap: T, r: Lo, z: Lo| {
            let wanted = length * (cast::<_, T>(z) - centre);
            gap > T::zero() && r > Lo::zero() && gap < wanted
                || capped && gap < T::zero() && r < Lo::zero() && gap > wanted
        };
        // a node that touches moves to one side only
        let lifted = move |gap: T, r: Lo| !(idles(r) || capped && gap == T::zero());
        let Fields { reducer, gap, residual, preconditioned, .. } = &mut self.iterate.fields;
        let fields = read(gap).zip(read(residual)).zip(read(preconditioned));
        let [landed, others] = local.run(reducer, fields, |local, _, ((gap, residual), z)| {
            let ([mut landed, mut others], faces) = ([0.0; 2], local.is_surface());
            for ((&gap, &r), &z) in gap.iter().zip(residual).zip(z) {
                if faces && lands(gap, r, z) {
                    landed += gap.widen();
                } else if lifted(gap, r) {
                    others += 1.0;
                }
            }
            [landed, others]
        });
        let lift = Lo::lit(if held { landed / others } else { 0.0 });
        self.remake(trial, move |faces, gap, [r, z, _]| {
            if faces && lands(gap, r, z) {
                cast(-gap)
            } else if lifted(gap, r) {
                lift
            } else {
                Lo::zero()
            }
        })
    }

    /// Writes a change anew, of each node by whether it faces the surface, its gap, its residual before and after the
    /// preconditioner, and its change.
    fn remake(&mut self, trial: Trial, anew: impl Fn(bool, T, [Lo; 3]) -> Lo + Sync + Send) -> Trial {
        let local = self.iterate.posed.potential();
        let Fields { reducer, gap, residual, preconditioned, change, .. } = &mut self.iterate.fields;
        let fields = read(gap).zip(read(residual)).zip(read(preconditioned)).zip(write(change));
        let found = local.run(reducer, fields, |local, first, (((gap, residual), z), change)| {
            let nodes = gap.iter().zip(residual).zip(z).zip(&mut *change);
            nodes.for_each(|(((&gap, &r), &z), d)| *d = anew(local.is_surface(), gap, [r, z, *d]));
            let (mut found, mut tractions, mut slopes) = (Tried::NONE, [T::zero(); CHUNK], [T::zero(); CHUNK]);
            if !local.is_zero() {
                let (tractions, slopes) = (&mut tractions[..gap.len()], &mut slopes[..gap.len()]);
                local.tractions_and_slopes(first, gap, tractions, slopes);
                found.kink = local.yielding(first, gap, change, tractions, slopes);
            }
            for (i, (&r, &d)) in residual.iter().zip(&*change).enumerate() {
                let ([r, d], [t, s]) = ([r, d].map(Lo::widen), [tractions[i], slopes[i]].map(T::widen));
                found.descent += r * d;
                found.change += d;
                found.traction += t * d;
                found.slope_change += s * d * d;
                found.square += d * d;
            }
            found
        });
        let Tried { descent: slope, change, square, traction, slope_change: slopes, kink, .. } = found;
        let tried = Tried { change, descent: slope, square, traction, ..trial.tried };
        Trial { tried, scale: 1.0, slope, kink, slopes }
    }

    /// The length of a step with `elastic` = ⟨c, K⁻¹c⟩; `None` if the energy rises at every length.
    fn search(&mut self, trial: &Trial, elastic: f64) -> Option<Step> {
        let (shift, nodes) =
            (self.iterate.offset() - self.iterate.sums_of_residual().level, self.iterate.posed.nodes());
        let noise = self.iterate.energy_noise() * nodes;
        let stiffness = self.iterate.posed.load.stiffness();
        let tally = *self.iterate.tally();
        let Iterate { fields, posed, .. } = &mut self.iterate;
        let local = posed.potential();
        let (scale, rest) = (T::lit(trial.scale), trial.scale - 1.0);
        let Tried { change, descent, traction, change_surface, gap_surface, .. } = trial.tried;
        // p = r' − φ'(g) and two constants, at every node with a change
        let pressed = descent - shift * change - traction;
        let cross = if rest == 0.0 {
            0.0
        } else {
            2.0 * trial.scale * rest * (pressed - change_surface) + rest * rest * (tally.sum_gp - gap_surface)
        };
        // the elastic curvature of a uniform change is rounding, of either sign
        let elastic = (trial.scale * trial.scale * elastic + cross).max(0.0);
        let work = trial.scale * pressed + rest * tally.sum_gp;
        let change = trial.scale * change + rest * tally.sum_gap;
        let shifted = work + shift * change;
        let spring = stiffness * change * change / nodes;
        if !(elastic + shifted).is_finite() {
            return None;
        }
        let (slopes, quadratic) = (trial.slopes, elastic + spring);
        let stiff = quadratic + slopes > LITTLE * quadratic;
        let curvature = if stiff { quadratic + slopes } else { LITTLE * quadratic };
        let best = (-(trial.slope + trial.kink) / curvature).min(FAR);
        // nodes that pass their corners leave none along the tangent: the whole step, which the search halves
        let best = if trial.kink > 0.0 && best <= 0.0 { 1.0 } else { best };
        let mut length = match trial.is_clipped() {
            true if best >= WHOLE => 1.0,
            true => best,
            false if local.projects() && best <= 1.0 => best,
            false if local.projects() => best.min(passes::reach(fields, &local).max(1.0)),
            // the law has no bound at zero gap
            false => best.min(HALF * passes::reach(fields, &local)),
        };
        // the tangent of a concave energy bounds it
        let bound = length * trial.slope + 0.5 * length * length * quadratic;
        if trial.kink > 0.0 || !(local.is_straight() || local.is_concave() && bound <= noise) {
            let before = tally.adhesive + tally.penalty;
            loop {
                let after = passes::energy_after(fields, &local, T::lit(length), scale);
                let rise = length * shifted + 0.5 * length * length * quadratic + (after - before);
                if rise.is_finite() && rise <= noise {
                    break;
                }
                length *= 0.5;
                if length < T::epsilon().widen() {
                    return None;
                }
            }
        }
        self.adapt(best);
        let (scale, slope, square) = (trial.scale, trial.slope, trial.tried.square);
        (length > 0.0).then_some(Step { length, scale, slope, square, change, work, elastic, spring })
    }

    /// Lets the trial length follow a best length.
    fn adapt(&mut self, best: f64) {
        // near the solution the best lengths scatter: damp their changes
        let ratio = if self.iterate.posed.nearness >= Nearness::Ahead { best.sqrt() } else { best };
        let (least, most) = if self.iterate.has_yielded() { ADAPT_YIELDING } else { ADAPT };
        self.step_length *= ratio.clamp(least, most);
    }
}
