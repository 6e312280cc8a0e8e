//! The self-test: what it finds, and how it tells.

use crate::bench::Bench;

#[test]
fn the_selftest_holds_and_tells_every_difference() {
    let bench = Bench::new();
    let report = bench.reported("selftest");
    assert_eq!((&report["command"], &report["ok"]), (&"selftest".into(), &true.into()));
    let checks = report["checks"].as_array().unwrap();
    for check in checks {
        let number = |key: &str| check[key].as_f64().unwrap();
        assert_eq!(number("difference"), (number("found") - number("theory")).abs(), "{check}");
        assert!(number("difference") <= number("allowed") && check["ok"] == true, "{check}");
        // what is allowed would not hide an answer that is wrong by a twentieth
        assert!(number("allowed") <= 0.05 * number("theory").abs(), "{check}");
    }
    for part in ["Hertz", "Maugis", "Westergaard", "Johnson", "full contact", "rough"] {
        let precisions = checks.iter().filter(|check| check["what"].as_str().unwrap().contains(part));
        let precisions: Vec<_> = precisions.map(|check| check["precision"].as_str().unwrap()).collect();
        assert!(precisions.contains(&"f64"), "{part}");
        assert!(precisions.contains(&"f32") || ["Westergaard", "Johnson"].contains(&part), "{part}");
    }
    // nothing is written
    assert!(bench.names(".").is_empty());
}

#[test]
fn the_selftest_prints_a_line_for_every_check_or_nothing() {
    let bench = Bench::new();
    let said = bench.said("selftest");
    let lines: Vec<_> = said.lines().collect();
    assert!(lines[0].starts_with("what") && lines[0].ends_with("ok"), "{said}");
    let held = lines.iter().filter(|line| line.ends_with("  yes")).count();
    let last = lines.last().unwrap();
    assert!(held >= 15 && last.starts_with(&format!("{held} checks in ")) && last.ends_with("all hold"), "{said}");
    assert_eq!(bench.said("selftest --quiet"), "");
    bench.refused_with("selftest --modulus 3", &["--modulus"]);
}
