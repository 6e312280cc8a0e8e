//! The refusals of a solve.

use asperity_scene::{Asked, Boundary, Load};

use super::Options;
use crate::options::ProblemOptions;
use crate::outcome::Outcome;
use crate::printing::in_options;
use crate::processes::Processes;

impl Options {
    /// Refuses what excludes each other, and what has no form for several processes.
    pub fn check_asked(&self, problem: &ProblemOptions, load: Load, processes: &Processes) -> Outcome<()> {
        let asked = in_options(problem.given.asked(load, 1.0))?;
        let (scene, started) = (&problem.scene, problem.files.initial_gap.is_some());
        if self.fields.is_some() && scene.elastic.boundary == Boundary::Free {
            processes.alone("--fields displacement with a free boundary")?;
        }
        if asked.goal.is_some() {
            processes.alone("--accuracy")?;
        }
        problem.check_after(&asked.after, processes)?;
        in_options(Asked::check(&asked, &scene.adhesion, scene.method, started))
    }
}
