//! The command-line tool: `asperity demo` shows what the library does, `asperity solve` does it on files,
//! `asperity sweep` under many loads and `asperity cycle` through jumps; `asperity surface` makes such files, `asperity prepare` makes them of
//! measured maps, and `asperity stats` measures them.

mod cycle;
mod demo;
mod input;
mod journal;
mod loads;
mod options;
mod output;
mod prepare;
mod progress;
mod report;
mod run;
mod solve;
mod stats;
mod surface;
mod sweep;

use std::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

/// Frictionless normal contact of rough surfaces, with adhesion.
///
/// Finds the gap and the pressure between an elastic half-space and a rigid rough surface, periodic, by an FFT-based
/// boundary element method, and says how accurate they are.
#[derive(Parser)]
#[command(version, after_help = EXAMPLES, max_term_width = 100)]
struct Tool {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  asperity demo
  asperity surface --size 512 --rms-slope 0.1 --out heights.npy
  asperity stats heights.npy
  asperity prepare measured.gsf --detrend plane --fill --mirror --out surface.npz
  asperity solve --heights heights.npy --mean-pressure 0.01 --out results
  asperity sweep --heights heights.npy --mean-pressures 1e-3:1e-1:20:log --out sweep.csv
  asperity cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 4e-3 \
    --mean-gaps 0.05,0.02,0.05 --out cycle.csv --plot cycle.png
  asperity solve --help";

#[derive(Subcommand)]
enum Command {
    Demo(demo::Options),
    Solve(Box<solve::Options>),
    Sweep(Box<sweep::Options>),
    Cycle(Box<cycle::Options>),
    Prepare(prepare::Options),
    Surface(surface::Options),
    Stats(stats::Options),
}

/// What a command may fail with: one line that names the value and the remedy.
type Outcome<T> = Result<T, Box<dyn Error>>;

const CONVERGED: ExitCode = ExitCode::SUCCESS;
const REFUSED: u8 = 1;
const NOT_CONVERGED: u8 = 2;

fn main() -> ExitCode {
    let tool = match Tool::try_parse() {
        Ok(tool) => tool,
        Err(error) => return usage(&error),
    };
    let converged = match tool.command {
        Command::Demo(options) => demo::run(&options),
        Command::Solve(options) => solve::run(&options),
        Command::Sweep(options) => sweep::run(&options),
        Command::Cycle(options) => cycle::run(&options),
        Command::Prepare(options) => prepare::run(&options),
        Command::Surface(options) => surface::run(&options),
        Command::Stats(options) => stats::run(&options),
    };
    match converged {
        Ok(true) => CONVERGED,
        Ok(false) => NOT_CONVERGED.into(),
        Err(error) => {
            complain("error", &error.to_string());
            REFUSED.into()
        }
    }
}

/// Prints help where it was asked for, and otherwise what is wrong with the arguments, on one line.
fn usage(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            let _ = error.print();
            CONVERGED
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = error.print();
            REFUSED.into()
        }
        _ => {
            let text = error.to_string();
            let text = text.split("\nUsage:").next().unwrap_or_default();
            let text = text.split("\nFor more information").next().unwrap_or_default();
            let lines: Vec<_> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
            complain("error", &format!("{}; see --help", lines.join(" ").trim_start_matches("error: ")));
            REFUSED.into()
        }
    }
}

/// Prints to standard output. Nobody may be listening any more, as behind `| head`: the files are written all the same.
fn say(text: &str) {
    let _ = writeln!(io::stdout(), "{text}");
}

/// Prints one line to standard error, whatever names with line breaks it quotes.
fn complain(kind: &str, text: &str) {
    let line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let _ = writeln!(io::stderr(), "{kind}: {line}");
}
