//! `asperity completions`: scripts that complete commands in a shell.

use std::io::{self, Write};

use asperity_maps::{RowAlignment, Trend};
use asperity_scene::{Kind, Outcome, Word, keys};
use clap::Arg;
use clap::builder::PossibleValuesParser;
use clap_complete::{Shell, generate};

use crate::command::Call;
use crate::parser;
use crate::printing::printed;

keys! {
    /// Print the completions of commands, options and their values for a shell.
    ///
    /// Where they belong depends on the shell; most read them from a folder when they start.
    ///
    /// # Examples
    ///   For bash, zsh and fish:
    ///     asperity completions bash > ~/.local/share/bash-completion/completions/asperity
    ///     asperity completions zsh > ~/.zfunc/_asperity
    ///     asperity completions fish > ~/.config/fish/completions/asperity.fish
    Options {
        "" {
            /// Shell
            shell: Option<String> = Kind::word(|| Word::all(&["bash", "elvish", "fish", "powershell", "zsh"]), &[])
                .positional(&["SHELL"]).required(),
        }
    }
}

/// Runs the command; always successful if it ends.
pub fn run(&Call { scene, .. }: &Call<'_>) -> Outcome<bool> {
    let shell = scene.keys::<Options>().shell.unwrap_or_default().parse::<Shell>()?;
    let mut script = Vec::new();
    let mut tool = parser().mut_subcommands(|command| command.mut_args(with_words));
    generate(shell, &mut tool, "asperity", &mut script);
    printed(io::stdout().write_all(&script));
    Ok(true)
}

/// An option with its words, which its definition does not have where numbers stand next to them.
fn with_words(option: Arg) -> Arg {
    match option.get_long() {
        Some("align-rows") => option.value_parser(PossibleValuesParser::new(RowAlignment::NAMES)),
        Some("detrend") => option.value_parser(PossibleValuesParser::new(Trend::NAMES)),
        _ => option,
    }
}
