//! `asperity study`: one problem for every combination of some options, as one table.

mod case;
mod cases;
mod merge;
mod work;

use std::path::PathBuf;
use std::thread::available_parallelism;

use asperity_scene::output::check_free;
use asperity_scene::{Kind, Outcome, keys, warnings};
use serde_json::json;

pub use self::cases::SECTIONS;
use self::cases::Study;
use self::merge::merge;
use self::work::{folder, is_done, solve};
use crate::command::Call;
use crate::page;
use crate::parser;
use crate::pictures::PlotOptions;
use crate::printing::{Printing, complain, name};
use crate::report;

keys! {
    /// Solve every combination of surfaces, laws and other options, in one table.
    ///
    /// A study is a TOML file like the scene of a sweep, a cycle, a solve or a pull-off, with lists of values in a section
    /// [vary]: each combination of them is a case, and the last list changes fastest. Options that belong together are a
    /// list of tables. With a section [make], the surface of each case is made with these options of asperity surface,
    /// which may vary as well. Each row of the table begins with the number of the case and the values that vary. A sweep
    /// or a cycle gives all of its rows, a solve one row of a sweep, and a pull-off one row with the keys of its report.
    ///
    /// The rows of each case are kept in OUT.cases. The same command continues an interrupted study, and a study that has
    /// become larger solves only the new cases. Several machines that share the folder can solve slices of a study. The run
    /// that finds all cases done writes the table, with the same bytes whoever solved them. Exits with 0 if all rows
    /// converged or the slice is done, 2 if rows did not converge, and 1 if a case is refused.
    ///
    /// # A study
    ///     command = "sweep"
    ///     out = "study.csv"
    ///     [loads]
    ///     mean-pressures = "1e-3:1e-1:5:log"
    ///     [make]
    ///     size = 64
    ///     k-s = 16
    ///     rms-slope = 0.1
    ///     [vary]
    ///     hurst = [0.5, 0.8]
    ///     seed = "1:3:3"
    ///     [[vary.adhesion]]
    ///     law = "none"
    ///     [[vary.adhesion]]
    ///     law = "exponential"
    ///     work-of-adhesion = 1e-4
    ///     range = 1e-2
    ///
    /// # Examples
    ///   All cases on this machine, or a slice of them on each of sixteen, and then the table:
    ///     asperity study study.toml
    ///     asperity study study.toml --slice 3/16
    ///     asperity study study.toml
    Options {
        "" {
            /// Study file
            study: PathBuf = Kind::file().positional(&["STUDY"]).required(),
            /// Cases that are solved at the same time, each on its share of the cores [default: one per core]
            jobs: Option<usize> = Kind::threads(),
            /// Solve only a part of the cases: 3/16 is the third of sixteen
            slice: Option<String> = Kind::text(|text| part(text).map(|_| ()), &["K/N"]),
            /// Print the cases, and solve none
            list: bool = Kind::switch(),
        }
        "Output" {
            /// File for the table, .csv or .jsonl [default: the out of the study]
            out: Option<PathBuf> = Kind::file(),
            /// Replace a table that is not of this study
            force: bool = Kind::switch(),
        }
    }
}

/// A slice of a study, and how many there are, of such a text.
fn part(text: &str) -> Result<(usize, usize), String> {
    let slice = text.split_once('/').and_then(|(slice, of)| Some((slice.parse().ok()?, of.parse().ok()?)));
    let slice = slice.filter(|(slice, of)| (1..=*of).contains(slice));
    slice.ok_or_else(|| "it must be a part of a whole, such as 3/16, the first of them 1/16".to_owned())
}

/// Runs the command; whether all rows converged.
pub fn run(&Call { scene, processes }: &Call<'_>) -> Outcome<bool> {
    let Options { study: path, jobs, slice, list, out, force } = scene.keys();
    let (plot, printing) = (PlotOptions::new(scene), scene.keys::<Printing>());
    let tool = parser();
    let study = Study::read(&tool, &path, out.as_deref())?;
    let (cases, out) = (study.cases.len(), &study.out);
    if list {
        for (k, case) in study.cases.iter().enumerate() {
            let done = if is_done(&case.rows) { "done" } else { "to do" };
            printing.say(&format!("{}  {done}  {}", k + 1, study.describe(case)));
        }
    } else {
        let replaceable = folder(out).exists() || force;
        check_free(out, replaceable, "--out")?;
        warnings::check_beside(out, replaceable)?;
        plot.check(out, replaceable)?;
        let (slice, of) = slice.as_deref().map_or(Ok((1, 1)), part)?;
        let jobs = jobs.unwrap_or_else(|| available_parallelism().map_or(1, usize::from));
        solve(&tool, &study, (slice - 1..cases).step_by(of), jobs, printing, processes)?;
    }
    let done = study.cases.iter().filter(|case| is_done(&case.rows)).count();
    let (rows, unconverged) = if done == cases && !list { Some(merge(&study)?) } else { None }.unzip();
    if rows.is_some() {
        page::draw_loads(out, &plot)?;
    }
    let told = name(out);
    printing.say(&match rows {
        Some(rows) => format!("{rows} rows of {cases} cases in {told}"),
        None => format!("{done} of {cases} cases are done; the run that finds all of them done writes {told}"),
    });
    printing.report(|| {
        let outcome = json!({
            "study": path.to_string_lossy(),
            "slice": slice,
            "cases": cases,
            "done": done,
            "rows": rows,
            "unconverged": unconverged,
            "out": out.to_string_lossy(),
            "version": env!("CARGO_PKG_VERSION"),
        });
        report::report("study", outcome, &())
    });
    let failed = unconverged.filter(|count| *count > 0);
    if let Some(count) = failed {
        let out = out.display();
        complain("warning", &format!("{count} rows not converged, their status and errors are in {out}"));
    }
    Ok(failed.is_none())
}
