//! Regressions, by name.

use std::ops::ControlFlow;

use asperity::*;
use ndarray::Array2;

use super::{bare, in_both_precisions, loose, problem};

in_both_precisions!(
    planes_stay_at_a_mean_gap_from_any_start,
    the_papers_algorithm_survives_the_clipping_of_every_node,
    the_papers_algorithm_does_not_overflow_on_a_plane,
    a_single_node_lands_from_far_away,
    springs_and_multipliers_keep_a_mean_gap_of_zero,
    a_step_under_a_light_pressure_lands_on_all_of_its_plateau,
);

fn solve_from<T: Real, C: ContactConstraint<T> + 'static>(
    solver: &mut Solver<C>,
    problem: &mut Problem<T>,
    control: Control,
    start: Option<&Array2<f64>>,
) -> Solution<T> {
    let start = start.map(|start| start.mapv(T::lit));
    let start = start.as_ref().map_or(Start::Default, |start| Start::From(start));
    solver.solve_with(problem, control, start, |_| ControlFlow::Continue(())).unwrap()
}

/// Only rounding makes waves in a plane, and errors must not be related to rounding.
fn planes_stay_at_a_mean_gap_from_any_start<T: Real>() {
    // in f32 the heights of the 285 nodes are their own rounding: an error of 1.3e-3
    let settings = Settings::default().tolerance(if T::NAME == "f32" { 2e-3 } else { 1e-6 });
    for shape in [(285, 1), (1, 25), (6, 5)] {
        for height in [8.04e-11, 1.04, -3e5] {
            for start in [None, Some(Array2::zeros(shape)), Some(Array2::from_elem(shape, 0.3))] {
                let mut plane = problem::<T>(shape, (1.07, 20.9), |_, _| height, bare());
                let control = Control::MeanGap(1.7e-5);
                let solution = solve_from(&mut Solver::new(settings), &mut plane, control, start.as_ref());
                let report = &solution.report;
                assert_eq!(report.status, Status::Converged, "{shape:?} {height}: {report:?}");
                let off = |g: &T| (g.widen() - 1.7e-5).abs();
                assert!(solution.gap.iter().all(|g| off(g) <= 1e3 * T::epsilon().widen() * 1.7e-5));
            }
        }
    }
}

fn paper(tolerance: f64) -> Solver {
    Solver::new(Settings::rey2017().tolerance(tolerance))
}

/// A step that leaves no node apart keeps the mean gap.
fn the_papers_algorithm_survives_the_clipping_of_every_node<T: Real>() {
    let levels = [[2, 2, 2], [0, 1, 2], [1, 0, 2], [2, 1, 2], [0, 2, 0]];
    let height = |i: usize, j: usize| 4.17e-7 * f64::from(levels[i][j]);
    let start = Array2::from_shape_fn((5, 3), |(i, j)| f64::from(u8::from(levels[i][j] == 0)) * 2.5e-7);
    let mut problem = problem::<T>((5, 3), (0.675, 2.26), height, bare());
    for gap in [7.7e-9, 1e-12, 1e-7] {
        let solution = solve_from(&mut paper(1e-4), &mut problem, Control::MeanGap(gap), Some(&start));
        let report = &solution.report;
        assert_eq!(report.status, Status::Converged, "{gap}: {:e}", report.relative_error);
        assert!((report.mean_gap - gap).abs() <= 64.0 * T::epsilon().widen() * gap);
    }
}

/// Where the residual is all rounding, ratios of its norms exceed every number.
fn the_papers_algorithm_does_not_overflow_on_a_plane<T: Real>() {
    let start = Array2::from_shape_vec((2, 2), vec![5.8e-4, 1.66e-4, 4.68e-4, 1.75e-4]).unwrap();
    let mut plane = problem::<T>((2, 2), (2.35e-3, 6.85e-3), |_, _| 1.57e-4, bare());
    let solution = solve_from(&mut paper(1e-5), &mut plane, Control::MeanGap(2.69e-6), Some(&start));
    assert!(solution.gap.iter().chain(&solution.pressure).all(|x| x.is_finite()));
    assert!(solution.gap.iter().all(|g| (g.widen() - 2.69e-6).abs() <= 1e-3 * 2.69e-6));
    // in f32 the residual is nothing but rounding, and may be above the tolerance or below
    assert!(solution.report.status == Status::Converged || T::NAME == "f32");
}

