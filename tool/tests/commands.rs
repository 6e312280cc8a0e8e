//! Every command in the README, in the documentation and in the help runs, and what it names exists.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use asperity_maps::io::write_npy;
use ndarray::Array2;
use tempfile::TempDir;

const TOOL: &str = env!("CARGO_BIN_EXE_asperity");

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// A folder in which the commands of one text are run, one after the other.
struct Reader {
    folder: TempDir,
    run: usize,
}

impl Reader {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), run: 0 }
    }

    fn shell(&self, command: &str) -> Output {
        let tools = Path::new(TOOL).parent().unwrap().to_owned();
        let path = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([tools].into_iter().chain(std::env::split_paths(&path))).unwrap();
        let mut shell = Command::new("sh");
        shell.args(["-c", command]).current_dir(&self.folder).env("PATH", path).env("HOME", self.folder.path());
        shell.output().unwrap()
    }

    /// Runs a command of the tool, with small surfaces in the place of those that a reader has.
    fn follow(&mut self, command: &str, text: &str) {
        let words: Vec<_> = command.split_whitespace().collect();
        let value = |option: &str| words.iter().skip_while(|word| **word != option).nth(1).copied();
        // a number, and the unit that it may have
        let side = value("--lengths").unwrap_or("1");
        let (side, unit) = side.split_at(side.find(|c: char| c.is_alphabetic() && c != 'e').unwrap_or(side.len()));
        let height = 0.01 * side.parse::<f64>().unwrap();
        let results = ["--out", "--psd", "--plot", "--fields"].map(value);
        let scene = (words[1] == "run" && !self.folder.path().join("heights.npy").exists()).then_some("heights.npy");
        for word in words.iter().copied().chain(scene) {
            let reads = !results.contains(&Some(word));
            let ours = word == "heights.npy" || !self.folder.path().join(word).exists();
            if !(reads && ours) {
                continue;
            }
            if word.ends_with(".dat") {
                fs::write(self.folder.path().join(word), "# qX, qY, Re, Im\n3, -1, 1e-3, 0\n").unwrap();
            } else if let Some((_, "txt" | "gsf" | "gwy")) = word.rsplit_once('.') {
                // the content and not the ending decides
                fs::write(self.folder.path().join(word), measured(!word.ends_with(".txt"))).unwrap();
            } else if word == "gap.npy" {
                write_npy(self.folder.path().join(word), &Array2::from_elem((64, 64), height)).unwrap();
            } else if word.ends_with(".npy") {
                let roughness = format!("--lengths {side}{unit} --k-l 2 --k-s 12 --rms-height {height}{unit}");
                let made = self.shell(&format!("asperity surface --size 64 {roughness} --force --quiet --out {word}"));
                assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
            }
        }
        if let Some((_, file)) = command.split_once(" > ~/") {
            fs::create_dir_all(self.folder.path().join(file).parent().unwrap()).unwrap();
        }
        let output = self.shell(command);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{text}: {command}\n{error}");
        self.run += 1;
    }
}

/// A map as an instrument may give it, of 5 by 4 micrometres: as a matrix in nanometres, or in the format of Gwyddion.
fn measured(gwyddion: bool) -> Vec<u8> {
    let (nx, ny) = (50, 40);
    let height = |i: usize, j: usize| 30.0 * (0.7 * i as f32).sin() * (0.4 * j as f32).cos() + 0.5 * i as f32;
    if !gwyddion {
        let row = |i| (0..ny).map(|j| height(i, j).to_string()).collect::<Vec<_>>().join(" ") + "\n";
        return (0..nx).map(row).collect::<String>().into_bytes();
    }
    let header = format!("XRes = {nx}\nYRes = {ny}\nXReal = 5e-6\nYReal = 4e-6\nXYUnits = m\nZUnits = m\n");
    let mut bytes = format!("Gwyddion Simple Field 1.0\n{header}").into_bytes();
    bytes.resize(bytes.len() + 4 - bytes.len() % 4, 0);
    let heights = (0..ny).flat_map(|j| (0..nx).map(move |i| 1e-9 * height(i, j)));
    bytes.extend(heights.flat_map(f32::to_le_bytes));
    bytes
}

/// The lines of a text with those joined that a backslash splits, without comments.
fn commands(text: &str) -> Vec<String> {
    let joined = text.replace("\\\n", " ");
    let lines = joined.lines().map(|line| line.split(" #").next().unwrap_or_default().trim());
    lines.filter(|line| !line.is_empty() && !line.starts_with('#')).map(str::to_owned).collect()
}

