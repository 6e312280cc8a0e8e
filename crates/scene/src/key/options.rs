//! The keys as options of the program.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, ValueHint};

use crate::key::{Entries, Key, Skin, Values, Word, worded};

impl Key {
    /// The option of the key.
    pub fn option(&'static self) -> Arg {
        let kind = &self.kind;
        let help = worded(self.help.trim(), Skin::Options);
        let arg = Arg::new(self.name).help(help).required(kind.required).overrides_with_all(kind.replaces);
        let arg = if kind.positional {
            arg
        } else {
            arg.long(self.dashed()).help_heading((!self.section.is_empty()).then_some(self.section))
        };
        if let Values::Switch = kind.values {
            return arg.action(ArgAction::SetTrue);
        }
        let arg = arg.value_names(kind.symbols.iter().copied()).value_parser(self.parser());
        let arg = arg.action(if kind.is_several() { ArgAction::Append } else { ArgAction::Set });
        let (least, most) = (kind.count.0, kind.count.1.min(kind.symbols.len()));
        let arg = if (least, most) == (1, 1) { arg } else { arg.num_args(least..=most) };
        let arg = if kind.commas { arg.value_delimiter(',') } else { arg };
        let arg = kind.default.into_iter().fold(arg, |arg, default| arg.default_value(default));
        let arg = kind.alone.into_iter().fold(arg, |arg, alone| arg.default_missing_value(alone));
        match kind.values {
            Values::Word(_) => arg.ignore_case(true),
            Values::File if kind.symbols == ["DIR"] => arg.value_hint(ValueHint::DirPath),
            Values::File => arg,
            _ if kind.count == (1, 1) && !kind.commas => arg.allow_hyphen_values(true).value_hint(ValueHint::Other),
            _ => arg.allow_negative_numbers(true).value_hint(ValueHint::Other),
        }
    }

    /// The check of one value, which [`chosen`] reads from its text.
    fn parser(&'static self) -> ValueParser {
        match self.kind.values {
            Values::Word(words) => {
                let value = |Word { name, help }| {
                    let value = PossibleValue::new(name);
                    if help.is_empty() { value } else { value.help(help.trim()) }
                };
                PossibleValuesParser::new(words().into_iter().map(value)).into()
            }
            Values::File => clap::value_parser!(PathBuf),
            _ => ValueParser::new(|text: &str| self.value(text).map(drop)),
        }
    }
}

/// What the options of some keys are given on a command line.
pub fn chosen(keys: impl Iterator<Item = &'static Key>, matches: &ArgMatches) -> Entries {
    let mut given = Entries::default();
    for key in keys.filter(|key| matches.value_source(key.name) == Some(ValueSource::CommandLine)) {
        let typed = match key.kind.values {
            Values::Switch if !matches.get_flag(key.name) => continue,
            Values::Switch => vec!["true".into()],
            _ => matches.get_raw(key.name).into_iter().flatten().map(ToOwned::to_owned).collect(),
        };
        // the parser of the option has taken them
        let _ = given.add(key, typed, false);
    }
    given
}
