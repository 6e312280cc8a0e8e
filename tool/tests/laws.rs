//! Adhesion laws in the tool: their options, their files, and their list.

use crate::bench::{Bench, text};

/// A wave of height 0.02 on 16 by 16 nodes, and a work of adhesion that is larger where x > ½.
fn wave() -> Bench {
    let bench = Bench::new();
    let (mut heights, mut works) = (String::new(), String::new());
    for i in 0..16 {
        let x = f64::from(i) / 16.0;
        let row: Vec<_> = (0..16)
            .map(|j| 0.01 * (std::f64::consts::TAU * x).cos() * (std::f64::consts::TAU * f64::from(j) / 16.0).cos())
            .collect();
        let text = |row: &[f64]| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ") + "\n";
        heights += &text(&row);
        works += &text(&[if i < 8 { 1e-6 } else { 4e-5 }; 16]);
    }
    bench.write("heights.txt", &heights);
    bench.write("works.txt", &works);
    bench.write("law.txt", "# gap, traction\n0 4e-3\n0.005 2e-3\n0.01 5e-4\n0.02 0\n");
    bench
}

const SOLVE: &str = "solve --heights heights.txt --mean-pressure 1e-3 --no-pictures --threads 1";

#[test]
fn every_law_solves_and_is_in_report_and_scene() {
    let bench = wave();
    for (number, law) in [
        "lennard-jones --work-of-adhesion 2e-5 --range 0.01",
        "lennard-jones --work-of-adhesion 2e-5 --range 0.01 --wall none",
        "morse --work-of-adhesion 2e-5 --range 0.01 --wall none --stability",
        "power --work-of-adhesion 2e-5 --range 0.01 --exponent 3 --cut-off 0.1",
        "van-der-waals --hamaker 1e-7 --range 0.012",
        "table --law-table law.txt",
        "exponential --work-of-adhesion-map works.txt --range 0.01",
        "table --law-table law.txt --work-of-adhesion-map works.txt",
        "morse --work-of-adhesion 2e-5 --range 0.01 --wall none --precision f32",
    ]
    .iter()
    .enumerate()
    {
        let report = bench.reported(&format!("{SOLVE} --law {law} --out {number}"));
        assert_eq!(report["status"], "converged", "{law}");
        assert_eq!(report["law"], law.split(' ').next().unwrap());
        assert_eq!(report["wall"], if law.contains("none") { "none" } else { "hard" });
        assert!(report["net_pressure"].as_f64().is_some_and(|p| (p - 1e-3).abs() < 1e-6), "{law}: {report}");
        assert_eq!(report["mu_rho_node"].is_null(), !law.contains("map"));
        // the scene repeats it, byte for byte
        let said = bench.said(&format!("run {number}/scene.toml --out again --force --quiet"));
        assert_eq!(said, "");
        assert_eq!(bench.bytes("again/gap.npy"), bench.bytes(&format!("{number}/gap.npy")), "{law}");
    }
    let mapped = bench.report("6");
    assert_eq!(mapped["mu_rho_node"], serde_json::json!([8, 0]));
    let share = |patch: usize, name: &str| mapped["patches"][patch][name].as_f64().unwrap();
    assert_eq!([0, 1].map(|patch| share(patch, "area_fraction")), [0.5, 0.5]);
    assert!(share(0, "attractive_fraction") < share(1, "attractive_fraction"));
    let contact = 0.5 * (share(0, "contact_fraction") + share(1, "contact_fraction"));
    assert!((contact - mapped["contact_fraction"].as_f64().unwrap()).abs() < 1e-15);
    let bare = bench.reported("run 7/scene.toml --law none --out bare");
    assert_eq!((&bare["law"], &bare["work_of_adhesion_map"]), (&"none".into(), &serde_json::Value::Null));
    // without a wall a sweep continues where it was, and another law is another sweep
    let sweep = "sweep --heights heights.txt --threads 1 --quiet --out sweep.csv --law lennard-jones --wall none";
    let law = "--work-of-adhesion 2e-5 --range 0.01";
    bench.said(&format!("{sweep} {law} --mean-pressures 1e-3,2e-3"));
    bench.said(&format!("{sweep} {law} --mean-pressures 1e-3,2e-3,3e-3"));
    assert_eq!(bench.read("sweep.csv").lines().count(), 4);
    bench.refused_with(
        &format!("{sweep} {law} --cut-off 0.1 --mean-pressures 1e-3,2e-3,3e-3"),
        &["cut off is none, and not 0.1"],
    );
}

