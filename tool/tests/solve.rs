//! The command-line tool, end to end.

use std::fs::{self, File};
use std::io::{BufReader, Cursor, Write};
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

/// Without adhesion a contact pressure is exactly zero wherever there is a gap, and the other way round.
#[track_caller]
fn assert_complementary(gap: &Array2<f64>, pressure: &Array2<f64>) {
    assert!(gap.iter().zip(pressure).all(|(g, p)| *g >= 0.0 && *p >= 0.0 && g * p == 0.0));
}

#[test]
fn demo() {
    let bench = Bench::new();
    let first = bench.run("demo");
    assert_eq!((first.status.code(), text(&first.stderr)), (Some(0), String::new()));
    let names = [
        "contact-with-adhesion.png",
        "contact-without-adhesion.png",
        "heights.npy",
        "heights.png",
        "pressure-with-adhesion.png",
        "pressure-without-adhesion.png",
        "scene.toml",
    ];
    assert_eq!(bench.names("asperity-demo"), names);
    assert_eq!(bench.names("."), ["asperity-demo"]);
    for name in names.iter().filter(|name| name.ends_with(".png")) {
        let (width, height, drawn) = picture(&bench, &format!("asperity-demo/{name}"));
        assert!(width > 500 && height > 500 && drawn, "{name}");
    }
    let said = text(&first.stdout);
    let row = |name: &str| -> Vec<f64> {
        let line = said.lines().find(|line| line.starts_with(name)).unwrap();
        line[name.len()..].split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    let [bare, sticky] = row("contact")[..] else { panic!("{said}") };
    assert!(sticky > 1.5 * bare, "{said}");
    assert_eq!(row("mean pressure"), [5.0, 5.0]);
    let stats = bench.run("stats asperity-demo/heights.npy --lengths 1um --json");
    let stats: Value = serde_json::from_slice(&stats.stdout).unwrap();
    let stated = said.split("rms height ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
    assert!((1e9 * number(&stats, "rms_height") / stated - 1.0).abs() < 1e-12, "{stats}");

    // The printed command gives the same as the table.
    let command = said.lines().find_map(|line| line.trim().strip_prefix("asperity ")).unwrap();
    let again = bench.run(&format!("{command} --no-pictures"));
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    let report = bench.report("asperity-demo/with-adhesion");
    assert!((100.0 * number(&report, "contact_fraction") - sticky).abs() <= 0.05);
    assert_eq!(row("iterations")[1], number(&report, "iterations"));
    // the grid resolves the adhesion
    assert!(number(&report, "mu_rho") < 0.5, "{report}");

    // and so does its scene
    let again = bench.run("run asperity-demo/scene.toml --no-pictures --json --out scene");
    assert_eq!((again.status.code(), text(&again.stderr)), (Some(0), String::new()));
    assert!(bench.bytes("scene/gap.npy") == bench.bytes("asperity-demo/with-adhesion/gap.npy"));
    let first = bench.run("demo --json --out other");
    let reports: Value = serde_json::from_slice(&first.stdout).unwrap();
    assert_eq!(reports["with_adhesion"]["contact_nodes"], report["contact_nodes"]);
    assert_eq!(reports["without_adhesion"]["law"], "none");
    for folder in ["scene", "other"] {
        fs::remove_dir_all(bench.path(folder)).unwrap();
    }

    // A second run replaces its own files by the same, and leaves others alone.
    let before: Vec<_> = names.iter().map(|name| bench.bytes(&format!("asperity-demo/{name}"))).collect();
    fs::write(bench.path("asperity-demo/heights.png"), "old").unwrap();
    assert_eq!(bench.run("demo --threads 1").status.code(), Some(0));
    let after: Vec<_> = names.iter().map(|name| bench.bytes(&format!("asperity-demo/{name}"))).collect();
    assert!(before == after, "the demo depends on something");
    assert_eq!(bench.names("asperity-demo/with-adhesion").len(), 5);
}

#[test]
fn hertz_at_a_mean_gap_and_at_the_pressure_it_takes() {
    let bench = paraboloid();
    let report = bench.solve("--mean-gap 0.0398 --tolerance 1e-10", "results", 0);
    assert_eq!(bench.names("results"), RESULTS);
    assert_eq!(bench.names("."), ["heights.npy", "results"]);
    for key in [
        "status",
        "relative_error",
        "load_error",
        "iterations",
        "operator_applications",
        "mean_gap",
        "mean_pressure",
        "mean_contact_pressure",
        "contact_fraction",
        "contact_nodes",
        "min_gap",
        "elastic_energy",
        "adhesive_energy",
        "mu_rho",
        "under_resolved",
        "precision",
        "method",
        "seconds",
        "shape",
        "lengths",
        "modulus",
        "law",
        "control",
        "tolerance",
        "max_iterations",
        "threads",
        "version",
    ] {
        assert!(!report[key].is_null(), "{key}");
    }
    assert_eq!((&report["status"], &report["method"]), (&"converged".into(), &"default".into()));
    assert_eq!((&report["precision"], &report["law"]), (&"f64".into(), &"none".into()));
    assert_eq!(report["contact_nodes"], 61);
    assert_eq!(number(&report, "contact_fraction"), 61.0 / 4096.0);
    assert!(number(&report, "relative_error") <= 1e-10);
    assert_close(number(&report, "mean_pressure"), 1.831421e-4, 5e-7 / 1.831421);
    assert_close(number(&report, "mean_contact_pressure"), number(&report, "mean_pressure"), 1e-9);

    let [gap, pressure, contact] = FIELDS.map(|name| bench.field(&format!("results/{name}")));
    assert_complementary(&gap, &contact);
    assert_close(gap.mean().unwrap(), 0.0398, 1e-12);
    assert_close(pressure.mean().unwrap(), number(&report, "mean_pressure"), 1e-9);
    assert_eq!(gap.iter().filter(|g| **g == 0.0).count(), 61);
    // The full pressure is that in the contact, and hardly any outside of it.
    assert!(pressure.iter().zip(&contact).all(|(p, c)| (p - c).abs() < 1e-8));
    for name in ["contact.png", "pressure.png"] {
        let (width, height, drawn) = picture(&bench, &format!("results/{name}"));
        assert!(width > 500 && height > 500 && drawn, "{name}");
    }

    let arguments = format!("--mean-pressure {} --tolerance 1e-10", report["mean_pressure"]);
    let back = bench.solve(&arguments, "back", 0);
    assert_close(number(&back, "mean_gap"), 0.0398, 1e-8);
    assert_eq!(back["contact_nodes"], 61);
}

#[test]
fn both_methods_and_both_precisions_agree() {
    let bench = paraboloid();
    let paper = bench.solve("--mean-gap 0.0398 --method rey2017", "paper", 0);
    assert_eq!((&paper["method"], &paper["contact_nodes"]), (&"rey2017".into(), &61.into()));
    assert!(number(&paper, "relative_error") <= 1e-6);
    let single = bench.solve("--mean-gap 0.0398 --precision f32 --tolerance 1e-3", "single", 0);
    assert_eq!((&single["precision"], &single["contact_nodes"]), (&"f32".into(), &61.into()));
    assert_close(number(&single, "mean_pressure"), 1.831421e-4, 1e-3);
    for name in FIELDS {
        assert!(bench.bytes(&format!("paper/{name}")).windows(3).any(|w| w == b"<f8"));
        assert!(bench.bytes(&format!("single/{name}")).windows(3).any(|w| w == b"<f4"));
    }
    assert_complementary(&bench.field("single/gap.npy"), &bench.field("single/contact_pressure.npy"));
    // The tolerance that f32 has by default can be met where there is enough contact.
    let default = bench.solve("--mean-gap 0.02 --precision f32", "default", 0);
    assert_eq!(number(&default, "tolerance"), 1e-4);
}

/// A .npy file of a square array.
fn npy(dtype: &str, fortran: bool, n: usize, data: Vec<u8>) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': ({n}, {n}), }}");
    let header = format!("{header:117}\n");
    [b"\x93NUMPY\x01\0", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), &data].concat()
}

