//! Full disks, two runs on one file, and heights in files that are something else.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use asperity_maps::io::read_topography;

use super::tool::{GIGABYTE, assert_orderly, bench, limited, names, words};

/// Runs the tool with files of no more than so many blocks of 512 bytes.
fn run_with(folder: &Path, blocks: &str, command: &str) -> Output {
    let output = limited(folder, 4 * GIGABYTE, blocks, &words(command));
    assert_orderly(&output, command);
    let said = String::from_utf8_lossy(&output.stderr);
    // nothing of a library before it
    assert!(output.status.code() != Some(1) || said.starts_with("error: "), "{command}: {said}");
    output
}

fn run(folder: &Path, command: &str) -> Output {
    run_with(folder, "unlimited", command)
}

/// Runs what must be refused on one line of plain text with these parts.
#[track_caller]
fn assert_refused(folder: &Path, command: &str, parts: &[&str]) {
    let output = run(folder, command);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{command}: {said}");
    assert!(said.trim_end_matches('\n').chars().all(|c| !c.is_control()), "{command}: {said:?}");
    assert!(parts.iter().all(|part| said.contains(part)), "{command}: {said}");
}

/// An archive of these members.
fn archive(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

const SIZES: [&str; 7] = ["0", "1", "2", "5", "17", "65", "130"];

#[test]
fn a_full_disk_gives_one_line_and_leaves_no_file_of_a_solve_a_surface_or_a_map() {
    let bench = bench(64);
    let before = names(bench.path());
    let mut full = 0;
    for command in [
        "solve --heights heights.npy --mean-gap 0.0398 --no-pictures --quiet --out out",
        "solve --heights heights.npy --mean-gap 0.0398 --no-pictures --quiet --format npz --out out",
        "solve --heights heights.npy --mean-gap 0.0398 --no-pictures --quiet --format vti --out out",
        "solve --heights heights.npy --mean-gap 0.0398 --quiet --out new/out",
        "surface --size 128 --rms-slope 0.1 --k-s 32 --quiet --out rough.npy",
        "surface --size 64 --rms-slope 0.1 --k-s 16 --quiet --out rough.npy --psd psd.csv",
        "surface --size 64 --rms-slope 0.1 --k-s 16 --quiet --out rough.npz",
        "surface --size 64 --rms-slope 0.1 --k-s 16 --quiet --out new/rough.gsf",
        "prepare heights.npy --detrend plane --quiet --out map.npy",
        "prepare heights.npy --detrend plane --quiet --out map.npz",
        "prepare heights.npy --detrend plane --quiet --out map.gsf",
    ] {
        for blocks in SIZES {
            let output = run_with(bench.path(), blocks, command);
            if output.status.code() == Some(1) {
                assert_eq!(names(bench.path()), before, "{command}, {blocks} blocks");
                full += 1;
                continue;
            }
            for name in names(bench.path()).iter().filter(|name| !before.contains(name)) {
                let path = bench.path().join(name);
                if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }.unwrap();
            }
        }
    }
    assert!(full >= 40, "{full}");
}

const SWEEP: &str = "sweep --heights heights.npy --mean-gaps 0.04:0.034:9 --quiet --fields fields --out table.csv";
const CYCLE: &str = "cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 1e-2 \
                     --mean-gaps 0.045,0.043 --steps 3 --quiet --plot plot.png --out table.csv";

#[test]
fn a_full_disk_leaves_a_table_of_whole_rows_from_which_a_sweep_or_a_cycle_goes_on() {
    for command in [SWEEP, CYCLE] {
        let reference = bench(32);
        assert_eq!(run(reference.path(), command).status.code(), Some(0));
        let whole = fs::read(reference.path().join("table.csv")).unwrap();
        let mut full = 0;
        for blocks in ["0", "1", "2", "3", "4", "5", "8", "17", "20", "33", "40"] {
            let bench = bench(32);
            let output = run_with(bench.path(), blocks, command);
            if output.status.code() != Some(1) {
                continue;
            }
            full += 1;
            let left = names(bench.path());
            assert!(left.iter().all(|name| !name.starts_with('.') && !name.ends_with(".tmp")), "{blocks}: {left:?}");
            let table = fs::read(bench.path().join("table.csv")).unwrap_or_default();
            assert!(whole.starts_with(&table) && table.last().is_none_or(|c| *c == b'\n'), "{command}, {blocks}");
            if !left.contains(&"table.csv".to_owned()) {
                assert_eq!(left, ["heights.npy"], "{command}, {blocks}");
            }
            let fields =
                if left.contains(&"fields".to_owned()) { names(&bench.path().join("fields")) } else { Vec::new() };
            assert!(fields.len() % 3 == 0 && fields.iter().all(|name| name.ends_with(".npy")), "{blocks}: {fields:?}");
            assert_eq!(run(bench.path(), command).status.code(), Some(0), "{command}, {blocks}");
            assert!(fs::read(bench.path().join("table.csv")).unwrap() == whole, "{command}, {blocks}");
            assert_eq!(names(bench.path()), names(reference.path()));
        }
        assert!(full >= 4, "{command}: {full}");
    }
}

