//! The parts of a minimisation: its sums, steps and progress.

use super::coarse::Coarse;
use super::passes::Tally;
use super::work::Work;

#[derive(Debug, Default)]
pub(super) struct Totals {
    pub(super) tally: Tally,
    /// Σ u·p, twice the elastic energy
    pub(super) work: Work,
    /// the mean of p, rounding only
    pub(super) drift: f64,
    /// the given mean pressure p̄, zero under gap control
    pub(super) given: f64,
    /// the load that has pulled the surfaces apart
    pub(super) detached: Option<f64>,
    pub(super) residual: Residual,
    /// the mean of r'·K r'; infinite as long as it is not known
    pub(super) certificate: f64,
    pub(super) preconditioned: Descent,
}

/// What the start of a solve knows of the solution, in ascending order.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub enum Nearness {
    #[default]
    Afar,
    /// the contacts of another load, with stiffness and places like the solution's
    Loaded,
    /// all but the edges of the contacts, where they move from load to load
    Ahead,
    /// all but the short waves at the edges of the contacts
    Near,
}

#[derive(Debug, Default)]
pub(super) struct Steps {
    /// the last step, if the next one may use it
    pub(super) momentum: Option<Made>,
    pub(super) step_length: f64,
    /// the contacts in the preconditioner
    pub(super) coarse: Option<Coarse>,
    pub(super) nearness: Nearness,
    /// Σ r'² of the step before, if the next one of Algorithm 3 may be conjugate to it
    pub(super) norm: Option<f64>,
    /// steps since the pressure was last computed from the gap
    pub(super) age: usize,
    /// the sum of ⟨c, c⟩/N over these steps, with c their change
    pub(super) updates: f64,
}

#[derive(Debug, Default)]
pub(super) struct Counters {
    pub(super) iterations: usize,
    pub(super) applications: usize,
    /// how often the function to be minimised has changed
    pub(super) rounds: usize,
    pub(super) progress: Progress,
    /// whether surfaces have touched where they did not attract each other
    pub(super) touches: bool,
}

/// The last step d = `factor`·c, with c the field of the change, and the sums for the next one to be conjugate to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Made {
    pub(super) factor: f64,
    /// ⟨d, y⟩, with y the change of the gradient r along the step d
    pub(super) curvature: f64,
    /// Σ r'·c, with the present residual
    pub(super) descent: f64,
    /// Σ r'·z', with z' the preconditioned residual of the previous state
    pub(super) overlap: f64,
    /// Σ c over the working set
    pub(super) sum: f64,
}

/// What comes next after a step, for the residual r' of the new state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Next {
    /// To compute it from gap and pressure.
    Compute,
    /// To subtract the level from the gradient in its field.
    Level,
    /// Nothing: the step has left it in its field.
    Go,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Residual {
    /// the mean of r over the working set under gap control, zero under pressure control: r' = r − level
    pub(super) level: f64,
    pub(super) working: f64,
    pub(super) complementarity: f64,
    /// Σ (r' − r'₀)², with r'₀ the previous content of the field, if r' was computed anew
    pub(super) difference: f64,
    /// whether contact nodes with a positive r' move down, as the surface yields
    pub(super) yields: bool,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Descent {
    pub(super) descent: f64,
    pub(super) sum: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    pub(super) best_error: f64,
    pub(super) lowest_energy: f64,
    pub(super) idle: usize,
    /// the least error of a pressure computed from its gap after its updates had met the goal
    pub(super) least_refuted: f64,
    /// how often such an error was no progress
    pub(super) refuted: usize,
    /// whether the pressure was computed anew at the floor of rounding
    pub(super) renewed: bool,
}

impl Default for Progress {
    fn default() -> Self {
        Self {
            best_error: f64::INFINITY,
            lowest_energy: f64::INFINITY,
            idle: 0,
            least_refuted: f64::INFINITY,
            refuted: 0,
            renewed: false,
        }
    }
}
