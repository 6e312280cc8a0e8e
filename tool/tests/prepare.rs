//! Measured surfaces from file to contact map, with the tool, and files shared with numpy, Gwyddion and ParaView.

mod files;
mod scan;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::bench::{Bench, text};
use asperity::{Amplitude, Grid, SelfAffine};
use asperity_maps::Topography;
use asperity_maps::io::{read_field, read_topography, write_npy, write_topography};
use ndarray::Array2;

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(name)
}

/// A map as an instrument gives it: 61 x 45 points on 3.05 by 2.25 µm, rough, tilted, bent, with a hole, a lost line
/// and lost points.
fn measured() -> Topography {
    let grid = Grid::new((61, 45), (3.05e-6, 2.25e-6)).unwrap();
    let amplitude = Amplitude::RmsHeight(20e-9);
    let rough =
        SelfAffine::default().hurst(0.8).k_l(1.0).k_r(2.0).k_s(16.0).amplitude(amplitude).random_phase(false).seed(3);
    let mut map = Topography::from(rough.surface(grid).unwrap());
    map.unit = Some("m".to_owned());
    for ((i, j), h) in map.heights.indexed_iter_mut() {
        *h += 1e-9 * (5.0 * i as f64 - 3.0 * j as f64) + 4e-7;
        let hole = (i as f64 - 20.0).hypot(j as f64 - 10.0) < 4.0;
        if hole || (i > 30 && j == 33) || (7 * i + 11 * j).is_multiple_of(97) {
            *h = f64::NAN;
        }
    }
    map
}

/// The number behind a word.
#[track_caller]
fn after(said: &str, word: &str) -> f64 {
    let rest = said.split_once(word).unwrap_or_else(|| panic!("no {word:?} in {said}")).1;
    rest.split_whitespace().next().unwrap().trim_end_matches([',', ':']).parse().unwrap()
}

#[test]
fn a_measured_surface_goes_from_file_to_contact_map() {
    let bench = Bench::new();
    let map = measured();
    write_topography(bench.path("measured.gsf"), &map).unwrap();
    let missing = map.missing();
    let solve = "--modulus 1e9 --mean-pressure 1e6 --pressure-unit Pa --out";

    // as it is, it cannot be solved, and the error says what to do
    let remedy = "asperity prepare --fill";
    bench.refused_with(
        &format!("solve --heights measured.gsf {solve} raw"),
        &[&format!("{missing} of 61 x 45 heights are missing"), remedy],
    );
    bench.refused_with("stats measured.gsf", &[remedy]);
    bench.printed("prepare measured.gsf --fill --out filled.npz");
    assert!(bench.printed("stats filled.npz").contains("3.05 µm x 2.25 µm"));

    let said = bench.printed("prepare measured.gsf --detrend plane --fill --mirror --out surface.npz");
    let lines: Vec<_> = said.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert_eq!(lines, ["read", "detrend", "fill", "mirror", "written"], "{said}");
    assert!(said.contains(&format!("{missing} of 2745 points filled")), "{said}");
    // 5 nm and 3 nm per spacing of 50 nm, and what tilt the roughness has
    assert!((after(&said, "tilt ") - 0.1).abs() < 0.02 && (after(&said, "along x, ") + 0.06).abs() < 0.02, "{said}");
    let rms: Vec<f64> = said.split("rms height ").skip(1).map(|rest| after(rest, "")).collect();
    assert!(rms[0] > 2.0 * rms[1] && (rms[2] / rms[1] - 1.0).abs() < 0.1 && rms[3] == rms[2], "{said}");

    let surface = read_topography(bench.path("surface.npz")).unwrap();
    assert_eq!((surface.heights.dim(), surface.missing(), surface.unit.as_deref()), ((122, 90), 0, Some("m")));
    let (lx, ly) = surface.lengths.unwrap();
    assert!((lx / 6.1e-6 - 1.0).abs() < 1e-12 && (ly / 4.5e-6 - 1.0).abs() < 1e-12);

    let said = bench.printed(&format!("solve --heights surface.npz {solve} results --format npz,vti"));
    assert!(said.contains("converged"), "{said}");
    let report = bench.report("results");
    assert_eq!((report["length_unit"].as_str(), report["lengths"][0].as_f64()), (Some("m"), Some(lx / 2.0)));
    let contact = report["contact_fraction"].as_f64().unwrap();
    assert!(contact > 0.005 && contact < 0.5, "{contact}");
    let names: Vec<_> = said.lines().last().unwrap().split(": ").last().unwrap().split(", ").collect();
    assert_eq!(names, ["report.json", "scene.toml", "fields.npz", "fields.vti", "contact.png", "pressure.png"]);
    let written: Vec<_> = fs::read_dir(bench.path("results")).unwrap().collect();
    assert_eq!(written.len(), names.len());
    assert!(names.iter().all(|name| fs::metadata(bench.path("results").join(name)).unwrap().len() > 200));

    // stats says units too
    let stats = bench.printed("stats surface.npz");
    assert!(
        stats.contains("6.1 µm x 4.5 µm")
            && stats.lines().any(|l| l.starts_with("rms curvature") && l.ends_with(" 1/µm"))
    );
}

