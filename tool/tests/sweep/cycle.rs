//! The command cycle.

use super::*;

/// A wave that jumps into and out of contact.
const CYCLE: &str = "--law exponential --work-of-adhesion 8e-5 --range 2e-3 --mean-gaps 0.03,0.02,0.03 --steps 20";

fn bench_with_a_wave() -> Bench {
    let bench = bench(4);
    let wave = Surface::wave(Grid::line(64, 1.0).unwrap(), 0.02, 1).unwrap();
    write_npy(bench.path("heights.npy"), wave.heights()).unwrap();
    bench
}

#[test]
fn a_cycle_has_its_jumps_and_a_picture() {
    let bench = bench_with_a_wave();
    let said = text(&bench.ends("cycle", &format!("{CYCLE} --out cycle.csv --plot loop.png"), 0).stdout);
    for part in ["jump-in", "pull-off", "greatest tension", "dissipated in jumps"] {
        assert!(said.contains(part), "{said}");
    }
    let table = bench.read("cycle.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split(',').collect()).collect();
    let at = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let events: Vec<_> = rows[1..].iter().map(|row| row[at("event")]).filter(|event| !event.is_empty()).collect();
    assert_eq!(events, ["jump-in", "pull-off"]);
    let last = rows.len() - 1;
    let value = |row: usize, name: &str| rows[row][at(name)].parse::<f64>().unwrap();
    let number = |name: &str| value(last, name);
    assert!(number("dissipated") > 0.0);
    // what the share of the imbalance is of
    let greatest = (1..=last).map(|row| value(row, "work").abs()).fold(0.0, f64::max);
    let share = format!("{:.1} % of the greatest work on the way, ", 100.0 * number("imbalance").abs() / greatest);
    let told: f64 = said.split_once(&share).expect(&said).1.lines().next().unwrap().parse().unwrap();
    assert!((told / greatest - 1.0).abs() < 1e-3, "{told} {greatest}");
    // both legs are named, and the second ends where the surfaces are apart
    assert_eq!(
        ["start", "approach", "withdrawal"]
            .map(|name| rows.iter().filter(|row| row[at("direction")] == name).count() > 0),
        [true; 3]
    );
    assert_eq!((number("contact_fraction"), number("attractive_fraction")), (0.0, 0.0));
    assert!(fs::read(bench.path("loop.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn what_a_cycle_asks_for_is_said_before_its_first_state() {
    let bench = bench_with_a_wave();
    let loads = "--mean-gaps 0.05,0.02,0.05 --steps 4 --smallest-step 0.1";
    let adhesive = format!("{loads} --law exponential --work-of-adhesion 1e-4 --range 4e-3");
    let first = |arguments: &str| {
        let said = text(&bench.ends("cycle", arguments, 0).stdout);
        said.lines().next().unwrap_or_default().to_owned()
    };
    let asked = "9 states or more, 2 legs of 4 steps: about ";
    let said = first(&format!("{loads} --out wall.csv"));
    assert!(said.starts_with(asked), "{said}");
    let said = first(&format!("{adhesive} --out a.csv"));
    assert!(said.starts_with(asked), "{said}");
    assert_eq!(first(&format!("{adhesive} --out b.csv --quiet")), "");
    assert_eq!(bench.read("a.csv"), bench.read("b.csv"));
    // a cycle that continues says how far it was, and a report has no time
    assert!(first(&format!("{adhesive} --out a.csv")).starts_with("a.csv has "));
    let report = text(&bench.ends("cycle", &format!("{adhesive} --out c.csv --json"), 0).stdout);
    assert!(report.starts_with('{') && !report.contains("about"), "{report}");
    assert_eq!(bench.read("a.csv"), bench.read("c.csv"));
}

#[test]
fn bad_cycles_are_refused_on_one_line() {
    let bench = bench_with_a_wave();
    bench.ends("cycle", &format!("{CYCLE} --quiet --out cycle.csv"), 0);
    for (arguments, part) in [
        ("--mean-gaps 0.03 --out a.csv", "two turning points"),
        ("--mean-gaps 0.03,0.02 --out a.txt", ".csv"),
        ("--mean-gaps 0.03,0.02 --out a.csv --plot a.gif", ".png, .svg or .pdf"),
        ("--mean-gaps 0.03,0.02 --smallest-step 2 --out a.csv", "smallest step is 2"),
        ("--mean-gaps 0.03,0.02 --steps 0 --out a.csv", "number of steps is 0"),
        ("--out a.csv", "--mean-gaps"),
        ("--mean-gaps 0.03,0.02 --out cycle.csv", "another run"),
    ] {
        let output = bench.ends("cycle", arguments, 1);
        let error = text(&output.stderr);
        assert!(error.lines().count() == 1 && error.contains(part), "{arguments}: {error}");
    }
}
