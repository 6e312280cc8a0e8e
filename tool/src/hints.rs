//! Hints next to the mistakes in arguments: what may have been meant.

use std::ffi::OsString;

use asperity_scene::synonyms::{is_same, meant};
use asperity_scene::{Key, Values};
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Arg, ArgAction, Command};

use crate::named;

/// A mistake in the arguments of a `tool`, with what may have been meant.
pub fn hinted(tool: &Command, arguments: &[OsString], mut error: Error) -> Error {
    let name = arguments.get(1).and_then(|name| name.to_str()).unwrap_or_default();
    let context = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    // with its value, or with the name of that
    let word = context(ContextKind::InvalidArg).split([' ', '=']).next().unwrap_or_default();
    let value = context(ContextKind::InvalidValue);
    let hints = match (error.kind(), tool.find_subcommand(name)) {
        (ErrorKind::InvalidSubcommand, _) if name.ends_with(".toml") => vec![of_scene(name)],
        (ErrorKind::UnknownArgument, Some(command)) if is_option(word) => of_option(tool, command, word),
        (ErrorKind::UnknownArgument, Some(command)) => of_value(command, word, before(arguments, word)),
        (ErrorKind::TooManyValues, Some(command)) => of_value(command, value, word),
        (ErrorKind::ValueValidation, Some(command)) => of_several(tool, command, word, value),
        _ => Vec::new(),
    };
    if let (true, Some(key)) = (hints.is_empty(), key_of(name, word.trim_start_matches('-')))
        && let ErrorKind::ValueValidation | ErrorKind::InvalidValue = error.kind()
        && let Err(reason) = key.value(value)
    {
        let mut said = Error::raw(ErrorKind::ValueValidation, format!("{word} is {value}: {reason}"));
        said.insert(ContextKind::InvalidArg, ContextValue::String(word.to_owned()));
        return said.with_cmd(tool);
    }
    if !hints.is_empty() {
        let hints = hints.into_iter().map(Into::into).collect();
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(hints));
    }
    error
}

/// The option that is meant by the name of none, with what its help says of it first.
pub fn meant_by(command: &Command, name: &str, dashes: &str) -> Option<String> {
    let known: Vec<_> = command.get_arguments().filter_map(Arg::get_long).collect();
    let meant = meant(name, known)?;
    let option = find(command, meant)?;
    let help = option.get_help()?.to_string();
    let (first, rest) = help.split_at_checked(1)?;
    let rest = rest.split(';').next().unwrap_or_default();
    let values: Vec<_> = option.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    let values = if values.is_empty() { values.concat() } else { format!(": {}", values.join(", ")) };
    Some(format!("did you mean '{dashes}{meant}', {}{rest}{values}?", first.to_lowercase()))
}

/// What no command computes.
const NEVER: [&str; 6] = ["friction", "friction-coefficient", "shear", "wear", "hardening", "temperature"];

/// For a name that is no option of a command.
fn of_option(tool: &Command, command: &Command, word: &str) -> Vec<String> {
    let name = word.trim_start_matches('-');
    if NEVER.contains(&name) {
        return vec![format!("asperity knows no {name}, docs/more/limits.md lists what it does not do")];
    }
    let has = |command: &&Command| find(command, name).is_some();
    let others: Vec<_> = tool.get_subcommands().filter(has).map(Command::get_name).collect();
    let positional = command.get_positionals().find(|option| option.get_id() == name);
    let one = command.get_arguments().filter_map(Arg::get_long).find(|one| is_plural(name, one));
    if let Some(one) = one.filter(|_| others.is_empty()) {
        return of_study(command, one);
    }
    let mut hints: Vec<_> = meant_by(command, name, "--").into_iter().collect();
    hints.extend(positional.map(|option| format!("{} is given without a name", option)));
    hints.extend((!others.is_empty()).then(|| format!("'{word}' is an option of {}", listed(&others))));
    hints
}

/// The longest word that may be the unit of the number before it.
const LONGEST_UNIT: usize = 8;

