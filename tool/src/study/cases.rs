//! The cases of a study, read from its file: every combination of the values that vary.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity_scene::list::parsed;
use asperity_scene::synonyms::similar;
use asperity_scene::{Format, Hash, Key, Outcome, Quantity, Values, number_and_unit};
use clap::Command as Parser;
use toml::{Table, Value};

use super::work::folder as folder_of;
use crate::command::{Command, Place};
use crate::entries::{Reader, document, entries};
use crate::printing::on_terminal;
use crate::scene::SceneFile;
use crate::table::format_of;
use crate::{named, part_of};

/// The sections that a study has besides the sections of its command.
pub const SECTIONS: [&str; 2] = ["make", "vary"];

/// The keys that a study decides by itself, or that a table lacks.
const OWN: [&str; 3] = ["threads", "stability", "percolation"];

/// The largest number of cases; more are taken for a slip of the pen.
const MOST_CASES: usize = 1_000_000;

/// A study: its table, and the cases that make the table.
pub struct Study {
    /// The file of the table
    pub out: PathBuf,
    pub format: Format,
    /// The options that vary, by their names in a table
    pub columns: Vec<String>,
    pub cases: Vec<Case>,
    commands: Commands,
    /// The folder of the study, from which files are named
    folder: PathBuf,
    /// What is the same in all cases, and the lists of what varies
    fixed: Choice,
    lists: Vec<Vec<Choice>>,
}

/// A run of the command of a study.
pub struct Case {
    /// The values of the columns; none where an option is not given in this case
    pub values: Vec<Option<Value>>,
    /// The file of the rows, named by all that they depend on
    pub rows: PathBuf,
}

/// The values that options take together, by their keys.
type Choice = Vec<(String, Value)>;

/// The keys of lists, each once, in the order in which they are given.
fn keys_of(lists: &[Vec<Choice>]) -> Vec<&str> {
    let mut keys: Vec<&str> = Vec::new();
    for (key, _) in lists.iter().flatten().flatten() {
        if !keys.contains(&key.as_str()) {
            keys.push(key);
        }
    }
    keys
}

