//! `asperity surface` and `asperity stats`, end to end.

use std::f64::consts::TAU;
use std::fs;

use crate::bench::Bench;
use asperity::{Amplitude, Grid, SelfAffine};
use asperity_maps::io::{read_field, read_topography};

/// The columns of a comma-separated file, with its header.
fn csv(bench: &Bench, name: &str) -> (String, Vec<Vec<f64>>) {
    let content = bench.read(name);
    let (header, rows) = content.split_once('\n').unwrap();
    let rows = rows.lines().map(|row| row.split(',').map(|value| value.parse().unwrap()).collect());
    (header.to_owned(), rows.collect())
}

/// The number in the row of a table; several rows may have the same name.
#[track_caller]
fn numbers(table: &str, name: &str) -> Vec<f64> {
    let rows = table.lines().filter_map(|line| line.strip_prefix(name));
    rows.filter_map(|rest| rest.trim().parse().ok()).collect()
}

#[test]
fn a_surface_is_the_librarys_and_is_measured_alike() {
    let bench = Bench::new();
    let options = "--shape 100 90 --lengths 2e-6 3e-6 --rms-height 1e-8 --hurst 0.6 --k-l 2 --k-r 5 --k-s 25 --seed 12";
    let said = bench.said(&format!("surface {options} --out rough.npy --psd psd.csv"));
    assert_eq!(bench.names(""), ["psd.csv", "rough.npy", "rough.npy.scene.toml"]);

    let grid = Grid::new((100, 90), (2e-6, 3e-6)).unwrap();
    let rough = SelfAffine::default()
        .hurst(0.6)
        .k_l(2.0)
        .k_r(5.0)
        .k_s(25.0)
        .amplitude(Amplitude::RmsHeight(1e-8))
        .random_phase(false)
        .seed(12);
    let surface = rough.surface(grid).unwrap();
    assert_eq!(read_field(bench.0.path().join("rough.npy")).unwrap(), surface.heights());
    let expected = surface.statistics();
    for (name, values) in [
        ("rms height", vec![1e-8]),
        ("lowest", vec![expected.lowest]),
        ("highest", vec![expected.highest]),
        ("rms slope, spectral", vec![expected.rms_slope]),
        ("rms curvature, spectral", vec![expected.rms_curvature]),
        ("  by differences", vec![expected.rms_slope_differences, expected.rms_curvature_differences]),
        ("Nayak's parameter", vec![expected.nayak]),
        ("kurtosis", vec![expected.kurtosis]),
    ] {
        let found = numbers(&said, name);
        assert_eq!(found.len(), values.len(), "{name}: {said}");
        for (found, value) in found.into_iter().zip(values) {
            assert!((found / value - 1.0).abs() < 1e-6, "{name}: {found} is not {value}");
        }
    }
    assert!(
        said.contains("100 x 90") && said.contains("2e-6 x 3e-6") && said.contains("heights in rough.npy"),
        "{said}"
    );

    let measured = bench.said("stats rough.npy --lengths 2e-6 3e-6 --psd measured.csv");
    assert!(said.starts_with(measured.trim_end()), "{measured}");
    let ((with_target, rows), (header, same)) = (csv(&bench, "psd.csv"), csv(&bench, "measured.csv"));
    assert_eq!(
        (with_target.as_str(), header.as_str()),
        ("wave_number,density,waves,target", "wave_number,density,waves")
    );
    assert_eq!(rows.iter().map(|row| row[..3].to_vec()).collect::<Vec<_>>(), same);
    bench.said("surface --shape 100 90 --lengths 2um 3um --rms-height 10nm --k-s 20 --quiet --out si.npz --psd si.csv");
    bench.said("stats rough.npy --lengths 2um 3um --quiet --psd units.csv");
    bench.said("surface --shape 64 1 --lengths 2um --rms-height 10nm --k-s 20 --quiet --out line.npz --psd line.csv");
    for (file, header) in [
        ("si.csv", "wave_number [1/m],density [m4],waves,target [m4]"),
        ("units.csv", "wave_number [1/m],density [m4],waves"),
        ("line.csv", "wave_number [1/m],density [m3],waves,target [m3]"),
    ] {
        assert_eq!(csv(&bench, file).0, header, "{file}");
    }
}

