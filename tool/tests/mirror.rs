//! Mirrored maps: results are of the original, unless the whole is asked for.

use asperity_maps::io::{read_field, read_topography};
use ndarray::{Array2, Axis, Slice};
use serde_json::Value;

use crate::bench::Bench;

/// A part of a rough surface, which is not periodic, and its mirror images.
fn mirrored() -> Bench {
    let bench = Bench::new();
    bench.said("surface --size 48 --k-l 2 --k-s 10 --rms-slope 0.1 --seed 5 --quiet --out rough.npz");
    bench.said("prepare rough.npz --crop 4 2 32 24 --mirror --quiet --out map.npz");
    bench
}

/// The original of a field on all nodes.
fn original(field: &Array2<f64>) -> Array2<f64> {
    field.slice_axis(Axis(0), Slice::from(..32)).slice_axis(Axis(1), Slice::from(..24)).to_owned()
}

#[test]
fn results_are_of_the_original_unless_the_whole_is_asked_for() {
    let bench = mirrored();
    let map = read_topography(bench.path("map.npz")).unwrap();
    assert_eq!((map.heights.dim(), map.original, map.seed), ((64, 48), Some((32, 24)), Some(5)));
    let solve = "solve --heights map.npz --mean-pressure 0.01 --stiffness --no-pictures";
    let said = bench.said(&format!("{solve} --out part"));
    assert!(said.contains("part of the mirrored map  original, 32 x 24 of 64 x 48 nodes"), "{said}");
    assert!(bench.said(&format!("{solve} --whole --out whole")).contains("whole, 64 x 48 nodes"));
    let gaps = ["part", "whole"].map(|folder| read_field(bench.path(&format!("{folder}/gap.npy"))).unwrap());
    assert_eq!(gaps[0], original(&gaps[1]));
    let [part, whole] = ["part", "whole"].map(|folder| bench.report(folder));
    assert_eq!((part["part"].as_str(), whole["part"].as_str()), (Some("original"), Some("whole")));
    assert_eq!((&part["shape"], &part["solved_shape"]), (&serde_json::json!([32, 24]), &serde_json::json!([64, 48])));
    for key in ["contact_fraction", "mean_gap", "mean_pressure", "elastic_energy", "contact_stiffness"] {
        assert_eq!(part[key], whole[key], "{key}");
    }
    for key in ["contact_nodes", "normal_force", "perimeter", "normal_stiffness"] {
        let [part, whole] = [&part, &whole].map(|report| report[key].as_f64().unwrap());
        assert!(whole > 0.0 && (4.0 * part / whole - 1.0).abs() < 1e-12, "{key}: {part} of {whole}");
    }

    // mirror planes are no edges of the contact
    bench.write(
        "corner.txt",
        &(0..16)
            .map(|i| {
                let height = |j: i32| -0.01 * f64::from((2 * i + 1_i32).pow(2) + (2 * j + 1).pow(2)) / 1024.0;
                (0..16).map(|j| height(j).to_string()).collect::<Vec<_>>().join(" ") + "\n"
            })
            .collect::<String>(),
    );
    bench.said("prepare corner.txt --lengths 1 --mirror --quiet --out corner.npz");
    bench.said("solve --heights corner.npz --mean-pressure 0.002 --no-pictures --quiet --out corner");
    for (folder, edge) in [("corner", 1.375), ("part", number(&part, "perimeter"))] {
        bench.said(&format!("contact {folder} --out contact --force"));
        assert!((number(&bench.report("contact"), "perimeter") / edge - 1.0).abs() < 1e-12, "{folder}");
    }

    // the gap of either is a start
    for (start, folder) in [("part", "from-part"), ("whole", "from-whole")] {
        bench.said(&format!("{solve} --initial-gap {start}/gap.npy --quiet --out {folder}"));
    }
    assert!(bench.bytes("from-part/gap.npy") == bench.bytes("from-whole/gap.npy"));
    assert!(bench.report("from-part")["iterations"].as_u64() < part["iterations"].as_u64());

    // a force is that on the original, as the normal force of the report
    let loaded =
        |load: &str| bench.reported(&format!("solve --heights map.npz {load} --no-pictures --force --out loaded"));
    let force = part["normal_force"].as_f64().unwrap();
    let again = loaded(&format!("--normal-force {force}"));
    assert_eq!(again["control_value"], force);
    let near =
        |report: &Value, key: &str| assert!((number(report, key) / number(&part, key) - 1.0).abs() < 1e-6, "{key}");
    for key in ["normal_force", "mean_pressure", "contact_nodes", "mean_gap"] {
        near(&again, key);
    }
    near(&loaded(&format!("--normal-force {} --whole", 4.0 * force)), "mean_pressure");
    // and so is the force of a spring
    let (stiffness, gap) = (0.3, number(&part, "mean_gap"));
    let sprung = loaded(&format!("--spring-stiffness {stiffness} --spring-position {}", gap - force / stiffness));
    assert_eq!(sprung["spring_stiffness"], stiffness);
    near(&sprung, "normal_force");
}

