//! The warnings of a command: printed, reported, or refused with `--strict`.

use std::fmt;

use asperity::{Solution, Surface, Warning, WarningCode};
use clap::Args;
use serde_json::{Value, json};

use crate::adhesion::Adhesion;
use crate::boundary::Boundary;
use crate::options::{ProblemOptions, Scalar};
use crate::outcome::Outcome;
use crate::part::Part;
use crate::printing::complain;
use crate::quantity::{LENGTH, PRESSURE};
use crate::units::Units;

/// Whether warnings are errors.
#[derive(Args, Clone, Copy)]
pub struct Strictness {
    /// Take warnings for errors: refuse input with a probable mistake in it, and write no solution with one
    #[arg(long, help_heading = "Output")]
    strict: bool,
}

/// A warning in the units of a run.
pub struct Told {
    code: WarningCode,
    message: String,
}

impl Told {
    pub fn new(warning: &Warning, units: &Units) -> Self {
        let [length, pressure] = [LENGTH, PRESSURE].map(|dimension| move |value| units.number(value, dimension));
        Self { code: warning.code, message: warning.message_with(length, pressure) }
    }
}

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code, self.message)
    }
}

/// The warnings of a run so far, each of which is said once.
pub struct Warnings {
    strictness: Strictness,
    units: Units,
    found: Vec<Told>,
    said: usize,
}

impl Warnings {
    /// Looks at the heights and at the adhesion on them, before a solve.
    pub fn of_input<T: Scalar>(
        strictness: Strictness,
        surface: &Surface,
        adhesion: &Adhesion<'_>,
        options: ProblemOptions<'_>,
        units: &Units,
    ) -> Outcome<Self> {
        let law = adhesion.law::<T>()?;
        let mut warnings = Self { strictness, units: units.clone(), found: Vec::new(), said: 0 };
        let mut found = Warning::of_surface(surface);
        // where nothing repeats, nothing has to meet, and a body that ends may be flat
        let free = options.surface.beyond.boundary == Boundary::Free;
        found.retain(|warning| match warning.code {
            WarningCode::Tilt | WarningCode::OpenEdges => !free,
            WarningCode::Flat => !free && surface.absent().is_none(),
            _ => true,
        });
        found.extend(Warning::of_law(&law, surface, options.surface.modulus()));
        warnings.add(found)?;
        Ok(warnings)
    }

    /// No warnings: as another process looks, or, with `--strict` an error, none does.
    pub fn none(strictness: Strictness, units: &Units, elsewhere: bool) -> Outcome<Self> {
        if strictness.strict && !elsewhere {
            return Err(
                "--strict has no form for several processes and more than 4096 x 4096 nodes: leave it out".into()
            );
        }
        Ok(Self { strictness, units: units.clone(), found: Vec::new(), said: 0 })
    }

    /// Looks at an answer, and prints its warnings; of many answers, the first with a warning counts.
    pub fn look_at<T: Scalar>(&mut self, solution: &Solution<T>, modulus: f64, part: &Part) -> Outcome<()> {
        let mut found = Warning::of_solution(solution, modulus);
        found.extend(part.warning(solution)?);
        self.add(found)?;
        self.say();
        Ok(())
    }

    /// Prints the warnings that were not printed before.
    pub fn say(&mut self) {
        self.found.iter().skip(self.said).for_each(|warning| complain("warning", &warning.to_string()));
        self.said = self.found.len();
    }

    /// Keeps new warnings, or with `--strict` returns them as an error.
    fn add(&mut self, found: Vec<Warning>) -> Outcome<()> {
        let new = found.iter().filter(|new| self.found.iter().all(|known| known.code != new.code));
        let new: Vec<_> = new.map(|new| Told::new(new, &self.units)).collect();
        if self.strictness.strict && !new.is_empty() {
            let all: Vec<_> = new.iter().map(Told::to_string).collect();
            return Err(all.join("; and ").into());
        }
        self.found.extend(new);
        Ok(())
    }

    /// The warnings as a report lists them.
    pub fn report(&self) -> Value {
        report(&self.found)
    }
}

/// Warnings as a report lists them.
pub fn report(warnings: &[Told]) -> Value {
    warnings.iter().map(|warning| json!({ "code": warning.code.name(), "message": warning.message })).collect()
}
