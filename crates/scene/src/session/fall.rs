//! The fall of the error of a solve, and the time that is left.

use std::collections::VecDeque;

use asperity::solver::Iteration;

/// The iterations from which the fall of the error is told, at most and at least.
const WINDOW: usize = 12;
const ENOUGH: usize = 4;

/// The fall of the error over the last iterations of one minimisation.
#[derive(Clone, Debug, Default)]
pub struct Fall {
    /// the iteration, its error, and its time in seconds
    last: VecDeque<(usize, f64, f64)>,
    /// the minimisation: an error of another function says nothing of its own
    of: (usize, bool),
}

impl Fall {
    /// Adds an iteration with its error, at a time in seconds.
    pub fn add(&mut self, state: &Iteration, error: f64, seconds: f64) {
        self.next((state.round, state.smoothed), state.iteration, error, seconds);
    }

    /// Adds an iteration of a minimisation.
    pub fn next(&mut self, of: (usize, bool), iteration: usize, error: f64, seconds: f64) {
        if self.of != of {
            *self = Self { of, ..Self::default() };
        }
        self.last.push_back((iteration, error, seconds));
        if self.last.len() > WINDOW {
            self.last.pop_front();
        }
    }

    /// The factor by which the error falls in an iteration, and the seconds until it is at the tolerance at that rate;
    /// nothing as long as it does not fall.
    pub fn rate(&self, tolerance: f64) -> Option<(f64, f64)> {
        let (&(first, before, start), &(last, error, now)) = (self.last.front()?, self.last.back()?);
        let steps = last.checked_sub(first).filter(|&steps| steps >= ENOUGH)? as f64;
        let per_step = (before / error).ln() / steps;
        let left = (error / tolerance).ln().max(0.0) / per_step;
        (per_step > 0.0 && left.is_finite()).then(|| (per_step.exp(), left * (now - start) / steps))
    }

    /// The same in words.
    pub fn describe(&self, tolerance: f64) -> String {
        let Some((factor, seconds)) = self.rate(tolerance) else { return String::new() };
        format!(", {factor:.2} times smaller in an iteration, {} left", time(seconds))
    }
}

/// A time that is left, in words.
pub fn time(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 10.0 => format!("{seconds:.1} s"),
        seconds if seconds < 120.0 => format!("{seconds:.0} s"),
        seconds if seconds < 7200.0 => format!("{:.0} min", seconds / 60.0),
        seconds => format!("{:.1} h", seconds / 3600.0),
    }
}
