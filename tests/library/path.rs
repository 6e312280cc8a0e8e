//! Branches of equilibria: where they break off, what that dissipates, and what exact solutions say.

mod bifurcations;
mod pull_off;
mod resumption;

use std::ops::ControlFlow;

use asperity::path::{Event, Jump, Path, PathSettings, PathStep};
use asperity::stability::{StabilityTest, Verdict};
use asperity::surface::Amplitude;
use asperity::*;
use oracles::{Checkpoint, check, followed, rough, sphere};

/// Two equal waves, or nearly so.
fn two_waves(n: usize, asymmetry: f64) -> Problem<f64> {
    let grid = Grid::line(n, 1.0).unwrap();
    let turn = 2.0 * std::f64::consts::PI;
    let height = |x: f64, _| 0.01 * ((2.0 * turn * x).cos() + asymmetry * (turn * x).cos());
    let surface = Surface::from_fn(grid, height).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), Exponential::new(1.5e-4, 2.5e-3).unwrap()).unwrap()
}

/// One wave of a line, with Johnson's α = 0.2.
const AMPLITUDE: f64 = 0.02;

fn wave(n: usize, range: f64) -> Problem<f64> {
    let grid = Grid::line(n, 1.0).unwrap();
    let surface = Surface::wave(grid, AMPLITUDE, 1).unwrap();
    let law = Exponential::new(0.5 * (0.2 * std::f64::consts::PI * AMPLITUDE).powi(2), range).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

fn gaps(values: &[f64]) -> Vec<Control> {
    values.iter().copied().map(Control::MeanGap).collect()
}

fn pressures(values: &[f64]) -> Vec<Control> {
    values.iter().copied().map(Control::MeanPressure).collect()
}

#[track_caller]
fn follow(
    problem: &mut Problem<f64>,
    loads: Vec<Control>,
    settings: PathSettings,
    tolerance: f64,
) -> Vec<PathStep<f64>> {
    let mut solver = Solver::new(Settings::default().tolerance(tolerance));
    let steps = followed(Path::new(loads, settings).unwrap(), &mut solver, problem);
    for step in &steps {
        assert_eq!(step.solution.report.status, Status::Converged, "{:?} {:?}", step.solution.report, step.event);
        check(&step.solution);
    }
    steps
}

fn jumps(steps: &[PathStep<f64>]) -> Vec<Jump> {
    let jump = |step: &PathStep<f64>| match step.event {
        Some(Event::Jump(jump)) => Some(jump),
        _ => None,
    };
    steps.iter().filter_map(jump).collect()
}

fn names<T: Real>(steps: &[PathStep<T>]) -> Vec<&'static str> {
    steps.iter().filter_map(|step| step.event.as_ref().map(Event::name)).collect()
}

fn energy(step: &PathStep<f64>) -> f64 {
    step.solution.report.elastic_energy + step.solution.report.adhesive_energy
}

#[test]
fn jumps_are_found_where_they_are_however_long_the_steps() {
    let mut found: Vec<Vec<Jump>> = Vec::new();
    let smallest_steps = [1e-2, 1e-3, 1e-4, 1e-5];
    for smallest_step in smallest_steps {
        let settings = PathSettings::default().smallest_step(smallest_step);
        let steps = follow(&mut wave(128, 2e-3), gaps(&[0.03, 0.015, 0.03]), settings, 1e-6);
        assert_eq!(names(&steps), ["jump-in", "pull-off"]);
        found.push(jumps(&steps));
    }
    for k in 0..2 {
        let last = found[3][k];
        for (jumps, smallest_step) in found.iter().zip(smallest_steps) {
            let jump = jumps[k];
            let width = (jump.mean_gap.1 - jump.mean_gap.0).abs();
            assert!(width <= 1.001 * smallest_step * 0.015);
            // within its own width, and the width of a step at which the branch before it is lost
            assert!((jump.mean_gap.0 - last.mean_gap.0).abs() <= 3.0 * width, "{jump:?} {last:?}");
            let unsure = width * (jump.mean_pressure.1 - jump.mean_pressure.0).abs();
            assert!((jump.energy_drop - last.energy_drop).abs() <= 2.0 * unsure);
        }
    }
}

