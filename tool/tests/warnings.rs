//! Input and answers that are probably a mistake, end to end: what the tool says of them, and what it refuses.

use asperity::SelfAffine;
use asperity_maps::Topography;
use asperity_maps::io::{read_field, write_npy, write_topography};
use ndarray::Array2;
use serde_json::Value;

use crate::bench::{Bench, text};

/// A folder with a rough surface in it, periodic, and the same after changes.
fn bench() -> Bench {
    let bench = Bench::new();
    let rough = SelfAffine::default().k_l(2.0).k_r(2.0).k_s(10.0);
    let heights = rough.surface(asperity::Grid::square(32, 1.0).unwrap()).unwrap().heights().clone();
    let write = |name: &str, heights: &Array2<f64>| write_npy(bench.path(name), heights).unwrap();
    write("clean.npy", &heights);
    let mut tilted = heights.clone();
    tilted.indexed_iter_mut().for_each(|((i, _), h)| *h += 0.01 * i as f64);
    write("tilted.npy", &tilted);
    let mut strip = heights.clone();
    strip.row_mut(7).fill(-9999.0);
    write("strip.npy", &strip);
    write("metres.npy", &heights.mapv(|h| 1e-9 * h));
    let mut both = heights.clone();
    (both[[3, 5]], both[[0, 0]]) = (f64::NEG_INFINITY, f64::NAN);
    write("both.npy", &both);
    for (name, side) in [("small.npz", 1.0), ("large.npz", 3.0)] {
        let mut map = Topography::new(heights.clone());
        map.lengths = Some((side, side));
        write_topography(bench.path(name), &map).unwrap();
    }
    bench
}

fn codes(report: &Value) -> Vec<&str> {
    let warnings = report["warnings"].as_array().unwrap();
    warnings.iter().map(|warning| warning["code"].as_str().unwrap()).collect()
}

/// The codes of the lines of warning on standard error.
fn said(stderr: &str) -> Vec<&str> {
    let first =
        |line: &'_ str| line.len() - line.trim_start_matches(|c: char| c.is_ascii_lowercase() || c == '-').len();
    let lines = stderr.lines().filter_map(|line| line.strip_prefix("warning: "));
    let lines: Vec<_> = lines.filter(|line| line[first(line)..].starts_with(':')).collect();
    assert!(lines.iter().all(|line| line.chars().count() <= 90), "{lines:?}");
    lines.iter().map(|line| &line[..first(line)]).collect()
}

#[test]
fn each_command_says_what_is_probably_a_mistake_and_reports_it() {
    let bench = bench();
    for (heights, expected) in [("clean.npy", &[][..]), ("tilted.npy", &["tilt", "open-edges"])] {
        for (command, out) in [
            ("solve --mean-gap 1e5 --no-pictures", "results"),
            ("sweep --mean-gaps 2e5,1e5", "sweep.csv"),
            ("cycle --mean-pressures 0.01,0.02 --modulus 1e3 --steps 2 --smallest-step 0.1", "cycle.csv"),
        ] {
            let output = bench.run(&format!("{command} --heights {heights} --out {out} --force --json"));
            // some of that does not converge, which is told too
            assert_ne!(output.status.code(), Some(1), "{command} {heights}: {}", text(&output.stderr));
            let report: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(codes(&report), expected, "{command} {heights}");
            assert_eq!(said(&text(&output.stderr)), expected, "{command} {heights}");
            for warning in report["warnings"].as_array().unwrap() {
                let message = warning["message"].as_str().unwrap();
                assert!(text(&output.stderr).contains(message) && !message.contains('\n'), "{message}");
            }
        }
        assert_eq!(codes(&bench.report("results")), expected, "{heights}");
    }
    // for people too
    let output = bench.run("solve --heights tilted.npy --mean-gap 1 --no-pictures --out people");
    assert_eq!(said(&text(&output.stderr)), ["tilt", "open-edges"]);
}

