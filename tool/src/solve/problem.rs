//! The problem of a solve, as its options pose it.

use asperity::Control;
use asperity_scene::{Asked, Branches, Inputs};

use super::Options;
use crate::options::Iteration;
use crate::outcome::Outcome;
use crate::part::Part;
use crate::report;
use crate::scene::Scene;
use crate::units::Units;

impl Options {
    /// Whether both branches of equilibria are asked for.
    fn wants_both(&self) -> bool {
        self.solver.branch == Some(Branches::Both)
    }

    /// Refuses both branches where there is nothing to be compared.
    pub fn check_branches(&self) -> Outcome<()> {
        let reason = match self {
            _ if !self.wants_both() => return Ok(()),
            _ if !self.adhesion.adheres() => "without adhesion there is but one equilibrium",
            _ if self.load.contact_fraction.is_some() => {
                "each branch has a load of its own for a contact fraction: give a load"
            }
            _ if self.accuracy.accuracy.is_some() => "each branch has an accuracy of its own: give one branch",
            _ if self.leave => "an equilibrium that is left leads off its branch: give one branch",
            _ if self.solver.method == Iteration::Rey2017 => "rey2017 has one start: take the default method",
            _ => return Ok(()),
        };
        Err(format!("--branch both: {reason}").into())
    }

    /// The solution that the options ask for, under a load.
    pub fn asked(&self, control: Control) -> Asked {
        Asked {
            fraction: self.load.contact_fraction,
            nested: (self.nested || self.no_nested).then_some(self.nested),
            other_branch: self.wants_both(),
            stability: self.stability || self.leave,
            leave: self.leave,
            stiffness: self.stiffness,
            goal: self.accuracy.goal(),
            ..Asked::under(control)
        }
    }

    /// The inputs of the report.
    pub fn inputs(&self, part: &Part, units: &Units, scene: &Scene) -> Inputs {
        report::inputs(self.problem(), part, units, scene)
    }
}