#[test]
fn corners_of_the_load_are_no_jumps() {
    // where two nodes of the coarse grid come into contact, the load has a corner, with as large a load on either side
    let grid = Grid::line(64, 1.0).unwrap();
    let surface = Surface::wave(grid, AMPLITUDE, 1).unwrap();
    let law = Exponential::new(1e-3, 8e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
    for (steps, imbalance) in [7, 10, 15, 25].iter().flat_map(|steps| [1e-5, 3e-5, 1e-4].map(|share| (*steps, share))) {
        let settings = PathSettings::default().steps(steps).imbalance(imbalance);
        // the tolerance that a path has by itself with that imbalance
        let found = follow(&mut problem, gaps(&[0.08, 0.01, 0.08]), settings, 0.01 * imbalance.sqrt());
        assert_eq!(names(&found), ["jump-in", "pull-off"], "{steps} {imbalance}");
    }
}

#[test]
fn steps_that_are_loosely_balanced_do_not_miss_the_largest_tension() {
    let amplitude = Amplitude::RmsHeight(6e-3);
    let profile = SelfAffine::default().k_s(32.0).hurst(0.8).amplitude(amplitude);
    let largest = |seed, imbalance| {
        let grid = Grid::line(2048, 1.0).unwrap();
        let surface = profile.seed(seed).surface(grid).unwrap();
        let law = Exponential::new(1e-4, 1e-3).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
        let settings = PathSettings::default().imbalance(imbalance);
        let steps = follow(&mut problem, gaps(&[0.04, 0.004, 0.04]), settings, 1e-4);
        steps.iter().map(|step| -step.solution.report.mean_pressure).fold(0.0, f64::max)
    };
    for seed in [51, 52] {
        let [loose, close] = [1e-3, 1e-5].map(|imbalance| largest(seed, imbalance));
        assert!((loose / close - 1.0).abs() < 0.02, "{seed}: {loose:e} {close:e}");
    }
}

#[test]
fn energy_is_balanced_over_a_cycle() {
    let settings = PathSettings::default().imbalance(1e-11);
    let mut problem = wave(256, 2e-3);
    let steps = follow(&mut problem, gaps(&[0.03, 0.012, 0.03]), settings, 1e-10);
    let (first, last) = (&steps[0], &steps[steps.len() - 1]);
    let largest = steps.iter().map(|step| step.work.abs()).fold(0.0, f64::max);
    for step in &steps {
        let change = energy(step) - energy(first);
        assert!((step.work - step.dissipated - change).abs() <= 1e-6 * largest);
        assert!((step.work - step.dissipated - change + step.imbalance).abs() <= 1e-12 * largest);
    }
    // back where it began, and what the load has done is lost, to a few times what each step may be out of balance. Those
    // of the smallest length, next to a jump, are taken as they are: by half of how far their work may lie apart
    let energies = || steps.iter().map(energy);
    let range = energies().fold(f64::NEG_INFINITY, f64::max) - energies().fold(f64::INFINITY, f64::min);
    let apart = |three: &[PathStep<f64>]| {
        let [before, after] = [0, 1].map(|k| &three[k].solution.report);
        let width = (after.mean_gap - before.mean_gap).abs();
        let taken = three[1].event.is_none() && three[2].event.is_some() && width <= 1.01e-4 * 0.018;
        if taken { width * (after.mean_pressure - before.mean_pressure).abs() } else { 0.0 }
    };
    let taken: f64 = steps.windows(3).map(apart).sum();
    let allowed = 5e-11 * (range + 20.0 * last.dissipated) * steps.len() as f64 + 0.5 * taken;
    assert!((energy(last) - energy(first)).abs() <= 1e-9 * largest);
    assert!((last.work - last.dissipated).abs() <= allowed && last.dissipated > 0.0, "{allowed:e}");
}

#[test]
fn the_share_of_the_way_grows_from_nothing_to_all() {
    for (loads, grows) in [(gaps(&[0.03, 0.015, 0.03]), true), (pressures(&[6e-3, -0.1]), false)] {
        let (mut solver, mut problem) = (Solver::default(), wave(128, 2e-3));
        let mut path = Path::new(loads, PathSettings::default().steps(20)).unwrap();
        let mut shares = vec![path.share()];
        while path.next(&mut solver, &mut problem).unwrap().is_some() {
            shares.push(path.share());
        }
        assert_eq!((&shares[..2], shares.last()), (&[0.0; 2][..], Some(&1.0)));
        assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
        // under a pressure it may fall past a limit point
        assert!(!grows || shares[1..].is_sorted(), "{shares:?}");
        path.end_leg();
        assert_eq!(path.share(), 1.0);
    }
}

#[test]
fn a_pressure_leads_to_limit_points_and_the_gap_past_them() {
    let mut problem = wave(128, 2e-3);
    let settings = PathSettings::default().smallest_step(1e-4);
    let given_gap = follow(&mut problem, gaps(&[0.012, 0.03]), settings, 1e-6);
    let least = |steps: &[PathStep<f64>]| {
        steps.iter().map(|step| step.solution.report.mean_pressure).fold(f64::INFINITY, f64::min)
    };
    let steps = follow(&mut problem, pressures(&[6e-3, -0.1]), settings, 1e-6);
    assert_eq!(names(&steps), ["limit-point", "pull-off"]);
    // the steps by the gap pass the limit point at a distance of theirs, on a curve that the grid ripples
    assert!((least(&steps) / least(&given_gap) - 1.0).abs() < 5e-3);
    let Some(Event::LimitPoint { mean_pressure, .. }) = steps.iter().find_map(|step| step.event) else { panic!() };
    assert!((mean_pressure - least(&steps)).abs() <= 3.0 * 1e-4 * 0.106);
    let last = &steps[steps.len() - 1].solution.report;
    assert!(last.contact_nodes == 0 && last.mean_pressure.abs() < 1e-3 * mean_pressure.abs());

    // and to a pressure beyond the one from which the contact closes
    let steps = follow(&mut problem, pressures(&[6e-3, 0.05]), settings, 1e-6);
    let last = &steps[steps.len() - 1].solution.report;
    assert_eq!((last.mean_pressure, last.contact_fraction), (0.05, 1.0));
    assert_eq!(names(&steps)[0], "limit-point");
}

#[test]
fn stability_is_lost_at_a_limit_point() {
    let mut problem = wave(128, 2e-3);
    let steps = follow(&mut problem, gaps(&[0.021, 0.026]), PathSettings::default().smallest_step(1e-4), 1e-6);
    let least = steps.iter().map(|step| step.solution.report.mean_pressure).fold(f64::INFINITY, f64::min);
    let turn = steps.iter().position(|step| step.solution.report.mean_pressure == least).unwrap();
    let pull_off = steps.iter().position(|step| step.event.is_some()).unwrap();
    assert!(turn > 8 && turn + 8 < pull_off);
    for (k, step) in steps.iter().enumerate().take(pull_off) {
        let verdict = |problem: &mut _, control| StabilityTest::under(control).run(problem, &step.solution).unwrap();
        let held = verdict(&mut problem, step.solution.report.control);
        assert_eq!(held.verdict, Verdict::Stable, "{k}");
        let loaded = verdict(&mut problem, Control::MeanPressure(step.solution.report.mean_pressure));
        if k.abs_diff(turn) > 4 {
            let expected = if k < turn { Verdict::Stable } else { Verdict::Unstable };
            assert_eq!(loaded.verdict, expected, "{k} {turn} {} {}", loaded.eigenvalue, loaded.lower_bound);
        }
    }
    // left alone under its load, the state just past the limit point comes apart or together
    let step = &steps[turn + 6];
    let control = Control::MeanPressure(step.solution.report.mean_pressure);
    let saddle = StabilityTest::under(control).run(&mut problem, &step.solution).unwrap();
    let left = saddle
        .leave(&mut Solver::default(), &mut problem, &step.solution, |_| ControlFlow::Continue(()))
        .unwrap()
        .unwrap();
    assert!(left.energy_drop > 0.0 && left.distance > 0.0);
}

#[test]
fn without_adhesion_a_path_is_there_and_back() {
    let mut problem = rough::<f64>(48, 12, NoAdhesion);
    for loads in [gaps(&[0.03, 0.01, 0.03]), pressures(&[0.01, 0.1, 0.01])] {
        let steps = follow(&mut problem, loads, PathSettings::default(), 1e-7);
        assert!(names(&steps).is_empty());
        let (first, last) = (&steps[0], &steps[steps.len() - 1]);
        let largest = steps.iter().map(|step| step.work).fold(0.0, f64::max);
        assert!(last.work.abs() < 1e-3 * largest && last.dissipated == 0.0);
        assert!((first.solution.report.mean_pressure / last.solution.report.mean_pressure - 1.0).abs() < 1e-5);
        assert_eq!(steps.iter().map(|step| step.leg).max(), Some(2));
    }
}

#[test]
fn without_adhesion_a_path_strides_to_first_contact() {
    let (mut problem, peak) = (rough::<f64>(48, 12, NoAdhesion), 0.05);
    let settings = PathSettings::default();
    let steps = follow(&mut problem, gaps(&[20.0 * peak, 0.5 * peak]), settings, 1e-6);
    let touches = |step: &&PathStep<f64>| step.solution.report.contact_nodes > 0;
    assert!(names(&steps).is_empty() && steps.last().is_some_and(|last| touches(&last)));
    // mostly the longest steps: of the smallest ones a leg has ten thousand
    let apart = steps.iter().take_while(|step| !touches(step)).count();
    assert!(apart < 2 * settings.steps, "{apart}");
}

/// The numbers of states on a path into contact and out of it, in which nothing happens, and of those that have stalled.
fn there_and_back<T: Real>(n: usize, w: f64) -> (usize, usize) {
    let mut problem = rough::<T>(n, n as i32 / 4, Exponential::new(w, 4e-3).unwrap());
    let mut solver = Solver::default();
    let path = Path::new(gaps(&[0.2, 0.02, 0.2]), PathSettings::default()).unwrap();
    let steps = followed(path, &mut solver, &mut problem);
    assert!(names(&steps).is_empty());
    let count = |status| steps.iter().filter(|step| step.solution.report.status == status).count();
    assert_eq!(count(Status::Converged) + count(Status::Stalled), steps.len());
    (steps.len(), count(Status::Stalled))
}

#[test]
fn a_path_does_not_creep_where_its_states_are_at_the_floor_of_rounding() {
    let (double, single) = (there_and_back::<f64>(64, 1e-4), there_and_back::<f32>(64, 1e-4));
    // a tenth more, as rounding differs between processors
    assert!(double.0 <= 217 && double.1 == 0, "{double:?} and not (197, 0)");
    assert!(single.0 <= 141 && (1..=8).contains(&single.1), "{single:?} and not (128, 4)");
    // the energy of adhesion is less than a hundred roundings of the energy of the surface pressed flat
    let weak = there_and_back::<f32>(128, 1e-6);
    assert!(weak.0 <= 135 && weak.1 <= 10, "{weak:?} and not (123, 5)");
}

#[test]
fn bad_settings_loads_and_grids_are_refused() {
    let (mut solver, mut problem) = (Solver::default(), wave(16, 4e-3));
    let good = PathSettings::default();
    let name = |result: Result<_>| match result {
        Err(Error::Value { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    let load = gaps(&[0.03]);
    let refused = |settings| name(Path::<f64>::new(load.clone(), settings).map(|_| ()));
    assert_eq!(refused(good.steps(0)), "number of steps");
    assert_eq!(refused(good.imbalance(-1.0)), "imbalance");
    assert_eq!(refused(good.smallest_step(1.0)), "smallest step");
    for (loads, expected) in [(gaps(&[0.03, -1.0]), "mean gap"), (pressures(&[f64::NAN]), "mean pressure")] {
        let mut path = Path::new(loads, good).unwrap();
        assert_eq!(name(path.check(&solver, &problem)), expected);
        assert_eq!(name(path.next(&mut solver, &mut problem).map(|_| ())), expected);
        assert_eq!(path.next(&mut solver, &mut problem).unwrap(), None);
    }
    assert_eq!(Path::new([], good).unwrap().next(&mut solver, &mut problem).unwrap(), None);
    let mut path = Path::new(load.clone(), good).unwrap();
    assert!(path.next(&mut solver, &mut problem).unwrap().is_some());
    assert_eq!(path.next(&mut solver, &mut problem).unwrap(), None);
    let refused = path.next(&mut solver, &mut wave(32, 4e-3));
    assert!(matches!(refused, Err(Error::Shape { name: "field of the path", .. })), "{refused:?}");
}