#[test]
fn every_file_format_gives_the_same_answer() {
    let bench = Bench::new();
    // Not symmetric, so that a transposed map would be noticed; all heights are exact in f32.
    let n = 32;
    let heights = Array2::from_shape_fn((n, n), |(i, j)| -((i * i + 3 * j) as f64) / 4096.0);
    let bytes = |values: Vec<f64>| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let rows: Vec<f64> = heights.iter().copied().collect();
    let little = npy("<f8", false, n, bytes(rows.clone()));
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("heights.npy", zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(&little).unwrap();
    let lines = heights.rows().into_iter().map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" "));
    let files = [
        ("little", little),
        ("single", npy("<f4", false, n, rows.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect())),
        ("big", npy(">f8", false, n, rows.iter().flat_map(|v| v.to_be_bytes()).collect())),
        ("fortran", npy("<f8", true, n, bytes(heights.t().iter().copied().collect()))),
        ("archive", zip.finish().unwrap().into_inner()),
        ("text", lines.collect::<Vec<_>>().join("\n").into_bytes()),
    ];
    for (name, content) in &files {
        fs::write(bench.path(name), content).unwrap();
        let output = bench.run(&format!("solve --heights {name} --mean-gap 0.05 --no-pictures --out out-{name}"));
        assert_eq!(output.status.code(), Some(0), "{name}: {}", text(&output.stderr));
        for field in FIELDS {
            assert!(
                bench.bytes(&format!("out-{name}/{field}")) == bench.bytes(&format!("out-little/{field}")),
                "{name} {field}"
            );
        }
    }
}