#[test]
fn a_tip_in_a_periodic_cell_and_a_modulus_beside_metres_are_told() {
    let bench = bench();
    bench.said("surface --form sphere --radius 20nm --size 32 --lengths 16nm --quiet --out tip.npz");
    bench.said("surface --form sphere --radius 7nm --size 32 --lengths 16nm --quiet --out whole.npz");
    bench.said("surface --size 32 --k-l 2 --k-s 10 --rms-slope 0.1 --lengths 1um --quiet --out rough.npz");
    let bare = "--modulus 2e9 --normal-force 1e-9";
    for (arguments, expected) in [
        (format!("--heights tip.npz {bare}"), &["ends"][..]),
        (format!("--heights whole.npz --absent-missing {bare}"), &["ends"]),
        (format!("--heights tip.npz --boundary free {bare}"), &[]),
        (format!("--heights whole.npz --absent-missing --boundary free {bare}"), &[]),
        ("--heights rough.npz --modulus 70 --mean-pressure 1".to_owned(), &["modulus"]),
        ("--heights rough.npz --modulus 70 --pressure-unit GPa --mean-pressure 1".to_owned(), &[]),
        ("--heights rough.npz --modulus 70Pa --mean-pressure 1Pa".to_owned(), &[]),
        ("--heights rough.npz --modulus 70e9 --mean-pressure 1e9".to_owned(), &[]),
        ("--heights rough.npz --mean-pressure 0.01".to_owned(), &[]),
    ] {
        let output = bench.run(&format!("solve {arguments} --no-pictures --force --out results"));
        let stderr = text(&output.stderr);
        let found: Vec<_> = said(&stderr).into_iter().filter(|code| ["ends", "modulus"].contains(code)).collect();
        assert_eq!((output.status.code(), &found[..]), (Some(0), expected), "{arguments}: {stderr}");
    }
    let output = bench.run("solve --heights rough.npz --modulus 70 --mean-pressure 1 --strict --out strict");
    let told = "modulus: the contact modulus is 70, below 1e3 Pa";
    assert!(text(&output.stderr).contains(told), "{}", text(&output.stderr));
}

#[test]
fn strict_takes_warnings_for_errors_and_writes_nothing() {
    let bench = bench();
    let before = bench.names(".");
    for command in
        ["solve --mean-gap 1 --out results", "sweep --mean-gaps 1 --out s.csv", "cycle --mean-gaps 2,1 --out c.csv"]
    {
        bench.refused_with(&format!("{command} --heights tilted.npy --strict"), &["error: tilt", "open-edges"]);
        bench.refused_with(
            &format!("{command} --heights strip.npy --strict --json"),
            &["missing-code: -9999 stands at 32 nodes"],
        );
    }
    let high = "solve --heights clean.npy --mean-pressure 5 --no-pictures --out high";
    bench.refused_with(&format!("{high} --strict"), &["beyond-modulus", "contact pressure"]);
    // an answer that is refused before the first row of a table leaves no table
    for table in [
        "sweep --mean-pressures 5,6 --out s.csv",
        "cycle --mean-pressures 5,6 --steps 2 --smallest-step 0.1 --quiet --out c.csv",
    ] {
        bench.refused_with(&format!("{table} --heights clean.npy --strict"), &["beyond-modulus"]);
    }
    assert_eq!(bench.names("."), before);
    // a table that is there stays as it is
    bench.said("sweep --heights clean.npy --mean-pressures 0.01 --out s.csv");
    let table = bench.read("s.csv");
    bench.refused_with(
        "sweep --heights clean.npy --mean-pressures 0.01,5 --out s.csv --strict --quiet",
        &["beyond-modulus"],
    );
    assert_eq!(bench.read("s.csv"), table);
    let output = bench.run(high);
    assert_eq!((output.status.code(), said(&text(&output.stderr))), (Some(0), vec!["beyond-modulus"]));
    assert_eq!(codes(&bench.report("high")), ["beyond-modulus"]);
    // clean input does not mind
    bench.said("solve --heights clean.npy --mean-pressure 0.01 --no-pictures --out fine --strict");
    assert_eq!(codes(&bench.report("fine")), [""; 0]);
    assert!(bench.read("fine/scene.toml").contains("strict = true"));
}

