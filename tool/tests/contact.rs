//! The contact of a solve in tables and charts, end to end.

use std::fs;

use asperity_maps::io::{read_field, write_npy};

use crate::bench::{Bench, text};

/// The numbers of a table, column by column, and its header.
fn table(bench: &Bench, file: &str) -> (String, Vec<Vec<f64>>) {
    let text = bench.read(file);
    let (header, lines) = text.split_once('\n').unwrap();
    let rows: Vec<Vec<f64>> =
        lines.lines().map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let columns = header.split(',').count();
    (header.to_owned(), (0..columns).map(|k| rows.iter().map(|row| row[k]).collect()).collect())
}

#[test]
fn the_tables_are_those_of_the_contact() {
    let bench = Bench::new();
    bench.said("surface --size 64 --lengths 20um --k-l 2 --k-s 8 --rms-height 0.1um --quiet --out heights.npz");
    bench.said("solve --heights heights.npz --modulus 1GPa --mean-pressure 4MPa --no-pictures --quiet --out pressed");
    let said = bench.said("contact pressed --out contact");
    assert!(said.contains("clusters of contact") && said.contains("results in contact"), "{said}");
    let expected = "autocorrelation.csv autocorrelation.png clusters.csv clusters.png gap.csv gap.png pressure.csv \
                    pressure.png report.json scene.toml";
    assert_eq!(bench.names("contact").join(" "), expected);
    let (solve, report) = (bench.report("pressed"), bench.report("contact"));
    let number = |report: &serde_json::Value, key: &str| report[key].as_f64().unwrap();

    // densities over the nodes: of the contact all, of the gap all but what is below nine decades
    let (header, columns) = table(&bench, "contact/pressure.csv");
    assert_eq!(header, "from_pressure [Pa],to_pressure [Pa],pressure_density [1/Pa]");
    let shares = columns[0].iter().zip(&columns[1]).zip(&columns[2]).map(|((from, to), density)| (to - from) * density);
    let share: f64 = shares.sum();
    assert!((share - number(&solve, "repulsive_fraction")).abs() < 1e-12, "{share}");
    assert!((number(&solve, "mean_contact_pressure") / number(&report, "mean_contact_pressure") - 1.0).abs() < 1e-12);
    let (header, columns) = table(&bench, "contact/gap.csv");
    assert_eq!(header, "from_gap [m],to_gap [m],gap_density [1/m]");
    let shares = columns[0].iter().zip(&columns[1]).zip(&columns[2]).map(|((from, to), density)| (to - from) * density);
    assert!((shares.sum::<f64>() - 1.0 + number(&solve, "contact_fraction")).abs() < 1e-12);
    assert!(columns[0].windows(2).all(|two| two[0] < two[1]) && columns[0][1..] == columns[1][..columns[1].len() - 1]);

    // the pressure is like itself, and forgets itself far away
    let (header, columns) = table(&bench, "contact/autocorrelation.csv");
    assert_eq!(header, "distance [m],autocorrelation");
    assert_eq!((columns[0][0], columns[1][0]), (0.0, 1.0));
    assert!(columns[1].iter().all(|value| value.abs() <= 1.0) && columns[1].last().unwrap().abs() < 0.3);
    let half = number(&report, "correlation_length");
    assert!(half > 0.0 && half < 5e-6, "{half}");

    // clusters make up the contact, its edge and its load
    let (header, columns) = table(&bench, "contact/clusters.csv");
    assert_eq!(header, "nodes,area [m2],perimeter [m],normal_force [N]");
    let sum = |k: usize| columns[k].iter().sum::<f64>();
    assert_eq!(sum(0), number(&solve, "contact_nodes"));
    assert!((sum(1) / 4e-10 - number(&solve, "contact_fraction")).abs() < 1e-12);
    assert!((sum(2) / number(&solve, "perimeter") - 1.0).abs() < 1e-12);
    let force = number(&solve, "mean_contact_pressure") * 4e-10;
    assert!((sum(3) / force - 1.0).abs() < 1e-12);
    assert!(columns[0].windows(2).all(|two| two[0] >= two[1]));

    let again = bench.reported("run contact/scene.toml --out again --picture-format svg");
    assert_eq!(again["clusters"], report["clusters"]);
    bench.refused_with("contact pressed --out contact", &["exists: use --force"]);
    bench.refused_with("contact contact", &["contact", "another command"]);
    // however small a gap is
    let mut gap = read_field(bench.path("pressed/gap.npy")).unwrap();
    let open = gap.iter_mut().find(|gap| **gap > 0.0).unwrap();
    *open = 1e-320;
    write_npy(bench.path("pressed/gap.npy"), &gap).unwrap();
    bench.said("contact pressed --force --out again");
    assert_eq!(table(&bench, "again/gap.csv").1[0].len(), 72);
    // tables that somebody has changed have no page
    fs::write(bench.path("contact/gap.csv"), "from,to,density\n1\n").unwrap();
    bench.refused_with("report contact", &["gap.csv", "rows of other than 3 numbers"]);
    bench.refused_with("contact heights.npz", &["heights.npz", "no report.json"]);
}

