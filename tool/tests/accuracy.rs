//! Accuracies that are asked for, and contact stiffnesses, end to end.

use crate::bench::{Bench, text};
use serde_json::Value;

/// A folder with a rough surface, with four nodes in the shortest wave.
fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 32 --k-l 1 --k-r 2 --k-s 8 --rms-slope 0.1 --quiet --out heights.npy");
    bench
}

const PRESSED: &str = "solve --heights heights.npy --mean-pressure 5e-3 --no-pictures";

#[test]
fn an_accuracy_is_planned_reached_and_reported() {
    let bench = rough();
    let said = bench.said(&format!("{PRESSED} --accuracy 0.01 --out right"));
    let first = said.lines().next().unwrap();
    for part in ["accuracy 0.01 of the area: the shortest wave has", "likely", "tolerance 5e-4, about", "MiB"] {
        assert!(first.contains(part), "{first}");
    }
    assert!(said.contains("error of the grid"), "{said}");
    let report = bench.report("right");
    assert_eq!(report["accuracy"], serde_json::json!({ "wanted": 0.01, "of": "area", "reached": true }));
    let error = report["grid_error"]["area"]["relative"].as_f64().unwrap();
    assert!(error > 1e-3 && error < 0.01, "{report}");
    assert_eq!(report["tolerance"], 5e-4);
    // what is given, or was not asked for, has none
    assert_eq!(report["grid_error"]["pressure"], Value::Null);
    let levels = report["levels"].as_array().unwrap();
    assert_eq!(levels.last().unwrap()["shape"], report["shape"]);
    assert!(report["shape"][0].as_u64().unwrap() >= 64 && report["equivalent_applications"].as_f64().unwrap() > 10.0);
    // its scene repeats it, and a plain solve has no such keys
    bench.said("run right/scene.toml --out again --quiet");
    assert!(bench.bytes("right/gap.npy") == bench.bytes("again/gap.npy"));
    let plain = bench.reported(&format!("{PRESSED} --out plain"));
    assert_eq!((&plain["accuracy"], &plain["grid_error"]), (&Value::Null, &Value::Null));
}

#[test]
fn an_error_of_the_grid_that_cannot_be_told_says_why() {
    // the shortest wave of the second has 95/24 nodes
    for (size, k_s, nodes) in [(64, 31, "2."), (95, 29, "3.9")] {
        let bench = Bench::new();
        bench.said(&format!("surface --size {size} --k-l 1 --k-s {k_s} --rms-slope 0.1 --quiet --out noisy.npy"));
        let said = bench.said("solve --heights noisy.npy --mean-pressure 5e-3 --nested --no-pictures --out out");
        let told = said.lines().find(|line| line.starts_with("error of the grid")).unwrap();
        let unknown = format!("unknown: the shortest wave has {nodes}");
        assert!(told.contains(&unknown) && told.contains(" nodes and needs 4: refine"), "{told}");
        // and so does the page
        bench.said("report out");
        assert!(bench.read("out/report.html").contains(&unknown));
    }
}

#[test]
fn an_accuracy_that_is_not_reached_says_why() {
    let bench = rough();
    let output = bench.run(&format!("{PRESSED} --accuracy 0.004 --memory 1e-3 --out near"));
    let warning = text(&output.stderr);
    assert_eq!((output.status.code(), warning.lines().count()), (Some(2), 1), "{warning}");
    for part in ["the accuracy of 0.004 of the area is not reached: the estimate is", "would be next", "--memory"] {
        assert!(warning.contains(part), "{warning}");
    }
    assert_eq!(bench.report("near")["accuracy"]["reached"], false);
    bench.refused_with(
        &format!("{PRESSED} --accuracy 1e-6 --memory 1e-2 --out no"),
        &["1e-6 of the area takes about", "GiB", "enough for about"],
    );
    // a punch is known on its grid alone
    bench.said("surface --form flat-punch --radius 0.3 --size 32 --quiet --out punch.npz");
    let output = bench.run(
        "solve --heights punch.npz --boundary free --absent-missing --approach 0.01 --no-pictures --out held \
         --accuracy 0.01 --accuracy-of pressure",
    );
    let warning = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{warning}");
    assert!(warning.contains("is not reached") && warning.contains("absent nodes"), "{warning}");
}

#[test]
fn stiffness_is_found_where_it_is_asked_for() {
    let bench = rough();
    let plain = bench.reported(&format!("{PRESSED} --out plain"));
    assert_eq!((&plain["contact_stiffness"], &plain["normal_stiffness"]), (&Value::Null, &Value::Null));
    let report = bench.reported(&format!("{PRESSED} --lengths 2 2 --stiffness --out stiff"));
    let [stiffness, normal] = ["contact_stiffness", "normal_stiffness"].map(|key| report[key].as_f64().unwrap());
    assert!(stiffness > 0.0 && (normal / stiffness - 4.0).abs() < 1e-12);
    assert!(bench.said(&format!("{PRESSED} --stiffness --force --out plain")).contains("contact stiffness"));
    // the same in a sweep, in columns of their own
    let sweep = "sweep --heights heights.npy --lengths 2 2 --mean-pressures 5e-3,1e-2 --stiffness --out";
    bench.said(&format!("{sweep} sweep.csv --quiet"));
    let table = bench.read("sweep.csv");
    let (header, first) = (table.lines().next().unwrap(), table.lines().nth(1).unwrap());
    assert!(header.ends_with(",heights,part,seed,contact_stiffness,normal_stiffness"), "{header}");
    let cells: Vec<f64> = first.rsplit(',').take(2).map(|cell| cell.parse().unwrap()).collect();
    assert!((cells[0] / normal - 1.0).abs() < 1e-3 && (cells[1] / stiffness - 1.0).abs() < 1e-3, "{first}");
    let other = "sweep --heights heights.npy --lengths 2 2 --mean-pressures 5e-3,1e-2 --out sweep.csv";
    bench.refused_with(other, &["sweep.csv", "stiffness"]);
    // pressed flat nothing gives way
    let full = bench.reported("solve --heights heights.npy --mean-pressure 0.4 --no-pictures --stiffness --out full");
    assert_eq!((full["contact_fraction"].as_f64(), &full["contact_stiffness"]), (Some(1.0), &Value::Null));
}
