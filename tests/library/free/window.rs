//! The window of a free half-space: its size and its edge.

use super::*;

#[test]
fn a_larger_window_gives_the_same_answer() {
    let law = Exponential::new(4e-6, 5e-4).unwrap();
    let of = |n: usize| {
        let surface = sphere(n, 0.4 * n as f64 / 64.0);
        solve(&mut problem(&surface, law), Control::Force(1e-4), 1e-8).report
    };
    let (small, large) = (of(64), of(96));
    assert_eq!(small.contact_nodes, large.contact_nodes);
    // at the edge of the small window the gap is some fifteen ranges
    assert!((small.approach.unwrap() / large.approach.unwrap() - 1.0).abs() < 1e-6);
    assert!(small.edge_traction.unwrap() < 1e-5 && !small.reaches_edge);
}

#[test]
fn the_field_of_pressure_carries_the_load_where_nodes_face_no_surface() {
    let (whole, holed) = (bumps((12, 10)), bumps_with_holes((12, 10)));
    let law = || Exponential::new(1e-5, 2e-2).unwrap();
    let half_space = || Westergaard::new(*holed.grid(), 1.0).unwrap();
    for load in [-1e-5, 1e-3, 0.1] {
        let control = Control::MeanPressure(load);
        let found = [
            Solver::default().solve(&mut problem(&whole, law()), control).unwrap(),
            Solver::default().solve(&mut problem(&holed, law()), control).unwrap(),
            Solver::default().solve(&mut Problem::new(&holed, half_space(), law()).unwrap(), control).unwrap(),
        ];
        for Solution { pressure, report, .. } in found {
            assert_eq!(report.status, Status::Converged);
            let scale = load.abs().max(largest(&pressure));
            assert!((pressure.sum() / pressure.len() as f64 - load).abs() < 1e-14 * scale, "{report:?}");
        }
    }
}

#[test]
fn statistics_do_not_wrap_and_leave_absent_nodes_out() {
    let grid = Grid::square(32, 1.0).unwrap();
    // bumps at two opposite edges
    let heights = grid.sample(|x, y| if y.abs() > 0.2 { f64::NAN } else { -0.1 * ((x.abs() - 0.5).powi(2) + y * y) });
    let surface = surface_with_absent(grid, heights).unwrap();
    let found = solve(&mut problem(&surface, NoAdhesion), Control::Force(1e-4), 1e-6);
    let statistics = ContactStatistics::of(&found).unwrap();
    assert_eq!(statistics.cluster_sizes.len(), 2);
    assert_eq!(statistics.contact_fraction, found.report.contact_fraction);
    assert!((statistics.contact_fraction + statistics.apart_fraction - 1.0).abs() < 1e-15);
    for distribution in
        [PressureDistribution::of_pressure(&found, 7), PressureDistribution::of_contact_pressure(&found, 7)]
    {
        assert!(distribution.unwrap().integral() <= 1.0 + 1e-12);
    }
    assert!((PressureDistribution::of_pressure(&found, 7).unwrap().integral() - 1.0).abs() < 1e-12);
    assert!(found.report.reaches_edge);
}

#[test]
fn a_traction_at_the_edge_reaches_it_without_contact_there() {
    let surface = sphere(32, 0.24);
    let reaches = |range: f64| {
        let mut problem = problem(&surface, Exponential::new(2e-6, range).unwrap());
        let found = solve(&mut problem, Control::Approach(1e-3), 1e-8);
        assert!(found.report.contact_nodes > 0 && found.gap.row(0).iter().all(|gap| *gap > 0.0));
        found.report.reaches_edge
    };
    // the gap is 3.6e-3 there, and deeper by the displacement
    assert!(reaches(1e-3) && !reaches(2e-4));
}

/// The attraction of van der Waals hardly falls from the apex to the edge, and misses what is beyond.
#[test]
fn a_long_ranged_traction_reaches_the_edge_of_bodies_apart() {
    let law = PowerLaw::new(1e-4, 1e-3, 3.0).unwrap();
    let found = solve(&mut problem(&sphere(32, 0.24), law), Control::Approach(-6e-3), 1e-6).report;
    assert!(found.contact_nodes == 0 && found.reaches_edge && found.edge_traction.unwrap() > 0.1);
}

#[test]
fn bodies_that_are_nearly_apart_do_not_reach_the_edge() {
    let surface = sphere(32, 0.24);
    let mut problem = problem(&surface, Exponential::new(2e-5, 2e-3).unwrap());
    let far = Array2::from_shape_fn((32, 32), |node| 0.05 - surface.heights()[node]);
    let control = Control::Approach(-0.05);
    let found = Solver::default().solve_with(&mut problem, control, Start::From(&far), |_| ControlFlow::Continue(()));
    let found = found.unwrap();
    assert!(found.report.edge_traction.unwrap() > 1e-3 && !found.report.reaches_edge);
}
