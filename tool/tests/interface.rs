//! The law of an interface, end to end.

use serde_json::Value;

use crate::bench::{Bench, text};

const ROUGH: &str = "surface --size 64 --lengths 20um --k-l 2 --k-s 8 --rms-height 0.1um --quiet --out heights.npz";
const PRESSED: &str = "interface --heights heights.npz --modulus 1GPa";

/// The rows of a table of numbers, without its header.
fn numbers(text: &str, between: char, comment: char) -> Vec<Vec<f64>> {
    let lines = text.lines().filter(|line| !line.starts_with(comment));
    lines.map(|line| line.split(between).map(|cell| cell.trim().parse().unwrap()).collect()).collect()
}

/// The rows of the table by the names of its columns without their units.
fn rows(bench: &Bench, file: &str) -> Vec<Value> {
    let text = bench.read(file);
    let mut lines = text.lines();
    let names: Vec<_> = lines.next().unwrap().split(',').map(|name| name.split(' ').next().unwrap()).collect();
    lines.map(|line| asperity_scene::csv::parsed(&names, line)).collect()
}

fn column(rows: &[Value], name: &str) -> Vec<f64> {
    rows.iter().map(|row| row[name].as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn the_slope_of_the_pressure_is_the_stiffness_to_its_error() {
    let bench = Bench::new();
    bench.said(ROUGH);
    // two loads so near each other that the stiffness is the same but for what its error says
    bench.said(&format!("{PRESSED} --mean-pressures 2MPa,2.02MPa,8MPa,8.08MPa --tolerance 1e-9 --quiet --out law.csv"));
    let rows = rows(&bench, "law.csv");
    let [pressure, closure, gap, stiffness, error] =
        ["mean_pressure", "closure", "mean_gap", "contact_stiffness", "stiffness_error"]
            .map(|name| column(&rows, name));
    for k in [0, 2] {
        let slope = (pressure[k + 1] - pressure[k]) / (closure[k + 1] - closure[k]);
        let (mean, allowed) = (0.5 * (stiffness[k] + stiffness[k + 1]), error[k].max(error[k + 1]));
        assert!(allowed < 0.05 && (slope / mean - 1.0).abs() < allowed, "{slope} {mean} {allowed}");
        // the closure is the fall of the mean gap from first touch
        assert!((closure[k + 1] - closure[k] + gap[k + 1] - gap[k]).abs() < 1e-9 * gap[k]);
    }
    let stats = bench.reported("stats heights.npz");
    let touch = stats["highest"].as_f64().unwrap() - stats["mean_height"].as_f64().unwrap();
    assert!((gap[0] + closure[0] - touch).abs() < 1e-9 * touch);
    assert!(rows.iter().all(|row| row["status"] == "converged" && row["branch"].is_null()));
}

/// Absent nodes are left out of the mean gap, and the displacement has a mean over the others.
#[test]
fn the_closure_counts_from_first_touch_with_absent_nodes_too() {
    let bench = Bench::new();
    let height = |i: usize, j: usize| match i.abs_diff(16).pow(2) + j.abs_diff(16).pow(2) < 40 {
        true => "nan".to_owned(),
        false => (0.01 * (0.6 * i as f64).sin() * (0.4 * (j * j) as f64).cos()).to_string(),
    };
    let lines = (0..32).map(|i| (0..32).map(|j| height(i, j)).collect::<Vec<_>>().join(" ") + "\n");
    bench.write("rough.txt", &lines.collect::<String>());
    let loads = "--mean-pressures 1e-9,0.0099,0.01,0.0101 --tolerance 1e-7";
    bench.said(&format!("interface --heights rough.txt --lengths 1 --absent-missing {loads} --quiet --out h.csv"));
    let [closure, pressure, stiffness] =
        ["closure", "mean_pressure", "contact_stiffness"].map(|name| bench.column("h.csv", name));
    assert!(closure[0].abs() < 1e-6, "{closure:?}");
    let slope = (pressure[3] - pressure[1]) / (closure[3] - closure[1]);
    assert!((slope / stiffness[2] - 1.0).abs() < 0.02, "{slope} {stiffness:?}");
}

#[test]
fn each_code_gets_the_table_as_it_reads_it() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let loads = "--mean-pressures 0.5MPa,2MPa,8MPa --conductivities 400W/mK 15W/mK --leakage 1e-4";
    let said = bench.said(&format!("{PRESSED} {loads} --for abaqus,comsol,moose --out 2.law.csv"));
    assert!(said.contains("3 rows in 2.law.csv") && said.contains("2.law.transmissivity.csv"), "{said}");
    let [pressure, closure, conductance, upper] =
        ["mean_pressure", "closure", "thermal_conductance", "transmissivity_y_upper"]
            .map(|name| bench.column("2.law.csv", name));
    // from no pressure on, to as many digits as there are
    let from_zero = |values: &[f64]| [&[0.0], values].concat();
    let same = |found: Vec<f64>, expected: &[f64]| {
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(a, b)| assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} {b}"));
    };
    let at = |table: &[Vec<f64>], column: usize| table.iter().map(|row| row[column]).collect::<Vec<_>>();
    for (ending, between, comment) in [("txt", ' ', '%'), ("csv", ',', '#')] {
        let read = |name: &str| numbers(&bench.read(&format!("2.law.{name}.{ending}")), between, comment);
        let [law, conducts, leaks] = ["pressure", "conductance", "transmissivity"].map(read);
        same(at(&law, 0), &from_zero(&closure));
        same(at(&law, 1), &from_zero(&pressure));
        same(at(&conducts, 0), &from_zero(&pressure));
        same(at(&conducts, 1), &from_zero(&conductance));
        same(at(&leaks, 0), &pressure);
        same(at(&leaks, 4), &upper);
        let header = bench.read(&format!("2.law.pressure.{ending}"));
        assert!(header.starts_with(&format!("{comment} closure [m], mean_pressure [Pa]\n")), "{header}");
    }
    // keywords, then lines of at most 20 characters a number
    let text = bench.read("2.law.inp");
    let keywords: Vec<_> = text.lines().filter(|line| line.starts_with('*') && !line.starts_with("**")).collect();
    assert_eq!(
        keywords,
        [
            "*SURFACE INTERACTION, NAME=I_2_law",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
            "*GAP CONDUCTANCE, PRESSURE"
        ]
    );
    assert!(text.lines().filter(|line| !line.starts_with('*')).all(|line| line.split(", ").all(|n| n.len() <= 20)));
    let after = |keyword: &str| {
        let lines = text.lines().skip_while(|line| !line.starts_with(keyword)).skip(1);
        let lines: Vec<_> = lines.take_while(|line| line.starts_with("**") || !line.starts_with('*')).collect();
        numbers(&lines.join("\n"), ',', '*')
    };
    let law = after("*SURFACE BEHAVIOR");
    same(at(&law, 0), &from_zero(&pressure));
    same(at(&law, 1), &from_zero(&closure));
    let conducts = after("*GAP CONDUCTANCE");
    same(at(&conducts, 0), &from_zero(&conductance));
    same(at(&conducts, 1), &from_zero(&pressure));

    // it continues, and its scene repeats it
    let more = format!("{PRESSED} {} --for abaqus,comsol,moose --out 2.law.csv", loads.replace("8MPa", "8MPa,16MPa"));
    assert!(bench.said(&more).starts_with("2.law.csv has 3 of 4 rows already"));
    bench.said("run 2.law.csv.scene.toml --quiet --out again.csv");
    assert_eq!(bench.read("again.csv"), bench.read("2.law.csv"));
    assert_eq!(bench.read("again.pressure.csv"), bench.read("2.law.pressure.csv"));
}

