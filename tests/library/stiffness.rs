//! The contact stiffness, against exact solutions and differences of two solves.

use std::f64::consts::{PI, TAU};

use asperity::stability::{ContactStiffness, StabilityTest};
use asperity::*;
use asperity_maps::surface_with_absent;
use oracles::{rough, solve, solve_from, sphere};

const PUNCH: f64 = 0.3;

fn punch(grid: Grid) -> Surface {
    let heights = grid.sample(|x, y| if x.hypot(y) < PUNCH { 0.0 } else { f64::NAN });
    surface_with_absent(grid, heights).unwrap()
}

#[test]
fn a_contact_of_any_shape_resists_like_a_punch_of_its_radius() {
    for (n, error) in [(64, 2e-3), (128, 1e-3)] {
        let grid = Grid::square(n, 1.0).unwrap();
        let half_space = || Boussinesq::<f64>::new(grid, 3.0).unwrap();
        let sphere = Surface::paraboloid(grid, 2.0).unwrap();
        let mut hertz = Problem::new(&sphere, half_space(), NoAdhesion).unwrap();
        let solution = Solver::default().solve(&mut hertz, Control::Approach(0.04)).unwrap();
        let found = ContactStiffness::of(&mut hertz, &solution).unwrap();
        let exact = 2.0 * (2.0_f64 * 0.04).sqrt() * 3.0;
        assert!((found.force_per_length / exact - 1.0).abs() < error, "{n}: {found:?}");
        assert!((found.force_per_length - found.pressure_per_length).abs() < 1e-12 * exact); // of 1 by 1
        assert!(found.operator_applications <= 14 && found.relative_error <= 1e-6, "{found:?}");

        // the force on a punch is proportional to its approach, on the grid too
        let mut flat = Problem::new(&punch(grid), half_space(), NoAdhesion).unwrap();
        let tight = Settings::default().tolerance(1e-8);
        let solution = Solver::new(tight).solve(&mut flat, Control::Approach(0.01)).unwrap();
        let found = ContactStiffness::of(&mut flat, &solution).unwrap();
        let linear = solution.report.normal_force / 0.01;
        // its map is too large by a share of the spacing
        assert!((found.force_per_length / linear - 1.0).abs() < 2e-6, "{n}: {found:?} {linear}");
        assert!((linear / (2.0 * PUNCH * 3.0) - 1.0).abs() < 1.0 / (PUNCH * f64::from(n as u32)), "{n}: {linear}");
    }
}

#[test]
fn a_wave_on_a_line_follows_its_closed_form() {
    // ḡ = h₀(1 − s + s ln s) and p̄ = p*s, so that −dp̄/dḡ = −πE*/(λ ln s)
    let grid = Grid::line(2048, 1.0).unwrap();
    let mut problem =
        Problem::new(&Surface::wave(grid, 0.02, 1).unwrap(), Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion)
            .unwrap();
    // the edge of what is apart is known to a node, and there are few of these under the largest load
    for (s, error) in [(0.05_f64, 2e-3), (0.3, 2e-3), (0.8, 6e-3)] {
        let solution = solve(&mut problem, Control::MeanPressure(s * PI * 0.02), 1e-8);
        let found = ContactStiffness::of(&mut problem, &solution).unwrap();
        let exact = -PI / s.ln();
        assert!((found.pressure_per_length / exact - 1.0).abs() < error, "{s}: {found:?} {exact}");
    }
}