#[test]
fn the_edge_of_a_free_map_is_that_of_its_report() {
    let bench = Bench::new();
    for (nx, ny) in [(24, 24), (24, 16)] {
        let row = |i: usize| (0..ny).map(|j| ((7 * i + 5 * j) % 11).to_string()).collect::<Vec<_>>().join(" ");
        bench.write("heights.txt", &(0..nx).map(row).collect::<Vec<_>>().join("\n"));
        let pressed = "--heights heights.txt --lengths 100 --boundary free --mean-pressure 0.05 --no-pictures --force --out pressed";
        assert!(bench.run(&format!("solve {pressed}")).status.success());
        bench.said("contact pressed --out contact --force");
        let [edge, same] =
            ["pressed", "contact"].map(|name| bench.report(name)).map(|report| report["perimeter"].as_f64().unwrap());
        assert!(edge > 0.0 && (same / edge - 1.0).abs() < 1e-12, "{nx} x {ny}: {edge} {same}");
    }
}

#[test]
fn the_clusters_of_a_profile_have_lengths() {
    let bench = Bench::new();
    let row = |i: usize| format!("{}e-9\n", 7 * i % 11);
    bench.write("profile.txt", &(0..64).map(row).collect::<String>());
    let loads = "--lengths 64um --modulus 1GPa --mean-pressure 1MPa --no-pictures --quiet";
    let solved = bench.run(&format!("solve --heights profile.txt {loads} --out pressed"));
    assert!(solved.status.success(), "{}", text(&solved.stderr));
    bench.said("contact pressed --picture-format svg --out contact");
    let chart = bench.read("contact/clusters.svg");
    assert!(chart.contains("length of a cluster (µm)") && !chart.contains("area"), "{chart}");
}

#[test]
fn the_densities_of_a_sphere_have_the_exponents_of_its_edge() {
    let bench = Bench::new();
    // a radius of contact of 300 nodes
    bench.said("surface --form paraboloid --radius 1 --size 1024 --lengths 1 --quiet --out sphere.npz");
    bench.said("solve --heights sphere.npz --boundary free --approach 0.086 --no-pictures --quiet --out pressed");
    let report = bench.reported("contact pressed");
    let exponent = |key: &str| report[key]["exponent"].as_f64().unwrap();
    // at the edge g ∝ x^(3/2); p = p₀ √(1 − r²/a²), with the density p over all of the contact
    assert!((exponent("gap_exponent") + 1.0 / 3.0).abs() < 0.05, "{report}");
    assert!((exponent("pressure_exponent") - 1.0).abs() < 0.05, "{report}");
    assert_eq!((report["clusters"].as_u64(), &report["correlation_length"]), (Some(1), &().into()));
    // fewer nodes do not tell
    bench.said("surface --form paraboloid --radius 1 --size 32 --lengths 1 --quiet --out coarse.npz");
    bench.said("solve --heights coarse.npz --boundary free --approach 0.086 --no-pictures --quiet --out few");
    assert!(bench.said("contact few").contains("not determined"));
}
