//! The lines that repeat what a page has done, in a shell and in Python, and the scene of the program.

use asperity_scene::{Elastic, GridKeys, Key, Keys, RoughnessKeys, key};
use serde_json::{Map, Value};

/// The file of the surface.
const HEIGHTS: &str = "heights.npz";
/// The file of a made surface before steps of preparation.
const MADE: &str = "made.npz";
/// The file of the gap from which a solve with adhesion started.
pub const START: &str = "start.npz";

/// Keys and values as they were typed.
type KeyValues = Map<String, Value>;

/// Where a surface comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// The map.
    pub source: Source,
    /// The steps of its preparation, if there were any.
    pub steps: Option<KeyValues>,
}

/// Where a map comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A file.
    Opened {
        /// The name of the file.
        name: String,
        /// How it is read, where that was chosen: its channel, and whether masked points are missing.
        reading: KeyValues,
    },
    /// The keys of a made surface.
    Made(KeyValues),
}

impl Default for Source {
    fn default() -> Self {
        Self::Made(KeyValues::new())
    }
}

impl Origin {
    /// The name of the file of the surface.
    pub fn name(&self) -> &str {
        match (&self.source, &self.steps) {
            (Source::Opened { name, reading }, None) if reading.is_empty() => name,
            _ => HEIGHTS,
        }
    }

    /// The commands that make the surface and solve on it.
    pub fn shell(&self, typed: &KeyValues, started: bool) -> Vec<String> {
        let mut lines = Vec::new();
        let prepared = self.steps.is_some();
        let map = match &self.source {
            Source::Made(typed) => {
                let out = if prepared { MADE } else { HEIGHTS };
                lines.push(format!("asperity surface{} --out {out}", options(typed)));
                out
            }
            Source::Opened { name, .. } => name,
        };
        if self.name() == HEIGHTS && map != HEIGHTS {
            let reading = match &self.source {
                Source::Opened { reading, .. } => options(reading),
                Source::Made(_) => String::new(),
            };
            let steps = self.steps.as_ref().map(options).unwrap_or_default();
            lines.push(format!("asperity prepare {}{reading}{steps} --out {HEIGHTS}", word(map)));
        }
        let start = if started { format!(" --initial-gap {START}") } else { String::new() };
        let heights = word(self.name());
        lines.push(format!("asperity solve --heights {heights}{}{start} --out results", options(typed)));
        lines
    }

    /// The same in Python.
    pub fn python(&self, typed: &KeyValues, started: bool) -> String {
        let mut lines = vec!["import asperity".to_owned(), String::new()];
        let mut heights = match &self.source {
            Source::Made(typed) => {
                lines.extend(made(typed));
                "surface".to_owned()
            }
            Source::Opened { name, reading } if reading.is_empty() => quoted(name),
            Source::Opened { name, reading } => {
                lines.push(format!("surface = asperity.read({}, {})", quoted(name), keywords(reading.iter())));
                "surface".to_owned()
            }
        };
        if let Some(steps) = &self.steps {
            lines.push(format!("surface = asperity.prepare({heights}, {})", keywords(steps.iter())));
            "surface".clone_into(&mut heights);
        }
        let mut rest: Vec<String> = Vec::new();
        if started {
            lines.insert(1, "import numpy".to_owned());
            rest.push(format!("start=numpy.load({})[\"heights\"]", quoted(START)));
        }
        if !typed.contains_key(key!(Elastic, modulus)) {
            rest.push("modulus=1.0".to_owned());
        }
        let given = keywords(typed.iter());
        let all: Vec<_> = [given].into_iter().filter(|text| !text.is_empty()).chain(rest).collect();
        lines.push(format!("solution = asperity.solve({heights}, {})", all.join(", ")));
        lines.push("solution".to_owned());
        lines.join("\n") + "\n"
    }
}

