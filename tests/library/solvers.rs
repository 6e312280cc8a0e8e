//! The driver: what its certificate promises, how many applications it takes, how it starts and ends.

mod certificate;
mod counts;
mod laws;
mod memory;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use approx::assert_relative_eq;
use asperity::adhesion::{Discretisation, Hints, Values};
use asperity::solver::{Criterion, Method};
use asperity::*;
use ndarray::Array2;
use oracles::{rough, solve, solve_from, sphere};

/// The applications that rounding, which differs between processors, may add to a count.
const SLACK: usize = 2;

fn limited(max_iterations: usize, tolerance: f64) -> Solver {
    Solver::new(Settings::default().max_iterations(max_iterations).tolerance(tolerance))
}

fn wavy_cylinder(nodes: (usize, usize)) -> Surface {
    let grid = Grid::new(nodes, (1.0, 0.8)).unwrap();
    Surface::from_fn(grid, |x, y| 0.02 * (6.0 * x + 9.0 * y).sin() * (20.0 * y).cos() - x * x).unwrap()
}

#[test]
fn both_controls_find_the_same_state() {
    let mut problem = rough::<f64>(96, 24, NoAdhesion);
    let pressed = solve(&mut problem, Control::MeanPressure(0.08), 1e-10);
    let held = solve(&mut problem, Control::MeanGap(pressed.report.mean_gap), 1e-10);
    assert_relative_eq!(held.report.mean_pressure, 0.08, max_relative = 1e-8);
    assert_eq!(pressed.report.contact_nodes, held.report.contact_nodes);
}

#[test]
fn both_methods_find_the_same_state() {
    for control in [Control::MeanGap(0.03), Control::MeanPressure(0.05)] {
        let mut problem = rough::<f64>(64, 16, NoAdhesion);
        let ours = solve(&mut problem, control, 1e-9);
        let mut paper = Solver::new(Settings::rey2017().criterion(Criterion::Complementarity).tolerance(1e-11));
        let paper = paper.solve(&mut problem, control).unwrap();
        oracles::check(&paper);
        assert_eq!((paper.report.status, paper.report.method), (Status::Converged, Method::Rey2017));
        assert!(paper.report.complementarity <= 1e-11 && paper.report.relative_error < 1e-5);
        assert_eq!(ours.report.contact_nodes, paper.report.contact_nodes);
        assert_relative_eq!(ours.report.mean_gap, paper.report.mean_gap, max_relative = 1e-7);
        assert!(paper.report.operator_applications > 2 * ours.report.operator_applications);
    }
}

#[test]
fn adhesion_raises_the_contact_and_satisfies_the_envelope_theorem() {
    let rms = 0.0085;
    let law = Exponential::new(2e-4, 0.3 * rms).unwrap();
    let mut problem = rough::<f64>(128, 24, law);
    assert!(problem.mu_rho() < 0.51);
    let mut bare = rough::<f64>(128, 24, NoAdhesion);
    let (stuck, pressed) =
        (solve(&mut problem, Control::MeanGap(0.015), 1e-10), solve(&mut bare, Control::MeanGap(0.015), 1e-10));
    assert_eq!(stuck.report.status, Status::Converged);
    assert!(stuck.report.contact_nodes > pressed.report.contact_nodes);
    assert!(stuck.report.adhesive_energy < 0.0 && stuck.report.mean_pressure < pressed.report.mean_pressure);

    // de/dg = −p, by central differences that stay on the branch
    let step = 1e-7;
    let mut energy = |gap: f64| {
        let report = solve_from(&mut problem, Control::MeanGap(gap), 1e-10, Some(&stuck.gap)).report;
        report.elastic_energy + report.adhesive_energy
    };
    let slope = (energy(0.015 + step) - energy(0.015 - step)) / (2.0 * step);
    assert_relative_eq!(slope, -stuck.report.mean_pressure, max_relative = 1e-5);
}

#[test]
fn strong_and_unresolved_adhesion_ends_and_says_so() {
    for (range, work) in [(2e-4, 1e-4), (2e-5, 2e-5), (5e-4, 5e-3)] {
        let mut problem = rough::<f64>(64, 16, Exponential::new(work, range).unwrap());
        let solution = solve(&mut problem, Control::MeanGap(0.02), 1e-6);
        let report = &solution.report;
        assert!(report.under_resolved && report.mu_rho > 0.5);
        assert!(report.status == Status::Converged || report.status == Status::Stalled);
        assert!(report.status != Status::Converged || report.relative_error <= 1e-6);
    }
}

#[test]
fn a_warm_start_from_the_solution_is_the_solution() {
    // the jump of the first law is smoothed on the way
    let dugdale: Box<dyn AdhesionLaw<f64>> = Box::new(MaugisDugdale::new(1e-4, 2e-3).unwrap());
    let exponential: Box<dyn AdhesionLaw<f64>> = Box::new(Exponential::new(1e-4, 2e-3).unwrap());
    for (law, most) in [(dugdale, 20), (exponential, 1)] {
        let mut problem = sphere::<f64>(64, law);
        for control in [Control::MeanGap(0.0429), Control::MeanPressure(-5e-4)] {
            let first = solve(&mut problem, control, 1e-9);
            let again = solve_from(&mut problem, control, 1e-8, Some(&first.gap));
            assert_eq!((first.report.status, again.report.status), (Status::Converged, Status::Converged));
            assert!(again.report.iterations <= most, "{}", again.report.iterations);
            assert_eq!(first.report.contact_nodes, again.report.contact_nodes);
        }
    }
}