#[test]
fn sizes_seeds_phases_and_threads() {
    let bench = Bench::new();
    let made = |options: &str| {
        let said =
            bench.said(&format!("surface --rms-slope 0.1 --k-s 20 --force --quiet --out a/b/rough.npy {options}"));
        assert_eq!(said, "");
        bench.bytes("a/b/rough.npy")
    };
    let first = made("--size 64");
    assert!(first == made("--shape 64 64 --seed 0 --k-l 4 --k-r 4 --hurst 0.8 --threads 1"));
    for other in
        ["--size 64 --seed 1", "--size 64 --random-phase", "--size 65", "--size 64 --k-r 6", "--size 64 --hurst 1"]
    {
        assert!(first != made(other), "{other}");
    }
    bench.said("surface --rms-slope 0.1 --size 64 --k-s 20 --random-phase --quiet --out r.npy");
    let line = bench.said("surface --rms-slope 0.1 --shape 4096 1 --lengths 5 --k-s 1000 --out line.npy");
    assert!(
        line.contains("4096 x 1")
            && numbers(&line, "side lengths") == [5.0]
            && numbers(&line, "rms slope, spectral") == [0.1]
    );
    assert_eq!(bench.said("stats line.npy --lengths 5"), line[..line.find("heights in").unwrap()]);
    // a surface can be solved as it comes
    assert!(bench.said("solve --heights r.npy --mean-pressure 0.01 --no-pictures --out solved").contains("converged"));
}

#[test]
fn slopes_of_a_map_without_side_lengths_are_not_told() {
    let bench = Bench::new();
    fs::write(bench.path("wave.txt"), "0 1 0 -1\n".repeat(3)).unwrap();
    let said = bench.said("stats wave.txt");
    let row = |name: &str| said.lines().find_map(|line| line.strip_prefix(name)).map(str::trim);
    assert!(row("side lengths").unwrap().starts_with("unknown: give --lengths"), "{said}");
    assert_eq!(
        (row("rms slope, spectral"), row("rms curvature, spectral"), row("Nayak's parameter")),
        (Some("-"), Some("-"), Some("-"))
    );
    assert_eq!((numbers(&said, "highest"), numbers(&said, "kurtosis")), (vec![1.0], vec![2.0]));
    let (unknown, known) = (bench.reported("stats wave.txt"), bench.reported("stats wave.txt --lengths 3 4"));
    for key in ["lengths", "rms_slope", "rms_slope_differences", "rms_curvature", "rms_curvature_differences", "nayak"]
    {
        assert!(unknown[key].is_null() && !known[key].is_null(), "{key}: {unknown} {known}");
    }
    assert_eq!((&unknown["rms_height"], &unknown["skewness"]), (&known["rms_height"], &known["skewness"]));
    bench.refused_with("stats wave.txt --psd psd.csv", &["wave.txt", "side lengths are unknown", "--lengths"]);
    assert_eq!(bench.names(""), ["wave.txt"]);
}

#[test]
fn bad_input_is_refused_on_one_line_and_writes_nothing() {
    let bench = Bench::new();
    fs::write(bench.0.path().join("old.npy"), "old").unwrap();
    fs::write(bench.0.path().join("wave.txt"), "0 1 0 -1\n0 1 0 nan\n").unwrap();
    let good = "surface --size 64 --k-s 20 --rms-slope 0.1";
    for (arguments, parts) in [
        (format!("{good} --out old.npy"), vec!["old.npy", "exists", "--force"]),
        (format!("{good} --out new.npy --psd old.npy"), vec!["old.npy", "exists", "--force"]),
        (format!("{good} --out new.npy --psd ./new.npy"), vec!["--psd", "new.npy", "a name of its own"]),
        (format!("{good} --out wave.txt/new.npy"), vec!["wave.txt", "not a folder"]),
        (format!("{good} --out .."), vec!["..", "no name for a file"]),
        (good.to_owned(), vec!["--out"]),
        (
            "surface --size 64 --rms-slope 0.1 --out n.npy".to_owned(),
            vec!["k_s is 64", "below 32", "64 x 64", "more nodes"],
        ),
        ("surface --size 64 --k-s 20 --out n.npy".to_owned(), vec!["--rms-height", "--rms-slope"]),
        ("surface --k-s 20 --rms-slope 1 --out n.npy".to_owned(), vec!["--size", "--shape"]),
        (format!("{good} --rms-height 1 --out n.npy"), vec!["--rms-height", "cannot be used with"]),
        (format!("{good} --shape 3 4 --out n.npy"), vec!["--shape", "cannot be used with"]),
        (format!("{good} --hurst 1.5 --out n.npy"), vec!["Hurst exponent", "1.5", "from 0 to 1"]),
        (format!("{good} --seed -1 --out n.npy"), vec!["--seed", "-1"]),
        (format!("{good} --lengths 0 --out n.npy"), vec!["--lengths", "is 0", "positive"]),
        ("surface --size 0 --rms-slope 1 --out n.npy".to_owned(), vec!["--size", "is 0", "from 1"]),
        ("surface --size -3 --rms-slope 1 --out n.npy".to_owned(), vec!["--size", "-3", "from 1"]),
        ("surface --size 16000000 --rms-slope 1 --out n.npy".to_owned(), vec!["16000000", "memory", "fewer"]),
        ("surface --size 64 --k-s 20 --rms-slope 0 --out n.npy".to_owned(), vec!["--rms-slope", "is 0", "positive"]),
        ("stats".to_owned(), vec!["FILE"]),
        ("stats nothing.npy".to_owned(), vec!["nothing.npy", "does not exist"]),
        (
            "stats wave.txt".to_owned(),
            vec!["wave.txt: 1 of 2 x 4 heights are missing", "[1, 3]", "asperity prepare --fill"],
        ),
        ("stats wave.txt --psd old.npy".to_owned(), vec!["old.npy", "exists", "--force"]),
        ("stats wave.txt --lengths -1".to_owned(), vec!["--lengths", "-1", "positive"]),
    ] {
        bench.refused_with(&arguments, &parts);
        assert_eq!(bench.names(""), ["old.npy", "wave.txt"], "{arguments}");
    }
    assert_eq!(bench.bytes("old.npy"), b"old");
}

