//! The command-line tool: `asperity demo` solves a built-in case, `asperity solve` one given by files, `asperity sweep`
//! many loads, `asperity cycle` a path with jumps, `asperity pull-off` the greatest tension, and `asperity study` every
//! combination of options; `asperity contact` tabulates the contact of a solve, `asperity leak` tells what leaks
//! through the gap of a solve, and `asperity interface` makes tables for finite elements. `asperity surface` makes
//! files of heights, `asperity prepare` makes them of measured maps, and `asperity stats` measures them. `asperity
//! laws` lists the adhesion laws, and `asperity selftest` compares solves with theory. `asperity run` does any of these
//! by a scene file, which every run leaves next to its results, and `asperity report` puts the results on a page for a
//! browser. (`command.rs` has what a command is.)

// the report of a solve has more keys than serde_json's macro expands otherwise
#![recursion_limit = "256"]

// the commands
mod columns;
mod completions;
mod contact;
mod cycle;
mod demo;
mod interface;
mod laws;
mod leak;
mod page;
mod prepare;
mod pull_off;
mod run;
mod selftest;
mod solve;
mod stats;
mod study;
mod surface;
mod sweep;

// the parts that make commands
mod citation;
mod command;
mod entries;
mod heights;
mod hints;
mod interruption;
mod options;
mod pictures;
mod printing;
mod progress;
mod report;
mod results;
mod scene;
mod session;
mod solved;
mod summary;
mod table;
mod threads;

use std::error::Error;
use std::ffi::OsString;
use std::path::Path;

use asperity_scene::{
    AccuracyKeys, AdhesionKeys, ConductorKeys, CutOffKeys, CycleAccuracyKeys, FindingsKeys, FormKeys, FourierKeys,
    FractionsKeys, GridKeys, Keys, LeakKeys, LeakageKeys, LengthsKeys, Load, LoadKeys, LoadsKeys, NestedKeys,
    NewLengthsKeys, Outcome, PathKeys, PercolationKeys, Processes, PullOffKeys, RoughnessKeys, Skin, SolverKeys,
    StepKeys, StiffnessKeys, SurfaceKeys, UnitKeys, chosen, is_elsewhere, keys,
};
use clap::ArgMatches;
use clap::error::ErrorKind;
use serde_json::Value;

use crate::command::{Call, Command, Place, help};
use crate::hints::hinted;
use crate::options::ProblemOptions;
use crate::pictures::{FormatKeys, MapColours, PaperOptions, PlotKeys};
use crate::printing::{Printing, check_printed, complain, on_one_line, printed};
use crate::scene::SceneFile;
use crate::session::Strictness;
use crate::table::ForceKeys;

keys! {
    /// Compute how rough surfaces touch and stick.
    ///
    /// Finds the gap and the pressure between an elastic half-space and a rigid rough surface, with or without adhesion,
    /// and says how accurate they are. The contact is normal and frictionless, in a periodic cell or with a free boundary.
    /// The method is an FFT-based boundary element method.
    ///
    /// # Examples
    ///   asperity demo
    ///   asperity surface --size 512 --rms-slope 0.1 --out heights.npy
    ///   asperity stats heights.npy
    ///   asperity prepare measured.gsf --detrend plane --fill --mirror --out surface.npz
    ///   asperity solve --heights heights.npy --mean-pressure 0.01 --out results
    ///   asperity report results
    ///   asperity run results/scene.toml --mean-pressure 0.02 --out more
    ///   asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --out sweep.csv
    ///   asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \
    ///     --range 4e-3 --mean-gaps 0.05,0.02,0.05 --out cycle.csv --plot cycle.png
    ///   asperity pull-off --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 4e-3
    ///   asperity contact results --out contact
    ///   asperity leak results
    ///   asperity interface --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --for abaqus \
    ///     --out law.csv
    ///   asperity study study.toml --jobs 4
    ///   asperity laws
    ///   asperity selftest
    ///   asperity solve --help
    Tool {}
}

