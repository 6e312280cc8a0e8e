//! Files that appear complete or not at all.

use std::fs;

use asperity_scene::output::{commit, output_folder};

#[test]
fn a_file_that_comes_to_be_there_meanwhile_is_refused_with_the_remedy() {
    let parent = tempfile::tempdir().unwrap();
    let out = parent.path().join("results");
    let folder = output_folder(&out, &["report.json"], false).unwrap();
    fs::write(folder.path("report.json"), "new").unwrap();
    fs::create_dir(&out).unwrap();
    fs::write(out.join("report.json"), "of another run").unwrap();
    let early = output_folder(&out, &["report.json"], false).err().unwrap().to_string();
    let late = commit(folder).unwrap_err().to_string();
    assert!(early == late && late.contains("use --force"), "{early}\n{late}");
}
