//! `asperity sweep`, end to end.

mod cycle;

use std::fs;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::Duration;

use asperity::{Grid, Surface};
use asperity_maps::io::{read_field, write_npy};
use ndarray::Array2;
use serde_json::Value;

use crate::bench::{Bench, text};

/// A folder with a wavy surface.
fn bench(n: usize) -> Bench {
    Bench::with(&wavy(n))
}

/// Expects a refusal on one line with these parts in it.
#[track_caller]
fn refuse(bench: &Bench, arguments: &str, parts: &[&str]) {
    bench.refused_with(&format!("sweep --heights heights.npy {arguments}"), parts);
}

/// How many complete rows a table has.
fn count_rows(bench: &Bench, name: &str) -> usize {
    let table = fs::read_to_string(bench.path(name)).unwrap_or_default();
    table.matches('\n').count().saturating_sub(usize::from(!table.is_empty()))
}

fn wavy(n: usize) -> Array2<f64> {
    let wave = |m: f64, x: f64| (std::f64::consts::TAU * m * x).sin();
    let height =
        |x: f64, y: f64| 0.01 * wave(3.0, x) * wave(4.0, x + y) + 0.01 * (wave(1.0, y) + 0.7 * wave(2.0, x - y));
    Surface::from_fn(Grid::square(n, 1.0).unwrap(), height).unwrap().heights().clone()
}

#[test]
fn a_sweep_writes_a_row_for_each_load() {
    let bench = bench(64);
    let output = bench.ends("sweep", "--mean-pressures 1e-3:4e-3:3:log,0.01 --out new/sweep.csv", 0);
    assert_eq!(text(&output.stdout).lines().count(), 5);
    assert_eq!(output.stderr.len(), 0);
    let table = bench.read("new/sweep.csv");
    assert_eq!(
        table.lines().next().unwrap(),
        "control,control_value,mean_pressure,mean_contact_pressure,mean_gap,normal_force,approach,edge_traction,\
         contact_fraction,corrected_contact_fraction,perimeter,clusters,largest_cluster,repulsive_fraction,attractive_fraction,\
         elastic_energy,adhesive_energy,min_gap,relative_error,load_error,iterations,operator_applications,status,modulus,law,\
         work_of_adhesion,range,heights,part,seed"
    );
    assert_eq!(bench.names("new"), ["sweep.csv", "sweep.csv.scene.toml", "sweep.csv.state"]);
    assert_eq!(bench.column("new/sweep.csv", "control_value"), [1e-3, 2e-3, 4e-3, 0.01]);
    assert_eq!(bench.column("new/sweep.csv", "mean_pressure"), [1e-3, 2e-3, 4e-3, 0.01]);
    let [nodes, corrected] =
        ["contact_fraction", "corrected_contact_fraction"].map(|name| bench.column("new/sweep.csv", name));
    assert!(nodes.is_sorted() && nodes.iter().zip(&corrected).all(|(nodes, corrected)| corrected < nodes));
    assert!(bench.column("new/sweep.csv", "relative_error").iter().all(|error| *error <= 1e-6));
    assert!(
        table
            .lines()
            .skip(1)
            .all(|row| row.starts_with("mean-pressure,") && row.ends_with(",converged,1.0,none,,,heights.npy,,"))
    );

    // JSON lines say the same
    bench.ends("sweep", "--mean-pressures 1e-3,2e-3,4e-3,1e-2 --quiet --threads 1 --out sweep.jsonl", 0);
    for (object, row) in bench.read("sweep.jsonl").lines().zip(table.lines().skip(1)) {
        assert!(serde_json::from_str::<Value>(object).unwrap().is_object());
        // as text, which reading would round
        let cells =
            object.trim_matches(['{', '}']).split(',').map(|pair| pair.split_once(':').unwrap().1.trim_matches('"'));
        let cells = cells.map(|cell| if cell == "null" { "" } else { cell });
        assert_eq!(cells.collect::<Vec<_>>().join(","), row);
    }
}