#[test]
fn laws_that_lack_something_or_have_too_much_are_refused() {
    let bench = wave();
    bench.write("unsorted.txt", "0 1\n2 0.5\n1 0\n");
    bench.write("three.txt", "0 1 2\n1 0.5 2\n2 0 1\n");
    bench.write("negative.txt", &format!("{}\n", ["-1"; 16].join(" ")).repeat(16));
    bench.write("repels.txt", "0 -0.05\n2e-3 0\n4e-3 0.03\n1e-2 0.01\n2e-2 0\n");
    bench.write("small.txt", "1e-5 1e-5\n1e-5 1e-5\n");
    let (w, range) = ("--work-of-adhesion 2e-5", "--range 0.01");
    for (law, parts) in [
        ("table".to_owned(), ["lacks --law-table", "give it"]),
        (
            format!("exponential {range} --cut-off 0.005 --work-of-adhesion-map works.txt"),
            ["cut-off distance is 0.005", "a range of the law"],
        ),
        ("table --law-table repels.txt --wall none".to_owned(), ["--law table ends at a gap of 0", "or --wall hard"]),
        (format!("exponential {w} {range} --work-of-adhesion-map works.txt"), ["every node", "leave one of them out"]),
        ("none --work-of-adhesion-map works.txt".to_owned(), ["there is no adhesion", "leave it out"]),
        (format!("exponential {range} --work-of-adhesion-map small.txt"), ["--work-of-adhesion-map", "2 x 2"]),
        (
            format!("exponential {range} --work-of-adhesion-map negative.txt"),
            ["--work-of-adhesion-map", "zero or positive"],
        ),
        ("table --law-table unsorted.txt".to_owned(), ["unsorted.txt", "sort the table"]),
        ("table --law-table three.txt".to_owned(), ["three.txt", "3 columns"]),
    ] {
        bench.refused_with(&format!("{SOLVE} --out out --law {law}"), &parts);
    }
    assert!(!bench.path("out").exists());
}

#[test]
fn springs_stand_for_the_wall() {
    let bench = wave();
    let solve = |wall: &str, out: &str| {
        let report = bench.reported(&format!("{SOLVE} --wall {wall} --out {out}"));
        assert_eq!(report["status"], "converged", "{wall}");
        let fraction = report["contact_fraction"].clone();
        (report, fraction)
    };
    let (hard, touching) = solve("hard", "hard");
    assert_eq!((&hard["wall"], &hard["wall_stiffness"]), (&"hard".into(), &serde_json::Value::Null));
    let (soft, _) = solve("penalty --wall-stiffness 100", "springs");
    assert_eq!((&soft["wall"], soft["wall_stiffness"].as_f64()), (&"penalty".into(), Some(100.0)));
    assert!(soft["min_gap"].as_f64() < Some(0.0), "{soft}");
    assert_eq!(solve("uzawa --wall-stiffness 20", "rounds").1, touching);
    bench.said("run rounds/scene.toml --out again --quiet");
    assert_eq!(bench.bytes("again/gap.npy"), bench.bytes("rounds/gap.npy"));

    let sweep = "sweep --heights heights.txt --threads 1 --quiet --out sweep.csv --wall penalty";
    bench.said(&format!("{sweep} --wall-stiffness 100 --mean-pressures 1e-3,2e-3"));
    bench.said(&format!("{sweep} --wall-stiffness 100 --mean-pressures 1e-3,2e-3,3e-3"));
    assert_eq!(bench.read("sweep.csv").lines().count(), 4);
    let other = format!("{sweep} --wall-stiffness 200 --mean-pressures 1e-3,2e-3,3e-3,4e-3");
    bench.refused_with(&other, &["wall stiffness is 100, and not 200"]);
    let cycle = "cycle --heights heights.txt --mean-gaps 0.02,0.01 --out cycle.csv --wall penalty --wall-stiffness 100";
    bench.refused_with(cycle, &["springs", "take a rigid wall"]);
    assert!(!bench.path("cycle.csv").exists() && !bench.path("out").exists());
}

#[test]
fn surfaces_that_their_law_keeps_apart_go_through_a_cycle() {
    let bench = wave();
    let law = "--threads 1 --law lennard-jones --work-of-adhesion 3.9e-4 --range 0.01 --wall none";
    let cycle = format!("cycle --heights heights.txt --out cycle.csv --quiet {law}");
    bench.said(&format!("{cycle} --spring-stiffness 0.5 --spring-positions 0.1,-0.02,0.1"));
    let rows = bench.read("cycle.csv");
    for event in ["jump-in", "pull-off"] {
        assert!(rows.lines().any(|row| row.contains(event)), "{event}");
    }
}

