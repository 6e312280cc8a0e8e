//! Branches through saddles.

use super::*;

/// The jumps and bifurcations that dissipate more than `least`, the imbalance that a step may have.
fn drops(steps: &[PathStep<f64>], least: f64) -> Vec<Jump> {
    let jumps = steps.iter().filter_map(|step| step.event.as_ref()?.jump().copied());
    jumps.filter(|jump| jump.energy_drop > least).collect()
}

#[track_caller]
fn are_the_same(found: &[Jump], expected: &[Jump], width: f64, node: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        // to the step at which the branch is lost in each, and as nodes are pinned
        assert!((a.mean_gap.0 - b.mean_gap.0).abs() <= 5.0 * width, "{a:?} {b:?}");
        let (a, b) = (a.contact_fraction, b.contact_fraction);
        assert!((a.0 - b.0).abs() <= 4.0 * node && (a.1 - b.1).abs() <= 4.0 * node, "{a:?} {b:?}");
    }
}

#[test]
fn two_equal_waves_come_into_contact_one_after_the_other() {
    for n in [128, 64] {
        let follow = |asymmetry, steps| {
            let settings = PathSettings::default().steps(steps).smallest_step(1e-4);
            follow(&mut two_waves(n, asymmetry), gaps(&[0.03, 0.008, 0.03]), settings, 1e-6)
        };
        let w = 1.5e-4;
        let (width, least) = (1e-4 * 0.022, 1e-3 * w);
        let uneven = follow(1e-6, 50);
        let expected = drops(&uneven, least);
        assert_eq!(expected.len(), 4, "{:?}", names(&uneven));
        let dissipated = uneven[uneven.len() - 1].dissipated;
        for steps in [10, 50, 200] {
            let found = follow(0.0, steps);
            assert_eq!(names(&found)[0], "bifurcation");
            assert_eq!(names(&found).last(), Some(&"pull-off"));
            are_the_same(&drops(&found, least), &expected, width, 1.0 / n as f64);
            let last = &found[found.len() - 1];
            assert!((last.dissipated / dissipated - 1.0).abs() < 1e-2, "{} {dissipated}", last.dissipated);
            // a closed cycle
            assert!((last.work - last.dissipated + last.imbalance).abs() < 1e-3 * w);
        }
    }
}

#[test]
fn energy_is_balanced_through_a_bifurcation() {
    let settings = PathSettings::default().imbalance(1e-8);
    let steps = follow(&mut two_waves(256, 0.0), gaps(&[0.03, 0.01, 0.03]), settings, 1e-9);
    let bifurcation = steps.iter().position(|step| matches!(step.event, Some(Event::Bifurcation { .. }))).unwrap();
    let Some(Event::Bifurcation { eigenvalue, jump }) = steps[bifurcation].event else { unreachable!() };
    let (before, after) = (&steps[bifurcation - 1], &steps[bifurcation]);
    assert!(eigenvalue < 0.0 && jump.energy_drop > 0.0);
    assert!((jump.mean_gap.1 / after.solution.report.mean_gap - 1.0).abs() < 1e-14);
    let test = StabilityTest::default();
    let mut problem = two_waves(256, 0.0);
    for step in [before, after] {
        let stability = test.run(&mut problem, &step.solution).unwrap();
        assert_eq!(stability.verdict, Verdict::Stable, "{}", stability.eigenvalue);
    }
    // the symmetry is gone
    let gap = &after.solution.gap;
    let half = gap.len() / 2;
    let contact = |from: usize| (from..from + half).filter(|i| gap[[(i + 192) % 256, 0]] == 0.0).count();
    assert_eq!((contact(0) > 0, contact(half) > 0), (true, false), "at the first of the two");
    let (first, last) = (&steps[0], &steps[steps.len() - 1]);
    let largest = steps.iter().map(|step| step.work.abs()).fold(0.0, f64::max);
    for step in &steps {
        let change = energy(step) - energy(first);
        assert!((step.work - step.dissipated - change).abs() <= 1e-5 * largest);
        assert!((step.work - step.dissipated - change + step.imbalance).abs() <= 1e-12 * largest);
    }
    let lost: f64 = drops(&steps, 0.0).iter().map(|jump| jump.energy_drop).sum();
    assert!((last.dissipated / lost - 1.0).abs() < 1e-9 && (last.work / lost - 1.0).abs() < 1e-3);
}

