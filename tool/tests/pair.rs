//! Two surfaces that face each other, end to end.

use asperity_maps::io::read_field;
use ndarray::Array2;
use serde_json::json;

use crate::bench::Bench;

/// Two rough surfaces, and the one between them as numpy would add it: `heights + other[::-1]`.
fn pair() -> Bench {
    let bench = Bench::new();
    for (seed, name) in [(1, "heights"), (2, "other")] {
        let rough = "surface --size 32 --k-l 2 --k-s 10 --rms-slope 0.1 --quiet";
        bench.said(&format!("{rough} --seed {seed} --out {name}.npy"));
    }
    let [one, other] = ["heights.npy", "other.npy"].map(|name| read_field(bench.path(name)).unwrap());
    matrix(&bench, "sum.txt", &Array2::from_shape_fn((32, 32), |(i, j)| one[[i, j]] + other[[31 - i, j]]));
    bench
}

fn matrix(bench: &Bench, name: &str, heights: &Array2<f64>) {
    let row = |row: ndarray::ArrayView1<'_, f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    bench.write(name, &heights.rows().into_iter().map(row).collect::<Vec<_>>().join("\n"));
}

fn field(bench: &Bench, name: &str) -> Array2<f64> {
    read_field(bench.path(name)).unwrap()
}

#[track_caller]
fn close(a: &Array2<f64>, b: &Array2<f64>, tolerance: f64) {
    let most = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(most <= tolerance, "{most:e}");
}

const PRESSED: &str = "--mean-pressure 0.02 --no-pictures";

#[test]
fn two_surfaces_are_the_one_between_them() {
    let bench = pair();
    bench.said(&format!("solve --heights heights.npy --against other.npy {PRESSED} --quiet --out both"));
    bench.said(&format!("solve --heights sum.txt {PRESSED} --quiet --out sum"));
    assert_eq!(bench.bytes("both/gap.npy"), bench.bytes("sum/gap.npy"));
    let report = bench.report("both");
    assert_eq!((&report["against"], &report["shift"]), (&json!("other.npy"), &json!([0.0, 0.0])));
    assert!(report["against_modulus"].is_null() && bench.report("sum")["shift"].is_null());

    // of two elastic half-spaces, 1/E* = 1/3 + 1/6, with either boundary, and the pressure over E* h'rms
    for more in ["", "--boundary free", "--reduced-pressure 0.1"] {
        let loaded = if more.starts_with("--r") { "--no-pictures" } else { PRESSED };
        let solve = |heights: &str, out: &str| {
            // a pressure on a window reaches its edge, as a warning tells
            assert!(bench.run(&format!("solve {heights} {loaded} {more} --out {out} --force")).status.success());
            bench.report(out)
        };
        let both = solve("--heights heights.npy --against other.npy --modulus 3 --against-modulus 6", "both");
        let one = solve("--heights sum.txt --modulus 2", "sum");
        assert_eq!(bench.bytes("both/gap.npy"), bench.bytes("sum/gap.npy"), "{more}");
        assert_eq!(["modulus", "against_modulus"].map(|key| both[key].as_f64()), [Some(3.0), Some(6.0)]);
        for key in ["mean_pressure", "mu_rho", "corrected_contact_fraction", "elastic_energy"] {
            assert_eq!(both[key], one[key], "{key} {more}");
        }
    }
    let said = bench.said(&format!("solve --heights heights.npy {PRESSED} --against-modulus 6 --out flat"));
    assert!(said.contains("against a half-space of contact modulus 6"), "{said}");
    // a scene repeats it from another folder
    bench.said("run both/scene.toml --quiet --out again");
    assert_eq!(bench.bytes("again/gap.npy"), bench.bytes("both/gap.npy"));
}

#[test]
fn a_surface_slides_over_another_in_a_study() {
    let bench = pair();
    let study = "command = \"sweep\"\nout = \"sliding.csv\"\n[surface]\nheights = \"heights.npy\"\n\
                 against = \"other.npy\"\n[loads]\nmean-pressures = 0.02\n[vary]\nshift = \"0:1:5\"\n";
    bench.write("sliding.toml", study);
    bench.said("study sliding.toml --quiet");
    assert_eq!(bench.column("sliding.csv", "shift"), [0.0, 0.25, 0.5, 0.75, 1.0]);
    // around the cell
    let contact = bench.column("sliding.csv", "contact_fraction");
    assert!(contact[0] == contact[4] && contact[0] != contact[1], "{contact:?}");

    // another shift is another table
    let sweep = "sweep --heights heights.npy --against other.npy --mean-pressures 0.02 --quiet --out table.csv";
    bench.said(&format!("{sweep} --shift 0.25"));
    let another = ["table.csv", "another of its two surfaces, or another shift"];
    bench.refused_with(&format!("{sweep} --shift 0.26"), &another);
    bench.refused_with(&format!("{sweep} --shift 0.25").replace("other.npy", "heights.npy"), &another);
    bench.refused_with(&format!("{sweep} --shift 0.25 --against-modulus 2"), &["table.csv", "against modulus"]);
    let law = "--law exponential --work-of-adhesion 1e-4 --range 4e-3 --mean-gaps 0.04,0.03 --steps 3 --quiet";
    bench.said(&format!("cycle --heights heights.npy --against other.npy --shift=-0.1 {law} --out cycle.csv"));
}

