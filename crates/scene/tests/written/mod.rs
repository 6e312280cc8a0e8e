//! Files that a test writes anew where `UPDATE` is set, and compares otherwise.

use std::path::Path;

/// Compares the texts of files with those that a test makes of a list.
pub fn check_written<const N: usize>(list: &str, files: [(&str, String); N]) {
    for (file, text) in files {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&path, &text).expect("a file that can be written");
        }
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(found == text, "{file} differs from the {list}: UPDATE=1 cargo test -p asperity-scene --test {list}");
    }
}

/// A table of a document, without the columns in which nothing stands.
pub fn table(heads: &[&str], rows: &[Vec<String>]) -> String {
    let columns: Vec<_> = (0..heads.len()).filter(|&column| rows.iter().any(|row| !row[column].is_empty())).collect();
    let line = |cells: &[String]| {
        let cells = columns.iter().map(|&column| format!(" {} |", cells[column].replace('*', "\\*")));
        format!("|{}\n", cells.collect::<String>())
    };
    let heads: Vec<_> = heads.iter().map(|head| (*head).to_owned()).collect();
    let rule = "---|".repeat(columns.len());
    format!("\n{}|{rule}\n{}", line(&heads), rows.iter().map(|row| line(row)).collect::<String>())
}
