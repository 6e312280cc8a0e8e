use asperity::{Solution, Surface, Warning};
use clap::Args;
use serde_json::{Value, json};

use crate::Outcome;
use crate::options::{AdhesionOptions, SurfaceOptions};
use crate::printing::complain;
use crate::run::Scalar;

/// What becomes of warnings.
#[derive(Args, Clone, Copy)]
pub struct Strictness {
    /// Take for errors all warnings of input, or of an answer, that is probably a mistake: then it is not written
    #[arg(long, help_heading = "Output")]
    strict: bool,
}

/// The warnings of a run so far, each of which was said once.
pub struct Warnings {
    strictness: Strictness,
    said: Vec<Warning>,
}

impl Warnings {
    /// Looks at the heights and at the adhesion on them, before a solve.
    pub fn of_input<T: Scalar>(
        strictness: Strictness,
        surface: &Surface,
        options: &SurfaceOptions,
        adhesion: &AdhesionOptions,
    ) -> Outcome<Self> {
        let mut warnings = Self { strictness, said: Vec::new() };
        let law = adhesion.law::<T>()?;
        let found = Warning::of_surface(surface).into_iter().chain(Warning::of_law(&law, surface, options.modulus));
        warnings.say(found.collect())?;
        Ok(warnings)
    }

    /// Looks at an answer; of many, the first with a warning is told.
    pub fn look_at<T: Scalar>(&mut self, solution: &Solution<T>, modulus: f64) -> Outcome<()> {
        self.say(Warning::of_solution(solution, modulus))
    }

    /// Says on standard error what was not said before, or refuses to go on.
    fn say(&mut self, mut found: Vec<Warning>) -> Outcome<()> {
        found.retain(|new| self.said.iter().all(|said| said.code != new.code));
        if self.strictness.strict && !found.is_empty() {
            let all: Vec<_> = found.iter().map(Warning::to_string).collect();
            return Err(all.join("; and ").into());
        }
        found.iter().for_each(|warning| complain("warning", &warning.to_string()));
        self.said.append(&mut found);
        Ok(())
    }

    /// The warnings as a report has them.
    pub fn report(&self) -> Value {
        let all = self.said.iter();
        all.map(|warning| json!({ "code": warning.code.name(), "message": warning.message })).collect()
    }
}