/// Waits until a table has so many rows, and kills what writes it.
fn kill_at(child: &mut Child, bench: &Bench, name: &str, rows: usize) {
    while count_rows(bench, name) < rows && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Where tables go on from is tested in `asperity-scene`; here the process ends at whatever moment.
#[test]
fn a_table_whose_run_is_killed_goes_on_where_it_was() {
    let bench = bench(96);
    let law = "--law exponential --work-of-adhesion 1e-5 --range 2e-3";
    for (command, options) in [
        ("sweep", format!("{law} --mean-gaps 0.03:0.02:12,0.02:0.03:12")),
        ("sweep", "--contact-fractions 0.01:0.2:8 --precision f32 --tolerance 1e-4".to_owned()),
        ("cycle", format!("{law} --mean-gaps 0.03,0.02,0.03 --steps 10")),
    ] {
        bench.ends(command, &format!("{options} --quiet --force --out whole.csv"), 0);
        let whole = bench.read("whole.csv");
        let arguments = format!("{command} --heights heights.npy {options} --quiet --out killed.csv");
        for kill in [2, 6] {
            let mut child = bench.command(&arguments).stderr(Stdio::null()).spawn().unwrap();
            kill_at(&mut child, &bench, "killed.csv", kill);
        }
        assert!(whole.starts_with(bench.read("killed.csv").rsplit_once('\n').unwrap().0));
        let output = bench.ends(command, &format!("{options} --out killed.csv"), 0);
        assert!(text(&output.stdout).contains(" rows already"), "{arguments}");
        assert!(bench.read("killed.csv") == whole, "{arguments}");
        for name in ["killed.csv", "killed.csv.scene.toml", "killed.csv.state"] {
            fs::remove_file(bench.path(name)).unwrap();
        }
    }
}

#[test]
fn the_file_of_another_sweep_is_refused_and_kept() {
    let bench = bench(32);
    let good = "--mean-pressures 2e-3,4e-3 --out sweep.csv";
    bench.ends("sweep", good, 0);
    write_npy(bench.path("start.npy"), &Array2::from_elem((32, 32), 0.01)).unwrap();
    let (before, names) = (bench.read("sweep.csv"), bench.names("."));
    for (arguments, part) in [
        (format!("{good} --modulus 2"), "modulus is 1, and not 2"),
        (format!("{good} --lengths 2"), "lengths is 1 1, and not 2 2"),
        (format!("{good} --tolerance 1e-7"), "tolerance"),
        (format!("{good} --max-iterations 7"), "max iterations is 2000, and not 7"),
        (format!("{good} --method rey2017"), "method"),
        (format!("{good} --precision f32"), "precision"),
        (format!("{good} --law exponential --work-of-adhesion 1e-4 --range 1e-2"), "law is none, and not exponential"),
        (format!("{good} --initial-gap start.npy"), "initial gap"),
        (format!("{good} --format jsonl"), "format is csv, and not jsonl"),
        ("--mean-gaps 2e-3,4e-3 --out sweep.csv".to_owned(), "control is mean-pressure, and not mean-gap"),
        ("--mean-pressures 2e-3,5e-3 --out sweep.csv".to_owned(), "first 2 loads"),
        ("--mean-pressures 2e-3 --out sweep.csv".to_owned(), "first 2 loads"),
    ] {
        refuse(&bench, &arguments, &["sweep.csv", "another run", part, "--force"]);
        assert_eq!((bench.read("sweep.csv"), bench.names(".")), (before.clone(), names.clone()), "{arguments}");
    }
    let mut heights = wavy(32);
    heights[[3, 4]] += 1e-9;
    write_npy(bench.path("heights.npy"), &heights).unwrap();
    refuse(&bench, good, &["another file of its heights"]);
    write_npy(bench.path("heights.npy"), &wavy(32)).unwrap();
    bench.ends("sweep", good, 0);
    assert_eq!(bench.read("sweep.csv"), before);

    fs::write(bench.path("notes.csv"), "mine\n").unwrap();
    refuse(&bench, "--mean-pressures 2e-3 --out notes.csv", &["notes.csv", "exists", "--force"]);
    assert_eq!(bench.read("notes.csv"), "mine\n");
    bench.ends("sweep", "--mean-pressures 2e-3 --out notes.csv --force", 0);
    assert_eq!(count_rows(&bench, "notes.csv"), 1);
}

#[test]
fn bad_lists_and_files_are_refused() {
    let bench = bench(16);
    for (arguments, parts) in [
        ("--out sweep.csv", vec!["--mean-gaps", "--mean-pressures"]),
        ("--mean-gaps 0.1 --mean-pressures 0.1 --out sweep.csv", vec!["cannot be used with"]),
        ("--mean-gaps 0.1,1e300 --precision f32 --out sweep.csv", vec!["1e300", "precision"]),
        ("--mean-gaps 0.1 --out sweep.txt", vec!["sweep.txt", ".csv", ".jsonl", "--format"]),
        ("--mean-gaps 0.1 --out sweep", vec![".csv", ".jsonl", "--format"]),
        ("--mean-gaps 0.1", vec!["--out"]),
        ("--mean-gaps 0.1 --law exponential --out sweep.csv", vec!["--work-of-adhesion"]),
        ("--mean-gaps 0.1 --out heights.npy/sweep.csv", vec!["heights.npy", "is not a folder"]),
    ] {
        refuse(&bench, arguments, &parts);
        assert_eq!(bench.names("."), ["heights.npy"], "{arguments}");
    }
    let empty = bench.command("sweep --heights heights.npy --out sweep.csv --mean-gaps").arg("").output().unwrap();
    assert_eq!((empty.status.code(), text(&empty.stderr).lines().count()), (Some(1), 1));
    fs::create_dir(bench.path("folder.csv")).unwrap();
    refuse(&bench, "--mean-gaps 0.1 --out folder.csv", &["folder.csv", "not a regular file"]);
    if cfg!(target_os = "linux") {
        refuse(&bench, "--mean-gaps 0.1 --out /proc/asperity/sweep.csv", &["/proc", "cannot be written"]);
        refuse(&bench, "--mean-gaps 0.1 --out /dev/null --format csv", &["/dev/null", "not a regular file"]);
    }
}

#[test]
fn rows_that_did_not_converge_are_written_and_counted() {
    let bench = bench(32);
    let law = "--law exponential --work-of-adhesion 1e-5 --range 4e-3";
    let arguments = &format!("{law} --mean-pressures 4e-3,-1,4e-3 --out sweep.csv");
    let first = bench.ends("sweep", arguments, 2);
    let warning = text(&first.stderr);
    assert!(warning.contains("1 of 3 rows") && warning.lines().count() == 1, "{warning}");
    let table = bench.read("sweep.csv");
    assert_eq!(bench.cells("sweep.csv", "status"), ["converged", "detached", "converged"]);
    // what there is already counts too
    let again = bench.ends("sweep", arguments, 2);
    assert!(text(&again.stdout).contains("3 of 3 rows already") && text(&again.stderr).contains("1 of 3 rows"));
    assert_eq!(bench.read("sweep.csv"), table);
    assert!(!warning.contains("f64"), "{warning}");
    let single = bench.ends("sweep", "--precision f32 --tolerance 1e-9 --mean-pressures 4e-3 --out single.csv", 2);
    assert!(
        text(&single.stderr).contains("1 of 1 rows not converged") && text(&single.stderr).contains("--precision f64")
    );

    let law = "--law maugis-dugdale --work-of-adhesion 1e-4 --range 1e-3";
    let output = bench.ends("sweep", &format!("{law} --mean-gaps 0.03,0.02 --out unresolved.csv"), 0);
    let warning = text(&output.stderr);
    assert!(warning.contains("mu_rho") && warning.lines().count() == 1, "{warning}");
}

#[test]
fn fields_are_kept_for_every_load() {
    let bench = bench(32);
    let arguments = "--mean-gaps 0.02,0.01 --fields fields --out sweep.csv";
    bench.ends("sweep", arguments, 0);
    let names = ["contact_pressure-0001.npy", "contact_pressure-0002.npy", "gap-0001.npy", "gap-0002.npy"];
    assert_eq!(bench.names("fields")[..4], names);
    assert_eq!(bench.names("fields").len(), 6);
    let [first, second] = [0, 1].map(|k| read_field(bench.path("fields").join(names[2 + k])).unwrap());
    assert!((first.mean().unwrap() - 0.02).abs() < 1e-12 && (second.mean().unwrap() - 0.01).abs() < 1e-12);
    let table = bench.read("sweep.csv");
    let contact = second.iter().filter(|gap| **gap == 0.0).count() as f64 / 1024.0;
    assert_eq!(bench.column("sweep.csv", "contact_fraction")[1], contact);
    refuse(&bench, "--mean-gaps 0.02,0.01 --fields fields --out other.csv", &["gap-0001.npy", "exists", "--force"]);
    refuse(&bench, "--mean-gaps 0.02,0.01 --out sweep.csv", &["another run", "fields"]);
    // more loads continue from there
    bench.ends("sweep", "--mean-gaps 0.02,0.01,0.005 --fields fields --out sweep.csv", 0);
    assert!(bench.read("sweep.csv").starts_with(&table) && count_rows(&bench, "sweep.csv") == 3);
    assert_eq!(bench.names("fields").len(), 9);
}
