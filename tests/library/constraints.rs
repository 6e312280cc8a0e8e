//! Penalty and Uzawa beside projection: the same solution, at the price that each of them asks.

use crate::common::outrun::Outrun;
use crate::common::{rough, solve, sphere};
use approx::assert_relative_eq;
use asperity::*;

fn with<T: Real, C: ContactConstraint<T>, L: AdhesionLaw<T>>(
    problem: &mut Problem<T, Westergaard<T>, L>,
    constraint: C,
    control: Control,
    tolerance: f64,
) -> (Solution<T>, C) {
    let mut solver = Solver { settings: Settings { tolerance, ..Settings::default() }, constraint };
    let solution = solver.solve(problem, control).unwrap();
    (solution, solver.constraint)
}

#[test]
fn a_penalty_interpenetrates_by_the_pressure_over_its_stiffness() {
    let control = Control::MeanGap(0.0398);
    let exact = solve(&mut sphere::<f64, _>(64, NoAdhesion), control, 1e-9).report;
    let mut last = f64::INFINITY;
    for stiffness in [50.0, 500.0, 5000.0] {
        let constraint = Penalty::new(stiffness).unwrap();
        let (solution, _) = with(&mut sphere(64, NoAdhesion), constraint, control, 1e-8);
        let report = &solution.report;
        assert_eq!(report.status, Status::Converged);
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert_relative_eq!(report.min_gap, -deepest / stiffness, max_relative = 1e-9);
        assert_eq!(report.contact_points, solution.gap.iter().filter(|&&g| g < 0.0).count());
        // the pressure is softer than the rigid one by about the springs' compliance beside the contact's
        let error = (report.mean_pressure / exact.mean_pressure - 1.0).abs();
        assert!(error < last && error < 20.0 / stiffness, "{error}");
        last = error;
    }
}

#[test]
fn uzawa_removes_the_interpenetration_whatever_its_stiffness() {
    let control = Control::MeanGap(0.0398);
    let exact = solve(&mut sphere::<f64, _>(64, NoAdhesion), control, 1e-9).report;
    for stiffness in [50.0, 500.0] {
        let (solution, uzawa) = with(&mut sphere(64, NoAdhesion), Uzawa::new(stiffness).unwrap(), control, 1e-9);
        assert_eq!((solution.report.status, solution.report.contact_points), (Status::Converged, exact.contact_points));
        assert!(uzawa.outer_iterations() > 2);
        // the last update changed no multiplier by more than its tolerance
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert!(-solution.report.min_gap <= 1e-6 * deepest / stiffness);
        assert_relative_eq!(solution.report.mean_pressure, exact.mean_pressure, max_relative = 1e-6);
    }
}

#[test]
fn uzawa_that_may_not_update_enough_has_not_converged() {
    let mut constraint = Uzawa::new(100.0).unwrap();
    constraint.max_outer_iterations = 2;
    let (solution, uzawa) = with(&mut sphere(32, NoAdhesion), constraint, Control::MeanGap(0.0398), 1e-8);
    assert_eq!((solution.report.status, uzawa.outer_iterations()), (Status::IterationLimit, 2));
    assert!(solution.report.min_gap < 0.0);
}

#[test]
fn every_law_control_and_precision_works_with_them() {
    let law = MaugisDugdale::new(1e-4, 4e-3).unwrap();
    let pull = Control::MeanPressure(-3e-4);
    let exact = solve(&mut sphere::<f64, _>(48, law), pull, 1e-8).report;
    let (uzawa, _) = with(&mut sphere(48, law), Uzawa::new(300.0).unwrap(), pull, 1e-8);
    assert_eq!(uzawa.report.status, Status::Converged);
    assert_relative_eq!(uzawa.report.mean_gap, exact.mean_gap, max_relative = 1e-2);

    let press = Control::MeanPressure(0.1);
    let exact = solve(&mut rough::<f64, _>(64, 16, NoAdhesion), press, 1e-8).report;
    let (penalty, _) = with(&mut rough::<f64, _>(64, 16, NoAdhesion), Penalty::new(1e4).unwrap(), press, 1e-7);
    assert_eq!(penalty.report.status, Status::Converged);
    assert_relative_eq!(penalty.report.mean_gap, exact.mean_gap, max_relative = 1e-2);
    let (single, _) = with(&mut rough::<f32, _>(64, 16, NoAdhesion), Uzawa::new(500.0).unwrap(), press, 1e-5);
    assert!(single.report.status == Status::Converged || single.report.status == Status::Stalled);
    assert_relative_eq!(single.report.mean_gap, exact.mean_gap, max_relative = 1e-3);
}

#[test]
fn bad_stiffnesses_are_refused() {
    for stiffness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Penalty::new(stiffness).is_err() && Uzawa::new(stiffness).is_err());
    }
}

type Sticky = Problem<f64, Westergaard<f64>, Exponential<f64>>;

