//! The pace of a cycle: what it is likely to take, its states and events, and the time that is left.

use asperity::path::PathSettings;

use crate::session::fall::time;

/// The time of a state without a jump, over that of an operator application. Rough surfaces and a sphere of 64² to 256²
/// nodes take from 40 to 120 for each state that is asked for, steps that are taken back and halved included.
const STATE: f64 = 60.0;

/// The further time of a jump for each halving of its step, over that of an operator application. The same surfaces
/// take from 400 to 1600: across a jump the start of a solve is far from the solution.
const HALVING: f64 = 800.0;

/// The share of the way from which on it tells the time that is left; before, the least number of states does.
const ENOUGH: f64 = 0.05;

/// The pace of a cycle, of which the number of states is not known before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// The number of legs, and the least number of steps in each.
    asked: (usize, usize),
    /// The halvings of a step that locate a jump.
    halvings: usize,
    /// The seconds of an operator application, once they are known.
    application: Option<f64>,
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
        let steps = settings.steps.max(1);
        let halvings = (steps as f64 * settings.smallest_step).recip().log2().ceil().max(1.0) as usize;
        let asked = (legs, steps);
        Self { asked, halvings, application: None, states: 0, events: 0, share: 0.0, before: (0, 0.0), seconds: 0.0 }
    }

    /// The pace behind as many states with as many events.
    pub fn behind(self, states: usize, events: usize) -> Self {
        Self { states, events, before: (states, 0.0), ..self }
    }

    /// Takes the time of an operator application in seconds, from which the time before the first state follows.
    pub fn expect(&mut self, application: f64) {
        self.application = Some(application);
    }

    /// The least number of states at the end: the start, and the steps of all legs.
    fn least(&self) -> usize {
        1 + self.asked.0 * self.asked.1
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

    /// The seconds that are left: before the first state of this run those that the least number of states is expected
    /// to take, then those of the same number at the speed so far, and after a twentieth of the way those of the rest.
    pub fn seconds_left(&self) -> Option<f64> {
        let (states, gone) = (self.states - self.before.0, self.share - self.before.1);
        let rest = self.least().saturating_sub(self.states).max(1) as f64;
        match states {
            0 => self.application.map(|application| STATE * application * rest),
            _ if gone < ENOUGH => Some(self.seconds / states as f64 * rest),
            _ => Some(self.seconds * (1.0 - self.share) / gone),
        }
    }

    /// The pace in words.
    pub fn told(&self) -> String {
        let left = self.seconds_left().map_or(String::new(), |seconds| format!(", about {} left", time(seconds)));
        let way = format!("{:.0} % of the way", 100.0 * self.share);
        format!("{}, {}, {way}{left}", count(self.states, "state"), count(self.events, "event"))
    }

    /// What is asked for and what that is likely to take, before the first state of all; with adhesion also what each
    /// jump adds.
    pub fn asked(&self, adhesive: bool) -> Option<String> {
        let application = self.application.filter(|_| self.states == 0)?;
        let ((legs, steps), least) = (self.asked, self.least());
        let mut text = format!(
            "{} or more, {} of {}: about {}",
            count(least, "state"),
            count(legs, "leg"),
            count(steps, "step"),
            time(STATE * application * least as f64)
        );
        if adhesive {
            let (few, many) = (self.halvings, 2 * self.halvings);
            let seconds = time(HALVING * application * self.halvings as f64);
            text += &format!("; each jump takes {few} to {many} more, and about {seconds}");
        }
        Some(text)
    }
}

/// A number of things, whose name has an s if they are several.
fn count(number: usize, name: &str) -> String {
    format!("{number} {name}{}", if number == 1 { "" } else { "s" })
}
