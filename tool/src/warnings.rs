//! The warnings of a command: printed, reported, kept beside a table, or refused with `--strict`.

use std::path::{Path, PathBuf};
use std::{fs, io};

use asperity::{Error, Solution, Surface};
use asperity_scene::{Elastic, Told, warnings_of, warnings_of_input};
use clap::Args;

use crate::adhesion::Adhesion;
use crate::heights::Origin;
use crate::options::Scalar;
use crate::outcome::Outcome;
use crate::output::{OutputFile, check_free, with_suffix, write_text};
use crate::part::Part;
use crate::printing::complain;
use crate::units::Units;

/// Whether warnings are errors.
#[derive(Args, Clone, Copy)]
pub struct Strictness {
    /// Take warnings for errors: refuse input with a probable mistake in it, and write no solution with one
    #[arg(long, help_heading = "Output")]
    strict: bool,
}

/// The file with the warnings of a table, beside it, a line for each; there is none if nothing was said.
pub fn beside(table: &Path) -> PathBuf {
    with_suffix(table, ".warnings.txt")
}

/// Refuses a file in the place of the warnings of a new table, unless `force` replaces it.
pub fn check_beside(table: &Path, force: bool) -> Outcome<()> {
    check_free(&beside(table), force, "--out")
}

/// The warnings beside a table.
pub fn read_beside(table: &Path) -> Outcome<Vec<Told>> {
    let path = beside(table);
    match fs::read_to_string(&path) {
        Ok(text) => Ok(text.lines().filter_map(Told::parse).collect()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(Error::unreadable(&path, error).into()),
    }
}

/// Replaces the warnings beside a table.
pub fn write_beside(table: &Path, warnings: &[Told]) -> Outcome<()> {
    let path = beside(table);
    if warnings.is_empty() {
        return match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(Error::file(&path, format!("cannot be removed: {error}")).into())
            }
            _ => Ok(()),
        };
    }
    let lines: String = warnings.iter().map(Told::line).collect();
    let file = OutputFile::create(&path, true)?;
    file.write(|path| write_text(path, &lines))?;
    Ok(file.commit()?)
}

/// The warnings of a run so far, each of which is said once, when it is first found; the worst of each code is kept.
pub struct Warnings {
    strictness: Strictness,
    units: Units,
    /// The threshold of the scars that were removed from the heights
    scars_removed: Option<f64>,
    found: Vec<Told>,
    said: usize,
    /// Whether some have become worse since they were written
    worse: bool,
    /// The table that keeps them beside itself
    table: Option<PathBuf>,
}

impl Warnings {
    /// Looks at the heights and at the adhesion on them, before a solve.
    pub fn of_input<T: Scalar>(
        strictness: Strictness,
        (surface, origin): (&Surface, &Origin),
        adhesion: &Adhesion,
        elastic: &Elastic,
        units: &Units,
    ) -> Outcome<Self> {
        let (law, surface) = (adhesion.law::<T>(), (surface, origin.converted_from.as_deref()));
        let mut warnings = Self { scars_removed: origin.scars_removed, ..Self::empty(strictness, units) };
        warnings.add(warnings_of_input(surface, elastic, &*law, units))?;
        Ok(warnings)
    }

    /// No warnings, as of maps that no process has as a whole; with `--strict` an error.
    pub fn none(strictness: Strictness, units: &Units) -> Outcome<Self> {
        if strictness.strict {
            return Err(
                "--strict has no form for several processes and more than 4096 x 4096 nodes: leave it out".into()
            );
        }
        Ok(Self::empty(strictness, units))
    }

    fn empty(strictness: Strictness, units: &Units) -> Self {
        let (units, found) = (units.clone(), Vec::new());
        Self { strictness, units, scars_removed: None, found, said: 0, worse: false, table: None }
    }

    /// Looks at an answer, and prints its warnings; of many answers, the worst counts.
    pub fn look_at<T: Scalar>(&mut self, solution: &Solution<T>, part: &Part) -> Outcome<()> {
        let found = warnings_of(solution, part.wanted(), (&self.found, self.scars_removed))?;
        self.add(found.iter().map(|warning| self.units.told(warning)).collect())?;
        self.say()
    }

    /// Keeps the warnings beside a table from now on, after those of the rows that it has already.
    pub fn keep_beside(&mut self, table: &Path, has_rows: bool) -> Outcome<()> {
        self.say()?;
        self.keep(if has_rows { read_beside(table)? } else { Vec::new() });
        self.said = self.found.len();
        self.table = Some(table.to_owned());
        write_beside(table, &self.found)
    }

    /// Prints the warnings that were not printed before, and writes them beside the table that keeps them.
    pub fn say(&mut self) -> Outcome<()> {
        let new = &self.found[self.said..];
        new.iter().for_each(|warning| complain("warning", &warning.to_string()));
        match &self.table {
            Some(table) if !new.is_empty() || self.worse => write_beside(table, &self.found)?,
            _ => {}
        }
        (self.said, self.worse) = (self.found.len(), false);
        Ok(())
    }

    /// Keeps warnings of new codes, and worse ones of those that are known.
    fn keep(&mut self, new: Vec<Told>) {
        for told in new {
            match self.found.iter_mut().find(|known| known.code == told.code) {
                Some(known) => self.worse |= told.replace_if_worse(known),
                None => self.found.push(told),
            }
        }
    }

    /// Keeps new warnings, or with `--strict` returns them as an error.
    fn add(&mut self, new: Vec<Told>) -> Outcome<()> {
        // earlier rows of a table may have said the same without it
        if self.strictness.strict && !new.is_empty() {
            let all: Vec<_> = new.iter().map(Told::to_string).collect();
            return Err(all.join("; and ").into());
        }
        self.keep(new);
        Ok(())
    }

    /// All warnings so far.
    pub fn found(&self) -> &[Told] {
        &self.found
    }
}
