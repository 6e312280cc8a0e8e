//! A folder in which the tool is run.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use asperity_maps::io::{read_field, write_npy};
use ndarray::Array2;
use serde_json::Value;
use tempfile::TempDir;

pub struct Bench(pub TempDir);

impl Bench {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
        command.current_dir(&self.0).args(arguments.split_whitespace());
        command
    }

    /// A folder with heights in `heights.npy`.
    pub fn with(heights: &Array2<f64>) -> Self {
        let bench = Self::new();
        write_npy(bench.path("heights.npy"), heights).unwrap();
        bench
    }

    pub fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command on `heights.npy`, which must end with this exit code.
    #[track_caller]
    pub fn ends(&self, command: &str, arguments: &str, code: i32) -> Output {
        let output = self.run(&format!("{command} --heights heights.npy {arguments}"));
        assert_eq!(output.status.code(), Some(code), "{arguments}: {}", text(&output.stderr));
        output
    }

    /// Solves with all results in `out`, must end with this exit code, and returns the report.
    #[track_caller]
    pub fn solve(&self, arguments: &str, out: &str, code: i32) -> Value {
        self.ends("solve", &format!("{arguments} --out {out}"), code);
        self.report(out)
    }

    /// Runs what must succeed in silence on standard error, and returns what it prints.
    #[track_caller]
    pub fn said(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{arguments}");
        text(&output.stdout)
    }

    /// Runs what must succeed, perhaps with warnings, and returns what it prints.
    #[track_caller]
    pub fn printed(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let warnings = text(&output.stderr);
        assert!(output.status.success() && warnings.lines().all(|line| line.starts_with("warning: ")), "{warnings}");
        text(&output.stdout)
    }

    /// The JSON report of a run that must succeed, perhaps with warnings.
    #[track_caller]
    pub fn reported(&self, arguments: &str) -> Value {
        serde_json::from_str(&self.printed(&format!("{arguments} --json"))).unwrap()
    }

    /// Runs what must be refused on one line, and returns that.
    #[track_caller]
    pub fn refused(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let error = text(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{arguments}: {error}");
        assert_eq!(error.lines().count(), 1, "{arguments}: {error}");
        error
    }

    /// Runs what must be refused on one line, with these parts.
    #[track_caller]
    pub fn refused_with(&self, arguments: &str, parts: &[&str]) {
        let error = self.refused(arguments);
        assert!(parts.iter().all(|part| error.contains(part)), "{arguments}: {error}");
    }

    pub fn report(&self, folder: &str) -> Value {
        serde_json::from_slice(&self.bytes(&format!("{folder}/report.json"))).unwrap()
    }

    pub fn write(&self, name: &str, content: &str) {
        fs::write(self.path(name), content).unwrap();
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub fn field(&self, name: &str) -> Array2<f64> {
        read_field(self.path(name)).unwrap()
    }

    pub fn read(&self, name: &str) -> String {
        text(&self.bytes(name))
    }

    /// The cells of a comma-separated table under a name, which may have a unit.
    #[track_caller]
    pub fn cells(&self, table: &str, name: &str) -> Vec<String> {
        let text = self.read(table);
        let mut rows = text.lines().map(|row| row.split(','));
        let is_named = |column: &str| column.split(" [").next() == Some(name);
        let at = rows.next().unwrap().position(is_named).unwrap_or_else(|| panic!("{table} has no {name}"));
        rows.map(|mut row| row.nth(at).unwrap().to_owned()).collect()
    }

    /// The numbers of a comma-separated table under a name; NaN where a cell has none.
    #[track_caller]
    pub fn column(&self, table: &str, name: &str) -> Vec<f64> {
        self.cells(table, name).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
    }

    /// The names of all files in a folder, hidden ones too.
    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
