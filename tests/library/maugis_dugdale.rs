//! The two spheres of Rey, Anciaux and Molinari (2017) with the law of Maugis and Dugdale, from a start that does not
//! know the answer, against the exact solution among periodic images.

use std::ops::ControlFlow;

use asperity::exact::{MaugisDugdale as Exact, Periodic};
use asperity::*;
use ndarray::Array2;

const RADIUS: f64 = 2.0;

/// Range, work of adhesion and mean gap of Figures 2 and 3.
const STATES: [(f64, f64, f64); 2] = [(3e-4, 1e-5, 0.0405), (2e-3, 1e-4, 0.0429)];

/// Relative errors in the energy norm and in L² of u without its mean, and the absolute one of p̄.
fn errors(n: usize, (range, work, gap): (f64, f64, f64), start: Option<f64>) -> [f64; 3] {
    let grid = Grid::square(n, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, RADIUS).unwrap();
    let sphere = Exact::new(RADIUS, 1.0, work, range).unwrap();
    let exact = Periodic::new(sphere, 1.0).unwrap().at_mean_gap(gap, surface.mean()).unwrap();
    let law = MaugisDugdale::new(work, range).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap();
    let mut solver = Solver::new(Settings::default().tolerance(1e-7));
    let start = start.map(|gap| Array2::from_elem(grid.shape(), gap));
    let start = start.as_ref().map_or(Start::Default, |gap| Start::From(gap));
    let control = Control::MeanGap(gap);
    let found = solver.solve_with(&mut problem, control, start, |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(found.report.status, Status::Converged);

    let reference = exact.displacement_field(&grid).unwrap();
    let mut half_space = Westergaard::<f64>::new(grid, 1.0).unwrap();
    let mut norms = |u: Array2<f64>| {
        let mean = u.sum() / u.len() as f64;
        let (u, mut p) = (u.mapv(|u| u - mean), Array2::zeros(grid.shape()));
        half_space.pressure(u.view(), p.view_mut()).unwrap();
        ((&u * &p).sum().sqrt(), (&u * &u).sum().sqrt())
    };
    let (energy, l2) = norms(&found.gap + surface.heights() - &reference);
    let (whole_energy, whole_l2) = norms(reference);
    [energy / whole_energy, l2 / whole_l2, (found.report.mean_pressure - exact.mean_pressure()).abs()]
}

#[test]
fn errors_fall_from_grid_to_grid_from_the_default_start() {
    // the pressure is of order √(distance) at the contact edge and jumps at c: its energy norm converges like Δx
    for state in STATES {
        let found = [64, 128, 256, 512].map(|n| errors(n, state, None));
        for (k, least) in [(0, 0.9), (1, 1.2)] {
            assert!(found.windows(2).all(|pair| pair[1][k] < pair[0][k]), "{found:?}");
            let rate = (found[0][k] / found[3][k]).log2() / 3.0;
            assert!(rate > least, "{rate} {found:?}");
        }
        assert!(found[3][0] < 0.025 && found[3][1] < 0.01, "{found:?}");
        // half a per cent of the JKR pull-off pressure, 1.5 π w R
        assert!(found[3][2] < 0.005 * 1.5 * std::f64::consts::PI * state.1 * RADIUS, "{found:?}");
    }
}

#[test]
#[ignore = "a minute: cargo test --release --test library maugis_dugdale:: -- --ignored"]
fn errors_go_on_falling_to_2048() {
    for state in STATES {
        let found = [512, 1024, 2048].map(|n| errors(n, state, None));
        assert!((0..2).all(|k| found.windows(2).all(|pair| pair[1][k] < 0.7 * pair[0][k])), "{found:?}");
    }
}

#[test]
fn a_uniform_gap_that_is_given_does_as_well_as_the_default_start() {
    let [default, given] = [None, Some(STATES[1].2)].map(|start| errors(128, STATES[1], start));
    assert!(given[1] < 1.01 * default[1], "{default:?} {given:?}");
}

#[test]
fn a_loop_of_given_starts_bears_no_more_than_the_pull_off() {
    let grid = Grid::line(256, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.01, 1).unwrap();
    let w = 4.4e-5;
    let range = (w / 256.0_f64).sqrt() / 0.5; // μ_ρ = ½
    let law = MaugisDugdale::new(w, range).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let exact = asperity::exact::AdhesiveWavyLine::new(0.01, 1.0, 1.0, w).unwrap().pull_off().unwrap().mean_pressure();
    let (mut solver, mut gap) = (Solver::default(), None::<Array2<f64>>);
    let mut load = 0.2 * 0.01 * std::f64::consts::PI;
    let borne = loop {
        let start = gap.as_ref().map_or(Start::Default, |gap| Start::From(gap));
        let control = Control::MeanPressure(load);
        let found = solver.solve_with(&mut problem, control, start, |_| ControlFlow::Continue(())).unwrap();
        if found.report.status == Status::Detached {
            break load;
        }
        assert_eq!(found.report.status, Status::Converged);
        gap = Some(found.gap);
        load += 0.02 * exact;
    };
    assert!((0.98..1.05).contains(&(borne / exact)), "{borne} {exact}");
}

#[test]
fn a_law_comes_back_as_it_was_however_the_solve_ends() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, RADIUS).unwrap();
    let law = MaugisDugdale::new(1e-4, 2e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let control = Control::MeanGap(0.0429);
    let adhesive =
        |solution: &Solution<f64>| solution.gap.iter().map(|&g| law.energy(g)).sum::<f64>() / solution.gap.len() as f64;
    for limit in [0, 3, 12, 2000] {
        let mut solver = Solver::new(Settings::default().max_iterations(limit));
        let limited = solver.solve(&mut problem, control).unwrap();
        assert_eq!(limited.report.status == Status::Converged, limit == 2000);
        let mut smoothed = 0;
        let stopped = Solver::default()
            .solve_with(&mut problem, control, Start::Default, |iteration| {
                smoothed += usize::from(iteration.smoothed);
                if iteration.iteration < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            })
            .unwrap();
        assert!(smoothed > 0 && stopped.report.iterations <= limit);
        for solution in [limited, stopped] {
            assert!((solution.report.adhesive_energy - adhesive(&solution)).abs() <= 1e-12 * 1e-4);
        }
    }
}