/// A table of commands: the module of each and its name, what it may be part of, the lists of its options in the order of
/// the help, and what else differs.
macro_rules! commands {
    ($($module:ident $name:literal [$($place:ident)*]: $($list:path),+ $(; $field:ident: $value:expr)*;;)+) => {
        /// The commands.
        static COMMANDS: &[Command] = &[$(Command {
            $($field: $value,)*
            ..Command {
                name: $name,
                help: <$module::Options as Keys>::ABOUT,
                lists: &[$(<$list as Keys>::KEYS),+],
                places: &[$(Place::$place),*],
                run: $module::run,
                problem: ProblemOptions::new,
                one_of: Vec::new,
                has_folder: false,
            }
        }),+];
    };
}

commands! {
    demo "demo" [Scene]: demo::Options, FormatKeys, PaperOptions, Printing;;
    solve "solve" [Processes Scene Study]: SurfaceKeys, LoadKeys, AdhesionKeys, SolverKeys, NestedKeys, AccuracyKeys,
        solve::Options, FindingsKeys, ConductorKeys, PercolationKeys, LeakageKeys, Strictness, Printing, FormatKeys,
        PaperOptions, MapColours, UnitKeys; one_of: || Load::one().collect(); has_folder: true;;
    sweep "sweep" [Processes Scene Study]: SurfaceKeys, LoadsKeys, FractionsKeys, AdhesionKeys, SolverKeys,
        sweep::Options, PlotKeys, PaperOptions, UnitKeys, StiffnessKeys, ConductorKeys, LeakageKeys, ForceKeys,
        Strictness, Printing; one_of: || Load::many().chain(FractionsKeys::KEYS.iter().map(|key| key.name)).collect();;
    cycle "cycle" [Processes Scene Study]: SurfaceKeys, LoadsKeys, PathKeys, AdhesionKeys, SolverKeys,
        CycleAccuracyKeys, cycle::Options, PaperOptions, UnitKeys, ForceKeys, Strictness, Printing;
        one_of: || Load::many().collect();;
    pull_off "pull-off" [Scene Study]: SurfaceKeys, PullOffKeys, AdhesionKeys, SolverKeys, UnitKeys,
        pull_off::Options, Strictness, Printing; problem: pull_off::problem;;
    study "study" []: study::Options, PlotKeys, PaperOptions, Printing;;
    run "run" []: run::Options;;
    page "report" []: page::Options, MapColours;;
    prepare "prepare" [Scene]: prepare::Options, NewLengthsKeys, StepKeys, CutOffKeys, Printing;;
    surface "surface" [Scene]: GridKeys, FormKeys, RoughnessKeys, FourierKeys, surface::Options, Printing;
        one_of: || vec!["size", "shape"];;
    stats "stats" [Scene]: LengthsKeys, stats::Options, Printing;;
    leak "leak" [Scene]: LengthsKeys, LeakKeys, leak::Options, FormatKeys, PaperOptions, Printing; has_folder: true;;
    interface "interface" [Processes Scene]: SurfaceKeys, LoadsKeys, AdhesionKeys, SolverKeys, interface::Options,
        ConductorKeys, LeakageKeys, UnitKeys, ForceKeys, Strictness, Printing; one_of: || Load::many().collect();;
    contact "contact" [Scene]: contact::Options, FormatKeys, PaperOptions, Printing; has_folder: true;;
    laws "laws" []: AdhesionKeys, laws::Options, PaperOptions, UnitKeys;;
    selftest "selftest" []: Printing;;
    completions "completions" []: completions::Options;;
}

/// The command of a name.
fn named(name: &str) -> Outcome<&'static Command> {
    Ok(COMMANDS.iter().find(|command| command.name == name).ok_or_else(|| format!("{name} is not built in"))?)
}

/// The names of the commands that may be part of something.
fn part_of(place: Place) -> Vec<&'static str> {
    COMMANDS.iter().filter(|command| command.places.contains(&place)).map(|command| command.name).collect()
}

