//! A cap on the contact pressure: its limits, exact solutions, a dense solution, and what remains after unloading.
//!
//! `cargo test --release --test library hardness::dense -- --nocapture` prints what the random scenes take; `CASES`
//! says on how many.

mod cycle;
mod dense;
mod nested;

use std::f64::consts::PI;
use std::ops::ControlFlow::{Break, Continue};

use approx::assert_relative_eq;
use asperity::path::{Path, PathSettings};
use asperity::solver::Iteration;
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::{Array2, Zip};
use oracles::dense::Dense;
use oracles::rough::rough as rough_surface;
use oracles::{Checkpoint, followed, rough, sphere, swept};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

fn capped(hardness: f64, tolerance: f64) -> Solver<Hardness> {
    Solver { settings: Settings::default().tolerance(tolerance), constraint: Hardness::new(hardness).unwrap() }
}

fn greatest<T: Real>(solution: &Solution<T>) -> f64 {
    solution.contact_pressure.iter().fold(0.0, |most, p| most.max(p.widen()))
}

/// Solves with a rigid wall and with a hardness ten times the greatest pressure, and compares all bits.
fn has_the_bits_of_no_cap<T: Real>(problem: &mut Problem<T>, control: Control) {
    let rigid = Solver::default().solve(problem, control).unwrap();
    let constraint = Hardness::new(1e3 * greatest(&rigid)).unwrap();
    let hard = Solver { settings: Settings::default(), constraint }.solve(problem, control).unwrap();
    assert_eq!((&hard.gap, &hard.pressure), (&rigid.gap, &rigid.pressure), "{control:?}");
    assert_eq!(hard.contact_pressure, rigid.contact_pressure);
    let [a, b] = [&hard, &rigid].map(|solution| {
        let report = &solution.report;
        (report.iterations, report.operator_applications, report.relative_error.to_bits(), report.contact_nodes)
    });
    assert_eq!(a, b);
    let plastic = hard.report.plastic.unwrap();
    assert_eq!((plastic.fraction, plastic.depth_max, plastic.energy), (0.0, 0.0, 0.0));
    assert!(hard.plastic_depth.unwrap().iter().all(|depth| *depth == T::zero()));
}