#[test]
fn the_laws_are_listed_and_drawn() {
    let bench = wave();
    let said = bench.said("laws");
    for law in ["maugis-dugdale", "exponential", "lennard-jones", "morse", "power", "van-der-waals", "table"] {
        assert!(said.lines().any(|line| line == law), "{law}");
    }
    assert_eq!(bench.said("laws --law morse").lines().count(), 4);
    assert_eq!(bench.said("laws morse"), bench.said("laws --law morse"));
    for (number, law) in ["lennard-jones --wall none", "lennard-jones", "morse"].iter().enumerate() {
        bench.said(&format!("laws --law {law} --work-of-adhesion 0.05 --range 3e-10 --plot {number}.png"));
    }
    bench.said("laws --law table --law-table law.txt --plot table.png");
    assert_ne!(bench.bytes("0.png"), bench.bytes("1.png"));
    bench.refused_with("laws --plot law.png", &["--plot needs a law"]);
    bench.refused_with("laws --law table --law-table law.txt --plot table.png", &["exists", "--force"]);
}

#[test]
fn the_law_without_a_range_has_that_of_the_grid() {
    let bench = wave();
    let law = "--law jkr --work-of-adhesion 2e-6";
    let report = bench.reported(&format!("{SOLVE} {law} --out limit"));
    let number = |report: &serde_json::Value, key: &str| report[key].as_f64().unwrap();
    let range = (13.0 * 2e-6 / 16.0_f64).sqrt();
    assert!((number(&report, "range") / range - 1.0).abs() < 1e-12);
    assert!((number(&report, "peak_traction") * range / 4e-6 - 1.0).abs() < 1e-12);
    bench.refused_with(&format!("laws {law} --plot law.png"), &["has the range of a grid"]);
    // the same in a table, and a search for the pull-off with its limit
    bench.said(&format!("sweep --heights heights.txt --mean-pressures 1e-3 {law} --out limit.csv"));
    let table = bench.read("limit.csv");
    assert!(table.lines().next().unwrap().ends_with("adhesive_contact_fraction,jkr_contact_fraction"), "{table}");
    let pull_off = "pull-off --heights heights.txt --preload 1e-3";
    let few = text(&bench.run(&format!("{pull_off} {law}")).stderr);
    assert!(few.contains("few-nodes: one node or less of a contact"), "{few}");
    // closed surfaces have no limit
    let closed = "pull-off --heights heights.txt --law jkr --work-of-adhesion 1e-2";
    assert!(bench.reported(closed)["limit_pressure"].is_null());
    assert!(bench.said(closed).contains("unknown: the surfaces are closed"));
    // nor has one an error that grows from the coarser grid, and each says why
    bench.said("surface --size 128 --rms-slope 0.1 --k-l 2 --k-s 8 --seed 3 --quiet --out rough.npy");
    for (work, known) in [("3e-5", true), ("1e-4", false)] {
        let found = bench.reported(&format!("pull-off --heights rough.npy --law jkr --work-of-adhesion {work}"));
        assert!(found["limit_pressure"].is_number() == known && found["limit_error"].is_number() == known, "{found}");
        if known {
            assert!(number(&found, "limit_pressure") <= number(&found, "pull_off_pressure"));
        }
        let reason = found["limit_reason"].as_str().unwrap_or("told");
        assert!(reason.contains(if known { "told" } else { "adhesion is strong, w is 0.0" }), "{reason}");
        assert!(found["to_report"].is_string(), "{found}");
    }
    // nor one of contacts that reach the edge of the map
    bench.said("surface --form paraboloid --radius 1 --size 32 --lengths 0.8 --quiet --out tip.npy");
    let tip = "pull-off --heights tip.npy --lengths 0.8 --boundary free --law jkr --work-of-adhesion 0.05";
    let found = bench.reported(tip);
    assert!(found["limit_reason"].as_str().unwrap().contains("reach the edge of the map"), "{found}");
    let long = "--law exponential --work-of-adhesion 2e-6 --range 4e-3 --accuracy 0.1";
    bench.refused_with(&format!("{pull_off} {long}"), &["accuracy of the pull-off", "range of the grid"]);
}
