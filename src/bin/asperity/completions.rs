//! `asperity completions`: scripts that complete commands in a shell.

use std::io::{self, Write};

use clap::{Args, Command};
use clap_complete::{Shell, generate};

use crate::outcome::Outcome;
use crate::printing::printed;

/// Print the completions of commands and options for a shell.
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
pub fn run(options: &Options, mut tool: Command) -> Outcome<bool> {
    let mut script = Vec::new();
    generate(options.shell, &mut tool, "asperity", &mut script);
    printed(io::stdout().write_all(&script));
    Ok(true)
}