#[test]
fn steps_have_a_fixed_order_and_are_those_of_the_library() {
    let bench = Bench::new();
    let map = measured();
    write_topography(bench.path("measured.npz"), &map).unwrap();
    let said = bench.printed(
        "prepare measured.npz --resample 100 64 --window 0.15 --fill --detrend quadric --flip --crop 3 2 50 40 --scale 2 \
         --lengths 6.1e-6 4.5e-6 --unit m --out a.npz",
    );
    let order =
        ["read", "lengths", "scale", "unit", "crop", "flip", "detrend", "fill", "window", "resample", "written"];
    assert_eq!(said.lines().map(|line| line.split_whitespace().next().unwrap()).collect::<Vec<_>>(), order, "{said}");
    let mut expected = map;
    expected.lengths = Some((6.1e-6, 4.5e-6));
    expected.heights.mapv_inplace(|h| 2.0 * h);
    let expected = expected.crop(3..53, 2..42).unwrap().flip().detrend(asperity_maps::Trend::Quadric).unwrap();
    let expected = expected.fill().unwrap().window(0.15).unwrap().resample((100, 64)).unwrap();
    assert_eq!(read_topography(bench.path("a.npz")).unwrap(), expected);
    assert!(said.contains("before 3.05 µm x 2.25 µm") && said.contains("curvatures xx"), "{said}");

    // nothing is done unasked, and what is left undone is said
    let said = bench.printed("prepare measured.npz --out same.npz");
    assert!(said.contains("points are missing still") && said.lines().count() == 3, "{said}");
    let (same, before) = (read_topography(bench.path("same.npz")).unwrap(), measured());
    assert!(same.heights.iter().zip(&before.heights).all(|(a, b)| a == b || a.is_nan() && b.is_nan()));
    assert_eq!(bench.printed("prepare measured.npz --fill --out heights.npy --quiet"), "");
    assert!(bench.printed("prepare measured.npz --fill --out h.npy").contains("give them again by --lengths"));
    assert_eq!(read_topography(bench.path("heights.npy")).unwrap().lengths, None);
    let fit = bench.printed("prepare heights.npy --detrend mean --out level.gsf");
    assert!(fit.contains("unknown side lengths") && fit.contains("removed"), "{fit}");
}

#[test]
fn a_form_is_removed_and_told_with_its_radius() {
    let bench = Bench::new();
    let grid = Grid::new((40, 30), (4e-6, 3e-6)).unwrap();
    let rod = grid.sample(|x, y| (1e-10 - (0.6 * x - 0.8 * y).powi(2)).sqrt() + 1e-9 * (4e6 * x).sin());
    let mut map = Topography::new(rod);
    (map.lengths, map.unit) = (Some((4e-6, 3e-6)), Some("m".to_owned()));
    write_topography(bench.path("rod.npz"), &map).unwrap();
    let said = bench.printed("prepare rod.npz --remove-form cylinder --out a.npz");
    assert!(
        (after(&said, "cylinder of radius ") / 10.0 - 1.0).abs() < 0.01 && said.contains(" µm, bulging upwards"),
        "{said}"
    );
    // the axis is where 0.6 x = 0.8 y
    assert!((after(&said, "axis at ") - 0.6_f64.atan2(0.8).to_degrees()).abs() < 0.5, "{said}");
    let rms = read_topography(bench.path("a.npz")).unwrap().rms_height();
    assert!(rms < 1e-9 && rms > 1e-10, "{rms}");
    let said = bench.printed("prepare rod.npz --flip --remove-form sphere --out b.npz");
    assert!(said.contains("sphere of radius") && said.contains("bulging downwards"), "{said}");
    bench.printed("prepare rod.npz --out rod.npy");
    bench.refused_with("prepare rod.npy --remove-form sphere --out n.npz", &["side length Lx", "known"]);
}