fn number(report: &Value, key: &str) -> f64 {
    report[key].as_f64().unwrap()
}

#[test]
fn tables_say_of_which_part_and_seed_their_rows_are() {
    let bench = mirrored();
    let row = |arguments: &str| {
        bench.said(&format!("{arguments} --quiet"));
        let table = bench.read("table.csv");
        let (header, row) = (table.lines().next().unwrap(), table.lines().last().unwrap());
        let cells = header.split(',').zip(row.split(','));
        cells.map(|(name, cell)| (name.to_owned(), cell.to_owned())).collect::<std::collections::HashMap<_, _>>()
    };
    let sweep = "sweep --heights map.npz --mean-pressures 0.005,0.01 --fields fields --force --out table.csv";
    let (part, whole) = (row(sweep), row(&format!("{sweep} --whole")));
    assert_eq!((&part["part"][..], &part["seed"][..], &whole["part"][..]), ("original", "5", "whole"));
    assert_eq!(part["contact_fraction"], whole["contact_fraction"]);
    for name in ["normal_force", "perimeter"] {
        let [part, whole] = [&part, &whole].map(|row| row[name].parse::<f64>().unwrap());
        assert!(whole > 0.0 && (4.0 * part / whole - 1.0).abs() < 1e-12, "{name}: {part} of {whole}");
    }
    // a table continues only with rows of the same part
    bench.refused_with(
        "sweep --heights map.npz --mean-pressures 0.005,0.01,0.02 --fields fields --out table.csv",
        &["part"],
    );
    let fractions = row("sweep --heights map.npz --contact-fractions 0.1 --force --out table.csv");
    assert_eq!(fractions["part"], "original");
    let forces = row("sweep --heights map.npz --normal-forces 0.002,0.004 --force --out table.csv");
    assert!((forces["normal_force"].parse::<f64>().unwrap() / 0.004 - 1.0).abs() < 1e-6);
    assert_eq!(forces["control_value"], "0.004");
    let forces = row("cycle --heights map.npz --normal-forces 0.002,0.004 --steps 4 --force --out table.csv");
    assert!((forces["normal_force"].parse::<f64>().unwrap() / 0.004 - 1.0).abs() < 1e-6);
    let cycle = "cycle --heights map.npz --mean-pressures 0.01,0.02 --steps 4 --fields kept --force --out table.csv";
    assert_eq!(row(cycle)["part"], "original");
    let last = bench.names("kept").into_iter().rfind(|name| name.starts_with("gap-")).unwrap();
    assert_eq!(read_field(bench.path(&format!("kept/{last}"))).unwrap().dim(), (32, 24));
    // neither is known of a map that was not mirrored, and of one that is no surface of ours
    bench.said("prepare rough.npz --quiet --out plain.npy");
    let plain = row("sweep --heights plain.npy --mean-gaps 0.02 --force --out table.csv");
    assert_eq!((&plain["part"][..], &plain["seed"][..]), ("", ""));
}