#[test]
fn the_error_of_a_line_is_known_from_its_edge() {
    // errors pass zero now and then; the scatter of the terms is what is left of the estimate there
    for n in [256, 1024] {
        let grid = Grid::line(n, 1.0).unwrap();
        let wave = Surface::wave(grid, 0.02, 1).unwrap();
        let mut problem = Problem::new(&wave, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
        for s in [0.05_f64, 0.13, 0.3, 0.31, 0.32, 0.8] {
            let solution = solve(&mut problem, Control::MeanPressure(s * PI * 0.02), 1e-9);
            let found = ContactStiffness::of(&mut problem, &solution).unwrap();
            let edge = found.edge.unwrap();
            let gap = solution.report.mean_gap - 0.02 * (1.0 - s + s * s.ln());
            let stiffness = found.pressure_per_length + PI / s.ln();
            for (estimate, error) in [(edge.gap, gap), (edge.stiffness.unwrap(), stiffness)] {
                assert!((0.9..1.2).contains(&(estimate / error.abs())), "{n} {s}: {estimate:e} {error:e}");
            }
        }
    }
}

#[test]
fn the_edge_tells_nothing_where_errors_are_others() {
    let tells = |found: ContactStiffness| found.edge.is_some();
    let grid = Grid::square(32, 1.0).unwrap();
    let wave = Surface::wave_2d(grid, 0.02, 1).unwrap();
    let mut problem = Problem::new(&wave, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let solution = Solver::default().solve(&mut problem, Control::MeanGap(0.01)).unwrap();
    assert!(tells(ContactStiffness::of(&mut problem, &solution).unwrap()));
    let mut springs = Solver { settings: Settings::default(), constraint: Penalty::new(200.0).unwrap() };
    let solution = springs.solve(&mut problem, Control::MeanGap(0.01)).unwrap();
    let found = ContactStiffness::of_constrained(&mut problem, &springs.constraint, &solution, 1e-6).unwrap();
    assert!(solution.report.contact_nodes > 0 && !tells(found), "{found:?}");
    let sphere = Surface::paraboloid(grid, 2.0).unwrap();
    let mut free = Problem::new(&sphere, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let solution = Solver::default().solve(&mut free, Control::Approach(0.04)).unwrap();
    assert!(!tells(ContactStiffness::of(&mut free, &solution).unwrap()));
}

/// −dp̄/dḡ between two solves at nearly the same mean gap.
fn difference(problem: &mut Problem<f64>, solution: &Solution<f64>, step: f64) -> f64 {
    let gap = solution.report.mean_gap;
    let [low, high] = [1.0 - step, 1.0 + step]
        .map(|share| solve_from(problem, Control::MeanGap(share * gap), 1e-10, Some(&solution.gap)).report);
    (low.mean_pressure - high.mean_pressure) / (high.mean_gap - low.mean_gap)
}

#[test]
fn differences_of_two_solves_agree() {
    // as long as hardly a node changes sides
    let mut hard = rough::<f64>(64, 16, NoAdhesion);
    for pressure in [0.01, 0.1, 1.0] {
        let solution = solve(&mut hard, Control::MeanPressure(pressure), 1e-10);
        let found = ContactStiffness::of(&mut hard, &solution).unwrap();
        let expected = difference(&mut hard, &solution, 1e-5);
        assert!((found.pressure_per_length / expected - 1.0).abs() < 2e-3, "{pressure}: {found:?} {expected}");
    }
    let mut sticky = rough::<f64>(64, 16, Exponential::new(4e-4, 4e-3).unwrap());
    for gap in [0.012, 0.03] {
        let solution = solve(&mut sticky, Control::MeanGap(gap), 1e-10);
        let found = ContactStiffness::of(&mut sticky, &solution).unwrap();
        let expected = difference(&mut sticky, &solution, 1e-5);
        assert!((found.pressure_per_length - expected).abs() < 5e-3 * expected.abs(), "{gap}: {found:?} {expected}");
    }
}

#[test]
fn springs_and_laws_without_a_wall_resist_with_their_slopes() {
    let grid = Grid::square(32, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 1).unwrap();
    let half_space = || Westergaard::<f64>::new(grid, 1.0).unwrap();
    let tight = Settings::default().tolerance(1e-9);
    let mut pressed = Problem::new(&surface, half_space(), NoAdhesion).unwrap();
    let mut springs = Solver { settings: tight, constraint: Penalty::new(200.0).unwrap() };
    let mut reports = |gap| springs.solve(&mut pressed, Control::MeanGap(gap)).unwrap();
    let (solution, [low, high]) = (reports(0.01), [0.00999, 0.01001].map(|gap| reports(gap).report));
    let expected = (low.mean_pressure - high.mean_pressure) / (high.mean_gap - low.mean_gap);
    let found = ContactStiffness::of_constrained(&mut pressed, &springs.constraint, &solution, 1e-8).unwrap();
    assert!((found.pressure_per_length / expected - 1.0).abs() < 1e-3, "{found:?} {expected}");
    // a solution of springs is none of a rigid wall
    let error = ContactStiffness::of(&mut pressed, &solution).unwrap_err();
    assert!(matches!(error, Error::Unsuited { what: "rigid", .. }), "{error}");

    let mut soft = Problem::new(&surface, half_space(), LennardJones::new(1e-3, 5e-3).unwrap()).unwrap();
    let mut no_wall = Solver { settings: tight, constraint: NoWall };
    let mut reports = |gap| no_wall.solve(&mut soft, Control::MeanGap(gap)).unwrap();
    let (solution, [low, high]) = (reports(0.012), [0.01199, 0.01201].map(|gap| reports(gap).report));
    let expected = (low.mean_pressure - high.mean_pressure) / (high.mean_gap - low.mean_gap);
    let found = ContactStiffness::of_constrained(&mut soft, &NoWall, &solution, 1e-8).unwrap();
    assert!((found.pressure_per_length / expected - 1.0).abs() < 1e-3, "{found:?} {expected}");
}

#[test]
fn under_uzawa_stiffness_and_stability_are_those_of_the_rigid_wall() {
    for mut problem in [rough::<f64>(32, 8, NoAdhesion), rough(32, 8, Exponential::new(1e-3, 3e-2).unwrap())] {
        for pressure in [0.05, 1.0] {
            let (control, settings) = (Control::MeanPressure(pressure), Settings::default().tolerance(1e-9));
            let rigid = Solver::new(settings).solve(&mut problem, control).unwrap();
            let stiffness = ContactStiffness::of(&mut problem, &rigid).unwrap().pressure_per_length;
            let eigenvalue = StabilityTest::default().run(&mut problem, &rigid).unwrap().eigenvalue;
            for softest in [10.0, 1e4] {
                let mut solver = Solver { settings, constraint: Uzawa::new(softest).unwrap() };
                let solution = solver.solve(&mut problem, control).unwrap();
                let wall = &solver.constraint;
                assert_eq!(solution.report.contact_nodes, rigid.report.contact_nodes);
                let found = ContactStiffness::of_constrained(&mut problem, wall, &solution, 1e-6).unwrap();
                assert!(
                    (found.pressure_per_length / stiffness - 1.0).abs() < 1e-5,
                    "{pressure}: {found:?} {stiffness}"
                );
                // each eigenvalue is right to the square of the test's tolerance
                let found = StabilityTest::default().run_with(&mut problem, wall, &solution).unwrap().eigenvalue;
                assert!((found / eigenvalue - 1.0).abs() < 1e-4, "{pressure}: {found} {eigenvalue}");
            }
        }
    }
}

#[test]
fn all_in_contact_is_rigid_and_no_contact_is_free() {
    let grid = Grid::square(16, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 1e-3, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let full = solve(&mut problem, Control::MeanPressure(1.0), 1e-6);
    assert_eq!(full.report.contact_nodes, 256);
    let found = ContactStiffness::of(&mut problem, &full).unwrap();
    assert_eq!((found.pressure_per_length, found.force_per_length), (f64::INFINITY, f64::INFINITY));
    let apart = solve(&mut problem, Control::MeanGap(0.01), 1e-6);
    assert_eq!(apart.report.contact_nodes, 0);
    assert_eq!(ContactStiffness::of(&mut problem, &apart).unwrap().pressure_per_length, 0.0);

    let grid = Grid::square(16, 1.0).unwrap();
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let law = Exponential::new(1e-3, 1e-2).unwrap();
    let mut flats = Problem::new(&flat, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    // stable at this mean gap, and less than nothing resists
    let even = solve(&mut flats, Control::MeanGap(0.02), 1e-8);
    let found = ContactStiffness::of(&mut flats, &even).unwrap();
    assert!((found.force_per_length + 10.0 * (-2.0_f64).exp()).abs() < 1e-9, "{found:?}");
}

#[test]
fn an_equilibrium_that_does_not_last_has_no_stiffness() {
    let grid = Grid::square(16, 1.0).unwrap();
    let wavy = Surface::wave_2d(grid, 1e-6, 1).unwrap();
    let law = Exponential::new(1e-3, 1e-2).unwrap();
    let mut problem = Problem::new(&wavy, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let mut saddle = Solver::default().solve(&mut problem, Control::MeanGap(0.008)).unwrap();
    // all gaps are below 0.0116, where the longest wave becomes unstable
    saddle.gap = grid.sample(|x, y| 0.008 + 0.002 * (TAU * x).cos() * (TAU * y).cos());
    assert!(ContactStiffness::of(&mut problem, &saddle).unwrap().pressure_per_length.is_nan());
}

#[test]
fn precisions_layouts_and_jumps_of_a_law() {
    let law = MaugisDugdale::new(1e-4, 2e-3).unwrap();
    let mut double = sphere::<f64>(64, law);
    let solution = solve(&mut double, Control::MeanGap(0.0429), 1e-6);
    let found = ContactStiffness::of(&mut double, &solution).unwrap();
    assert!(found.smoothed && found.pressure_per_length.is_finite());
    let mut columns = solution.clone();
    columns.gap = solution.gap.t().as_standard_layout().into_owned().reversed_axes();
    assert_eq!(ContactStiffness::of(&mut double, &columns).unwrap(), found);

    let mut reference = rough::<f64>(64, 16, NoAdhesion);
    let mut single = rough::<f32>(64, 16, NoAdhesion);
    let control = Control::MeanPressure(0.1);
    let exact = solve(&mut reference, control, 1e-8);
    let near = Solver::default().solve(&mut single, control).unwrap();
    let [exact, near] =
        [ContactStiffness::of(&mut reference, &exact).unwrap(), ContactStiffness::of(&mut single, &near).unwrap()];
    assert!(!exact.smoothed && near.relative_error <= 1e-4);
    assert!((near.pressure_per_length / exact.pressure_per_length - 1.0).abs() < 1e-3, "{near:?} {exact:?}");
    // found from above, within its bound
    let mut loose = rough::<f64>(64, 16, NoAdhesion);
    let solution = solve(&mut loose, control, 1e-8);
    for tolerance in [1e-1, 1e-2, 1e-3] {
        let found = ContactStiffness::of_constrained(&mut loose, &Projection, &solution, tolerance).unwrap();
        let excess = found.pressure_per_length / exact.pressure_per_length - 1.0;
        assert!(found.relative_error <= tolerance);
        assert!((-1e-6..=found.relative_error).contains(&excess), "{tolerance}: {found:?} {excess}");
    }
    let error = ContactStiffness::of_constrained(&mut loose, &Projection, &solution, 0.0).unwrap_err();
    assert!(matches!(error, Error::Value { name: "tolerance", .. }), "{error}");
    let mut other = solution;
    other.gap = ndarray::Array2::zeros((3, 3));
    let error = ContactStiffness::of(&mut double, &other);
    assert!(matches!(error, Err(Error::Value { name: "work of adhesion", .. })), "{error:?}");
    let error = ContactStiffness::of(&mut loose, &other);
    assert!(matches!(error, Err(Error::Shape { name: "gap", .. })), "{error:?}");
}
