//! The command-line tool: `asperity demo` solves a built-in case, `asperity solve` one given by files, `asperity sweep`
//! many loads, `asperity cycle` a path with jumps, `asperity pull-off` the greatest tension, and `asperity study` every
//! combination of options; `asperity contact` tabulates the contact of a solve, `asperity leak` tells what leaks
//! through the gap of a solve, and `asperity interface` makes tables for finite elements. `asperity surface` makes
//! files of heights, `asperity prepare` makes them of measured maps, and `asperity stats` measures them. `asperity
//! laws` lists the adhesion laws, and `asperity selftest` compares solves with theory. `asperity run` does any of these
//! by a scene file, which every run leaves next to its results, and `asperity report` puts the results on a page for a
//! browser.

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
mod adhesion;
mod citation;
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
    allowed, csv, journal, list as loads, numbers, outcome, output, processes, quantity, synonyms, units, warnings,
};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use serde_json::Value;

use crate::hints::hinted;
use crate::options::ProblemOptions;
use crate::outcome::Outcome;
use crate::pictures::MapColours;
use crate::printing::{check_printed, complain, on_one_line, printed};
use crate::processes::{Processes, is_elsewhere};
use crate::scene::SceneFile;
use crate::session::Strictness;

/// Compute how rough surfaces touch and stick.
///
/// Finds the gap and the pressure between an elastic half-space and a rigid rough surface, with or without adhesion,
/// and says how accurate they are. The contact is normal and frictionless, in a periodic cell or with a free boundary.
/// The method is an FFT-based boundary element method.
#[derive(Parser)]
#[command(name = "asperity", version, after_help = EXAMPLES, max_term_width = 100)]
struct Tool {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  asperity demo
  asperity surface --size 512 --rms-slope 0.1 --out heights.npy
  asperity stats heights.npy
  asperity prepare measured.gsf --detrend plane --fill --mirror --out surface.npz
  asperity solve --heights heights.npy --mean-pressure 0.01 --out results
  asperity report results
  asperity run results/scene.toml --mean-pressure 0.02 --out more
  asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --out sweep.csv
  asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 \\
    --range 4e-3 --mean-gaps 0.05,0.02,0.05 --out cycle.csv --plot cycle.png
  asperity pull-off --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 4e-3
  asperity contact results --out contact
  asperity leak results
  asperity interface --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --for abaqus \\
    --out law.csv
  asperity study study.toml --jobs 4
  asperity laws
  asperity selftest
  asperity solve --help";

/// What a command may be part of.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// A run of several processes
    Processes,
    /// A scene
    Scene,
    /// A study, as its cases
    Study,
}

macro_rules! commands {
    ($($name:literal $variant:ident $module:ident: [$($place:ident),*],)+) => {
        #[derive(Subcommand)]
        enum Command {
            $(#[command(name = $name)] $variant(Box<$module::Options>),)+
        }

        impl Command {
            fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $name,)+
                }
            }

            fn run(&self, call: &Call<'_>) -> Outcome<bool> {
                match self {
                    $(Self::$variant(options) => $module::run(options, call),)+
                }
            }
        }

        /// The commands, with what they may be part of.
        const COMMANDS: &[(&str, &[Place])] = &[$(($name, &[$(Place::$place),*]),)+];
    };
}

// the name of each command, the module that has its options and runs it, and what it may be part of
commands! {
    "demo" Demo demo: [Scene],
    "solve" Solve solve: [Processes, Scene, Study],
    "sweep" Sweep sweep: [Processes, Scene, Study],
    "cycle" Cycle cycle: [Processes, Scene, Study],
    "pull-off" PullOff pull_off: [Scene, Study],
    "study" Study study: [],
    "run" Run run: [],
    "report" Report page: [],
    "prepare" Prepare prepare: [Scene],
    "surface" Surface surface: [Scene],
    "stats" Stats stats: [Scene],
    "leak" Leak leak: [Scene],
    "interface" Interface interface: [Processes, Scene],
    "contact" Contact contact: [Scene],
    "laws" Laws laws: [],
    "selftest" Selftest selftest: [],
    "completions" Completions completions: [],
}

