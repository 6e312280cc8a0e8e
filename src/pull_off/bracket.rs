//! A bracket: the tensions that surfaces bear, and the least tension that they do not.

use crate::degrees::{HALF, HARDLY, PARTLY, TWICE};
use crate::solver::Report;

/// The share of a bracket below a tension that is tried without a peak: a state that holds costs less than surfaces that come
/// apart.
const BELOW: f64 = 0.35;

/// A tension that is borne, and how far the bodies are there: the mean gap, with a free boundary minus the approach.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub(super) distance: f64,
    pub(super) tension: f64,
}

impl Held {
    pub(super) fn of(report: &Report) -> Self {
        let free = !report.boundary.is_periodic();
        let distance = report.approach.filter(|_| free).map_or(report.mean_gap, |approach| -approach);
        Self { distance, tension: -report.mean_pressure }
    }
}

/// The tensions that are borne, in their order, and the least tension that is not.
#[derive(Debug, Default)]
pub(super) struct Bracket {
    pub(super) borne: Vec<Held>,
    pub(super) lost: Option<f64>,
    /// the tension that was borne before the loss
    from: f64,
    /// the tensions between which the pull-off is expected
    pub(super) expected: Option<[f64; 2]>,
}

impl Bracket {
    pub(super) fn new(expected: Option<[f64; 2]>) -> Self {
        Self { expected, ..Self::default() }
    }

    pub(super) fn bear(&mut self, place: Held) {
        self.lost = self.lost.filter(|&lost| lost > place.tension);
        self.borne.push(place);
    }

    pub(super) fn lose(&mut self, tension: f64) {
        (self.lost, self.from) = (Some(tension), self.greatest());
    }

    /// Takes the greatest tension as the one that is not borne.
    pub(super) fn give_back(&mut self) {
        if let Some(last) = self.borne.pop() {
            self.lose(last.tension);
        }
    }

    pub(super) fn greatest(&self) -> f64 {
        self.borne.last().map_or(0.0, |place| place.tension)
    }

    pub(super) fn is_narrow(&self, tolerance: f64) -> bool {
        self.lost.is_some_and(|lost| lost - self.from <= tolerance * lost)
    }

    /// The tension to try. A loss takes many times the iterations of a state that holds: a tension above the peak is tried
    /// only where its loss ends the search.
    pub(super) fn next(&self, first: f64, tolerance: f64) -> f64 {
        if let Some(tension) = self.next_as_expected() {
            return tension;
        }
        let low = self.greatest();
        // the farthest tension with a loss that ends the search
        let last = low / (1.0 - (1.0 - HARDLY) * tolerance);
        let near = peak(&self.borne).map(|peak| peak * (1.0 - 0.25 * tolerance));
        // as long as no tension is too large, each step is at most half as long again as the step before
        let Some(lost) = self.lost else {
            let before = self.borne.iter().rev().nth(1).map_or(0.0, |place| place.tension);
            let (step, least) = (low - before, low + (last - low) * TWICE.powi(self.raised_peaks(tolerance)));
            let farthest = (low + step + HALF * step).max(least);
            return if low > 0.0 { near.map_or(farthest, |near| near.max(least).min(farthest)) } else { first };
        };
        if lost <= last {
            // lost from farther off
            return lost;
        }
        let inside = PARTLY * (lost - low);
        match near.filter(|&near| near < lost) {
            Some(near) => near.clamp(low + inside, lost - inside).max(last),
            None if low > 0.0 && lost > 2.0 * low => (low * lost).sqrt(),
            None => (low + BELOW * (lost - low)).max(last),
        }
    }

    /// The tension to try while the pull-off is not enclosed: the ends of the expected tensions, then ever farther beyond.
    fn next_as_expected(&self) -> Option<f64> {
        let ([least, most], low) = (self.expected?, self.greatest());
        let beyond = match self.lost {
            None if low < least => least,
            None if low < most => most,
            None => 2.0 * low - least,
            Some(lost) => 2.0 * lost - most,
        };
        let is_beyond = self.lost.is_none_or(|lost| lost <= least);
        (is_beyond && beyond > low).then_some(beyond)
    }

