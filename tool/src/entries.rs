//! Files of options, in TOML, and their entries as words of a command line. (`scene.rs` writes such files.)

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use asperity::Error;
use clap::{Arg, ArgAction, Command};
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

use crate::hints::meant_by;
use crate::scene::{is_path, key, section};
use crate::synonyms::similar;

/// Reads a file of options.
pub fn document(path: &Path) -> asperity::Result<Table> {
    let refuse = |reason: String| Error::file(path, reason);
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
    let mut sections: Vec<_> = command.get_arguments().map(section).collect();
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
                return Err(format!("[{key}] is no section of {}, which has {names}{hint}", command.get_name()));
            }
            value => add(key, value)?,
        }
    }
    Ok(entries)
}

/// An option of a scene as words of a command line. Only options that cannot be typed at all are refused here; all
/// others are for the parser of the arguments to judge.
pub fn spelled(entry: &str, value: &Value, command: &Command, folder: &Path) -> Result<Vec<OsString>, String> {
    let name = format!("--{entry}");
    let Some(option) = command.get_arguments().find(|option| key(option).as_deref() == Some(entry)) else {
        let typed = entry.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
        // not even known options that ask for help
        let unknown = typed && !["help", "version"].contains(&entry);
        return if unknown { Ok(vec![name.into()]) } else { Err(format!("\"{entry}\" is no option: remove it")) };
    };
    if matches!(option.get_action(), ArgAction::SetTrue) {
        return match value {
            Value::Boolean(true) => Ok(vec![name.into()]),
            Value::Boolean(false) => Ok(Vec::new()),
            other => {
                let hint = meant_by(command, entry, "").map_or(String::new(), |hint| format!("; {hint}"));
                Err(format!("{entry} is {other}: it must be true or false{hint}"))
            }
        };
    }
    let least = option.get_num_args().map_or(1, |count| count.min_values());
    if let (0, Value::Boolean(is_given)) = (least, value) {
        return Ok(is_given.then(|| name.into()).into_iter().collect());
    }
    let word = |value: &Value| match value {
        Value::String(word) if is_path(option) && !word.is_empty() => {
            Ok(folder.join(word).components().collect::<PathBuf>().into())
        }
        Value::String(word) => Ok(word.into()),
        Value::Integer(_) | Value::Float(_) if !is_path(option) => Ok(value.to_string().into()),
        other => Err(format!("{entry} is {other}: it must be {}", wanted(option))),
    };
    let words = match value {
        Value::Array(values) => values.iter().map(word).collect::<Result<Vec<_>, _>>()?,
        value => vec![word(value)?],
    };
    if option.is_positional() {
        return Ok(words);
    }
    let most = option.get_num_args().map_or(1, |count| count.max_values());
    if most > 1 && words.len() > most {
        return Err(format!("{entry} has {} values: give {most} at most", words.len()));
    }
    // values with commas between them may be negative
    if most > 1 && option.get_value_delimiter().is_none() {
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
