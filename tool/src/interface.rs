//! `asperity interface`: the law of an interface over the load, for codes of finite elements.

use std::fs;
use std::path::PathBuf;

use asperity::Error;
use asperity_scene::interface::Code;
use asperity_scene::output::{OutputFile, check_apart, check_free, write_text};
use asperity_scene::{Facts, Format, Kind, Outcome, Scalar, keys};
use serde_json::{Value, json};

use crate::command::Call;
use crate::printing::{complain, in_options};
use crate::table::{Fill, Table, TableOptions};

keys! {
    /// Tabulate the law of an interface over the load, for finite elements.
    ///
    /// Solves like asperity sweep, and writes a row for each load: the mean pressure, the mean gap, the closure, the
    /// contact area, and the contact stiffness with its relative error. The closure is the approach of the mean planes
    /// since the undeformed surfaces first touched, and the stiffness is the slope of the pressure over the closure.
    /// --resistivities, --conductivities and --leakage add conductance and transmissivity. --for adds files that a
    /// finite-element code reads: pressure over closure, and conductance and transmissivity over pressure, from zero
    /// pressure on. With adhesion the rows belong to one branch, and one of them needs a pressure of zero or less. Exits
    /// with 0 if all rows converged, 2 if not (then only the table is written), and 1 if the input is refused.
    ///
    /// # Examples
    ///   Pressure and thermal conductance of a joint of steel over the closure, for Abaqus and MOOSE:
    ///     asperity interface --heights heights.npy --lengths 20um --modulus 115GPa \
    ///       --mean-pressures 1MPa:1GPa:12:log --conductivities 15W/mK 15W/mK \
    ///       --for abaqus,moose --out joint.csv
    ///   A seal with a transmissivity that falls with the pressure, for COMSOL:
    ///     asperity interface --heights heights.npy --lengths 20um --modulus 10MPa \
    ///       --mean-pressures 10kPa:1MPa:12:log --leakage --for comsol --out seal.csv
    Options {
        "Output" {
            /// File for the table, .csv
            out: PathBuf = Kind::file().required(),
            /// Codes to write files for, next to the table and named after it: law.inp; law.pressure.txt and
            /// law.conductance.txt; law.pressure.csv and law.conductance.csv
            r#for: Vec<Code> = Kind::word(Code::words, &["CODE"]).commas(),
        }
    }
}

/// Runs the command; whether all rows converged.
pub fn run(call: &Call<'_>) -> Outcome<bool> {
    let options = &call.scene.keys::<Options>();
    let out = &options.out;
    let table = TableOptions { interface: true, ..TableOptions::new(call, out, Format::Csv, None)? };
    let problem = &table.problem;
    problem.case.check_elastic("the contact stiffness of an interface is known for elastic contact alone")?;
    if Format::from_path(out) != Some(Format::Csv) {
        return Err(Error::file(out, "does not end in .csv: rename it").into());
    }
    for (_, path) in options.files() {
        check_apart(&path, problem.files().chain([out.as_path()]))?;
        check_free(&path, table.force || out.exists(), "--out")?;
    }
    table.fill(options)
}

impl Options {
    /// The files that the codes may have, by their ends.
    fn files(&self) -> impl Iterator<Item = (&'static str, PathBuf)> {
        let endings = self.r#for.iter().flat_map(|code| code.endings());
        endings.map(|ending| (*ending, self.out.with_extension(&ending[1..])))
    }

    /// Removes the files for any code of a former table in the place of this one.
    fn clear(&self) -> Outcome<()> {
        for ending in Code::ALL.iter().flat_map(|code| code.endings()) {
            let path = self.out.with_extension(&ending[1..]);
            if path.is_file() && fs::read_to_string(&path).is_ok_and(|text| Code::wrote(&text)) {
                fs::remove_file(&path).map_err(|error| Error::file(&path, format!("cannot be removed: {error}")))?;
            }
        }
        Ok(())
    }

    /// Writes the files of all rows for the codes, and tells their names.
    fn write<T: Scalar>(&self, rows: &[Value], table: &Table<'_, T>) -> Outcome<Vec<String>> {
        let Facts { scene, units, .. } = table.rows.facts();
        let adhesive = scene.adhesion.adheres();
        let name = self.out.file_stem().unwrap_or_default().to_string_lossy();
        let mut written = Vec::new();
        for code in &self.r#for {
            for (ending, text) in in_options(code.files(rows, adhesive, &name, units))? {
                let path = self.out.with_extension(&ending[1..]);
                OutputFile::create(&path, true)?.complete(|path| write_text(path, &text))?;
                written.push(path.to_string_lossy().into_owned());
            }
        }
        Ok(written)
    }
}

impl Fill for Options {
    fn fill<T: Scalar>(&self, table: &mut Table<'_, T>) -> Outcome<bool> {
        let (rows, of_rows) = (table.rows.count(), table.rows.of_rows());
        // while the table changes, files of its former rows are wrong
        if table.options.force || rows > 0 && of_rows != Some(rows) {
            table.first(|| self.clear())?;
        }
        let rows = table.solve()?;
        let converged = table.converged("or --tolerance");
        if !converged && !self.r#for.is_empty() {
            complain("warning", "there are no files --for finite-element codes, since rows have not converged");
        }
        table.first(|| {
            let written = if converged { self.write(&rows, table)? } else { Vec::new() };
            if !written.is_empty() {
                table.options.printing.say(&format!("for finite elements: {}", written.join(", ")));
            }
            table.options.printing.report(|| table.report(json!({ "last": rows.last(), "files": written })));
            Ok(())
        })?;
        Ok(converged)
    }
}
