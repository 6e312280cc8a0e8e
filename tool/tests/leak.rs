//! What leaks through a gap, end to end.

use asperity_maps::io::{read_field, write_npy};
use ndarray::Array2;

use crate::bench::{Bench, text};

/// A slot along x, half of the width, of a gap of 2.
fn slot(bench: &Bench) {
    let gap = Array2::from_shape_fn((16, 8), |(_, j)| if j < 4 { 2.0 } else { 0.0 });
    write_npy(bench.path("slot.npy"), &gap).unwrap();
}

#[test]
fn a_slot_leaks_as_its_cube_says() {
    let bench = Bench::new();
    slot(&bench);
    for boundary in ["periodic", "free"] {
        let report = bench.reported(&format!("leak slot.npy --lengths 2 1 --boundary {boundary} --viscosity 4"));
        let x = &report["transmissivity"]["x"];
        let [lower, upper] = ["lower", "upper"].map(|key| x[key].as_f64().unwrap());
        // a channel half as wide as the cell, which is twice as long as wide
        let exact = 8.0 / 12.0 * 0.5 / 2.0;
        assert!(lower <= exact && exact <= upper && upper - lower <= 1e-6 * upper, "{lower} {upper}");
        let per_pressure = report["flow_per_pressure"]["x"]["upper"].as_f64().unwrap();
        assert!((per_pressure - upper / 4.0).abs() < 1e-15);
        assert_eq!((&report["percolates"]["x"], &report["percolates"]["y"]), (&true.into(), &false.into()));
        assert_eq!(
            (report["constriction"]["x"]["gap"].as_f64(), &report["constriction"]["y"]),
            (Some(2.0), &().into())
        );
        assert!(x["grid_error"].as_f64().unwrap() < 1e-3);
        let y = &report["transmissivity"]["y"];
        assert_eq!((y["upper"].as_f64(), &y["grid_error"]), (Some(0.0), &().into()));
        assert_eq!((&report["boundary"], &report["reached"]), (&boundary.into(), &true.into()));
    }
    let said = bench.said("leak slot.npy --lengths 2 1");
    assert!(
        ["along x", "the gap is 2 at the constriction", "error of the grid", "closed"]
            .iter()
            .all(|word| said.contains(word)),
        "{said}"
    );
}

#[test]
fn a_solve_leaks_with_its_sides_and_units_and_leaves_files() {
    let bench = Bench::new();
    bench.said("surface --size 64 --lengths 20um --k-l 2 --k-s 8 --rms-height 0.1um --quiet --out heights.npz");
    bench.said("solve --heights heights.npz --modulus 1GPa --mean-pressure 1MPa --no-pictures --quiet --out pressed");
    let report = bench.reported("leak pressed --viscosity 1mPas --out leakage");
    assert_eq!(report["length_unit"], "m");
    assert_eq!(report["lengths"][0].as_f64(), Some(20e-6));
    assert_eq!(report["viscosity"].as_f64(), Some(1e-3));
    assert_eq!(report["given"]["viscosity"], "1mPas");
    assert_eq!(report["boundary"], "periodic");
    let upper = report["transmissivity"]["x"]["upper"].as_f64().unwrap();
    assert!(upper > 0.0 && upper < (1e-6_f64).powi(3), "{upper}");
    let names = bench.names("leakage");
    let expected = "flow_x.npy flow_x.png flow_y.npy flow_y.png pressure_x.npy pressure_y.npy report.json scene.toml";
    assert_eq!(names.join(" "), expected);
    assert_eq!(bench.report("leakage")["transmissivity"], report["transmissivity"]);
    let pressure = read_field(bench.path("leakage/pressure_x.npy")).unwrap();
    let gap = read_field(bench.path("pressed/gap.npy")).unwrap();
    assert!(pressure.iter().zip(&gap).all(|(pressure, gap)| pressure.is_nan() || (*gap > 0.0 && pressure.abs() < 2.0)));
    let flow = read_field(bench.path("leakage/flow_x.npy")).unwrap();
    assert!(flow.iter().zip(&gap).all(|(flow, gap)| *flow >= 0.0 && (*gap > 0.0 || *flow == 0.0)));

    // the scene repeats it, and files stay unless they may be replaced
    let again = bench.reported("run leakage/scene.toml --out again");
    assert_eq!(again["transmissivity"], report["transmissivity"]);
    bench.refused_with("leak pressed --out leakage", &["exists: use --force"]);
    let said = bench.said("leak pressed --viscosity 1mPas --picture-format svg --force --out leakage");
    assert!(said.contains("µm³/(Pa·s)") && !said.contains("e-"), "{said}");
    assert!(said.contains("results in leakage") && said.contains("flow_y.svg"), "{said}");
    // a viscosity in an unknown unit leaves a number
    let said = bench.said("leak pressed --viscosity 0.001");
    let row = said.lines().find(|line| line.contains("flow per pressure")).unwrap();
    assert!(row.rsplit(' ').next().unwrap().parse::<f64>().is_ok(), "{row}");
    // the same gap from its file, in a cell of the same shape
    let alone = bench.reported("leak pressed/gap.npy --lengths 20um");
    assert_eq!(alone["transmissivity"], report["transmissivity"]);

    write_npy(bench.path("leakage/flow_x.npy"), &Array2::<f64>::ones((32, 32))).unwrap();
    bench.refused_with("report leakage", &["pressure and flow", "different runs"]);
}