    /// How many times, one after the other, the last places have raised the peak by more than the tolerance: a curve that
    /// bends otherwise than a parabola has its peak ever farther off.
    fn raised_peaks(&self, tolerance: f64) -> i32 {
        let is_raised = |&last: &usize| {
            let [before, then] = [last - 1, last].map(|last| peak(&self.borne[..=last]));
            before.zip(then).is_some_and(|(before, then)| then > before * (1.0 + tolerance))
        };
        (1..self.borne.len()).rev().take_while(is_raised).count() as i32
    }
}

/// The largest tension of the parabola over the distance through the last three places, if the bodies go apart from
/// place to place, and it has one.
fn peak(borne: &[Held]) -> Option<f64> {
    let [.., a, b, c] = borne[..] else { return None };
    if !(a.distance < b.distance && b.distance < c.distance) {
        return None;
    }
    let slope = |from: Held, to: Held| (to.tension - from.tension) / (to.distance - from.distance);
    let bend = (slope(b, c) - slope(a, b)) / (c.distance - a.distance);
    let there = slope(b, c) + bend * (c.distance - b.distance);
    Some(c.tension - there * there / (4.0 * bend)).filter(|peak| bend < 0.0 && peak.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_parabola_is_found_and_enclosed() {
        let curve = |x: f64| 3.0 - (x - 2.0).powi(2);
        let places = [0.3, 0.8, 1.1].map(|distance| Held { distance, tension: curve(distance) });
        let mut bracket = Bracket { borne: places.to_vec(), ..Bracket::default() };
        assert!((peak(&bracket.borne).unwrap() - 3.0).abs() < 1e-12);
        let mut tries = 0;
        while !bracket.is_narrow(0.02) {
            let tension = bracket.next(0.1, 0.02);
            match tension <= 3.0 {
                true => bracket.bear(Held { distance: 2.0 - (3.0 - tension).sqrt(), tension }),
                false => bracket.lose(tension),
            }
            tries += 1;
        }
        assert!(tries <= 4 && bracket.greatest() <= 3.0 && bracket.lost > Some(3.0), "{tries}: {bracket:?}");
    }

    #[test]
    fn a_curve_of_teeth_is_enclosed_by_halving() {
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.0 }], ..Bracket::default() };
        let mut tries = 0;
        while !bracket.is_narrow(1e-3) {
            let tension = bracket.next(1e-3, 1e-3);
            match tension <= 0.7 {
                true => bracket.bear(Held { distance: 1.0 + (f64::from(tries) * 0.7).fract(), tension }),
                false => bracket.lose(tension),
            }
            tries += 1;
        }
        assert!(tries < 40 && bracket.greatest() <= 0.7 && bracket.lost > Some(0.7), "{tries}: {bracket:?}");
    }

    #[test]
    fn a_curve_that_no_parabola_follows_is_enclosed() {
        let mut bracket = Bracket { borne: vec![Held { distance: 0.0, tension: 0.0 }], ..Bracket::default() };
        let mut tries = 0;
        while !bracket.is_narrow(0.02) {
            let tension = bracket.next(1e-4, 0.02);
            match tension <= 1.0 {
                true => bracket.bear(Held { distance: tension.powi(3), tension }),
                false => bracket.lose(tension),
            }
            tries += 1;
        }
        assert!(tries < 60 && bracket.lost > Some(1.0), "{tries}: {bracket:?}");
    }

    #[test]
    fn a_loss_by_a_long_step_is_tried_again_from_close_by() {
        let mut bracket = Bracket { borne: vec![Held { distance: 1.0, tension: 0.6 }], ..Bracket::default() };
        let (mut tries, mut early) = (0, 0);
        while !bracket.is_narrow(0.02) {
            let tension = bracket.next(0.6, 0.02);
            // a step longer than 0.2 jumps
            match tension <= 1.0 && tension <= bracket.greatest() + 0.2 {
                true => bracket.bear(Held { distance: tension, tension }),
                false => bracket.lose(tension),
            }
            early += usize::from(bracket.lost.is_some_and(|lost| lost <= 1.0));
            tries += 1;
        }
        assert!(
            early > 0 && tries < 40 && bracket.greatest() <= 1.0 && bracket.lost > Some(1.0),
            "{tries}: {bracket:?}"
        );
    }
}
