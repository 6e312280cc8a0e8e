//! The cases of a study, read from its file: every combination of the values that vary.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_scene::{Format, Hash};
use clap::Command;
use toml::{Table, Value};

use crate::entries::{document, entries, spelled};
use crate::loads::parsed;
use crate::outcome::Outcome;
use crate::printing::{on_one_line, on_terminal};
use crate::quantity::Quantity;
use crate::scene::{self, is_path, key};
use crate::synonyms::similar;

/// The commands of which a case may be a run.
const COMMANDS: [&str; 2] = ["sweep", "cycle"];

/// The sections that a study has beside those of its command.
pub const SECTIONS: [&str; 2] = ["make", "vary"];

/// Options that a study decides by itself.
const OWN: [&str; 8] = ["out", "format", "force", "quiet", "json", "threads", "fields", "plot"];

/// The largest number of cases; more are taken for a slip of the pen.
const MOST_CASES: usize = 1_000_000;

/// A study: its table, and the cases of which the table is made.
pub struct Study {
    /// The command of which each case is a run
    pub command: String,
    /// The file of the table
    pub out: PathBuf,
    pub format: Format,
    /// The options that vary, by their names in a table
    pub columns: Vec<String>,
    pub cases: Vec<Case>,
}

/// A run of a sweep or a cycle.
pub struct Case {
    /// The values of the columns; none where an option is not given in this case
    pub values: Vec<Option<Value>>,
    /// The arguments of the command that makes the surface, if that is part of the case
    pub surface: Option<Vec<OsString>>,
    /// The arguments of the command, but for those that the study adds
    pub arguments: Vec<OsString>,
    /// All that the rows depend on
    pub identity: Hash,
}

/// The values that options take together, by their keys.
type Choice = Vec<(String, Value)>;

