//! What a user has typed into the fields of the page, by their keys.

use asperity_scene::outcome::Outcome;
use asperity_scene::{Given, Key, Keys, Skin, Typed, Values, worded};
use serde::Deserialize;
use serde_json::{Map, Value};

/// The keys of a list, but for those of files, of which a page has none.
pub fn keys<L: Keys>() -> impl Iterator<Item = &'static Key> {
    L::KEYS.iter().filter(|key| !matches!(key.kind.values, Values::File))
}

/// Reads an object of `known` keys and values, of which those that are empty count as not given.
///
/// # Errors
/// The key and the remedy, if it is not known or a value is none for it, and if some quantities have units and others
/// have none.
pub fn read(json: &str, known: &[&'static Key]) -> Outcome<Given> {
    let typed: Map<String, Value> = serde_json::from_str(json)?;
    let typed = typed.into_iter().filter_map(|(key, typed)| Some((key, Typed::deserialize(typed).ok()?)));
    let given = Given::read(known, typed);
    let given = given.map_err(reason)?;
    given.quantities().check(Skin::Keywords)?;
    Ok(given)
}

/// A reason in the words of the page, which are those of Python.
pub fn reason(text: impl AsRef<str>) -> String {
    worded(text.as_ref(), Skin::Keywords)
}
