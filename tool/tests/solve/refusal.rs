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
fn bad_input_is_refused_on_one_line_and_writes_nothing() {
    let bench = paraboloid();
    write_npy(bench.path("negative.npy"), &(hertz(64) - 1e-9)).unwrap();
    fs::write(bench.path("words.txt"), "one two\n").unwrap();
    let before = bench.names(".");
    let good = "--heights heights.npy --mean-gap 0.0398";
    for (arguments, parts) in [
        (format!("{good} --threads 0"), vec!["--threads", "is 0", "from 1"]),
        (format!("{good} --max-iterations 1.5"), vec!["--max-iterations", "1.5"]),
        (format!("{good} --lengths 1 -1"), vec!["--lengths", "-1", "positive"]),
        (format!("{good} --initial-gap negative.npy"), vec!["gap", "-0.125000001", "zero or positive"]),
        (format!("{good} --colour red"), vec!["--colour", "see --help"]),
        ("heights.npy --mean-gap 1".to_owned(), vec!["'heights.npy'", "'--heights heights.npy'"]),
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
