//! Whether equilibria are stable, against what is known exactly and against dense matrices.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use asperity::path::{Path, PathSettings};
use asperity::solver::Iteration;
use asperity::stability::{StabilityTest, Verdict};
use asperity::*;
use ndarray::Array2;
use oracles::dense::{Dense, Held};
use oracles::{rough, solve, sphere};

fn tight() -> StabilityTest {
    StabilityTest::default().tolerance(1e-6)
}

fn flat<T: Real>(shape: (usize, usize), law: Exponential) -> Problem<T> {
    let grid = Grid::new(shape, (1.0, if shape.1 == 1 { 1.0 } else { 0.7 })).unwrap();
    let surface = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 2.0).unwrap(), law).unwrap()
}

#[test]
fn flats_at_a_uniform_gap() {
    let (w, range) = (1e-3, 1e-2);
    for shape in [(32, 32), (21, 10), (64, 1), (2, 1)] {
        let mut problem = flat::<f64>(shape, Exponential::new(w, range).unwrap());
        let softest = 2.0 * PI; // πE*/L
        let critical = range * (w / (softest * range * range)).ln();
        for offset in [-0.3, -1e-3, -1e-6, 1e-6, 1e-3, 0.3, 10.0] {
            let gap = critical + offset * range;
            let control = Control::MeanGap(gap);
            let solution = solve(&mut problem, control, 1e-8);
            let stability = tight().run(&mut problem, &solution).unwrap();
            let exact = softest - w / (range * range) * (-gap / range).exp();
            assert!(
                (stability.eigenvalue - exact).abs() < 1e-8,
                "{shape:?} {offset}: {} {exact}",
                stability.eigenvalue
            );
            assert_eq!(stability.verdict, if offset < 0.0 { Verdict::Unstable } else { Verdict::Stable });
            assert!(stability.lower_bound <= exact + 1e-12);
            // at a given pressure the flats move as one, and elasticity does not hold them
            let pulled = StabilityTest::under(Control::MeanPressure(-1e-3)).tolerance(1e-6);
            let stability = pulled.run(&mut problem, &solution).unwrap();
            assert_eq!(stability.verdict, Verdict::Unstable);
            assert!((stability.eigenvalue - (exact - softest)).abs() < 1e-8 * softest);
        }
    }
}

/// How many eigenvalues of the second derivative are below a number: the negative pivots of the dense matrix.
fn below(problem: &Problem<f64>, gap: &Array2<f64>, centred: bool, number: f64) -> usize {
    let dense = Dense::new(problem.grid().shape(), problem.grid().lengths(), 1.0);
    let slopes: Vec<f64> = gap.iter().map(|&gap| problem.law().slope(gap)).collect();
    let free: Vec<usize> = (0..gap.len()).filter(|&i| gap.as_slice().unwrap()[i] > 0.0).collect();
    dense.below(&free, if centred { Held::Shift(0.0) } else { Held::Pressure(0.0) }, &slopes, number)
}