impl Study {
    /// Reads a study; `tool` has the words of mistakes, and `out` replaces the file of the table.
    pub fn read(tool: &Parser, path: &Path, out: Option<&Path>) -> Outcome<Self> {
        let refuse = |reason: String| Error::file(path, reason);
        let mut table = document(path)?;
        let is_scene = !SECTIONS.iter().any(|name| table.contains_key(*name));
        let run =
            if is_scene { format!(", or run the scene by 'asperity run {}'", path.display()) } else { String::new() };
        let command = match table.remove("command") {
            Some(Value::String(name)) if part_of(Place::Study).contains(&name.as_str()) => named(&name)?,
            Some(other) => {
                let known = part_of(Place::Study).join(", ");
                return Err(refuse(format!("command is {other}: it must be one of {known}{run}")).into());
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
        let format = format_of(&out, &run)?;
        let [make, vary] = SECTIONS.map(|name| match table.remove(name) {
            Some(Value::Table(section)) => Ok(Some(section)),
            None => Ok(None),
            Some(other) => Err(refuse(format!("{name} is {other}: it must be a section, [{name}]"))),
        });
        let make = make?;
        let fixed = entries(table, command, &SECTIONS).map_err(refuse)?;
        let commands = Commands(make.iter().map(|_| named("surface")).chain([Ok(command)]).collect::<Outcome<_>>()?);
        let fixed: Vec<_> = fixed.into_iter().chain(make.into_iter().flatten()).collect();
        let lists = vary?.into_iter().flatten().map(|(key, value)| choices(key, value));
        let lists = lists.collect::<Result<Vec<_>, _>>().map_err(refuse)?;

        let keys = keys_of(&lists);
        let mut all = fixed.iter().map(|(key, _)| key.as_str()).chain(keys.iter().copied());
        all.try_for_each(|key| commands.check(key)).map_err(refuse)?;
        let count = lists.iter().try_fold(1_usize, |count, list| count.checked_mul(list.len()));
        let Some(count @ ..=MOST_CASES) = count else {
            return Err(refuse(format!("has more cases than the {MOST_CASES} that are allowed")).into());
        };
        let columns = keys.iter().map(|key| key.replace('-', "_")).collect();
        let (files, beside, folder) = (&mut HashMap::new(), folder_of(&out), folder.to_owned());
        let keys: Vec<_> = keys.into_iter().map(str::to_owned).collect();
        let cases = Vec::with_capacity(count);
        let mut study = Self { out, format, columns, cases, commands, folder, fixed, lists };
        for number in 0..count {
            let all: Vec<_> = study.entries(number).collect();
            let twice = all.iter().enumerate().find(|(k, (key, _))| all[..*k].iter().any(|(other, _)| other == key));
            if let Some((_, (key, _))) = twice {
                return Err(refuse(format!("{key} is there twice: remove one of them")).into());
            }
            let rows = format!("{}.{}", study.commands.identity(&all, &study.folder, files)?, format.name());
            let value = |key: &String| all.iter().find(|(name, _)| name == key).map(|(_, value)| value.clone());
            let case = Case { values: keys.iter().map(value).collect(), rows: beside.join(rows) };
            study.cases.push(case);
            study.scenes(number, tool).map_err(|error| refuse(format!("case {}: {error}", number + 1)))?;
        }
        Ok(study)
    }

    /// Whether the surface of each case is made.
    pub fn makes_surface(&self) -> bool {
        self.commands.0.len() > 1
    }

    /// The entries of the case of a number.
    fn entries(&self, number: usize) -> impl Iterator<Item = &(String, Value)> {
        self.fixed.iter().chain(combination(&self.lists, number))
    }

    /// The scenes of a case: of its command, before it of the command that makes its surface, if one does. Files of
    /// results are named, and not written.
    pub fn scenes(&self, number: usize, tool: &Parser) -> Result<Vec<SceneFile>, String> {
        let made = self.cases[number].rows.with_extension("npz");
        let scene = |(k, command): (usize, &'static Command)| {
            let reader = Reader { command, tool, folder: &self.folder };
            let is_own = |(name, _): &&(String, Value)| self.commands.option(name).is_some_and(|(of, _)| of == k);
            let mut given = reader.read(self.entries(number).filter(is_own))?;
            let files = [("out", Path::new("table.csv"))]
                .into_iter()
                .chain(self.makes_surface().then_some(("heights", &*made)));
            for (name, file) in files {
                if let Some(key) = command.keys().find(|key| key.name == name) {
                    given.add(key, vec![file.into()], false).map_err(|(_, reason)| reason)?;
                }
            }
            Ok(SceneFile { command: command.name, given: reader.complete(&given)? })
        };
        self.commands.0.iter().copied().enumerate().map(scene).collect()
    }

    /// The values of a case in words, for people.
    pub fn describe(&self, case: &Case) -> String {
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

/// The values of a range FROM:TO:COUNT or FROM:TO:COUNT:log; both ends have the same unit or none.
fn range(text: &str) -> Result<Vec<Value>, String> {
    let split = |end: &str| {
        let (number, unit) = number_and_unit(end.trim())?;
        Some((number.parse::<f64>().ok().filter(|value| value.is_finite())?, unit.to_owned()))
    };
    let unit = text.split(':').find_map(split).map_or(String::new(), |(_, unit)| unit);
    let number = |end: &str| match split(end) {
        Some((value, own)) if own == unit => Ok(Quantity::number(value)),
        _ => Err("both ends of a range must be numbers, with the same unit or without one".to_owned()),
    };
    // in no unit, so that the digits are those that one would write
    let values = parsed(text, &number)?.values;
    Ok(values.into_iter().map(|value| Value::String(format!("{value}{unit}"))).collect())
}

/// The combination of this number, the last list changing fastest.
fn combination(lists: &[Vec<Choice>], number: usize) -> impl Iterator<Item = &(String, Value)> {
    let place = |k: usize| lists[k + 1..].iter().map(Vec::len).product::<usize>();
    lists.iter().enumerate().flat_map(move |(k, list)| &list[number / place(k) % list.len()])
}

/// The command of a case, before it the command that makes its surface, if one does.
struct Commands(Vec<&'static Command>);

impl Commands {
    /// The key of an option, with the number of its command.
    fn option(&self, name: &str) -> Option<(usize, &'static Key)> {
        let keys = |(k, command): (_, &&'static Command)| command.keys().map(move |key| (k, key));
        self.0.iter().enumerate().flat_map(keys).find(|(_, key)| key.dashed() == name)
    }

    /// Refuses what is no option of theirs, or is not for a study, as files next to the rows.
    fn check(&self, name: &str) -> Result<(), String> {
        let is_own = |key: &Key| {
            let is_file = key.section == "Output" && Key::named(key.name).is_none() && key.name != "strict";
            OWN.contains(&key.name) || is_file
        };
        match self.option(name) {
            Some((_, key)) if is_own(key) => return Err(format!("{name} is no option of a study: remove it")),
            Some(_) => return Ok(()),
            None => {}
        }
        let keys = self.0.iter().flat_map(|command| command.keys()).filter(|key| !is_own(key));
        let known: Vec<_> = keys.map(Key::dashed).collect();
        let meant = similar(name, known.iter().map(String::as_str));
        let hint = meant.map_or("remove it".to_owned(), |meant| format!("did you mean {meant}?"));
        let names: Vec<_> = self.0.iter().map(|command| command.name).collect();
        Err(format!("{name} is no option of {}: {hint}", names.join(" or ")))
    }

    /// All that the rows depend on: options, contents of files, and the version of the tool.
    fn identity(
        &self,
        entries: &[&(String, Value)],
        folder: &Path,
        files: &mut HashMap<PathBuf, Hash>,
    ) -> asperity::Result<Hash> {
        let mut words = Vec::new();
        for (name, value) in entries {
            let Some((of, key)) = self.option(name) else { continue };
            let value = match value {
                Value::String(file) if matches!(key.kind.values, Values::File) => {
                    contents(&folder.join(file), files)?.to_string()
                }
                value => text(value),
            };
            words.push(format!("{} {name} {value}", of + 1 < self.0.len()));
        }
        words.sort();
        let before = [env!("CARGO_PKG_VERSION"), self.0[self.0.len() - 1].name];
        let words = before.into_iter().chain(words.iter().map(String::as_str));
        Ok(words.fold(Hash::NEW, |hash, word| hash.extend(word.as_bytes()).extend(b"\n")))
    }
}

/// The hash of a file, which is read once.
fn contents(path: &Path, files: &mut HashMap<PathBuf, Hash>) -> asperity::Result<Hash> {
    if let Some(&hash) = files.get(path) {
        return Ok(hash);
    }
    let bytes = fs::read(path).map_err(|e| Error::unreadable(path, e))?;
    let hash = Hash::NEW.extend(&bytes);
    files.insert(path.to_owned(), hash);
    Ok(hash)
}