fn start(folder: &Path, command: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_asperity"))
        .current_dir(folder)
        .args(words(command))
        .args(["--threads", "1"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

#[test]
fn a_second_run_on_one_file_is_refused_until_the_first_is_over_or_killed() {
    for command in [
        "sweep --heights heights.npy --mean-gaps 0.04:0.03:4000 --quiet --out table.csv",
        "cycle --heights heights.npy --law exponential --work-of-adhesion 1e-4 --range 1e-2 \
         --mean-gaps 0.05,0.03,0.05 --steps 2000 --quiet --out table.csv",
    ] {
        let bench = bench(64);
        let mut first = start(bench.path(), command);
        let table = bench.path().join("table.csv");
        let rows = || fs::read(&table).map_or(0, |table| table.iter().filter(|byte| **byte == b'\n').count());
        while rows() < 3 && first.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(5));
        }
        let parts = ["table.csv: another run is writing there"];
        assert_refused(bench.path(), command, &parts);
        assert_refused(bench.path(), &format!("{command} --force"), &parts);
        assert_eq!(first.try_wait().unwrap(), None, "{command}: it was disturbed, or too fast for this test");
        first.kill().unwrap();
        first.wait().unwrap();
        let before = rows();
        let mut next = start(bench.path(), command);
        while rows() <= before + 1 && next.try_wait().unwrap().is_none() {
            sleep(Duration::from_millis(5));
        }
        assert_eq!(next.try_wait().unwrap(), None, "{command}: it did not continue");
        next.kill().unwrap();
        next.wait().unwrap();
    }
}

#[test]
fn of_runs_that_start_at_once_on_one_file_one_writes_it() {
    for command in [SWEEP, CYCLE] {
        let reference = bench(16);
        assert_eq!(run(reference.path(), command).status.code(), Some(0));
        for round in 0..12 {
            let bench = bench(16);
            let both = [start(bench.path(), command), start(bench.path(), command)];
            let ended = both.map(|child| child.wait_with_output().unwrap());
            assert!(ended.iter().any(|output| output.status.code() == Some(0)), "{command}, {round}: {ended:?}");
            for output in ended.iter().filter(|output| output.status.code() != Some(0)) {
                let said = String::from_utf8_lossy(&output.stderr);
                assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{command}, {round}: {said}");
                assert!(said.contains("another run is writing there"), "{command}, {round}: {said}");
            }
            let read = |bench: &tempfile::TempDir| fs::read(bench.path().join("table.csv")).unwrap();
            assert!(read(&bench) == read(&reference), "{command}, {round}");
            assert_eq!(names(bench.path()), names(reference.path()));
        }
    }
}

#[test]
fn side_lengths_under_another_name_are_not_ignored_in_silence() {
    let bench = bench(16);
    let heights = fs::read(bench.path().join("heights.npy")).unwrap();
    let map = archive(&[("heights.npy", &heights), ("length.npy", b"anything"), ("x.npy", b"")]);
    fs::write(bench.path().join("map.npz"), map).unwrap();
    for command in [
        "solve --heights map.npz --mean-gap 0.0398 --quiet --out out",
        "sweep --heights map.npz --mean-gaps 0.0398 --quiet --out table.csv",
        "stats map.npz --quiet",
        "prepare map.npz --detrend mean --quiet --out mean.npz",
    ] {
        let output = run(bench.path(), command);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.lines().count()), (Some(0), 1), "{command}: {said}");
        let parts = ["warning: sides: the side lengths are unknown", "\"length\", \"x\": give lengths"];
        assert!(parts.iter().all(|part| said.contains(part)), "{command}: {said}");
        let output = run(bench.path(), &format!("{command} --lengths 1 1 --force"));
        let given = command.starts_with("stats") || output.status.code() == Some(0);
        assert!(given && !String::from_utf8_lossy(&output.stderr).contains("not read"), "{command}: {output:?}");
    }
    assert_eq!(read_topography(bench.path().join("map.npz")).unwrap().unread, ["length", "x"]);
}

