//! The certified error next to the true error.

use super::*;

#[test]
fn the_certificate_is_never_below_the_true_error() {
    let surface = wavy_cylinder((60, 49));
    let mut operator = Westergaard::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(&surface, operator.clone(), NoAdhesion).unwrap();
    for control in [Control::MeanGap(0.03), Control::MeanGap(0.1), Control::MeanPressure(0.05)] {
        let mut sharpest = f64::INFINITY;
        for iterations in 0..24 {
            let state = limited(iterations, 1e-14).solve(&mut problem, control).unwrap();
            oracles::check(&state);
            // a state under pressure control is certified at its own mean gap
            let exact = solve(&mut problem, Control::MeanGap(state.report.mean_gap), 1e-12);
            assert_eq!(exact.report.status, Status::Converged);
            let (error, size, flat) = oracles::energy_norms(&surface, &mut operator, &exact.gap, &state.gap);
            // without contact the surface's own size may stand for the size of the displacement
            let size = if state.report.contact_nodes > 0 { size } else { size.max(flat) };
            let (error, bound) = ((error / size).sqrt(), state.report.relative_error);
            assert!(error <= bound * (1.0 + 1e-6) + 2e-12, "{control:?} {iterations}: {error:e} > {bound:e}");
            if error > 1e-8 {
                sharpest = sharpest.min(bound / error);
            }
        }
        assert!(sharpest < 2.0, "the bound is {sharpest} times the error at best");
    }
}

#[test]
fn the_certificate_of_springs_is_never_below_the_true_error() {
    let surface = wavy_cylinder((48, 35));
    let mut operator = Westergaard::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(&surface, operator.clone(), NoAdhesion).unwrap();
    // far softer than the stiffest wave, which has 75, and far stiffer
    for (stiffness, control) in
        [(3.0, Control::MeanGap(0.03)), (100.0, Control::MeanPressure(0.05)), (3000.0, Control::MeanGap(0.05))]
    {
        let solve = |problem: &mut Problem<_>, control, iterations, tolerance| {
            let settings = Settings::default().max_iterations(iterations).tolerance(tolerance);
            Solver { settings, constraint: Penalty::new(stiffness).unwrap() }.solve(problem, control).unwrap()
        };
        for iterations in 0..24 {
            let state = solve(&mut problem, control, iterations, 1e-14);
            let exact = solve(&mut problem, Control::MeanGap(state.report.mean_gap), 1000, 1e-12);
            assert_eq!(exact.report.status, Status::Converged);
            let (error, size, _) = oracles::energy_norms(&surface, &mut operator, &exact.gap, &state.gap);
            let (error, bound) = ((error / size).sqrt(), state.report.relative_error);
            assert!(error <= bound * (1.0 + 1e-6) + 2e-12, "{stiffness} {iterations}: {error:e} > {bound:e}");
        }
    }
}

#[test]
fn the_papers_method_can_be_held_to_the_certified_error() {
    let settings = Settings::rey2017().tolerance(1e-7);
    let solution = Solver::new(settings).solve(&mut sphere::<f64>(64, NoAdhesion), Control::MeanGap(0.0398)).unwrap();
    let (points, _) = crate::algorithm3::of_sphere(64, 0.0398);
    assert_eq!((solution.report.status, solution.report.contact_nodes), (Status::Converged, points));
    assert!(solution.report.relative_error <= 1e-7);
}
