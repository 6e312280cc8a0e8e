//! The progress bar of a solve, and how fast its error falls.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use asperity::Grid;
use asperity::solver::Iteration;
use asperity_scene::fall::Fall;
use asperity_scene::pace::Pace;
use asperity_scene::{PRESSURE, Units};
use indicatif::{ProgressBar, ProgressStyle};

use crate::printing::{Printing, complain};

/// The steps from the first error to the tolerance, on a logarithmic scale.
const STEPS: f64 = 1000.0;

/// The time from which a run is long.
const LONG: Duration = Duration::from_secs(5);

/// The time between lines in the place of a bar.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// The progress of a solve, drawn on standard error if that is a terminal, and gone when dropped; elsewhere a
/// line for each grid of a long run.
pub struct Progress {
    bar: ProgressBar,
    /// whether long runs tell their grids in lines, without a terminal
    in_lines: bool,
    tolerance: f64,
    /// the tolerance of the present grid
    until: f64,
    nodes: f64,
    first_error: Option<f64>,
    fall: Fall,
    clock: Instant,
    pace: Option<Pace>,
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
            in_lines: bar.is_hidden() && !quiet,
            bar,
            tolerance,
            until: tolerance,
            nodes: nodes as f64,
            first_error: None,
            fall: Fall::default(),
            clock: Instant::now(),
            pace: None,
        }
    }

    /// The progress of a cycle: its bar has the share of its way.
    pub fn follow(&mut self, pace: Option<Pace>) {
        if let Some(pace) = pace {
            self.bar.set_position((STEPS * pace.share()) as u64);
        }
        self.pace = pace;
    }

    /// Shows the state of a solve on nested grids, each to a tolerance of its own; the bar continues from one grid to
    /// the next, as the error does.
    fn update_on(&mut self, grid: &Grid, state: &Iteration, tolerance: f64) {
        let nodes = grid.nodes() as f64;
        self.until = tolerance;
        if self.nodes != nodes {
            self.nodes = nodes;
            self.fall = Fall::default();
            let (nx, ny) = grid.shape();
            if self.in_lines && self.clock.elapsed() > LONG {
                complain("note", &format!("on {nx} x {ny} nodes"));
            }
            self.bar.set_prefix(format!("{nx} x {ny} "));
        }
        self.update(state);
    }

    /// The listener to a solve on nested grids.
    pub fn on_grids(&mut self) -> impl FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> {
        |grid, state, tolerance| {
            self.update_on(grid, state, tolerance);
            ControlFlow::Continue(())
        }
    }

    /// The listener to the solves of a search for the pull-off, which is announced before the first: the bar has the
    /// grid, the solve and its mean pressure, and so have lines now and then where there is no bar.
    pub fn on_tensions<'a>(
        &'a mut self,
        announcement: &'a str,
        units: &'a Units,
        printing: Printing,
    ) -> impl FnMut(&Grid, &Iteration, f64) -> ControlFlow<()> {
        // these lines have the grids, too
        self.in_lines = false;
        let (mut solves, mut last, mut told) = (0, None, Instant::now());
        move |grid, state, tolerance| {
            self.update_on(grid, state, tolerance);
            if last.is_none() {
                printing.say(announcement);
            }
            if last != Some((grid.shape(), state.control)) {
                last = Some((grid.shape(), state.control));
                solves += 1;
                let ((nx, ny), pressure) = (grid.shape(), units.number(state.control.value(), PRESSURE));
                let name = format!("{nx} x {ny}, solve {solves} at {pressure} ");
                if self.bar.is_hidden() && told.elapsed() >= BETWEEN_LINES {
                    printing.say(name.trim_end());
                    told = Instant::now();
                }
                self.bar.set_prefix(name);
            }
            ControlFlow::Continue(())
        }
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
            if self.pace.is_none() {
                self.bar.set_position(((STEPS * way.clamp(0.0, 1.0)) as u64).max(self.bar.position()));
            }
            self.fall.add(state, error, self.clock.elapsed().as_secs_f64());
        }
        let error = if state.relative_error.is_finite() { format!("{:.1e}", state.relative_error) } else { "?".into() };
        let contact = 100.0 * state.contact_nodes as f64 / self.nodes;
        let (pace, fall) = match &self.pace {
            Some(pace) => (format!("{}; ", pace.describe()), String::new()),
            None => (String::new(), self.fall.describe(self.until)),
        };
        self.bar.set_message(format!("{pace}{}: error {error}{fall}, contact {contact:.2} %", state.iteration));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