#[test]
fn an_integer_of_a_scene_beyond_64_bits_is_named_with_its_line_and_key() {
    let bench = bench(16);
    for (scene, key, number) in [
        ("command = \"surface\"\n[roughness]\nseed = 99999999999999999999\n", "line 3: seed", "99999999999999999999"),
        ("command = \"surface\"\nseed = 9_223_372_036_854_775_808\n", "line 2: seed", "9_223_372_036_854_775_808"),
        (&format!("seed = -1{}\n", "0".repeat(99)), "line 1: seed", "-1000000"),
        ("\n\nmean-gaps = [0.1,\n 18446744073709551616]\n", "line 4: mean-gaps", "18446744073709551616"),
        ("[shape]\nsize = 0xffffffffffffffff\n", "line 2: size", "0xffffffffffffffff"),
    ] {
        fs::write(bench.path().join("scene.toml"), scene).unwrap();
        let parts = ["scene.toml", key, number, "9223372036854775807", "quotation marks"];
        assert_refused(bench.path(), "run scene.toml", &parts);
    }
    // what helps, according to that line
    let scene = "command = \"surface\"\nsize = 16\nk-s = 6\nrms-slope = 0.1\nseed = \"18446744073709551615\"\n";
    fs::write(bench.path().join("scene.toml"), scene).unwrap();
    assert_eq!(run(bench.path(), "run scene.toml --quiet --out rough.npy").status.code(), Some(0));
}

#[test]
fn binary_files_are_named_with_a_remedy_and_none_of_their_bytes_reaches_the_terminal() {
    let bench = bench(16);
    let noise: Vec<u8> = (0..3000_u32).map(|i| (i * i / 7) as u8).collect();
    for (name, start, parts) in [
        ("map.gwy", &b"GWYOGwyContainer\0"[..], ["Gwyddion 1 (.gwy)", "as .gsf"]),
        ("map.spm", b"\\*File list\r\n\\Version: 0x05120000\r\n", ["Nanoscope file (.spm)", "Gwyddion"]),
        ("map.tif", b"II*\0\x08\0\0\0", ["TIFF image (.tif)", "thumbnail"]),
        ("map.sur", b"DIGITAL SURF\0", ["Digital Surf file (.sur)", "Gwyddion"]),
        ("map.al3d", b"AliconaImaging\0\r\n", ["Alicona file (.al3d)", "Gwyddion"]),
        ("map.ibw", b"\x05\0", ["Igor file (.ibw)", "Gwyddion"]),
        ("map.opd", b"\x01\0Directory", ["Wyko file (.opd)", "Gwyddion"]),
        ("map.plu", b"Fri Mar 12\0", ["Sensofar file (.plu)", "Gwyddion"]),
        ("map.png", b"\x89PNG\r\n\x1a\n", ["PNG image", "grey values"]),
        ("map.h5", b"\x89HDF\r\n\x1a\n", ["HDF5 file", "numpy.save"]),
        ("map.mat", b"MATLAB 5.0 MAT-file", ["MATLAB file (.mat)", "writematrix"]),
        ("map.pkl", b"\x80\x04\x95", ["Python pickle", "numpy.save"]),
        ("map.x3p", &archive(&[("main.xml", b"<p/>"), ("bindata/data.bin", b"\0")]), [".x3p", "Gwyddion"]),
        ("map.bin", b"\x1b[31m\0\x07", ["binary file", "Gwyddion"]),
        ("map.txt", b"\x1b[31m\x07 2 3\n", ["line 1", "\\u{1b}[31m\\u{7}"]),
        ("map.xyz", b"1 2 \x1b[2J\n", ["line 1", "\\u{1b}[2J"]),
    ] {
        let text = ["map.txt", "map.xyz", "map.x3p"].contains(&name);
        fs::write(bench.path().join(name), if text { start.to_vec() } else { [start, &noise].concat() }).unwrap();
        for command in ["solve --mean-gap 0.1 --out out --heights", "stats", "prepare --out out.npz"] {
            assert_refused(bench.path(), &format!("{command} {name}"), &[&[name][..], &parts].concat());
        }
    }
    for (name, field) in [("unit.gsf", "ZUnits=\x1b[31m\n"), ("title.gsf", "Title=\x1b[31m\nZUnits=V\n")] {
        let header = format!("Gwyddion Simple Field 1.0\nXRes=1\nYRes=1\n{field}");
        let padding = 4 - header.len() % 4;
        fs::write(bench.path().join(name), [header.as_bytes(), &vec![0; padding + 4]].concat()).unwrap();
        for command in ["stats", "prepare --out out.npz --force --detrend mean"] {
            let output = run(bench.path(), &format!("{command} {name}"));
            assert!(![output.stdout, output.stderr].concat().contains(&b'\x1b'), "{command} {name}");
        }
    }
}
