//! The balance of energy of a step, by which it is taken, taken back, or a jump.

use super::course::{Course, PLACES};
use super::figures::{Figures, Mode};
use super::quadrature::{integral, trapezoid};
use crate::degrees::{LITTLE, PARTLY};
use crate::solver::Report;

/// The share of the energy of a jump to which the work of the load in its step is known.
const LOCATED: f64 = 0.2;

/// The share of the dissipated energy in the scale of an imbalance: where there are many jumps, those that are small
/// compared with all before are not located one by one.
const MANY: f64 = 20.0;

/// The share of the expected growth of the tension in a step, below which it may have had a maximum there.
const GROWN: f64 = 0.25;

/// The least and the largest ratio of two successive steps.
const GROWTH: (f64, f64) = (0.5, 2.0);

#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// whether the energy changed by the work of the load
    pub(super) balanced: bool,
    /// whether it fell by more than any work of the load in such a step
    pub(super) jumped: bool,
    /// whether it jumped in a step that is short enough to be taken
    pub(super) located: bool,
    /// whether the tension may have grown in it beyond the largest one so far
    pub(super) peaks: bool,
    /// the imbalance that the step may have
    pub(super) allowed: f64,
    /// the work by quadrature
    pub(super) work: f64,
    /// the change of the energy beyond the work
    pub(super) excess: f64,
    /// what a jump anywhere in it dissipates
    pub(super) drop: f64,
    /// what jumps have dissipated before, of a law that attracts next to contacts alone; infinite of others
    pub(super) before: f64,
    /// the factor by which the next step may be longer
    pub(super) growth: f64,
}

impl Balance {
    /// Whether a jump is located by a step, from the product of the step and the change of the load: its work lies
    /// within half of that, as the jump may be anywhere in the step.
    pub(super) fn locates(&self, product: f64) -> bool {
        // a loop of a law without a range is known to the grid, and not to where in its step a jump is
        let known = (LOCATED * self.drop).min(LITTLE * (self.before + self.drop));
        0.5 * product.abs() <= self.allowed.max(known)
    }
}

impl Course {
    /// The balance of a step, up to an imbalance as a share of the change of the energy (`least` at least) and of what
    /// jumps have dissipated, the noise of rounding, and what the tolerance of the solver has `left`.
    pub(super) fn balance(
        &self,
        target: f64,
        report: &Report,
        (imbalance, least): (f64, f64),
        (noise, left): (f64, f64),
        touching: bool,
    ) -> Balance {
        let (here, next) = (self.here(), Figures::of(report).held_by(self.mode));
        let ((from, before), (_, after)) = (here.slope(self.mode), next.slope(self.mode));
        let step = target - from;
        let mut points: Vec<_> = self.places.iter().map(|place| place.slope(self.mode)).collect();
        points.push((target, after));
        let points = &points[points.len().saturating_sub(PLACES)..];
        let change = next.potential(self.mode) - here.potential(self.mode);
        let along = integral(points, (from, target));
        let excess = change - along;
        let (low, high) = self.account.range;
        let scale = (high.max(next.energy) - low.min(next.energy)).max(least) + MANY * self.account.dissipated;
        let allowed = (imbalance * scale + noise).max(left);
        let order = 1.0 + points.len() as f64;
        let growth = (0.5 * allowed / excess.abs()).powf(order.recip());
        let energy = next.energy - here.energy;
        let product = step * (after - before);
        let drop = trapezoid((from, before), (target, after)) - change;
        // under a corner of the load the integral is between this one and the integral of the branch before, continued
        let continued = integral(&points[..points.len() - 1], (from, target));
        let corner = allowed.max(product.abs()).max((along - continued).abs());
        let (peak, breaks_off) = self.peak(step, next.pressure, noise.max(left));
        let balance = Balance {
            // a jump of little energy, or a smooth maximum, may be in the step
            // corners of the load, where nodes come into contact, are smaller
            balanced: excess.abs() <= allowed && !(breaks_off && peak > PARTLY),
            jumped: -excess > corner,
            located: false,
            peaks: peak > LITTLE,
            allowed,
            work: energy - excess,
            excess,
            drop,
            before: if touching { self.account.dissipated } else { f64::INFINITY },
            growth: if growth.is_nan() { GROWTH.1 } else { growth.clamp(GROWTH.0, GROWTH.1) },
        };
        let stays = self.bracket.is_some_and(|bracket| bracket.keeps(drop));
        let located = stays && balance.locates(product) && !balance.peaks;
        Balance { located: balance.jumped && drop > corner && located, ..balance }
    }

    /// The share of the largest tension so far by which the tension may have grown beyond it along the branch, somewhere
    /// in a step, if that is more than the noise of an energy; and whether it grew by less than was to be expected.
    fn peak(&self, step: f64, after: f64, noise: f64) -> (f64, bool) {
        let ([.., last, here], Mode::Gap | Mode::Spring(_)) = (&self.places[..], self.mode) else {
            return (0.0, false);
        };
        let [(x0, p0), (x1, p1)] = [last, here].map(|place| place.slope(self.mode));
        let growth = (p1 - p0) / (x1 - x0) * step;
        let largest = self.account.tension.max(-after);
        let beyond = p1 + growth - largest;
        let peak = if beyond * step.abs() > noise { beyond / largest } else { 0.0 };
        (peak, -after - p1 < GROWN * growth)
    }
}
