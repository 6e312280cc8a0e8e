//! How many applications and how much memory solves on a free half-space take.

use super::*;

/// All applications in units of one on the finest grid, against the applications of the finest grid alone: with contact
/// on a part of the window, and on most of it.
#[test]
fn nested_grids_take_few_applications_under_every_control() {
    let grid = Grid::square(256, 1.0).unwrap();
    let roughness = SelfAffine::default().k_s(16.0).amplitude(Amplitude::RmsSlope(0.05));
    let tip = Surface::paraboloid(grid, 1.0).unwrap().heights() + roughness.surface(grid).unwrap().heights();
    let tip = Surface::new(grid, tip).unwrap();
    let adhesion = Exponential::new(1e-4, 2e-3).unwrap();
    let spring = Control::Spring { stiffness: 0.1, rest: 0.02 };
    let free = |grid: Grid| Boussinesq::<f64>::new(grid, 1.0);
    for (law, control, counted) in [
        (None, Control::Force(3e-4), 9.1),
        (None, Control::Approach(0.01), 8.9),
        (None, spring, 8.7),
        (None, Control::Force(0.02), 25.9),
        (Some(adhesion), Control::Force(3e-4), 37.5),
        (Some(adhesion), Control::Approach(0.01), 34.5),
        (Some(adhesion), Control::Force(0.02), 32.0),
    ] {
        let law: Arc<dyn AdhesionLaw<f64>> = law.map_or(Arc::new(NoAdhesion), |law| Arc::new(law));
        let one = solve(&mut problem(&tip, law.clone()), control, 1e-6);
        let nested = Nested::default().solve(&mut Solver::default(), &tip, free, law, control).unwrap();
        let (taken, alone) = (nested.equivalent_applications(), one.report.operator_applications + 1);
        println!("{control:?}: {taken:.1} of {counted}, {alone}");
        assert!(taken <= counted + 2.05, "{control:?}: {taken} and not {counted}, {alone} on one grid");
        assert_eq!(nested.solution.report.status, Status::Converged);
        assert!((nested.solution.report.approach.unwrap() / one.report.approach.unwrap() - 1.0).abs() < 1e-5);
        assert!((nested.solution.report.normal_force / one.report.normal_force - 1.0).abs() < 1e-5);
        assert!(nested.solution.report.contact_nodes.abs_diff(one.report.contact_nodes) <= 5);
        // the whole of the window has its gaps
        let differs = nested.solution.gap.iter().zip(&one.gap).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(differs < 1e-5 * one.report.mean_gap, "{differs:e}");
    }
}

#[test]
fn an_iteration_allocates_nothing_and_a_solve_twenty_three_fields_of_the_window() {
    let surface = bumps((250, 256));
    let field = (surface.heights().len() * size_of::<f64>()) as f64;
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| {
        let few = |iterations| Settings::default().max_iterations(iterations).tolerance(1e-14);
        let law = Exponential::new(1e-3, 2e-2).unwrap();
        let problem = std::cell::RefCell::new(problem(&surface, law));
        let count = |iterations| {
            let counted = allocation_counter::measure(|| {
                Solver::new(few(iterations)).solve(&mut problem.borrow_mut(), Control::Force(5e-3)).unwrap();
            });
            counted.count_total
        };
        count(1);
        // beyond the solve of the wall alone
        assert_eq!(count(60), count(80));
        drop(problem);
        let solved = allocation_counter::measure(|| {
            let half_space = Boussinesq::<f64>::new(*surface.grid(), 1.0).unwrap();
            let mut problem = Problem::new(&surface, half_space, law).unwrap();
            Solver::new(few(4)).solve(&mut problem, Control::Force(5e-3)).unwrap();
        });
        // besides the coarse space, plans, tiles and the partial sums of a reduction
        let coarse_space = 13.0 * 8.0 * (4.0 * surface.heights().len() as f64).powf(2.0 / 3.0);
        let fields = (solved.bytes_max as f64 - coarse_space) / field;
        assert!((22.0..23.5).contains(&fields), "{fields}");
    });
}

#[test]
fn applications_hardly_grow_with_the_window() {
    let of = |n: usize| {
        solve(&mut problem(&sphere(n, 0.4), NoAdhesion), Control::Force(1e-3), 1e-6).report.operator_applications
    };
    let (small, large) = (of(64), of(256));
    assert!(large <= 60 && 2 * large <= 3 * small, "{small} {large}");
}

#[test]
#[ignore = "a window of 512 x 512 nodes: cargo test --release --test library applications_at_512 -- --ignored"]
fn applications_at_512_are_at_most_sixty() {
    let of = |n: usize| {
        solve(&mut problem(&sphere(n, 0.4), NoAdhesion), Control::Force(1e-3), 1e-6).report.operator_applications
    };
    let (small, large) = (of(64), of(512));
    assert!(large <= 60 && 2 * large <= 3 * small, "{small} {large}");
}
