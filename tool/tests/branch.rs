//! The branch of equilibria, end to end.

use serde_json::Value;

use crate::bench::Bench;

/// A wave with adhesion that holds it flat once it was pressed flat.
const STICKY: &str = "--heights wave.npy --law exponential --work-of-adhesion 4e-4 --range 4e-3 --no-pictures";

fn wave() -> Bench {
    let bench = Bench::new();
    bench.said("surface --form wave --shape 128 1 --lengths 1 1 --amplitude 0.02 --quiet --out wave.npy");
    bench
}

#[test]
fn both_branches_are_compared_and_the_default_is_loading() {
    let bench = wave();
    let said = bench.said(&format!("solve {STICKY} --mean-pressure 1e-3 --branch both --out both"));
    let line =
        |name: &str| said.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}: {said}"));
    assert!(line("branch ").ends_with(" loading"), "{said}");
    assert!(line("on that of unloading ").contains(" 100.0 % contact, mean gap 0"), "{said}");
    let report = bench.report("both");
    let other = &report["other_branch"];
    assert_eq!(
        (&report["branch"], &other["branch"], &other["same"]),
        (&"loading".into(), &"unloading".into(), &false.into())
    );
    assert!(other["distance"].as_f64().unwrap() > 0.1 && other["contact_fraction"] == 1.0);
    let alone = bench.reported(&format!("solve {STICKY} --mean-pressure 1e-3 --out alone"));
    assert_eq!((&alone["contact_nodes"], &alone["other_branch"]), (&report["contact_nodes"], &Value::Null));
    let flat = bench.reported(&format!("solve {STICKY} --mean-pressure 1e-3 --branch unloading --out flat"));
    assert_eq!((&flat["contact_fraction"], &flat["branch"]), (&other["contact_fraction"], &"unloading".into()));
    // weaker adhesion has one equilibrium
    let weak = STICKY.replace("4e-4", "1e-5");
    let said = bench.said(&format!("solve {weak} --mean-pressure 0.01 --branch both --out one"));
    assert!(
        said.lines()
            .any(|line| line.starts_with("on that of unloading") && line.contains("no second equilibrium found"))
    );
    assert_eq!(bench.report("one")["other_branch"]["same"], true);
    // the scene has the branch, and a sweep begins on it
    assert!(bench.read("flat/scene.toml").contains("branch = \"unloading\"\n"));
    let first = |branch: &str| {
        let out = format!("{branch}.csv");
        bench.said(&format!(
            "sweep {} --mean-pressures 1e-3,2e-3 --branch {branch} --out {out}",
            STICKY.replace(" --no-pictures", "")
        ));
        bench.column(&out, "contact_fraction")[0]
    };
    assert!(first("loading") < 0.9 && first("unloading") == 1.0);
    let both = format!("sweep {} --mean-pressures 1e-3,2e-3 --branch both", STICKY.replace(" --no-pictures", ""));
    bench.refused_with(&format!("{both} --out none.csv"), &["--branch both", "solve under one"]);
}