/// The texts for people: the pages in Markdown and the documentation in the code, with their names.
fn texts() -> Vec<(String, String)> {
    let (mut folders, mut files) = (
        ["src", "crates", "docs", "tool/src", "benches", "examples"].map(|folder| root().join(folder)).to_vec(),
        Vec::new(),
    );
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    files.insert(0, root().join("README.md"));
    files.extend(["CHANGELOG.md", "tool/README.md", "python/README.md"].map(|page| root().join(page)));
    let text = |path: PathBuf| {
        let is = |end: &str| path.extension().is_some_and(|extension| extension == end);
        let text = if is("md") || is("rs") { fs::read_to_string(&path).unwrap() } else { return None };
        let documentation = |line: &str| {
            let line = line.trim_start();
            let line = line.strip_prefix("//!").or(line.strip_prefix("///"))?;
            Some(line.strip_prefix(' ').unwrap_or(line).to_owned())
        };
        let text = if is("md") { text } else { text.lines().filter_map(documentation).collect::<Vec<_>>().join("\n") };
        Some((path.strip_prefix(root()).unwrap().display().to_string(), text))
    };
    files.into_iter().filter_map(text).collect()
}

/// The blocks of a text that have a language, and the language.
fn blocks(text: &str) -> Vec<(&str, &str)> {
    let fenced = text.split("```").skip(1).step_by(2);
    fenced.filter_map(|block| block.split_once('\n')).collect()
}

/// The commands in the blocks of a text.
#[test]
fn commands_of_the_documentation_run() {
    let mut run = 0;
    for (name, text) in texts() {
        let mut reader = Reader::new();
        // scripts have a test of their own
        for (language, block) in blocks(&text).into_iter().filter(|(_, block)| !block.starts_with("#!")) {
            // a file that begins with its name
            if let ("toml", Some((file, _))) =
                (language, block.strip_prefix("# ").and_then(|rest| rest.split_once('\n')))
            {
                fs::write(reader.folder.path().join(file), block).unwrap();
            }
            let code = ["", "rust", "toml", "python"].iter().any(|code| language.split(',').any(|word| word == *code));
            // in other blocks there may be anything else, too
            let shell = |command: &String| language == "sh" || !code && command.starts_with("asperity ");
            for command in commands(block).into_iter().filter(shell) {
                let program = command.split_whitespace().next().unwrap();
                match (program, command.split_once(" -- ")) {
                    ("asperity", _) => reader.follow(&command, &name),
                    ("cargo", Some(("cargo run --release", arguments))) => {
                        reader.follow(&format!("asperity {arguments}"), &name);
                    }
                    ("cargo", _) => assert!(names_no_target_or_an_existing_one(&command), "{name}: {command}"),
                    // needs MPI: `.ci/mpi` does the like
                    ("apt-get" | "mpiexec", _) => {}
                    // a package of this repository
                    ("pip", _) => {
                        let folder = command.split([' ', '\'', '[']).find(|word| word.starts_with("./"));
                        let package = root().join(folder.unwrap_or_default()).join("pyproject.toml");
                        assert!(package.exists(), "{name}: {command}");
                    }
                    (script, _) if script.contains('/') => assert!(root().join(script).exists(), "{name}: {command}"),
                    _ => panic!("{name}: nobody knows whether this runs: {command}"),
                }
            }
        }
        run += reader.run;
    }
    assert!(run >= 10, "{run} commands found");
}

/// The library in ten lines, which `cargo test --doc` runs where the library has it.
#[test]
fn the_readme_shows_the_code_that_is_tested() {
    let texts: HashMap<_, _> = texts().into_iter().collect();
    let code = |page: &str| -> Vec<_> {
        blocks(&texts[page])
            .into_iter()
            .filter(|(language, _)| *language == "rust")
            .map(|(_, code)| code.to_owned())
            .collect()
    };
    let tested = code("src/README.md");
    assert!(tested.len() == 1 && code("README.md") == tested);
}

/// The links of the pages are checked where the site is built, by `.ci/site`.
#[test]
fn files_that_the_readme_links_to_exist() {
    let (_, text) = texts().remove(0);
    let after =
        |start: &'static str, end: char| text.split(start).skip(1).filter_map(move |rest| rest.split(end).next());
    let files: Vec<_> = after("](", ')').chain(after("src=\"", '"')).filter(|link| !link.contains("://")).collect();
    assert!(files.len() >= 10, "{files:?}");
    for file in files {
        assert!(root().join(file).is_file(), "{file}");
    }
}

