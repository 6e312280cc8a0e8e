//! Surfaces that come apart under a load: the search for a state that adhesion holds, and the final gap if there is
//! none.

use super::descent::{Descent, End};
use super::driver::Observer;
use super::minimisation::Nearness;
use super::passes::Fields;
use super::plan::Stage;
use super::posed::Posed;
use super::stages::adhere;
use crate::degrees::{FAR, HARDLY, PARTLY, TWICE};
use crate::error::Result;
use crate::field::{found, read};
use crate::problem::Load;
use crate::real::Real;
use crate::vector::sums;

/// The most loads or mean gaps that are tried in search of a hold.
pub(super) const TRIES: usize = 12;

/// The share of an interval that a golden section keeps.
const GOLDEN: f64 = 0.618;

/// Gaps at which the law is asked for its strongest traction.
const SAMPLES: usize = 1000;

/// Where adhesion may hold surfaces that have come apart from full contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hold {
    /// Where they touch, under no load before.
    Touching,
    /// At some mean gap, under more than the tension.
    Gap,
}

impl Hold {
    pub(super) const ALL: [Self; 2] = [Self::Touching, Self::Gap];
}

found! {
    /// The sums of the gaps up to the closest gap, and of those beyond it.
    struct Opened {
        near: f64,
        apart: f64,
    }
}

impl<T: Real, Lo: Real> Posed<'_, T, Lo> {
    /// The mean gap from which on the surfaces hardly attract each other.
    fn out_of_reach(&self) -> f64 {
        self.flat.height_span + FAR * self.law().hints().range.widen()
    }

    /// Whether the load pulls by more than the law's strongest traction on all nodes that face the surface.
    pub(super) fn is_torn(&self) -> bool {
        let facing = self.facing() / self.nodes();
        matches!(self.load, Load::Pressure(load) if -load > (1.0 + PARTLY) * facing * self.strongest_traction())
    }

    /// The gap of nodes that touch: zero at a wall, the gap of rest where the law itself repels.
    pub(super) fn closest(&self) -> T {
        let rest = if self.projects() { None } else { self.law().hints().rest };
        rest.unwrap_or_else(T::zero)
    }

    /// The largest of many tractions of the law, which no uniform gap exceeds; narrow peaks may be missed. Without bound
    /// if the law does not say over which range it acts.
    fn strongest_traction(&self) -> f64 {
        let hints = self.law().hints();
        let range = hints.range.widen();
        if range <= 0.0 && !hints.zero {
            return f64::INFINITY;
        }
        let gaps = (0..SAMPLES).map(|i| T::lit(FAR * range * i as f64 / SAMPLES as f64));
        gaps.map(|gap| self.law().traction(gap).widen()).fold(0.0, f64::max)
    }

    /// The load that holds a mean gap: the mean gap itself, or a spring as stiff as the stiffest wave if nodes face no
    /// surface.
    fn holding(&self, gap: f64) -> Load {
        if self.flat.faces_all() {
            Load::Gap(gap)
        } else {
            Load::Spring { stiffness: self.stiffness_range().1, rest: gap }
        }
    }
}

/// Continues under the load from surfaces that touch undeformed and adhere under no load.
pub(super) fn touch<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, observe: Observer<'_>) -> Result<bool> {
    let (load, smooths) = (descent.iterate.posed.load, descent.iterate.posed.smoothed.is_some());
    descent.iterate.posed.from_full_contact = false;
    descent.iterate.start_undeformed()?;
    adhere(descent, Load::Pressure(0.0), if smooths { Stage::SMOOTHED } else { Stage::HOLD })?;
    let mut end = descent.minimise(&mut *observe)?;
    if smooths && !matches!(end, End::Cut(_)) {
        go_on(descent, load, Stage::SMOOTHED)?;
        end = descent.minimise(&mut *observe)?;
    }
    go_on(descent, load, Stage::SOLUTION)?;
    // a solve that is cut short ends at once
    Ok(matches!(end, End::Cut(_)) || !descent.proof().is_apart())
}

/// Looks for a state that holds more than the tensile load, to continue from under the load; `false` if it finds
/// none.
///
/// The tension at a given mean gap grows up to the pull-off and is lost beyond: a golden section looks for its
/// largest value, about the gap at which undeformed surfaces would touch.
pub(super) fn hold_gap<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, observe: Observer<'_>) -> Result<bool> {
    let load = match descent.iterate.posed.load {
        Load::Pressure(load) if load < 0.0 => load,
        _ => return Ok(false),
    };
    let (touch, rest) = (descent.iterate.posed.flat.peak, descent.iterate.posed.closest().widen());
    let mut interval =
        [rest + 0.5 * touch, rest + 1.5 * touch + 0.5 * FAR * descent.iterate.posed.law().hints().range.widen()];
    let [mut gaps, mut held] = [[0.0; 2]; 2];
    let (mut next, mut tried) = (None, Vec::with_capacity(TRIES));
    for section in 0..TRIES {
        let side = next.unwrap_or(section % 2);
        let width = interval[1] - interval[0];
        gaps[side] = if side == 0 { interval[1] - GOLDEN * width } else { interval[0] + GOLDEN * width };
        held[side] = match tension_at(descent, gaps[side], HARDLY * -load, &mut *observe)? {
            Some(tension) if tension >= -load => {
                go_on(descent, Load::Pressure(load), Stage::SOLUTION)?;
                descent.begin(Nearness::Near);
                return Ok(true);
            }
            Some(tension) => tension,
            None => break,
        };
        tried.push((gaps[side], held[side]));
        if most_between(&mut tried, HARDLY * -load) < -load {
            break;
        }
        if section > 0 {
            // the larger tension stays inside; where hardly any is held the surfaces are apart
            let larger = usize::from(held[1] > held[0].max(HARDLY * -load));
            interval[1 - larger] = gaps[1 - larger];
            (gaps[1 - larger], held[1 - larger]) = (gaps[larger], held[larger]);
            next = Some(larger);
        }
    }
    go_on(descent, Load::Pressure(load), Stage::SOLUTION)?;
    Ok(false)
}

