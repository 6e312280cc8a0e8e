//! Bodies that come apart, and bodies that are apart.

use super::*;

#[test]
fn a_tension_beyond_the_pull_off_detaches_and_one_below_it_holds() {
    let (work, range) = (2e-5, 2e-3);
    let pull_off = -exact::MaugisDugdale::new(2.0, 1.0, work, range).unwrap().pull_off().load();
    let mut problem = problem(&sphere(32, 0.24), MaugisDugdale::new(work, range).unwrap());
    let held = solve(&mut problem, Control::Force(-0.9 * pull_off), 1e-6).report;
    assert!(held.contact_nodes > 0 && (held.net_pressure / held.mean_pressure - 1.0).abs() < 1e-5);
    let lost = Solver::default().solve(&mut problem, Control::Force(-1.1 * pull_off)).unwrap().report;
    assert_eq!((lost.status, lost.contact_nodes, lost.reaches_edge), (Status::Detached, 0, false));
    assert!((lost.normal_force / pull_off + 1.1).abs() < 1e-12 && lost.net_pressure.abs() < 1e-3 * pull_off);
    // a search for a hold where they touch and at a few mean gaps, and none where the law itself holds less
    assert!(lost.operator_applications < 430, "{}", lost.operator_applications);
    let strongest = work / range * 0.24 * 0.24;
    for force in [-1.2 * strongest, -1e3 * strongest] {
        let torn = Solver::default().solve(&mut problem, Control::Force(force)).unwrap().report;
        assert_eq!((torn.status, torn.contact_nodes, torn.normal_force), (Status::Detached, 0, force));
        assert!(torn.operator_applications < 60, "{}", torn.operator_applications);
    }
}

#[test]
fn bodies_apart_carry_nothing() {
    for control in [Control::Approach(-0.01), Control::Spring { stiffness: 0.3, rest: -0.01 }, Control::Force(0.0)] {
        let found = solve(&mut problem(&sphere(32, 0.4), NoAdhesion), control, 1e-6);
        assert_eq!((found.report.contact_nodes, found.report.reaches_edge), (0, false));
        assert!(found.report.normal_force.abs() < 1e-12, "{control:?} {}", found.report.normal_force);
        if control != Control::Force(0.0) {
            assert!((found.report.approach.unwrap() + 0.01).abs() < 1e-10);
        }
    }
}

#[test]
fn surfaces_that_just_touch_bear_nothing() {
    fn check<T: Real>(surface: &Surface, control: Control) {
        let body = Boussinesq::<T>::new(*surface.grid(), 1.0).unwrap();
        let found = Solver::default().solve(&mut Problem::new(surface, body, NoAdhesion).unwrap(), control).unwrap();
        assert_eq!(
            (found.report.status, found.report.contact_nodes),
            (Status::Converged, 0),
            "{control:?} {}",
            T::NAME
        );
    }
    for seed in 0..12 {
        let surface = oracles::rough::rough(Grid::square(64, 1.0).unwrap(), 16, seed);
        for control in [Control::Approach(0.0), Control::Spring { stiffness: 0.3, rest: 0.0 }] {
            check::<f64>(&surface, control);
            check::<f32>(&surface, control);
        }
    }
}
