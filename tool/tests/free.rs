//! The free boundary, its loads, absent nodes and simple forms, end to end.

use std::f64::consts::PI;

use asperity_maps::io::read_field;
use serde_json::{Value, json};

use crate::bench::{Bench, text};

const TIP: &str = "surface --form sphere --radius 2 --size 32 --lengths 1 --quiet --out tip.npz";

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_punch_has_absent_nodes_and_its_gap_is_a_start() {
    let bench = Bench::new();
    let made = bench.reported("surface --form flat-punch --radius 0.3 --size 48 --out punch.npz");
    let absent = number(&made["absent_nodes"]);
    assert!((1.0 - absent / 48.0_f64.powi(2) - PI * 0.09).abs() < 0.02, "{made}");
    let solve = "solve --heights punch.npz --boundary free --absent-missing --approach 0.01 --no-pictures";
    let solved = bench.reported(&format!("{solve} --out a"));
    assert_eq!(number(&solved["absent_nodes"]), absent);
    assert_eq!(solved["warnings"], Value::Array(Vec::new()));
    let gap = read_field(bench.0.path().join("a/gap.npy")).unwrap();
    assert_eq!(gap.iter().filter(|gap| gap.is_nan()).count() as f64, absent);
    let again = bench.reported(&format!("{solve} --initial-gap a/gap.npy --out b"));
    assert!(again["iterations"].as_u64() <= solved["iterations"].as_u64(), "{again}");
}

#[test]
fn a_cycle_without_a_range_tells_its_limits() {
    let bench = Bench::new();
    bench.said("surface --form paraboloid --radius 2 --size 32 --lengths 0.7 --quiet --out tip.npz");
    let cycle =
        "cycle --heights tip.npz --boundary free --law jkr --work-of-adhesion 5e-5 --approaches=-8e-3,6e-3,-20e-3";
    let found = bench.reported(&format!("{cycle} --out c.csv"));
    let events: Vec<_> = found["events"].as_array().unwrap().iter().map(|event| event["event"].clone()).collect();
    assert_eq!(events, ["touch", "pull-off"], "the largest jump first");
    for name in ["tension_limit", "tension_limit_error", "work_limit", "work_limit_error"] {
        assert!(number(&found[name]) > 0.0, "{name}: {found}");
    }
    let said = bench.said(&format!("{cycle} --out c.csv"));
    assert!(said.contains("16 x 16 nodes, for the error of the grid"), "{said}");
    assert_eq!(said.matches("in the limit").count(), 2, "{said}");
    // a map of one hardness is that hardness, on the coarser grid too, and the gap of a start is that of its nodes
    bench.write("hard.txt", &format!("{}\n", ["0.05"; 32].join(" ")).repeat(32));
    let limit_of = |more: &str| number(&bench.reported(&format!("{cycle} --out c.csv --force {more}"))["work_limit"]);
    assert_eq!(limit_of("--hardness-map hard.txt"), limit_of("--hardness 0.05"));
    bench.said("solve --heights tip.npz --boundary free --approach=-8e-3 --quiet --out apart");
    let [from_start, from_afar] = ["--initial-gap apart/gap.npy", ""].map(limit_of);
    assert!((from_start / from_afar - 1.0).abs() < 1e-3, "{from_start} {from_afar}");
    // an odd number of nodes has no half on which a map of works of adhesion is known
    bench.said("surface --form paraboloid --radius 2 --size 33 --lengths 0.7 --quiet --out odd.npz");
    bench.write("works.txt", &format!("{}\n", ["5e-5"; 33].join(" ")).repeat(33));
    let odd =
        "cycle --heights odd.npz --boundary free --law jkr --work-of-adhesion-map works.txt --approaches=-8e-3,6e-3";
    let found = bench.reported(&format!("{odd} --out odd.csv"));
    assert!(found["work_limit"].is_null() && number(&found["work"]) < 0.0, "{found}");
}

