//! Laws that end at a distance keep their work of adhesion.

use asperity::adhesion::{CutOff, Hints, Varying, check_law};
use asperity::*;
use ndarray::Array2;

const W: f64 = 0.05;
const RANGE: f64 = 2e-9;

/// One law in either precision.
struct Both(Box<dyn AdhesionLaw<f64>>, Box<dyn AdhesionLaw<f32>>);

macro_rules! either {
    ($float:ty, $field:tt) => {
        impl AdhesionLaw<$float> for Both {
            fn energy(&self, gap: $float) -> $float {
                self.$field.energy(gap)
            }
            fn traction(&self, gap: $float) -> $float {
                self.$field.traction(gap)
            }
            fn slope(&self, gap: $float) -> $float {
                self.$field.slope(gap)
            }
            fn hints(&self) -> Hints<$float> {
                self.$field.hints()
            }
        }
    };
}
either!(f64, 0);
either!(f32, 1);

/// Every law that never ends.
fn laws() -> [Both; 6] {
    fn both<L: AdhesionLaw<f64> + AdhesionLaw<f32> + Copy + 'static>(law: Result<L>) -> Both {
        let law = law.unwrap();
        Both(Box::new(law), Box::new(law))
    }
    [
        both(Exponential::new(W, RANGE)),
        both(LennardJones::new(W, RANGE)),
        both(LennardJones::new(W, RANGE).map(LennardJones::cut)),
        both(Morse::new(W, RANGE)),
        both(PowerLaw::new(W, RANGE, 1.5)),
        both(PowerLaw::van_der_waals(6e-20, RANGE)),
    ]
}

/// The largest traction of a law.
fn largest(law: &dyn AdhesionLaw<f64>) -> f64 {
    let start = law.hints().rest.unwrap_or(0.0);
    (0..20_000).map(|i| law.traction(start + 1e-3 * f64::from(i) * RANGE)).fold(0.0, f64::max)
}

#[test]
fn a_law_that_is_cut_off_keeps_its_work_its_rest_and_its_contact() {
    for Both(law, _) in laws() {
        let start = law.hints().rest.unwrap_or(0.0);
        for ranges in [1.0, 1.5, 2.5, 4.0, 30.0] {
            let end = start + ranges * law.hints().range;
            let cut = CutOff::new(&law, end).unwrap();
            check_law::<f64>(&cut, 1.5 * end).unwrap();
            let scales = |hints: Hints<f64>| (hints.work_of_adhesion, hints.range, hints.rest);
            assert_eq!(scales(cut.hints()), scales(law.hints()));
            let all = |law: &dyn AdhesionLaw<f64>, gap| [law.energy(gap), law.traction(gap), law.slope(gap)];
            // the same in contact, or where it repels
            for gap in [start, 0.9 * start] {
                assert_eq!(all(&cut, gap), all(&law, gap));
            }
            assert_eq!([all(&cut, end), all(&cut, 2.0 * end)], [[0.0; 3]; 2]);
            // it gives its energy back without repelling on the way, and ends smoothly
            let (work, range) = (law.hints().work_of_adhesion, law.hints().range);
            let (near, scale) = (all(&cut, end - 1e-5 * range).map(f64::abs), work / range);
            assert!(near[0] < 1e-9 * work && near[1] < 1e-8 * scale && near[2] < 2e-3 * scale / range, "{near:?}");
            let gaps = (0..1000).map(|i| start + (end - start) * f64::from(i) / 1e3);
            assert!(gaps.map(|gap| cut.traction(gap)).all(|traction| traction >= -1e-12 * scale));
        }
    }
}

