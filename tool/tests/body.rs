//! Layers and coatings, end to end.

use crate::bench::Bench;

fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 64 --k-l 2 --k-s 16 --rms-slope 0.1 --quiet --out heights.npy");
    bench
}

const PRESSED: &str = "solve --heights heights.npy --mean-pressure 0.02 --no-pictures";
const COATED: &str = "--coating 0.1 --coating-modulus 5 --coating-poisson 0.2 --poisson 0.3";

#[test]
fn bodies_are_solved_reported_and_repeated() {
    let bench = rough();
    let contact = |arguments: &str, out: &str| {
        let report = bench.reported(&format!("{PRESSED} {arguments} --out {out}"));
        report["contact_fraction"].as_f64().unwrap()
    };
    // each key arrives: thin bodies on a rigid base, and hard skins, are stiffer
    let half_space = contact("", "half-space");
    let (bonded, sliding) = ("--layer 0.05 --poisson 0.45", "--layer 0.05 --poisson 0.45 --base sliding");
    assert!(contact(bonded, "bonded") < contact(sliding, "sliding"));
    assert!(contact(COATED, "coated") < half_space);

    let report = bench.report("coated");
    for (key, value) in [("coating", 0.1), ("coating_modulus", 5.0), ("coating_poisson", 0.2), ("poisson", 0.3)] {
        assert_eq!(report[key], value, "{key}");
    }
    assert!(report["layer"].is_null() && report["base"].is_null());
    assert_eq!(["bonded", "sliding"].map(|name| bench.report(name)["base"].clone()), ["bonded", "sliding"]);
    let said = bench.said(&format!("{PRESSED} {COATED} --out told"));
    assert!(said.contains("coating of 0.1, contact modulus 5"), "{said}");

    bench.said("run coated/scene.toml --quiet --out repeated");
    assert_eq!(bench.bytes("repeated/gap.npy"), bench.bytes("coated/gap.npy"));
}

#[test]
fn bodies_are_swept_cycled_and_kept_apart_in_tables() {
    let bench = rough();
    let table = "--heights heights.npy --mean-gaps 0.03,0.02 --quiet --out table.csv";
    bench.said(&format!("sweep {table} --layer 0.05 --poisson 0.3"));
    // the table of another body is not continued
    bench.refused_with(&format!("sweep {table}"), &["table.csv", "poisson is 0.3, and not none"]);
    bench.refused_with(&format!("sweep {table} --layer 0.06 --poisson 0.3"), &["table.csv", "layer"]);
    let law = "--law exponential --work-of-adhesion 1e-4 --range 4e-3";
    let gaps = "--mean-gaps 0.03,0.02,0.03 --steps 4 --quiet --out cycle.csv";
    bench.said(&format!("cycle --heights heights.npy {law} {gaps} {COATED}"));
}
