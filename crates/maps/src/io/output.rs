//! The output folder: all files of a run, or none.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, io};

use tempfile::TempDir;

use asperity::{Error, Result};

/// A folder that receives the results of one run, all of them or none.
///
/// Files are written at [`path`](Self::path), in a hidden temporary folder on the file system of the
/// destination, and appear in the destination on [`commit`](Self::commit). A folder that is dropped without a commit
/// leaves nothing behind. A process that is killed leaves the temporary folder, `.asperity-` and a few letters, unless
/// it can still call [`abandon_all`](Self::abandon_all).
///
/// ```
/// use asperity_maps::io::{OutputFolder, write_npy};
/// let parent = tempfile::tempdir()?;
/// let destination = parent.path().join("results");
/// let folder = OutputFolder::create(&destination, &["gap.npy"], false)?;
/// write_npy(folder.path("gap.npy"), &ndarray::array![[0.0, 1.0]])?;
/// assert!(!destination.exists()); // not yet
/// folder.commit()?;
/// assert!(destination.join("gap.npy").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(hidden)]
#[derive(Debug)]
pub struct OutputFolder {
    destination: PathBuf,
    names: Vec<String>,
    force: bool,
    /// In the destination, or in the nearest folder above it that exists.
    temporary: TempDir,
}

/// The temporary folders of this process.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A change of the destination.
enum Step {
    Remove(PathBuf),
    Move(PathBuf, PathBuf),
}

impl Step {
    fn take(&self) -> io::Result<()> {
        match self {
            Self::Remove(file) => match fs::remove_file(file) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
                _ => Ok(()),
            },
            Self::Move(from, to) => fs::rename(from, to),
        }
    }
}

impl OutputFolder {
    /// Prepares a folder at `path`, existing or not, for a run with files of these `names`, and creates nothing there
    /// yet. With `force` the run takes the place of a former run: its files of these `names` go, also where the run
    /// does not write them itself; other files in the folder are left alone.
    ///
    /// If there are several names, the first one stands for the run: its file goes before any other one changes, and
    /// comes after all of them. So a file of this name is never next to files of two runs, even if the process is
    /// killed.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if one of the files exists and `force` is not given, if one of them is no regular file, if
    /// `path` or something above it is a file, and if the folder cannot be written.
    pub fn create(path: impl AsRef<Path>, names: &[&str], force: bool) -> Result<Self> {
        let path = path.as_ref();
        for name in names {
            refuse_existing(&path.join(name), force)?;
        }
        // Where the destination, or the first folder on the way to it, will be created.
        let existing = path.ancestors().find(|p| p.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
        if !existing.is_dir() {
            return Err(Error::file(existing, "is not a folder: choose another output folder"));
        }
        let unwritable = |e| Error::file(existing, format!("cannot be written ({e}): choose another output folder"));
        // Nobody abandons it before it is known to exist.
        let mut all = live();
        let temporary = tempfile::Builder::new().prefix(".asperity-").tempdir_in(existing).map_err(unwritable)?;
        all.push(temporary.path().to_owned());
        drop(all);
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let folder = Self { destination: path.to_owned(), names, force, temporary };
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
        let unwritable = |e| Error::unwritable(destination, e);
        if destination.symlink_metadata().is_err() {
            if let Some(parent) = destination.parent() {
                fs::create_dir_all(parent).map_err(unwritable)?;
            }
            return fs::rename(self.files(), destination).map_err(unwritable);
        }
        let steps = self.steps().map_err(unwritable)?;
        // All checks come before the first change.
        for Step::Remove(file) | Step::Move(_, file) in &steps {
            refuse_existing(file, self.force)?;
        }
        steps.iter().try_for_each(Step::take).map_err(unwritable)
    }

    /// The changes of a destination that exists, in their order.
    fn steps(&self) -> io::Result<Vec<Step>> {
        let mut written =
            fs::read_dir(self.files())?.map(|entry| Ok(entry?.file_name())).collect::<io::Result<Vec<_>>>()?;
        let seal = self.names.first().filter(|_| self.names.len() > 1);
        written.sort_by_key(|name| seal.is_some_and(|seal| name == seal.as_str()));
        let goes = |name: &&String| seal == Some(name) || !written.iter().any(|written| written == name.as_str());
        let former = self.names.iter().filter(goes).map(|name| Step::Remove(self.destination.join(name)));
        let new = written.iter().map(|name| Step::Move(self.files().join(name), self.destination.join(name)));
        Ok(former.chain(new).collect())
    }

    fn files(&self) -> PathBuf {
        self.temporary.path().join("files")
    }

    /// Removes the temporary folders that this process has not committed, before it ends by a signal. Users of these
    /// folders fail. As long as the returned value lives, no thread makes another folder.
    ///
    /// ```
    /// use asperity_maps::io::OutputFolder;
    /// let parent = tempfile::tempdir()?;
    /// let folder = OutputFolder::create(parent.path().join("results"), &["gap.npy"], false)?;
    /// assert!(std::fs::read_dir(parent.path())?.count() == 1);
    /// OutputFolder::abandon_all();
    /// assert!(std::fs::read_dir(parent.path())?.count() == 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn abandon_all() -> impl Sized {
        let mut all = live();
        for folder in all.drain(..) {
            // there may be files that another thread writes meanwhile
            let _ = fs::remove_dir_all(&folder).or_else(|_| fs::remove_dir_all(&folder));
        }
        all
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        let mut all = live();
        // while the folder is on the list, so that it goes if the process ends by a signal
        let _ = fs::remove_dir_all(self.temporary.path());
        all.retain(|folder| folder != self.temporary.path());
    }
}