/// The parser of the program.
fn parser() -> clap::Command {
    let parser = clap::Command::new("asperity").version(env!("CARGO_PKG_VERSION")).max_term_width(100);
    let parser = help(parser, Tool::ABOUT).subcommand_required(true).arg_required_else_help(true);
    let mut parser = parser.subcommands(COMMANDS.iter().map(Command::parser)).mut_subcommand("run", run::with_options);
    parser.build();
    parser
}

const CONVERGED: u8 = 0;
const REFUSED: u8 = 1;
const NOT_CONVERGED: u8 = 2;

/// Runs the program with the `arguments` of its process, its name first, and returns the exit code: 0 if all is well, 1
/// if something was refused, 2 if a solve did not converge.
///
/// A process runs it once, as its last work: an interruption ends the process, and threads are chosen for all of it.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    match Processes::start() {
        Ok(processes) => {
            if !processes.is_first() {
                printing::silence();
            }
            #[cfg(unix)]
            interruption::listen();
            match called(arguments.into_iter().collect()) {
                Ok(scene) => agreed(&processes, execute(&scene, &processes)),
                Err(error) => match error.downcast() {
                    Ok(mistake) => usage(&mistake, &processes),
                    Err(error) => agreed(&processes, Err(error)),
                },
            }
        }
        Err(error) => refused(&*error),
    }
}

/// The scene that the arguments of the program give.
fn called(arguments: Vec<OsString>) -> Outcome<SceneFile> {
    let tool = &mut parser();
    let (command, matches) = parsed(tool, &arguments)?;
    if command.name == "run" {
        return run::scene(tool, command, &matches);
    }
    let given = chosen(command.keys(), &matches).complete(command.keys());
    command.check(&given, tool.find_subcommand(command.name).unwrap_or(tool))?;
    let units = given.quantities().check(Skin::Options);
    units.map_err(|reason| tool.error(ErrorKind::ValueValidation, reason))?;
    Ok(SceneFile { command: command.name, given })
}

/// The command that arguments name, and what they give for its options.
fn parsed(tool: &mut clap::Command, arguments: &[OsString]) -> Outcome<(&'static Command, ArgMatches)> {
    let found = tool.try_get_matches_from_mut(arguments).map_err(|error| hinted(tool, arguments, error))?;
    let (name, matches) = found.subcommand().ok_or("there is no command")?;
    Ok((named(name)?, matches.clone()))
}

fn execute(scene: &SceneFile, processes: &Processes) -> Outcome<bool> {
    let command = named(scene.command)?;
    if !command.places.contains(&Place::Processes) {
        processes.alone(&format!("every command but {}", part_of(Place::Processes).join(", ")))?;
    }
    (command.run)(&Call { scene, processes })
}

/// The exit code of an outcome; one process tells of an error.
fn agreed(processes: &Processes, converged: Outcome<bool>) -> u8 {
    match processes.agree(converged.and_then(|converged| check_printed().map(|()| converged))) {
        Ok(true) => CONVERGED,
        Ok(false) => NOT_CONVERGED,
        Err(error) => refused(&*error),
    }
}

/// Puts the results of a run, the folder of a solve or a table, on a page in a file, as `asperity report` does.
///
/// # Errors
/// Errors of the command, in words.
pub fn page(results: &Path, out: &Path, force: bool) -> Result<(), String> {
    let written = page::write(results, Some(out), force, &MapColours::default(), false);
    written.map(|_| ()).map_err(|error| error.to_string())
}

/// The figures of the report of a solve by their names, as its page has them.
pub fn figures(report: &Value) -> Vec<(String, String)> {
    page::figures(report)
}

fn refused(error: &(dyn Error + 'static)) -> u8 {
    if !is_elsewhere(error) {
        complain("error", &error.to_string());
    }
    REFUSED
}

/// Prints help where it was asked for, and otherwise the mistake in the arguments on one line.
fn usage(error: &clap::Error, processes: &Processes) -> u8 {
    let help = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    if !processes.is_first() {
        return if help { CONVERGED } else { REFUSED };
    }
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            printed(error.print());
            return agreed(processes, Ok(true));
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = error.print();
        }
        _ => complain("error", &format!("{}; see --help", on_one_line(error))),
    }
    REFUSED
}
