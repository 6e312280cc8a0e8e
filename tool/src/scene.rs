//! The scene of a run: its options, its quantities, and the file that repeats it. (`run.rs` reads such files.)

use std::any::TypeId;
use std::collections::HashSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use asperity::Error;
use asperity_scene::{Measured, Quantities, Skin};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use toml::Value;

use crate::loads::Loads;
use crate::outcome::Outcome;
use crate::output::{OutputFile, absolute, check_free, resolved, with_suffix, write_text};
use crate::quantity::Quantity;

/// A run as a scene file that repeats it: every option that was given or has a default.
#[derive(Default)]
pub struct SceneFile {
    command: String,
    entries: Vec<Entry>,
    quantities: Quantities,
}

struct Entry {
    /// The heading of the option in the help
    section: String,
    key: String,
    values: Vec<Literal>,
}

enum Literal {
    /// Written as it is
    Plain(String),
    /// Relative to the folder in which it was given
    Path(PathBuf),
}

/// The beginning of the file. A file with another beginning is not replaced.
const FIRST: &str = "# Written by asperity ";

/// Options without influence on the results.
const LEFT_OUT: [&str; 3] = ["force", "quiet", "json"];

/// The name of the scene in a folder of results.
pub const NAME: &str = "scene.toml";

impl SceneFile {
    /// The scene of a command with the options in `matches`.
    pub fn of(command: &Command, matches: &ArgMatches) -> Self {
        let entries = command.get_arguments().filter_map(|arg| entry(arg, matches)).collect();
        let quantities = command.get_arguments().filter_map(|arg| measured(arg, matches)).collect();
        Self { command: command.get_name().to_owned(), entries, quantities }
    }

    /// Whether quantities have units; then all numbers are in SI units.
    pub fn is_si(&self) -> bool {
        self.quantities.is_si()
    }

    /// Refuses numbers without units next to quantities with units.
    pub fn check_units(&self) -> Result<(), String> {
        self.quantities.check(Skin::Options)
    }

    /// The quantities of the command.
    pub fn quantities(&self) -> Quantities {
        self.quantities.clone()
    }

    /// The quantities as they were typed, by the names of reports; nothing if none has a unit.
    pub fn given(&self) -> Option<serde_json::Value> {
        self.quantities.given()
    }

    /// The scene file, to be put into `folder`.
    pub fn text(&self, folder: &Path) -> String {
        let mut text = format!(
            "{FIRST}{}; `asperity run FILE` repeats the run\ncommand = \"{}\"\n",
            env!("CARGO_PKG_VERSION"),
            self.command
        );
        let mut known = HashSet::new();
        let sections = self.entries.iter().map(|entry| &entry.section).filter(|section| known.insert(*section));
        for section in sections {
            text.push_str(&if section.is_empty() { String::new() } else { format!("\n[{section}]\n") });
            for entry in self.entries.iter().filter(|entry| entry.section == *section) {
                let values: Vec<_> = entry.values.iter().map(|value| value.text(folder)).collect();
                let value = if values.len() == 1 { values.concat() } else { format!("[{}]", values.join(", ")) };
                text.push_str(&format!("{} = {value}\n", entry.key));
            }
        }
        text
    }

    /// Refuses to replace a file at `path` that was not written as a scene, and names of files that a scene there
    /// cannot have.
    pub fn check(&self, path: &Path) -> Outcome<()> {
        for value in self.entries.iter().flat_map(|entry| &entry.values) {
            if let Literal::Path(name) = value
                && seen_from(name, folder_of(path)).to_str().is_none()
            {
                let reason = "is no name in UTF-8, which the scene of this run could not have: rename it";
                return Err(Error::file(name, reason).into());
            }
        }
        match fs::read_to_string(path) {
            Ok(text) if !text.starts_with(FIRST) => {
                let reason = "was not written by asperity, and would be replaced by the scene of this run: rename it, or choose another --out";
                Err(Error::file(path, reason).into())
            }
            _ => Ok(()),
        }
    }

    /// Refuses a `file` next to which there is the scene of another run, unless `force` replaces it, or a file that was
    /// not written as a scene.
    pub fn check_beside(&self, file: &Path, force: bool) -> Outcome<()> {
        let path = beside(file);
        self.check(&path)?;
        // whatever version has written it
        let rest = |text: &str| text.split_once('\n').map(|(_, rest)| rest.to_owned());
        let same = fs::read_to_string(&path).is_ok_and(|text| rest(&text) == rest(&self.text(folder_of(file))));
        check_free(&path, force || same, "--out")
    }