#[test]
fn a_solve_that_is_cut_as_its_smoothed_law_lets_go_keeps_its_gap() {
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = Surface::paraboloid(grid, RADIUS).unwrap();
    let law = MaugisDugdale::new(1e-4, 2e-3).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    let control = Control::MeanPressure(-3e-3);
    let mut end = 0;
    let lost = Solver::default()
        .solve_with(&mut problem, control, Start::Default, |iteration| {
            end = if iteration.round == 0 { iteration.iteration } else { end };
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(lost.report.status, Status::Detached);
    for limit in [end - 1, end] {
        let cut = Solver::new(Settings::default().max_iterations(limit)).solve(&mut problem, control).unwrap();
        assert_eq!((cut.report.status, cut.report.iterations), (Status::IterationLimit, limit));
        assert!(cut.gap.iter().any(|&gap| gap != cut.gap[[0, 0]]), "uniform at {limit}");
    }
}

#[test]
fn on_a_line_too_the_pressure_converges_from_the_default_start() {
    // (the spacing that sets the smoothing is that along the line, not the width)
    let (amplitude, law) = (0.02, MaugisDugdale::new(2e-5, 4e-4).unwrap());
    let found = [512, 1024, 2048].map(|n| {
        let grid = Grid::line(n, 1.0).unwrap();
        let surface = Surface::wave(grid, amplitude, 1).unwrap();
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let report = Solver::default().solve(&mut problem, Control::MeanGap(0.5 * amplitude)).unwrap().report;
        assert_eq!(report.status, Status::Converged);
        report.mean_pressure
    });
    let [coarse, fine] = [found[1] - found[0], found[2] - found[1]].map(f64::abs);
    assert!(coarse < 5e-3 * found[2].abs() && fine < coarse, "{found:?}");
}