fn names_no_target_or_an_existing_one(command: &str) -> bool {
    let known = ["run", "test", "bench", "build", "install", "doc"];
    known.contains(&command.split_whitespace().nth(1).unwrap_or_default())
        && targets(command).all(|(kind, name)| exists(kind, &name))
        && modules(command).all(|(target, module)| exists(&format!("tests/{target}"), module))
}

/// The examples, benches and tests that a text names as options of cargo.
fn targets(text: &str) -> impl Iterator<Item = (&'static str, String)> {
    let kinds = [("--example ", "examples"), ("--bench ", "benches"), ("--test ", "tests")];
    kinds.into_iter().flat_map(move |(option, folder)| {
        let after = text.split(option).skip(1);
        after.map(move |rest| (folder, rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()))
    })
}

/// The modules of tests that a text names, with their targets, as in `--test library solvers::`.
fn modules(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let named = text.split("--test ").skip(1).filter_map(|rest| rest.split_once("::")?.0.split_once(' '));
    named.filter(|(_, module)| module.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'))
}

fn exists(folder: &str, name: &str) -> bool {
    [format!("{name}.rs"), format!("{name}/main.rs")].iter().any(|file| root().join(folder).join(file).is_file())
}

/// The names in the sentences of a text.
#[test]
fn examples_and_options_that_the_documentation_names_exist() {
    let (help, manifest) = (Help::new(), fs::read_to_string(root().join("Cargo.toml")).unwrap());
    // tests that stand in sources have their names there
    let tests = fs::read_to_string(root().join("tests/Cargo.toml")).unwrap();
    let (mut named, mut checked) = (HashSet::new(), 0);
    for (file, text) in texts() {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for (folder, name) in targets(&text).filter(|(_, name)| name.chars().any(char::is_lowercase)) {
            let known = exists(folder, &name) || tests.contains(&format!("[[test]]\nname = \"{name}\"\n"));
            assert!(known, "{file}: there is no {folder}/{name}.rs");
            named.insert(name);
        }
        // those that the root has run without their package
        for command in text.split("`").flat_map(|span| span.split("cargo ").skip(1)) {
            for (folder, name) in targets(command) {
                let elsewhere =
                    folder == "examples" && !manifest.contains(&format!("[[example]]\nname = \"{name}\"\n"));
                assert_eq!(command.contains("-p asperity-examples "), elsewhere, "{file}: cargo {command}");
            }
        }
        for (target, module) in modules(&text) {
            assert!(exists(&format!("tests/{target}"), module), "{file}: there is no tests/{target}/{module}.rs");
        }
        for span in text.replace("```", "").split('`').skip(1).filter_map(|span| span.strip_prefix("asperity ")) {
            let mut words = span.split(' ');
            let command = words.next().unwrap();
            let Some(help) = help.of.get(command) else {
                assert!(command.starts_with("--") || !command.chars().all(char::is_lowercase), "{file}: {span}");
                continue;
            };
            for option in words.filter_map(|word| word.strip_prefix("--")) {
                let option = option.split(['=', ',', '.', ';', ':', ')']).next().unwrap();
                assert!(help.contains(&format!("--{option}")), "{file}: asperity {command} has no --{option}");
                checked += 1;
            }
        }
    }
    assert!(named.len() >= 8 && checked >= 2, "{named:?}, {checked} options");
}

/// The help of all commands, by name; the help of the tool has none.
struct Help {
    of: HashMap<String, String>,
}

impl Help {
    fn new() -> Self {
        let help = |arguments: &[&str]| {
            let output = Command::new(TOOL).args(arguments).output().unwrap();
            assert!(output.status.success());
            String::from_utf8(output.stdout).unwrap()
        };
        let tool = help(&["--help"]);
        let list = tool.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
        let names = list.lines().filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
        let of = names.map(|name| (name.to_owned(), help(&[name, "--help"]))).collect::<HashMap<_, _>>();
        Self { of: of.into_iter().chain([(String::new(), tool)]).collect() }
    }
}

#[test]
fn examples_of_the_help_run() {
    let help = Help::new();
    assert!(help.of.len() >= 9);
    let (_, study) = help.of["study"].split_once("A study:\n").unwrap();
    let study = study.split("\n\n").next().unwrap().to_owned();
    for (name, help) in help.of {
        let (_, examples) = help.split_once("Examples:\n").unwrap_or_else(|| panic!("{name} has no examples"));
        let mut reader = Reader::new();
        fs::write(reader.folder.path().join("study.toml"), &study).unwrap();
        for command in commands(examples).iter().filter(|line| line.starts_with("asperity ")) {
            reader.follow(command, &name);
        }
        assert!(reader.run > 0, "{name}");
    }
}