#[test]
fn each_body_has_its_displacement() {
    let bench = pair();
    let solve = |more: &str, out: &str| {
        let both = "solve --heights heights.npy --against other.npy --fields displacement --quiet";
        assert!(bench.run(&format!("{both} {more} --out {out}")).status.success());
        ["gap", "displacement"].map(|name| field(&bench, &format!("{out}/{name}.npy")))
    };
    let sum = field(&bench, "sum.txt");
    // a rigid one has none
    let [gap, displacement] = solve(PRESSED, "rigid");
    assert_eq!(displacement, &gap + &sum);
    assert!(!bench.names("rigid").contains(&"against_displacement.npy".to_owned()));

    let of_other = |out: &str| field(&bench, &format!("{out}/against_displacement.npy"));
    let elastic = format!("{PRESSED} --modulus 3 --against-modulus 6");
    // beyond a free window the pressure vanishes to the tolerance of the solve
    for (out, more, tolerance) in [("elastic", "", 1e-12), ("free", "--boundary free", 1e-7)] {
        let [gap, own] = solve(&format!("{elastic} {more}"), out);
        let other = of_other(out);
        close(&own, &(2.0 * &other), 1e-15);
        let both = &own + &other;
        let rest = &both - &(&gap + &sum);
        close(&rest, &Array2::from_elem(rest.dim(), rest.mean().unwrap()), tolerance);
        let mean = other.mean().unwrap();
        assert!(if out == "free" { mean > 1e-3 } else { mean.abs() < 1e-15 }, "{out}: {mean}");
    }
    // all in one file
    bench.said(&format!("solve --heights heights.npy {elastic} --fields displacement --format npz --quiet --out npz"));
    assert!(!bench.names("npz").contains(&"displacement.npy".to_owned()));
}

#[test]
fn units_sides_and_missing_points_of_both_are_looked_at() {
    let bench = pair();
    for (name, unit, side) in [("heights", "um", 20), ("other", "nm", 20_000)] {
        bench.said(&format!(
            "prepare {name}.npy --lengths {side} --scale {side} --unit {unit} --quiet --out {name}.npz"
        ));
    }
    // micrometres and nanometres, in the unit of the first one or in metres
    let both = "solve --heights heights.npz --against other.npz --no-pictures";
    bench.said(&format!("{both} --mean-pressure 0.02 --quiet --out own"));
    bench.said(&format!("{both} --modulus 1GPa --mean-pressure 20MPa --shift 0um --quiet --out metres"));
    bench.said(&format!("solve --heights heights.npy --against other.npy {PRESSED} --quiet --out plain"));
    let gaps = ["own", "metres", "plain"].map(|out| field(&bench, &format!("{out}/gap.npy")));
    close(&(&gaps[0] / 20.0), &gaps[2], 1e-7);
    close(&(&gaps[1] / 20e-6), &gaps[2], 1e-7);

    // negative lengths with units, also from a scene, where they lead around the cell
    let shifted = format!("{both} --modulus 1GPa --mean-pressure 20MPa --quiet");
    bench.said(&format!("{shifted} --shift=-5um,0um --out back"));
    bench.said(&format!("{shifted} --shift 15um 0um --out on"));
    bench.said("run back/scene.toml --quiet --out again");
    assert!(["on", "again"].iter().all(|out| bench.bytes(&format!("{out}/gap.npy")) == bench.bytes("back/gap.npy")));
    assert_eq!(bench.report("again")["given"]["shift"], json!(["-5um", "0um"]));

    bench.said("prepare other.npy --lengths 1 --resample 24 24 --quiet --out coarse.npy");
    bench.said("prepare other.npy --lengths 1 --mirror --quiet --out mirrored.npz");
    bench.said("prepare heights.npy --lengths 1 --mirror --quiet --out mirror.npz");
    matrix(&bench, "hole.txt", &{
        let mut heights = field(&bench, "other.npy");
        heights[[3, 4]] = f64::NAN;
        heights
    });
    for (arguments, parts) in [
        ("--heights heights.npy --lengths 2 --against coarse.npy", &["24 x 24", "2 x 2"][..]),
        ("--heights heights.npy --against none.npy", &["none.npy"]),
    ] {
        bench.refused_with(&format!("solve {arguments} {PRESSED} --out none"), parts);
    }
    let report = bench.reported(&format!(
        "solve --heights heights.npy --against hole.txt --absent-missing --shift 0.25 {PRESSED} --out absent"
    ));
    assert_eq!(report["absent_nodes"], 1);
    // the originals of mirrored maps face each other as maps without images do
    bench.said("prepare sum.txt --lengths 1 --mirror --quiet --out sum.npz");
    bench.said(&format!("solve --heights mirror.npz --against mirrored.npz {PRESSED} --quiet --out originals"));
    bench.said(&format!("solve --heights sum.npz {PRESSED} --quiet --out original"));
    assert_eq!(bench.bytes("originals/gap.npy"), bench.bytes("original/gap.npy"));
}
