//! The outcome of whatever a command does.

use std::error::Error;

use asperity_scene::{Skin, worded};

/// A value, or an error of one line that names the cause and the remedy.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// A value, or the reason why there is none, in the words of options.
pub fn in_options<V>(found: Result<V, String>) -> Outcome<V> {
    Ok(found.map_err(|text| worded(&text, Skin::Options))?)
}
