//! The meaning of "converged" under the lightest loads, under tension, and at the end of a solve.
//!
//! `cargo test --release --test library light_loads::floors -- --ignored --nocapture` prints how accurate light loads
//! get.

use std::ops::ControlFlow;

use asperity::solver::Iteration;
use asperity::*;
use ndarray::Array2;

use oracles::dense::Dense;

fn solved<T: Real>(heights: &Array2<f64>, control: Control, tolerance: f64) -> Solution<T> {
    let grid = Grid::new(heights.dim(), (1.0, 1.0)).unwrap();
    let surface = Surface::new(grid, heights.clone()).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    Solver::new(Settings::default().tolerance(tolerance)).solve(&mut problem, control).unwrap()
}

/// Heights without any order, of unit size.
fn noise(n: usize) -> Array2<f64> {
    Array2::from_shape_fn((n, 1), |(i, _)| ((i * i * 7919 + 31 * i) % 1009) as f64 / 1009.0)
}

fn paraboloid(n: usize) -> Array2<f64> {
    let x = |i: usize| i as f64 / n as f64 - 0.5;
    Array2::from_shape_fn((n, n), |(i, j)| -x(i).powi(2) - x(j).powi(2))
}

fn rough(n: usize) -> Array2<f64> {
    let grid = Grid::square(n, 1.0).unwrap();
    SelfAffine::default().k_s(n as f64 / 4.0).surface(grid).unwrap().heights().clone()
}

/// The certified error of a gap as it is, in `f64`.
fn seen_in_f64(heights: &Array2<f64>, gap: &Array2<f64>) -> f64 {
    let grid = Grid::new(heights.dim(), (1.0, 1.0)).unwrap();
    let surface = Surface::new(grid, heights.clone()).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut solver = Solver::new(Settings::default().max_iterations(0).tolerance(1e-30));
    let go_on = |_: &Iteration| ControlFlow::Continue(());
    let as_it_is = Control::MeanGap(gap.mean().unwrap());
    solver.solve_with(&mut problem, as_it_is, Start::From(gap), go_on).unwrap().report.relative_error
}

#[test]
fn a_light_load_is_carried_or_not_called_converged() {
    for heights in [noise(61), paraboloid(32), rough(64)] {
        for exponent in 0..15 {
            let load = 10_f64.powi(-exponent);
            let control = Control::MeanPressure(load);
            for report in [solved::<f64>(&heights, control, 1e-6).report, solved::<f32>(&heights, control, 1e-3).report]
            {
                let what = format!("{load:e} {} {report:?}", report.precision);
                let tolerance = if report.precision == "f64" { 1e-6 } else { 1e-3 };
                let missed = (report.net_pressure / load - 1.0).abs();
                if report.status == Status::Converged {
                    assert!(report.contact_nodes > 0 && missed <= 1.01 * tolerance, "{missed:e} {what}");
                    assert!((report.mean_contact_pressure / load - 1.0).abs() <= 1.01 * tolerance, "{what}");
                } else {
                    assert!(report.relative_error.max(report.load_error) > tolerance, "{what}");
                }
                assert!(report.load_error >= 0.99 * missed.min(1.0), "{missed:e} {what}");
                assert!(report.mean_gap < 10.0, "{what}");
            }
        }
    }
}

#[test]
fn f64_solves_loads_down_to_a_contact_of_one_node() {
    for exponent in 3..12 {
        let report = solved::<f64>(&rough(64), Control::MeanPressure(10_f64.powi(-exponent)), 1e-6).report;
        assert_eq!(report.status, Status::Converged, "{report:?}");
        assert!(exponent < 9 || report.contact_nodes == 1);
    }
}

/// One node in contact carries all of a light load: its energy is half the load times what its place gives way,
/// exactly.
#[test]
fn the_energy_of_a_contact_of_one_node_is_exact() {
    let heights = paraboloid(16);
    let dense = Dense::new((16, 16), (1.0, 1.0), 1.0);
    for load in [1e-7, 1e-9, 1e-11] {
        let Solution { gap, report, .. } = solved::<f64>(&heights, Control::MeanPressure(load), 1e-5);
        assert_eq!(report.contact_nodes, 1);
        let force: Vec<f64> = gap.iter().map(|&g| if g == 0.0 { 256.0 * load } else { 0.0 }).collect();
        let exact = 0.5 * dense.compliant(&force.iter().map(|f| f - load).collect::<Vec<_>>());
        assert!((report.elastic_energy / exact - 1.0).abs() < 4e-5, "{load:e}: {:e} {exact:e}", report.elastic_energy);
    }
}