#[test]
fn a_cycle_to_an_accuracy_is_on_the_grid_that_it_takes() {
    let bench = Bench::new();
    bench.said("surface --form paraboloid --radius 2 --size 32 --lengths 0.7 --quiet --out 32.npz");
    bench.said("surface --form paraboloid --radius 2 --size 64 --lengths 0.7 --quiet --out 64.npz");
    let cycle = "cycle --heights 32.npz --boundary free --work-of-adhesion 5e-5 --approaches=-8e-3,6e-3,-20e-3";
    let jkr = format!("{cycle} --accuracy 0.11 --law jkr --out c.csv");
    let found = bench.reported(&jkr);
    assert_eq!(found["accuracy"], json!({ "wanted": 0.11, "of": "work", "reached": true }));
    let shapes: Vec<_> = found["levels"].as_array().unwrap().iter().map(|level| level["shape"][0].clone()).collect();
    assert_eq!(shapes, [16, 32, 64]);
    assert_eq!(found["levels"][2]["work"], found["work"]);
    // again, it takes the same grid, and has its rows
    let table = bench.bytes("c.csv");
    let said = bench.said(&jkr);
    for part in ["64 x 64 nodes", "MiB, by the cycle on 16 x 16, 32 x 32; an error of", "rows already"] {
        assert!(said.contains(part), "{said}");
    }
    assert!(bench.bytes("c.csv") == table);
    for (more, refused) in [
        ("0.1 --law exponential --range 1e-3", "the error of the grid is known of the law jkr alone"),
        ("0.1 --law jkr --hardness 1", "--accuracy and --hardness"),
        ("0.03 --law jkr --memory 1e-6", "an accuracy of 0.03 of the work takes about"),
        ("0.1 --law jkr --accuracy-of area", "work or tension"),
    ] {
        let cycle = cycle.replace("32.npz", "64.npz");
        bench.refused_with(&format!("{cycle} --out d.csv --quiet --accuracy {more}"), &[refused]);
    }
}

#[test]
fn a_tip_jumps_in_and_off_and_the_cycle_ends_where_it_is_apart() {
    let bench = Bench::new();
    bench.said("surface --form paraboloid --radius 2 --size 42 --lengths 0.588 --quiet --out tip.npz");
    let cycle = "cycle --heights tip.npz --boundary free --law exponential --work-of-adhesion 2e-5 --range 2e-3 \
                 --spring-stiffness 0.01 --spring-positions=-0.02,0,-0.2 --steps 10 --smallest-step 1e-3 --out c.csv";
    let found = bench.reported(&format!("{cycle} --fields jumps --plot c.png"));
    let events: Vec<_> = found["events"].as_array().unwrap().iter().map(|event| event["event"].clone()).collect();
    assert_eq!(events, ["pull-off", "jump-in"], "the largest jump first");
    let directions: Vec<_> = found["events"].as_array().unwrap().iter().map(|e| e["direction"].clone()).collect();
    assert_eq!(directions, ["withdrawal", "approach"]);
    assert!(number(&found["greatest_tensile_force"]) > 0.0);
    let [contact, attraction] = ["contact_fraction", "attractive_fraction"].map(|name| bench.column("c.csv", name));
    assert_eq!((&bench.cells("c.csv", "direction")[0][..], contact[0]), ("start", 0.0));
    assert_eq!((contact.last(), attraction.last()), (Some(&0.0), Some(&0.0)));
    assert!(*bench.column("c.csv", "control_value").last().unwrap() > -0.2, "it continued to the end");
    // fields before and after each of two jumps: the last row is after the second
    assert_eq!(bench.names("jumps").len(), 4 * 3);
    // the same command again has nothing to do
    let before = bench.bytes("c.csv");
    bench.said(&format!("{cycle} --fields jumps"));
    assert!(before == bench.bytes("c.csv"));
    // a withdrawal that is not the last ends there too
    let loads = "--approaches 0.01,-0.2,0.005 --steps 8";
    bench.said(&format!("cycle --heights tip.npz --boundary free {loads} --quiet --out d.csv"));
    let last = bench.cells("d.csv", "direction").iter().rposition(|direction| direction == "withdrawal").unwrap();
    let loads = bench.column("d.csv", "control_value");
    assert!(bench.column("d.csv", "contact_fraction")[last] == 0.0 && loads[last] > -0.05, "{loads:?}");
    assert_eq!((bench.column("d.csv", "leg").last(), loads.last()), (Some(&2.0), Some(&0.005)));
}

