//! The pace of a cycle: its states and events, and the time that is left.

use crate::fall::time;

/// The share of the way from which on it tells the time that is left; before, the least number of states does.
const ENOUGH: f64 = 0.05;

/// The pace of a cycle, of which the number of states is not known before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// The number of states.
    states: usize,
    /// The number of events: jumps, bifurcations and limit points.
    events: usize,
    /// The share of the way through all legs that is behind.
    share: f64,
    /// The least number of states at the end.
    least: usize,
    /// The states and the share before the first state of this run, and the seconds of the run.
    before: (usize, f64),
    seconds: f64,
}

impl Pace {
    /// The pace of a cycle with a least number of states, behind those with as many events that it has already.
    pub fn new(least: usize, states: usize, events: usize) -> Self {
        Self { states, events, share: 0.0, least, before: (states, 0.0), seconds: 0.0 }
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

    /// The seconds that are left, once there is a state in this run: at first those of the least number of states, and
    /// after a twentieth of the way those of the rest at the speed so far.
    pub fn seconds_left(&self) -> Option<f64> {
        let (states, gone) = (self.states - self.before.0, self.share - self.before.1);
        match states {
            0 => None,
            _ if gone < ENOUGH => {
                let rest = (self.least.saturating_sub(self.states)).max(1);
                Some(self.seconds / states as f64 * rest as f64)
            }
            _ => Some(self.seconds * (1.0 - self.share) / gone),
        }
    }

    /// The pace in words.
    pub fn told(&self) -> String {
        let count = |number: usize, name: &str| format!("{number} {name}{}", if number == 1 { "" } else { "s" });
        let left = self.seconds_left().map_or(String::new(), |seconds| format!(", about {} left", time(seconds)));
        let way = format!("{:.0} % of the way", 100.0 * self.share);
        format!("{}, {}, {way}{left}", count(self.states, "state"), count(self.events, "event"))
    }

    /// What is to come, after the first state of all.
    pub fn expected(&self) -> Option<String> {
        let seconds = self.seconds_left().filter(|_| self.states == 1 && self.least > 1)?;
        Some(format!("{} states and {} at least; each jump takes further ones", self.least, time(seconds)))
    }
}
