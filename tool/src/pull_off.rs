//! `asperity pull-off`: the greatest tension under which the surfaces stay together.

use std::path::PathBuf;

use asperity::Status;
use asperity_maps::io::write_npy;
use asperity_scene::{Entries, Kind, Outcome, Posed, Precision, Processes, Scalar, Skin, Solved, gap_to_write, keys};
use serde_json::json;

use crate::command::Call;
use crate::options::ProblemOptions;
use crate::printing::{Printing, aligned, complain, in_options};
use crate::progress::Progress;
use crate::report;
use crate::results::{self, Results, write_report};
use crate::session::{Strictness, say_new};
use crate::solve::FIELDS;
use crate::summary::warn;

keys! {
    /// Find the pull-off, the greatest tension that surfaces bear.
    ///
    /// Numbers may have units, all of them or none, as for asperity solve. The surfaces were pressed flat before, or to the
    /// preload. Then the tension grows until they come apart, and the pull-off lies between a tension that they bear and
    /// one that they do not. Under a tension many contacts may break at once; asperity cycle draws the surfaces apart
    /// instead, and shows each break. Prints the pull-off as a pressure over the area of the map and as a force, and with
    /// --json also all keys of the last state that holds. Exits with 0 if the pull-off was found, 2 if not, and 1 if the
    /// input is refused.
    ///
    /// # Examples
    ///   The tension that takes a map of 1 by 1 off, of surfaces that were pressed flat:
    ///     asperity pull-off --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 4e-3
    ///   Of surfaces that were pressed to a mean pressure before:
    ///     asperity pull-off --heights heights.npy --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3 --preload 0.01
    ///   A tip on a free half-space:
    ///     asperity pull-off --heights tip.npy --boundary free --law exponential --work-of-adhesion 1e-4 \
    ///       --range 4e-3
    Options {
        "Output" {
            /// Folder for report.json, scene.toml, and the fields of the last state that holds: gap.npy, pressure.npy and
            /// contact_pressure.npy
            out: Option<PathBuf> = Kind::folder(),
            /// Replace results that are there
            force: bool = Kind::switch(),
        }
    }
}

/// The problem of what is given; refuses a surface that yields.
pub fn problem(given: &Entries) -> Outcome<ProblemOptions> {
    let problem = ProblemOptions::new(given)?;
    problem.case.check_table()?;
    problem.case.check_elastic(
        "a surface that yields bears another tension after each load of the search: follow it by asperity cycle",
    )?;
    Ok(problem)
}

/// Runs the command; whether the pull-off was found.
pub fn run(&Call { scene, processes }: &Call<'_>) -> Outcome<bool> {
    let problem = &problem(&scene.given)?;
    let Options { out, force } = scene.keys();
    let results = out.as_deref().map(|out| Results { out, scene, files: results::files(&FIELDS, &[]), force });
    results.iter().try_for_each(|results| results.check(problem.files()))?;
    let posed = problem.read(processes)?.posed;
    match problem.case.scene().precision {
        Precision::F32 => find::<f32>(problem, posed, results, processes),
        Precision::F64 => find::<f64>(problem, posed, results, processes),
    }
}

/// Finds the pull-off, and puts it into the folder of the results, if they are to be written.
fn find<T: Scalar>(
    problem: &ProblemOptions,
    posed: Posed,
    results: Option<Results<'_>>,
    processes: &Processes,
) -> Outcome<bool> {
    let given = problem.case.given();
    let (printing, nodes) = (given.keys::<Printing>(), posed.surface.grid().nodes());
    let session = given.keys::<Strictness>().session::<T>(posed, processes)?;
    let mut session = session.with_slopes();
    let start = problem.start(&mut session, processes)?;
    say_new(&mut session.facts.warnings);
    let (asked, goal) = (given.pull_off(), in_options(given.goal())?);
    let announcement = session.announce_pull_off(goal.is_some())?;
    let (units, tolerance) = (session.facts.units.clone(), session.tolerance(None)?);
    let mut progress = Progress::new("", tolerance, nodes, printing.without_bars());
    let found =
        session.pull_off(asked, goal, start.map(T::field), &mut progress.on_tensions(&announcement, &units, printing));
    drop(progress);
    let (mut solved, pulled_off) = found?;
    say_new(&mut solved.facts.warnings);
    solved.look()?;
    let Solved { found, account: last, facts } = solved;
    let mut outcome = json!(pulled_off);
    outcome[report::LAST] = json!(last);
    let report = report::report("pull-off", outcome, &facts.inputs);

    printing.say(&aligned(&pulled_off.rows(&last, &units)));
    if let Some(results) = results {
        let held = &*found.part()?;
        let fields = [&*gap_to_write(held), &held.pressure, &held.contact_pressure];
        results.write(results.folder()?, |folder| {
            write_report(folder, &report)?;
            FIELDS.into_iter().zip(fields).try_for_each(|(name, field)| write_npy(folder.path(name), field))
        })?;
        printing.say(&results.list());
    }
    printing.report(|| report);
    warn("", &last);
    if let Some(text) = pulled_off.shortfall(&last, Skin::Options) {
        complain("warning", &text);
    }
    Ok(pulled_off.reached && last.status == Status::Converged)
}
