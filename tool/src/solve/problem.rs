//! The problem of a solve, as its options pose it.

use asperity_scene::{After, Asked, Boundary, Branches};

use super::Options;
use crate::after;
use crate::outcome::Outcome;
use crate::printing::in_options;
use crate::processes::Processes;

impl Options {
    /// The solution that the options ask for, under a load where a reduced pressure of 1 is the `full` pressure.
    pub fn asked(&self, full: f64) -> Asked {
        let load = self.load.load();
        Asked {
            fraction: load.fraction(),
            nested: (self.nested || self.no_nested).then_some(self.nested),
            other_branch: self.solver.branch == Some(Branches::Both),
            stability: self.stability || self.leave,
            leave: self.leave,
            after: self.after(),
            goal: self.accuracy.goal(),
            ..Asked::under(load.control(full))
        }
    }

    /// The findings that are asked for after the solve.
    fn after(&self) -> After {
        let (stiffness, conductors) = (self.stiffness, self.conductors.conductors());
        After { stiffness, conductors, percolation: self.percolation, leakage: None }
    }

    /// Refuses what excludes each other.
    pub fn check_asked(&self, processes: &Processes) -> Outcome<()> {
        after::check(&self.after(), self.problem(), processes)?;
        let (adhesion, started) = (self.adhesion.described(), self.solver.initial_gap.is_some());
        in_options(self.asked(1.0).check(&adhesion, self.solver.method.method(), started))
    }

    /// Refuses what has no form for several processes.
    pub fn check_shared(&self, processes: &Processes) -> Outcome<()> {
        if self.fields.is_some() && self.surface.beyond.boundary == Boundary::Free {
            processes.alone("--fields displacement with a free boundary")?;
        }
        if self.accuracy.accuracy.is_some() { processes.alone("--accuracy") } else { Ok(()) }
    }
}