/// The lines that make a surface in Python.
fn made(typed: &KeyValues) -> Vec<String> {
    let form = typed.get("form").and_then(Value::as_str).unwrap_or("self-affine").replace('-', "_");
    let shape = match (typed.get("size"), typed.get("shape")) {
        (Some(size), _) => python(size),
        (_, shape) => shape.map(python).unwrap_or_default(),
    };
    let lengths = typed.get("lengths").map_or("(1.0, 1.0)".to_owned(), python);
    let is_of = |keys: &[Key], name: &str| keys.iter().any(|key| key.name == name);
    let of = |wanted: bool| {
        let of_rough = move |(name, _): &(&String, &Value)| {
            *name != "form" && !is_of(GridKeys::KEYS, name) && is_of(RoughnessKeys::KEYS, name) == wanted
        };
        keywords(typed.iter().filter(of_rough))
    };
    let join = |texts: &[&str]| texts.iter().filter(|text| !text.is_empty()).copied().collect::<Vec<_>>().join(", ");
    let roughened = typed.contains_key("rms_height") || typed.contains_key("rms_slope");
    if form == "self_affine" {
        return vec![format!(
            "surface = asperity.surface.self_affine({})",
            join(&[&shape, &lengths, &of(true), &of(false)])
        )];
    }
    let body = format!("asperity.surface.{form}({})", join(&[&shape, &lengths, &of(false)]));
    if !roughened {
        return vec![format!("surface = {body}")];
    }
    vec![
        format!("body = {body}"),
        format!("rough = asperity.surface.self_affine({})", join(&[&shape, &lengths, &of(true)])),
        "surface = asperity.Topography(body.heights + rough.heights, body.lengths, unit=body.unit)".to_owned(),
    ]
}

/// The options of a command.
fn options(typed: &KeyValues) -> String {
    let option = |(key, value): (&String, &Value)| {
        let name = key.replace('_', "-");
        match value {
            Value::Bool(_) => format!(" --{name}"),
            Value::Array(items) if key == "missing" => {
                let codes: Vec<_> = items.iter().filter_map(Value::as_str).collect();
                format!(" --{name}={}", codes.join(","))
            }
            Value::Array(items) => {
                let words: Vec<_> = items.iter().filter_map(Value::as_str).map(word).collect();
                format!(" --{name} {}", words.join(" "))
            }
            other => {
                let text = word(other.as_str().unwrap_or_default());
                if text.starts_with('-') { format!(" --{name}={text}") } else { format!(" --{name} {text}") }
            }
        }
    };
    typed.iter().map(option).collect()
}

/// A word for a shell.
fn word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./:=+-,".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

/// Keywords with their values.
fn keywords<'a>(typed: impl Iterator<Item = (&'a String, &'a Value)>) -> String {
    let given = typed.map(|(key, value)| format!("{key}={}", python(value)));
    given.collect::<Vec<_>>().join(", ")
}

/// A value in Python.
fn python(value: &Value) -> String {
    match value {
        Value::Array(items) => {
            let items: Vec<_> = items.iter().map(python).collect();
            if items.len() == 1 { items.concat() } else { format!("({})", items.join(", ")) }
        }
        Value::String(text) if text.parse::<f64>().is_ok() => text.clone(),
        Value::String(text) => quoted(text),
        _ => "True".to_owned(),
    }
}

/// A text in quotation marks, as Python and TOML have it.
fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

/// The scene of a solve on the file of the surface, for `asperity run`.
pub fn scene(typed: &KeyValues, started: bool) -> String {
    let mut text = format!(
        "# Written by asperity {}; `asperity run FILE` repeats the run\ncommand = \"solve\"\nheights = \"{HEIGHTS}\"\n",
        env!("CARGO_PKG_VERSION")
    );
    let one = |value: &Value| match value {
        Value::String(text) if text.parse::<i64>().is_ok() => text.clone(),
        Value::String(text) => match text.parse::<f64>() {
            Ok(number) => format!("{number:?}"),
            Err(_) => quoted(text),
        },
        _ => "true".to_owned(),
    };
    for (key, value) in typed {
        let value = match value {
            Value::Array(items) => format!("[{}]", items.iter().map(one).collect::<Vec<_>>().join(", ")),
            other => one(other),
        };
        text.push_str(&format!("{} = {value}\n", key.replace('_', "-")));
    }
    if started {
        text.push_str(&format!("initial-gap = \"{START}\"\n"));
    }
    text + "out = \"results\"\n"
}
