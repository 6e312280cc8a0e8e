//! The session of a command, and its warnings as it says them.

use std::sync::Arc;

use asperity::Surface;
use asperity_scene::{Input, Session, Skin};
use clap::Args;

use crate::adhesion::Adhesion;
use crate::heights::Origin;
use crate::options::{ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::part::Part;
use crate::printing::complain;
use crate::processes::Processes;
use crate::report;
use crate::scene::SceneFile;
use crate::units::Units;
use crate::warnings::Warnings;

/// The code of the warning that rows have not converged; it stands before the message, as those of all warnings do.
pub const UNCONVERGED: &str = "unconverged";

/// Whether warnings are errors.
#[derive(Args, Clone, Copy, Default)]
pub struct Strictness {
    /// Take warnings for errors: refuse input with a probable mistake in it, and write no solution with one
    #[arg(long, help_heading = "Output")]
    strict: bool,
}

/// Says the warnings that were not said before.
pub fn say_new(warnings: &mut Warnings) {
    warnings.tell().iter().for_each(|told| complain("warning", &told.to_string()));
}

/// The session of a problem on a surface, with what was read of its files.
pub fn session<T: Scalar>(
    problem: &ProblemOptions,
    surface: Arc<Surface>,
    (adhesion, origin, part): (&Adhesion, &Origin, &Part),
    (units, scene): (&Units, &SceneFile),
    strictness: Strictness,
    processes: &Processes,
) -> Outcome<Session<T>> {
    let input = Input {
        surface,
        formula: adhesion.formula.clone(),
        hardness: adhesion.hardness.clone(),
        original: part.wanted(),
        converted_from: origin.converted_from.clone(),
        scars_removed: origin.scars_removed,
        is_strict: strictness.strict,
        skin: Skin::Options,
    };
    let (scene, inputs) = (&problem.scene, report::inputs(problem, part, units, scene));
    let mut session = Session::new(scene, input, inputs, units.clone(), processes)?;
    session.seed = origin.seed;
    Ok(session)
}
