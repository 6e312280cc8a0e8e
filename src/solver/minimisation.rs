//! What a minimisation aims at, and what it carries from one step to the next.

/// The goal of a minimisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal {
    /// The gap that the wall alone leaves, without adhesion: a start on the branch of loading.
    Wall,
    /// A start for the law itself, from the law with its jumps smoothed.
    Start,
    /// A state at a given mean gap that holds a tensile load: a start under that load.
    Hold,
    /// The solution, to the tolerance of the settings.
    Solution,
}

/// The last step d = `factor`·c, with c the field of the change, and the sums from which the next one is made
/// conjugate to it.
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

/// The content of the field `residual` after a step, before r' is computed in it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Left {
    /// Values without use, such as K⁻¹c.
    Nothing,
    /// The gradient r less the level of the state before.
    Gradient(Made),
    /// The residual r', under pressure control.
    Residual(Made),
    /// Values without use, beside a pressure that was computed anew after the step.
    Renewed(Made),
}

/// The residual r' of the present state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Residual {
    /// the mean of r over the working set under gap control, zero under pressure control: r' = r − level
    pub(super) level: f64,
    /// the number of nodes in the working set
    pub(super) working: f64,
    /// Σ|g r'|
    pub(super) orthogonality: f64,
    /// Σ (r' − r'₀)², with r'₀ the previous content of the field, if r' was computed from gap and pressure
    pub(super) difference: f64,
}

/// Sums of the preconditioned residual z.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Preconditioned {
    /// ⟨r', z⟩
    pub(super) descent: f64,
    /// Σ z
    pub(super) sum: f64,
}

/// The progress of a minimisation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    pub(super) best_error: f64,
    pub(super) lowest_energy: f64,
    /// iterations without progress
    pub(super) idle: usize,
    /// the least error that a pressure computed from its gap had, after its updates had met the goal
    pub(super) least_refuted: f64,
    /// how often such an error was no progress
    pub(super) refuted: usize,
    /// whether the pressure was computed anew at the floor of rounding
    pub(super) renewed: bool,
}

impl Progress {
    pub(super) const NONE: Self = Self {
        best_error: f64::INFINITY,
        lowest_energy: f64::INFINITY,
        idle: 0,
        least_refuted: f64::INFINITY,
        refuted: 0,
        renewed: false,
    };
}
