//! The free half-space, absent nodes, and what is held: forces, approaches and springs.

mod apart;
mod bodies;
mod cost;
mod dense;
mod operator;
mod springs;
mod window;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use asperity::contact::{ContactStatistics, PressureDistribution};
use asperity::elastic::check_operator;
use asperity::exact::{self, Cone, EllipticHertz, FlatPunch, Hertz, Sphere};
use asperity::path::{Event, Path, PathSettings, PathStep};
use asperity::solver::{Criterion, Iteration};
use asperity::stability::{StabilityTest, Verdict};
use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;

use oracles::dense::{Dense, Held};
use oracles::followed;

/// A free half-space of unit modulus against a surface.
fn problem(surface: &Surface, law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    Problem::new(surface, Boussinesq::new(*surface.grid(), 1.0).unwrap(), law).unwrap()
}

/// A paraboloid of radius 2 in a square window.
fn sphere(n: usize, side: f64) -> Surface {
    Surface::paraboloid(Grid::square(n, side).unwrap(), 2.0).unwrap()
}

/// Solves and watches that the energy falls, but for the rounding of its sums: in the terms that cancel there the
/// surface is pressed flat.
fn solve<T: Real>(problem: &mut Problem<T>, control: Control, tolerance: f64) -> Solution<T> {
    let mut history: Vec<Iteration> = Vec::new();
    let mut solver = Solver::new(Settings::default().tolerance(tolerance));
    let solution = solver
        .solve_with(problem, control, Start::Default, |iteration| {
            history.push(*iteration);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(solution.report.status, Status::Converged, "{control:?}");
    let lengths = history.iter().map(|iteration| iteration.mean_gap.abs()).fold(0.0, f64::max);
    let largest = history.iter().map(|iteration| iteration.energy.abs()).fold(0.0, f64::max);
    let size = largest + problem.operator().stiffness_range().1 * lengths * lengths;
    for pair in history.windows(2).filter(|pair: &&[Iteration]| pair[0].round == pair[1].round) {
        let rise = pair[1].energy - pair[0].energy;
        // in f64 the energy is summed of changes in f32
        let allowed = (8.0 * T::epsilon().widen() * size).max(4.0 * f64::from(f32::EPSILON) * largest);
        assert!(rise <= allowed, "{rise:e} of {size:e} in iteration {}", pair[1].iteration);
    }
    solution
}

fn largest(field: &Array2<f64>) -> f64 {
    field.iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Some bumps in an oblong window with cells that are not square.
fn bumps(shape: (usize, usize)) -> Surface {
    let grid = Grid::new(shape, (1.0, 0.7)).unwrap();
    Surface::from_fn(grid, |x, y| 0.05 * ((9.0 * x + 1.0).cos() * (11.0 * y).cos() - 2.0 * (x * x + y * y) + 0.3 * x))
        .unwrap()
}

/// The same with holes, at an edge too.
fn bumps_with_holes(shape: (usize, usize)) -> Surface {
    let heights = bumps(shape).heights().clone();
    let absent = |i: usize, j: usize| (i * i + 3 * j).is_multiple_of(11) || i + 3 < j && j + 3 > shape.1;
    let holes = Array2::from_shape_fn(shape, |(i, j)| if absent(i, j) { f64::NAN } else { heights[[i, j]] });
    surface_with_absent(*bumps(shape).grid(), holes).unwrap()
}

fn faces(surface: &Surface) -> Vec<bool> {
    let nodes = surface.heights().len();
    surface.absent().map_or(vec![true; nodes], |absent| absent.iter().map(|absent| !absent).collect())
}

#[test]
fn single_precision_and_nested_grids_come_to_the_same_state() {
    let surface = sphere(128, 0.4);
    let control = Control::Force(1e-3);
    let one = solve(&mut problem(&surface, NoAdhesion), control, 1e-6);
    let single = {
        let half_space = Boussinesq::<f32>::new(*surface.grid(), 1.0).unwrap();
        solve(&mut Problem::new(&surface, half_space, NoAdhesion).unwrap(), control, 1e-4)
    };
    assert!((single.report.approach.unwrap() / one.report.approach.unwrap() - 1.0).abs() < 1e-4);
    assert_eq!(single.report.precision, "f32");
    let approach = one.report.approach.unwrap();
    for control in [Control::Approach(approach), Control::Spring { stiffness: 0.1, rest: approach + 1e-3 / 0.1 }] {
        let half_space = Boussinesq::<f32>::new(*surface.grid(), 1.0).unwrap();
        let single = solve(&mut Problem::new(&surface, half_space, NoAdhesion).unwrap(), control, 1e-4);
        assert!((single.report.normal_force / 1e-3 - 1.0).abs() < 1e-3, "{}", single.report.normal_force);
    }
    for control in [control, Control::Approach(one.report.approach.unwrap())] {
        let half_space = |grid: Grid| Boussinesq::<f64>::new(grid, 1.0);
        let mut solver = Solver::default();
        let nested = Nested::default().solve(&mut solver, &surface, half_space, NoAdhesion, control).unwrap();
        assert_eq!((nested.levels.len(), nested.solution.report.status), (2, Status::Converged));
        assert!((nested.solution.report.approach.unwrap() / one.report.approach.unwrap() - 1.0).abs() < 1e-5);
        assert!((nested.solution.report.normal_force / 1e-3 - 1.0).abs() < 1e-5);
    }
}

#[test]
fn a_periodic_cell_takes_forces_springs_and_absent_nodes() {
    let grid = Grid::new((40, 32), (1.0, 0.8)).unwrap();
    let surface = Surface::wave_2d(grid, 0.02, 1).unwrap();
    let half_space = || Westergaard::<f64>::new(grid, 1.0).unwrap();
    let mut wave = Problem::new(&surface, half_space(), NoAdhesion).unwrap();
    let by_pressure = solve(&mut wave, Control::MeanPressure(0.02), 1e-8);
    let gap = by_pressure.report.mean_gap;
    for control in [
        Control::Force(0.016),
        Control::Spring { stiffness: 1e-3, rest: gap - 16.0 },
        Control::Spring { stiffness: 3.0, rest: gap - 0.016 / 3.0 },
        Control::Spring { stiffness: 1e4, rest: gap - 1.6e-6 },
    ] {
        let found = solve(&mut wave, control, 1e-8);
        assert!(largest(&(&found.gap - &by_pressure.gap)) < 1e-7, "{control:?}");
        assert!((found.report.normal_force / 0.016 - 1.0).abs() < 1e-6);
        assert_eq!((found.report.approach, found.report.edge_traction), (None, None));
    }
    // a hole where the contact is: what is left carries the load, and the hole nothing
    let holed = surface
        .heights()
        .indexed_iter()
        .map(|((i, j), h)| if i.abs_diff(20) < 3 && j.abs_diff(16) < 3 { f64::NAN } else { *h });
    let holed = surface_with_absent(grid, Array2::from_shape_vec((40, 32), holed.collect()).unwrap()).unwrap();
    assert_eq!(holed.absent_nodes(), 25);
    let mut problem = Problem::new(&holed, half_space(), NoAdhesion).unwrap();
    let found = solve(&mut problem, Control::MeanPressure(0.02), 1e-8);
    assert!((found.contact_pressure.sum() / 1280.0 - 0.02).abs() < 1e-8);
    assert!(found.gap.iter().filter(|gap| gap.is_infinite()).count() == 25 && found.pressure[[20, 16]] == 0.0);
    // in the hole the half-space is free: K⁻¹u is the pressure, with no force there
    let mut operator = half_space();
    let mut u = Array2::zeros((40, 32));
    operator.displacement(found.pressure.view(), u.view_mut()).unwrap();
    let faces = faces(&holed);
    let shifts: Vec<f64> = found
        .gap
        .iter()
        .zip(holed.heights())
        .zip(&u)
        .zip(&faces)
        .filter(|(_, faces)| **faces)
        .map(|(((g, h), u), _)| g + h - u)
        .collect();
    let (low, high) = shifts.iter().fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(*s), high.max(*s)));
    assert!(high - low < 1e-7, "{low} {high}");
}

#[test]
fn a_sweep_goes_on_from_solution_to_solution() {
    for surface in [bumps((24, 20)), bumps_with_holes((24, 20))] {
        let mut solver = Solver::default();
        let mut problem = problem(&surface, NoAdhesion);
        let mut approaches = Vec::new();
        let mut sweep = Sweep::default();
        for force in [1e-3, 2e-3, 4e-3, 8e-3] {
            let report = sweep.next(&mut solver, &mut problem, Control::Force(force)).unwrap().report;
            assert_eq!(report.status, Status::Converged);
            approaches.push(report.approach.unwrap());
        }
        let mut sweep = Sweep::default();
        for approach in approaches {
            let step = sweep.next(&mut solver, &mut problem, Control::Approach(approach)).unwrap();
            assert!((step.report.approach.unwrap() - approach).abs() < 1e-6);
        }
    }
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let law = Exponential::new(1e-3, 2e-2).unwrap();
            let surface = bumps_with_holes((70, 51));
            let mut problem = problem(&surface, law);
            [Control::Force(5e-3), Control::Approach(0.01), Control::Spring { stiffness: 0.1, rest: 0.01 }]
                .map(|control| solve(&mut problem, control, 1e-6))
        })
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert_eq!(run(threads), one);
    }
}