/// The tension at a mean gap, from the contact or, if that hardly holds, a uniform gap; nothing if cut short.
fn tension_at<T: Real, Lo: Real>(
    descent: &mut Descent<'_, T, Lo>,
    gap: f64,
    hardly: f64,
    observe: Observer<'_>,
) -> Result<Option<f64>> {
    // where the law itself keeps the surfaces apart, it may hold them with no node pressed
    let is_soft = !descent.iterate.posed.projects();
    let holds = is_soft && descent.iterate.tally().traction > hardly * descent.iterate.posed.nodes();
    if descent.iterate.tally().contact == 0.0 && !holds {
        descent.iterate.fields.gap.nodes_mut().fill(T::lit(gap));
    } else if is_soft && descent.iterate.posed.flat.faces_all() {
        open_to(descent, gap);
    }
    go_on(descent, descent.iterate.posed.holding(gap), Stage::HOLD)?;
    let end = descent.minimise(observe)?;
    Ok((!matches!(end, End::Cut(_))).then(|| descent.iterate.multiplier() - descent.iterate.given()))
}

/// Scales the gaps of nodes apart to a given mean gap, or sets all gaps to it.
fn open_to<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, mean: f64) {
    let (nodes, closest) = (descent.iterate.posed.nodes(), descent.iterate.posed.closest());
    let Fields { reducer, gap, .. } = &mut descent.iterate.fields;
    let Opened { near, apart } = reducer.run(read(gap), |_, gap| {
        sums!([gap], [], |i| {} => Opened {
            near: gap[i].min(closest).widen(), apart: (gap[i] - closest).max(T::zero()).widen()
        })
    });
    let scale = (mean * nodes - near) / apart;
    let possible = scale.is_finite() && scale > 0.0;
    let (scale, mean) = (T::lit(scale), T::lit(mean));
    descent.iterate.each_gap(|gap| match possible {
        true if gap > closest => closest + scale * (gap - closest),
        true => gap,
        false => mean,
    });
}

fn go_on<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>, load: Load, stage: Stage) -> Result<()> {
    (descent.iterate.posed.load, descent.iterate.posed.stage) = (load, stage);
    // the refresh scales the mean of the present gap to the one that is held
    descent.iterate.count();
    descent.iterate.refresh()?;
    descent.restart();
    descent.forget_certificate();
    Ok(())
}

/// Holds drifting surfaces out of each other's reach, to come to rest.
pub(super) fn hold_apart<T: Real, Lo: Real>(descent: &mut Descent<'_, T, Lo>) {
    let far = 2.0 * descent.iterate.posed.out_of_reach();
    let mean = descent.iterate.mean_gap();
    let target = mean.max(far);
    let lift = T::lit(target - mean);
    descent.iterate.each_gap(|gap| gap + lift);
    descent.iterate.posed.detached = Some(descent.iterate.given());
    descent.iterate.posed.load = descent.iterate.posed.holding(target);
    descent.restart();
}

/// The most tension, with some margin, that a concave function through (gap, tension) pairs may have about the largest.
/// Without bound where all held hardly any, or that gap has no neighbours.
fn most_between(tried: &mut [(f64, f64)], hardly: f64) -> f64 {
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = (0..tried.len()).max_by(|&a, &b| tried[a].1.total_cmp(&tried[b].1)).unwrap_or_default();
    let (Some(&before), Some(&after)) = (best.checked_sub(1).and_then(|at| tried.get(at)), tried.get(best + 1)) else {
        return f64::INFINITY;
    };
    let (gap, most) = tried[best];
    if most <= hardly {
        return f64::INFINITY;
    }
    let rise = |from: (f64, f64), to: (f64, f64)| (most - from.1) / (gap - from.0) * (to.0 - gap);
    most + TWICE * rise(before, after).max(rise(after, before))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_tension_is_bounded_between_three_gaps() {
        let bound = |tried: &[(f64, f64)]| most_between(&mut tried.to_vec(), 1e-3);
        // −(x − 1)² + 1, which is largest at 1
        let at = |x: f64| (x, 1.0 - (x - 1.0).powi(2));
        let bounds = [0.8, 0.4, 0.1, 0.01]
            .map(|width| bound(&[at(1.0 + 1.1 * width), at(1.0 + 0.1 * width), at(1.0 - 0.9 * width)]));
        assert!(bounds.iter().all(|&bound| bound >= 1.0) && bounds.is_sorted_by(|a, b| a > b) && bounds[3] < 1.02);
        // lost beyond the largest
        assert!(bound(&[(0.8, 0.9), (1.0, 1.0), (1.1, 0.0)]) > 1.05);
        // no neighbour on one side, and nothing held at all
        assert_eq!([bound(&[at(0.5), at(0.7)]), bound(&[(0.0, -1.0), (1.0, 1e-9), (2.0, 0.0)])], [f64::INFINITY; 2]);
    }
}
