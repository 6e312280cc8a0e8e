//! The output folder: all files of a run, or none.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::error::{Error, Result};

/// A folder that receives the results of one run, all of them or none.
///
/// Files are written at [`path`](Self::path), in a hidden temporary folder on the file system of the
/// destination, and appear in the destination on [`commit`](Self::commit). Dropped without it, nothing stays
/// behind. A process that is killed leaves the temporary folder, `.asperity-` and a few letters.
///
/// ```
/// use asperity::io::{OutputFolder, write_npy};
/// let parent = tempfile::tempdir()?;
/// let destination = parent.path().join("results");
/// let folder = OutputFolder::create(&destination, &["gap.npy"], false)?;
/// write_npy(&folder.path("gap.npy"), &ndarray::array![[0.0, 1.0]])?;
/// assert!(!destination.exists()); // not yet
/// folder.commit()?;
/// assert!(destination.join("gap.npy").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct OutputFolder {
    destination: PathBuf,
    force: bool,
    /// In the destination, or in the nearest folder above it that exists.
    temporary: TempDir,
}

impl OutputFolder {
    /// Prepares a folder at `path`, existing or not, for files with these `names`, and creates nothing there
    /// yet. With `force` they may replace existing files; other files in the folder are left alone.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if one of the files exists and `force` is not given, if one of them is a folder, if
    /// `path` or something above it is a file, and if the folder cannot be written.
    pub fn create(path: &Path, names: &[&str], force: bool) -> Result<Self> {
        for name in names {
            refuse_existing(&path.join(name), force)?;
        }
        // Where the destination, or the first folder on the way to it, will be created.
        let existing = path.ancestors().find(|p| p.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
        if !existing.is_dir() {
            return Err(Error::file(existing, "is not a folder: choose another output folder"));
        }
        let unwritable = |e| Error::file(existing, format!("cannot be written ({e}): choose another output folder"));
        let temporary = tempfile::Builder::new().prefix(".asperity-").tempdir_in(existing).map_err(unwritable)?;
        let folder = Self { destination: path.to_owned(), force, temporary };
        // A temporary folder is private: the files go one level deeper, in a folder with the usual permissions.
        fs::create_dir(folder.files()).map_err(unwritable)?;
        Ok(folder)
    }

    /// Where to write the file called `name` until [`commit`](Self::commit).
    pub fn path(&self, name: &str) -> PathBuf {
        self.files().join(name)
    }

    /// Moves all files to the destination, which is created with its parents if needed.
    ///
    /// A destination that did not exist appears at once with all its files; in one that existed, each file
    /// appears or is replaced at once.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if the destination cannot be written, or if one of the files has been created there
    /// since [`create`](Self::create) and `force` was not given.
    pub fn commit(self) -> Result<()> {
        let destination = &self.destination;
        let unwritable = |e| Error::file(destination, format!("cannot be written: {e}"));
        if destination.symlink_metadata().is_err() {
            if let Some(parent) = destination.parent() {
                fs::create_dir_all(parent).map_err(unwritable)?;
            }
            return fs::rename(self.files(), destination).map_err(unwritable);
        }
        let entries: Vec<_> = fs::read_dir(self.files()).and_then(Iterator::collect).map_err(unwritable)?;
        // All checks come before the first change.
        for entry in &entries {
            refuse_existing(&destination.join(entry.file_name()), self.force)?;
        }
        for entry in &entries {
            fs::rename(entry.path(), destination.join(entry.file_name())).map_err(unwritable)?;
        }
        Ok(())
    }

    fn files(&self) -> PathBuf {
        self.temporary.path().join("files")
    }
}

fn refuse_existing(file: &Path, force: bool) -> Result<()> {
    match file.symlink_metadata() {
        Ok(found) if found.is_dir() => Err(Error::file(file, "is a folder: choose another output folder")),
        Ok(_) if !force => Err(Error::file(file, "exists: allow it to be replaced, or choose another output folder")),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::assert_refused;
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn output_folder_appears_on_commit() {
        let parent = tempfile::tempdir().unwrap();
        let destination = parent.path().join("new/results");
        let output = OutputFolder::create(&destination, &["a.txt", "b.txt", "unused"], false).unwrap();
        fs::write(output.path("a.txt"), "a").unwrap();
        fs::write(output.path("b.txt"), "b").unwrap();
        assert!(!parent.path().join("new").exists());
        assert!(names_in(parent.path())[0].starts_with(".asperity-"));
        output.commit().unwrap();
        assert_eq!(names_in(parent.path()), ["new"]);
        assert_eq!(names_in(&destination), ["a.txt", "b.txt"]);
        assert_eq!(fs::read_to_string(destination.join("a.txt")).unwrap(), "a");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
            assert_eq!(mode(&destination), mode(destination.parent().unwrap()), "the usual permissions");
        }
    }

    #[test]
    fn output_folder_that_exists_keeps_its_other_files() {
        let parent = tempfile::tempdir().unwrap();
        fs::write(parent.path().join("other.txt"), "other").unwrap();
        let output = OutputFolder::create(parent.path(), &["a.txt"], false).unwrap();
        fs::write(output.path("a.txt"), "a").unwrap();
        output.commit().unwrap();
        assert_eq!(names_in(parent.path()), ["a.txt", "other.txt"]);
    }

    #[test]
    fn dropped_output_folder_leaves_nothing() {
        let parent = tempfile::tempdir().unwrap();
        for destination in [parent.path().to_owned(), parent.path().join("new/results")] {
            let output = OutputFolder::create(&destination, &["a.txt"], false).unwrap();
            fs::write(output.path("a.txt"), "a").unwrap();
            drop(output);
            assert!(names_in(parent.path()).is_empty());
        }
    }

    #[test]
    fn existing_results_are_replaced_only_with_force() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("a.txt");
        fs::write(&file, "old").unwrap();
        let refused = OutputFolder::create(parent.path(), &["b.txt", "a.txt"], false);
        assert!(matches!(&refused, Err(Error::File { path, .. }) if *path == file));
        assert_refused(refused, &["exists", "allow it to be replaced"]);
        assert_eq!(names_in(parent.path()), ["a.txt"]);

        let output = OutputFolder::create(parent.path(), &["a.txt"], true).unwrap();
        fs::write(output.path("a.txt"), "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
        output.commit().unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");

        fs::create_dir(parent.path().join("sub")).unwrap();
        assert_refused(OutputFolder::create(parent.path(), &["sub"], true), &["is a folder"]);
    }

    #[test]
    fn results_of_another_run_meanwhile_are_kept() {
        let parent = tempfile::tempdir().unwrap();
        let destination = parent.path().join("results");
        let output = OutputFolder::create(&destination, &["a.txt", "b.txt"], false).unwrap();
        fs::write(output.path("a.txt"), "ours").unwrap();
        fs::write(output.path("b.txt"), "ours").unwrap();
        fs::create_dir(&destination).unwrap();
        fs::write(destination.join("b.txt"), "theirs").unwrap();
        assert_refused(output.commit(), &["exists", "allow it to be replaced"]);
        assert_eq!(names_in(&destination), ["b.txt"]);
        assert_eq!(fs::read_to_string(destination.join("b.txt")).unwrap(), "theirs");
        assert_eq!(names_in(parent.path()), ["results"]);
    }

    #[test]
    fn output_folder_that_cannot_be_written_is_refused() {
        let parent = tempfile::tempdir().unwrap();
        let file = parent.path().join("file");
        fs::write(&file, "").unwrap();
        for path in [file.clone(), file.join("below/it")] {
            assert_refused(OutputFolder::create(&path, &["a.txt"], true), &["is not a folder", "choose another"]);
        }
        assert_eq!(names_in(parent.path()), ["file"]);
        if cfg!(target_os = "linux") {
            let path = Path::new("/proc/asperity/results");
            assert_refused(OutputFolder::create(path, &["a.txt"], false), &["cannot be written"]);
        }
    }
}
