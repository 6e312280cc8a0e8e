//! The state of a path: its leg, its last places, the length of the next step, and the account of energy.

use super::account::Account;
use super::balance::Balance;
use super::bracket::Bracket;
use super::figures::{Figures, Mode};
use super::quadrature::trapezoid;
use super::{Event, Jump, PathSettings};
use crate::degrees::{FIRST_STEP, HARDLY};
use crate::problem::{Control, Load, PressedFlat};
use crate::solver::Report;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Way {
    pub(super) jumped: bool,
    /// whether surfaces have touched at new places
    pub(super) touches: bool,
    /// the eigenvalue of the saddle that was left, where a symmetry breaks
    pub(super) bifurcation: Option<f64>,
}

impl Way {
    pub(super) fn is_new(&self) -> bool {
        self.jumped || self.bifurcation.is_some()
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Course {
    pub(super) solved: bool,
    pub(super) leg: usize,
    pub(super) mode: Mode,
    /// whether the boundary is free, and the nominal area
    free: bool,
    area: f64,
    /// where this leg, or its rest under another control, began and ends
    span: (f64, f64),
    step: f64,
    /// where the leg ends and began in pressure, if mean gaps are given on the way there
    pressures: Option<(f64, f64)>,
    limit: Option<(f64, f64)>,
    /// whether the last state is a saddle that could not be left
    pub(super) on_saddle: bool,
    pub(super) account: Account,
    /// the last states on the branch, the latest last: at most four
    pub(super) places: Vec<Figures>,
    /// the states with kept gaps
    pub(super) at: Vec<Figures>,
    pub(super) bracket: Option<Bracket>,
}

/// The step after a jump, as a share of that before it.
const REGAINED: f64 = 0.25;

/// The smallest step as a share of the leg, if none is given.
const SMALLEST: f64 = 1e-4;

/// The largest number of states in the quadrature.
pub(super) const PLACES: usize = 4;

impl Course {
    pub(super) fn on<T>(flat: &PressedFlat<T>) -> Self {
        Self { free: !flat.boundary.is_periodic(), area: flat.area, ..Self::default() }
    }

    pub(super) fn control(&self, value: f64) -> Control {
        match self.mode {
            Mode::Gap if self.free => Control::Approach(-value),
            Mode::Gap => Control::MeanGap(value),
            Mode::Pressure => Control::MeanPressure(value),
            Mode::Spring(compliance) => {
                Control::Spring { stiffness: self.area / compliance, rest: if self.free { -value } else { value } }
            }
        }
    }

    /// The control that holds the mean gap where the load is a position.
    pub(super) fn held<T>(&self, flat: &PressedFlat<T>) -> Load {
        let rigid = flat.boundary.mean_compliance();
        let compliance = if let Mode::Spring(compliance) = self.mode { flat.padding * compliance } else { 0.0 };
        match rigid + compliance {
            0.0 => Load::Gap(0.0),
            compliance => Load::Spring { stiffness: compliance.recip(), rest: 0.0 },
        }
    }

    pub(super) fn here(&self) -> Figures {
        self.places.last().copied().unwrap_or_default()
    }

    pub(super) fn begin(&mut self, report: &Report) {
        let place = Figures::of(report);
        self.solved = true;
        self.account.range = (place.energy, place.energy);
        (self.places, self.at) = (vec![place], vec![place]);
        let (x, _) = place.slope(self.mode);
        self.span = (x, x);
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.span.0 == self.span.1 || self.here().slope(self.mode).0 == self.span.1
    }

    /// The share of the way through that many loads that is behind, all legs alike.
    pub(super) fn share(&self, loads: usize) -> f64 {
        let along = |from: f64, to: f64, at: f64| ((at - from) / (to - from)).clamp(0.0, 1.0);
        let here = self.here();
        let leg = match self.pressures {
            _ if self.is_at_end() => 1.0,
            // at given mean gaps, to wherever the pressure or the contact ends
            Some((end, start)) => {
                along(start, end, here.pressure).max(along(self.span.0, self.span.1, here.slope(self.mode).0))
            }
            None => along(self.span.0, self.span.1, here.slope(self.mode).0),
        };
        match loads.saturating_sub(1) {
            0 => f64::from(u8::from(self.solved)),
            legs => (self.leg.saturating_sub(1) as f64 + if self.leg > 0 { leg } else { 0.0 }) / legs as f64,
        }
    }

    pub(super) fn end_leg(&mut self) {
        let (x, _) = self.here().slope(self.mode);
        self.span = (x, x);
    }

    pub(super) fn end(&self) -> f64 {
        self.span.1
    }

    pub(super) fn enter(&mut self, leg: usize, load: Control, settings: &PathSettings) {
        let (mode, end) = match load.on_position(self.free, self.area) {
            Load::Gap(position) => (Mode::Gap, position),
            Load::Pressure(pressure) => (Mode::Pressure, pressure),
            Load::Spring { stiffness, rest } => (Mode::Spring(self.area / stiffness), rest),
        };
        (self.leg, self.pressures) = (leg, None);
        self.turn(mode, end, settings);
    }

    fn turn(&mut self, mode: Mode, end: f64, settings: &PathSettings) {
        let here = self.here().held_by(mode);
        self.at.iter_mut().for_each(|place| *place = place.held_by(mode));
        self.mode = mode;
        self.span = (here.slope(mode).0, end);
        self.bracket = None;
        // nothing is known of the branch in that direction
        self.places = vec![here];
        self.step = (self.length() / settings.steps as f64 * FIRST_STEP).max(self.smallest(settings));
    }

    fn length(&self) -> f64 {
        (self.span.1 - self.span.0).abs()
    }

    fn smallest(&self, settings: &PathSettings) -> f64 {
        settings.smallest_step.unwrap_or(SMALLEST) * self.length()
    }

    /// The value of the held quantity in the next step, and whether the step cannot be halved.
    pub(super) fn next_target(&self, settings: &PathSettings) -> (f64, bool) {
        let (from, end) = (self.here().slope(self.mode).0, self.bracket.map_or(self.span.1, |bracket| bracket.end.0));
        let left = (end - from).abs();
        let smallest = self.smallest(settings);
        // no tiny step at the end
        let step = if self.step >= left {
            left
        } else if 1.5 * self.step >= left {
            0.5 * left
        } else {
            self.step
        };
        let target = if step == left { end } else { from + step * (end - from).signum() };
        // as close as numbers can be
        let target = if target == from { end } else { target };
        (target, step <= smallest)
    }

    /// Takes a step back, to the state of a report, with its balance.
    pub(super) fn halve(&mut self, report: &Report, trial: Balance, settings: &PathSettings) {
        let (target, _) = self.next_target(settings);
        let tried = (target - self.here().slope(self.mode).0).abs();
        let there = Figures::of(report).held_by(self.mode);
        let stride = self.bracket.map_or(tried, |bracket| bracket.stride);
        let (end, potential) = ((target, there.slope(self.mode).1), there.potential(self.mode));
        self.bracket = Some(Bracket { end, potential, drop: trial.drop, stride });
        self.step = (0.5 * tried).max(self.smallest(settings));
    }

    /// The end of the shortest step that was taken back, if it is ahead.
    pub(super) fn taken_back(&self) -> Option<f64> {
        self.bracket.map(|bracket| bracket.end.0)
    }

    /// The length of the next step in units of the last one.
    pub(super) fn extrapolation(&self, target: f64) -> f64 {
        let at: Vec<_> = self.at.iter().map(|place| place.slope(self.mode).0).collect();
        match at[..] {
            [before, last] => (target - last) / (last - before),
            _ => 0.0,
        }
    }

    /// Continues at given mean gaps, from a limit point or before a bifurcation: between the gap at which the surfaces
    /// bear the pressure at the leg's end and that at which they lose each other.
    pub(super) fn leave_pressure_control(
        &mut self,
        (close, far): (f64, f64),
        limit_point: bool,
        settings: &PathSettings,
    ) {
        let here = self.here();
        let (from, to) = self.span;
        if !self.free && here.gap <= close && to > from {
            // pressed flat, and no way to continue
            self.span = (here.pressure, here.pressure);
            return;
        }
        self.limit = limit_point.then_some((here.gap, here.pressure));
        self.pressures = Some((to, from));
        let end = match to > from {
            true if self.free => here.position - far,
            true => close,
            false if self.free => here.position + far,
            false => far.max(2.0 * here.gap),
        };
        self.turn(Mode::Gap, end, settings);
        self.step = self.smallest(settings);
    }

    /// Whether a step at a given mean gap passes the pressure at which the leg ends: then the next one is shorter.
    pub(super) fn overshoots(&mut self, report: &Report, settings: &PathSettings) -> bool {
        let Some((end, start)) = self.pressures else { return false };
        let (before, after) = (self.here().pressure, report.mean_pressure);
        let beyond = (after - end) * (end - start).signum();
        if beyond <= HARDLY * (end - start).abs() || (after - before) * (end - start) <= 0.0 {
            return false;
        }
        let share = ((end - before) / (after - before)).clamp(0.1, 0.9);
        let (target, smallest) = self.next_target(settings);
        self.step = share * (target - self.here().slope(self.mode).0).abs();
        !smallest
    }

    /// Takes a step to the state of a report, with its balance.
    pub(super) fn accept(
        &mut self,
        target: f64,
        report: &Report,
        trial: Balance,
        way: Way,
        settings: &PathSettings,
    ) -> Option<Event> {
        let (here, mut next) = (self.here(), Figures::of(report).held_by(self.mode));
        // the held quantity is exactly the given one
        match self.mode {
            Mode::Gap if self.free => next.position = target,
            Mode::Gap => (next.position, next.gap) = (target, target),
            Mode::Spring(_) => next.rest = target,
            Mode::Pressure => next.pressure = target,
        }
        let drop = self.book([here, next], target, trial, way);
        let event = self.event([here, next], drop, way);
        self.step = self.next_step([here, next], target, trial, way, settings);
        self.arrive(next, way);
        self.land(next, settings);
        event
    }

    /// Adds a step to the account; returns the energy that a jump in it dissipates.
    fn book(&mut self, [here, next]: [Figures; 2], target: f64, trial: Balance, way: Way) -> f64 {
        let Account { work, dissipated, imbalance, variance, range, tension, touches } = &mut self.account;
        *range = (range.0.min(next.energy), range.1.max(next.energy));
        *tension = tension.max(-next.pressure);
        *touches += usize::from(way.touches);
        if !way.jumped {
            *work += trial.work;
            *imbalance += trial.excess;
            *variance += trial.excess.powi(2);
            return 0.0;
        }
        // the jump is anywhere in the step, each place as likely as another
        let done = -trapezoid((here.position, here.pressure), (next.position, next.pressure));
        let [(from, before), (_, after)] = [here, next].map(|place| place.slope(self.mode));
        *variance += ((target - from) * (after - before)).powi(2) / 12.0;
        let drop = done - (next.energy - here.energy);
        *work += done;
        *dissipated += drop;
        drop
    }

    /// The event in a step, that the account has.
    fn event(&mut self, [here, next]: [Figures; 2], energy_drop: f64, way: Way) -> Option<Event> {
        let limit = self.limit.take();
        let jump = Jump {
            mean_gap: (here.gap, next.gap),
            mean_pressure: (here.pressure, next.pressure),
            approach: self.free.then_some((-here.position, -next.position)),
            contact_fraction: (here.contact, next.contact),
            touches: way.touches,
            energy_drop,
        };
        match way.bifurcation {
            Some(eigenvalue) => Some(Event::Bifurcation { eigenvalue, jump }),
            None if way.jumped => Some(Event::Jump(jump)),
            None => limit.map(|(mean_gap, mean_pressure)| Event::LimitPoint { mean_gap, mean_pressure }),
        }
    }

    /// The length of the step after one to `target`.
    fn next_step(
        &mut self,
        [here, next]: [Figures; 2],
        target: f64,
        trial: Balance,
        way: Way,
        settings: &PathSettings,
    ) -> f64 {
        let taken = (target - here.slope(self.mode).0).abs();
        let largest = self.length() / settings.steps as f64;
        let step = match self.bracket.take() {
            Some(bracket) if way.is_new() => taken.max(REGAINED * bracket.stride),
            None if way.is_new() => taken,
            Some(bracket) if bracket.end.0 != target => {
                self.bracket = Some(bracket);
                bracket.next_step(next.slope(self.mode), next.potential(self.mode), trial)
            }
            // a short last step says nothing about the next one
            _ => (taken * trial.growth).max(self.step.min(taken)),
        };
        step.clamp(self.smallest(settings).min(largest), largest)
    }

    /// Keeps a state as the last one of the branch.
    fn arrive(&mut self, next: Figures, way: Way) {
        if way.is_new() {
            self.places.clear();
            self.at.clear();
        }
        if self.places.len() == PLACES - 1 {
            self.places.remove(0);
        }
        if self.at.len() == 2 {
            self.at.remove(0);
        }
        self.places.push(next);
        self.at.push(next);
    }

    /// Ends a leg to a pressure at given mean gaps where it has arrived, or goes on to the pressure itself.
    fn land(&mut self, next: Figures, settings: &PathSettings) {
        let Some((end, start)) = self.pressures else { return };
        let short = (end - next.pressure) * (end - start).signum();
        if short <= HARDLY * (end - start).abs() {
            self.end_leg();
        } else if !self.free && end > start && next.gap == self.span.1 {
            // pressed flat, the surfaces bear any pressure
            self.pressures = None;
            self.turn(Mode::Pressure, end, settings);
        }
    }
}