#[test]
fn a_range_is_told_once_and_with_how_wrong_the_answer_may_be() {
    let bench = bench();
    let law = "--law exponential --work-of-adhesion 1e-4 --range";
    let output = bench.run(&format!("solve --heights clean.npy --mean-gap 0.03 {law} 2e-3 --no-pictures --out short"));
    let stderr = text(&output.stderr);
    let lines: Vec<_> = stderr.lines().filter(|line| line.contains("mu_rho")).collect();
    assert!(
        lines.len() == 1 && lines[0].starts_with("warning: range: ") && lines[0].contains("makes w act as"),
        "{stderr}"
    );
    let report = bench.report("short");
    assert_eq!((codes(&report), &report["under_resolved"]), (vec!["range"], &Value::Bool(true)));
    let output = bench.run(&format!("solve --heights clean.npy --mean-gap 0.03 {law} 2 --no-pictures --out long"));
    assert!(
        text(&output.stderr).contains("warning: range: the range of adhesion, 2, exceeds"),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(codes(&bench.report("long")), ["range"]);
}

#[test]
fn warnings_have_the_units_of_tables() {
    let bench = bench();
    let solve = "solve --heights clean.npy --lengths 1m --mean-gap 30mm --modulus 1GPa --no-pictures";
    let law = "--law exponential --work-of-adhesion 100kJ/m2 --range";
    let output = bench.run(&format!("{solve} {law} 2m --out long"));
    let stderr = text(&output.stderr);
    assert!(stderr.contains("range: the range of adhesion, 2 m, exceeds the heights, "), "{stderr}");
    assert!(stderr.contains(" mm: "), "{stderr}");
    // on the page, too
    bench.said("report long");
    assert!(bench.read("long/report.html").contains("<li>range: the range of adhesion, 2 m, exceeds"));
    let output = bench.run(&format!(
        "solve --heights clean.npy --length-unit um --mean-gap 0.03 {} 2 --no-pictures --out plain",
        law.replace("kJ/m2", "")
    ));
    assert!(text(&output.stderr).contains("the range of adhesion, 2 um, exceeds"), "{}", text(&output.stderr));
}

#[test]
fn a_code_for_missing_points_is_named_as_it_stands_in_the_file() {
    let bench = bench();
    let mut map = Topography::new(read_field(bench.path("clean.npy")).unwrap());
    (map.lengths, map.unit) = (Some((1.0, 1.0)), Some("nm".to_owned()));
    for (code, count) in [(-999.0, 1), (1e30, 2)] {
        (0..count).for_each(|j| map.heights[[3, j]] = code);
        write_topography(bench.path("map.npz"), &map).unwrap();
        for command in ["solve --no-pictures --out o --mean-pressure", "sweep --out o.csv --mean-pressures"] {
            let command = format!("{command} 1kPa --heights map.npz --modulus 1GPa --force --strict");
            let refused = bench.refused(&command);
            let start = format!("error: missing-code: {} stands at {count} node", display(code));
            assert!(refused.starts_with(&start), "{refused}");
            assert!(refused.contains(&format!("--missing {} --fill", display(code))), "{refused}");
        }
        let filled = bench.said(&format!("prepare map.npz --missing {} --fill --out f.npz --force", display(code)));
        assert!(filled.contains(&format!("stood at {count} of 1024 points")), "{filled}");
        (0..count).for_each(|j| map.heights[[3, j]] = 0.0);
    }
}

/// A code as messages have it.
fn display(code: f64) -> String {
    if code.abs() < 1e9 { format!("{code}") } else { format!("{code:e}") }
}

#[test]
fn the_page_of_a_table_has_the_warnings_of_all_its_runs() {
    let bench = bench();
    let listed = |table: &str| -> Vec<String> {
        bench.said(&format!("report {table} --force"));
        let page = bench.read(&format!("{table}.html"));
        let items = page.lines().filter_map(|line| line.strip_prefix("<li>")?.strip_suffix("</li>"));
        items.map(|item| item.split([',', '.']).next().unwrap_or_default().to_owned()).collect()
    };
    let high = "the contact pressure is up to";
    let first_words = |warnings: &[String]| warnings.iter().map(|text| text[..10].to_owned()).collect::<Vec<_>>();
    bench.run("sweep --heights tilted.npy --mean-pressures 5 --out s.csv");
    let found = listed("s.csv");
    assert_eq!(first_words(&found), ["the map is", "opposite e", "the contac"], "{found:?}");
    // a run that continues adds what is new to what was said before
    bench.run("sweep --heights clean.npy --mean-pressures 0.01 --out t.csv");
    assert!(listed("t.csv").is_empty() && !bench.names(".").contains(&"t.csv.warnings.txt".to_owned()));
    bench.run("sweep --heights clean.npy --mean-pressures 0.01,5 --out t.csv");
    let found = listed("t.csv");
    assert!(found.len() == 1 && found[0].starts_with(high), "{found:?}");
    let again = bench.run("sweep --heights clean.npy --mean-pressures 0.01,5,0.02 --out t.csv --json");
    let report: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!((codes(&report), said(&text(&again.stderr))), (vec!["beyond-modulus"], vec![]));
    assert_eq!(listed("t.csv"), found);
    // what was said before is no reason to write more of it with --strict
    let table = bench.read("t.csv");
    let further = "sweep --heights clean.npy --mean-pressures 0.01,5,0.02,6 --out t.csv --strict --quiet";
    bench.refused_with(further, &["beyond-modulus"]);
    assert_eq!(bench.read("t.csv"), table);
    bench.run("sweep --heights clean.npy --mean-pressures 0.01 --out t.csv --force");
    assert!(listed("t.csv").is_empty());
    bench.run("cycle --heights tilted.npy --mean-gaps 2,1 --steps 1 --smallest-step 0.5 --out c.csv");
    assert_eq!(first_words(&listed("c.csv")), ["the map is", "opposite e"]);
    bench.write(
        "study.toml",
        "command = \"sweep\"\nout = \"study.csv\"\nmean-pressures = \"0.01\"\n[vary]\n\
         heights = [\"clean.npy\", \"tilted.npy\"]\nmodulus = [1.0, 2.0]\n",
    );
    bench.run("study study.toml");
    let found = listed("study.csv");
    assert!(found[0].starts_with("cases 3-4: the map is") && found.len() == 2, "{found:?}");
    // one of each code, though its figures differ
    bench.write(
        "rough.toml",
        "command = \"sweep\"\nout = \"rough.csv\"\nmean-pressures = \"0.01\"\n[make]\nsize = 16\n\
         rms-slope = 2.0\nk-s = 4\n[vary]\nseed = [2, 3, 1]\n",
    );
    bench.run("study rough.toml");
    let found = listed("rough.csv");
    assert!(found.len() == 2 && found.iter().all(|one| one.starts_with("all cases")), "{found:?}");
    // with the warnings of the worst of its cases
    let alone = [2, 3, 1].map(|seed| {
        bench.said(&format!("surface --size 16 --rms-slope 2 --k-s 4 --seed {seed} --quiet --force --out made.npy"));
        bench.run("sweep --heights made.npy --mean-pressures 0.01 --force --out made.csv");
        let said = bench.read("made.csv.warnings.txt");
        let (severity, message) = said.lines().next().unwrap().split_once("]: ").unwrap();
        (severity.split_once('[').unwrap().1.parse::<f64>().unwrap(), message.to_owned())
    });
    let worst = (0..3).max_by(|i, j| alone[*i].0.total_cmp(&alone[*j].0)).unwrap();
    let figures = format!("with the figures of case {}, the worst: {}", worst + 1, alone[worst].1);
    assert!(worst > 0 && bench.read("rough.csv.warnings.txt").contains(&figures), "{alone:?}");
    bench.write(
        "range.toml",
        "command = \"sweep\"\nout = \"range.csv\"\nheights = \"clean.npy\"\nmean-pressures = \"0.01\"\n[adhesion]\n\
         law = \"exponential\"\nwork-of-adhesion = 1e-4\n[vary]\nrange = [3e-3, 9e-4, 2e-3]\n",
    );
    bench.run("study range.toml");
    let found = bench.read("range.csv.warnings.txt");
    assert!(
        found.starts_with("range [") && found.contains("all cases, with the figures of case 2, the worst"),
        "{found}"
    );
    bench.said("report range.csv");
    assert!(bench.read("range.csv.html").contains("case 2, the worst"));
    // and so do the rows of a sweep, in whatever order they come
    for pressures in ["5,9,6", "9,5,6", "5,6,9"] {
        let sweep = format!("sweep --heights clean.npy --mean-pressures {pressures} --out rows.csv --force --json");
        let report: Value = serde_json::from_slice(&bench.run(&sweep).stdout).unwrap();
        let message = report["warnings"][0]["message"].as_str().unwrap();
        assert!(bench.read("rows.csv.warnings.txt").ends_with(&format!("]: {message}\n")));
        let alone = bench.run("sweep --heights clean.npy --mean-pressures 9 --out only.csv --force --json");
        let alone: Value = serde_json::from_slice(&alone.stdout).unwrap();
        let figure = |text: &str| text.split(',').next().unwrap().to_owned();
        assert_eq!(figure(message), figure(alone["warnings"][0]["message"].as_str().unwrap()), "{pressures}");
    }
}

#[test]
fn the_file_of_warnings_of_a_table_replaces_no_other() {
    let bench = bench();
    let sweep = "sweep --heights clean.npy --mean-pressures 0.01 --out t.csv";
    bench.write("t.csv.warnings.txt", "of another kind");
    bench.refused_with(sweep, &["t.csv.warnings.txt: exists: use --force"]);
    assert_eq!(bench.read("t.csv.warnings.txt"), "of another kind");
    bench.said(&format!("{sweep} --force"));
    assert!(!bench.names(".").contains(&"t.csv.warnings.txt".to_owned()));
    bench.write(
        "study.toml",
        "command = \"sweep\"\nheights = \"clean.npy\"\nmean-pressures = \"0.01\"\n[vary]\nmodulus = [1.0, 2.0]\n",
    );
    bench.write("v.csv.warnings.txt", "of another kind");
    bench.refused_with("study study.toml --out v.csv", &["v.csv.warnings.txt: exists: use --force"]);
    assert_eq!(bench.read("v.csv.warnings.txt"), "of another kind");
    // what cannot be replaced leaves no table
    std::fs::create_dir(bench.path("u.csv.warnings.txt")).unwrap();
    let before = bench.names(".");
    bench.refused_with(&sweep.replace("t.csv", "u.csv --force"), &["u.csv.warnings.txt"]);
    assert_eq!(bench.names("."), before);
}

#[test]
fn prepare_looks_at_the_slope_that_its_lengths_make() {
    let bench = bench();
    let prepare = |options: &str| {
        let output = bench.run(&format!("prepare metres.npy {options} --out out.npz --force --json"));
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        codes(&report).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(prepare("--lengths 1 --unit nm"), ["smooth"]);
    // with the step that mends it, or without lengths, there is nothing to say
    assert_eq!([prepare("--lengths 1 --scale 1e9 --unit nm"), prepare("")], [Vec::<String>::new(), Vec::new()]);
    let said = bench.said("prepare both.npy --lengths 1 --fill --out filled.npz");
    assert!(said.contains("1 missing, 1 infinite") && said.contains("2 of 1024 points filled"), "{said}");
}

#[test]
fn side_lengths_of_another_file_win_over_those_in_a_scene() {
    let bench = bench();
    bench.said("solve --heights small.npz --lengths 1 1 --mean-pressure 0.01 --no-pictures --out small --quiet");
    for given in ["--heights large.npz", "--heights=large.npz"] {
        let report = bench.reported(&format!("run small/scene.toml {given} --out large --force"));
        assert_eq!(report["lengths"], serde_json::json!([3.0, 3.0]));
    }
    // the scene that this leaves repeats it
    bench.said("run large/scene.toml --out again --quiet");
    assert!(bench.bytes("large/gap.npy") == bench.bytes("again/gap.npy"));
    // a file without lengths takes the lengths of the scene, and lengths that are given count
    assert_eq!(
        bench.reported("run small/scene.toml --heights clean.npy --out a")["lengths"],
        serde_json::json!([1.0, 1.0])
    );
    bench.refused_with("run small/scene.toml --heights large.npz --lengths 2 2 --out b", &["--lengths", "3 x 3"]);
}