#[test]
fn the_original_of_a_mirrored_map_leaks_as_the_whole() {
    let bench = Bench::new();
    bench.said("surface --size 32 --k-l 2 --k-s 8 --rms-height 0.01 --quiet --out heights.npy");
    bench.said("prepare heights.npy --lengths 1 --mirror --quiet --out mirrored.npz");
    bench.said("solve --heights mirrored.npz --mean-pressure 0.01 --no-pictures --quiet --out original");
    bench.said("solve --heights mirrored.npz --mean-pressure 0.01 --no-pictures --quiet --whole --out whole");
    let [original, whole] =
        ["original", "whole"].map(|folder| bench.reported(&format!("leak {folder} --tolerance 1e-9")));
    assert_eq!((&original["boundary"], &whole["boundary"]), (&"free".into(), &"periodic".into()));
    for axis in ["x", "y"] {
        let [one, other] = [&original, &whole].map(|report| report["transmissivity"][axis]["upper"].as_f64().unwrap());
        assert!(one > 0.0 && (one / other - 1.0).abs() < 1e-8, "{axis}: {one} {other}");
    }
}

#[test]
fn absent_nodes_and_unclosed_bounds_are_told() {
    let bench = Bench::new();
    let gap = Array2::from_shape_fn((8, 8), |(i, _)| if i == 3 { f64::NAN } else { 1.0 });
    write_npy(bench.path("hole.npy"), &gap).unwrap();
    let report = bench.reported("leak hole.npy");
    assert_eq!((&report["percolates"]["x"], &report["absent_gap"]), (&false.into(), &().into()));
    let report = bench.reported("leak hole.npy --absent-gap 2");
    let upper = report["transmissivity"]["x"]["upper"].as_f64().unwrap();
    assert!((12.0 * upper - 8.0 / (7.0 + 1.0 / 8.0)).abs() < 1e-5, "{upper}");

    let wavy =
        Array2::from_shape_fn((32, 32), |(i, j)| 1.0 + 0.9 * (0.5 * i as f64 + j as f64).sin() * (i as f64).cos());
    write_npy(bench.path("wavy.npy"), &wavy).unwrap();
    let output = bench.run("leak wavy.npy --max-iterations 2 --tolerance 1e-9");
    let told = text(&output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("bounds") && told.contains("--max-iterations"), "{told}");
}

#[test]
fn what_has_no_gap_is_refused_by_name() {
    let bench = Bench::new();
    slot(&bench);
    bench.said("surface --size 16 --k-s 4 --rms-height 0.01 --quiet --out heights.npy");
    bench.said("solve --heights heights.npy --mean-gap 0.02 --format npz --quiet --out packed");
    std::fs::create_dir(bench.path("empty")).unwrap();
    // a wall of springs lets the surfaces overlap, and the solve is known to be of a gap
    let springs = "--wall penalty --wall-stiffness 10 --percolation --leakage --no-pictures --out springs";
    bench.said(&format!("solve --heights heights.npy --mean-pressure 0.01 {springs}"));
    assert_eq!(bench.reported("leak springs")["constriction"], bench.report("springs")["constriction"]);
    for (arguments, parts) in [
        ("missing.npy", &["missing.npy"][..]),
        ("empty", &["empty", "no report.json"]),
        ("heights.npy", &["least gap is -0.0", "Is it a gap?", "of heights solve first"]),
        ("springs/gap.npy", &["least gap is -", "where surfaces overlap set it to zero"]),
        ("packed", &["packed", "no gap.npy", "--format npy"]),
        ("slot.npy --tolerance 2", &["--tolerance", "share between 0 and 1"]),
        ("slot.npy --lengths 0", &["--lengths", "positive"]),
        ("slot.npy --viscosity -1", &["--viscosity", "positive", "1mPas"]),
        ("slot.npy --viscosity 3m", &["--viscosity", "a unit of something else"]),
        ("slot.npy --absent-gap 0", &["--absent-gap", "positive"]),
        ("slot.npy --max-iterations 0", &["max_iterations is 0", "at least 1"]),
        ("slot.npy --lengths 1um --viscosity 3", &["--viscosity", "--lengths", "both units"]),
        ("slot.npy --viscosity 1mPas", &["slot.npy", "give --lengths"]),
    ] {
        bench.refused_with(&format!("leak {arguments}"), parts);
    }
    bench.said("solve --heights heights.npy --mean-gap 0.02 --quiet --no-pictures --out solved");
    bench.refused_with("leak solved --lengths 2", &["solved", "leave --lengths out"]);
    for given in ["viscosity 1mPas", "absent-gap 50nm"] {
        let told = format!("--{}: give a number", given.replace(' ', " is "));
        bench.refused_with(&format!("leak solved --{given}"), &["solved: was solved without units", &told]);
    }
    bench.said("leak solved --quiet --out leaked");
    bench.refused_with("leak leaked", &["leaked", "another command"]);
}
