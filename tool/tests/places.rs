//! Files and their names: what a run replaces, what it never replaces, and names that are more than letters.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{Seek, SeekFrom, Write};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::bench::{Bench, text};

const SURFACE: &str = "surface --size 16 --k-l 2 --k-s 6 --rms-slope 0.1 --quiet --out";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.said(&format!("{SURFACE} heights.npy"));
    bench
}

/// The tool with a word more, as it is, with the colours of a terminal.
fn run_with(bench: &Bench, arguments: &str, word: impl AsRef<OsStr>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.current_dir(bench.path(".")).args(arguments.split_whitespace()).arg(word).env("CLICOLOR_FORCE", "1");
    command.output().unwrap()
}

#[test]
fn a_run_in_the_place_of_another_leaves_none_of_its_files() {
    let bench = bench();
    let solve = "solve --heights heights.npy --mean-pressure 0.01 --quiet --out results";
    bench.said(&format!("{solve} --stability --distribution --format npy,vti"));
    bench.write("results/notes.txt", "mine");
    bench.said("report results");
    assert!(bench.read("results/report.html").contains("Maps and curves"));
    bench.said(&solve.replace("0.01 --quiet", "0.02 --quiet --format npz --no-pictures --force"));
    assert_eq!(bench.names("results"), ["fields.npz", "notes.txt", "report.json", "scene.toml"]);
    bench.said("report results");
    let page = bench.read("results/report.html");
    assert!(page.contains("There are no maps on this page") && !page.contains("Maps and curves"));
    // what is left of a run that was killed as it replaced another one
    bench.write("results/gap.npy", "of a former run");
    fs::remove_file(bench.path("results/report.json")).unwrap();
    fs::remove_file(bench.path("results/scene.toml")).unwrap();
    fs::remove_file(bench.path("results/fields.npz")).unwrap();
    bench.refused_with("report results --force", &["report.json", "is not there"]);
    bench.refused_with(&format!("{solve} --format npz"), &["gap.npy", "--force"]);
    bench.said(&format!("{solve} --format npz --no-pictures --force"));
    assert!(!bench.path("results/gap.npy").exists());
}

#[test]
fn no_output_replaces_what_its_run_reads() {
    let bench = bench();
    let heights = bench.bytes("heights.npy");
    let solve = "solve --heights heights.npy --mean-pressure 0.01 --quiet --no-pictures --out";
    bench.said(&format!("{solve} results"));
    bench.said("sweep --heights heights.npy --mean-pressures 0.01 --quiet --out s.csv");
    let refused = |arguments: &str| bench.refused_with(arguments, &["is read by this run", "another name"]);
    refused("stats heights.npy --lengths 1 --psd heights.npy --force");
    refused("stats heights.npy --lengths 1 --psd ./results/../heights.npy --force");
    for name in ["gap.npy", "pressure.npy", "contact_pressure.npy", "report.json", "scene.toml"] {
        refused(&format!("report results --out results/{name} --force"));
    }
    for name in ["s.csv", "s.csv.scene.toml", "s.csv.state"] {
        refused(&format!("report s.csv --out {name} --force"));
    }
    fs::copy(bench.path("heights.npy"), bench.path("results/gap.npy")).unwrap();
    refused("solve --heights results/gap.npy --mean-pressure 0.01 --format npz --out results --force");
    refused("sweep --heights heights.npy --mean-pressures 0.01 --format csv --out heights.npy --force");
    let out = bench.refused(&format!("{SURFACE} rough.npy --psd ./rough.npy"));
    assert!(out.contains("--psd is rough.npy, the same as --out"), "{out}");
    assert!(bench.bytes("heights.npy") == heights && bench.bytes("results/gap.npy") == heights);
}