#[test]
fn a_channel_of_a_gwyddion_file_is_chosen_where_several_have_heights() {
    let bench = Bench::new();
    fs::copy(corpus("bad-channels.gwy"), bench.path("scan.gwy")).unwrap();
    fs::copy(corpus("map.gwy"), bench.path("map.gwy")).unwrap();
    for command in ["stats scan.gwy", "prepare scan.gwy --out n.npz", "solve --heights scan.gwy --mean-gap 1 --out n"] {
        bench.refused_with(command, &["0 \"Trace\", 1 \"Retrace\"", "asperity prepare --channel"]);
    }
    for channel in ["0", "Retrace"] {
        bench.said(&format!("prepare scan.gwy --channel {channel} --scale 1e-9 --fill --out {channel}.npz"));
        bench.said(&format!("stats {channel}.npz"));
    }
    let said = bench.said("prepare map.gwy --scale 1e-9 --out map.npz");
    assert!(said.contains("4 x 3 heights, 1 missing, 2 µm x 3 µm"), "{said}");
    bench.refused_with("prepare map.gwy --channel Amplitude --out n.npz", &["\"Amplitude\"", "1 \"Phase\""]);
}

#[test]
fn lengths_of_files_and_of_options() {
    let bench = Bench::new();
    fs::write(bench.path("g.txt"), "# Width: 2 nm\n# Height: 1 nm\n# Value units: nm\n1 2 4\n3 5 9\n").unwrap();
    fs::write(bench.path("plain.txt"), "1 2 4\n3 5 9\n").unwrap();
    let sides = |arguments: &str| {
        let said = bench.printed(arguments);
        said.lines().find_map(|line| line.strip_prefix("side lengths")).unwrap().trim().to_owned()
    };
    assert_eq!(sides("stats g.txt"), "2 nm x 1 nm");
    // headers are rounded: what is near is taken as given
    assert_eq!(sides("stats g.txt --lengths 2.01e-9 1e-9"), "2.01 nm x 1 nm");
    assert_eq!(sides("stats plain.txt"), "unknown: give --lengths for slopes, curvatures and Nayak's parameter");
    assert_eq!(sides("stats plain.txt --lengths 4"), "4 x 6");
    for command in
        ["stats g.txt", "solve --mean-gap 1 --out r --heights g.txt", "sweep --mean-gaps 1 --out r.csv --heights g.txt"]
    {
        bench.refused_with(
            &format!("{command} --lengths 2 1"),
            &["--lengths", "sides of 2 m x 1 m", "2 nm x 1 nm", "leave --lengths out", "asperity prepare"],
        );
    }
    // the file has a unit, in which these are metres
    let output = bench.run("prepare g.txt --lengths 2 1 --out g.npz");
    assert!(
        text(&output.stderr).starts_with("warning: smooth: the rms slope by differences is "),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(sides("stats g.npz"), "2 m x 1 m");
    // sweeps take the lengths and the unit too
    let output = bench.run("sweep --mean-gaps 1e-9 --heights g.txt --json --out s.csv");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["lengths"], &report["length_unit"]), (&serde_json::json!([2e-9, 1e-9]), &"m".into()));
}

#[test]
fn a_low_pass_warns_of_edges_that_do_not_meet() {
    let bench = Bench::new();
    bench.said("surface --size 128 --k-s 8 --rms-height 0.01 --seed 3 --quiet --out rough.npz");
    let low_pass = "prepare rough.npz --lengths 1 1 --crop 0 0 50 50 --cut-off-wavelength 0.05";
    for (options, rings) in [("--out part.npz", true), ("--mirror --out mirrored.npz", false)] {
        let output = bench.run(&format!("{low_pass} {options}"));
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert_eq!(text(&output.stderr).contains("warning: open-edges: "), rings, "{}", text(&output.stderr));
    }
}

