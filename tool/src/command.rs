//! A command of the program: its name, its help, the lists of its options, and its work.

use asperity_scene::{Entries, Key, Outcome, Processes};
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Arg, ArgGroup};

use crate::options::ProblemOptions;
use crate::results::OF_FOLDER;
use crate::scene::SceneFile;

/// What a command may be part of.
#[derive(Clone, Copy, PartialEq)]
pub enum Place {
    /// A run of several processes
    Processes,
    /// A scene
    Scene,
    /// A study, as its cases
    Study,
}

/// The call of a command: the scene that repeats it, and the processes that run it.
#[derive(Clone, Copy)]
pub struct Call<'a> {
    pub scene: &'a SceneFile,
    pub processes: &'a Processes,
}

/// A command.
pub struct Command {
    pub name: &'static str,
    /// The help, with examples
    pub help: &'static str,
    /// The lists of its options, in the order of the help
    pub lists: &'static [&'static [Key]],
    /// What it may be part of
    pub places: &'static [Place],
    /// The work; whether all converged
    pub run: fn(&Call<'_>) -> Outcome<bool>,
    /// The problem of what is given
    pub problem: fn(&Entries) -> Outcome<ProblemOptions>,
    /// Keys of which one has to be given, and no other one
    pub one_of: fn() -> Vec<&'static str>,
    /// Whether all files are in one folder, which options of these files need
    pub has_folder: bool,
}

/// The name of the group of the keys of which one has to be given.
const ONE: &str = "one";

impl Command {
    /// The keys of the options.
    pub fn keys(&self) -> impl Iterator<Item = &'static Key> {
        self.lists.iter().copied().flatten()
    }

    /// The parser of the options.
    pub fn parser(&self) -> clap::Command {
        let parser = help(clap::Command::new(self.name), self.help).args(self.keys().map(Key::option));
        let one = (self.one_of)();
        if one.is_empty() { parser } else { parser.group(ArgGroup::new(ONE).required(true).args(one)) }
    }

    /// The parser of options next to a scene, which has all that is required.
    pub fn beside_scene(&self, parser: clap::Command) -> clap::Command {
        let parser = parser.mut_args(|arg| arg.required(false));
        let has_one = !(self.one_of)().is_empty();
        if has_one { parser.mut_group(ONE, |group| group.required(false)) } else { parser }
    }

    /// Refuses keys that exclude each other, and keys without what they need, in the words of the parser.
    pub fn check(&self, given: &Entries, parser: &clap::Command) -> Result<(), Error> {
        let option = |name: &str| parser.get_arguments().find(|arg| arg.get_id() == name).map(Arg::to_string);
        let any = |keys: Vec<&str>| format!("<{}>", keys.into_iter().filter_map(option).collect::<Vec<_>>().join("|"));
        let has = |name: &&str| given.entries().any(|(key, _)| key.name == *name);
        let one_of = (self.one_of)();
        let mut missing = Vec::new();
        for key in self.keys() {
            if !given.has(key.name) {
                missing.extend(option(key.name).filter(|_| key.kind.required && !has(&key.name)));
                continue;
            }
            let others = self.keys().map(|other| other.name).filter(|other| *other != key.name && given.has(other));
            let is_choice = one_of.contains(&key.name);
            let excludes = |other: &&str| key.kind.excludes.contains(other) || is_choice && one_of.contains(other);
            if let Some((one, other)) = option(key.name).zip(others.filter(excludes).find_map(option)) {
                let context = [(ContextKind::InvalidArg, one), (ContextKind::PriorArg, other)];
                let context = context.map(|(kind, option)| (kind, ContextValue::String(option)));
                return Err(mistake(ErrorKind::ArgumentConflict, parser, context));
            }
            let folder = (self.has_folder && OF_FOLDER.contains(&key.name)).then_some("out");
            for need in key.kind.needs.iter().copied().chain(folder) {
                // one of several
                let needs: Vec<_> = need.split('|').collect();
                if !needs.iter().any(has) {
                    let known: Vec<_> = needs.into_iter().filter_map(option).collect();
                    missing.extend(match known.len() {
                        0 | 1 => known,
                        _ => vec![format!("<{}>", known.join("|"))],
                    });
                }
            }
        }
        if !one_of.is_empty() && !one_of.iter().any(has) {
            missing.push(any(one_of));
        }
        match missing.is_empty() {
            true => Ok(()),
            false => {
                let context = [(ContextKind::InvalidArg, ContextValue::Strings(missing))];
                Err(mistake(ErrorKind::MissingRequiredArgument, parser, context))
            }
        }
    }
}

/// A mistake in the words of a parser.
pub fn mistake(
    kind: ErrorKind,
    parser: &clap::Command,
    context: impl IntoIterator<Item = (ContextKind, ContextValue)>,
) -> Error {
    let mut mistake = Error::new(kind).with_cmd(parser);
    for (kind, value) in context {
        mistake.insert(kind, value);
    }
    mistake
}

/// A parser with the help of a text: its paragraphs, and behind the first heading lines as they are.
pub fn help(parser: clap::Command, text: &str) -> clap::Command {
    let (about, more) = text.split_once("\n #").unwrap_or((text, ""));
    let lines: Vec<_> = about.lines().map(str::trim).collect();
    let paragraphs: Vec<_> = lines.split(|line| line.is_empty()).map(|lines| lines.join(" ")).collect();
    let examples = format!("#{more}");
    let examples = examples.lines().map(|line| match line.trim_start().strip_prefix("# ") {
        Some(heading) => format!("\u{1b}[1;4m{heading}:\u{1b}[0m\n"),
        None => format!("{}\n", line.strip_prefix(' ').unwrap_or(line)),
    });
    let (about, examples) = (paragraphs.join("\n\n").trim().to_owned(), examples.collect::<String>());
    let short = paragraphs[0].trim_end_matches('.').to_owned();
    parser.about(short).long_about(about).after_help(examples.trim_end().to_owned())
}