    /// The file FILE.scene.toml next to `file`, written but for its name.
    pub fn written_beside(&self, file: &Path) -> Outcome<OutputFile> {
        let scene = OutputFile::create(&beside(file), true)?;
        scene.write(|path| write_text(path, &self.text(folder_of(file))))?;
        Ok(scene)
    }
}

/// The path of the scene next to a file.
pub fn beside(file: &Path) -> PathBuf {
    with_suffix(file, &format!(".{NAME}"))
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The name of an argument in a scene; none for those that ask for help.
pub fn key(arg: &Arg) -> Option<String> {
    let asks_for_help = matches!(arg.get_action(), ArgAction::Help | ArgAction::HelpShort | ArgAction::HelpLong);
    let key = || arg.get_long().map_or_else(|| arg.get_id().as_str().replace('_', "-"), str::to_owned);
    (!asks_for_help).then(key)
}

/// Whether an argument is the name of a file or a folder.
pub fn is_path(arg: &Arg) -> bool {
    arg.get_value_parser().type_id() == TypeId::of::<PathBuf>()
}

/// The section in which an option stands.
pub fn section(arg: &Arg) -> String {
    arg.get_help_heading().unwrap_or_default().to_lowercase()
}

/// The quantities of an argument, if it has some.
fn measured(arg: &Arg, matches: &ArgMatches) -> Option<Measured> {
    let id = arg.get_id().as_str();
    let quantities: Vec<Quantity> = match arg.get_value_parser().type_id() {
        parser if parser == TypeId::of::<Quantity>() => matches.get_many(id)?.copied().collect(),
        parser if parser == TypeId::of::<Loads>() => matches.get_one::<Loads>(id)?.given.clone(),
        _ => return None,
    };
    let texts = matches.get_raw(id)?.map(|raw| raw.to_string_lossy().trim().to_owned()).collect();
    let is_default = matches.value_source(id) == Some(ValueSource::DefaultValue);
    Some(Measured::of(&key(arg)?.replace('-', "_"), texts, &quantities, is_default))
}

fn entry(arg: &Arg, matches: &ArgMatches) -> Option<Entry> {
    let (id, key) = (arg.get_id().as_str(), key(arg)?);
    if LEFT_OUT.contains(&key.as_str()) || matches.value_source(id).is_none() {
        return None;
    }
    let values = if matches!(arg.get_action(), ArgAction::SetTrue) {
        if matches.value_source(id) == Some(ValueSource::DefaultValue) {
            return None;
        }
        vec![Literal::Plain("true".to_owned())]
    } else {
        let raw = matches.get_raw(id)?;
        raw.map(|raw| if is_path(arg) { Literal::Path(raw.into()) } else { literal(arg, &raw.to_string_lossy()) })
            .collect()
    };
    Some(Entry { section: section(arg), key, values })
}

/// A number in the digits of Rust, and everything else in quotation marks.
fn literal(arg: &Arg, raw: &str) -> Literal {
    let (parser, trimmed) = (arg.get_value_parser().type_id(), raw.trim());
    let number = if [TypeId::of::<f64>(), TypeId::of::<Quantity>()].into_iter().any(|number| parser == number) {
        trimmed.parse::<f64>().ok().map(|number| format!("{number:?}"))
    } else if parser == TypeId::of::<usize>() || parser == TypeId::of::<u64>() {
        // TOML has no larger integers
        trimmed.parse::<i64>().ok().map(|number| number.to_string())
    } else {
        None
    };
    Literal::Plain(number.unwrap_or_else(|| Value::from(raw).to_string()))
}

impl Literal {
    fn text(&self, folder: &Path) -> String {
        match self {
            Self::Plain(text) => text.clone(),
            Self::Path(path) => Value::from(seen_from(path, folder).to_string_lossy().into_owned()).to_string(),
        }
    }
}

/// A path relative to the working folder as one relative to `folder`, which need not exist. Absolute paths remain.
fn seen_from(path: &Path, folder: &Path) -> PathBuf {
    if path.is_absolute() {
        return path.to_owned();
    }
    let (path, folder) = (absolute(path), resolved(&absolute(folder)));
    // a link to a file stays a link
    let path = match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if !path.is_dir() => resolved(parent).join(name),
        _ => resolved(&path),
    };
    let (mut path, mut folder) = (path.components().peekable(), folder.components().peekable());
    while path.peek().is_some() && path.peek() == folder.peek() {
        path.next();
        folder.next();
    }
    let up = folder.map(|_| Component::ParentDir);
    let steps: PathBuf = up.chain(path).collect();
    if steps.as_os_str().is_empty() { ".".into() } else { steps }
}
