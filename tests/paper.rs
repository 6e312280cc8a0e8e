//! The numbers of Rey, Anciaux and Molinari (2017) that can be reproduced, in the authors' convention.

#[path = "common/authors.rs"]
mod authors;

use asperity::*;

fn pressed<C: ContactConstraint<f64>>(n: usize, constraint: C) -> (Surface, Solution<f64>) {
    let surface = authors::surface(n).unwrap();
    let operator = Westergaard::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(&surface, operator, NoAdhesion).unwrap();
    let mut solver = Solver { settings: Settings { tolerance: 1e-10, ..Settings::default() }, constraint };
    let solution = solver.solve(&mut problem, Control::MeanPressure(2e-4)).unwrap();
    assert_eq!(solution.report.status, Status::Converged);
    (surface, solution)
}

/// The digits of a printed value, which the paper cuts off.
fn first_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 2.0);
    (value / unit).floor() * unit
}

fn table_1(n: usize, printed: f64, mean_gap: f64) {
    let (surface, solution) = pressed(n, Projection);
    let (eta, _) = authors::errors(&surface, 2e-4, &solution.gap, &solution.contact_pressure).unwrap();
    assert!((first_digits(eta.sqrt()) / printed - 1.0).abs() < 1e-9, "{n}: {:e}", eta.sqrt());
    assert!((solution.report.mean_gap - mean_gap).abs() < 1e-8, "{n}: {}", solution.report.mean_gap);
}

#[test]
fn table_1_to_the_printed_digits() {
    table_1(64, 1.40e-2, 0.04097003);
    table_1(128, 4.08e-3, 0.04031740);
    table_1(256, 7.78e-4, 0.03999459);
    table_1(512, 3.66e-4, 0.03983374);
}

#[test]
#[ignore = "a larger run: cargo test --release --test paper -- --ignored"]
fn table_1_to_the_printed_digits_at_1024() {
    table_1(1024, 1.20e-4, 0.03975357);
}

#[test]
#[ignore = "a larger run: cargo test --release --test paper -- --ignored"]
fn the_last_entry_of_table_1_holds_a_small_error_of_the_load() {
    let (surface, solution) = pressed(2048, Projection);
    let eta = |shift: f64| {
        let pressure = solution.contact_pressure.mapv(|p| p + shift);
        authors::errors(&surface, 2e-4, &solution.gap, &pressure).unwrap().0.sqrt()
    };
    assert!((first_digits(eta(0.0)) / 2.80e-5 - 1.0).abs() < 1e-9, "{:e}", eta(0.0));
    assert!((first_digits(eta(2e-12)) / 1.66e-5 - 1.0).abs() < 1e-9, "{:e}", eta(2e-12));
}

#[test]
fn table_2_prints_squares_and_the_baselines_errors_are_of_their_recovery() {
    let (surface, solution) = pressed(512, Projection);
    let (eta, theta) = authors::errors(&surface, 2e-4, &solution.gap, &solution.contact_pressure).unwrap();
    assert!((eta / 1.3e-7 - 1.0).abs() < 0.05 && (theta / 1.5e-4 - 1.0).abs() < 0.05, "{eta:e} {theta:e}");
    assert_eq!(solution.report.min_gap, 0.0);

    // the penalty's error is small if the mean pressure is taken where the surfaces are apart, and above one, as it is
    // printed, if it is taken from the wrong end of the pressures
    let (surface, solution) = pressed(128, Penalty::new(5000.0).unwrap());
    let (eta, _) = authors::errors(&surface, 2e-4, &solution.gap, &solution.contact_pressure).unwrap();
    let largest = solution.pressure.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let wrong = solution.pressure.mapv(|p| p - largest);
    let (wrong, _) = authors::errors(&surface, 2e-4, &solution.gap, &wrong).unwrap();
    assert!(eta.abs() < 1e-3 && wrong > 1.0, "{eta:e} {wrong}");
    assert!((solution.report.min_gap + 4.26e-6).abs() < 0.05 * 4.26e-6, "{:e}", solution.report.min_gap);
}
