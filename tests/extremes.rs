//! Inputs at the edge: every one is solved, refused, or ended with the right status.

mod common;

use asperity::*;
use common::{check, solve};
use ndarray::Array2;

fn problem<L: AdhesionLaw<f64>>(
    shape: (usize, usize),
    lengths: (f64, f64),
    height: impl Fn(usize, usize) -> f64,
    law: L,
) -> Problem<f64, Westergaard<f64>, L> {
    let grid = Grid::new(shape, lengths).unwrap();
    let surface = Surface::new(grid, Array2::from_shape_fn(shape, |(i, j)| height(i, j))).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

fn checkerboard(i: usize, j: usize) -> f64 {
    0.1 * ((i + j) % 2) as f64
}

#[test]
fn flats_under_tension_hold_up_to_the_law_and_no_further() {
    let traction = 1e-4 / 2e-3;
    for shape in [(8, 8), (7, 5), (1, 1)] {
        let mut exponential = problem(shape, (1.0, 1.0), |_, _| 0.3, Exponential::new(1e-4, 2e-3).unwrap());
        let mut dugdale = problem(shape, (1.0, 1.0), |_, _| 0.3, MaugisDugdale::new(1e-4, 2e-3).unwrap());
        let mut bare = problem(shape, (1.0, 1.0), |_, _| 0.3, NoAdhesion);
        let held = Control::MeanPressure(-0.99 * traction);
        for solution in [solve(&mut exponential, held, 1e-6), solve(&mut dugdale, held, 1e-6)] {
            assert_eq!((solution.report.status, solution.report.contact_fraction), (Status::Converged, 1.0));
        }
        for load in [-1.1 * traction, -5.0] {
            let lost = Control::MeanPressure(load);
            assert_eq!(solve(&mut exponential, lost, 1e-6).report.status, Status::Detached);
            assert_eq!(solve(&mut dugdale, lost, 1e-6).report.status, Status::Detached);
            let solution = solve(&mut bare, lost, 1e-6);
            assert_eq!((solution.report.status, solution.report.load_error), (Status::Detached, 1.0));
            assert!(solution.pressure.iter().all(|p| p.abs() < 1e-12));
        }
        let pressed = solve(&mut bare, Control::MeanPressure(2.0), 1e-6);
        assert_eq!((pressed.report.status, pressed.report.contact_fraction), (Status::Converged, 1.0));
        assert!(pressed.pressure.iter().all(|&p| p == 2.0));
    }
}

#[test]
fn flats_at_a_gap_stay_there() {
    for shape in [(8, 8), (7, 5), (1, 9)] {
        let law = Exponential::new(1e-4, 2e-3).unwrap();
        let mut problem = problem(shape, (1.0, 1.0), |_, _| -3.7, law);
        let solution = solve(&mut problem, Control::MeanGap(1e-3), 1e-6);
        assert_eq!(solution.report.status, Status::Converged);
        assert!((solution.report.mean_pressure + law.traction(1e-3)).abs() < 1e-15);
    }
}

#[test]
fn pull_off_ends_detached_and_at_rest() {
    let grid = Grid::square(64, 1.0).unwrap();
    let sphere = Surface::paraboloid(grid, 0.5).unwrap();
    let law = Exponential::new(1e-3, 1e-2).unwrap();
    let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    // pull-off is between 1.5 and 2 times πwR
    let unit = std::f64::consts::PI * 1e-3 * 0.5;
    let held = solve(&mut problem, Control::MeanPressure(-1.5 * unit), 1e-7);
    assert_eq!(held.report.status, Status::Converged);
    assert!(held.report.contact_points > 0);
    for factor in [2.0, 3.0, 100.0] {
        let lost = solve(&mut problem, Control::MeanPressure(-factor * unit), 1e-7);
        assert_eq!((lost.report.status, lost.report.contact_points), (Status::Detached, 0));
        assert!(lost.report.iterations < 300 && lost.report.relative_error < 1e-6 && lost.report.mean_gap < 10.0);
    }
}

#[test]
fn sharp_surfaces_do_not_jam() {
    // peaks that a rounding's width keeps from landing; changes that are uniform but for rounding
    for (shape, load) in [((40, 24), 8.85e-3), ((101, 1), 16.1), ((12, 7), 9.0), ((2, 3), 1e-2)] {
        let mut problem = problem(shape, (1.0, 1.0), checkerboard, NoAdhesion);
        let report = solve(&mut problem, Control::MeanPressure(load), 1e-6).report;
        assert_eq!(report.status, Status::Converged, "{shape:?} {load}");
    }
    let wave = |i: usize, _: usize| 0.1 * (std::f64::consts::TAU * i as f64 / 31.0).cos();
    let mut problem = problem((31, 17), (3.0, 1.0), wave, NoAdhesion);
    assert_eq!(solve(&mut problem, Control::MeanPressure(3.05e-5), 1e-6).report.status, Status::Converged);
}

#[test]
fn a_spike_a_step_and_elongated_grids() {
    let spike = |i: usize, j: usize| f64::from(u8::from((i, j) == (3, 0)));
    let step = |i: usize, _: usize| if i < 5 { 0.0 } else { 0.2 };
    for shape in [(16, 16), (13, 7), (1, 16), (16, 1), (512, 3), (2, 2)] {
        for control in [Control::MeanGap(0.05), Control::MeanPressure(1e-3), Control::MeanPressure(0.5)] {
            if shape.0 > 3 {
                let mut problem = problem(shape, (1.0, 0.3), spike, NoAdhesion);
                assert_eq!(
                    solve(&mut problem, control, 1e-6).report.status,
                    Status::Converged,
                    "{shape:?} {control:?}"
                );
            }
            let mut problem = problem(shape, (1.0, 0.3), step, NoAdhesion);
            assert_eq!(solve(&mut problem, control, 1e-6).report.status, Status::Converged, "{shape:?} {control:?}");
        }
    }
}

#[test]
fn the_lightest_loads_are_not_certified_on_rounding() {
    for load in [1e-6, 1e-8, 1e-10, 1e-12] {
        let mut problem = common::rough::<f64, _>(64, 16, NoAdhesion);
        let solution = solve(&mut problem, Control::MeanPressure(load), 1e-6);
        let report = &solution.report;
        assert!(report.status == Status::Converged || report.relative_error > 1e-6);
        assert!(load < 1e-9 || report.status == Status::Converged, "{load} {}", report.status);
        assert!(report.contact_points >= 1);
    }
}

/// An exponential that fails beyond a gap.
struct Broken(f64);

impl AdhesionLaw<f64> for Broken {
    fn energy(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { -1e-4 * (-gap / 1e-2).exp() }
    }
    fn traction(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { 1e-2 * (-gap / 1e-2).exp() }
    }
    fn slope(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { -(-gap / 1e-2).exp() }
    }
}

#[test]
fn a_law_that_fails_is_refused_or_never_called_converged() {
    let wave = |i: usize, _: usize| 0.02 * (std::f64::consts::TAU * i as f64 / 16.0).cos();
    let mut problem = problem((16, 16), (1.0, 1.0), wave, Broken(0.02));
    let error = Solver::default().solve(&mut problem, Control::MeanGap(0.03)).unwrap_err().to_string();
    assert!(error.contains("adhesive energy is NaN at a gap of 0.03"), "{error}");
    let control = Control::MeanGap(0.01);
    let solution = Solver::default().solve(&mut problem, control).unwrap();
    check(&solution, &Broken(f64::INFINITY), control);
    assert!(solution.report.status != Status::Converged || solution.gap.iter().all(|&g| g <= 0.02));
}

#[test]
fn controls_that_the_precision_cannot_hold_are_refused() {
    let grid = Grid::square(8, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.01, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f32>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    assert!(Solver::default().solve(&mut problem, Control::MeanGap(1e300)).is_err());
    assert!(Solver::default().solve(&mut problem, Control::MeanPressure(-1e300)).is_err());
    // a gap that underflows is none
    let closed = Solver::default().solve(&mut problem, Control::MeanGap(1e-300)).unwrap();
    assert_eq!(closed.report.contact_fraction, 1.0);
}
