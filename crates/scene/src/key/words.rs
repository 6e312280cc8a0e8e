//! The words of the skins, in which sentences have the names of keys.

/// A skin, which has names of its own for the keys of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Skin {
    /// The program: keys are options.
    Options,
    /// The Python package: keys are keywords.
    Keywords,
}

/// The keywords with other names than their options.
const KEYWORDS: [(&str, &str); 2] = [("initial_gap", "start"), ("hardness_map", "hardness")];

/// A text with the names of a skin in the place of the keys in braces: `{mean_gap}` is `--mean-gap` or `mean_gap`, with
/// a value `{precision=f64}` is `--precision f64` or `precision='f64'`, a switch `{whole=}` is `--whole` or
/// `whole=True`, and of a command `{cycle:mean_gaps}` is `asperity cycle --mean-gaps` or
/// `asperity.cycle(mean_gaps=...)`.
pub fn worded(text: &str, skin: Skin) -> String {
    // between two braces, every other piece
    let pieces = text.split(['{', '}']).enumerate();
    pieces.map(|(k, piece)| if k % 2 == 0 { piece.to_owned() } else { named(piece, skin) }).collect()
}

/// A key in the words of a skin.
fn named(key: &str, skin: Skin) -> String {
    let (command, key) = key.split_once(':').map_or((None, key), |(command, key)| (Some(command), key));
    let (key, value) = key.split_once('=').map_or((key, None), |(key, value)| (key, Some(value)));
    let keyword = KEYWORDS.iter().find(|(option, _)| *option == key).map_or(key, |(_, keyword)| keyword);
    let option = key.replace('_', "-");
    match (skin, command, value) {
        (Skin::Options, Some(command), _) => format!("asperity {command} --{option}"),
        (Skin::Options, None, Some(value)) => format!("--{option} {value}").trim_end().to_owned(),
        (Skin::Options, None, None) => format!("--{option}"),
        (Skin::Keywords, Some(command), Some("")) => format!("asperity.{command}({keyword}=True)"),
        (Skin::Keywords, Some(command), _) => format!("asperity.{command}({keyword}=...)"),
        (Skin::Keywords, None, Some("")) => format!("{keyword}=True"),
        (Skin::Keywords, None, Some(value)) => format!("{keyword}='{value}'"),
        (Skin::Keywords, None, None) => keyword.to_owned(),
    }
}