/// A rough surface, and a law that attracts ten times its range deep into the peaks at the default start.
fn sticky() -> (Sticky, Exponential<f64>, Control) {
    let law = Exponential::new(2e-4, 3e-3).unwrap();
    (rough(64, 8, law), law, Control::MeanGap(0.05))
}

#[test]
fn penalty_and_uzawa_find_the_adhesive_state_of_a_rough_surface() {
    let (mut problem, law, control) = sticky();
    assert!(problem.resolution() < 0.7);
    let exact = solve(&mut problem, control, 1e-8).report;
    let mut last = f64::INFINITY;
    for stiffness in [30.0, 300.0, 3000.0] {
        let (solution, _) = with(&mut problem, Penalty::new(stiffness).unwrap(), control, 1e-7);
        let report = &solution.report;
        assert_eq!(report.status, Status::Converged);
        // the springs carry the contact pressure, and the adhesion of contact
        let deepest = solution.contact_pressure.iter().copied().fold(0.0, f64::max);
        assert_relative_eq!(report.min_gap, -deepest / stiffness, max_relative = 1e-9);
        for ((&g, &p), &lambda) in solution.gap.iter().zip(&solution.pressure).zip(&solution.contact_pressure) {
            let balance = p + law.traction(g.max(0.0)) - lambda;
            assert!(balance.abs() < 1e-3 * deepest, "{g} {p} {lambda}");
        }
        let error = (report.mean_pressure / exact.mean_pressure - 1.0).abs();
        assert!(error < 0.2 * last, "{stiffness} {error}");
        last = error;
        let (solution, uzawa) = with(&mut problem, Uzawa::new(stiffness).unwrap(), control, 1e-8);
        assert_eq!((solution.report.status, uzawa.outer_iterations() > 2), (Status::Converged, true));
        assert_eq!(solution.report.contact_points, exact.contact_points);
        assert_relative_eq!(solution.report.mean_pressure, exact.mean_pressure, max_relative = 1e-5);
    }
    assert!(last < 0.02, "{last}");
}

#[test]
fn an_exponential_evaluated_at_negative_gaps_diverges_and_is_not_called_converged() {
    let (mut problem, law, control) = sticky();
    for stiffness in [30.0, 300.0] {
        let diverged = [
            with(&mut problem, Outrun(Penalty::new(stiffness).unwrap(), law), control, 1e-6).0,
            with(&mut problem, Outrun(Uzawa::new(stiffness).unwrap(), law), control, 1e-6).0,
        ];
        for solution in diverged {
            assert_eq!(solution.report.status, Status::Stalled);
            // it is past the barrier that springs and law leave, where k|g| = φ'(g)
            assert!(stiffness * -solution.report.min_gap < law.traction(solution.report.min_gap));
            assert!(!solution.report.relative_error.is_nan() && solution.gap.iter().all(|g| g.is_finite()));
        }
    }
    // stiff springs leave a local minimum, which is found from next to it, where the law goes on as its tangent
    let springs = Penalty::new(3000.0).unwrap();
    let (near, _) = with(&mut problem, springs, control, 1e-7);
    let mut solver = Solver { settings: Settings::default(), constraint: Outrun(springs, law) };
    let held = solver
        .solve_from(&mut problem, control, Some(near.gap.view()), |_| std::ops::ControlFlow::Continue(()))
        .unwrap();
    assert_eq!(held.report.status, Status::Converged);
    assert_relative_eq!(held.report.mean_pressure, near.report.mean_pressure, max_relative = 1e-2);
}

/// A law that is undefined, as it may be, where the surfaces interpenetrate.
struct Positive(Exponential<f64>);

impl AdhesionLaw<f64> for Positive {
    fn energy(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.energy(gap) }
    }
    fn traction(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.traction(gap) }
    }
    fn slope(&self, gap: f64) -> f64 {
        if gap < 0.0 { f64::NAN } else { self.0.slope(gap) }
    }
}

#[test]
fn no_law_is_asked_for_a_negative_gap() {
    let (mut problem, law, control) = sticky();
    let (expected, _) = with(&mut problem, Penalty::new(300.0).unwrap(), control, 1e-6);
    let mut problem = rough::<f64, _>(64, 8, Positive(law));
    let (found, _) = with(&mut problem, Penalty::new(300.0).unwrap(), control, 1e-6);
    assert!(found.report.status == Status::Converged && found.report.min_gap < 0.0);
    // the same steps, but for the last bits of the exponential, which the law computes for many gaps at once
    assert!(found.gap.iter().zip(&expected.gap).all(|(found, expected)| (found - expected).abs() < 1e-9));
    // nor where a start interpenetrates
    let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(300.0).unwrap() };
    let again = solver
        .solve_from(&mut problem, control, Some(found.gap.view()), |_| std::ops::ControlFlow::Continue(()))
        .unwrap();
    assert_eq!(again.report.status, Status::Converged);
}
