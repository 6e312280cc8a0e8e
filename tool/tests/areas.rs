//! The tool finds what the library finds, from the seed of a surface to areas over loads.

use asperity::contact::ContactStatistics;
use asperity::{AdhesionLaw, Control, Exponential, Grid, NoAdhesion, Problem, SelfAffine, Solver, Sweep, Westergaard};

use crate::bench::Bench;

const LOAD: f64 = 0.003;

fn press(law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    let grid = Grid::square(160, 1.0).unwrap();
    let surface = SelfAffine::default().seed(3).surface(grid).unwrap();
    Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap()
}

#[test]
fn from_a_seed_to_areas_the_tool_finds_what_the_library_finds() {
    let bench = Bench::new();
    let said = |arguments: &str| {
        let output = bench.run(arguments);
        assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    said("surface --size 160 --rms-slope 0.1 --seed 3 --out rough.npy");
    let statistics = said("stats rough.npy --lengths 1");
    let slope = statistics.lines().find_map(|line| line.strip_prefix("rms slope, spectral")).unwrap();
    assert!((slope.trim().parse::<f64>().unwrap() - 0.1).abs() < 1e-7, "{statistics}");

    let law = "--law exponential --work-of-adhesion 2e-6 --range 4e-4";
    said(&format!("solve --heights rough.npy --mean-pressure {LOAD} {law} --no-pictures --out sticky"));
    let report = bench.report("sticky");
    let mut problem = press(Exponential::new(2e-6, 4e-4).unwrap());
    let single = Solver::default().solve(&mut problem, Control::MeanPressure(LOAD)).unwrap().report;
    for (name, expected) in [
        ("contact_fraction", single.contact_fraction),
        ("mean_contact_pressure", single.mean_contact_pressure),
        ("mean_gap", single.mean_gap),
    ] {
        assert_eq!(report[name].as_f64().unwrap(), expected, "{name}");
    }

    let loads = [0.001, 0.002, LOAD];
    for (file, law) in [("bare.csv", ""), ("sticky.csv", law)] {
        said(&format!("sweep --heights rough.npy --mean-pressures 0.001,0.002,{LOAD} {law} --out {file}"));
    }
    let (mut solver, mut problem, mut sweep) = (Solver::default(), press(NoAdhesion), Sweep::default());
    let areas = loads.map(|load| {
        let solution = sweep.next(&mut solver, &mut problem, Control::MeanPressure(load)).unwrap();
        let found = ContactStatistics::of(&solution).unwrap();
        [found.contact_fraction, found.corrected_contact_fraction]
    });
    for (i, name) in ["contact_fraction", "corrected_contact_fraction"].into_iter().enumerate() {
        let expected: Vec<f64> = areas.iter().map(|area| area[i]).collect();
        assert_eq!(bench.column("bare.csv", name), expected);
        assert!(bench.column("sticky.csv", name).iter().zip(expected).all(|(sticky, bare)| *sticky > bare));
    }
    // from the last load, not from full contact: the same state to what the tolerance leaves
    let last = bench.column("sticky.csv", "mean_gap")[2];
    assert!((last / single.mean_gap - 1.0).abs() < 1e-5, "{last} {}", single.mean_gap);
}
