//! Scans with spikes, scars, offsets and noise.

use super::*;

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