fn live() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner)
}

fn refuse_existing(file: &Path, force: bool) -> Result<()> {
    match file.symlink_metadata() {
        Ok(found) if found.is_dir() => Err(Error::file(file, "is a folder: choose another output folder")),
        Ok(found) if found.is_symlink() => Err(Error::file(file, "is a link: name the file to which it points")),
        Ok(found) if !found.is_file() => Err(Error::file(file, "is not a regular file: choose another name")),
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
    fn a_run_takes_the_place_of_a_former_one_and_is_never_mixed_with_it() {
        let names = ["report", "gap", "pressure", "fields", "mode"];
        let (former, new) = (["report", "gap", "pressure", "mode"], ["gap", "fields", "report"]);
        let parent = tempfile::tempdir().unwrap();
        for killed_after in 0..=8 {
            let destination = parent.path().join(format!("results-{killed_after}"));
            fs::create_dir(&destination).unwrap();
            fs::write(destination.join("notes"), "mine").unwrap();
            former.iter().for_each(|name| fs::write(destination.join(name), "former").unwrap());
            assert_refused(OutputFolder::create(&destination, &["fields", "mode"], false), &["exists"]);
            let output = OutputFolder::create(&destination, &names, true).unwrap();
            new.iter().for_each(|name| fs::write(output.path(name), "new").unwrap());
            let steps = output.steps().unwrap();
            steps.iter().take(killed_after).for_each(|step| step.take().unwrap());
            drop(output);
            let content = |name: &String| fs::read_to_string(destination.join(name)).unwrap();
            let found = names_in(&destination);
            let runs: Vec<_> = found.iter().filter(|name| *name != "notes").map(content).collect();
            if let Some(run) = found.contains(&"report".to_owned()).then(|| content(&"report".to_owned())) {
                assert!(runs.iter().all(|other| *other == run), "{killed_after}: {found:?} {runs:?}");
            }
            assert_eq!(content(&"notes".to_owned()), "mine");
            if killed_after >= steps.len() {
                assert_eq!(found, ["fields", "gap", "notes", "report"]);
            }
            assert!(steps.len() <= 8);
        }
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