#[test]
fn a_datum_of_a_million_heights_costs_an_approach_nothing() {
    // heights in units of 2⁻³⁵, so that a datum of 2¹⁷ leaves them as they are
    let (grid, unit) = (Grid::square(32, 0.4).unwrap(), 2.0_f64.powi(-35));
    let force = |datum: f64, approach: f64| {
        let height = |x: f64, y: f64| ((-(x * x + y * y) / 4.0) / unit).round() * unit + datum;
        let surface = Surface::from_fn(grid, height).unwrap();
        solve(&mut problem(&surface, NoAdhesion), Control::Approach(approach), 1e-9).report.normal_force
    };
    for approach in [1e-6, 1e-5, 1e-4] {
        let (low, high) = (force(0.0, approach), force(2.0_f64.powi(17), approach));
        assert!((high / low - 1.0).abs() < 2e-9, "{approach}: {low:e} {high:e}");
    }
}

#[test]
fn what_a_boundary_does_not_have_is_refused_by_name() {
    let grid = Grid::square(16, 1.0).unwrap();
    let flat = Surface::from_fn(grid, |_, _| 0.0).unwrap();
    let mut free = problem(&flat, NoAdhesion);
    let mut periodic = Problem::new(&flat, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let holed = surface_with_absent(grid, grid.sample(|x, y| if x.hypot(y) < 0.2 { f64::NAN } else { 0.0 })).unwrap();
    let mut absent = Problem::new(&holed, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut solver = Solver::default();
    let spring = |stiffness: f64, rest: f64| Control::Spring { stiffness, rest };
    let named = |result: Result<Solution<f64>>, control: &str| match result {
        Err(Error::Unsuited { what: found, .. }) => assert_eq!(found, control),
        other => panic!("{other:?}"),
    };
    named(solver.solve(&mut free, Control::MeanGap(0.1)), "mean-gap");
    named(solver.solve(&mut periodic, Control::Approach(0.1)), "approach");
    named(solver.solve(&mut absent, Control::MeanGap(0.1)), "mean-gap");
    named(solver.solve(&mut absent, spring(1.0, 0.0)), "spring");
    named(solver.solve(&mut absent, Control::Approach(0.0)), "approach");
    for (control, name) in [
        (spring(-1.0, 0.0), "stiffness of the spring"),
        (spring(0.0, 0.0), "stiffness of the spring"),
        (spring(f64::INFINITY, 0.0), "stiffness of the spring"),
        (spring(1.0, f64::NAN), "rest of the spring"),
        (Control::Approach(f64::NAN), "approach"),
        (Control::Force(f64::INFINITY), "normal force"),
    ] {
        match solver.solve(&mut free, control) {
            Err(Error::Value { name: found, .. }) => assert_eq!(found, name),
            other => panic!("{other:?}"),
        }
    }
    let paper = &mut Solver::new(Settings::rey2017().criterion(Criterion::Complementarity));
    assert!(matches!(paper.solve(&mut free, Control::Force(1.0)), Err(Error::Unsuited { .. })));
    assert!(matches!(paper.solve(&mut periodic, spring(1.0, 0.0)), Err(Error::Unsuited { .. })));
    let legs = [Control::MeanPressure(0.0)];
    let refused = Path::new(legs, PathSettings::default()).unwrap().check(&solver, &absent);
    assert!(matches!(refused, Err(Error::Unsuited { what: "path", .. })));
    // surfaces and half-spaces
    let nothing = surface_with_absent(grid, Array2::from_elem((16, 16), f64::NAN));
    assert!(matches!(nothing, Err(Error::Value { name: "number of nodes with a surface", .. })));
    let mut infinite = Array2::from_elem((16, 16), f64::NAN);
    infinite[[3, 4]] = f64::INFINITY;
    assert!(matches!(surface_with_absent(grid, infinite), Err(Error::NotFinite { first: (3, 4), .. })));
    for line in [Grid::line(8, 1.0).unwrap(), Grid::new((1, 8), (1.0, 1.0)).unwrap()] {
        assert!(matches!(Boussinesq::<f64>::new(line, 1.0), Err(Error::Value { .. })));
    }
    assert!(Boussinesq::<f64>::new(grid, -1.0).is_err());
    assert!(Boussinesq::<f32>::new(grid, 1e36).is_ok() && Boussinesq::<f32>::new(grid, 1e39).is_err());
    let other = Grid::square(32, 1.0).unwrap();
    assert!(Problem::new(&flat, Boussinesq::<f64>::new(other, 1.0).unwrap(), NoAdhesion).is_err());
    let longer = Grid::square(16, 2.0).unwrap();
    assert!(Problem::new(&flat, Boussinesq::<f64>::new(longer, 1.0).unwrap(), NoAdhesion).is_err());
    let start = Array2::from_elem((32, 32), 1.0);
    let refused = solver.solve_with(&mut free, Control::Force(0.1), Start::From(&start), |_| ControlFlow::Continue(()));
    assert!(matches!(refused, Err(Error::Shape { .. })));
}
