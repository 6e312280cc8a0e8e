//! Damaged states of sweeps and cycles, and folders that cannot be written.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Output;

use asperity_scene::Hash;

use super::tool::{GIGABYTE, assert_orderly, bench, limited, names, words};

const SWEEP: &str = "sweep --heights heights.npy --mean-gaps 0.04:0.038:3 --quiet --out table.csv";
const CYCLE: &str = "cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 1e-2 \
                     --mean-gaps 0.045,0.043 --steps 3 --quiet --out table.csv";

fn run(folder: &Path, command: &str) -> Output {
    let output = limited(folder, GIGABYTE, "200000", &words(command));
    assert_orderly(&output, command);
    output
}

/// A state as it would be written with another place.
fn resealed(state: &[u8], place: &[u8]) -> Vec<u8> {
    let lines: Vec<_> = state.splitn(3, |&byte| byte == b'\n').collect();
    let rest = [lines[1], b"\n", place].concat();
    [Hash::NEW.extend(&rest).to_string().as_bytes(), b"\n", &rest].concat()
}

/// States that are not whole are tested in `asperity-scene`; these have the checksum of what they are.
#[test]
fn states_of_something_else_are_refused_and_the_table_is_kept() {
    for command in [SWEEP, CYCLE] {
        let (bench, other) = (bench(16), bench(18));
        for bench in [&bench, &other] {
            assert_eq!(run(bench.path(), command).status.code(), Some(0), "{command}");
        }
        let (table, path) = (bench.path().join("table.csv"), bench.path().join("table.csv.state"));
        let (whole, state) = (fs::read(&table).unwrap(), fs::read(&path).unwrap());
        let foreign = fs::read(other.path().join("table.csv.state")).unwrap();
        for (what, damaged) in [
            ("of another surface", foreign),
            ("a huge array", resealed(&state, &[0xff; 9])),
            ("nothing", resealed(&state, &[])),
        ] {
            fs::write(&path, &damaged).unwrap();
            let output = run(bench.path(), command);
            let error = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{command}, {what}: {error}");
            assert!(error.contains("table.csv") && error.contains("--force"), "{command}, {what}: {error}");
            assert!(fs::read(&table).unwrap() == whole && fs::read(&path).unwrap() == damaged, "{command}, {what}");
        }
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        assert_eq!(run(bench.path(), command).status.code(), Some(1));
        assert!(fs::read(&table).unwrap() == whole);
    }
}

const OUTPUTS: [&str; 10] = [
    "solve --heights heights.npy --mean-gap 0.0398 --out",
    "sweep --heights heights.npy --mean-gaps 0.04 --format csv --out",
    "sweep --heights heights.npy --mean-gaps 0.04 --out sweep.csv --fields",
    "sweep --heights heights.npy --mean-gaps 0.04 --out sweep.csv --plot",
    "cycle --heights heights.npy --mean-gaps 0.04,0.039 --steps 1 --out",
    "cycle --heights heights.npy --mean-gaps 0.04,0.039 --steps 1 --out cycle.csv --plot",
    "surface --size 16 --rms-slope 0.1 --k-s 6 --out",
    "surface --size 16 --rms-slope 0.1 --k-s 6 --out rough.npy --psd",
    "stats heights.npy --lengths 1 --psd",
    "demo --out",
];

/// The name of an output in a folder, with an ending that the command takes.
fn below(folder: &str, command: &str) -> String {
    let ending = match command {
        _ if command.ends_with("--plot") => ".png",
        _ if command.starts_with("cycle") => ".csv",
        _ => "",
    };
    format!("{command} {folder}/results{ending}")
}

#[test]
fn nothing_is_written_below_a_file() {
    for command in OUTPUTS {
        let bench = bench(16);
        let output = run(bench.path(), &below("heights.npy", command));
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command}: {error}");
        assert!(error.contains("heights.npy") && error.contains("is not a folder"), "{command}: {error}");
        assert!(!names(bench.path()).iter().any(|name| name == "rough.npy"), "{command}");
    }
}

#[test]
fn folders_without_permission_are_refused() {
    for command in OUTPUTS {
        let bench = bench(16);
        let folder = bench.path().join("locked");
        fs::create_dir(&folder).unwrap();
        fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).unwrap();
        if fs::write(folder.join("probe"), "").is_ok() {
            eprintln!("skipped: permissions do not bind this user");
            return;
        }
        let output = run(bench.path(), &below("locked", command));
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command}: {error}");
        assert!(error.contains("locked") && names(&folder).is_empty(), "{command}: {error}");
        fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).unwrap();
    }
}