impl Study {
    /// Reads a study; `tool` defines the commands and options, and `out` replaces the file of the table.
    pub fn read(tool: &mut Command, path: &Path, out: Option<&Path>) -> Outcome<Self> {
        let refuse = |reason: String| Error::file(path, reason);
        let mut table = document(path)?;
        let name = match table.remove("command") {
            Some(Value::String(name)) if COMMANDS.contains(&name.as_str()) => name,
            Some(other) => {
                let is_scene = other.as_str().is_some_and(|name| scene::COMMANDS.contains(&name));
                let hint = format!(", or run the scene by 'asperity run {}'", path.display());
                let hint = if is_scene { hint.as_str() } else { "" };
                return Err(refuse(format!("command is {other}: it must be sweep or cycle{hint}")).into());
            }
            None => return Err(refuse(lacks(&table, "command", "does not say what to do", "sweep")).into()),
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let out = match (out, table.remove("out")) {
            (Some(out), _) => out.to_owned(),
            (None, Some(Value::String(out))) if !out.is_empty() => folder.join(out),
            (None, None) => return Err(refuse(lacks(&table, "out", "names no table", "study.csv")).into()),
            (None, Some(other)) => return Err(refuse(format!("out is {other}: it must be the name of a file")).into()),
        };
        let refused = || Error::file(&out, "does not end in .csv or .jsonl: rename it");
        let format = Format::of(&out).ok_or_else(refused)?;
        let section = |table: &mut Table, name: &str| match table.remove(name) {
            Some(Value::Table(section)) => Ok(Some(section)),
            None => Ok(None),
            Some(other) => Err(refuse(format!("{name} is {other}: it must be a section, [{name}]"))),
        };
        let [make, vary] = SECTIONS.map(|name| section(&mut table, name));
        let (make, vary) = (make?, vary?.unwrap_or_default());
        let commands = Commands {
            command: tool.find_subcommand(&name).cloned().ok_or_else(|| refuse(format!("{name} is not built in")))?,
            surface: make.as_ref().and_then(|_| tool.find_subcommand("surface").cloned()),
        };
        let fixed = entries(table, &commands.command, &SECTIONS).map_err(refuse)?;
        let fixed: Vec<_> = fixed.into_iter().chain(make.into_iter().flatten()).collect();
        let choices = vary.into_iter().map(|(key, value)| choices(key, value)).collect::<Result<Vec<_>, _>>();
        let choices = choices.map_err(refuse)?;

        let mut keys: Vec<&str> = Vec::new();
        for list in &choices {
            let mut here: Vec<&str> = Vec::new();
            for (key, _) in list.iter().flatten() {
                if !here.contains(&key.as_str()) {
                    here.push(key);
                }
            }
            if let Some(twice) =
                here.iter().find(|key| keys.contains(key) || fixed.iter().any(|(fixed, _)| fixed == *key))
            {
                return Err(refuse(format!("{twice} is there twice: remove one of them")).into());
            }
            keys.extend(here);
        }
        for key in fixed.iter().map(|(key, _)| key.as_str()).chain(keys.iter().copied()) {
            if OWN.contains(&key) {
                return Err(refuse(format!("{key} is not for a study, which sees to it by itself: remove it")).into());
            }
            commands.check(key).map_err(refuse)?;
        }
        let count = choices.iter().try_fold(1_usize, |count, list| count.checked_mul(list.len()));
        let Some(count @ ..=MOST_CASES) = count else {
            return Err(refuse(format!("has more cases than the {MOST_CASES} that are allowed")).into());
        };
        let mut files = HashMap::new();
        let mut cases = Vec::with_capacity(count);
        for number in 0..count {
            let chosen = combination(&choices, number);
            let all: Vec<_> = fixed.iter().chain(chosen.iter().copied().flatten()).collect();
            let told = |error: String| refuse(format!("case {}: {error}", number + 1));
            let (surface, arguments) = commands.arguments(&all, folder).map_err(told)?;
            let identity = commands.identity(&all, folder, &mut files)?;
            check(tool, &name, surface.as_deref(), &arguments).map_err(told)?;
            let value = |key: &&str| all.iter().find(|(name, _)| name == key).map(|(_, value)| value.clone());
            cases.push(Case { values: keys.iter().map(value).collect(), surface, arguments, identity });
        }
        let columns = keys.iter().map(|key| key.replace('-', "_")).collect();
        Ok(Self { command: name, out, format, columns, cases })
    }

    /// The values of a case in words, for people.
    pub fn told(&self, case: &Case) -> String {
        let values = self.columns.iter().zip(&case.values);
        let told = values.filter_map(|(name, value)| Some(format!("{name} {}", text(value.as_ref()?))));
        on_terminal(&told.collect::<Vec<_>>().join(", "))
    }
}

/// The remedy for a file that lacks an entry: an addition, or the correction of an entry that may be misspelt.
fn lacks(table: &Table, key: &str, what: &str, value: &str) -> String {
    let instead = similar(key, table.keys().map(String::as_str));
    let instead = instead.map_or(String::new(), |found| format!(" in the place of {found}"));
    format!("{what}: add {key} = \"{value}\"{instead}")
}

/// A value without quotation marks and brackets.
pub fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(text).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}

/// The values that an entry of the section [vary] takes in turn.
fn choices(key: String, value: Value) -> Result<Vec<Choice>, String> {
    let list = match value {
        Value::Array(list) if !list.is_empty() => list,
        Value::String(list) if list.contains(':') => range(&list).map_err(|error| format!("vary.{key}: {error}"))?,
        other => return Err(format!("vary.{key} is {other}: it must be a list of values, or FROM:TO:COUNT")),
    };
    let tables = list.iter().filter(|value| value.is_table()).count();
    if tables != 0 && tables != list.len() {
        return Err(format!("vary.{key} has both tables and other values: write all of them as tables"));
    }
    let choice = |value| match value {
        Value::Table(table) => table.into_iter().collect(),
        value => vec![(key.clone(), value)],
    };
    Ok(list.into_iter().map(choice).collect())
}

/// The values of a range FROM:TO:COUNT or FROM:TO:COUNT:log, of which both ends have the same unit or none.
fn range(text: &str) -> Result<Vec<Value>, String> {
    let unit =
        |end: &str| end.trim().trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c)).to_owned();
    let mut ends = text.split(':');
    let units = [ends.next(), ends.next()].map(|end| end.map_or(String::new(), unit));
    let number = |end: &str| match end.trim().trim_end_matches(&units[0]).trim().parse::<f64>() {
        Ok(value) if value.is_finite() && units[0] == units[1] => Ok(Quantity::number(value)),
        _ => Err("both ends of a range must be numbers, with the same unit or without one".to_owned()),
    };
    // in no unit, so that the digits are those that one would write
    let values = parsed(text, &number)?.values;
    Ok(values.into_iter().map(|value| Value::String(format!("{value}{}", units[0]))).collect())
}

