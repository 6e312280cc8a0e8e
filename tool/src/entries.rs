//! Files of options, in TOML, and what their entries give for the keys of a command. (`scene.rs` writes such files.)

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use asperity_scene::synonyms::similar;
use asperity_scene::{Entries, Key, Skin, Values};
use clap::Arg;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

use crate::command::{Command, mistake};
use crate::hints::{hinted, meant_by};
use crate::printing::on_one_line;

/// Reads a file of options.
pub fn document(path: &Path) -> asperity::Result<Table> {
    let refuse = |reason: String| asperity::Error::file(path, reason);
    let text = fs::read_to_string(path).map_err(|e| match e.kind() {
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
        )));
    }
    text.parse().map_err(|e: toml::de::Error| {
        let line = line(e.span().map_or(0, |span| span.start));
        refuse(format!("line {line} is not TOML: {}", e.message().replace('\n', ", ")))
    })
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

/// The options of a scene, before the first section and in all sections. Sections that have been taken out of the table
/// are only named.
pub fn entries(table: Table, command: &Command, taken: &[&str]) -> Result<Vec<(String, Value)>, String> {
    let mut sections: Vec<_> = command.keys().map(|key| key.section.to_lowercase()).collect();
    sections.retain(|section| !section.is_empty());
    let mut seen = HashSet::new();
    sections.retain(|section| seen.insert(section.clone()));
    let has = |key: &str| sections.iter().any(|section| section == key);
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
            Value::Table(options) if has(&key) => {
                options.into_iter().try_for_each(|(key, value)| add(key, value))?;
            }
            Value::Table(_) => {
                let known: Vec<_> = sections.iter().map(String::as_str).chain(taken.iter().copied()).collect();
                let names: Vec<_> = known.iter().map(|section| format!("[{section}]")).collect();
                let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                let hint = similar(&key, known).map_or(String::new(), |meant| format!(": did you mean [{meant}]?"));
                return Err(format!("[{key}] is no section of {}, which has {names}{hint}", command.name));
            }
            value => add(key, value)?,
        }
    }
    Ok(entries)
}

/// A reader of the entries of a scene.
pub struct Reader<'a> {
    pub command: &'static Command,
    /// The parser of the tool, for its words
    pub tool: &'a clap::Command,
    /// The folder of the scene, from which files are named
    pub folder: &'a Path,
}

impl Reader<'_> {
    /// The parser of the command.
    pub fn parser(&self) -> &clap::Command {
        self.tool.find_subcommand(self.command.name).unwrap_or(self.tool)
    }

    /// What entries give for the keys, without defaults.
    pub fn read<'e>(&self, entries: impl IntoIterator<Item = &'e (String, Value)>) -> Result<Entries, String> {
        let mut given = Entries::default();
        for (name, value) in entries {
            let key = self.command.keys().find(|key| key.dashed() == *name).ok_or_else(|| self.unknown(name))?;
            let invalid = |(text, _): (String, String)| self.invalid(ErrorKind::ValueValidation, key, &text);
            given.add(key, self.typed(key, value)?, false).map_err(invalid)?;
        }
        Ok(given)
    }

    /// All that is given, with defaults, unless it is not enough or excludes itself.
    pub fn complete(&self, given: &Entries) -> Result<Entries, String> {
        let given = given.complete(self.command.keys());
        self.command.check(&given, self.parser()).map_err(|error| on_one_line(&error))?;
        given.quantities().check(Skin::Options)?;
        Ok(given)
    }

    /// The texts of a key, of a value.
    fn typed(&self, key: &Key, value: &Value) -> Result<Vec<OsString>, String> {
        let (entry, kind, is_path) = (key.dashed(), &key.kind, matches!(key.kind.values, Values::File));
        match (kind.values, kind.alone, value) {
            (Values::Switch, _, Value::Boolean(true)) => return Ok(vec!["true".into()]),
            (Values::Switch, _, Value::Boolean(false)) | (_, Some(_), Value::Boolean(false)) => return Ok(Vec::new()),
            (_, Some(alone), Value::Boolean(true)) => return Ok(vec![alone.into()]),
            (Values::Switch, _, other) => {
                let hint = meant_by(self.parser(), &entry, "").map_or(String::new(), |hint| format!("; {hint}"));
                return Err(format!("{entry} is {other}: it must be true or false{hint}"));
            }
            _ => {}
        }
        let wanted = if is_path {
            "a name in quotation marks"
        } else {
            "a number, a word in quotation marks, or a list of them"
        };
        let text = |value: &Value| match value {
            Value::String(name) if is_path && name.is_empty() => Err(self.invalid(ErrorKind::InvalidValue, key, "")),
            Value::String(name) if is_path => Ok(self.folder.join(name).components().collect::<PathBuf>().into()),
            Value::String(word) => Ok(word.into()),
            Value::Integer(_) | Value::Float(_) if !is_path => Ok(value.to_string().into()),
            other => Err(format!("{entry} is {other}: it must be {wanted}")),
        };
        let texts: Vec<OsString> = match value {
            Value::Array(values) => values.iter().map(text).collect::<Result<_, _>>()?,
            value => vec![text(value)?],
        };
        let (least, most) = kind.count;
        let texts = match () {
            () if kind.commas => texts
                .iter()
                .flat_map(|text| text.to_string_lossy().split(',').map(OsString::from).collect::<Vec<_>>())
                .collect(),
            () if most == 1 => vec![texts.join(&OsString::from(","))],
            () => texts,
        };
        if most > 1 && !(least..=most).contains(&texts.len()) {
            let limit = if texts.len() > most { format!("{most} at most") } else { least.to_string() };
            return Err(format!("{entry} has {} values: give {limit}", texts.len()));
        }
        Ok(texts)
    }

    /// The mistake of an entry that is no option.
    fn unknown(&self, entry: &str) -> String {
        // not even known options that ask for help
        if !entry.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_') || ["help", "version"].contains(&entry) {
            return format!("\"{entry}\" is no option: remove it");
        }
        let alike = similar(entry, self.parser().get_arguments().filter_map(Arg::get_long));
        let alike = alike.map(|alike| (ContextKind::SuggestedArg, format!("--{alike}")));
        let context = alike.into_iter().chain([(ContextKind::InvalidArg, format!("--{entry}"))]);
        self.explain(ErrorKind::UnknownArgument, context)
    }

    /// The mistake of a text that is no value of a key.
    fn invalid(&self, kind: ErrorKind, key: &Key, text: &str) -> String {
        let option = self.parser().get_arguments().find(|arg| arg.get_id() == key.name).map(Arg::to_string);
        self.explain(
            kind,
            [(ContextKind::InvalidArg, option.unwrap_or_default()), (ContextKind::InvalidValue, text.to_owned())],
        )
    }

    /// A mistake with what may have been meant, on a line.
    fn explain(&self, kind: ErrorKind, context: impl IntoIterator<Item = (ContextKind, String)>) -> String {
        let context = context.into_iter().map(|(kind, text)| (kind, ContextValue::String(text)));
        let arguments = ["asperity", self.command.name].map(OsString::from);
        on_one_line(&hinted(self.tool, &arguments, mistake(kind, self.parser(), context)))
    }
}