#[test]
fn what_cannot_be_prepared_is_refused_and_nothing_is_written() {
    let bench = Bench::new();
    fs::write(bench.path("holes.txt"), "1 nan 3\n4 5 6\n7 8 9\n").unwrap();
    fs::write(bench.path("nothing.txt"), "nan nan\nnan nan\n").unwrap();
    fs::write(bench.path("old.npz"), "old").unwrap();
    fs::write(bench.path("nm.txt"), "# heights in nm\n1 2 3\n4 5 6\n").unwrap();
    for (arguments, parts) in [
        ("prepare holes.txt --window 0.1 --out n.npz", vec!["holes.txt", "9 heights, 1 missing", "add --fill"]),
        ("prepare holes.txt --resample 6 6 --out n.npz", vec!["1 missing", "add --fill"]),
        ("prepare nothing.txt --fill --out n.npz", vec!["number of measured heights", "0"]),
        ("prepare nothing.txt --detrend plane --out n.npz", vec!["number of measured heights"]),
        ("prepare holes.txt --fill --out old.npz", vec!["old.npz", "exists", "--force"]),
        ("prepare holes.txt --fill --out n.tif", vec!["n.tif", "ending", ".npz"]),
        ("prepare holes.txt --fill --window 0.6 --out n.npz", vec!["window", "0.6", "0.5"]),
        ("prepare holes.txt --fill --window 0.1 --mirror --out n.npz", vec!["--window", "--mirror"]),
        ("prepare holes.txt --crop 0 0 4 1 --out n.npz", vec!["crop along x", "is 4", "within the map"]),
        ("prepare holes.txt --crop 0 0 4 --out n.npz", vec!["--crop"]),
        ("prepare holes.txt --fill --resample 0 4 --out n.npz", vec!["--resample", "is 0"]),
        ("prepare holes.txt --fill --resample 16000000 16000000 --out n.npz", vec!["memory", "fewer"]),
        ("prepare holes.txt --scale 0 --out n.npz", vec!["--scale", "is 0"]),
        ("prepare nm.txt --scale 1e-9 --out n.npz", vec!["scale is 1e-9", "the file tells the unit"]),
        ("prepare holes.txt --detrend cubic --out n.npz", vec!["cubic", "quadric"]),
        ("prepare none.txt --out n.npz", vec!["none.txt", "does not exist"]),
        ("prepare holes.txt", vec!["--out"]),
    ] {
        bench.refused_with(arguments, &parts);
        assert_eq!(fs::read_dir(&bench.0).unwrap().count(), 4, "{arguments}");
    }
    assert_eq!(fs::read(bench.path("old.npz")).unwrap(), b"old");
}

#[test]
fn a_cleaning_is_its_steps_and_leaves_parts_out() {
    let bench = Bench::new();
    bench.said("surface --size 64 --lengths 1um --rms-slope 0.1 --k-s 8 --tilt 0.05 --out tilted.npz --quiet");
    let steps = |options: &str| {
        let said = bench.printed(&format!("prepare tilted.npz {options} --mirror --out made.npz --force"));
        let names: Vec<_> = said.lines().map(|line| line.split_whitespace().next().unwrap().to_owned()).collect();
        (names, bench.bytes("made.npz"))
    };
    let (names, cleaned) = steps("--clean");
    assert_eq!(names[1..6], ["align-rows", "remove-scars", "despike", "detrend", "fill"]);
    let all = "--align-rows median --remove-scars --despike --detrend plane --fill";
    assert!(steps(all).1 == cleaned);
    assert_eq!(steps("--clean --without rows,scars --without spikes").0[1..3], ["detrend", "fill"]);
    bench.refused_with("prepare tilted.npz --without rows --out m.npz", &["--clean"]);
    bench.refused_with("prepare tilted.npz --clean --without salt --out m.npz", &["salt", "scars"]);
}
