//! The session of a command, and its warnings as it says them.

use std::io::{self, IsTerminal};

use asperity_scene::{Input, Session, Skin, Told};
use clap::Args;

use crate::options::{Problem, ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::printing::complain;
use crate::processes::Processes;
use crate::report;
use crate::scene::SceneFile;
use crate::warnings::Warnings;

/// The code of the warning that rows have not converged, which precedes its message.
pub const UNCONVERGED: &str = "unconverged";

/// Whether warnings are errors.
#[derive(Args, Clone, Copy, Default)]
pub struct Strictness {
    /// Treat warnings as errors: refuse input with a probable mistake, and write no solution with one
    #[arg(long, help_heading = "Output")]
    strict: bool,
}

/// Says the warnings that were not said before.
pub fn say_new(warnings: &mut Warnings) {
    say(warnings.tell());
}

/// Says warnings, and on a terminal where their codes are explained.
pub fn say(warnings: &[Told]) {
    warnings.iter().for_each(|told| complain("warning", &told.to_string()));
    let codes: Vec<_> = warnings.iter().map(|told| told.code.as_str()).collect();
    if !codes.is_empty() && io::stderr().is_terminal() {
        complain("note", &format!("docs/program/warnings.md explains {}", codes.join(", ")));
    }
}

/// The session of a problem, with what was read of its files.
pub fn session<T: Scalar>(
    problem: &ProblemOptions,
    given: Problem,
    scene: &SceneFile,
    strictness: Strictness,
    processes: &Processes,
) -> Outcome<Session<T>> {
    let Problem { surface, adhesion, origin, part, units, .. } = given;
    let input = Input {
        surface,
        formula: adhesion.formula,
        hardness: adhesion.hardness,
        original: part.wanted(),
        converted_from: origin.converted_from,
        scars_removed: origin.scars_removed,
        is_strict: strictness.strict,
        skin: Skin::Options,
    };
    let inputs = report::inputs(problem, &part, &units, scene);
    let mut session = Session::new(&problem.scene, input, inputs, units, processes)?;
    session.seed = origin.seed;
    Ok(session)
}