#[cfg(unix)]
#[test]
fn no_output_replaces_what_is_no_regular_file() {
    let bench = bench();
    assert!(Command::new("mkfifo").arg(bench.path("fifo")).status().unwrap().success());
    bench.write("table.csv", "mine");
    std::os::unix::fs::symlink("table.csv", bench.path("link")).unwrap();
    bench.said("solve --heights heights.npy --mean-pressure 0.01 --quiet --no-pictures --out results");
    for (file, reason) in [("fifo", "is not a regular file"), ("link", "name the file to which it points")] {
        bench.refused_with(&format!("report results --out {file} --force"), &[file, reason]);
        bench.refused_with(&format!("stats heights.npy --lengths 1 --psd {file} --force"), &[file, reason]);
    }
    fs::rename(bench.path("fifo"), bench.path("results/gap.npy")).unwrap();
    bench.refused_with(
        "solve --heights heights.npy --mean-pressure 0.01 --force --out results",
        &["gap.npy", "regular"],
    );
    assert_eq!(bench.read("table.csv"), "mine");
}

#[cfg(unix)]
#[test]
fn names_that_control_a_terminal_do_not_reach_it() {
    let bench = bench();
    let name = "a\u{1b}[2Jb\nc\u{9b}31md\u{7f}";
    fs::copy(bench.path("heights.npy"), bench.path(&format!("{name}.npy"))).unwrap();
    fs::create_dir(bench.path(name)).unwrap();
    bench.write(
        "study.toml",
        "command = \"sweep\"\nout = \"a\\u001Bb.csv\"\nmean-pressures = \"0.01\"\n[vary]\nheights = [\"a\\u001B[2Jb\\nc\\u009B31md\\u007F.npy\"]\n",
    );
    let own = ["\u{1b}[0m", "\u{1b}[1m", "\u{1b}[1;31m", "\u{1b}[1;32m", "\u{1b}[1;33m"];
    for (arguments, word) in [
        ("solve --heights heights.npy --mean-pressure 0.01 --no-pictures --out", name.to_owned()),
        ("solve --mean-pressure 0.01 --no-pictures --json --out json --heights", format!("{name}.npy")),
        ("sweep --heights heights.npy --mean-pressures 0.01 --out", format!("{name}.csv")),
        ("sweep --heights heights.npy --mean-pressures 0.01 --out", format!("{name}.csv")),
        ("cycle --heights heights.npy --mean-pressures 0.01,0.02 --steps 1 --out", format!("{name}c.csv")),
        ("report s.csv --out", format!("{name}.html")),
        ("report", format!("{name}.csv")),
        ("prepare heights.npy --detrend plane --out", format!("{name}p.npz")),
        ("surface --size 16 --k-s 6 --rms-slope 0.1 --out", format!("{name}s.npy")),
        ("stats", format!("{name}.npy")),
        ("stats --json", format!("{name}.npy")),
        ("stats", format!("{name}.none")),
        ("study --list", "study.toml".to_owned()),
        ("study", "study.toml".to_owned()),
        ("study --json", "study.toml".to_owned()),
    ] {
        let output = run_with(&bench, arguments, &word);
        let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        let plain = own.iter().fold(said.concat(), |text, style| text.replace(style, ""));
        assert!(!plain.contains(|c: char| c.is_control() && c != '\n'), "{arguments}: {plain:?}");
        assert!(!said[0].contains("b\nc"), "{arguments}: {plain:?}");
        if arguments.contains("--json") {
            assert!(serde_json::from_str::<serde_json::Value>(&said[0]).is_ok(), "{arguments}: {said:?}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_a_scene_could_not_have_are_refused() {
    use std::os::unix::ffi::OsStrExt;
    let bench = bench();
    let name = OsStr::from_bytes(b"map\xff.npy");
    fs::copy(bench.path("heights.npy"), bench.0.path().join(name)).unwrap();
    let before = fs::read_dir(bench.path(".")).unwrap().count();
    for arguments in [
        "solve --mean-pressure 0.01 --out results --heights",
        "sweep --mean-pressures 0.01 --out s.csv --heights",
        "solve --heights heights.npy --mean-pressure 0.01 --out results --initial-gap",
        "prepare --detrend plane --out map.npz",
    ] {
        let output = run_with(&bench, arguments, name);
        let said = text(&output.stderr);
        assert!(output.status.code() == Some(1) && said.contains("UTF-8"), "{arguments}: {said}");
        assert_eq!(fs::read_dir(bench.path(".")).unwrap().count(), before, "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_an_error() {
    let bench = bench();
    for arguments in ["stats heights.npy --json", "stats heights.npy", "laws", "completions bash", "solve --help"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
        command.current_dir(bench.path(".")).args(arguments.split(' ')).stdout(File::create("/dev/full").unwrap());
        let output = command.output().unwrap();
        let said = text(&output.stderr);
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{arguments}: {said}");
        assert!(said.contains("standard output cannot be written: No space left"), "{arguments}: {said}");
    }
}

/// Whether there is a temporary folder.
fn is_at_work(bench: &Bench) -> bool {
    bench.names(".").iter().any(|name| name.starts_with(".asperity-"))
}

#[cfg(unix)]
#[test]
fn temporary_folders_go_with_an_interruption() {
    for signal in ["INT", "TERM"] {
        let bench = bench();
        let mut child = Command::new(env!("CARGO_BIN_EXE_asperity"))
            .current_dir(bench.path("."))
            .args("surface --size 2048 --k-s 700 --rms-slope 0.1 --quiet --out large.npy".split(' '))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while !is_at_work(&bench) && child.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(2));
        }
        assert_eq!(child.try_wait().unwrap(), None, "too fast for this test");
        assert!(
            Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap().success()
        );
        assert_eq!(child.wait().unwrap().code(), None);
        assert_eq!(bench.names("."), ["heights.npy", "heights.npy.scene.toml"], "{signal}");
    }
}

#[test]
fn words_and_units_come_back_from_a_table_as_they_were() {
    let bench = bench();
    fs::copy(bench.path("heights.npy"), bench.path("=1+1.npy")).unwrap();
    let sweep = "--length-unit nm,about --pressure-unit \"Pa\" --force-unit N --mean-pressures 0.01 --heights";
    bench.said(&format!("sweep {sweep} =1+1.npy --quiet --out s.csv"));
    let table = bench.read("s.csv");
    let [header, row] = [0, 1].map(|line| table.lines().nth(line).unwrap());
    assert!(
        header.contains(",\"mean_gap [nm,about]\",") && header.contains("\"mean_pressure [\"\"Pa\"\"]\""),
        "{header}"
    );
    assert!(row.contains(",\"=1+1.npy\","), "{row}");
    bench.said("report s.csv");
    let page = bench.read("s.csv.html");
    assert!(page.contains(" nm,about</td>") && page.contains("<td>=1+1.npy</td>"));
    bench.write(
        "study.toml",
        "command = \"sweep\"\nout = \"study.csv\"\nmean-pressures = \"0.01\"\nlength-unit = \"nm,about\"\n\
         pressure-unit = \"Pa\"\nforce-unit = \"N\"\n[vary]\nheights = [\"=1+1.npy\", \"heights.npy\"]\n",
    );
    bench.said("study study.toml --quiet");
    let study = bench.read("study.csv");
    assert!(study.starts_with("case,control,") && study.contains(",\"mean_gap [nm,about]\","), "{study}");
    assert_eq!(study.lines().count(), 3);
    for option in ["--length-unit", "--pressure-unit", "--force-unit"] {
        let long = format!("sweep --heights heights.npy --mean-pressures 0.01 --out t.csv {option} {}", "x".repeat(65));
        bench.refused_with(&long, &[option, "at most 64 characters"]);
    }
}

#[test]
fn the_longest_unit_can_be_read_and_no_longer_one_is_written() {
    let bench = bench();
    let unit = "µ".repeat(64);
    bench.said(&format!("prepare heights.npy --detrend plane --unit {unit} --quiet --out map.npz"));
    assert_eq!(bench.reported("stats map.npz")["length_unit"], unit.as_str());
    let long = format!("prepare heights.npy --detrend plane --unit {unit}x --quiet --out long.npz");
    bench.refused_with(&long, &["--unit", "at most 64 characters"]);
}

/// Runs the tool with so much memory in kB, and expects that it is refused for want of it.
#[cfg(target_os = "linux")]
#[track_caller]
fn assert_too_large(bench: &Bench, memory: &str, arguments: &str, parts: &[&str]) {
    let shell = ["-c", "ulimit -v $1; shift; exec \"$@\"", "sh", memory, env!("CARGO_BIN_EXE_asperity")];
    let mut command = Command::new("sh");
    command.current_dir(bench.path(".")).args(shell).args(arguments.split_whitespace());
    let output = command.output().unwrap();
    let said = text(&output.stderr);
    let errors = said.lines().filter(|line| !line.starts_with("warning: "));
    assert_eq!((output.status.code(), errors.count()), (Some(1), 1), "{arguments}: {said}");
    assert!(parts.iter().all(|part| said.contains(part)), "{arguments}: {said}");
}

#[cfg(target_os = "linux")]
#[test]
fn what_takes_more_memory_than_there_is_is_refused() {
    let bench = Bench::new();
    // a file with holes, which takes no room on the disk
    let header = format!("{:117}\n", "{'descr': '<f8', 'fortran_order': False, 'shape': (20000, 20000), }");
    let mut file = File::create(bench.path("large.npy")).unwrap();
    file.write_all(&[b"\x93NUMPY\x01\0v\0", header.as_bytes()].concat()).unwrap();
    file.seek(SeekFrom::Start(127 + 8 * 20_000 * 20_000)).unwrap();
    file.write_all(&[0]).unwrap();
    bench.write("large.txt", &"1 2 3 4 5 6 7 8\n".repeat(1_500_000));
    bench.write("large.xyz", &(0..3_000_000).map(|k| format!("{} {} 1\n", k / 1000, k % 1000)).collect::<String>());
    let map = bench.path("map.npy");
    asperity_maps::io::create_npy::<f64>(&map, (2048, 2048)).unwrap();
    for command in ["stats", "prepare --out map.npz --mirror", "solve --mean-gap 1 --out out --heights"] {
        assert_too_large(&bench, "2000000", &format!("{command} large.npy"), &["large.npy takes 3.0 GiB of memory"]);
        assert_too_large(&bench, "160000", &format!("{command} large.txt"), &["large.txt takes 128.0 MiB of memory"]);
        assert_too_large(&bench, "160000", &format!("{command} large.xyz"), &["large.xyz takes 96.0 MiB of memory"]);
    }
    for command in ["stats", "prepare --out map.npz --detrend plane"] {
        assert_too_large(&bench, "300000", &format!("{command} large.txt"), &["1500000 x 8 nodes do not fit"]);
    }
    for command in ["solve --mean-gap 1 --no-nested --out out", "sweep --mean-gaps 1 --out s.csv"] {
        let command = format!("{command} --heights map.npy --quiet --threads 1");
        assert_too_large(&bench, "240000", &command, &["a solve on 2048 x 2048 nodes takes 160.0 MiB of memory"]);
    }
    let free = "solve --boundary free --normal-force 1 --out out --heights map.npy --quiet --threads 1";
    assert_too_large(&bench, "240000", free, &["a free half-space on 4096 x 4096 nodes takes 256.0 MiB of memory"]);
    let rough = "surface --size 8192 --rms-slope 0.1 --out rough.npy";
    assert_too_large(&bench, "1000000", rough, &["a random surface on 8192 x 8192 nodes takes 2.0 GiB of memory"]);
    let fine = "prepare map.npy --resample 8192 8192 --out fine.npz";
    assert_too_large(&bench, "1000000", fine, &["8192 x 8192 nodes takes 2.0 GiB of memory, more than is free"]);
}
