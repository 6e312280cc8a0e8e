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
    let energy = |row: usize| value(row, "elastic_energy") + value(row, "adhesive_energy");
    let missing = number("work") - number("dissipated") + number("imbalance") - (energy(last) - energy(1));
    assert!(missing.abs() < 1e-9 * number("dissipated"), "{missing}");
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
fn an_interrupted_cycle_goes_on_to_the_same_file() {
    let bench = bench_with_a_wave();
    bench.ends("cycle", &format!("{CYCLE} --quiet --out whole.csv"), 0);
    let whole = bench.read("whole.csv");
    for pause in [20, 60, 150] {
        let name = format!("{pause}.csv");
        let arguments = format!("{CYCLE} --quiet --out {name}");
        let mut child = bench.command(&format!("cycle --heights heights.npy {arguments}")).spawn().unwrap();
        sleep(Duration::from_millis(pause));
        let _ = child.kill();
        child.wait().unwrap();
        bench.ends("cycle", &arguments, 0);
        assert_eq!(bench.read(&name), whole);
    }
    // and there is nothing to add to it
    bench.ends("cycle", &format!("{CYCLE} --quiet --out whole.csv"), 0);
    assert_eq!(bench.read("whole.csv"), whole);
}

#[test]
fn what_is_interrupted_on_a_free_half_space_goes_on_to_the_same_file() {
    let bench = bench(4);
    let tip = Surface::paraboloid(Grid::square(32, 1.0).unwrap(), 2.0).unwrap();
    write_npy(bench.path("heights.npy"), tip.heights()).unwrap();
    let law = "--law exponential --work-of-adhesion 1e-4 --range 8e-3";
    for (k, (command, options)) in [
        ("sweep", "--normal-forces 1e-3:1e-2:12"),
        ("sweep", &format!("{law} --normal-forces 1e-3:1e-2:12")),
        ("sweep", "--contact-fractions 0.01:0.1:6"),
        ("cycle", &format!("{law} --approaches -0.005,0.005 --steps 12")),
    ]
    .into_iter()
    .enumerate()
    {
        let [whole, killed] = ["whole", "killed"].map(|name| format!("{name}-{k}.csv"));
        let follow = |name: &str| {
            let mut command = bench.command(&format!(
                "{command} --heights heights.npy {options} --boundary free --quiet --threads 1 --out {name}"
            ));
            command.stderr(Stdio::null());
            command
        };
        // contact fractions may jump, in whichever run
        let code = follow(&whole).status().unwrap().code();
        assert_ne!(code, Some(1), "{options}");
        kill_at(&mut follow(&killed).spawn().unwrap(), &bench, &killed, 4);
        assert_eq!(follow(&killed).status().unwrap().code(), code, "{options}");
        assert_eq!(bench.read(&killed), bench.read(&whole), "{options}");
    }
}

#[test]
fn a_row_of_a_cycle_that_is_ahead_of_its_state_is_made_again() {
    let bench = bench_with_a_wave();
    bench.ends("cycle", &format!("{CYCLE} --quiet --out whole.csv"), 0);
    let whole = bench.read("whole.csv");
    let arguments = format!("{CYCLE} --quiet --out killed.csv");
    let mut child = bench.command(&format!("cycle --heights heights.npy {arguments}")).spawn().unwrap();
    kill_at(&mut child, &bench, "killed.csv", 5);
    let path = bench.path("killed.csv.state");
    let state = fs::read(&path).unwrap();
    let text = String::from_utf8_lossy(&state);
    let (_, rows) = text.split_once("\"rows\":").unwrap();
    let rows: usize = rows.split(',').next().unwrap().parse().unwrap();
    let ends: Vec<usize> = whole.match_indices('\n').map(|(at, _)| at + 1).collect();
    let next = ends.get(rows + 1).copied().unwrap_or(ends[rows]);
    for length in [ends[rows], ends[rows] + 1, next - 1, next] {
        fs::write(bench.path("killed.csv"), &whole[..length.min(whole.len())]).unwrap();
        fs::write(&path, &state).unwrap();
        if length >= ends[rows] {
            bench.ends("cycle", &arguments, 0);
            assert_eq!(bench.read("killed.csv"), whole, "{rows} {length}");
        }
    }
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