#[test]
fn eigenvalues_and_bounds_agree_with_dense_matrices() {
    let mut seen = [0; 2];
    for (range, w, gaps) in [(4e-3, 4e-4, [0.012, 0.02, 0.03]), (1e-2, 2e-3, [0.03, 0.11, 0.115])] {
        let mut problem = rough::<f64>(24, 6, Exponential::new(w, range).unwrap());
        for gap in gaps {
            let given = Control::MeanGap(gap);
            let solution = solve(&mut problem, given, 1e-8);
            for control in [given, Control::MeanPressure(solution.report.mean_pressure)] {
                let centred = control == given;
                let stability = StabilityTest::under(control).tolerance(1e-6).run(&mut problem, &solution).unwrap();
                let value = stability.eigenvalue;
                assert_eq!(below(&problem, &solution.gap, centred, value - 1e-7), 0, "{control:?} {value}");
                assert!(below(&problem, &solution.gap, centred, value + 1e-7) >= 1, "{control:?} {value}");
                assert!(stability.lower_bound <= value);
                match stability.verdict {
                    Verdict::Stable => {
                        assert!(value > 0.0 && stability.lower_bound > 0.0);
                        assert!(stability.error_bound.unwrap() >= solution.report.relative_error);
                    }
                    Verdict::Unstable => assert!(value < 0.0 && stability.error_bound.is_none()),
                    _ => panic!("{control:?} {value} {}", stability.lower_bound),
                }
                seen[usize::from(value > 0.0)] += 1;
            }
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}

#[test]
fn a_mode_takes_about_twice_as_many_applications_as_the_solve() {
    let mut sums = [0; 3];
    let law = |w, range| Exponential::new(w, range).unwrap();
    let sphere = |w| sphere::<f64>(256, law(w, 2e-3));
    let rough = |w, range| rough::<f64>(256, 32, law(w, range));
    for (mut problem, gap) in [(sphere(2e-4), 0.0429), (rough(4e-4, 2e-3), 0.01), (rough(4e-4, 2e-3), 0.03)] {
        let control = Control::MeanGap(gap);
        let solution = Solver::default().solve(&mut problem, control).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        let stability = StabilityTest::default().run(&mut problem, &solution).unwrap();
        let tight = tight().run(&mut problem, &solution).unwrap();
        assert_eq!(stability.verdict, Verdict::Stable);
        assert!((stability.eigenvalue / tight.eigenvalue - 1.0).abs() < 1e-3);
        let counts =
            [solution.report.operator_applications, stability.operator_applications, stability.bound_applications];
        println!("{gap}: {counts:?} for the solve, the mode and the bound");
        // a count differs between processors by the iteration or two that rounding adds, and between cases by a third
        assert!(counts[1].max(counts[2]) <= 3 * counts[0], "{counts:?}");
        sums = [0, 1, 2].map(|k| sums[k] + counts[k]);
    }
    let [solve, mode, bound] = sums.map(|sum| sum as f64);
    assert!(mode <= 2.1 * solve && bound <= 2.3 * solve, "{sums:?}");
}

#[test]
fn the_certificate_bounds_the_error_of_a_stable_equilibrium() {
    let mut problem = rough::<f64>(64, 16, Exponential::new(4e-4, 4e-3).unwrap());
    let surface = oracles::rough::rough(*problem.grid(), 16, 1);
    let mut operator = Westergaard::<f64>::new(*problem.grid(), 1.0).unwrap();
    let mut larger = 0;
    for control in [Control::MeanGap(0.012), Control::MeanGap(0.03)] {
        let Control::MeanGap(gap) = control else { unreachable!() };
        let beside = solve(&mut problem, Control::MeanGap(1.05 * gap), 1e-6);
        let start = Some(&beside.gap);
        let exact = oracles::solve_from(&mut problem, control, 1e-11, start);
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let rough = oracles::solve_from(&mut problem, control, tolerance, start);
            let stability = StabilityTest::default().run(&mut problem, &rough).unwrap();
            let (error, work, _) = oracles::energy_norms(&surface, &mut operator, &rough.gap, &exact.gap);
            let (error, bound) = ((error / work).sqrt(), stability.error_bound.unwrap());
            assert!(error <= bound, "{error:e} {bound:e}");
            larger += usize::from(error > rough.report.relative_error);
        }
    }
    // what the solve certifies alone is no bound under adhesion
    assert!(larger > 0);
}

#[test]
fn the_memory_layout_of_the_gap_does_not_matter() {
    let mut problem = rough::<f64>(24, 6, Exponential::new(4e-4, 4e-3).unwrap());
    for control in [Control::MeanGap(0.012), Control::MeanGap(0.03)] {
        let solution = solve(&mut problem, control, 1e-8);
        let mut columns = solution.clone();
        columns.gap = solution.gap.t().as_standard_layout().into_owned().reversed_axes();
        assert!(columns.gap == solution.gap && !columns.gap.is_standard_layout());
        let test = StabilityTest::default();
        let rows = test.run(&mut problem, &solution).unwrap();
        assert_eq!(test.run(&mut problem, &columns).unwrap(), rows);
        let mut leave = |from| {
            rows.leave(&mut Solver::default(), &mut problem, from, |_| ControlFlow::Continue(())).unwrap().unwrap()
        };
        assert_eq!(leave(&columns).solution, leave(&solution).solution);
        let start = |gap: &Array2<f64>| gap.mapv(|gap| 1.1 * gap);
        let mut from = |gap: &Array2<f64>| {
            let path = Path::new([control], PathSettings::default()).unwrap();
            path.starting_from(start(gap)).next(&mut Solver::default(), &mut problem).unwrap()
        };
        assert_eq!(from(&columns.gap), from(&solution.gap));
    }
}

#[test]
fn an_observer_ends_a_departure() {
    let grid = Grid::line(64, 1.0).unwrap();
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let (half_space, law) = (Westergaard::<f64>::new(grid, 1.0).unwrap(), Exponential::new(1e-3, 1e-2).unwrap());
    let mut problem = Problem::new(&flat, half_space, law).unwrap();
    let even = Solver::default().solve(&mut problem, Control::MeanGap(0.011)).unwrap();
    let stability = StabilityTest::default().run(&mut problem, &even).unwrap();
    let mut calls = 0;
    let stop = |_: &Iteration| {
        calls += 1;
        ControlFlow::Break(())
    };
    let left = stability.leave(&mut Solver::default(), &mut problem, &even, stop).unwrap().unwrap();
    assert_eq!((left.solution.report.status, calls), (Status::Stopped, 1));
}

#[test]
fn a_law_that_jumps_is_smoothed_for_the_verdict() {
    let law = MaugisDugdale::new(1e-4, 2e-3).unwrap();
    let mut problem = sphere::<f64>(128, law);
    let control = Control::MeanGap(0.0415);
    let solution = solve(&mut problem, control, 1e-6);
    let stability = StabilityTest::default().run(&mut problem, &solution).unwrap();
    assert!(stability.smoothed && stability.verdict == Verdict::Stable);
}

#[test]
fn single_precision_comes_to_the_same() {
    let control = Control::MeanGap(0.03);
    let mut problem = rough::<f32>(64, 16, Exponential::new(4e-4, 4e-3).unwrap());
    let solution = solve(&mut problem, control, 1e-5);
    let single = StabilityTest::default().run(&mut problem, &solution).unwrap();
    let mut problem = rough::<f64>(64, 16, Exponential::new(4e-4, 4e-3).unwrap());
    let solution = solve(&mut problem, control, 1e-5);
    let double = StabilityTest::default().run(&mut problem, &solution).unwrap();
    assert_eq!((single.verdict, double.verdict), (Verdict::Stable, Verdict::Stable));
    assert!((single.eigenvalue / double.eigenvalue - 1.0).abs() < 1e-3);
}

#[test]
fn nothing_can_move_in_full_contact_and_bad_input_is_refused() {
    let mut problem = rough::<f64>(16, 4, Exponential::new(4e-3, 4e-3).unwrap());
    let control = Control::MeanPressure(10.0);
    let solution = solve(&mut problem, control, 1e-6);
    assert_eq!(solution.report.contact_fraction, 1.0);
    let stability = StabilityTest::default().run(&mut problem, &solution).unwrap();
    assert_eq!((stability.verdict, stability.eigenvalue), (Verdict::Stable, f64::INFINITY));
    let left = stability.leave(&mut Solver::default(), &mut problem, &solution, |_| ControlFlow::Continue(()));
    assert!(left.unwrap().is_none());

    let mut other = rough::<f64>(12, 4, NoAdhesion);
    let refused = StabilityTest::default().run(&mut other, &solution);
    assert!(matches!(refused, Err(Error::Shape { name: "solution", .. })));
    let test = StabilityTest::default().tolerance(0.0);
    assert!(matches!(test.run(&mut problem, &solution), Err(Error::Value { name: "tolerance", .. })));
}

#[test]
fn springs_are_part_of_the_second_derivative() {
    // two flats that are pressed into springs of stiffness k: k for the mean, and k + πE*/L for the softest wave
    let stiffness = 7.0;
    let mut problem = flat::<f64>((16, 16), Exponential::new(1e-3, 1e-2).unwrap());
    let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(stiffness).unwrap() };
    let pressed = Control::MeanPressure(0.05);
    let solution = solver.solve(&mut problem, pressed).unwrap();
    assert!(solution.report.min_gap < 0.0);
    let held = Control::MeanGap(solution.report.mean_gap);
    for (control, exact) in [(pressed, stiffness), (held, stiffness + 2.0 * PI)] {
        let test = StabilityTest::under(control).tolerance(1e-6);
        let stability = test.run_with(&mut problem, &solver.constraint, &solution).unwrap();
        assert_eq!(stability.verdict, Verdict::Stable);
        assert!((stability.eigenvalue / exact - 1.0).abs() < 1e-8, "{} {exact}", stability.eigenvalue);
        // a rigid wall leaves no such gap
        let refused = tight().run(&mut problem, &solution);
        assert!(matches!(refused, Err(Error::Unsuited { what: "rigid", .. })), "{refused:?}");
    }
}