#[test]
fn files_for_codes_are_never_those_of_a_former_table() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let all = "--for abaqus,comsol,moose --quiet";
    let files = || {
        bench
            .names(".")
            .into_iter()
            .filter(|name| !name.ends_with(".scene.toml") && !name.ends_with(".state") && !name.contains("warnings"))
            .collect::<Vec<_>>()
            .join(" ")
    };
    bench.said(&format!("{PRESSED} --mean-pressures 1MPa,2MPa {all} --out law.csv"));
    // a further code on the same rows is no other table, and a model of one's own none of its files
    bench.said(&format!("{PRESSED} --mean-pressures 1MPa,2MPa --for comsol --quiet --out law.csv"));
    assert_eq!(files(), "heights.npz law.csv law.inp law.pressure.csv law.pressure.txt");
    bench.write("law.conductance.txt", "mine");
    bench.said(&format!("{PRESSED} --mean-pressures 1MPa,3MPa --for abaqus --quiet --force --out law.csv"));
    assert_eq!(files(), "heights.npz law.conductance.txt law.csv law.inp");
    let failed = bench.run(&format!("{PRESSED} --mean-pressures 1MPa --max-iterations 3 {all} --force --out law.csv"));
    assert_eq!(failed.status.code(), Some(2));
    assert_eq!(files(), "heights.npz law.conductance.txt law.csv");
}

