//! The progress bar of a solve, and how fast its error falls.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use asperity::{Grid, Iteration};
use indicatif::{ProgressBar, ProgressStyle};

/// The steps from the first error to the tolerance, on a logarithmic scale.
const STEPS: f64 = 1000.0;

/// The iterations from which the fall of the error is told, at most and at least.
const WINDOW: usize = 12;
const ENOUGH: usize = 4;

/// The progress of a solve, drawn on standard error if that is a terminal, and gone when dropped.
pub struct Progress {
    bar: ProgressBar,
    tolerance: f64,
    /// the tolerance of the present grid
    until: f64,
    nodes: f64,
    first_error: Option<f64>,
    fall: Fall,
    clock: Instant,
}

impl Progress {
    pub fn new(name: &str, tolerance: f64, nodes: usize, quiet: bool) -> Self {
        let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(STEPS as u64) };
        let template = "{prefix}{spinner} [{bar:20}] {wide_msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_prefix(if name.is_empty() { String::new() } else { format!("{name} ") });
        bar.set_message("preparing");
        // On large grids an iteration takes a while, and the time before the first one longer.
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self {
            bar,
            tolerance,
            until: tolerance,
            nodes: nodes as f64,
            first_error: None,
            fall: Fall::default(),
            clock: Instant::now(),
        }
    }

    /// Shows the state of a solve on nested grids, each to a tolerance of its own; the bar goes on from one grid to the
    /// next, as the error does.
    pub fn update_on(&mut self, grid: &Grid, state: &Iteration, tolerance: f64) {
        let nodes = grid.nodes() as f64;
        self.until = tolerance;
        if self.nodes != nodes {
            self.nodes = nodes;
            self.fall = Fall::default();
            let (nx, ny) = grid.shape();
            self.bar.set_prefix(format!("{nx} x {ny} "));
        }
        self.update(state);
    }

    pub fn update(&mut self, state: &Iteration) {
        if self.bar.is_hidden() {
            return;
        }
        // The paper's method knows its error only now and then.
        let error = state.relative_error.max(state.load_error);
        if error.is_finite() && error > 0.0 {
            let first = *self.first_error.get_or_insert(error.max(10.0 * self.tolerance));
            let way = (first / error).ln() / (first / self.tolerance).ln();
            self.bar.set_position(((STEPS * way.clamp(0.0, 1.0)) as u64).max(self.bar.position()));
            self.fall.add(state, error, self.clock.elapsed().as_secs_f64());
        }
        let error = if state.relative_error.is_finite() { format!("{:.1e}", state.relative_error) } else { "?".into() };
        let contact = 100.0 * state.contact_nodes as f64 / self.nodes;
        let fall = self.fall.told(self.until);
        self.bar.set_message(format!("{}: error {error}{fall}, contact {contact:.2} %", state.iteration));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The fall of the error over the last iterations of one minimisation.
#[derive(Default)]
struct Fall {
    /// the iteration, its error, and its time in seconds
    last: VecDeque<(usize, f64, f64)>,
    /// the minimisation: an error of another function says nothing of its own
    of: (usize, bool),
}

impl Fall {
    fn add(&mut self, state: &Iteration, error: f64, seconds: f64) {
        self.next((state.round, state.smoothed), state.iteration, error, seconds);
    }

    fn next(&mut self, of: (usize, bool), iteration: usize, error: f64, seconds: f64) {
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
    fn rate(&self, tolerance: f64) -> Option<(f64, f64)> {
        let (&(first, before, start), &(last, error, now)) = (self.last.front()?, self.last.back()?);
        let steps = last.checked_sub(first).filter(|&steps| steps >= ENOUGH)? as f64;
        let per_step = (before / error).ln() / steps;
        let left = (error / tolerance).ln().max(0.0) / per_step;
        (per_step > 0.0 && left.is_finite()).then(|| (per_step.exp(), left * (now - start) / steps))
    }

    /// The same in words.
    fn told(&self, tolerance: f64) -> String {
        let Some((factor, seconds)) = self.rate(tolerance) else { return String::new() };
        format!(", {factor:.2} times smaller in an iteration, {} left", time(seconds))
    }
}

/// A time that is left, in words.
fn time(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 10.0 => format!("{seconds:.1} s"),
        seconds if seconds < 120.0 => format!("{seconds:.0} s"),
        seconds if seconds < 7200.0 => format!("{:.0} min", seconds / 60.0),
        seconds => format!("{:.1} h", seconds / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_fall_tells_its_rate_and_the_time_that_is_left() {
        let mut fall = Fall::default();
        for k in 0..3 {
            fall.next((0, false), k, 0.5_f64.powi(k as i32), 0.1 * k as f64);
            assert_eq!(fall.rate(1e-3), None);
        }
        for k in 3..9 {
            fall.next((0, false), k, 0.5_f64.powi(k as i32), 0.1 * k as f64);
        }
        // from 2⁻⁸ to 2⁻¹⁰ in two iterations of 0.1 s
        let (factor, seconds) = fall.rate(0.5_f64.powi(10)).unwrap();
        assert!((factor - 2.0).abs() < 1e-12 && (seconds - 0.2).abs() < 1e-12);
        assert_eq!(fall.told(0.5_f64.powi(10)), ", 2.00 times smaller in an iteration, 0.2 s left");
        assert_eq!(fall.rate(0.1).unwrap().1, 0.0);
        // another law is another error, and one that grows tells nothing
        fall.next((1, false), 9, 1.0, 0.9);
        assert_eq!(fall.told(1e-3), "");
        (10..20).for_each(|k| fall.next((1, false), k, k as f64, 0.1 * k as f64));
        assert_eq!(fall.told(1e-3), "");
        assert_eq!([5.0, 60.0, 600.0, 9000.0].map(time), ["5.0 s", "60 s", "10 min", "2.5 h"]);
    }
}
