//! `asperity run`: reads a scene file as what is given for a command. (`scene.rs` writes such files.)

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_maps::io::read_topography;
use asperity_scene::{AdhesionKeys, Entries, Keys, Kind, Outcome, chosen, keys};
use clap::{Arg, ArgMatches, value_parser};
use toml::Value;

use crate::command::{Call, Command, Place};
use crate::entries::{Reader, document, entries};
use crate::scene::SceneFile;
use crate::{named, part_of};
use crate::{parsed, study};

keys! {
    /// Do what a scene file says.
    ///
    /// A scene is a TOML file with the name of a command (solve, sweep, cycle, pull-off, interface, contact, leak, prepare,
    /// surface, stats or demo) and its options by their long names, without the hyphens in front. Numbers, words and lists
    /// are written in TOML; an option without a value is set to true. Options may be in sections with the names of the help
    /// of the command. File names are relative to the scene. Options after the name of the scene replace those in it. So do
    /// the side lengths of a file of heights that is given there.
    ///
    /// Every run writes a scene that repeats it: scene.toml in a folder of results, or FILE.scene.toml next to a file.
    ///
    /// # A scene
    ///     command = "solve"
    ///     out = "results"
    ///     [surface]
    ///     heights = "heights.npy"
    ///     [load]
    ///     mean-gap = 0.04
    ///
    /// # Examples
    ///   Leave a scene, repeat it, and do the same at another load:
    ///     asperity solve --heights heights.npy --mean-gap 0.04 --out results
    ///     asperity run results/scene.toml --out again
    ///     asperity run results/scene.toml --mean-gap 0.03 --out closer
    ///   Continue an interrupted sweep:
    ///     asperity sweep --heights heights.npy --mean-gaps 0.05:0.04:3 --out sweep.csv
    ///     asperity run sweep.csv.scene.toml
    Options {
        "" {
            /// Scene file
            scene: PathBuf = Kind::file().positional(&["SCENE"]).required(),
        }
    }
}

/// Refuses to run: a scene names another command.
pub fn run(_: &Call<'_>) -> Outcome<bool> {
    Err("a scene cannot run another one: name a command in it".into())
}

/// The parser of this command with the options of the command in the scene behind its name.
pub fn with_options(parser: clap::Command) -> clap::Command {
    let options = Arg::new("options").value_name("OPTION").help("Options of the command").num_args(..);
    parser.arg(options.value_parser(value_parser!(OsString)).trailing_var_arg(true).allow_hyphen_values(true))
}

/// The scene of a file, with the options behind its name; `tool` is the parser of both.
pub fn scene(tool: &clap::Command, command: &Command, matches: &ArgMatches) -> Outcome<SceneFile> {
    let Options { scene: path } = chosen(command.keys(), matches).keys();
    let refuse = |reason: String| Error::file(&path, reason);
    let mut table = document(&path)?;
    if let Some(section) = study::SECTIONS.iter().find(|section| table.contains_key(**section)) {
        let file = path.display();
        return Err(refuse(format!("has [{section}] like a study: solve it by 'asperity study {file}'")).into());
    }
    let known = || part_of(Place::Scene);
    let command = match table.remove("command") {
        Some(Value::String(name)) if known().contains(&name.as_str()) => named(&name)?,
        Some(other) => {
            return Err(refuse(format!("command is {other}: it must be one of {}", known().join(", "))).into());
        }
        None => return Err(refuse("does not say what to do: add command = \"solve\"".to_owned()).into()),
    };
    let mut entries = entries(table, command, &[]).map_err(refuse)?;
    let options = matches.get_many::<OsString>("options").into_iter().flatten().cloned();
    let words: Vec<_> = ["asperity", command.name].map(OsString::from).into_iter().chain(options).collect();
    let (_, matches) =
        parsed(&mut tool.clone().mut_subcommand(command.name, |parser| command.beside_scene(parser)), &words)?;
    let beside = chosen(command.keys(), &matches);
    let replaced = replaced(command, &beside);
    entries.retain(|(name, _)| !replaced.iter().any(|key| key.replace('_', "-") == *name));
    let reader = Reader { command, tool, folder: path.parent().unwrap_or(Path::new("")) };
    let given = reader.read(&entries).and_then(|given| reader.complete(&Entries::all([&beside, &given])));
    Ok(SceneFile { command: command.name, given: given.map_err(refuse)? })
}

/// The keys of a scene that others which are given beside it replace: the same ones, those of which one alone can be
/// given, without adhesion all of it, and the side lengths of a file of heights with other ones.
fn replaced(command: &Command, beside: &Entries) -> Vec<&'static str> {
    let mut replaced: Vec<_> =
        beside.entries().flat_map(|(key, _)| [Some(key.name), key.kind.replaces]).flatten().collect();
    let one_of = (command.one_of)();
    if one_of.iter().any(|key| beside.has(key)) {
        // what only one of them needs goes with it, as the position with the spring
        let goes = |need: &&'static str| one_of.contains(need) && !beside.has(need);
        replaced.extend(command.keys().filter(|key| key.kind.needs.iter().any(goes)).map(|key| key.name));
        replaced.extend(one_of);
    }
    if beside.word("law") == Some("none") {
        replaced.extend(AdhesionKeys::KEYS.iter().map(|key| key.name));
    }
    let heights = beside.files().heights;
    if beside.has("heights") && read_topography(heights).is_ok_and(|map| map.lengths.is_some()) {
        replaced.push("lengths");
    }
    replaced
}
