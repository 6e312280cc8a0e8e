//! What version 0.1 promises, by the file `promised.toml`: names that reports, tables, scenes and options keep.

use std::collections::{BTreeMap, BTreeSet};

use asperity_maps::io::write_npy;
use ndarray::Array2;
use serde::Deserialize;
use serde_json::Value;

use crate::bench::{Bench, text};

#[derive(Deserialize)]
struct Promised {
    files: String,
    arrays: String,
    exits: BTreeMap<String, String>,
    reports: BTreeMap<String, Report>,
    tables: Vec<Table>,
    scenes: BTreeMap<String, String>,
    options: BTreeMap<String, String>,
}

/// The keys that reports of a command have, by the kind of their values where these are not `null`.
#[derive(Deserialize)]
struct Report {
    runs: Vec<String>,
    #[serde(flatten)]
    keys: BTreeMap<String, String>,
}

#[derive(Deserialize)]
struct Table {
    run: String,
    columns: String,
}

fn promised() -> Promised {
    toml::from_str(include_str!("promised.toml")).unwrap()
}

/// A folder with the files that the promises name.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 32 --k-l 2 --k-s 10 --rms-height 0.01 --quiet --out heights.npy");
    bench.said("surface --size 32 --lengths 20um --k-l 2 --k-s 10 --rms-height 0.1um --quiet --out metres.npz");
    bench.said("surface --form sphere --radius 1 --size 32 --quiet --out tip.npz");
    bench.said("prepare heights.npy --mirror --quiet --out mirrored.npz");
    bench.said("solve --heights heights.npy --mean-pressure 0.01 --no-pictures --quiet --out solved");
    // a wave, with noise by the digits of sines
    let wave = |i: usize| (i as f64 * std::f64::consts::TAU / 128.0).sin();
    let noisy = |i: usize, j: usize| wave(i) + ((i * 128 + j) as f64).sin() * 1e5 % 0.01;
    write_npy(bench.path("noisy.npy"), &Array2::from_shape_fn((128, 128), |(i, j)| noisy(i, j))).unwrap();
    bench.write("works.txt", &("1e-4 ".repeat(16) + &"2e-4 ".repeat(16) + "\n").repeat(32));
    bench.write("hardness.txt", &("0.1 ".repeat(32) + "\n").repeat(32));
    bench.write("waves.dat", "2, 1, 0.01, 0\n");
    bench.write("table.csv", "0,2e-2\n5e-3,1e-2\n1e-2,0\n");
    let study = "command = \"sweep\"\nheights = \"heights.npy\"\nmean-gaps = [0.02]\nout = \"study.csv\"\n";
    bench.write("study.toml", &format!("{study}[vary]\nmodulus = [1, 2]\n"));
    bench
}

fn run(command: &str) -> String {
    command.replace("{law}", "--law exponential --work-of-adhesion 1e-4 --range 4e-3")
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "nothing",
        Value::Bool(_) => "truths",
        Value::Number(_) => "numbers",
        Value::String(_) => "texts",
        Value::Array(_) => "lists",
        Value::Object(_) => "tables",
    }
}

/// The keys in a value with the kinds of their values; keys of inner tables stand behind the key of the table and a
/// dot.
fn keys(value: &Value, before: &str, found: &mut BTreeMap<String, BTreeSet<&'static str>>) {
    match value {
        Value::Object(entries) => entries.iter().for_each(|(key, value)| {
            let key = format!("{before}{key}");
            found.entry(key.clone()).or_default().insert(kind(value));
            keys(value, &format!("{key}."), found);
        }),
        Value::Array(values) => values.iter().for_each(|value| keys(value, before, found)),
        _ => {}
    }
}

#[test]
fn reports_keep_their_keys_and_the_kinds_of_their_values() {
    let (bench, promised) = (bench(), promised());
    let everywhere = &promised.reports["solve"].keys;
    let page = concat!(
        include_str!("../../docs/program/reports.md"),
        include_str!("../../docs/program/numbers.md"),
        include_str!("../../docs/program/keys.md")
    );
    for (command, report) in &promised.reports {
        let mut found = BTreeMap::new();
        for arguments in &report.runs {
            let output = bench.run(&format!("{} --json", run(arguments)));
            assert_eq!(output.status.code(), Some(0), "{arguments}: {}", text(&output.stderr));
            let report: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(report["command"].as_str(), arguments.split(' ').next(), "{arguments}");
            keys(&report, "", &mut found);
        }
        let is_described = ["solve", "sweep", "cycle", "surface", "stats", "prepare"].contains(&&**command);
        for name in found.keys().filter(|_| is_described).flat_map(|key| key.split('.')) {
            assert!(page.contains(&format!("`{name}`")), "{command}: {name} is not documented");
        }
        for (expected, names) in &report.keys {
            for name in names.split_whitespace() {
                let kinds = found.get(name).unwrap_or_else(|| panic!("{command}: no {name}"));
                let kept = kinds.iter().all(|kind| kind == expected || *kind == "nothing");
                assert!(kept, "{command}: {name} has {kinds:?}, not {expected}");
            }
        }
        // a key means the same in all reports
        for (expected, names) in everywhere {
            for name in names.split_whitespace() {
                let kinds = found.get(name).into_iter().flatten();
                assert!(kinds.clone().all(|kind| kind == expected || *kind == "nothing"), "{command}: {name}");
            }
        }
    }
}

#[test]
fn tables_keep_their_columns() {
    let bench = bench();
    for Table { run: arguments, columns } in promised().tables {
        bench.said(&format!("{} --quiet", run(&arguments)));
        let table = bench.read(arguments.rsplit(' ').next().unwrap());
        let header: BTreeSet<_> = table.lines().next().unwrap().split(',').collect();
        for column in columns.split_whitespace() {
            assert!(header.contains(column), "{arguments}: no {column}");
        }
    }
}

#[test]
fn results_keep_their_names_and_exits_their_codes() {
    let (bench, promised) = (bench(), promised());
    for (code, arguments) in &promised.exits {
        assert_eq!(bench.run(arguments).status.code(), Some(code.parse().unwrap()), "{arguments}");
    }
    assert_eq!(bench.names("fine"), promised.files.split_whitespace().collect::<Vec<_>>());
    for (name, scene) in &promised.scenes {
        bench.write(&format!("{name}.toml"), scene);
        bench.said(&format!("run {name}.toml --quiet"));
        let archive = zip::ZipArchive::new(std::fs::File::open(bench.path("scene/fields.npz")).unwrap()).unwrap();
        let arrays: BTreeSet<_> = archive.file_names().map(|name| name.trim_end_matches(".npy")).collect();
        assert!(promised.arrays.split_whitespace().all(|name| arrays.contains(name)), "{arrays:?}");
    }
}

#[test]
fn commands_keep_their_options() {
    let bench = Bench::new();
    for (command, options) in promised().options {
        let help = bench.said(&format!("{command} --help"));
        let known: BTreeSet<_> = help.split_whitespace().filter_map(|word| word.strip_prefix("--")).collect();
        for option in options.split_whitespace() {
            assert!(known.contains(option), "{command}: no --{option}");
        }
    }
}
