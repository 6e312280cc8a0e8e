//! `asperity run`: reads a scene file as the arguments of a command. (`scene.rs` writes such files.)

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_maps::io::read_topography;
use clap::{Args, Command};
use toml::Value;

use crate::entries::{document, entries, spelled};
use crate::outcome::Outcome;
use crate::scene::{key, section};
use crate::{Call, Place, commands, study};

/// Do what a scene file says.
///
/// A scene is a TOML file with the name of a command (solve, sweep, cycle, pull-off, interface, contact, leak, prepare,
/// surface, stats or demo) and its options by their long names, without the hyphens in front. Numbers, words and lists
/// are written in TOML; an option without a value is set to true. Options may be in sections with the names of the help
/// of the command. File names are relative to the scene. Options after the name of the scene replace those in it. So do
/// the side lengths of a file of heights that is given there.
///
/// Every run writes a scene that repeats it: scene.toml in a folder of results, or FILE.scene.toml next to a file.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Options {
    /// Scene file
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Options of the command
    #[arg(value_name = "OPTION", trailing_var_arg = true, allow_hyphen_values = true)]
    options: Vec<OsString>,
}

const EXAMPLES: &str = "\
\u{1b}[1;4mA scene:\u{1b}[0m
    command = \"solve\"
    out = \"results\"
    [surface]
    heights = \"heights.npy\"
    [load]
    mean-gap = 0.04

\u{1b}[1;4mExamples:\u{1b}[0m
  Leave a scene, repeat it, and do the same at another load:
    asperity solve --heights heights.npy --mean-gap 0.04 --out results
    asperity run results/scene.toml --out again
    asperity run results/scene.toml --mean-gap 0.03 --out closer
  Continue an interrupted sweep:
    asperity sweep --heights heights.npy --mean-gaps 0.05:0.04:3 --out sweep.csv
    asperity run sweep.csv.scene.toml";

/// Refuses to run: a scene names another command.
pub fn run(_: &Options, _: &Call<'_>) -> Outcome<bool> {
    Err("a scene cannot run another one: name a command in it".into())
}

/// The arguments that a scene file stands for.
pub struct Arguments {
    path: PathBuf,
    /// The arguments after the name of the scene
    given: Vec<OsString>,
    /// All arguments, the name of the tool first
    pub arguments: Vec<OsString>,
}

impl Arguments {
    /// Reads the scene; `tool` defines the commands and options that it may have.
    pub fn read(tool: &Command, Options { scene: path, options: given }: Options) -> Outcome<Self> {
        let refuse = |reason: String| Error::file(&path, reason);
        let mut table = document(&path)?;
        if let Some(section) = study::SECTIONS.iter().find(|section| table.contains_key(**section)) {
            let file = path.display();
            return Err(refuse(format!("has [{section}] like a study: solve it by 'asperity study {file}'")).into());
        }
        let name = match table.remove("command") {
            Some(Value::String(name)) if commands(Place::Scene).contains(&name.as_str()) => name,
            Some(other) => {
                let known = commands(Place::Scene).join(", ");
                return Err(refuse(format!("command is {other}: it must be one of {known}")).into());
            }
            None => return Err(refuse("does not say what to do: add command = \"solve\"".to_owned()).into()),
        };
        let command = tool.find_subcommand(&name).ok_or_else(|| refuse(format!("{name} is not built in")))?;
        let entries = entries(table, command, &[]).map_err(refuse)?;
        let mut replaced = replaced(command, &given);
        // those in the scene are of the file in the scene
        replaced.extend(brings_lengths(&given).then(|| "lengths".to_owned()));
        let mut arguments: Vec<OsString> = vec!["asperity".into(), name.into()];
        let folder = path.parent().unwrap_or(Path::new(""));
        for (name, value) in &entries {
            if !replaced.contains(name) {
                arguments.extend(spelled(name, value, command, folder).map_err(refuse)?);
            }
        }
        arguments.extend(given.iter().cloned());
        Ok(Self { path, given, arguments })
    }

    /// The name of the scene, to be put before a complaint about one of its arguments; none for an argument that was
    /// given after the name of the scene.
    pub fn blamed(&self, argument: &str) -> Option<String> {
        let word = argument.split([' ', '=']).next().unwrap_or_default();
        let beside = self.given.iter().any(|given| given.to_string_lossy().split('=').next() == Some(word));
        (!beside).then(|| format!("{}: ", self.path.display()))
    }
}

/// The options of a scene that the options `given` after it replace: the same ones, those in the same exclusive group,
/// and with `--law none` all of the adhesion.
fn replaced(command: &Command, given: &[OsString]) -> Vec<String> {
    let mut replaced = Vec::new();
    let words: Vec<_> = given.iter().map(|word| word.to_string_lossy()).collect();
    if words.iter().any(|word| word == "--law=none") || words.windows(2).any(|pair| pair == ["--law", "none"]) {
        replaced.extend(command.get_arguments().filter(|arg| section(arg) == "adhesion").filter_map(key));
    }
    for word in words {
        let Some(name) = word.strip_prefix("--").and_then(|word| word.split('=').next()) else { continue };
        let Some(option) = command.get_arguments().find(|arg| arg.get_long() == Some(name)) else { continue };
        replaced.extend(key(option));
        for group in command.get_groups() {
            if group.get_args().any(|id| id == option.get_id()) && !group.clone().is_multiple() {
                let members = group.get_args().filter_map(|id| command.get_arguments().find(|arg| arg.get_id() == id));
                replaced.extend(members.filter_map(key));
            }
        }
    }
    // the position goes with the spring; one that was given comes after it
    if replaced.iter().any(|name| name == "spring-stiffness") {
        let positions = ["spring-position", "spring-positions"].map(str::to_owned);
        let stays = given.iter().any(|word| word.to_string_lossy().starts_with("--spring-stiffness"));
        replaced.extend(positions.into_iter().filter(|_| !stays));
    }
    replaced
}

/// Whether heights that are given after a scene come from a file with side lengths of its own.
fn brings_lengths(given: &[OsString]) -> bool {
    let after = given.iter().skip_while(|word| *word != "--heights").nth(1).map(Path::new);
    let joined = || given.iter().find_map(|word| word.to_str()?.strip_prefix("--heights=")).map(Path::new);
    let path = after.or_else(joined);
    path.is_some_and(|path| read_topography(path).is_ok_and(|map| map.lengths.is_some()))
}
