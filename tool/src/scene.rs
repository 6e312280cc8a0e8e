//! The scene of a run: its options, its quantities, and the file that repeats it. (`run.rs` reads such files.)

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

use asperity::Error;
use asperity_scene::output::{OutputFile, absolute, check_free, resolved, with_suffix, write_text};
use asperity_scene::{Entries, Key, Keys, Outcome, Values};
use toml::Value;

/// A run as a scene file that repeats it: every option that was given or has a default.
#[derive(Clone)]
pub struct SceneFile {
    pub command: &'static str,
    pub given: Entries,
}

/// The beginning of the file. A file with another beginning is not replaced.
const FIRST: &str = "# Written by asperity ";

/// Options without influence on the results.
const LEFT_OUT: [&str; 3] = ["force", "quiet", "json"];

/// The name of the scene in a folder of results.
pub const NAME: &str = "scene.toml";

impl SceneFile {
    /// What is given for a list of keys.
    pub fn keys<L: Keys>(&self) -> L {
        self.given.keys()
    }

    /// Whether quantities have units; then all numbers are in SI units.
    pub fn is_si(&self) -> bool {
        self.given.quantities().is_si()
    }

    /// The quantities as they were typed, by the names of reports; nothing if none has a unit.
    pub fn quantities(&self) -> Option<serde_json::Value> {
        self.given.quantities().texts()
    }

    /// The scene file, to be put into `folder`.
    pub fn text(&self, folder: &Path) -> String {
        let mut text = format!(
            "{FIRST}{}; `asperity run FILE` repeats the run\ncommand = \"{}\"\n",
            env!("CARGO_PKG_VERSION"),
            self.command
        );
        let mut known = HashSet::new();
        for section in self.entries().map(|(key, _)| key.section).filter(|section| known.insert(*section)) {
            if !section.is_empty() {
                text.push_str(&format!("\n[{}]\n", section.to_lowercase()));
            }
            for (key, typed) in self.entries().filter(|(key, _)| key.section == section) {
                text.push_str(&format!("{} = {}\n", key.dashed(), value(key, typed, folder)));
            }
        }
        text
    }

    /// What is given and has an influence on the results, keys without a section first.
    fn entries(&self) -> impl Iterator<Item = (&'static Key, &[OsString])> {
        let (first, rest): (Vec<_>, Vec<_>) = self.given.entries().partition(|(key, _)| key.section.is_empty());
        first.into_iter().chain(rest).filter(|(key, _)| !LEFT_OUT.contains(&key.name))
    }

    /// Refuses to replace a file at `path` that was not written as a scene, and names of files that a scene there
    /// cannot have.
    pub fn check(&self, path: &Path) -> Outcome<()> {
        let files = self.entries().filter(|(key, _)| matches!(key.kind.values, Values::File));
        for name in files.flat_map(|(_, typed)| typed).map(Path::new) {
            if seen_from(name, folder_of(path)).to_str().is_none() {
                let reason = "is no name in UTF-8, which the scene of this run could not have: rename it";
                return Err(Error::file(name, reason).into());
            }
        }
        match fs::read_to_string(path) {
            Ok(text) if !text.starts_with(FIRST) => {
                let reason = "was not written by asperity, and would be replaced by the scene of this run: rename it, or choose another --out";
                Err(Error::file(path, reason).into())
            }
            _ => Ok(()),
        }
    }

    /// Refuses a `file` next to which there is the scene of another run, unless `force` replaces it, or a file that was
    /// not written as a scene.
    pub fn check_next_to(&self, file: &Path, force: bool) -> Outcome<()> {
        let path = path_for(file);
        self.check(&path)?;
        // whatever version has written it
        let rest = |text: &str| text.split_once('\n').map(|(_, rest)| rest.to_owned());
        let same = fs::read_to_string(&path).is_ok_and(|text| rest(&text) == rest(&self.text(folder_of(file))));
        check_free(&path, force || same, "--out")
    }

    /// The file FILE.scene.toml next to `file`, written but for its name.
    pub fn write_next_to(&self, file: &Path) -> Outcome<OutputFile> {
        let scene = OutputFile::create(&path_for(file), true)?;
        scene.write(|path| write_text(path, &self.text(folder_of(file))))?;
        Ok(scene)
    }
}

/// The path of the scene next to a file.
pub fn path_for(file: &Path) -> PathBuf {
    with_suffix(file, &format!(".{NAME}"))
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The texts of a key as the value of an entry.
fn value(key: &Key, typed: &[OsString], folder: &Path) -> String {
    let value = |text: &OsString| {
        let (path, raw) = (Path::new(text), text.to_string_lossy());
        // a number in the digits of Rust, and everything else in quotation marks; TOML has no larger integers
        let number = match key.kind.values {
            Values::Switch => return "true".to_owned(),
            Values::File => return Value::from(seen_from(path, folder).to_string_lossy().into_owned()).to_string(),
            Values::Quantity(..) | Values::Number(_) => {
                raw.trim().parse::<f64>().ok().map(|number| format!("{number:?}"))
            }
            Values::Whole(..) => raw.trim().parse::<i64>().ok().map(|number| number.to_string()),
            _ => None,
        };
        number.unwrap_or_else(|| Value::from(&*raw).to_string())
    };
    let values: Vec<_> = typed.iter().map(value).collect();
    if values.len() == 1 { values.concat() } else { format!("[{}]", values.join(", ")) }
}

/// A path relative to the working folder as one relative to `folder`, which need not exist. Absolute paths remain.
fn seen_from(path: &Path, folder: &Path) -> PathBuf {
    if path.is_absolute() {
        return path.to_owned();
    }
    let (path, folder) = (absolute(path), resolved(&absolute(folder)));
    // a link to a file stays a link
    let path = match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if !path.is_dir() => resolved(parent).join(name),
        _ => resolved(&path),
    };
    let (mut path, mut folder) = (path.components().peekable(), folder.components().peekable());
    while path.peek().is_some() && path.peek() == folder.peek() {
        path.next();
        folder.next();
    }
    let up = folder.map(|_| Component::ParentDir);
    let steps: PathBuf = up.chain(path).collect();
    if steps.as_os_str().is_empty() { ".".into() } else { steps }
}
