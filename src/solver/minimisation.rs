//! The parts of a minimisation: its steps, and the sums that they use.

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

/// A step d = scale·(g + c) − g to be taken by a length, and its sums.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) length: f64,
    pub(super) scale: f64,
    /// ⟨r', d⟩
    pub(super) slope: f64,
    /// Σ c²
    pub(super) square: f64,
    /// Σ d
    pub(super) change: f64,
    /// Σ d·p and ⟨d, K⁻¹d⟩
    pub(super) work: f64,
    pub(super) elastic: f64,
    pub(super) spring: f64,
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
pub(super) struct Preconditioned {
    pub(super) descent: f64,
    pub(super) sum: f64,
}
