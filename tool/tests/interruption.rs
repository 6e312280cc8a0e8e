//! Runs that are interrupted, and studies that end or meet in the middle of their cases.

use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::bench::{Bench, text};

const STUDY: &str = "command = \"sweep\"\nout = \"study.csv\"\nmean-pressures = \"1e-3:1e-2:ROWS:log\"\n[make]\nsize = 64\nk-s = 20\n\
                     rms-slope = 0.1\n[vary]\nseed = [1, 2]\n";

fn begun(bench: &Bench, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.current_dir(bench.path(".")).args(arguments.split_whitespace()).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until something is so, for a minute at most.
#[track_caller]
fn wait_until(what: impl Fn() -> bool) {
    let begin = Instant::now();
    while !what() {
        assert!(begin.elapsed() < Duration::from_secs(60));
        sleep(Duration::from_millis(5));
    }
}

/// The rows of the tables in a folder.
fn rows(folder: &Path) -> usize {
    let files = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let tables = files.filter(|path| path.extension().is_some_and(|extension| extension == "csv"));
    tables.map(|path| fs::read_to_string(path).map_or(0, |table| table.lines().skip(1).count())).sum()
}

fn interrupted(signal: &str, process: Child) -> (Option<i32>, String) {
    let sent = Command::new("kill").args([signal, &process.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let output = process.wait_with_output().unwrap();
    (output.status.signal(), text(&output.stderr))
}

#[test]
fn an_interrupted_table_says_how_many_rows_stand_and_goes_on() {
    let bench = Bench::new();
    bench.said("surface --size 64 --k-s 20 --rms-slope 0.1 --quiet --out h.npy");
    for (signal, number, command) in [
        ("-INT", 2, "sweep --heights h.npy --mean-pressures 1e-3:1e-2:4000:log --out t.csv"),
        ("-TERM", 15, "cycle --heights h.npy --mean-pressures 0,0.01,0 --steps 2000 --out c.csv"),
    ] {
        let process = begun(&bench, command);
        wait_until(|| rows(&bench.path(".")) > 3);
        let (ended, said) = interrupted(signal, process);
        let name = command.split_whitespace().last().unwrap();
        let count = bench.read(name).lines().skip(1).count();
        let of = if number == 2 { " of 4000" } else { "" };
        // a row may have been written, but not its state
        let stands = [count, count - 1].map(|count| {
            format!("interrupted: {count}{of} rows are in {name}: the same command continues from there\n")
        });
        assert!(ended == Some(number) && stands.contains(&said), "{ended:?} {said}");
        fs::remove_file(bench.path(name)).unwrap();
    }
}

#[test]
fn a_study_ends_with_its_cases_and_says_how_many_are_done() {
    let bench = Bench::new();
    bench.write("study.toml", &STUDY.replace("ROWS", "20000"));
    let cases = bench.path("study.csv.cases");
    // a lock that is free belongs to a run that has ended
    let is_free = |extension: &str| {
        let files = fs::read_dir(&cases).unwrap().map(|entry| entry.unwrap().path());
        let mut locks = files.filter(|path| path.extension().is_some_and(|found| found == extension));
        locks.all(|path| File::open(path).unwrap().try_lock().is_ok())
    };
    for signal in ["-KILL", "-INT"] {
        let process = begun(&bench, "study study.toml --jobs 1");
        let before = rows(&cases);
        wait_until(|| rows(&cases) > before + 3);
        assert!(!is_free("csv") && !is_free("lock"));
        let (_, said) = interrupted(signal, process);
        wait_until(|| is_free("csv"));
        let told =
            "interrupted: 0 of 2 cases are done: the same command continues, also within those that were begun\n";
        assert_eq!(said, if signal == "-INT" { told } else { "" });
    }
}

#[test]
fn a_case_that_another_run_solves_is_waited_for() {
    let (one, bench) = (Bench::new(), Bench::new());
    for bench in [&one, &bench] {
        let study = STUDY.replace("ROWS", "300").replace("size = 64\nk-s = 20", "k-s = 6");
        bench.write("study.toml", &study.replace("seed = [1, 2]", "size = [96, 16]"));
    }
    one.said("study study.toml --quiet");
    let first = begun(&bench, "study study.toml --jobs 1 --slice 1/2");
    wait_until(|| rows(&bench.path("study.csv.cases")) > 3);
    // meets the first case, leaves it, and comes back to it
    let second = begun(&bench, "study study.toml --jobs 1").wait_with_output().unwrap();
    let waited =
        "1/2  case 2: size 16\ncase 1: size 96 is solved by another run: waiting for it\n2/2  case 1: size 96\n";
    let expected = format!("{waited}600 rows of 2 cases in study.csv\n");
    assert_eq!((text(&second.stdout), text(&second.stderr)), (expected, String::new()));
    assert!(first.wait_with_output().unwrap().status.success());
    assert!(bench.bytes("study.csv") == one.bytes("study.csv"));
    assert!(bench.names("study.csv.cases").iter().all(|name| name.ends_with(".csv") || name.ends_with(".sum")));
}

#[test]
fn a_study_starts_no_other_process() {
    let bench = Bench::new();
    bench.write("study.toml", &STUDY.replace("ROWS", "20000"));
    let study = begun(&bench, "study study.toml --jobs 2");
    let tables = || bench.names("study.csv.cases").iter().filter(|name| name.ends_with(".csv")).count();
    wait_until(|| bench.path("study.csv.cases").exists() && tables() == 2);
    let processes = Command::new("ps").args(["-A", "-o", "ppid="]).output().unwrap();
    assert!(text(&processes.stdout).lines().all(|parent| parent.trim() != study.id().to_string()));
    interrupted("-KILL", study);
}
