//! Hertz' contact by the command solve.

use super::*;

#[test]
fn demo() {
    let bench = Bench::new();
    let first = bench.run("demo");
    assert_eq!((first.status.code(), text(&first.stderr)), (Some(0), String::new()));
    let names = [
        "contact-with-adhesion.png",
        "contact-without-adhesion.png",
        "heights.npy",
        "heights.png",
        "pressure-with-adhesion.png",
        "pressure-without-adhesion.png",
        "scene.toml",
    ];
    assert_eq!(bench.names("asperity-demo"), names);
    assert_eq!(bench.names("."), ["asperity-demo"]);
    for name in names.iter().filter(|name| name.ends_with(".png")) {
        let (width, height, drawn) = picture(&bench, &format!("asperity-demo/{name}"));
        assert!(width > 500 && height > 500 && drawn, "{name}");
    }
    let said = text(&first.stdout);
    let row = |name: &str| -> Vec<f64> {
        let line = said.lines().find(|line| line.starts_with(name)).unwrap();
        line[name.len()..].split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    let [bare, sticky] = row("contact")[..] else { panic!("{said}") };
    assert!(sticky > 1.5 * bare, "{said}");
    assert_eq!(row("mean pressure"), [5.0, 5.0]);
    let stats = bench.run("stats asperity-demo/heights.npy --lengths 1um --json");
    let stats: Value = serde_json::from_slice(&stats.stdout).unwrap();
    let stated = said.split("rms height ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap();
    assert!((1e9 * number(&stats, "rms_height") / stated - 1.0).abs() < 1e-12, "{stats}");

    // The printed command gives the same as the table.
    let command = said.lines().find_map(|line| line.trim().strip_prefix("asperity ")).unwrap();
    let again = bench.run(&format!("{command} --no-pictures"));
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    let report = bench.report("asperity-demo/with-adhesion");
    assert!((100.0 * number(&report, "contact_fraction") - sticky).abs() <= 0.05);
    assert_eq!(row("iterations")[1], number(&report, "iterations"));
    // the grid resolves the adhesion
    assert!(number(&report, "mu_rho") < 0.5, "{report}");

    // and so does its scene
    let again = bench.run("run asperity-demo/scene.toml --no-pictures --json --out scene");
    assert_eq!((again.status.code(), text(&again.stderr)), (Some(0), String::new()));
    assert!(bench.bytes("scene/gap.npy") == bench.bytes("asperity-demo/with-adhesion/gap.npy"));
    let first = bench.run("demo --json --out other");
    let reports: Value = serde_json::from_slice(&first.stdout).unwrap();
    assert_eq!(reports["with_adhesion"]["contact_nodes"], report["contact_nodes"]);
    assert_eq!(reports["without_adhesion"]["law"], "none");
    for folder in ["scene", "other"] {
        fs::remove_dir_all(bench.path(folder)).unwrap();
    }

    // A second run replaces its own files by the same, and leaves others alone.
    let before: Vec<_> = names.iter().map(|name| bench.bytes(&format!("asperity-demo/{name}"))).collect();
    fs::write(bench.path("asperity-demo/heights.png"), "old").unwrap();
    assert_eq!(bench.run("demo --threads 1").status.code(), Some(0));
    let after: Vec<_> = names.iter().map(|name| bench.bytes(&format!("asperity-demo/{name}"))).collect();
    assert!(before == after, "the demo depends on something");
    assert_eq!(bench.names("asperity-demo/with-adhesion").len(), 5);
}

#[test]
fn the_report_of_a_solve_is_of_its_fields() {
    let bench = paraboloid();
    let report = bench.solve("--mean-gap 0.0398 --tolerance 1e-10", "results", 0);
    assert_eq!(bench.names("results"), RESULTS);
    assert_eq!(bench.names("."), ["heights.npy", "results"]);
    assert_eq!((&report["status"], &report["law"]), (&"converged".into(), &"none".into()));
    assert!(number(&report, "relative_error") <= 1e-10);
    let [gap, pressure, contact] = FIELDS.map(|name| bench.field(&format!("results/{name}")));
    assert_eq!(report["contact_nodes"], gap.iter().filter(|g| **g == 0.0).count());
    assert_close(gap.mean().unwrap(), 0.0398, 1e-12);
    assert_close(pressure.mean().unwrap(), number(&report, "mean_pressure"), 1e-9);
    assert_close(contact.mean().unwrap(), number(&report, "mean_contact_pressure"), 1e-9);
    for name in ["contact.png", "pressure.png"] {
        let (width, height, drawn) = picture(&bench, &format!("results/{name}"));
        assert!(width > 500 && height > 500 && drawn, "{name}");
    }
}

#[test]
fn lines_and_rectangles_have_sensible_lengths() {
    let (bench, hertz) = (Bench::new(), hertz(64));
    let line = hertz.row(32).to_owned().insert_axis(ndarray::Axis(1));
    write_npy(bench.path("heights.npy"), &line).unwrap();
    for (arguments, lengths) in
        [("--lengths 2", json!([2.0, 2.0])), ("--lengths 2 3", json!([2.0, 3.0])), ("", json!([1.0, 1.0]))]
    {
        let report = bench.solve(&format!("{arguments} --mean-gap 0.04 --force"), "line", 0);
        assert_eq!((&report["shape"], &report["lengths"]), (&json!([64, 1]), &lengths));
    }
    assert_eq!(bench.names("line"), RESULTS);
    write_npy(bench.path("heights.npy"), &Array2::from_shape_fn((64, 32), |(i, j)| hertz[[i, j]])).unwrap();
    for (arguments, lengths) in
        [("--lengths 2", json!([2.0, 1.0])), ("--lengths 2 3", json!([2.0, 3.0])), ("", json!([1.0, 1.0]))]
    {
        let report = bench.solve(&format!("{arguments} --mean-gap 0.04 --force"), "rectangle", 0);
        assert_eq!((&report["shape"], &report["lengths"]), (&json!([64, 32]), &lengths));
    }
}
