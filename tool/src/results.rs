//! A folder of results: all files of a run, or none.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_maps::io::OutputFolder;
use asperity_plot::Picture;
use asperity_scene::output::{at_destination, check_apart, commit, output_folder, write_text};
use asperity_scene::{Account, Outcome, key};
use serde::Serialize;
use serde_json::{Value, json};

use crate::pictures::PictureFormat;
use crate::printing::name;
use crate::scene::{self, SceneFile};

/// The name of the report in a folder of results.
pub const REPORT: &str = "report.json";

/// The name of the page of a folder of results.
pub const PAGE: &str = "report.html";

/// The contents of a folder for a page: figures by their names, what falls short, and pictures.
pub struct Contents {
    pub figures: Vec<(String, String)>,
    pub shortfall: Option<String>,
    pub pictures: Vec<Picture>,
}

/// A folder of results, with what it may replace.
pub struct Results<'a> {
    pub out: &'a Path,
    /// The scene that is put into the folder
    pub scene: &'a SceneFile,
    /// All files that the command may leave; the first stands for the run
    pub files: Vec<String>,
    /// Whether files that are there are replaced; files of a run that has not converged are
    pub force: bool,
}

/// The report, the scene, other files, the page of all, and pictures in any format.
pub fn files(others: &[&str], pictures: &[&str]) -> Vec<String> {
    let pictures = PictureFormat::ALL.iter().flat_map(|format| pictures.iter().map(move |name| format.file(name)));
    [REPORT, scene::NAME].iter().chain(others).chain([&PAGE]).map(|name| (*name).to_owned()).chain(pictures).collect()
}

/// The keys of files in a folder, which need the folder.
pub const OF_FOLDER: [&str; 6] = ["format", "picture_format", "dpi", "width", "colour_limits", "colour_clusters"];

impl Results<'_> {
    /// Refuses a folder that cannot have the files, or from which one of them is read.
    pub fn check(&self, read: impl IntoIterator<Item = impl AsRef<Path>>) -> Outcome<()> {
        self.scene.check(&self.out.join(scene::NAME))?;
        let read: Vec<PathBuf> = read.into_iter().map(|path| path.as_ref().to_owned()).collect();
        let mut files = self.files.iter().map(|name| self.out.join(name));
        files.try_for_each(|file| check_apart(&file, read.iter().map(PathBuf::as_path)))?;
        // Only a trial: a run that is interrupted leaves nothing behind.
        drop(self.folder()?);
        Ok(())
    }

    /// The folder in which the files are written until all of them are there.
    pub fn folder(&self) -> Outcome<OutputFolder> {
        let names: Vec<_> = self.files.iter().map(String::as_str).collect();
        output_folder(self.out, &names, self.force || self.has_failed())
    }

    /// Whether the folder has the results of a run that has not converged, which the corrected one replaces.
    fn has_failed(&self) -> bool {
        let report = fs::read_to_string(self.out.join(REPORT)).ok();
        let report: Option<Value> = report.and_then(|text| serde_json::from_str(&text).ok());
        report.is_some_and(|report| report[key!(Account, status)].as_str().is_some_and(|status| status != "converged"))
    }

    /// Puts the scene, and the files that `write` leaves in the folder, in their places.
    pub fn write<V>(
        &self,
        folder: OutputFolder,
        write: impl FnOnce(&OutputFolder) -> asperity::Result<V>,
    ) -> Outcome<V> {
        let written = write_text(&folder.path(scene::NAME), &self.scene.text(self.out)).and_then(|()| write(&folder));
        let written = written.map_err(|error| at_destination(error, self.out))?;
        commit(folder)?;
        Ok(written)
    }

    /// The names of the files that were written, for people.
    pub fn list(&self) -> String {
        let written = self.files.iter().filter(|file| self.out.join(file).exists()).map(String::as_str);
        format!("results in {}: {}", name(self.out), written.collect::<Vec<_>>().join(", "))
    }
}

/// Writes the report.
pub fn write_report(folder: &OutputFolder, report: &impl Serialize) -> asperity::Result<()> {
    write_text(&folder.path(REPORT), &format!("{:#}\n", json!(report)))
}
