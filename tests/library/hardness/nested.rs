//! Nested grids of contacts that yield.

use super::*;

#[test]
fn nested_grids_find_the_same() {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(32.0).surface(grid).unwrap();
    let control = Control::MeanPressure(0.01);
    let half_space = |grid: Grid| Westergaard::<f64>::new(grid, 1.0);
    let mut problem = Problem::new(&surface, half_space(grid).unwrap(), NoAdhesion).unwrap();
    let rigid = Solver::default().solve(&mut problem, control).unwrap();
    let hardness = 0.3 * greatest(&rigid);
    let alone = capped(hardness, 1e-7).solve(&mut problem, control).unwrap();
    let mut solver = capped(hardness, 1e-7);
    let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert_eq!((nested.levels.len(), nested.solution.report.status), (3, Status::Converged));
    let error = nested.solution.distance(&alone);
    assert!(error <= 3e-7, "{error:e}");
    assert!(nested.solution.report.operator_applications <= alone.report.operator_applications);
    // a hardness above all pressures is none
    let mut above = capped(2.0 * greatest(&rigid), 1e-6);
    let above = Nested::default().solve(&mut above, &surface, half_space, NoAdhesion, control).unwrap().solution;
    let rigid =
        Nested::default().solve(&mut Solver::default(), &surface, half_space, NoAdhesion, control).unwrap().solution;
    assert_eq!((&above.gap, &above.pressure), (&rigid.gap, &rigid.pressure));
}

#[test]
fn nested_grids_help_where_all_but_a_little_yields() {
    let grid = Grid::square(256, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(32.0).surface(grid).unwrap();
    let (half_space, control) = (|grid: Grid| Westergaard::<f64>::new(grid, 1.0), Control::MeanPressure(0.001));
    for hardness in [0.0012, 0.001001] {
        let mut solver = capped(hardness, 1e-6);
        let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
        assert_eq!((nested.levels.len(), nested.solution.report.status), (3, Status::Converged));
        let applications = nested.equivalent_applications();
        println!("hardness {hardness}: {applications:.1}");
        assert!(applications < 90.0, "{applications}");
    }
}

#[test]
fn nested_grids_take_a_hardness_that_varies_also_with_a_free_boundary() {
    let grid = Grid::square(128, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let field = Array2::from_shape_fn((128, 128), |(i, _)| if i < 64 { 0.03 } else { 0.06 });
    let constraint = Hardness::varying(field).unwrap();
    let mut solver = Solver { settings: Settings::default().tolerance(1e-7), constraint };
    let half_space = |grid: Grid| Boussinesq::<f64>::new(grid, 1.0);
    let control = Control::Force(4e-3);
    let mut problem = Problem::new(&surface, half_space(grid).unwrap(), NoAdhesion).unwrap();
    let alone = solver.solve(&mut problem, control).unwrap();
    assert!(alone.report.plastic.unwrap().fraction > 0.0);
    // the contact is on a small part of the window
    assert!(alone.report.contact_fraction < 0.25);
    let nested = Nested::default().coarsest(32);
    let found = nested.solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
    assert!(found.levels.len() > 1 && found.solution.report.status == Status::Converged);
    let error = found.solution.distance(&alone);
    assert!(error <= 3e-7, "{error:e}");
}
