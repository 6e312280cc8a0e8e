//! The progress of a descent, and the end of its patience.

/// The share of the best error below which an error is progress.
const PROGRESS: f64 = 0.95;

/// Iterations without progress until the direction is dropped, and until the solve has stalled.
pub(super) const STALL: (usize, usize) = (10, 30);

/// The same numbers at the floor of rounding.
pub(super) const STALL_AT_FLOOR: (usize, usize) = (3, 6);

#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    best_error: f64,
    lowest_energy: f64,
    idle: usize,
    /// the least error of a pressure computed from its gap after its updates had met the goal
    least_refuted: f64,
    /// how often such an error was no progress
    refuted: usize,
    /// whether the pressure was computed anew at the floor of rounding
    renewed: bool,
}

impl Default for Progress {
    fn default() -> Self {
        let [best_error, lowest_energy, least_refuted] = [f64::INFINITY; 3];
        Self { best_error, lowest_energy, idle: 0, least_refuted, refuted: 0, renewed: false }
    }
}

impl Progress {
    /// Notes an error, and whether it or the energy is progress.
    pub(super) fn note(&mut self, error: f64, energy: f64, noise: f64) {
        let better = error < PROGRESS * self.best_error || energy < self.lowest_energy - noise;
        self.idle = if better { 0 } else { self.idle + 1 };
        self.best_error = self.best_error.min(error);
        self.lowest_energy = self.lowest_energy.min(energy);
    }

    /// Notes the error of a pressure computed anew that its updates had put below the goal.
    pub(super) fn refute(&mut self, error: f64) {
        self.best_error = self.best_error.max(error);
        if error < PROGRESS * self.least_refuted {
            (self.least_refuted, self.refuted) = (error, 0);
        } else {
            self.refuted += 1;
        }
    }

    pub(super) fn idle(&self) -> usize {
        self.idle
    }

    pub(super) fn lacks(&self, patience: usize) -> bool {
        self.idle.max(self.refuted) >= patience
    }

    pub(super) fn renewed(&self) -> bool {
        self.renewed
    }

    /// The progress after the pressure was computed anew at the floor of rounding.
    pub(super) fn renew(&mut self) {
        *self = Self { renewed: true, ..Self::default() };
    }
}