#[test]
fn tension_is_held_by_adhesion_up_to_pull_off_and_detaches_beyond() {
    // pull-off of this state is near −9.76e-4 in the paper's units
    let mut problem = sphere::<f64>(128, MaugisDugdale::new(1e-4, 2e-3).unwrap());
    let held = solve(&mut problem, Control::MeanPressure(-7e-4), 1e-7);
    assert_eq!(held.report.status, Status::Converged);
    assert!(held.report.contact_nodes > 100 && held.report.mean_contact_pressure > 0.0);
    let lost = solve(&mut problem, Control::MeanPressure(-1.2e-3), 1e-7);
    assert_eq!((lost.report.status, lost.report.contact_nodes), (Status::Detached, 0));
    // some of them to look for a hold, at a dozen mean gaps
    assert!(lost.report.iterations < 400 && lost.gap.iter().all(|g| g.is_finite()));
    let mut bare = sphere::<f64>(128, NoAdhesion);
    let lost = solve(&mut bare, Control::MeanPressure(-1e-9), 1e-7);
    assert_eq!(lost.report.status, Status::Detached);
    assert!(lost.report.iterations < 100 && lost.report.mean_gap.is_finite());
}

#[test]
fn an_observer_can_stop_and_the_limit_is_kept() {
    let mut problem = sphere::<f64>(64, NoAdhesion);
    let control = Control::MeanGap(0.0398);
    let mut seen = Vec::new();
    let stopped = Solver::default()
        .solve_with(&mut problem, control, Start::Default, |iteration| {
            seen.push(iteration.iteration);
            if iteration.iteration == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    assert_eq!((seen, stopped.report.status), (vec![0, 1, 2, 3], Status::Stopped));
    oracles::check(&stopped);
    // from every start, and from a gap in any layout
    let by_columns = stopped.gap.t().as_standard_layout().into_owned().reversed_axes();
    assert!(!by_columns.is_standard_layout() && by_columns == stopped.gap);
    for start in [Start::Default, Start::From(&by_columns), Start::Near(by_columns.clone())] {
        let mut seen = 0;
        let stopped = Solver::default().solve_with(&mut problem, control, start, |_| {
            seen += 1;
            if seen == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!((seen, stopped.unwrap().report.status), (2, Status::Stopped));
    }
    let ended = limited(5, 1e-6).solve(&mut problem, control).unwrap();
    assert_eq!((ended.report.status, ended.report.iterations), (Status::IterationLimit, 5));
    assert!(ended.report.relative_error > 1e-6);
}

#[test]
fn impossible_inputs_are_refused_by_name() {
    let mut problem = sphere::<f64>(16, NoAdhesion);
    let mut refuse = |control, start: Option<Array2<f64>>, tolerance, text: &str| {
        let settings = Settings::default().tolerance(tolerance);
        let start = start.as_ref().map_or(Start::Default, |s| Start::From(s));
        let error = Solver::new(settings)
            .solve_with(&mut problem, control, start, |_| ControlFlow::Continue(()))
            .unwrap_err()
            .to_string();
        assert!(error.contains(text), "{error}");
    };
    let gap = Control::MeanGap(0.04);
    refuse(Control::MeanGap(-1.0), None, 1e-6, "mean gap is -1");
    refuse(Control::MeanGap(f64::NAN), None, 1e-6, "mean gap is NaN");
    refuse(Control::MeanPressure(f64::INFINITY), None, 1e-6, "mean pressure is inf");
    refuse(gap, None, 0.0, "tolerance is 0");
    refuse(gap, Some(Array2::zeros((16, 15))), 1e-6, "starting gap has shape 16 x 15");
    refuse(gap, Some(Array2::from_elem((16, 16), -0.5)), 1e-6, "starting gap is -0.5");
    refuse(gap, Some(Array2::from_elem((16, 16), f64::NAN)), 1e-6, "256 of 256");

    let grid = Grid::square(16, 1.0).unwrap();
    let other = Surface::paraboloid(Grid::square(16, 2.0).unwrap(), 1.0).unwrap();
    let operator = || Westergaard::<f64>::new(grid, 1.0).unwrap();
    assert!(Problem::new(&other, operator(), NoAdhesion).is_err());
    // laws that only f64 can hold
    let single = Westergaard::<f32>::new(grid, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    for (work, range) in [(1e60, 1e-3), (1e-4, 1e-60)] {
        let laws = (Exponential::new(work, range).unwrap(), MaugisDugdale::new(work, range).unwrap());
        assert!(
            matches!(Problem::new(&surface, single.clone(), laws.0), Err(Error::Contract { .. })),
            "{work} {range}"
        );
        assert!(
            matches!(Problem::new(&surface, single.clone(), laws.1), Err(Error::Contract { .. })),
            "{work} {range}"
        );
        assert!(
            Problem::new(&surface, operator(), laws.0).is_ok() && Problem::new(&surface, operator(), laws.1).is_ok()
        );
    }
    let mut heights = Array2::zeros((16, 16));
    heights[[3, 5]] = f64::NAN;
    let error = Surface::new(grid, heights).unwrap_err().to_string();
    assert!(error.contains("1 of 256") && error.contains("[3, 5]"), "{error}");
}

type Law<T> = fn() -> Box<dyn AdhesionLaw<T>>;