#[test]
fn the_largest_traction_of_a_law_that_is_cut_off_is_that_of_the_page() {
    let page = include_str!("../../src/adhesion/cut_off.rs");
    let row = |name: &str| -> Vec<f64> {
        let line = page.lines().find(|line| line.starts_with(&format!("/// | {name}"))).unwrap();
        line.split('|').skip(2).filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    let attractive = Some("exponential, power laws");
    let names = [attractive, Some("Lennard-Jones"), Some("Lennard-Jones"), Some("Morse"), None, attractive];
    for (Both(law, _), name) in laws().iter().zip(names) {
        let Some(name) = name else { continue };
        let expected = row(name);
        assert_eq!(expected.len(), 6);
        for (ranges, expected) in [1.0, 1.5, 2.0, 2.5, 3.0, 4.0].into_iter().zip(expected) {
            let cut = CutOff::new(law, law.hints().rest.unwrap_or(0.0) + ranges * law.hints().range).unwrap();
            let found = largest(&cut) / largest(law);
            // the digits that are written, and the 1.516 to 1.522 of the attractive ones
            assert!((found - expected).abs() < 0.025, "{name} {ranges} {found}");
        }
    }
}

#[test]
fn single_precision_cuts_the_same_law_off() {
    for law in laws() {
        let end = law.0.hints().rest.unwrap_or(0.0) + 2.5 * law.0.hints().range;
        let cut = CutOff::new(law, end).unwrap();
        check_law::<f32>(&cut, 1.5 * end).unwrap();
        let scale = AdhesionLaw::<f64>::hints(&cut).work_of_adhesion / AdhesionLaw::<f64>::hints(&cut).range;
        for i in 0..100 {
            let gap = end * (0.5 + 0.01 * f64::from(i));
            let (a, b): (f64, f32) = (cut.traction(gap), cut.traction(gap as f32));
            assert!((a - f64::from(b)).abs() < 1e-4 * scale, "{a} {b}");
        }
    }
}

#[test]
fn a_cut_off_within_the_attraction_is_refused() {
    let refused = |law: &dyn AdhesionLaw<f64>, distance| match CutOff::new(law, distance) {
        Err(Error::Value { name, value, .. }) => assert_eq!((name, value), ("cut-off distance", distance)),
        other => panic!("{:?}", other.map(|law| law.distance())),
    };
    let (repels, dugdale) = (LennardJones::new(W, RANGE).unwrap(), MaugisDugdale::new(W, RANGE).unwrap());
    for distance in [0.0, -RANGE, f64::NAN, f64::INFINITY] {
        assert!(CutOff::new(dugdale, distance).is_err());
    }
    refused(&dugdale, 0.99 * RANGE);
    refused(&repels, 0.5 * RANGE);
    refused(&repels, 1.9 * RANGE);
    refused(&repels.cut(), 0.9 * RANGE);
    refused(&Exponential::new(W, RANGE).unwrap(), 0.5 * RANGE);
    // numbers as they are typed
    CutOff::new(LennardJones::new(0.05, 0.3e-9).unwrap(), 0.6e-9).unwrap();
    CutOff::new(dugdale, RANGE).unwrap();

    /// An energy that rises from nothing to w.
    #[derive(Debug)]
    struct Lifted;
    impl AdhesionLaw<f64> for Lifted {
        fn energy(&self, gap: f64) -> f64 {
            1.0 - (-gap).exp()
        }
        fn traction(&self, gap: f64) -> f64 {
            (-gap).exp()
        }
        fn slope(&self, gap: f64) -> f64 {
            -(-gap).exp()
        }
        fn hints(&self) -> Hints<f64> {
            Hints::new(1.0, 1.0)
        }
    }
    let error = CutOff::new(Lifted, 3.0).unwrap_err();
    assert!(error.to_string().contains("minus its work of adhesion"), "{error}");
}

#[test]
fn cut_off_and_varying_are_one_law_in_either_order_and_for_one_number() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 2).unwrap();
    let (w, range, end) = (2e-5, 8e-3, 0.02);
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let (control, settings) = (Control::MeanPressure(1e-3), Settings::default().tolerance(1e-8));
    let solve = |law: Box<dyn AdhesionLaw<f64>>| {
        let mut problem = Problem::new(&surface, half_space(grid).unwrap(), law).unwrap();
        let found = Solver::new(settings).solve(&mut problem, control).unwrap().report;
        assert_eq!(found.status, Status::Converged);
        found
    };
    // on coarser grids a map has fewer nodes
    let nested = |law| {
        let nested = Nested::default().coarsest(16);
        let found = nested.solve(&mut Solver::new(settings), &surface, half_space, law, control).unwrap();
        assert!(found.levels.len() > 1);
        found.solution.report
    };
    let close = |a: &Report, b: &Report| {
        let [a, b] = [a, b].map(|report| (report.contact_nodes, report.adhesive_energy));
        assert!(a.0 == b.0 && (a.1 / b.1 - 1.0).abs() < 1e-7, "{a:?} {b:?}");
    };
    let law = Exponential::new(1.0, range).unwrap();
    let maps = [Array2::from_elem((64, 64), w), grid.sample(|x, _| if x < 0.0 { 0.2 * w } else { w })];
    for (number, works) in maps.iter().enumerate() {
        let cut_first = Varying::new(CutOff::new(law, end).unwrap(), works.view()).unwrap();
        let cut_last = CutOff::new(Varying::new(law, works.view()).unwrap(), end).unwrap();
        let found = solve(Box::new(cut_first));
        close(&found, &solve(Box::new(cut_last.clone())));
        close(&found, &nested(cut_last));
        if number == 0 {
            close(&found, &solve(Box::new(CutOff::new(Exponential::new(w, range).unwrap(), end).unwrap())));
        }
    }
}
