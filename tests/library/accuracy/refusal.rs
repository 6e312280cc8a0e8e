//! Errors that are not known, and accuracies that cannot be had.

use super::*;

#[test]
fn grids_that_say_nothing_leave_the_error_unknown() {
    let estimate = |n, quantity, nodes_per_wave, mu_rho, coarse_tolerance| {
        let nested = Nested::default().coarsest(32).coarse_tolerance(coarse_tolerance);
        GridError::of(&levels_of(nested, &surface(n, 1), PRESSED), quantity, nodes_per_wave, mu_rho)
    };
    let waves = surface(128, 1).nodes_per_wave(Boundary::Periodic);
    assert!((15.0..19.0).contains(&waves), "{waves}");
    let error = estimate(128, Quantity::Area, waves, 0.0, 1e-3).unwrap();
    assert!(!error.rough && error.relative > 1e-3 && error.relative < 0.05, "{error:?}");
    // fewer than eight nodes on the coarser grid
    assert!(estimate(128, Quantity::Area, 12.0, 0.0, 1e-3).unwrap().rough);
    // the coarser grid has fewer than four, does not resolve the adhesion, was not solved, or is not there: the waves
    // tell the error of the area, and nothing tells the errors of the others
    for (n, nodes_per_wave, mu_rho, tolerance) in
        [(128, 7.9, 0.0, 1e-3), (128, waves, 0.36, 1e-3), (128, waves, 0.0, 1e-1), (32, waves, 0.0, 1e-3)]
    {
        let error = estimate(n, Quantity::Area, nodes_per_wave, mu_rho, tolerance).unwrap();
        assert!(error.rough && error.order.is_none() && error.relative > 0.3 / nodes_per_wave.powi(2), "{error:?}");
        assert_eq!(estimate(n, Quantity::Gap, nodes_per_wave, mu_rho, tolerance), None);
    }
    // a surface without waves tells nothing by them, and neither do they where the grid itself does not resolve them,
    // or the adhesion
    assert_eq!(estimate(32, Quantity::Area, f64::INFINITY, 0.0, 1e-3), None);
    assert_eq!(estimate(128, Quantity::Area, 3.9, 0.0, 1e-3), None);
    assert_eq!(estimate(128, Quantity::Area, waves, 0.51, 1e-3), None);
}

#[test]
fn what_cannot_be_had_is_refused_by_name() {
    let (surface, control) = (surface(32, 1), PRESSED);
    let refused = |settings, wanted| solve_to(settings, wanted, &surface, control).unwrap_err();
    for target in [0.0, -0.01, 1.0, f64::NAN, f64::INFINITY] {
        let error = refused(Settings::default(), Accuracy::new(target, Quantity::Area));
        assert!(matches!(error, Error::Value { name: "accuracy", .. }), "{error}");
    }
    let error = refused(Settings::default(), Accuracy::new(0.01, Quantity::Pressure));
    assert!(matches!(error, Error::Unsuited { what: "accuracy of the pressure", .. }), "{error}");
    assert!(
        Quantity::Gap.check(Control::MeanGap(0.1)).is_err() && Quantity::Gap.check(Control::Approach(0.1)).is_err()
    );
    assert!(Quantity::Pressure.check(Control::Force(0.1)).is_err());
    // a tolerance that contradicts it, and one that does not
    let wanted = Accuracy::new(0.05, Quantity::Area);
    let error = refused(Settings::default().tolerance(1e-2), wanted);
    assert!(matches!(error, Error::Value { name: "tolerance", value: 1e-2, .. }), "{error}");
    let mut solver = Solver::new(Settings::default().tolerance(1e-5));
    let found = wanted.solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert!(found.solution.report.tolerance == 1e-5 && found.levels[0].relative_error <= 1e-5);
    assert_eq!(solver.settings.tolerance, Some(1e-5));

    // no grid that fits, told before: which would, and its memory
    let small = Accuracy::new(1e-6, Quantity::Area).memory(1e6);
    let mut operator = half_space(*surface.grid()).unwrap();
    let error = small.plan(&Solver::default(), &surface, &mut operator, &NoAdhesion, control).unwrap_err();
    let Error::Unaffordable { shape, bytes, available, affordable, .. } = error else { panic!("{error}") };
    assert!(shape.0 >= 4096 && bytes > 1e9 && available == 1e6 && affordable > 1e-3, "{shape:?} {bytes} {affordable}");
    let text = error_text(&small, &surface);
    assert!(text.contains("an accuracy of 1e-6 of the area takes about") && text.contains("GiB"), "{text}");
    // and on the way
    let (small, mut made) = (Accuracy::new(2e-3, Quantity::Area).memory(1e6), 0);
    let operator = |grid: Grid| {
        made = made.max(grid.shape().0);
        half_space(grid)
    };
    let found = small.solve(&mut Solver::default(), &surface, operator, NoAdhesion, control).unwrap();
    let (shape, bytes) = found.unaffordable.unwrap();
    assert_eq!(made, found.surface.grid().shape().0);
    assert!(!found.reached && shape.0 == 2 * found.surface.grid().shape().0 && bytes > 1e6);
    assert!(found.error.unwrap().relative > 2e-3);
}

fn error_text(wanted: &Accuracy, surface: &Surface) -> String {
    let mut operator = half_space(*surface.grid()).unwrap();
    wanted.plan(&Solver::default(), surface, &mut operator, &NoAdhesion, PRESSED).unwrap_err().to_string()
}

#[test]
fn what_is_known_on_one_grid_alone_is_not_refined() {
    let grid = Grid::square(32, 1.0).unwrap();
    let punch = surface_with_absent(grid, grid.sample(|x, y| if x.hypot(y) < 0.3 { 0.0 } else { f64::NAN })).unwrap();
    let found = Accuracy::new(0.01, Quantity::Pressure)
        .solve(&mut Solver::default(), &punch, free, NoAdhesion, Control::Approach(0.01))
        .unwrap();
    assert!(!found.reached && found.unaffordable.is_none());
    assert_eq!(found.surface.grid().shape(), (32, 32));
    // an observer that stops it leaves no finer grid either
    let wanted = Accuracy::new(0.01, Quantity::Area);
    let stop = |_: &Grid, _: &Iteration| std::ops::ControlFlow::Break(());
    let found =
        wanted.solve_observed(&mut Solver::default(), &surface(32, 1), half_space, NoAdhesion, PRESSED, stop).unwrap();
    assert_eq!((found.reached, found.solution.report.status), (false, Status::Stopped));
}

#[test]
fn a_flat_surface_needs_no_fine_grid() {
    for shape in [(1, 1), (5, 1), (1, 5), (8, 8)] {
        let flat = Surface::from_fn(Grid::new(shape, (1.0, 1.0)).unwrap(), |_, _| 0.3).unwrap();
        let found = solve(Accuracy::new(0.01, Quantity::Area), &flat, PRESSED);
        assert!(found.levels.len() <= 2, "{shape:?}");
        assert_eq!(found.reached, shape != (1, 1), "{shape:?}");
        assert_eq!(found.solution.report.contact_fraction, 1.0);
    }
}
