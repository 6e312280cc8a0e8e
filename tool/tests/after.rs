//! Conductance, percolation and leakage after a solve, end to end.

use serde_json::Value;

use crate::bench::{Bench, text};

const ROUGH: &str = "surface --size 64 --lengths 20um --k-l 2 --k-s 8 --rms-height 0.1um --quiet --out heights.npz";
const PRESSED: &str = "--heights heights.npz --modulus 1GPa";

#[test]
fn the_conductance_is_that_of_the_stiffness_with_its_error_and_unit() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let solve =
        format!("solve {PRESSED} --mean-pressure 4MPa --nested --stiffness --no-pictures --force --out pressed");
    let report = bench.reported(&format!("{solve} --resistivities 17nOhm·m 2.4uOhm*cm"));
    let found = &report["conductance"];
    let stiffness = report["contact_stiffness"].as_f64().unwrap();
    let expected = 2.0 * stiffness / (1e9 * (17e-9 + 24e-9));
    assert!((found["value"].as_f64().unwrap() / expected - 1.0).abs() < 1e-12, "{found}");
    assert!((found["whole"].as_f64().unwrap() / (expected * 4e-10) - 1.0).abs() < 1e-12, "{found}");
    assert!(found["relative_error"].as_f64().unwrap() < 0.03, "{found}");
    assert_eq!(found["relative_error"], report["stiffness_error"]);
    assert_eq!((&found["resistivities"][1], &found["conductivities"]), (&2.4e-8.into(), &().into()));
    let said = bench.said(&format!("{solve} --conductivities 400W/mK 15W/mK"));
    assert!(said.contains("conductance per area") && said.contains("W/(m²·K), to "), "{said}");

    // columns of a sweep, in which the same load has the same conductance
    let sweep = format!("sweep {PRESSED} --mean-pressures 4MPa,8MPa --stiffness --resistivities 17nOhm·m 24nOhm·m");
    bench.said(&format!("{sweep} --leakage --quiet --out sweep.csv"));
    let text = bench.read("sweep.csv");
    let (header, row) = (text.lines().next().unwrap(), text.lines().nth(1).unwrap());
    assert!(header.ends_with(
        "normal_stiffness [N/m],electrical_conductance [S/m2],conductance_error,transmissivity_x_lower [m3],\
         transmissivity_x_upper [m3],transmissivity_y_lower [m3],transmissivity_y_upper [m3]"
    ));
    let cells: Vec<f64> = row.rsplit(',').take(6).map(|cell| cell.parse().unwrap()).collect();
    assert!((cells[5] / expected - 1.0).abs() < 1e-3, "{cells:?}");
    assert!(cells[0] >= cells[1] && cells[0] - cells[1] <= 1e-3 * cells[0] && cells[0] > 0.0);
    // a table of other conductors, or of other bounds, is another one
    bench.refused_with(&format!("{sweep} --leakage 1e-2 --quiet --out sweep.csv"), &["sweep.csv", "leakage"]);
    let other = sweep.replace("24nOhm·m", "25nOhm·m");
    bench.refused_with(&format!("{other} --leakage --quiet --out sweep.csv"), &["sweep.csv", "resistivities"]);
}

#[test]
fn with_adhesion_the_spots_conduct_and_the_slope_of_the_law_does_not() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let solve = |more: &str| {
        let solve = format!("solve {PRESSED} --mean-pressure 4MPa --stiffness --resistivities 1Ohmm 1Ohmm");
        bench.reported(&format!("{solve} {more} --no-pictures --force --out solved"))
    };
    let sticky = solve("--law exponential --work-of-adhesion 20mJ/m2 --range 20nm");
    let found = &sticky["conductance"];
    let value = found["value"].as_f64().unwrap();
    // the law pulls between the spots, and makes the stiffness less than the stiffness of the spots
    assert!(value > sticky["contact_stiffness"].as_f64().unwrap() / 1e9, "{found}");
    assert!(found["relative_error"].is_null());
    // of weak adhesion it is that without
    let [weak, bare] = [solve("--law exponential --work-of-adhesion 1uJ/m2 --range 20nm"), solve("--no-nested")];
    let [weak, bare] = [&weak, &bare].map(|report| report["conductance"]["value"].as_f64().unwrap());
    assert!((weak / bare - 1.0).abs() < 1e-3 && value > bare, "{weak} {bare} {value}");
}

#[test]
fn percolation_is_told_with_its_constriction() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let solve = format!("solve {PRESSED} --mean-pressure 4MPa --percolation --out pressed");
    let said = bench.said(&solve);
    assert!(said.contains("gap along x") && said.contains("at the constriction, node ["), "{said}");
    let report = bench.report("pressed");
    let leak = bench.reported("leak pressed");
    for key in ["percolates", "constriction"] {
        assert_eq!(report[key], leak[key]);
    }
    assert!(report["transmissivity"].is_null() && report["conductance"].is_null());
    let said = bench.said(&format!("solve {PRESSED} --mean-pressure 4MPa --leakage"));
    assert!(said.contains("transmissivity along x") && said.contains("nm³"), "{said}");
}

#[test]
fn bounds_of_a_transmissivity_that_are_too_far_apart_are_told() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let told = |command: &str, code: i32| {
        let output = bench.run(&format!("{command} --quiet --leakage 1e-16"));
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{told}");
        assert!(
            told.contains("the bounds of the transmissivity hold, but are ") && told.contains("raise --leakage"),
            "{told}"
        );
    };
    told(&format!("solve {PRESSED} --mean-pressure 4MPa"), 2);
    told(&format!("sweep {PRESSED} --mean-pressures 4MPa --out table.csv"), 0);
}

#[test]
fn springs_that_end_at_a_rigid_wall_seal_as_it_does() {
    let bench = Bench::new();
    bench.said("surface --size 64 --k-l 2 --k-s 16 --rms-slope 0.1 --seed 1 --quiet --out heights.npy");
    for pressure in [0.01, 0.06] {
        let [hard, ends_rigid] = ["hard", "uzawa --wall-stiffness 50"].map(|wall| {
            let solve = format!("solve --heights heights.npy --mean-pressure {pressure} --wall {wall}");
            bench.reported(&format!("{solve} --leakage 1e-6"))
        });
        assert_eq!(ends_rigid["percolates"], hard["percolates"]);
        for axis in ["x", "y"] {
            let upper = |report: &Value| report["transmissivity"][axis]["upper"].as_f64().unwrap();
            let (found, expected) = (upper(&ends_rigid), upper(&hard));
            assert!((found - expected).abs() <= 1e-4 * expected, "{axis}: {found} {expected}");
        }
    }
}