/// The error of `f32` under a light load, as it is when its gap is looked at in `f64`.
#[test]
fn f32_claims_no_less_under_a_light_load_than_it_is_wrong_by() {
    let heights = paraboloid(32);
    for load in [1e-4, 1e-5, 5e-7] {
        let Solution { gap, report, .. } = solved::<f32>(&heights, Control::MeanPressure(load), 1e-2);
        let seen = seen_in_f64(&heights, &gap.mapv(f64::from));
        assert!(seen < 2.0 * report.relative_error, "{load:e}: {seen:e} {report:?}");
    }
}

/// Two crossed waves that touch at one peak, with a law that jumps. The tension is a hundredth of what the contact
/// holds.
#[test]
fn a_tension_that_is_held_is_not_given_up() {
    let angle = std::f64::consts::TAU / 16.0;
    let heights =
        Array2::from_shape_fn((16, 16), |(i, j)| 0.01 * ((angle * i as f64).cos() + (angle * j as f64).cos()));
    let grid = Grid::square(16, 1.0).unwrap();
    let surface = Surface::new(grid, heights).unwrap();
    let law = MaugisDugdale::new(6.4e-7, 2e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let mut solve = |load| Solver::default().solve(&mut problem, Control::MeanPressure(load)).unwrap().report;
    for load in [-1.953e-8, -2e-6] {
        let report = solve(load);
        assert_eq!((report.status, report.contact_nodes), (Status::Converged, 1), "{load:e}");
        assert!((report.net_pressure - load).abs() < 1e-6 * report.mean_contact_pressure);
    }
    let lost = solve(-3e-4);
    assert_eq!((lost.status, lost.contact_nodes), (Status::Detached, 0));
    assert!(lost.net_pressure.abs() < 1e-6 * 3e-4 && lost.mean_pressure == -3e-4);
}

/// A state that the last computation of its pressure finds good is converged, and one that it finds bad is not.
#[test]
fn the_status_is_that_of_the_figures() {
    for seed in 0..40_u64 {
        let grid = Grid::new((9, 7), (1.0, 0.6)).unwrap();
        let height = |i: usize, j: usize| ((i * 31 + j * 17) as u64 * (seed + 3) * 2_654_435_761 % 1000) as f64 * 1e-4;
        let surface = Surface::new(grid, Array2::from_shape_fn((9, 7), |(i, j)| height(i, j))).unwrap();
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14] {
            for control in [Control::MeanGap(0.03), Control::MeanPressure(1e-3), Control::MeanPressure(1e-8)] {
                let operator = Westergaard::<f64>::new(grid, 1.0).unwrap();
                let mut problem = Problem::new(&surface, operator, NoAdhesion).unwrap();
                let mut solver = Solver::new(Settings::default().tolerance(tolerance));
                let report = solver.solve(&mut problem, control).unwrap().report;
                let good = report.relative_error <= tolerance && report.load_error <= tolerance;
                assert_eq!(report.status == Status::Converged, good, "{seed} {tolerance:e} {control:?} {report:?}");
                assert!(report.relative_error > 0.0 || report.contact_fraction == 1.0, "{report:?}");
            }
        }
    }
}

/// Errors that are reached, claimed and as they are when the gap is looked at in `f64`, for the page `choosing`.
#[test]
#[ignore = "prints figures: cargo test --release --test library light_loads::floors -- --ignored --nocapture"]
fn floors() {
    fn cells<T: Real>(heights: &Array2<f64>, load: f64) -> String {
        let Solution { gap, report, .. } = solved::<T>(heights, Control::MeanPressure(load), 1e-12);
        format!("{:.1e} | {:.1e}", report.relative_error, seen_in_f64(heights, &gap.mapv(T::widen)))
    }
    for (name, heights) in [("rough 128²", rough(128)), ("paraboloid 32²", paraboloid(32))] {
        println!("\n{name}\n\n| p̄/E* | f64 | f64, true | f32 | f32, true |\n|---|---|---|---|---|");
        for load in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13] {
            let single = if load > 1e-8 { cells::<f32>(&heights, load) } else { " | ".to_owned() };
            println!("| {load:.0e} | {} | {single} |", cells::<f64>(&heights, load));
        }
    }
}
