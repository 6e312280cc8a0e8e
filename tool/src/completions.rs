//! `asperity completions`: scripts that complete commands in a shell.

use std::io::{self, Write};

use asperity_maps::{RowAlignment, Trend};
use clap::builder::PossibleValuesParser;
use clap::{Arg, Args, CommandFactory, ValueHint};
use clap_complete::{Shell, generate};

use crate::outcome::Outcome;
use crate::printing::printed;
use crate::scene::is_path;
use crate::{Call, Tool};

/// Print the completions of commands, options and their values for a shell.
///
/// Where they belong depends on the shell; most read them from a folder when they start.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// Shell
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mExamples:\u{1b}[0m
  For bash, zsh and fish:
    asperity completions bash > ~/.local/share/bash-completion/completions/asperity
    asperity completions zsh > ~/.zfunc/_asperity
    asperity completions fish > ~/.config/fish/completions/asperity.fish";

/// Runs the command; always successful if it ends.
pub fn run(options: &Options, _: &Call<'_>) -> Outcome<bool> {
    let mut script = Vec::new();
    let mut tool = Tool::command().mut_subcommands(|command| command.mut_args(with_values));
    generate(options.shell, &mut tool, "asperity", &mut script);
    printed(io::stdout().write_all(&script));
    Ok(true)
}

/// An option with its values, as far as the definitions do not have them: words next to numbers, folders, and no files
/// where a number is wanted.
fn with_values(option: Arg) -> Arg {
    let is_folder = option.get_value_names().is_some_and(|names| names == ["DIR"]);
    match option.get_long() {
        Some("align-rows") => option.value_parser(PossibleValuesParser::new(RowAlignment::NAMES)),
        Some("detrend") => option.value_parser(PossibleValuesParser::new(Trend::NAMES)),
        Some(_) if is_folder => option.value_hint(ValueHint::DirPath),
        Some(_) if option.get_action().takes_values() && !is_path(&option) => option.value_hint(ValueHint::Other),
        _ => option,
    }
}