#[test]
fn a_mirrored_map_comes_into_contact_on_one_side_first() {
    let grid = Grid::new((32, 16), (1.0, 0.5)).unwrap();
    let turn = 2.0 * std::f64::consts::PI;
    let follow = |asymmetry: f64, steps| {
        // mirrored at x = 0, of two unlike halves along y
        let height = |x: f64, y: f64| {
            let across = -(2.0 * turn * x).cos() + 0.1 * (turn * x).cos() + asymmetry * (turn * x).sin();
            0.003 * (across + (2.0 * turn * y).cos() + 0.1 * (4.0 * turn * y).sin())
        };
        let (surface, law) = (Surface::from_fn(grid, height).unwrap(), Exponential::new(4e-4, 4e-3).unwrap());
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        let settings = PathSettings::default().steps(steps).smallest_step(1e-4);
        follow(&mut problem, gaps(&[0.05, 0.005]), settings, 1e-6)
    };
    let expected = drops(&follow(1e-6, 50), 4e-7);
    assert!(expected.len() > 2);
    for steps in [10, 50, 200] {
        let found = follow(0.0, steps);
        assert_eq!(names(&found)[0], "bifurcation");
        are_the_same(&drops(&found, 4e-7), &expected, 1e-4 * 0.045, 1.0 / 512.0);
    }
}

#[test]
fn a_symmetry_breaks_where_the_law_is_smoothed_and_where_the_pressure_is_given() {
    let grid = Grid::line(128, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.01, 2).unwrap();
    let law = MaugisDugdale::new(1e-4, 2.5e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let mut solver = Solver::default();
    let path = Path::new(gaps(&[0.03, 0.008, 0.03]), PathSettings::default()).unwrap();
    let steps = followed(path, &mut solver, &mut problem);
    assert!(names(&steps).contains(&"bifurcation"));

    // to where the pressure is reached beyond the bifurcation
    let loads = [gaps(&[0.03]), pressures(&[0.01])].concat();
    let steps = follow(&mut two_waves(128, 0.0), loads, PathSettings::default(), 1e-6);
    assert_eq!(names(&steps)[..2], ["limit-point", "bifurcation"]);
    let by_gap = follow(&mut two_waves(128, 0.0), gaps(&[0.03, 0.008]), PathSettings::default(), 1e-6);
    let [by_pressure, by_gap] = [steps, by_gap].map(|steps| drops(&steps, 1.5e-7)[0]);
    assert!((by_pressure.mean_gap.0 - by_gap.mean_gap.0).abs() < 1e-5, "{by_pressure:?} {by_gap:?}");
}

#[test]
fn no_symmetry_breaks_where_there_is_none() {
    let law = Exponential::new(4e-4, 5e-3).unwrap();
    for seed in [3, 4] {
        let grid = Grid::square(32, 1.0).unwrap();
        let amplitude = Amplitude::RmsHeight(0.01);
        let rough = SelfAffine::default().k_l(1.0).k_r(1.0).k_s(8.0).amplitude(amplitude).seed(seed);
        let surface = rough.surface(grid).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        let steps = follow(&mut problem, gaps(&[0.06, 0.008, 0.06]), PathSettings::default(), 1e-6);
        assert!(!names(&steps).contains(&"bifurcation"), "{:?}", names(&steps));
    }
    // two waves that are not quite equal jump as any others
    let steps = follow(&mut two_waves(128, 0.01), gaps(&[0.03, 0.008, 0.03]), PathSettings::default(), 1e-6);
    assert!(!names(&steps).contains(&"bifurcation") && drops(&steps, 1.5e-7).len() == 4, "{:?}", names(&steps));
}
