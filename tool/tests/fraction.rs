//! Loads by contact fraction, and by reduced pressure, end to end.

use serde_json::Value;

use crate::bench::{Bench, text};

fn rough() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 64 --k-l 2 --k-s 16 --rms-slope 0.1 --quiet --out heights.npy");
    bench
}

#[test]
fn a_solve_finds_the_load_of_a_contact_fraction() {
    let bench = rough();
    let said = bench.said("solve --heights heights.npy --contact-fraction 0.1 --no-pictures --out tenth");
    assert!(said.lines().any(|line| line.starts_with("wanted ") && line.contains(" 10.0 %, after ")), "{said}");
    let report = bench.report("tenth");
    let fraction = report["contact_fraction"].as_f64().unwrap();
    assert!((fraction / 0.1 - 1.0).abs() <= 0.01, "{fraction}");
    let search = &report["search"];
    assert_eq!((&search["wanted"], &search["reached"]), (&0.1.into(), &true.into()));
    assert!(search["operator_applications"].as_u64() >= report["operator_applications"].as_u64());
    // the load that it found is one that can be given
    let pressure = report["mean_pressure"].as_f64().unwrap();
    assert_eq!((&report["control"], report["control_value"].as_f64()), (&"mean-pressure".into(), Some(pressure)));
    let given =
        bench.reported(&format!("solve --heights heights.npy --mean-pressure {pressure:e} --no-pictures --out given"));
    assert_eq!((&given["contact_nodes"], &given["search"]), (&report["contact_nodes"], &Value::Null));
    // and the scene has the fraction
    assert!(bench.read("tenth/scene.toml").contains("contact-fraction = 0.1\n"));
    bench.said("run tenth/scene.toml --mean-gap 0.01 --quiet --out other");

    let sticky = "--law exponential --work-of-adhesion 1e-4 --range 4e-3 --no-pictures";
    let report = bench.reported(&format!("solve --heights heights.npy --contact-fraction 0.02 {sticky} --out sticky"));
    assert_eq!((&report["search"]["reached"], &report["control"]), (&true.into(), &"mean-gap".into()));
}

#[test]
fn a_sweep_over_contact_fractions_has_what_was_wanted_and_what_was_found() {
    let bench = rough();
    let law = "--law exponential --work-of-adhesion 5e-5 --range 4e-3";
    bench.said(&format!(
        "sweep --heights heights.npy {law} --contact-fractions 0.02:0.4:4:log --out whole.csv --plot whole.svg"
    ));
    // whatever the load is by which the fractions are found
    assert!(bench.read("whole.svg").contains("Contact fraction over mean pressure"));
    let [found, wanted] = ["contact_fraction", "wanted_contact_fraction"].map(|name| bench.column("whole.csv", name));
    let near = |(found, wanted): (&f64, &f64)| (found - wanted).abs() <= f64::max(0.01 * wanted, 1.0 / 4096.0);
    assert!(found.len() == 4 && wanted[3] == 0.4 && found.iter().zip(&wanted).all(near), "{found:?}");
    assert_eq!(bench.cells("whole.csv", "reached"), ["true"; 4]);
}

#[test]
fn a_contact_that_jumps_past_the_fraction_is_not_claimed() {
    let bench = Bench::new();
    // rows of nodes come into contact at once
    let command = "surface --form wave --amplitude 0.02 --shape 32 16 --lengths 1 0.5 --quiet --out wave.npy";
    bench.said(command);
    let output = bench.run("solve --heights wave.npy --lengths 1 0.5 --contact-fraction 0.25 --no-pictures --out out");
    let error = text(&output.stderr);
    assert_eq!((output.status.code(), error.lines().count()), (Some(2), 1), "{error}");
    assert!(error.contains("25.0 % contact") && error.contains("21.9 % to 28.1 %"), "{error}");
    let report = bench.report("out");
    assert_eq!((&report["search"]["reached"], &report["status"]), (&false.into(), &"converged".into()));
    assert_eq!((&report["search"]["below"], &report["search"]["above"]), (&0.21875.into(), &0.28125.into()));
    let output = bench.run("sweep --heights wave.npy --lengths 1 0.5 --contact-fractions 0.21875,0.25 --out out.csv");
    let error = text(&output.stderr);
    assert!(output.status.code() == Some(2) && error.contains("row 2: ") && error.contains("1 of 2 rows"), "{error}");
    assert_eq!(bench.cells("out.csv", "reached"), ["true", "false"]);
}

#[test]
fn reduced_pressures_are_over_the_modulus_and_the_slope() {
    let bench = rough();
    let slope = bench.reported("stats heights.npy --lengths 1")["rms_slope"].as_f64().unwrap();
    let report =
        bench.reported("solve --heights heights.npy --modulus 3 --reduced-pressure 0.05 --no-pictures --out reduced");
    assert!((report["mean_pressure"].as_f64().unwrap() / (0.05 * 3.0 * slope) - 1.0).abs() < 1e-12);
    // next to units, as it has none
    bench.said(
        "sweep --heights heights.npy --lengths 1m --modulus 3GPa --reduced-pressures 0.01,0.05 --quiet --out si.csv",
    );
    let pressures = bench.column("si.csv", "mean_pressure");
    // the load for a contact fraction has the unit of its kind
    for (law, unit) in [("", "Pa"), ("--law exponential --work-of-adhesion 0.1MJ/m2 --range 4mm", "m")] {
        bench.said(&format!(
            "sweep --heights heights.npy --lengths 1m --modulus 3GPa {law} --contact-fractions 0.1 --quiet --out {unit}.csv"
        ));
        assert!(bench.read(&format!("{unit}.csv")).contains(&format!("control,control_value [{unit}],")));
    }
    assert!((pressures[1] / (0.05e9 * 3.0 * slope) - 1.0).abs() < 1e-9, "{pressures:?} {slope}");
    bench.refused_with(
        "solve --heights heights.npy --contact-fraction 0.1 --mean-pressure 1 --out no",
        &["cannot be used with"],
    );
    assert!(!bench.path("no").exists());
}