#[test]
fn a_hardness_above_all_pressures_has_the_bits_of_none() {
    for control in [Control::MeanPressure(2e-4), Control::MeanGap(0.0398)] {
        has_the_bits_of_no_cap(&mut sphere::<f64>(64, NoAdhesion), control);
        has_the_bits_of_no_cap(&mut sphere::<f32>(64, NoAdhesion), control);
    }
    for control in [Control::MeanPressure(0.02), Control::MeanGap(0.03)] {
        has_the_bits_of_no_cap(&mut rough::<f64>(96, 8, NoAdhesion), control);
        has_the_bits_of_no_cap(&mut rough::<f64>(96, 8, Exponential::new(1e-5, 1e-2).unwrap()), control);
        has_the_bits_of_no_cap(&mut rough::<f32>(96, 8, MaugisDugdale::new(1e-5, 1e-2).unwrap()), control);
    }
    let grid = Grid::square(48, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let mut free = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    for control in [Control::Force(5e-4), Control::Approach(0.003)] {
        has_the_bits_of_no_cap(&mut free, control);
    }
}

#[test]
fn pressures_are_at_most_the_hardness_and_depths_only_where_it_is_reached() {
    for (share, control) in [0.5, 0.2].into_iter().zip([Control::MeanPressure(0.02), Control::MeanGap(0.04)]) {
        let mut problem = rough::<f64>(96, 8, NoAdhesion);
        let rigid = Solver::default().solve(&mut problem, control).unwrap();
        let hardness = share * greatest(&rigid);
        let solution = capped(hardness, 1e-7).solve(&mut problem, control).unwrap();
        let (report, depth) = (&solution.report, solution.plastic_depth.as_ref().unwrap());
        assert_eq!(report.status, Status::Converged);
        let plastic = report.plastic.unwrap();
        for ((&p, &gap), &depth) in solution.contact_pressure.iter().zip(&solution.gap).zip(depth) {
            assert!((0.0..=hardness).contains(&p) && gap >= 0.0 && depth >= 0.0);
            assert!(depth == 0.0 || (p == hardness && gap == 0.0));
            assert!(p == 0.0 || gap == 0.0);
        }
        let yielded = depth.iter().filter(|&&depth| depth > 0.0).count() as f64;
        assert!(yielded > 0.0 && plastic.fraction == yielded / depth.len() as f64);
        assert_relative_eq!(plastic.depth_mean, depth.mean().unwrap(), max_relative = 1e-12);
        assert_relative_eq!(plastic.energy, hardness * plastic.depth_mean, max_relative = 1e-12);
        assert_relative_eq!(report.mean_gap, solution.gap.mean().unwrap(), max_relative = 1e-12);
        // a mean gap that is given is to the surface as it was made
        if let Control::MeanGap(gap) = control {
            assert_relative_eq!(report.mean_gap - plastic.depth_mean, gap, max_relative = 1e-12);
        }
    }
}

#[test]
fn a_sphere_first_yields_where_hertz_says_and_its_depth_grows() {
    // p₀ = H at P = π³R²H³/6E*²
    let (n, radius, length): (usize, f64, f64) = (256, 1.0, 0.2);
    let grid = Grid::square(n, length).unwrap();
    let surface = Surface::paraboloid(grid, radius).unwrap();
    let hardness: f64 = 0.03;
    let first = PI.powi(3) * radius * radius * hardness.powi(3) / 6.0;
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut yields = |share: f64| {
        let solution = capped(hardness, 1e-8).solve(&mut problem, Control::Force(share * first)).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        solution.report.plastic.unwrap()
    };
    // the pressure at the first node to yield is within 1 % of Hertz' at 48 nodes across the contact
    assert_eq!(yields(0.97).fraction, 0.0);
    let [a, b, c] = [1.03, 1.5, 3.0].map(&mut yields);
    assert!(a.fraction > 0.0 && a.fraction < b.fraction && b.fraction < c.fraction);
    assert!(a.depth_max < b.depth_max && b.depth_max < c.depth_max);
}

#[test]
fn a_soft_surface_carries_its_hardness_everywhere() {
    // H → 0: each node in contact has yielded, A/A₀ = p̄/H
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    for (hardness, share) in [(1e-4, 0.3), (1e-5, 0.1)] {
        let solution = capped(hardness, 1e-7).solve(&mut problem, Control::MeanPressure(share * hardness)).unwrap();
        assert_eq!(solution.report.status, Status::Converged);
        // but for contact nodes at the edge that have not, of a share about H/E* of the slopes
        let area = solution.report.contact_fraction;
        assert!(area >= share * (1.0 - 1e-6) && area - share < 5e-3, "{area}");
    }
}

#[test]
fn loads_close_to_the_hardness_close_the_contact_and_one_beyond_it_is_refused() {
    let mut problem = rough::<f64>(64, 8, NoAdhesion);
    for hardness in [0.02, 0.5] {
        let mut last = 0.0;
        for share in [0.9, 0.99, 0.999] {
            let control = Control::MeanPressure(share * hardness);
            let report = capped(hardness, 1e-6).solve(&mut problem, control).unwrap().report;
            assert_eq!(report.status, Status::Converged, "{share} of {hardness}");
            assert!(report.contact_fraction >= share && report.contact_fraction >= last);
            last = report.contact_fraction;
        }
        assert!(last > 0.999);
        for share in [1.0, 2.0] {
            let refused = capped(hardness, 1e-6).solve(&mut problem, Control::MeanPressure(share * hardness));
            assert!(matches!(refused, Err(Error::Value { name: "mean pressure", .. })));
        }
    }
}

#[test]
fn a_load_that_has_not_converged_leaves_no_depth() {
    let mut solver = capped(0.05, 1e-9);
    let [low, high] = [1e-3, 0.02].map(Control::MeanPressure);
    let mut problem = rough::<f64>(48, 6, NoAdhesion);
    let alone = swept(&mut Sweep::default(), &mut solver, &mut problem, &[low, low]);
    problem.flatten(Array2::zeros((48, 48)).view()).unwrap();
    let mut sweep = Sweep::default();
    let first = sweep.next(&mut solver, &mut problem, low).unwrap();
    let stopped = |state: &Iteration| if state.iteration < 8 { Continue(()) } else { Break(()) };
    let second = sweep.next_observed(&mut solver, &mut problem, high, stopped).unwrap();
    assert!(
        second.report.status == Status::Stopped
            && second.plastic_depth.unwrap() != *first.plastic_depth.as_ref().unwrap()
    );
    assert_eq!(problem.plastic_depth(), first.plastic_depth);
    let third = sweep.next(&mut solver, &mut problem, low).unwrap();
    assert!(third.distance(&alone[1]) < 1e-8);
    // a path takes a state that cannot be reached by shorter steps as it is
    problem.flatten(Array2::zeros((48, 48)).view()).unwrap();
    solver.settings = solver.settings.max_iterations(8);
    let mut path = Path::new([high], PathSettings::default()).unwrap();
    let begun = path.next(&mut solver, &mut problem).unwrap().unwrap();
    assert!(
        begun.solution.report.status == Status::IterationLimit && begun.solution.plastic_depth.unwrap().sum() > 0.0
    );
    assert_eq!(problem.plastic_depth().unwrap().sum(), 0.0);
}

#[test]
fn any_share_of_contact_is_found_at_any_hardness() {
    let grid = Grid::square(32, 1.0).unwrap();
    let surface = SelfAffine::default().k_s(8.0).amplitude(Amplitude::RmsSlope(0.2)).surface(grid).unwrap();
    fn finds(mut problem: Problem<f64>, constraint: Hardness) {
        for fraction in [0.03, 0.3, 0.7, 0.97] {
            let mut solver = Solver { settings: Settings::default(), constraint: constraint.clone() };
            let found = ContactSearch::default().at(&mut solver, &mut problem, fraction).unwrap();
            let report = &found.solution.report;
            assert!(found.reached, "{fraction} at {}: {report:?}", constraint.mean());
            // to a node or 1 %
            assert!((report.contact_fraction - fraction).abs() <= (0.01 * fraction).max(1.0 / 1024.0));
        }
    }
    for hardness in [1e-3, 0.02, 0.1, 1.0] {
        let varying = Array2::from_shape_fn((32, 32), |(i, j)| hardness * (1 + (3 * i + j) % 7) as f64);
        for constraint in [Hardness::new(hardness).unwrap(), Hardness::varying(varying).unwrap()] {
            finds(
                Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), NoAdhesion).unwrap(),
                constraint.clone(),
            );
            finds(Problem::new(&surface, Boussinesq::new(grid, 1.0).unwrap(), NoAdhesion).unwrap(), constraint);
        }
    }
}

