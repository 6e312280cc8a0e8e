//! `asperity run`: reads a scene file as the arguments of a command. (`scene.rs` writes such files.)

use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::io::read_topography;
use clap::{Arg, ArgAction, Args, Command};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

use crate::outcome::Outcome;
use crate::scene::{is_path, key, section};

/// Do what a scene file says.
///
/// A scene is a TOML file with the name of a command (solve, sweep, cycle, prepare, surface, stats or demo) and its
/// options by their long names, without the hyphens in front. Numbers, words and lists are written as TOML has them,
/// an option without a value is set by true. Options may stand in sections, named as in the help of the command. File
/// names are relative to the scene. Options after the name of the scene replace those in it, and the side lengths of a
/// file of heights after it those in the scene.
///
/// Every run leaves a scene that repeats it: scene.toml in a folder of results, FILE.scene.toml beside a file.
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
  Go on with a sweep that was interrupted:
    asperity sweep --heights heights.npy --mean-gaps 0.05:0.04:3 --out sweep.csv
    asperity run sweep.csv.scene.toml";

/// The commands that a scene may have.
const COMMANDS: [&str; 7] = ["solve", "sweep", "cycle", "prepare", "surface", "stats", "demo"];

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
    pub fn read(tool: &Command, options: Options) -> Outcome<Self> {
        let Options { scene: path, options: given } = options;
        let refuse = |reason: String| Error::file(&path, reason);
        let text = fs::read_to_string(&path).map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => refuse("does not exist: check the path".to_owned()),
            std::io::ErrorKind::IsADirectory => refuse("is a folder: name a scene file in it".to_owned()),
            std::io::ErrorKind::InvalidData => refuse("is no text: give a scene file, in TOML".to_owned()),
            _ => refuse(format!("cannot be read: {e}")),
        })?;
        let line = |start: usize| text.bytes().take(start).filter(|byte| *byte == b'\n').count() + 1;
        if let Some((key, span)) = DeTable::parse(&text).ok().and_then(|table| large_integer(table.get_ref())) {
            return Err(refuse(format!(
                "line {}: {key} is {}, beyond the integers of TOML, which end at {}: write it with a decimal point, or in \
                 quotation marks",
                line(span.start),
                text.get(span).unwrap_or_default(),
                i64::MAX
            ))
            .into());
        }
        let mut table: Table = text.parse().map_err(|e: toml::de::Error| {
            let line = line(e.span().map_or(0, |span| span.start));
            refuse(format!("line {line} is not TOML: {}", e.message().replace('\n', ", ")))
        })?;
        let name = match table.remove("command") {
            Some(Value::String(name)) if COMMANDS.contains(&name.as_str()) => name,
            Some(other) => {
                return Err(refuse(format!("command is {other}: it must be one of {}", COMMANDS.join(", "))).into());
            }
            None => return Err(refuse("does not say what to do: add command = \"solve\"".to_owned()).into()),
        };
        let command = tool.find_subcommand(&name).ok_or_else(|| refuse(format!("{name} is not built in")))?;
        let entries = entries(table, command).map_err(refuse)?;
        let mut replaced = replaced(command, &given);
        // those in the scene are of the file in the scene
        replaced.extend(brings_lengths(&given).then(|| "lengths".to_owned()));
        let mut arguments: Vec<OsString> = vec!["asperity".into(), name.into()];
        let folder = path.parent().unwrap_or(Path::new(""));
        for (name, value) in &entries {
            if !replaced.contains(name) {
                let option = command.get_arguments().find(|arg| key(arg).as_ref() == Some(name));
                arguments.extend(spelled(name, value, option, folder).map_err(refuse)?);
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

/// The key and the place of the first integer that does not fit into 64 bits.
fn large_integer(table: &DeTable<'_>) -> Option<(String, Range<usize>)> {
    fn within(value: &Spanned<DeValue<'_>>) -> Option<Range<usize>> {
        match value.get_ref() {
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).is_err().then(|| value.span())
            }
            DeValue::Array(values) => values.iter().find_map(within),
            _ => None,
        }
    }
    table.iter().find_map(|(key, value)| match value.get_ref() {
        DeValue::Table(table) => large_integer(table),
        _ => Some((key.get_ref().to_string(), within(value)?)),
    })
}

/// The options of a scene, those before the first section and those of all sections.
fn entries(table: Table, command: &Command) -> Result<Vec<(String, Value)>, String> {
    let mut sections: Vec<_> = command.get_arguments().map(section).collect();
    sections.retain(|section| !section.is_empty());
    sections.dedup();
    let mut entries: Vec<(String, Value)> = Vec::new();
    let mut add = |key: String, value: Value| {
        if entries.iter().any(|(other, _)| *other == key) {
            return Err(format!("{key} is there twice: remove one of them"));
        }
        entries.push((key, value));
        Ok(())
    };
    for (key, value) in table {
        match value {
            Value::Table(options) if sections.contains(&key) => {
                options.into_iter().try_for_each(|(key, value)| add(key, value))?;
            }
            Value::Table(_) => {
                let known: Vec<_> = sections.iter().map(|section| format!("[{section}]")).collect();
                let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
                return Err(format!("[{key}] is no section of {}, which has {known}", command.get_name()));
            }
            value => add(key, value)?,
        }
    }
    Ok(entries)
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

/// An option of a scene as words of a command line. Only options that cannot be typed at all are refused here; all
/// others are for the parser of the arguments to judge.
fn spelled(key: &str, value: &Value, option: Option<&Arg>, folder: &Path) -> Result<Vec<OsString>, String> {
    let name = format!("--{key}");
    let Some(option) = option else {
        let typed = key.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
        // not even known options that ask for help
        let unknown = typed && !["help", "version"].contains(&key);
        return if unknown { Ok(vec![name.into()]) } else { Err(format!("\"{key}\" is no option: remove it")) };
    };
    if matches!(option.get_action(), ArgAction::SetTrue) {
        return match value {
            Value::Boolean(true) => Ok(vec![name.into()]),
            Value::Boolean(false) => Ok(Vec::new()),
            other => Err(format!("{key} is {other}: it must be true or false")),
        };
    }
    let word = |value: &Value| match value {
        Value::String(word) if is_path(option) && !word.is_empty() => {
            Ok(folder.join(word).components().collect::<PathBuf>().into())
        }
        Value::String(word) => Ok(word.into()),
        Value::Integer(_) | Value::Float(_) if !is_path(option) => Ok(value.to_string().into()),
        other => Err(format!("{key} is {other}: it must be {}", wanted(option))),
    };
    let words = match value {
        Value::Array(values) => values.iter().map(word).collect::<Result<Vec<_>, _>>()?,
        value => vec![word(value)?],
    };
    if option.is_positional() {
        return Ok(words);
    }
    let most = option.get_num_args().map_or(1, |count| count.max_values());
    if most > 1 {
        if words.len() > most {
            return Err(format!("{key} has {} values: give {most} at most", words.len()));
        }
        return Ok(std::iter::once(name.into()).chain(words).collect());
    }
    let mut typed = OsString::from(name + "=");
    typed.push(words.join(&OsString::from(",")));
    Ok(vec![typed])
}

/// The kinds of values that an option takes, in words.
fn wanted(option: &Arg) -> &'static str {
    if is_path(option) { "a name in quotation marks" } else { "a number, a word in quotation marks, or a list of them" }
}
