//! Events on a path of equilibria: jumps, limit points and bifurcations.

use std::fmt;

/// An event between two states on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// The state jumped to another branch.
    Jump(Jump),
    /// The branch became one of saddles, and was left along the unstable mode: where a symmetry breaks.
    Bifurcation {
        /// The eigenvalue of the mode on the branch that was left, negative for the first time.
        eigenvalue: f64,
        /// The jump from the last stable state to the new branch; its energy drop is zero where that bends off
        /// smoothly.
        jump: Jump,
    },
    /// The mean pressure is at an extremum: from the state before this one the path continues at given mean gaps.
    LimitPoint {
        /// The mean gap there.
        mean_gap: f64,
        /// The mean pressure there.
        mean_pressure: f64,
    },
}

/// A jump, between the states at the ends of the step in which it is located.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The mean gaps before and after.
    pub mean_gap: (f64, f64),
    /// The mean pressures before and after.
    pub mean_pressure: (f64, f64),
    /// The approaches before and after, with a free boundary.
    pub approach: Option<(f64, f64)>,
    /// The shares of nodes in contact before and after.
    pub contact_fraction: (f64, f64),
    /// Whether surfaces have touched at new places, by a law that attracts [next to contacts
    /// alone](crate::adhesion::Hints::touching).
    pub touches: bool,
    /// The energy that the jump dissipates, per area.
    pub energy_drop: f64,
}

impl Event {
    /// The jump of a jump or a bifurcation.
    pub fn jump(&self) -> Option<&Jump> {
        match self {
            Self::Jump(jump) | Self::Bifurcation { jump, .. } => Some(jump),
            Self::LimitPoint { .. } => None,
        }
    }

    /// The name that the tool uses: `"touch"` where surfaces stick that have touched at new places, `"jump-in"` where contact
    /// or adhesion grows otherwise, `"pull-off"` where the last contact is lost, `"jump-out"` where contact shrinks,
    /// `"bifurcation"` and `"limit-point"`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::LimitPoint { .. } => "limit-point",
            Self::Bifurcation { .. } => "bifurcation",
            Self::Jump(Jump { contact_fraction: (before, after), mean_pressure, touches, .. }) => {
                if after > before && *touches {
                    "touch"
                } else if after > before {
                    "jump-in"
                } else if after < before {
                    if *after == 0.0 { "pull-off" } else { "jump-out" }
                } else if mean_pressure.1 < mean_pressure.0 {
                    "jump-in"
                } else {
                    "jump-out"
                }
            }
        }
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