#[test]
fn with_adhesion_the_law_begins_between_the_rows_around_no_pressure() {
    let bench = Bench::new();
    bench.said(ROUGH);
    let sticky = format!("{PRESSED} --law exponential --work-of-adhesion 20mJ/m2 --range 20nm --branch unloading");
    bench.said(&format!("{sticky} --mean-pressures 8MPa,2MPa,-1kPa --for moose --quiet --out law.csv"));
    let [pressure, closure] = ["mean_pressure", "closure"].map(|name| bench.column("law.csv", name));
    let law = numbers(&bench.read("law.pressure.csv"), ',', '#');
    let share = -pressure[2] / (pressure[1] - pressure[2]);
    let origin = closure[2] + share * (closure[1] - closure[2]);
    assert!(law.len() == 3 && law[0][1] == 0.0 && (law[0][0] / origin - 1.0).abs() < 1e-8, "{law:?}");
    assert!(law[2][1] > law[1][1] && law[2][0] > law[1][0]);
    assert_eq!(bench.cells("law.csv", "branch"), ["unloading"; 3]);
    bench.refused_with(
        &format!("{sticky} --mean-pressures 2MPa --for moose --quiet --out positive.csv"),
        &["no row says where: add 0 to --mean-pressures"],
    );
}

#[test]
fn what_is_no_law_of_an_interface_is_refused_by_name() {
    let bench = Bench::new();
    bench.said(ROUGH);
    bench.write("taken.inp", "*HEADING\n");
    for (arguments, parts) in [
        ("--mean-pressures 1MPa --out law.jsonl", &["law.jsonl", ".csv"][..]),
        ("--mean-pressures 1MPa --boundary free --out law.csv", &["--boundary free", "periodic cell"]),
        ("--mean-pressures 1MPa --hardness 1GPa --out law.csv", &["--hardness", "elastic contact alone"]),
        ("--mean-pressures 1MPa --for ansys --out law.csv", &["ansys", "abaqus"]),
        ("--mean-pressures 1MPa --for abaqus --out taken.csv", &["taken.inp", "--force"]),
        ("--mean-pressures 1MPa --resistivities 1nOhm·m 1nm --out law.csv", &["1nm", "a unit of something else"]),
        ("--mean-pressures 1MPa --resistivities 1nOhm·m --out law.csv", &["--resistivities", "2 values"]),
        (
            "--mean-pressures 1MPa --conductivities 1W/mK 2W/mK --layer 1um --poisson 0.3 --out law.csv",
            &["--conductivities", "half-spaces", "--layer"],
        ),
        (
            "--mean-pressures 1MPa,2MPa,1MPa --for moose --quiet --out law.csv",
            &["no function of the closure", "loads that grow"],
        ),
    ] {
        bench.refused_with(&format!("{PRESSED} {arguments}"), parts);
    }
    let output = bench.run(&format!("{PRESSED} --mean-pressures 1MPa,2GPa,3GPa --for moose --quiet --out full.csv"));
    let said = text(&output.stderr);
    assert!(said.contains("error: the contact is full at 2e9, and from there on the closure grows no more"), "{said}");
    let output =
        bench.run(&format!("{PRESSED} --mean-pressures 2MPa --max-iterations 3 --for abaqus --quiet --out few.csv"));
    assert_eq!(output.status.code(), Some(2));
    assert!(!bench.path("few.inp").exists() && bench.path("few.csv").exists());
}
