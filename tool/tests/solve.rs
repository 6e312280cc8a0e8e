//! The command-line tool, end to end.

mod hertz;
mod refusal;

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::{Output, Stdio};

use asperity::{Grid, Surface};
use asperity_maps::io::write_npy;
use ndarray::Array2;
use serde_json::{Value, json};

use crate::bench::{Bench, text};

const FIELDS: [&str; 3] = ["gap.npy", "pressure.npy", "contact_pressure.npy"];

const RESULTS: [&str; 7] =
    ["contact.png", "contact_pressure.npy", "gap.npy", "pressure.npy", "pressure.png", "report.json", "scene.toml"];

/// A folder with a paraboloid.
fn paraboloid() -> Bench {
    Bench::with(&hertz(64))
}

/// The size of a picture, wholly decoded, and whether there is more on it than one colour.
fn picture(bench: &Bench, name: &str) -> (u32, u32, bool) {
    let file = File::open(bench.path(name)).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    (info.width, info.height, data.iter().any(|byte| *byte != data[0]))
}

fn hertz(n: usize) -> Array2<f64> {
    Surface::paraboloid(Grid::square(n, 1.0).unwrap(), 2.0).unwrap().heights().clone()
}

/// The lines on standard error, but for the warning that the paraboloid is a body that ends.
fn said(output: &Output) -> String {
    let text = text(&output.stderr);
    text.split_inclusive('\n').filter(|line| !line.starts_with("warning: ends: ")).collect()
}

fn number(report: &Value, key: &str) -> f64 {
    report[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", report[key]))
}

#[track_caller]
fn assert_close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not {expected}");
}

#[test]
fn nested_grids_are_told_and_are_the_default_where_they_pay() {
    let bench = Bench::new();
    let wavy = Surface::from_fn(Grid::square(256, 1.0).unwrap(), |x, y| 0.02 * (19.0 * x).sin() * (31.0 * y * x).cos());
    write_npy(bench.path("heights.npy"), wavy.unwrap().heights()).unwrap();
    let shapes = |options: &str| {
        let report = bench.solve(&format!("{options} --no-pictures --force"), "solved", 0);
        let levels = report["levels"].as_array().map(|levels| levels.iter().map(|grid| grid["shape"][0].clone()));
        (levels.map(Iterator::collect::<Vec<_>>), report["equivalent_applications"].is_f64())
    };
    let (three, one) = ((Some(vec![json!(64), json!(128), json!(256)]), true), (None, false));
    // at this size nested grids are faster at a given pressure, and one grid at a given mean gap
    assert_eq!(["--mean-pressure 0.02", "--mean-gap 0.01"].map(shapes), [three.clone(), one.clone()]);
    assert_eq!(
        ["--mean-pressure 0.02 --nested --no-nested", "--mean-gap 0.01 --nested"].map(shapes),
        [one, three.clone()]
    );
    // the law of JKR leads to one that the finest grid resolves; where that does not, coarser ones are not used
    let sticky = "--mean-gap 0.02 --nested --law exponential --work-of-adhesion 1e-4 --range";
    let alone = (Some(vec![json!(256)]), true);
    assert_eq!(["1.5e-3", "1e-3"].map(|range| shapes(&format!("{sticky} {range}"))), [three, alone]);
}

#[test]
fn a_load_that_is_not_met_is_said_alone() {
    let bench = paraboloid();
    let made = bench.run("surface --form sphere --radius 2 --size 32 --lengths 0.4 --quiet --out tip.npz");
    assert!(made.status.success());
    let spring = "--boundary free --spring-stiffness 1e-6 --spring-position=-0.1";
    let output = bench.run(&format!("solve --heights tip.npz {spring} --max-iterations 0 --out apart"));
    assert_eq!(output.status.code(), Some(2));
    let (warning, report) = (text(&output.stderr), bench.report("apart"));
    assert!(warning.contains("not converged (iteration-limit): load error 1.0e0 after 0 iterations"), "{warning}");
    assert!(number(&report, "relative_error") < 1e-10 && number(&report, "load_error") == 1.0);
}