#[test]
fn adhesion_adds_contact_and_tells_if_it_is_under_resolved() {
    let bench = paraboloid();
    for law in ["maugis-dugdale", "exponential"] {
        let options = format!("--mean-gap 0.0429 --law {law} --work-of-adhesion 1e-4");
        let bare = bench.solve("--mean-gap 0.0429 --force", "bare", 0);
        let arguments = format!("solve --heights heights.npy {options} --range 4e-3 --out {law}");
        let output = bench.run(&arguments);
        assert_eq!((output.status.code(), said(&output)), (Some(0), String::new()));
        let sticky = bench.report(law);
        assert_eq!(sticky["law"], *law);
        assert_eq!((number(&sticky, "work_of_adhesion"), number(&sticky, "range")), (1e-4, 4e-3));
        assert_close(number(&sticky, "mu_rho"), (1e-4_f64 / 64.0).sqrt() / 4e-3, 1e-12);
        assert!(number(&sticky, "contact_nodes") > number(&bare, "contact_nodes"));
        assert!(number(&sticky, "adhesive_energy") < 0.0);
        // The contact pressure is the full pressure plus the traction, which is w/rho where there is no gap.
        let [gap, pressure, contact] = FIELDS.map(|name| bench.field(&format!("{law}/{name}")));
        assert_complementary(&gap, &contact);
        let inside = gap.iter().zip(&pressure).zip(&contact).filter(|((g, _), _)| **g == 0.0);
        inside.for_each(|((_, p), c)| assert!((c - p - 1e-4 / 4e-3).abs() < 1e-9));
        assert!(pressure.iter().any(|p| *p < -1e-3));

        let output = bench.run(&format!("solve --heights heights.npy {options} --range 1e-3 --out {law} --force"));
        let warning = text(&output.stderr);
        let parts = ["mu_rho = 1.25", "use jkr"];
        assert!(parts.iter().all(|part| warning.contains(part)), "{warning}");
        assert_eq!(bench.report(law)["under_resolved"], true);
    }
}

#[test]
fn a_given_start_saves_iterations() {
    let bench = paraboloid();
    let first = bench.solve("--mean-pressure 2e-4 --no-pictures", "first", 0);
    let second = bench.solve("--mean-pressure 2e-4 --no-pictures --initial-gap first/gap.npy", "second", 0);
    assert!(number(&second, "iterations") < 0.5 * number(&first, "iterations"));
    assert_eq!(second["contact_nodes"], first["contact_nodes"]);
    assert_eq!((&second["initial_gap"], &first["initial_gap"]), (&"first/gap.npy".into(), &Value::Null));
}

