//! The keys as options of the program.

use std::ffi::OsString;
use std::marker::PhantomData;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};

use crate::key::list::list;
use crate::key::{Given, Key, Lists, Quantity, Read, Skin, Values, Word, worded};

impl Key {
    /// The option of the key.
    pub fn option(&self) -> Arg {
        let kind = &self.kind;
        let help = worded(self.help.trim(), Skin::Options);
        let arg = Arg::new(self.name).long(self.dashed()).help(help).help_heading(self.section);
        let arg = arg.conflicts_with_all(kind.excludes.iter().copied()).overrides_with_all(kind.replaces);
        let arg = kind.needs.iter().fold(arg, |arg, key| arg.requires(*key)).required(kind.required);
        if let Values::Switch = kind.values {
            return arg.action(ArgAction::SetTrue);
        }
        let arg = arg.value_names(kind.symbols.iter().copied()).value_parser(self.parser());
        let arg = arg.action(if kind.is_several() { ArgAction::Append } else { ArgAction::Set });
        let (least, most) = kind.count;
        let arg = if (least, most) == (1, 1) { arg } else { arg.num_args(least..=most) };
        let arg = if kind.commas { arg.value_delimiter(',') } else { arg };
        let arg = kind.default.into_iter().fold(arg, |arg, default| arg.default_value(default));
        let arg = kind.alone.into_iter().fold(arg, |arg, alone| arg.default_missing_value(alone));
        match kind.values {
            Values::Word(_) => arg.ignore_case(true),
            Values::File => arg,
            _ if kind.count == (1, 1) && !kind.commas => arg.allow_hyphen_values(true),
            _ => arg.allow_negative_numbers(true),
        }
    }

    /// The parser of one value.
    fn parser(&self) -> ValueParser {
        match self.kind.values {
            Values::Quantity(dimension, range) => ValueParser::new(dimension.within(range)),
            Values::Number(range) => ValueParser::new(move |text: &str| range.number(text)),
            Values::Whole(from, to, words) => ValueParser::new(move |text: &str| super::whole(text, from..=to, words)),
            Values::Switch => ValueParser::bool(),
            Values::Word(words) => {
                let value = |Word { name, help }| {
                    let value = PossibleValue::new(name);
                    if help.is_empty() { value } else { value.help(help.trim()) }
                };
                let named = move |typed: String| {
                    let name = words().into_iter().map(|word| word.name).find(|name| name.eq_ignore_ascii_case(&typed));
                    name.map_or(typed, str::to_owned)
                };
                PossibleValuesParser::new(words().into_iter().map(value)).map(named).into()
            }
            Values::Text(check) => ValueParser::new(move |text: &str| check(text).map(|()| text.to_owned())),
            Values::File => clap::value_parser!(PathBuf),
            Values::Quantities(dimension, range) => ValueParser::new(list(dimension.within(range))),
            Values::Numbers(range) => {
                ValueParser::new(list(move |text: &str| range.number(text).map(Quantity::number)))
            }
        }
    }
}

/// The options of lists of keys, with what they are given.
#[derive(Clone, Debug)]
pub struct Chosen<L>(pub Given, PhantomData<L>);

impl<L: Lists> FromArgMatches for Chosen<L> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Ok(Self(given(L::keys(), matches), PhantomData))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl<L: Lists> Args for Chosen<L> {
    fn augment_args(command: Command) -> Command {
        command.args(L::keys().map(Key::option))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// What the options of some keys are given.
fn given(keys: impl Iterator<Item = &'static Key>, matches: &ArgMatches) -> Given {
    let mut given = Given::default();
    for key in keys {
        let id = key.name;
        let Some(source) = matches.value_source(id) else { continue };
        let is_default = source == ValueSource::DefaultValue;
        if let Values::Switch = key.kind.values {
            if matches.get_flag(id) {
                given.insert(key, vec![Read::of(true)], Vec::new(), is_default);
            }
            continue;
        }
        let typed: Vec<OsString> = matches.get_raw(id).into_iter().flatten().map(ToOwned::to_owned).collect();
        // the parser of the option has taken them
        let values = typed.iter().filter_map(|text| key.value(&text.to_string_lossy()).ok()).collect();
        given.insert(key, values, typed, is_default);
    }
    given
}
