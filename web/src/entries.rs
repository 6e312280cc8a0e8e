//! What a user has typed into the fields of the page, by their keys.

use asperity_scene::{Entries, Input, Key, Outcome, Skin, worded};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Reads an object of `known` keys and values; empty values count as not given.
///
/// # Errors
/// The key and the remedy, if it is not known or a value is none for it, and if some quantities have units and others
/// have none.
pub fn read(json: &str, lists: &[&'static [Key]]) -> Outcome<Entries> {
    let typed: Map<String, Value> = serde_json::from_str(json)?;
    let of = |(key, value): (String, Value)| match Input::deserialize(&value) {
        Ok(typed) => Ok((key, typed)),
        Err(_) => Err(format!("{key} is {value}: it must be a number, a text, a truth value, or several")),
    };
    let typed = typed.into_iter().filter(|(_, value)| !value.is_null()).map(of).collect::<Result<Vec<_>, _>>()?;
    let given = Entries::read(lists, typed).map_err(reason)?;
    given.quantities().check(Skin::Keywords)?;
    Ok(given)
}

/// A reason in the words of the page, which are Python's.
pub fn reason(text: impl AsRef<str>) -> String {
    worded(text.as_ref(), Skin::Keywords)
}