#[test]
fn nested_grids_give_the_same_and_say_what_they_took() {
    let bench = Bench::new();
    let wavy = Surface::from_fn(Grid::square(256, 1.0).unwrap(), |x, y| 0.02 * (19.0 * x).sin() * (31.0 * y * x).cos());
    write_npy(bench.path("heights.npy"), wavy.unwrap().heights()).unwrap();
    for load in ["--mean-pressure 0.02", "--mean-gap 0.01"] {
        let single = bench.solve(&format!("{load} --no-pictures --force --nested --no-nested"), "single", 0);
        let nested = bench.solve(&format!("{load} --no-pictures --force --nested"), "nested", 0);
        assert_close(number(&nested, "mean_gap"), number(&single, "mean_gap"), 1e-5);
        assert_close(number(&nested, "mean_pressure"), number(&single, "mean_pressure"), 1e-5);
        assert_close(number(&nested, "contact_nodes"), number(&single, "contact_nodes"), 1e-3);
        assert_eq!((&single["levels"], &single["equivalent_applications"]), (&Value::Null, &Value::Null));

        let grids = nested["levels"].as_array().unwrap();
        let shapes: Vec<_> = grids.iter().map(|grid| &grid["shape"]).collect();
        assert_eq!(shapes, [&json!([64, 64]), &json!([128, 128]), &json!([256, 256])]);
        assert!(grids.iter().all(|grid| grid["status"] == "converged"));
        let counts: Vec<_> = grids.iter().map(|grid| number(grid, "operator_applications")).collect();
        // the report counts the solve on the finest grid, without the one that makes the problem
        assert_eq!(counts[2], number(&nested, "operator_applications") + 1.0);
        let equivalent = counts[2] + counts[1] / 4.0 + counts[0] / 16.0;
        assert_close(number(&nested, "equivalent_applications"), equivalent, 1e-12);
        // the finest alone takes fewer than without a start
        assert!(counts[2] < number(&single, "operator_applications"));
    }
    // the default is what is faster: at this size nested grids at a given pressure, and one grid at a given mean gap
    let grids = |load: &str| {
        bench.solve(&format!("{load} --no-pictures --force"), "default", 0)["levels"].as_array().map(Vec::len)
    };
    assert_eq!([grids("--mean-pressure 0.02"), grids("--mean-gap 0.01")], [Some(3), None]);
    // the law of JKR leads to one that the finest grid resolves; where that does not, coarser ones are not used
    for (range, grids) in [("1.5e-3", 3), ("1e-3", 1)] {
        let sticky = format!("--law exponential --work-of-adhesion 1e-4 --range {range}");
        let report = bench.solve(&format!("--mean-gap 0.02 --nested {sticky} --force"), "sticky", 0);
        assert_eq!(report["levels"].as_array().unwrap().len(), grids, "{range}");
    }

    let refused =
        bench.run("solve --heights heights.npy --mean-gap 0.02 --nested --initial-gap single/gap.npy --out no");
    let error = text(&refused.stderr);
    assert_eq!((refused.status.code(), error.lines().count()), (Some(1), 1), "{error}");
    assert!(error.contains("--nested") && error.contains("--initial-gap"), "{error}");
}

#[test]
fn lines_and_rectangles_have_sensible_lengths() {
    let (bench, hertz) = (Bench::new(), hertz(64));
    let line = hertz.row(32).to_owned().insert_axis(ndarray::Axis(1));
    write_npy(bench.path("heights.npy"), &line).unwrap();
    for (arguments, lengths) in
        [("--lengths 2", json!([2.0, 2.0])), ("--lengths 2 3", json!([2.0, 3.0])), ("", json!([1.0, 1.0]))]
    {
        let report = bench.solve(&format!("{arguments} --mean-gap 0.04 --force"), "line", 0);
        assert_eq!((&report["shape"], &report["lengths"]), (&json!([64, 1]), &lengths));
    }
    assert_eq!(bench.names("line"), RESULTS);
    write_npy(bench.path("heights.npy"), &Array2::from_shape_fn((64, 32), |(i, j)| hertz[[i, j]])).unwrap();
    for (arguments, lengths) in
        [("--lengths 2", json!([2.0, 1.0])), ("--lengths 2 3", json!([2.0, 3.0])), ("", json!([1.0, 1.0]))]
    {
        let report = bench.solve(&format!("{arguments} --mean-gap 0.04 --force"), "rectangle", 0);
        assert_eq!((&report["shape"], &report["lengths"]), (&json!([64, 32]), &lengths));
    }
}

