//! The channels of a file, and the choice of one.

use super::{Parsed, quoted, refuse};

/// The most channels that a message names.
const MOST_NAMES: usize = 10;

/// A channel of a file.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The number.
    pub number: usize,
    /// The title; empty if it has none.
    pub title: String,
    /// Whether heights and sides both are in units of length, as far as they have units.
    pub is_of_heights: bool,
}

impl Channel {
    pub(super) fn name(&self) -> String {
        let Self { number, title, .. } = self;
        if title.is_empty() { number.to_string() } else { format!("{number} {}", quoted(title)) }
    }
}

/// The place of the channel with a number or title, or of the only candidate.
pub(super) fn chosen(channels: &[Channel], asked: Option<&str>) -> Parsed<usize> {
    let places = |fits: &dyn Fn(&Channel) -> bool| -> Vec<usize> {
        channels.iter().enumerate().filter(|(_, channel)| fits(channel)).map(|(place, _)| place).collect()
    };
    let fits = match asked {
        Some(asked) => {
            let numbered = places(&|channel| asked.parse() == Ok(channel.number));
            if numbered.is_empty() { places(&|channel| channel.title == asked) } else { numbered }
        }
        None if channels.len() == 1 => vec![0],
        None => places(&|channel| channel.is_of_heights),
    };
    let names: Vec<_> = channels.iter().take(MOST_NAMES).map(Channel::name).collect();
    let more = if channels.len() > MOST_NAMES { ", ..." } else { "" };
    let found = format!("{} channels ({}{more})", channels.len(), names.join(", "));
    match (&fits[..], asked) {
        (&[place], _) => Ok(place),
        (_, None) if channels.is_empty() => refuse("holds no channel of heights: save one in it"),
        ([], Some(asked)) => refuse(format!("holds {found}, but no {}: name one of these", quoted(asked))),
        (_, Some(asked)) => refuse(format!("holds {found}, several named {}: give a number", quoted(asked))),
        (_, None) => refuse(format!(
            "holds {found}, {} of them of heights: choose one, by asperity prepare --channel NUMBER",
            fits.len()
        )),
    }
}

/// The names of the channels besides one.
pub(super) fn others(channels: &[Channel], chosen: usize) -> Vec<String> {
    channels.iter().enumerate().filter(|(place, _)| *place != chosen).map(|(_, channel)| channel.name()).collect()
}
