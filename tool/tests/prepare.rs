//! Measured surfaces from file to contact map, with the tool, and files shared with numpy, Gwyddion and ParaView.

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
    assert_eq!(names, ["fields.npz", "fields.vti", "report.json", "scene.toml", "contact.png", "pressure.png"]);
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

/// A scan of 60 by 50 nodes on 6 by 5 nm: rough, with offsets between its lines, three spikes and a code.
fn scanned() -> Topography {
    let grid = Grid::new((60, 50), (6.0, 5.0)).unwrap();
    let amplitude = Amplitude::RmsHeight(0.1);
    let rough =
        SelfAffine::default().hurst(0.8).k_l(1.0).k_r(2.0).k_s(12.0).amplitude(amplitude).random_phase(false).seed(4);
    let mut map = Topography::from(rough.surface(grid).unwrap());
    map.unit = Some("nm".to_owned());
    map.heights.indexed_iter_mut().for_each(|((_, j), h)| *h += (1.7 * j as f64).sin());
    [(7, 9), (30, 31), (55, 2)].iter().for_each(|node| map.heights[*node] += 25.0);
    (20..40).for_each(|i| map.heights[[i, 44]] = -9999.0);
    map
}

#[test]
fn a_scan_loses_its_code_its_offsets_and_its_spikes_step_by_step() {
    let bench = Bench::new();
    let map = scanned();
    write_topography(bench.path("scan.npz"), &map).unwrap();
    let steps = "--missing -9999 --align-rows median --despike --detrend 3 --fill";
    let said = bench.printed(&format!("prepare scan.npz {steps} --out a.npz"));
    let order = ["read", "missing", "align-rows", "despike", "detrend", "fill", "written"];
    assert_eq!(said.lines().map(|line| line.split_whitespace().next().unwrap()).collect::<Vec<_>>(), order, "{said}");
    for part in ["-9999 stood at 20 of 3000 points", "50 lines along x changed by 0.", "3 of 3000 points deviated"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // the offsets have an rms of 1/sqrt(2), and the spikes are 25 above their surroundings
    assert!((after(&said, "changed by ") - 0.7).abs() < 0.1, "{said}");
    assert!((after(&said, "the largest deviation was ") - 25.0).abs() < 1.0, "{said}");
    assert!(said.contains("polynomial of order 3 removed, heights changed by") && said.contains(" nm rms"), "{said}");
    let expected =
        map.declare_missing(-9999.0).align_rows(asperity_maps::RowAlignment::Median, asperity_maps::ScanAxis::X);
    let expected = expected.unwrap().despike(10.0).unwrap().detrend(asperity_maps::Trend::Polynomial(3)).unwrap();
    let prepared = read_topography(bench.path("a.npz")).unwrap();
    assert_eq!(prepared, expected.fill().unwrap());
    assert!(prepared.rms_height() < 0.2, "{}", prepared.rms_height());
    // its scene repeats it
    bench.printed("run a.npz.scene.toml --out b.npz");
    assert_eq!(read_topography(bench.path("b.npz")).unwrap(), prepared);
    // other thresholds, methods and directions, each told
    let said = bench
        .said("prepare scan.npz --missing -9999 --align-rows polynomial:2 --scan-axis y --despike 1e9 --out c.npz");
    assert!(said.contains("60 lines along y") && said.contains("none of 3000 points"), "{said}");
    bench.printed("run c.npz.scene.toml --align-rows median-difference --out d.npz");
    for (arguments, parts) in [
        ("--align-rows mode", ["mode", "median-difference"]),
        ("--align-rows median:2", ["median:2", "polynomial:ORDER"]),
        ("--align-rows polynomial:13", ["polynomial:13", "from 0 to 12"]),
        ("--scan-axis y", ["--align-rows", ""]),
        ("--despike 0", ["--despike", "positive"]),
        ("--missing x", ["--missing", "number"]),
        ("--detrend 13", ["--detrend", "from 0 to 12"]),
        ("--channel 0", ["no channels", "leave"]),
        ("--remove-form cone", ["cone", "cylinder"]),
    ] {
        bench.refused_with(&format!("prepare scan.npz {arguments} --out n.npz"), &parts);
    }
}

#[test]
fn a_code_is_guessed_and_named_but_not_taken_unasked() {
    let bench = Bench::new();
    write_topography(bench.path("scan.npz"), &scanned()).unwrap();
    let warned = |arguments: &str| {
        let output = bench.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        (text(&output.stderr), text(&output.stdout))
    };
    let (warning, said) = warned("prepare scan.npz --out a.npz --json");
    for part in ["warning: missing-code: -9999 stands at 20 nodes", "--missing -9999"] {
        assert!(warning.contains(part), "{part}: {warning}");
    }
    let report: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(report["warnings"][0]["code"], "missing-code");
    assert_eq!(read_topography(bench.path("a.npz")).unwrap(), scanned());
    assert_eq!(warned("prepare scan.npz --missing -9999 --out b.npz").0, "");
    // a map without one has no warning, holes or not
    write_topography(bench.path("measured.npz"), &measured()).unwrap();
    assert_eq!(warned("prepare measured.npz --out c.npz").0, "");
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
fn scars_and_noise_are_found_told_and_left_out() {
    let bench = Bench::new();
    let grid = Grid::square(128, 1e-6).unwrap();
    let rough = SelfAffine::default().k_l(2.0).k_r(2.0).k_s(60.0).amplitude(Amplitude::RmsHeight(5e-9)).seed(9);
    let mut map = Topography::from(rough.surface(grid).unwrap());
    map.unit = Some("m".to_owned());
    write_topography(bench.path("clean.npz"), &map).unwrap();
    let clean = map.heights.clone();
    // pieces of single lines far above their neighbours
    let scars = [(10, 30, 40), (60, 100, 7), (20, 60, 90), (80, 110, 64), (5, 40, 120)];
    for (from, to, line) in scars {
        (from..to).for_each(|i| map.heights[[i, line]] += 20e-9);
    }
    write_topography(bench.path("scan.npz"), &map).unwrap();
    let solve = "--modulus 10GPa --mean-pressure 100MPa --no-pictures --quiet --force --out r";
    let warned = |heights: &str| text(&bench.run(&format!("solve --heights {heights} {solve}")).stderr);
    assert_eq!(warned("clean.npz"), "");
    let told = warned("scan.npz");
    assert!(told.contains("warning: scars: ") && told.contains("along x"), "{told}");
    assert!(told.contains("prepare --remove-scars --scan-axis x"), "{told}");
    // a high threshold leaves them, which a map with its images remembers, too
    let said = bench.printed("prepare scan.npz --remove-scars 1000 --mirror --out left.npz");
    assert!(said.contains("no scars along x"), "{said}");
    let told = warned("left.npz");
    assert!(told.contains("use --remove-scars below 1000"), "{told}");

    let said = bench.printed("prepare scan.npz --remove-scars --out removed.npz");
    let on_scars: usize = scars.iter().map(|(from, to, _)| to - from).sum();
    assert!(
        said.contains("5 scars along x beyond ") && said.contains(&format!("{on_scars} of 16384 points replaced")),
        "{said}"
    );
    let removed = read_topography(bench.path("removed.npz")).unwrap().heights;
    let square = |heights: &Array2<f64>| heights.iter().zip(&clean).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    // what the membrane has not is the roughness within a spacing, a tenth of the rms height, on one node in 90
    assert!(square(&removed) < 1e-3 * square(&map.heights), "{} of {}", square(&removed), square(&map.heights));
    assert_eq!(warned("removed.npz"), "");
    let said = bench.printed("prepare clean.npz --remove-scars 1 --scan-axis y --out same.npz");
    assert!(said.contains("no scars along y beyond "), "{said}");
    assert_eq!(read_topography(bench.path("same.npz")).unwrap().heights, clean);
    bench.printed("run removed.npz.scene.toml --out again.npz");
    assert_eq!(read_topography(bench.path("again.npz")).unwrap().heights, removed);

    // white noise has a knee, at which it is cut off
    assert!(bench.reported("stats clean.npz")["knee_wavelength"].is_null());
    let mut state = 1_u64;
    map.heights = clean.mapv(|height| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        height + 8e-9 * ((state >> 40) as f64 / 2_f64.powi(24) - 0.5)
    });
    write_topography(bench.path("noisy.npz"), &map).unwrap();
    let knee = bench.reported("stats noisy.npz")["knee_wavelength"].as_f64().unwrap();
    assert!(knee > 16e-9 && knee < 500e-9, "{knee}");
    assert!(bench.printed("stats noisy.npz").contains("knee of the spectrum"));
    assert!(warned("noisy.npz").contains("warning: noise: "), "{}", warned("noisy.npz"));
    let prepare = format!("prepare noisy.npz --cut-off-wavelength {:.1}nm", 1e9 * knee);
    let said = bench.printed(&format!("{prepare} --out smooth.npz"));
    assert!(said.contains("waves shorter than ") && said.contains("rms slope by differences "), "{said}");
    let smooth = read_topography(bench.path("smooth.npz")).unwrap().heights;
    assert!(square(&smooth) < 0.5 * square(&map.heights) && warned("smooth.npz").is_empty());
    assert!(bench.reported("stats smooth.npz")["knee_wavelength"].is_null());

    bench.printed("prepare clean.npz --out bare.npy --quiet");
    bench.refused_with("prepare bare.npy --cut-off-wavelength 0.1 --out n.npz", &["side length Lx", "known"]);
    bench.refused_with("prepare clean.npz --cut-off-wavelength 0 --out n.npz", &["--cut-off-wavelength", "positive"]);
    bench.refused_with("prepare clean.npz --remove-scars -1 --out n.npz", &["--remove-scars", "positive"]);
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
    let help = bench.said("prepare --help").split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["Only the steps that you choose are done", "--remove-form, --detrend, --fill, --window", "Examples"] {
        assert!(help.contains(part), "{part}: {help}");
    }
}

/// Written by numpy 2.4, gsffile 0.5 and gwyfile 0.2: h = i + 10 j on 4 x 3 nodes of 2 by 3 µm, and [2, 1] is missing.
#[test]
fn files_of_others_have_their_heights_where_they_belong() {
    for (name, scale, lengths, unit) in [
        ("map.npz", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("map-deflated.npz", 1.0, Some((2.0, 3.0)), Some("\u{b5}m")),
        ("map.gsf", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("map.gwy", 1.0, Some((2e-6, 3e-6)), Some("m")),
        ("bare.gsf", 1.0, None, None),
        ("gwyddion.txt", 1e-9, Some((2e-6, 3e-6)), Some("m")),
        ("map.xyz", 1.0, Some((2.0, 3.0)), None),
    ] {
        let map = read_topography(corpus(name)).unwrap();
        assert_eq!((map.heights.dim(), map.missing(), map.unit.as_deref()), ((4, 3), 1, unit), "{name}");
        assert!(map.heights.is_standard_layout());
        for ((i, j), h) in map.heights.indexed_iter() {
            let expected = scale * (i as f64 + 10.0 * j as f64);
            assert!(
                if (i, j) == (2, 1) { h.is_nan() } else { (h - expected).abs() <= 1e-15 * expected },
                "{name}: {h} at {i}, {j}"
            );
        }
        assert_eq!(map.lengths.is_some(), lengths.is_some());
        if let (Some(found), Some(lengths)) = (map.lengths, lengths) {
            assert!((found.0 / lengths.0 - 1.0).abs() < 1e-12 && (found.1 / lengths.1 - 1.0).abs() < 1e-12, "{name}");
        }
    }
}

#[test]
fn all_formats_hold_the_same_fields() {
    let bench = Bench::new();
    for precision in ["f32", "f64"] {
        let heights = Array2::from_shape_fn((6, 4), |(i, j)| 0.01 * ((i * i + 2 * j) as f64).cos());
        write_npy(bench.path("h.npy"), &heights).unwrap();
        bench.said(&format!(
            "solve --heights h.npy --lengths 3 1 --mean-pressure 2e-3 --precision {precision} --law exponential \
             --work-of-adhesion 1e-5 --range 1e-2 --stability --format npy --format npz --format vti --no-pictures --out {precision}"
        ));
        let folder = bench.path(precision);
        let vti = fs::read(folder.join("fields.vti")).unwrap();
        let start = vti.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        let head = text(&vti[..start]);
        assert!(
            head.contains(r#"WholeExtent="0 5 0 3 0 0" Origin="-1.5e0 -5e-1 0" Spacing="5e-1 2.5e-1 2.5e-1""#),
            "{head}"
        );
        let width = if precision == "f32" { 4 } else { 8 };
        assert_eq!(head.matches(if width == 4 { "Float32" } else { "Float64" }).count(), 4);
        assert!(vti.ends_with(b"</AppendedData>\n</VTKFile>\n"));
        let archive = fs::read(folder.join("fields.npz")).unwrap();
        for (k, name) in ["gap", "pressure", "contact_pressure", "mode"].into_iter().enumerate() {
            let field = read_field(folder.join(format!("{name}.npy"))).unwrap();
            let offset = k * (8 + 24 * width);
            assert!(head.contains(&format!(r#"Name="{name}" format="appended" offset="{offset}""#)), "{head}");
            let block = &vti[start + offset..];
            assert_eq!(block[..8], (24 * width as u64).to_le_bytes());
            for ((i, j), value) in field.indexed_iter() {
                // x runs fastest
                let bytes = &block[8 + (6 * j + i) * width..][..width];
                let found = match width {
                    4 => f64::from(f32::from_le_bytes(bytes.try_into().unwrap())),
                    _ => f64::from_le_bytes(bytes.try_into().unwrap()),
                };
                // the mode is f64 on its own, and in the precision of the others with them
                assert!(found == *value || name == "mode" && (found - value).abs() < 1e-6, "{name} at {i}, {j}");
            }
            // stored as the files are
            let npy = fs::read(folder.join(format!("{name}.npy"))).unwrap();
            assert!(name == "mode" || archive.windows(npy.len()).any(|window| window == npy), "{name}");
        }
        bench.refused_with(&format!("stats {precision}/fields.npz"), &["5 arrays", "named heights"]);
    }
    // what is there is not overwritten, whatever its format
    bench.refused_with(
        "solve --heights h.npy --mean-gap 1 --format vti --out f64",
        &["f64/report.json", "exists", "--force"],
    );
    bench.refused_with("solve --heights h.npy --mean-gap 1 --format hdf5 --out x", &["hdf5", "npy", "npz", "vti"]);
}

/// A Python with numpy: by `.ci/run` in the target folder, or any.
fn python() -> Option<PathBuf> {
    let target = Path::new(env!("CARGO_BIN_EXE_asperity")).ancestors().nth(2)?;
    let candidates = [target.join("numpy/bin/python"), PathBuf::from("python3")];
    let has_numpy = |python: &PathBuf| {
        Command::new(python).args(["-c", "import numpy"]).output().is_ok_and(|output| output.status.success())
    };
    candidates.into_iter().find(has_numpy)
}

/// Runs a script in the folder of a bench, and returns what it prints.
fn script(python: &Path, bench: &Bench, script: &str) -> String {
    let output = Command::new(python).current_dir(&bench.0).args(["-c", script]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

const SKIPPED: &str = "skipped: neither target/numpy/bin/python nor python3 has numpy; .ci/run installs it";

#[test]
fn scripts_of_the_page_on_python_run() {
    let Some(python) = python() else { return println!("{SKIPPED}") };
    let bench = Bench::new();
    let page = include_str!("../../docs/program/numpy.md");
    let scripts: Vec<_> = page.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    let [before, after @ ..] = &scripts[..] else { panic!("{page}") };
    let solve = page.split("\nasperity ").nth(1).unwrap().split("\n```").next().unwrap().replace('\\', " ");
    script(&python, &bench, before);
    bench.said(&solve);
    assert!(script(&python, &bench, &after.concat()).starts_with("contact 0."));
    bench.said("solve --heights heights.npz --modulus 70e9 --mean-pressure 2e8 --format npz --out same");
    script(
        &python,
        &bench,
        "import numpy as np
assert (np.load('same/fields.npz')['gap'] == np.load('results/gap.npy')).all()",
    );
}

#[test]
fn numpy_reads_what_is_written_and_writes_what_is_read() {
    let Some(python) = python() else { return println!("{SKIPPED}") };
    let bench = Bench::new();
    let run = |lines: &str| script(&python, &bench, lines);
    // every kind of number, order and container: h = 3 i - j² is exact in all of them
    run("import numpy as np
h = np.array([[3 * i - j * j for j in range(4)] for i in range(7)])
for dtype in ['<f4', '>f4', '<f8', '>f8', 'i1', '<i2', '>i4', '<i8']:
    np.save(dtype.strip('<>') + ('b' if '>' in dtype else 'l') + '.npy', h.astype(dtype))
np.save('fortran.npy', np.asfortranarray(h.astype('f8')))
np.savez('one.npz', h)
np.savez_compressed('named.npz', heights=h, lengths=(7e3, 4e3), unit='m', other=np.zeros((9, 9)))
np.savetxt('text.txt', h, header='seven lines of four')");
    let expected = Array2::from_shape_fn((7, 4), |(i, j)| 3.0 * i as f64 - (j * j) as f64);
    let mut read = 0;
    for entry in fs::read_dir(&bench.0).unwrap() {
        let path = entry.unwrap().path();
        assert_eq!(read_field(&path).unwrap(), expected, "{}", path.display());
        read += 1;
    }
    assert_eq!(read, 12);
    let named = read_topography(bench.path("named.npz")).unwrap();
    assert_eq!((named.lengths, named.unit.as_deref()), (Some((7e3, 4e3)), Some("m")));

    // the other way, with the check that only the solution passes
    bench.said("solve --heights named.npz --modulus 1 --mean-gap 20 --format npy,npz --no-pictures --out r");
    bench.said("prepare named.npz --detrend plane --out back.npz");
    let said = run("import numpy as np, json
report = json.load(open('r/report.json'))
fields = np.load('r/fields.npz')
assert sorted(fields) == ['contact_pressure', 'gap', 'lengths', 'pressure'], sorted(fields)
for name in ['gap', 'pressure', 'contact_pressure']:
    alone = np.load('r/' + name + '.npy')
    assert alone.dtype == np.float64 and alone.shape == (7, 4)
    assert np.array_equal(fields[name], alone), name
assert list(fields['lengths']) == report['lengths']
assert abs(fields['gap'].mean() / 20 - 1) < 1e-12
assert (fields['gap'] * fields['contact_pressure'] == 0).all()
back = np.load('back.npz')
assert back['unit'] == 'm' and back['unit'].shape == () and list(back['lengths']) == [7e3, 4e3]
x, y = np.meshgrid(np.arange(7.0), np.arange(4.0), indexing='ij')
terms = np.stack([np.ones(28), x.ravel(), y.ravel()], 1)
h = np.load('one.npz')['arr_0'].ravel()
rest = h - terms @ np.linalg.lstsq(terms, h, rcond=None)[0]
assert abs(back['heights'].ravel() - rest).max() < 1e-13, abs(back['heights'].ravel() - rest).max()
print('same')");
    assert_eq!(said.trim(), "same");
}

#[test]
fn offsets_of_lines_along_the_other_axis_are_told() {
    let bench = Bench::new();
    // an image with scan lines as rows, each with an offset of its own
    let drift = |row: usize| ((row as f64 * 0.618).fract() - 0.5).powi(3);
    let grain = |row: usize, column: usize| 1e-3 * ((row * 7 + column * 13) as f64 * 0.414).fract();
    let image = ndarray::Array2::from_shape_fn((96, 80), |(row, column)| drift(row) + grain(row, column));
    let mut map = Topography::new(image);
    (map.lengths, map.unit) = (Some((96.0, 80.0)), Some("nm".to_owned()));
    write_topography(bench.path("image.npz"), &map).unwrap();
    let told = |arguments: &str| {
        let output = bench.run(&format!("prepare image.npz --align-rows median --json {arguments}"));
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let report: serde_json::Value = serde_json::from_str(&text(&output.stdout)).unwrap();
        let codes: Vec<_> = report["warnings"].as_array().unwrap().iter().map(|found| found["code"].clone()).collect();
        (text(&output.stderr), codes)
    };
    let (said, codes) = told("--out a.npz");
    assert_eq!(codes, ["scan-axis", "line-offsets"]);
    assert!(
        said.starts_with("warning: scan-axis: lines along y are offset") && said.contains("choose scan axis y"),
        "{said}"
    );
    assert_eq!(told("--scan-axis y --out b.npz"), (String::new(), vec![]));
}

#[test]
fn texts_of_instruments_are_read_by_what_the_options_say_of_them() {
    let bench = Bench::new();
    let channel = |title: &str, heights: &str| {
        format!("# Kanal: {title}\n# Breite: 3 \u{b5}m\n# H\u{f6}he: 2000 nm\n# Einheiten: nm\n{heights}\n")
    };
    let both = channel("Topo", "1 2 4\n4 6 3") + &channel("Topo zur\u{fc}ck", "9 2 1\n4 6 3");
    bench.write("two.txt", &both);
    bench.refused_with("prepare two.txt --out two.npz", &["2 channels (0 \"Topo\", 1 \"Topo zurück\")"]);
    bench.said("prepare two.txt --channel 1 --out two.npz");
    let map = read_topography(bench.path("two.npz")).unwrap();
    assert_eq!((map.heights.dim(), map.heights[[0, 1]], map.lengths), ((3, 2), 9e-9, Some((3e-6, 2e-6))));

    bench.write("words.txt", "Height (nm)\nof a tip\n1 2 lost\n4 7 6\n");
    bench.refused_with("stats words.txt", &["line 3: \"lost\"", "--missing-word \"lost\""]);
    let refused = ["line 1: \"Height\"", "--skip-lines 2"];
    bench.refused_with("prepare words.txt --missing-word lost --out words.npz", &refused);
    let said = bench.said("prepare words.txt --skip-lines 2 --missing-word lost --out words.npz");
    assert!(said.contains("2 x 3 heights, 1 missing"), "{said}");
    bench.refused_with("prepare words.npz --masked --out masked.npz", &["has no masks"]);

    bench.write("table.csv", "0,1.0,2,3,4,5\n1,5.0,2,7,3,1\n2,8.0,1,6,3,4\n");
    let said = text(&bench.run("stats table.csv").stderr);
    assert!(said.contains("warning: axes: the first line"), "{said}");
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
