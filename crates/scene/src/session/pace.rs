//! The pace of a cycle: what it is likely to take, its states and events, and the time that is left.

use asperity::path::PathSettings;

use crate::session::fall::time;

/// The time of a state without adhesion, over an operator application; rough surfaces take from 40 to 120.
const STATE: f64 = 60.0;

/// The time of a leg with adhesion, over an operator application: the balance of energy chooses the states, not the
/// number of steps that is asked for. Legs on ten rough, smooth and measured surfaces take from 900 to 6200
/// applications; with each, the law, the search for jumps and the certificate take four times as long as the operator.
const LEG: f64 = 12_000.0;

/// The share of the way from which on the speed so far says something.
const ENOUGH: f64 = 0.05;

/// The pace of a cycle with a number of states that is not known before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// The number of legs, and the least number of steps in each.
    asked: (usize, usize),
    /// The seconds that all is likely to take, once the seconds of an operator application are known.
    expected: Option<f64>,
    /// The number of states.
    states: usize,
    /// The number of events: jumps, bifurcations and limit points.
    events: usize,
    /// The share of the way through all legs that is behind.
    share: f64,
    /// The states and the share before the first state of this run, and the seconds of the run.
    before: (usize, f64),
    seconds: f64,
}

impl Pace {
    /// The pace of a cycle of as many legs, from its beginning.
    pub fn new(legs: usize, settings: &PathSettings) -> Self {
        let asked = (legs, settings.steps.max(1));
        Self { asked, expected: None, states: 0, events: 0, share: 0.0, before: (0, 0.0), seconds: 0.0 }
    }

    /// The pace behind as many states with as many events.
    pub fn behind(self, states: usize, events: usize) -> Self {
        Self { states, events, before: (states, 0.0), ..self }
    }

    /// Takes the time of an operator application in seconds, from which the time of a cycle with or without adhesion
    /// follows.
    pub fn expect(&mut self, application: f64, adhesive: bool) {
        let applications = if adhesive { LEG * self.asked.0 as f64 } else { STATE * self.least() as f64 };
        self.expected = Some(application * applications);
    }

    /// The least number of states at the end: the start, and the steps of all legs.
    fn least(&self) -> usize {
        self.asked.0.saturating_mul(self.asked.1).saturating_add(1)
    }

    /// Begins the run at a share of the way.
    pub fn begin(&mut self, share: f64) {
        if self.states == self.before.0 {
            (self.share, self.before.1) = (share, share);
        }
    }

    /// Adds a state, which comes at a share of the way and took this time.
    pub fn add(&mut self, share: f64, event: bool, seconds: f64) {
        self.states += 1;
        self.events += usize::from(event);
        self.share = self.share.max(share);
        self.seconds += seconds;
    }

    /// The share of the way through all legs that is behind.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// The seconds that are left: at first by what all is likely to take, and the farther the way the more by the speed
    /// so far.
    pub fn seconds_left(&self) -> Option<f64> {
        let gone = self.share - self.before.1;
        let by_speed = (gone >= ENOUGH).then(|| self.seconds / gone);
        let all = match (self.expected, by_speed) {
            (Some(expected), Some(by_speed)) => (1.0 - self.share) * expected + self.share * by_speed,
            (expected, by_speed) => by_speed.or(expected)?,
        };
        Some((1.0 - self.share) * all)
    }

    /// The pace in words.
    pub fn describe(&self) -> String {
        let left = self.seconds_left().map_or(String::new(), |seconds| format!(", about {} left", time(seconds)));
        let way = format!("{:.0} % of the way", 100.0 * self.share);
        format!("{}, {}, {way}{left}", count(self.states, "state"), count(self.events, "event"))
    }

    /// What is asked for and what that is likely to take, before the first state of all.
    pub fn forecast(&self) -> Option<String> {
        let expected = self.expected.filter(|_| self.states == 0)?;
        let (legs, steps) = self.asked;
        let [least, legs, steps] =
            [(self.least(), "state"), (legs, "leg"), (steps, "step")].map(|(n, name)| count(n, name));
        Some(format!("{least} or more, {legs} of {steps}: about {}", time(expected)))
    }
}

/// A number of things, with an s at their name if they are several.
fn count(number: usize, name: &str) -> String {
    format!("{number} {name}{}", if number == 1 { "" } else { "s" })
}
