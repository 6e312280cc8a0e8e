//! What the command solve refuses.

use super::*;

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
        (format!("{good} --law exponential --work-of-adhesion -1e-3 --range 1"), vec!["-1e-3", "zero or positive"]),
        (format!("{good} --law exponential --work-of-adhesion 1 --range 0"), vec!["--range", "is 0", "positive"]),
        (format!("{good} --threads 0"), vec!["--threads", "is 0", "from 1"]),
        (format!("{good} --threads -2"), vec!["--threads", "-2", "from 1"]),
        (format!("{good} --modulus nan"), vec!["--modulus", "nan", "finite"]),
        (format!("{good} --tolerance 0"), vec!["--tolerance is 0:", "positive"]),
        (format!("{good} --max-iterations 1.5"), vec!["--max-iterations", "1.5"]),
        (format!("{good} --lengths 1 -1"), vec!["--lengths", "-1", "positive"]),
        (format!("{good} --lengths 0"), vec!["--lengths is 0:", "positive"]),
        (format!("{good} --initial-gap missing.npy"), vec!["--initial-gap", "8 x 8", "64 x 64"]),
        (format!("{good} --initial-gap negative.npy"), vec!["gap", "-0.125000001", "zero or positive"]),
        ("--heights heights.npy --precision f32 --mean-gap 1e300".to_owned(), vec!["mean gap", "1e300", "precision"]),
        (format!("{good} --colour red"), vec!["--colour", "see --help"]),
        ("heights.npy --mean-gap 1".to_owned(), vec!["'heights.npy'", "'--heights heights.npy'"]),
        ("--heights heights.npy --mean-gap much".to_owned(), vec!["--mean-gap", "much", "a number"]),
        ("--heights heights.npy --mean-pressure inf".to_owned(), vec!["--mean-pressure", "inf", "finite"]),
        ("--mean-gap 1".to_owned(), vec!["--heights"]),
        ("--heights nothing.npy --mean-gap 1".to_owned(), vec!["nothing.npy", "does not exist", "check the path"]),
        ("--heights words.txt --mean-gap 1".to_owned(), vec!["words.txt", "line 1", "\"one\"", "expected"]),
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