/// The coefficients of a wave of amplitude 0.02 with 3 periods along x and -1 along y, and of one of half of it.
const WAVES: &str = "# qX, qY, Re, Im\n3, -1, 0.01, 0\n0, 2, 0, 0.005\n";

#[test]
fn fourier_coefficients_make_a_surface() {
    let bench = Bench::new();
    bench.write("waves.dat", WAVES);
    let said = bench.said("surface --fourier waves.dat --size 16 --out waves.npy --psd psd.csv");
    let found = read_field(bench.path("waves.npy")).unwrap();
    for ((i, j), h) in found.indexed_iter() {
        let (x, y) = (i as f64 / 16.0, j as f64 / 16.0);
        let expected = 0.02 * (TAU * (3.0 * x - y)).cos() - 0.01 * (TAU * 2.0 * y).sin();
        assert!((h - expected).abs() < 1e-16, "{h} {expected}");
    }
    let slope = TAU * (0.5 * (0.02_f64.powi(2) * 10.0 + 0.01_f64.powi(2) * 4.0)).sqrt();
    assert!((numbers(&said, "rms slope, spectral")[0] - slope).abs() < 1e-5, "{said}");
    assert_eq!(csv(&bench, "psd.csv").0, "wave_number,density,waves");
    assert_eq!(bench.reported("surface --fourier waves.dat --size 16 --out report.npy")["fourier"], "waves.dat");
    // with units, and repeated from the scene
    bench.said("surface --fourier waves.dat --fourier-unit 0.1mm --size 16 --lengths 0.1mm --quiet --out si.npz");
    let metres = read_topography(bench.path("si.npz")).unwrap();
    assert_eq!((metres.lengths, metres.unit.as_deref()), (Some((1e-4, 1e-4)), Some("m")));
    assert!(metres.heights.iter().zip(&found).all(|(h, one)| (h - 1e-4 * one).abs() < 1e-20));
    bench.said("run si.npz.scene.toml --quiet --force");
    assert_eq!(read_topography(bench.path("si.npz")).unwrap(), metres);
    // as roughness of a body
    bench.said("surface --fourier waves.dat --form paraboloid --radius 1 --size 16 --quiet --out body.npy");
    bench.said("surface --form paraboloid --radius 1 --size 16 --quiet --out smooth.npy");
    let [body, smooth] = ["body.npy", "smooth.npy"].map(|name| read_field(bench.path(name)).unwrap());
    assert!((&body - &smooth).iter().zip(&found).all(|(h, rough)| (h - rough).abs() < 1e-15));
}

#[test]
fn coefficients_that_make_no_surface_are_refused_by_their_line() {
    let bench = Bench::new();
    bench.write("waves.dat", WAVES);
    bench.write("twice.dat", "1 0 1 0\n1 0 1 0\n");
    let made = |rest: &str| format!("surface --fourier {rest} --out n.npz");
    for (command, parts) in [
        (made("waves.dat --size 6"), vec!["waves.dat", "line 2", "along x is 3", "below half", "take more nodes"]),
        (made("twice.dat --size 8"), vec!["twice.dat", "line 2", "number of coefficients of the wave is 2"]),
        (made("nothing.dat --size 8"), vec!["nothing.dat", "does not exist"]),
        (made("waves.dat --size 16 --lengths 1um"), vec!["coefficients have none", "--fourier-unit"]),
        (made("waves.dat --size 16 --hurst 0.5"), vec!["--hurst", "--fourier", "leave it out"]),
        (made("waves.dat --size 16 --rms-slope 0.5"), vec!["--fourier", "--rms-slope", "cannot be used with"]),
        (
            "surface --size 16 --rms-slope 1 --fourier-unit 1 --out n.npz".to_owned(),
            vec!["--fourier-unit", "--rms-slope"],
        ),
        ("surface --size 16 --fourier-unit 1 --out n.npz".to_owned(), vec!["--fourier <FILE>"]),
        ("surface --size 16 --fourier waves.dat --force --out waves.dat".to_owned(), vec!["waves.dat", "is read"]),
    ] {
        bench.refused_with(&command, &parts);
        assert_eq!(bench.names(""), ["twice.dat", "waves.dat"], "{command}");
    }
    assert_eq!(bench.read("waves.dat"), WAVES);
}
