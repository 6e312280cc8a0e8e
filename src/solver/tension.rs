//! Surfaces that come apart under a load: whether adhesion could hold them, and where they come to rest if not.

use super::driver::{End, Observer, minimise};
use super::report::Status;
use super::state::{Goal, State};
use crate::error::Result;
use crate::field::{Partial, write};
use crate::problem::Load;
use crate::real::Real;

/// A share of the load that, held without contact, is hardly any.
const HARDLY: f64 = 1e-3;

/// The largest number of mean gaps that are tried in search of a hold, and the share of an interval that a golden
/// section keeps.
const SECTIONS: usize = 12;
const GOLDEN: f64 = 0.618;

/// Gaps at which the law is asked for its strongest traction.
const SAMPLES: usize = 100;

/// The distance at which surfaces are held apart, and the largest one at which a hold is sought, in ranges of adhesion
/// beyond the heights.
const REACH: f64 = 10.0;

impl<T: Real, L: Real> State<'_, T, L> {
    /// Whether a tensile load has pulled the surfaces apart: no contact, and hardly any traction left to hold them.
    pub(super) fn is_adrift(&self) -> bool {
        let Load::Pressure(pressure) = self.load else { return false };
        let held = self.tally.traction / self.nodes();
        pressure < 0.0 && self.tally.contact == 0.0 && held <= HARDLY * -pressure
    }

    /// The mean gap from which on the surfaces hardly attract each other.
    fn out_of_reach(&self) -> f64 {
        self.flat.height_span + REACH * self.law.range().widen()
    }

    /// Whether the surfaces drift apart under a load that presses them, as rounding may make them where the load is
    /// less than it: the mean gap is then beyond that of the start and of every equilibrium.
    pub(super) fn runs_away(&self) -> bool {
        let pressed = matches!(self.load, Load::Pressure(pressure) if pressure >= 0.0);
        pressed && self.tally.sum_gap / self.nodes() > self.start_gap + 2.0 * self.out_of_reach()
    }

    /// Looks for a state that holds more than the tensile load that is given, to go on from under the load; `false` if
    /// it finds none.
    ///
    /// At a given mean gap the surfaces come apart less easily than under a load. The tension that they hold grows
    /// with the gap up to the pull-off and is lost beyond: a golden section looks for its largest value, about the gap
    /// at which surfaces that are not deformed would touch. From a state that holds more than the load, the load lets
    /// them close up to an equilibrium.
    pub(super) fn seek_hold(&mut self, observe: Observer<'_>) -> Result<bool> {
        let Load::Pressure(load) = self.load else { return Ok(false) };
        if -load > self.strongest_traction() || !self.projects() {
            return Ok(false);
        }
        let touch = self.flat.peak;
        let mut interval = [0.5 * touch, 1.5 * touch + 0.5 * REACH * self.law.range().widen()];
        let [mut gaps, mut held] = [[0.0; 2]; 2];
        let mut next = None;
        for section in 0..SECTIONS {
            let side = next.unwrap_or(section % 2);
            let width = interval[1] - interval[0];
            gaps[side] = if side == 0 { interval[1] - GOLDEN * width } else { interval[0] + GOLDEN * width };
            held[side] = match self.tension_at(gaps[side], &mut *observe)? {
                Some(tension) if tension >= -load => {
                    self.go_on(Load::Pressure(load), Goal::Solution)?;
                    self.stays_near();
                    return Ok(true);
                }
                Some(tension) => tension,
                None => break,
            };
            if section > 0 {
                // the larger tension stays inside
                let larger = usize::from(held[1] > held[0]);
                interval[1 - larger] = gaps[1 - larger];
                (gaps[1 - larger], held[1 - larger]) = (gaps[larger], held[larger]);
                next = Some(larger);
            }
        }
        self.go_on(Load::Pressure(load), Goal::Solution)?;
        Ok(false)
    }

    /// The tension at a given mean gap, from a uniform gap; nothing if the solve was stopped or ran out of iterations.
    fn tension_at(&mut self, gap: f64, observe: Observer<'_>) -> Result<Option<f64>> {
        self.fields.gap.fill(T::lit(gap));
        self.go_on(self.holding(gap), Goal::Hold)?;
        let end = minimise(self, observe)?;
        let gave = matches!(end, End::Gave(Status::Stopped | Status::IterationLimit));
        Ok((!gave).then(|| self.multiplier() - self.given))
    }

    /// The largest of many tractions of the law: no uniform gap holds more.
    fn strongest_traction(&self) -> f64 {
        let range = self.law.range().widen();
        let gaps = (0..SAMPLES).map(|i| T::lit(REACH * range * i as f64 / SAMPLES as f64));
        gaps.map(|gap| self.law.traction(gap).widen()).fold(0.0, f64::max)
    }

    /// The load that holds a mean gap: that itself, or, where some nodes face no surface, a spring as stiff as the
    /// stiffest wave.
    fn holding(&self, gap: f64) -> Load {
        match self.flat.window {
            None => Load::Gap(gap),
            Some(_) => Load::Spring { stiffness: self.operators.state().stiffness_range().1, rest: gap },
        }
    }

    /// Goes on from the present gap under another control.
    fn go_on(&mut self, load: Load, goal: Goal) -> Result<()> {
        (self.load, self.goal) = (load, goal);
        // the mean of the present gap, which the refresh scales to the one that is held
        self.count();
        self.refresh()?;
        self.restart();
        self.certificate = f64::INFINITY;
        Ok(())
    }

    /// Holds surfaces that drift apart at a mean gap at which they do not reach each other, to let them come to rest.
    pub(super) fn hold_apart(&mut self) {
        let far = 2.0 * self.out_of_reach();
        let mean = self.tally.sum_gap / self.nodes();
        let target = mean.max(far);
        let lift = T::lit(target - mean);
        self.fields.reducer.run(write(&mut self.fields.gap), |_, gap| {
            gap.iter_mut().for_each(|gap| *gap += lift);
            Partial::NONE
        });
        self.detached = Some(self.given);
        self.load = self.holding(target);
        self.restart();
    }
}