#[test]
fn results_are_replaced_only_with_force() {
    let bench = paraboloid();
    bench.solve("--mean-gap 0.0398", "results", 0);
    fs::write(bench.path("results/notes.txt"), "mine").unwrap();
    let before = bench.bytes("results/gap.npy");
    let refused = bench.run("solve --heights heights.npy --mean-gap 0.03 --out results");
    assert_eq!(refused.status.code(), Some(1));
    assert!(text(&refused.stderr).contains("--force"));
    assert!(bench.bytes("results/gap.npy") == before);
    bench.solve("--mean-gap 0.03 --force", "results", 0);
    assert!(bench.bytes("results/gap.npy") != before);
    assert_eq!(bench.bytes("results/notes.txt"), b"mine");
    assert_eq!(bench.names("results").len(), RESULTS.len() + 1);
    // results of a run that failed are in nobody's way
    bench.solve("--mean-gap 0.03 --max-iterations 1", "failed", 2);
    bench.solve("--mean-gap 0.03", "failed", 0);
    assert_eq!(bench.report("failed")["status"], "converged");
}

#[test]
fn a_tension_without_adhesion_is_refused() {
    let bench = paraboloid();
    for load in ["--mean-pressure=-0.01", "--normal-force=-1", "--reduced-pressure=-0.1"] {
        let refused = bench.run(&format!("solve --heights heights.npy {load} --out results"));
        let said = text(&refused.stderr);
        assert!(refused.status.code() == Some(1) && said.contains("nothing holds surfaces without adhesion"), "{said}");
    }
    let adhesive = "--law exponential --work-of-adhesion 1e-5 --range 4e-3";
    bench.solve(&format!("{adhesive} --mean-pressure=-1e-5"), "results", 0);
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
fn bad_input_is_refused_on_one_line_and_writes_nothing() {
    let bench = paraboloid();
    let mut missing = hertz(8);
    missing[[3, 5]] = f64::NAN;
    missing[[7, 0]] = f64::NAN;
    for (name, field) in [("missing.npy", missing), ("small.npy", hertz(8)), ("negative.npy", hertz(64) - 1e-9)] {
        write_npy(bench.path(name), &field).unwrap();
    }
    fs::write(bench.path("words.txt"), "one two\n").unwrap();
    let before = bench.names(".");
    let good = "--heights heights.npy --mean-gap 0.0398";
    for (arguments, parts) in [
        (
            format!("{good} --law none --work-of-adhesion 0.05"),
            vec!["--work-of-adhesion", "is given", "--law exponential"],
        ),
        (format!("{good} --range 0.25"), vec!["--range", "is given", "--law exponential"]),
        (format!("{good} --law exponential --range 1e-3"), vec!["--law exponential", "--work-of-adhesion"]),
        (format!("{good} --law maugis-dugdale --work-of-adhesion 1"), vec!["--law maugis-dugdale", "--range"]),
        (format!("{good} --law exponential --work-of-adhesion -1e-3 --range 1"), vec!["-1e-3", "zero or positive"]),
        (format!("{good} --law exponential --work-of-adhesion 1 --range 0"), vec!["--range", "is 0", "positive"]),
        (format!("{good} --law dupre"), vec!["dupre", "exponential", "maugis-dugdale"]),
        (format!("{good} --threads 0"), vec!["--threads", "is 0", "from 1"]),
        (format!("{good} --threads -2"), vec!["--threads", "-2", "from 1"]),
        (format!("{good} --modulus -1e9"), vec!["--modulus", "-1e9", "positive"]),
        (format!("{good} --modulus nan"), vec!["--modulus", "nan", "finite"]),
        (format!("{good} --tolerance 0"), vec!["--tolerance is 0:", "positive"]),
        (format!("{good} --max-iterations 1.5"), vec!["--max-iterations", "1.5"]),
        (format!("{good} --lengths 1 -1"), vec!["--lengths", "-1", "positive"]),
        (format!("{good} --lengths 0"), vec!["--lengths is 0:", "positive"]),
        (format!("{good} --mean-pressure 1"), vec!["--mean-gap", "--mean-pressure", "cannot be used with"]),
        (format!("{good} --precision f16"), vec!["f16", "f32", "f64"]),
        (format!("{good} --initial-gap small.npy"), vec!["--initial-gap", "8 x 8", "64 x 64"]),
        (format!("{good} --initial-gap missing.npy"), vec!["--initial-gap", "8 x 8", "64 x 64"]),
        (format!("{good} --initial-gap negative.npy"), vec!["gap", "-0.125000001", "zero or positive"]),
        ("--heights heights.npy --precision f32 --mean-gap 1e300".to_owned(), vec!["mean gap", "1e300", "precision"]),
        (format!("{good} --colour red"), vec!["--colour", "see --help"]),
        ("heights.npy --mean-gap 1".to_owned(), vec!["'heights.npy'", "'--heights heights.npy'"]),
        ("--heights heights.npy --mean-gap -0.1".to_owned(), vec!["--mean-gap", "-0.1", "zero or positive"]),
        ("--heights heights.npy --mean-gap much".to_owned(), vec!["--mean-gap", "much", "a number"]),
        ("--heights heights.npy --mean-pressure inf".to_owned(), vec!["--mean-pressure", "inf", "finite"]),
        ("--heights heights.npy".to_owned(), vec!["--mean-gap", "--mean-pressure"]),
        ("--mean-gap 1".to_owned(), vec!["--heights"]),
        ("--heights nothing.npy --mean-gap 1".to_owned(), vec!["nothing.npy", "does not exist", "check the path"]),
        ("--heights words.txt --mean-gap 1".to_owned(), vec!["words.txt", "line 1", "\"one\"", "expected"]),
        (
            "--heights missing.npy --mean-gap 1".to_owned(),
            vec![
                "missing.npy: 2 of 8 x 8 heights are missing",
                "[3, 5]",
                "asperity prepare --fill",
                "--absent-missing",
            ],
        ),
    ] {
        let output = bench.run(&format!("solve {arguments} --out new/results"));
        let error = said(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments}: {error}");
        assert_eq!((error.lines().count(), output.stdout.len()), (1, 0), "{arguments}: {error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{arguments}: {error}");
        assert_eq!(bench.names("."), before, "{arguments}");
    }
}

#[test]
fn folders_that_cannot_be_written_are_refused() {
    let bench = paraboloid();
    let solve = "solve --heights heights.npy --mean-gap 0.0398 --out";
    for arguments in
        [format!("{solve} heights.npy"), format!("{solve} heights.npy/below"), "demo --out heights.npy".into()]
    {
        let output = bench.run(&arguments);
        let error = text(&output.stderr);
        assert_eq!((output.status.code(), error.lines().count()), (Some(1), 1), "{error}");
        assert!(
            error.contains("heights.npy is not a folder") || error.contains("heights.npy: is not a folder"),
            "{error}"
        );
    }
    if cfg!(target_os = "linux") {
        let output = bench.run(&format!("{solve} /proc/asperity"));
        let error = text(&output.stderr);
        assert_eq!((output.status.code(), error.lines().count()), (Some(1), 1), "{error}");
        assert!(error.contains("/proc") && error.contains("choose another"), "{error}");
    }
    assert_eq!(bench.names("."), ["heights.npy"]);
}

#[test]
#[cfg(feature = "parallel")]
fn threads_do_not_change_a_bit() {
    let bench = Bench::new();
    let wavy = Surface::from_fn(Grid::square(150, 1.0).unwrap(), |x, y| 0.02 * (19.0 * x).sin() * (31.0 * y * x).cos());
    write_npy(bench.path("heights.npy"), wavy.unwrap().heights()).unwrap();
    let options = "--mean-pressure 0.02 --law exponential --work-of-adhesion 1e-4 --range 4e-3";
    for threads in [1, 2, 3] {
        let report = bench.solve(&format!("{options} --threads {threads}"), &format!("by-{threads}"), 0);
        assert_eq!(report["threads"], threads);
        for name in RESULTS.iter().filter(|name| !["report.json", "scene.toml"].contains(name)) {
            assert!(
                bench.bytes(&format!("by-{threads}/{name}")) == bench.bytes(&format!("by-1/{name}")),
                "{threads}: {name}"
            );
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
        ("--help", vec!["demo", "solve", "Examples"]),
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