#[test]
fn what_did_not_converge_is_written_and_said() {
    let bench = paraboloid();
    for (arguments, status, remedy) in [
        ("--mean-gap 0.0398 --max-iterations 2", "iteration-limit", "--max-iterations"),
        ("--mean-gap 0.0398 --precision f32 --tolerance 1e-12", "stalled", "--precision f64"),
        ("--mean-pressure -1 --law exponential --work-of-adhesion 1e-5 --range 4e-3", "detached", "less tension"),
    ] {
        let output = bench.run(&format!("solve --heights heights.npy {arguments} --out {status}"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let warning = said(&output);
        assert_eq!(warning.lines().count(), 1, "{warning}");
        assert!(warning.contains(status) && warning.contains(remedy), "{warning}");
        assert_eq!(bench.names(status), RESULTS);
        let report = bench.report(status);
        assert_eq!(report["status"], *status);
        let worst = number(&report, "relative_error").max(number(&report, "load_error"));
        assert!(worst > number(&report, "tolerance"));
        for key in ["mean_gap", "mean_pressure", "mean_contact_pressure", "elastic_energy", "min_pressure"] {
            assert!(report[key].is_f64(), "{arguments}: {key} is {}", report[key]);
        }
        for name in FIELDS {
            assert!(bench.field(&format!("{status}/{name}")).iter().all(|v| v.is_finite()), "{arguments}: {name}");
        }
    }
}

#[test]
fn quiet_is_quiet_and_a_reader_that_left_does_no_harm() {
    let bench = paraboloid();
    let arguments = "solve --heights heights.npy --mean-gap 0.0398 --no-pictures --out";
    let output = bench.run(&format!("{arguments} quiet --quiet"));
    assert_eq!((output.status.code(), output.stdout.len(), said(&output)), (Some(0), 0, String::new()));
    assert_eq!(bench.names("quiet"), ["contact_pressure.npy", "gap.npy", "pressure.npy", "report.json", "scene.toml"]);

    let output = bench.run(&format!("{arguments} loud"));
    let table = text(&output.stdout);
    assert!(["1.5 %", "61 of 4096", "converged", "results in loud"].iter().all(|part| table.contains(part)), "{table}");

    let mut child = bench.command(&format!("{arguments} left")).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    drop(child.as_mut().unwrap().stdout.take());
    let output = child.unwrap().wait_with_output().unwrap();
    assert_eq!((output.status.code(), said(&output)), (Some(0), String::new()));
    assert_eq!(bench.names("left").len(), 5);
}

#[test]
fn help_and_version() {
    let bench = Bench::new();
    for (arguments, parts) in [
        ("--help", vec!["demo", "solve", "surface", "stats", "Examples"]),
        ("demo --help", vec!["--out", "asperity-demo"]),
        (
            "solve --help",
            vec![
                "--heights",
                "[default: the file's, else 1 1]",
                "[default: 1e-6, in f32 and in cycles 1e-4]",
                "Examples",
                "--range 1nm",
            ],
        ),
        ("sweep --help", vec!["FROM:TO:COUNT:log", "--mean-gaps", ".csv or .jsonl", "Exits with 0", "Examples"]),
        ("surface --help", vec!["--rms-slope", "k^(-2-2H)", "[default: 64]", "Examples", "--shape 4096 1"]),
        ("stats --help", vec!["FILE", "--psd", "Examples", "[default: the file's]"]),
        (
            "prepare --help",
            vec!["Only the steps that you choose are done", "--remove-form, --detrend, --fill, --window"],
        ),
        ("--version", vec![env!("CARGO_PKG_VERSION")]),
    ] {
        let output = bench.run(arguments);
        assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0), "{arguments}");
        // However it is wrapped.
        let help = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(parts.iter().all(|part| help.contains(part)), "{arguments}: {help}");
    }
    for arguments in ["", "polish", "solve"] {
        let output = bench.run(arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{arguments:?}");
        assert!(!output.stderr.is_empty());
    }
    assert!(fs::read_dir(Path::new(bench.0.path())).unwrap().next().is_none());
}

#[test]
fn stability_is_in_the_report_and_its_mode_beside_it() {
    let bench = paraboloid();
    let law = "--law exponential --work-of-adhesion 1e-4 --range 4e-3";
    let report = bench.solve(&format!("--mean-gap 0.043 --stability {law}"), "held", 0);
    let stability = &report["stability"];
    assert_eq!(stability["verdict"], "stable");
    let number = |name: &str| stability[name].as_f64().unwrap();
    assert!(number("lower_bound") > 0.0 && number("lower_bound") <= number("eigenvalue"));
    assert!(number("error_bound") >= report["relative_error"].as_f64().unwrap());
    let mode = bench.field("held/mode.npy");
    assert!((mode.mapv(|value| value * value).mean().unwrap() - 1.0).abs() < 1e-9);
    let (gap, none) = (bench.field("held/gap.npy"), bench.solve("--mean-gap 0.04", "plain", 0));
    assert!(gap.iter().zip(&mode).all(|(gap, mode)| *gap > 0.0 || *mode == 0.0));
    assert_eq!(none["stability"], Value::Null);
    assert_eq!(bench.names("plain"), RESULTS);
}