/// No wave tells how far a node has to go that is alone.
fn a_single_node_lands_from_far_away<T: Real>() {
    for (start, load) in [(2.45e-4, 7.3e3), (1e6, 1e-3), (1e-9, 1e9)] {
        let mut alone = problem::<T>((1, 1), (2.4e-4, 7.9e-6), |_, _| 3.4e-4, bare());
        let start = Array2::from_elem((1, 1), start);
        let solution = solve_from(&mut Solver::default(), &mut alone, Control::MeanPressure(load), Some(&start));
        let report = &solution.report;
        assert_eq!((report.status, report.contact_nodes), (Status::Converged, 1), "{load}");
        assert!(report.iterations <= 3, "{load}: {}", report.iterations);
    }
}

/// Gaps of both signs may have no mean to be scaled by; and under a tension that nothing holds the surfaces part.
fn springs_and_multipliers_keep_a_mean_gap_of_zero<T: Real>() {
    springs::<T, _>(Penalty::new(5000.0).unwrap());
    springs::<T, _>(Uzawa::new(200.0).unwrap());
}

fn springs<T: Real, C: ContactConstraint<T> + 'static>(constraint: C) {
    let wave = |i: usize, j: usize| 0.02 * (std::f64::consts::TAU * (i + 2 * j) as f64 / 16.0).cos();
    let settings = Settings::default().tolerance(loose::<T>());
    let mut solver = Solver { settings, constraint };
    for start in [None, Some(Array2::from_shape_fn((16, 16), |(i, _)| if i % 2 == 0 { 1e-3 } else { -1e-3 }))] {
        let mut problem = problem::<T>((16, 16), (1.0, 1.0), wave, bare());
        let report = solve_from(&mut solver, &mut problem, Control::MeanGap(0.0), start.as_ref()).report;
        assert_eq!(report.status, Status::Converged);
        // multipliers that a rigid wall has found leave no gap at all
        assert!(report.mean_gap.abs() < 8.0 * T::epsilon().widen() * 0.02 && report.min_gap <= 0.0);
        let lost = solve_from(&mut solver, &mut problem, Control::MeanPressure(-1e-3), None).report;
        assert_eq!((lost.status, lost.contact_nodes), (Status::Detached, 0));
    }
}

/// The last change carried the whole plateau far through the other surface, for which trial steps were shortened below
/// the last digits of the gaps.
fn a_step_under_a_light_pressure_lands_on_all_of_its_plateau<T: Real>() {
    let step = |i: usize, _: usize| if i < 4 { 0.0086 } else { 0.0 };
    let mut problem = problem::<T>((7, 2), (59.6, 92.7), step, bare());
    // 1.9e4 times the modulus of one that the other tests have
    let control = Control::MeanPressure(1.064e-3 / 1.94e4);
    let tolerance = if T::NAME == "f64" { 1e-8 } else { 1e-2 };
    let mut solver = Solver::new(Settings::default().tolerance(tolerance));
    let report = solve_from(&mut solver, &mut problem, control, None).report;
    assert_eq!(report.status, Status::Converged, "{report:?}");
    assert_eq!(report.contact_nodes, 8);
    assert!(report.iterations < 60, "{}", report.iterations);
}

#[test]
fn more_nodes_than_numbers_are_refused() {
    for shape in [(usize::MAX, 2), (2, usize::MAX), (1 << 40, 1 << 40)] {
        assert!(matches!(Grid::new(shape, (1.0, 1.0)), Err(Error::Value { name: "number of nodes", .. })));
    }
}