#[test]
fn loads_that_a_boundary_does_not_have_are_refused_on_one_line() {
    let bench = Bench::new();
    bench.said(TIP);
    bench.said("surface --form flat-punch --radius 0.3 --size 16 --quiet --out punch.npz");
    let before = bench.names("");
    for (arguments, parts) in [
        ("solve --heights tip.npz --spring-position 1 --out x", vec!["--spring-stiffness"]),
        ("solve --heights tip.npz --spring-stiffness -1 --spring-position 0 --out x", vec!["is -1", "positive"]),
        ("solve --heights punch.npz --absent-missing --mean-gap 1 --out x", vec!["mean-gap", "absent nodes"]),
        ("sweep --heights tip.npz --approaches 0,1 --out x.csv", vec!["approach", "--boundary free"]),
        ("cycle --heights tip.npz --boundary free --mean-gaps 0,1 --out x.csv", vec!["mean gap"]),
        ("surface --form sphere --size 8 --out x.npy", vec!["--form sphere lacks --radius"]),
        ("surface --form cone --angle 90 --size 8 --out x.npy", vec!["--angle", "is 90", "below 90"]),
        ("surface --form wave --amplitude 1 --radius 1 --size 8 --out x.npy", vec!["--form wave has no --radius"]),
        (
            "surface --form wave --amplitude 1 --periods 5 --size 8 --out x.npy",
            vec!["periods MX is 5", "at most half the number of nodes"],
        ),
        ("surface --form flat-punch --radius 0.2 --size 8 --psd p.csv --out x.npy", vec!["no spectrum", "--psd"]),
    ] {
        let output = bench.run(arguments);
        let error = text(&output.stderr);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{arguments}: {error}");
        assert_eq!(error.lines().filter(|line| line.starts_with("error")).count(), 1, "{arguments}: {error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{arguments}: {error}");
        assert_eq!(bench.names(""), before, "{arguments}");
    }
}

#[test]
fn forms_are_tilted_and_rough() {
    let bench = Bench::new();
    bench.said("surface --form cone --angle 45 --size 8 --lengths 8 --tilt 0.5 --quiet --out cone.npy");
    let cone = read_field(bench.0.path().join("cone.npy")).unwrap();
    // nodes are 1 apart, and the apex is on node (4, 4)
    assert!(
        (cone[[4, 4]] - 0.0).abs() < 1e-12 && (cone[[7, 4]] + 1.5).abs() < 1e-12 && (cone[[1, 4]] + 4.5).abs() < 1e-12
    );
    let rough = "--size 32 --rms-height 1e-3 --k-s 8 --quiet --force";
    bench.said(&format!("surface {rough} --out rough.npy"));
    bench.said(&format!("surface --form wave --amplitude 0.1 --periods 2 1 {rough} --out both.npy"));
    bench.said("surface --form wave --amplitude 0.1 --periods 2 1 --size 32 --quiet --out wave.npy");
    let [rough, both, wave] =
        ["rough.npy", "both.npy", "wave.npy"].map(|name| read_field(bench.0.path().join(name)).unwrap());
    assert!((&both - &wave - &rough).iter().all(|h| h.abs() < 1e-15));
    assert!((wave[[16, 16]] - 0.1).abs() < 1e-15);
}