/// The names of the commands that may be part of something.
fn commands(place: Place) -> Vec<&'static str> {
    COMMANDS.iter().filter(|(_, places)| places.contains(&place)).map(|(name, _)| *name).collect()
}

/// The call of a command: the scene that repeats it, and the processes that run it.
#[derive(Clone, Copy)]
struct Call<'a> {
    scene: &'a SceneFile,
    processes: &'a Processes,
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
            let mut tool = Tool::command();
            tool.build();
            run_on(&mut tool, &processes, arguments)
        }
        Err(error) => refused(&*error),
    }
}

fn run_on(tool: &mut clap::Command, processes: &Processes, arguments: impl IntoIterator<Item = OsString>) -> u8 {
    match parsed(tool, arguments) {
        Ok((Command::Run(options), _)) => match run::Arguments::read(tool, *options) {
            Ok(read) => match parsed(tool, read.arguments.clone()) {
                Ok((command, scene)) => execute(&command, &scene, processes),
                Err(error) => usage(&error, processes, |argument| read.blamed(argument)),
            },
            Err(error) => agreed(processes, Err(error)),
        },
        Ok((command, scene)) => execute(&command, &scene, processes),
        Err(error) => usage(&error, processes, |_| None),
    }
}

/// The command that the arguments name, and the scene that repeats it.
fn parsed<I>(tool: &mut clap::Command, arguments: I) -> Result<(Command, SceneFile), clap::Error>
where
    I: IntoIterator<Item: Into<OsString>>,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let matches = tool.try_get_matches_from_mut(&arguments).map_err(|error| hinted(tool, &arguments, error))?;
    let command = Tool::from_arg_matches(&matches)?.command;
    let chosen = matches.subcommand().and_then(|(name, matches)| Some((tool.find_subcommand(name)?, matches)));
    let scene = chosen.map_or_else(SceneFile::default, |(command, matches)| SceneFile::of(command, matches));
    match scene.check_units() {
        Ok(()) => Ok((command, scene)),
        Err(reason) => Err(tool.error(ErrorKind::ValueValidation, reason)),
    }
}

impl Command {
    /// The problem of a case of a study that is a run of this command, and whether its warnings are errors.
    fn problem(&self) -> Outcome<(ProblemOptions, Strictness)> {
        match self {
            Self::Solve(options) => Ok((options.problem()?, options.strictness)),
            Self::Sweep(options) => Ok((options.problem()?, options.manner.strictness)),
            Self::Cycle(options) => Ok((options.problem()?, options.manner.strictness)),
            Self::PullOff(options) => Ok((options.problem()?, options.strictness)),
            _ => Err("the command has no cases".into()),
        }
    }
}

fn execute(command: &Command, scene: &SceneFile, processes: &Processes) -> u8 {
    let shared = commands(Place::Processes);
    if !shared.contains(&command.name())
        && let Err(error) = processes.alone(&format!("every command but {}", shared.join(", ")))
    {
        return agreed(processes, Err(error));
    }
    agreed(processes, command.run(&Call { scene, processes }))
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
    let written = page::write(results, Some(out), force, &MapColours::default());
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

/// Prints help where it was asked for, and otherwise the mistake in the arguments on one line, after the name of the
/// file that has the argument (`blamed`).
fn usage(error: &clap::Error, processes: &Processes, blamed: impl Fn(&str) -> Option<String>) -> u8 {
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
            return REFUSED;
        }
        _ => {}
    }
    let argument = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(argument)) => argument.as_str(),
        _ => "",
    };
    complain("error", &format!("{}{}; see --help", blamed(argument).unwrap_or_default(), on_one_line(error)));
    REFUSED
}
