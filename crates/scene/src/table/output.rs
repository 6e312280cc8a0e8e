//! The output file of a command, which appears when it is complete.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::{fs, io};

use asperity::Error;
use asperity_maps::io::OutputFolder;

use crate::outcome::Outcome;

/// The folder `path` for files with these `names`. A file that exists is refused unless `force` replaces it.
pub fn output_folder(path: &Path, names: &[&str], force: bool) -> Outcome<OutputFolder> {
    Ok(OutputFolder::create(path, names, force).map_err(with_remedy)?)
}

/// Puts the files of a folder in their places. One that has come to be there meanwhile is refused as by
/// [`output_folder`].
pub fn commit(folder: OutputFolder) -> asperity::Result<()> {
    folder.commit().map_err(with_remedy)
}

/// The error of a folder, with the option that replaces a file that exists.
fn with_remedy(error: Error) -> Error {
    match error {
        Error::File { path, reason, .. } if reason.starts_with("exists:") => refuse_existing(&path, "output folder"),
        other => other,
    }
}

fn refuse_existing(path: &Path, other: &str) -> Error {
    Error::file(path, format!("exists: use --force to replace it, or choose another {other}"))
}

/// Refuses a file that exists, unless it may be replaced; `other` names what else may be chosen.
pub fn check_free(path: &Path, replaceable: bool, other: &str) -> Outcome<()> {
    match path.exists() && !replaceable {
        true => Err(refuse_existing(path, other).into()),
        false => Ok(()),
    }
}

/// Refuses an output that is one of the files that a command reads.
pub fn check_apart<'a>(out: &Path, read: impl IntoIterator<Item = &'a Path>) -> Outcome<()> {
    match read.into_iter().any(|read| resolved(&absolute(read)) == resolved(&absolute(out))) {
        true => Err(Error::file(out, "is read by this run, which would replace it: choose another name").into()),
        false => Ok(()),
    }
}

/// A path from the root.
pub fn absolute(path: &Path) -> PathBuf {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// A path without links and dots, as far as it exists.
pub fn resolved(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => resolved(parent).join(name),
        _ => path.to_owned(),
    })
}

/// A single file that appears complete or not at all.
pub struct OutputFile {
    folder: OutputFolder,
    parent: PathBuf,
    name: String,
}

impl OutputFile {
    /// Prepares a file at `path`, which with `force` may replace one that is there.
    pub fn create(path: &Path, force: bool) -> Outcome<Self> {
        let parent = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| Error::file(path, "is no name for a file: choose another"))?;
        let folder = output_folder(parent, &[name], force)?;
        Ok(Self { folder, parent: parent.to_owned(), name: name.to_owned() })
    }

    /// Writes the file by `write`, which gets the path of a temporary one.
    pub fn write(&self, write: impl FnOnce(&Path) -> asperity::Result<()>) -> asperity::Result<()> {
        write(&self.folder.path(&self.name)).map_err(|error| at_destination(error, &self.parent))
    }

    /// Puts the file in its place.
    pub fn commit(self) -> asperity::Result<()> {
        commit(self.folder)
    }

    /// Writes the file, and puts it in its place.
    pub fn complete(self, write: impl FnOnce(&Path) -> asperity::Result<()>) -> asperity::Result<()> {
        self.write(write)?;
        self.commit()
    }

    /// Puts `files` in their places, and then this one, which stands for all of them: a file of its name goes before,
    /// so that it is never next to files of another run.
    pub fn commit_after(self, files: impl IntoIterator<Item = Self>) -> asperity::Result<()> {
        let place = self.parent.join(&self.name);
        match fs::remove_file(&place) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(Error::file(&place, format!("cannot be replaced: {error}")));
            }
            _ => {}
        }
        files.into_iter().try_for_each(Self::commit)?;
        self.commit()
    }
}

/// Writes a text, or says where it could not be written.
pub fn write_text(path: &Path, text: &str) -> asperity::Result<()> {
    fs::write(path, text).map_err(|e| Error::unwritable(path, e))
}

/// The error of a hidden temporary file as an error of the file in its destination `folder`.
pub fn at_destination(error: Error, folder: &Path) -> Error {
    match error {
        Error::File { path, reason, cause } => {
            let path = path.file_name().map_or_else(|| folder.to_owned(), |name| folder.join(name));
            Error::File { path, reason, cause }
        }
        other => other,
    }
}

/// The path of a file next to another, with a longer name.
pub fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(suffix);
    name.into()
}