#[test]
fn every_law_control_body_and_precision_works_with_it() {
    let law = Exponential::new(1e-5, 1e-2).unwrap();
    for control in [Control::MeanPressure(0.02), Control::MeanGap(0.04)] {
        let double = capped(0.3, 1e-6).solve(&mut rough::<f64>(64, 8, law), control).unwrap();
        let single = capped(0.3, 1e-4).solve(&mut rough::<f32>(64, 8, law), control).unwrap();
        assert_eq!((double.report.status, single.report.status), (Status::Converged, Status::Converged), "{control:?}");
        let [a, b] = [double.report.plastic.unwrap(), single.report.plastic.unwrap()];
        assert_relative_eq!(a.energy, b.energy, max_relative = 2e-2, epsilon = 1e-12);
        assert!(greatest(&double) <= 0.3);
    }
    // absent nodes, and a free boundary
    let grid = Grid::square(48, 1.0).unwrap();
    let sphere = Surface::paraboloid(grid, 2.0).unwrap();
    let mut heights = sphere.heights().clone();
    heights.iter_mut().step_by(7).for_each(|h| *h = f64::NAN);
    let holes = surface_with_absent(grid, heights).unwrap();
    let mut problem = Problem::new(&holes, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let periodic = capped(0.05, 1e-6).solve(&mut problem, Control::MeanPressure(5e-4)).unwrap();
    let mut problem = Problem::new(&holes, Boussinesq::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    for control in [Control::Force(5e-4), Control::Approach(4e-3), Control::Spring { stiffness: 0.5, rest: 6e-3 }] {
        let free = capped(0.05, 1e-6).solve(&mut problem, control).unwrap();
        for solution in [&periodic, &free] {
            assert_eq!(solution.report.status, Status::Converged, "{control:?}");
            assert!(solution.report.plastic.unwrap().fraction == 0.0 || greatest(solution) == 0.05);
            assert!(greatest(solution) <= 0.05);
            let depth = solution.plastic_depth.as_ref().unwrap();
            assert!(solution.gap.iter().zip(depth).all(|(gap, depth)| gap.is_finite() || *depth == 0.0));
        }
    }
}

#[test]
fn a_depth_in_any_order_in_memory_lowers_the_surface_of_a_free_half_space() {
    let grid = Grid::new((24, 16), (1.5, 1.0)).unwrap();
    let surface = Surface::paraboloid(grid, 2.0).unwrap();
    let mut problem = Problem::new(&surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let depth = grid.sample(|x, y| (0.01 - x * x - 2.0 * y * y).max(0.0));
    for depth in [depth.clone(), depth.t().as_standard_layout().into_owned().reversed_axes()] {
        problem.flatten(depth.view()).unwrap();
        assert_eq!(problem.plastic_depth().unwrap(), depth);
    }
}

#[test]
fn what_has_no_meaning_is_refused_by_name() {
    assert!(matches!(Hardness::new(0.0), Err(Error::Value { name: "hardness", .. })));
    assert!(matches!(Hardness::new(f64::NAN), Err(Error::Value { name: "hardness", .. })));
    assert!(matches!(Hardness::varying(Array2::zeros((0, 3))), Err(Error::Shape { name: "hardness", .. })));
    let mut field = Array2::from_elem((32, 32), 0.2);
    field[[3, 4]] = -1.0;
    assert!(matches!(Hardness::varying(field), Err(Error::Value { name: "hardness", value, .. }) if value == -1.0));
    let mut problem = sphere::<f64>(64, NoAdhesion);
    let control = Control::MeanPressure(1e-4);
    let constraint = Hardness::varying(Array2::from_elem((48, 48), 0.2)).unwrap();
    let other = Solver { settings: Settings::default(), constraint }.solve(&mut problem, control);
    assert!(matches!(other, Err(Error::Shape { name: "hardness", .. })));
    let paper = Solver { settings: Settings::rey2017(), constraint: Hardness::new(0.1).unwrap() };
    assert!(matches!({ paper }.solve(&mut problem, control), Err(Error::Unsuited { .. })));
    // attraction that crushes each contact
    let law = Exponential::new(1e-3, 1e-3).unwrap();
    let crushed = capped(0.5, 1e-6).solve(&mut sphere::<f64>(64, law), control);
    assert!(matches!(crushed, Err(Error::Value { name: "adhesive traction at contact", value, .. }) if value == 1.0));
    // an equilibrium that is not one of an energy
    let solution = capped(0.02, 1e-6).solve(&mut problem, Control::MeanPressure(3e-4)).unwrap();
    let stable = stability::StabilityTest::default().run_with(&mut problem, &Hardness::new(0.02).unwrap(), &solution);
    assert!(matches!(stable, Err(Error::Unsuited { .. })));
    assert!(matches!(problem.flatten(Array2::from_elem((64, 64), -1.0).view()), Err(Error::Value { .. })));
    assert!(matches!(problem.flatten(Array2::zeros((64, 63)).view()), Err(Error::Shape { .. })));
}