/// For a value that no option takes, after a word that may be an option without one.
fn of_value(command: &Command, value: &str, before: &str) -> Vec<String> {
    let mut hints = Vec::new();
    let name = before.trim_start_matches('-');
    let flag = find(command, name).filter(|option| matches!(option.get_action(), ArgAction::SetTrue));
    if is_number(before) && !value.contains('.') && value.len() <= LONGEST_UNIT {
        hints.push(format!("write '{before}{value}', without a blank"));
    } else if flag.is_some() && is_number(value) {
        hints.push(format!("'--{name}' takes no value"));
        hints.extend(meant_by(command, name, "--"));
    } else if value.ends_with(".toml") {
        hints.push(of_scene(value));
    } else if !is_number(value) && find(command, "heights").is_some() {
        hints.push(format!("a file of heights is given by '--heights {value}'"));
    }
    hints
}

/// For several values in the place of one, in one word or in a file.
fn of_several(tool: &Command, command: &Command, word: &str, value: &str) -> Vec<String> {
    let name = word.trim_start_matches('-');
    let several = |option: &Arg| option.get_num_args().is_some_and(|count| count.max_values() > 1);
    if value.contains(',') && find(command, name).is_some_and(several) {
        return vec![format!("give its values with spaces between, '{word} {}'", value.replace(',', " "))];
    }
    let map = format!("{name}-map");
    if !is_number(value) && find(command, &map).is_some() {
        return vec![format!("values at the nodes are in a file, by '--{map} {value}'")];
    }
    let list = |option: &&Arg| option.get_long().is_some_and(|long| is_plural(long, name));
    let has = |command: &&Command| command.get_arguments().any(|option| list(&option));
    let lists: Vec<_> = tool.get_subcommands().filter(has).map(Command::get_name).collect();
    let option = tool.get_subcommands().flat_map(Command::get_arguments).find(list).and_then(Arg::get_long);
    match option {
        _ if !value.contains([',', ':']) => Vec::new(),
        Some(option) => vec![format!("a list is for {}, by '--{option}'", listed(&lists))],
        None => of_study(command, name),
    }
}

/// For several values of an option of a solve that is no list.
fn of_study(command: &Command, name: &str) -> Vec<String> {
    let is_single = |key: &Key| !matches!(key.kind.values, Values::Quantities(..) | Values::Numbers(_));
    let has_cases = find(command, "heights").is_some() && key_of(command.get_name(), name).is_some_and(is_single);
    let hint =
        || format!("several values are for 'asperity study', by {name} = \"FROM:TO:COUNT\" in its section [vary]");
    has_cases.then(hint).into_iter().collect()
}

fn of_scene(file: &str) -> String {
    format!("a scene is run by 'asperity run {file}', a study by 'asperity study {file}'")
}

fn key_of(command: &str, name: &str) -> Option<&'static Key> {
    named(command).ok()?.keys().find(|key| key.dashed() == name)
}

fn find<'a>(command: &'a Command, name: &str) -> Option<&'a Arg> {
    command.get_arguments().find(|option| option.get_long() == Some(name))
}

/// The argument before the one that begins with a word.
fn before<'a>(arguments: &'a [OsString], word: &str) -> &'a str {
    let pair = arguments.windows(2).find(|pair| pair[1].to_str().is_some_and(|next| next.starts_with(word)));
    pair.and_then(|pair| pair[0].to_str()).unwrap_or_default()
}

/// Whether a name is the plural of another name.
fn is_plural(name: &str, one: &str) -> bool {
    name.len() > one.len() && is_same(name, one)
}

fn is_option(word: &str) -> bool {
    word.starts_with('-') && !is_number(word)
}

/// Whether a word begins as a number does.
fn is_number(word: &str) -> bool {
    word.trim_start_matches(['+', '-', '.']).starts_with(|first: char| first.is_ascii_digit())
}

/// Names with commas between, and the last one after "and".
fn listed(names: &[&str]) -> String {
    match names {
        [names @ .., last] if !names.is_empty() => format!("{} and {last}", names.join(", ")),
        names => names.concat(),
    }
}
