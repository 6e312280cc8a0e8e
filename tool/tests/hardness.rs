//! A cap on the contact pressure, end to end.

use asperity_maps::io::{read_field, write_npy};
use ndarray::{Array2, Zip};
use serde_json::Value;

use crate::bench::{Bench, text};

/// A bench with a rough surface of 48 x 48 nodes, and the greatest contact pressure on it at a mean pressure of 0.02.
fn rough() -> (Bench, f64) {
    let bench = Bench::new();
    bench.said("surface --size 48 --k-s 6 --rms-slope 0.2 --seed 3 --quiet --out heights.npy");
    bench.said("solve --heights heights.npy --mean-pressure 0.02 --quiet --out elastic");
    let greatest = field(&bench, "elastic/contact_pressure").fold(0.0, |most: f64, p| most.max(*p));
    (bench, greatest)
}

fn field(bench: &Bench, name: &str) -> Array2<f64> {
    read_field(bench.path(&format!("{name}.npy"))).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_solve_caps_the_pressure_and_reports_what_has_yielded() {
    let (bench, greatest) = rough();
    let hardness = 0.3 * greatest;
    let run = format!("solve --heights heights.npy --mean-pressure 0.02 --tolerance 1e-8 --hardness {hardness}");
    let report = bench.reported(&format!("{run} --fields displacement --out r"));
    let names = "contact.png contact_pressure.npy displacement.npy gap.npy plastic_depth.npy pressure.npy pressure.png \
                 report.json scene.toml";
    assert_eq!(bench.names("r").join(" "), names);
    let [gap, depth] = ["gap", "plastic_depth"].map(|name| field(&bench, &format!("r/{name}")));
    // u = g + h to the surface as it is now
    let own = field(&bench, "heights") - &depth + &gap;
    assert!(Zip::from(&own).and(&field(&bench, "r/displacement")).all(|a, b| (a - b).abs() < 1e-15));
    let yielded = depth.iter().filter(|depth| **depth > 0.0).count() as f64 / depth.len() as f64;
    assert_eq!((number(&report["hardness"]), number(&report["plastic_fraction"])), (hardness, yielded));
    let none = bench.report("elastic");
    for key in ["plastic_depth_max", "plastic_depth_mean", "plastic_energy", "plastic_fraction"] {
        assert!(number(&report[key]) > 0.0 && none[key].is_null(), "{key}");
    }
    assert!(none["hardness"].is_null() && !bench.path("elastic/plastic_depth.npy").exists());
    // the scene repeats it
    assert!(
        bench.read("r/scene.toml").contains(&format!("[body]\nhardness = {hardness}")),
        "{}",
        bench.read("r/scene.toml")
    );
    bench.said("run r/scene.toml --out again --quiet");
    assert_eq!(bench.bytes("again/plastic_depth.npy"), bench.bytes("r/plastic_depth.npy"));
    // other forms of the fields have it, and the page of the results tells it
    bench.said(&format!("{run} --format npz,vti --no-pictures --quiet --out both"));
    for archive in ["both/fields.npz", "both/fields.vti"] {
        assert!(bench.bytes(archive).windows(13).any(|name| name == b"plastic_depth"), "{archive}");
    }
    bench.said("report r");
    let page = bench.read("r/report.html");
    assert!(page.contains("yielded") && page.contains("plastic depth max"), "no word of it on the page");
}

#[test]
fn a_hardness_varies_over_the_nodes_of_a_map() {
    let (bench, greatest) = rough();
    let hardness = Array2::from_shape_fn((48, 48), |(i, _)| if i < 24 { 0.2 * greatest } else { 10.0 * greatest });
    write_npy(bench.path("hardness.npy"), &hardness).unwrap();
    let run = "solve --heights heights.npy --mean-pressure 0.02 --no-pictures --hardness-map";
    let report = bench.reported(&format!("{run} hardness.npy --out r"));
    assert_eq!(
        (&report["hardness_map"], number(&report["hardness"])),
        (&"hardness.npy".into(), hardness.mean().unwrap())
    );
    let depth = field(&bench, "r/plastic_depth");
    assert!(depth.indexed_iter().all(|((i, _), depth)| i < 24 || *depth == 0.0) && depth.sum() > 0.0);
    bench.said("run r/scene.toml --out again --quiet");
    assert_eq!(bench.bytes("again/gap.npy"), bench.bytes("r/gap.npy"));
    // the file is part of the identity of a table
    let table = "sweep --heights heights.npy --mean-pressures 0.01 --hardness-map hardness.npy --quiet --out s.csv";
    bench.said(table);
    write_npy(bench.path("hardness.npy"), &(2.0 * hardness)).unwrap();
    bench.refused_with(table, &["another file of its hardness map"]);
    bench.refused_with(&table.replace("hardness-map hardness.npy", "hardness 1"), &["hardness is"]);
    write_npy(bench.path("hardness.npy"), &Array2::from_elem((24, 48), 1.0)).unwrap();
    bench.refused_with(&format!("{run} hardness.npy --out none"), &["--hardness-map", "24 x 48", "48 x 48"]);
    write_npy(bench.path("hardness.npy"), &Array2::from_elem((48, 48), -1.0)).unwrap();
    bench.refused_with(&format!("{run} hardness.npy --out none"), &["hardness", "-1"]);
    bench.refused_with(
        &format!("{run} hardness.npy --hardness 1 --out none"),
        &["--hardness is given with --hardness-map"],
    );
}

#[test]
fn what_does_not_fit_a_hardness_is_refused_by_name_before_the_solve() {
    let (bench, _) = rough();
    let solve = "solve --heights heights.npy --mean-pressure 0.1 --out none --hardness";
    bench.refused_with(&format!("{solve} h.npy"), &["--hardness-map h.npy"]);
    for command in ["sweep --mean-pressures 0.01 --stiffness", "sweep --mean-pressures 0.01 --method rey2017"] {
        let run = format!("{command} --heights heights.npy --hardness 0.2 --out none.csv");
        bench.refused_with(&run, &["and --hardness"]);
    }
    let law = "--law exponential --work-of-adhesion 1e-5 --range 1e-2";
    bench
        .refused_with(&format!("pull-off --heights heights.npy {law} --hardness 1"), &["--hardness is given", "cycle"]);
    bench.refused_with("laws --hardness 1", &["--hardness is given"]);
    assert!(!bench.path("none").exists() && !bench.path("none.csv").exists());
}

#[test]
fn a_share_of_contact_that_a_mean_gap_does_not_reach_is_told() {
    let (bench, _) = rough();
    // with adhesion by the mean gap to the surface as it was made, which is not negative
    let law = "--law exponential --work-of-adhesion 2e-5 --range 2e-3";
    let run =
        format!("solve --heights heights.npy --hardness 0.05 --no-pictures --out r --contact-fraction 0.95 {law}");
    let output = bench.run(&format!("{run} --quiet"));
    let told = text(&output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("95.0 % contact: it grows to"), "{told}");
}

#[test]
fn a_cycle_tells_what_yielding_has_dissipated() {
    let (bench, greatest) = rough();
    let hardness = 0.3 * greatest;
    let run = format!("cycle --heights heights.npy --mean-pressures 1e-4,0.03,1e-4 --steps 6 --hardness {hardness}");
    let report = bench.reported(&format!("{run} --out cycle.csv"));
    let plastic = bench.column("cycle.csv", "plastic_energy");
    assert_eq!(Some(&number(&report["plastic_energy"])), plastic.last());
    let said = bench.said(&format!("{run} --out again.csv"));
    assert!(said.contains("dissipated by yielding"), "{said}");
    bench.said("report cycle.csv");
    assert!(bench.read("cycle.csv.html").contains("plastic work per area"));
}