/// The combination of this number, the last list changing fastest.
fn combination(choices: &[Vec<Choice>], mut number: usize) -> Vec<&Choice> {
    let mut chosen: Vec<_> = choices
        .iter()
        .rev()
        .map(|list| {
            let choice = &list[number % list.len()];
            number /= list.len();
            choice
        })
        .collect();
    chosen.reverse();
    chosen
}

/// The command of a case, and that which makes its surface, if one does.
struct Commands {
    command: Command,
    surface: Option<Command>,
}

impl Commands {
    /// The command that has an option: that which makes the surface first.
    fn of(&self, name: &str) -> (bool, &Command) {
        let has = |command: &&Command| command.get_arguments().any(|arg| key(arg).as_deref() == Some(name));
        match self.surface.as_ref().filter(has) {
            Some(surface) => (true, surface),
            None => (false, &self.command),
        }
    }

    /// Refuses what is no option of theirs.
    fn check(&self, name: &str) -> Result<(), String> {
        let commands = || self.surface.iter().chain([&self.command]);
        let known: Vec<_> = commands().flat_map(Command::get_arguments).filter_map(key).collect();
        if known.iter().any(|known| known == name) {
            return Ok(());
        }
        let commands: Vec<_> = commands().map(Command::get_name).collect();
        let meant = similar(name, known.iter().map(String::as_str).filter(|known| !OWN.contains(known)));
        let hint = meant.map_or("remove it".to_owned(), |meant| format!("did you mean {meant}?"));
        Err(format!("{name} is no option of {}: {hint}", commands.join(" or ")))
    }

    /// The arguments of both commands.
    fn arguments(
        &self,
        entries: &[&(String, Value)],
        folder: &Path,
    ) -> Result<(Option<Vec<OsString>>, Vec<OsString>), String> {
        let (mut surface, mut arguments) = (Vec::new(), Vec::new());
        for (name, value) in entries {
            let (makes, command) = self.of(name);
            if makes { &mut surface } else { &mut arguments }.extend(spelled(name, value, command, folder)?);
        }
        Ok((self.surface.is_some().then_some(surface), arguments))
    }

    /// All that the rows depend on: options, contents of files, and the version of the tool.
    fn identity(
        &self,
        entries: &[&(String, Value)],
        folder: &Path,
        files: &mut HashMap<PathBuf, Hash>,
    ) -> asperity::Result<Hash> {
        let mut words = vec![env!("CARGO_PKG_VERSION").to_owned(), self.command.get_name().to_owned()];
        for (name, value) in entries {
            let (makes, command) = self.of(name);
            let option = command.get_arguments().find(|arg| key(arg).as_ref() == Some(name));
            let value = match value {
                Value::String(file) if option.is_some_and(is_path) => contents(&folder.join(file), files)?.to_string(),
                value => text(value),
            };
            words.push(format!("{makes} {name} {value}"));
        }
        words[2..].sort();
        Ok(words.iter().fold(Hash::NEW, |hash, word| hash.of(word.as_bytes()).of(b"\n")))
    }
}

/// The hash of a file, which is read once.
fn contents(path: &Path, files: &mut HashMap<PathBuf, Hash>) -> asperity::Result<Hash> {
    if let Some(&hash) = files.get(path) {
        return Ok(hash);
    }
    let bytes = fs::read(path).map_err(|e| Error::unreadable(path, e))?;
    let hash = Hash::NEW.of(&bytes);
    files.insert(path.to_owned(), hash);
    Ok(hash)
}

/// Refuses arguments that the commands do not take.
fn check(tool: &mut Command, name: &str, surface: Option<&[OsString]>, arguments: &[OsString]) -> Result<(), String> {
    let mut parse = |words: Vec<OsString>| tool.try_get_matches_from_mut(words).map_err(|error| on_one_line(&error));
    let words = |name: &str, added: &[&str]| -> Vec<OsString> {
        ["asperity", name].iter().chain(added).map(|word| OsString::from(*word)).collect()
    };
    if let Some(surface) = surface {
        parse([words("surface", &["--out=surface.npz"]), surface.to_vec()].concat())?;
    }
    let added: &[&str] =
        if surface.is_some() { &["--out=table.csv", "--heights=surface.npz"] } else { &["--out=table.csv"] };
    parse([words(name, added), arguments.to_vec()].concat())?;
    Ok(())
}
