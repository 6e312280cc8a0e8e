//! The problem of a solve, as its options pose it.

use asperity::Control;
use asperity_scene::{Asked, Branches, Inputs};

use super::Options;
use crate::part::Part;
use crate::report;
use crate::scene::Scene;
use crate::units::Units;

impl Options {
    /// The solution that the options ask for, under a load.
    pub fn asked(&self, control: Control) -> Asked {
        Asked {
            fraction: self.load.contact_fraction,
            nested: (self.nested || self.no_nested).then_some(self.nested),
            other_branch: self.solver.branch == Some(Branches::Both),
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
