//! Warnings of contacts and cycles.

use super::*;

#[test]
fn a_range_beyond_the_heights_or_below_the_grid_is_told() {
    let surface = Surface::wave_2d(Grid::square(64, 1.0).unwrap(), 0.01, 2).unwrap();
    let found = |work: f64, range: f64| Warning::of_law::<f64>(&Exponential::new(work, range).unwrap(), &surface, 1.0);
    assert!(found(1e-5, 2e-3).is_empty());
    let resolved = |warnings: Vec<Warning>| (warnings.len(), warnings[0].code, short(&warnings[0]).message());
    // √(1e-5/64)/ρ
    let (count, code, message) = resolved(found(1e-5, 3e-4));
    assert_eq!((count, code), (1, WarningCode::Range));
    for part in ["mu_rho = 1.32", "0.72 to 1.65 w", "use jkr"] {
        assert!(message.contains(part), "{message}");
    }
    // far beyond what was measured
    let (_, _, message) = resolved(found(1e-5, 2e-5));
    assert!(message.contains("<0.25 to >13.8 w"), "{message}");
    // without a range there is none to resolve
    assert!(Warning::of_law::<f64>(&Jkr::new(1e-5).unwrap(), &surface, 1.0).is_empty());
    // a law that jumps is smoothed
    assert!(Warning::of_law::<f64>(&MaugisDugdale::new(1e-5, 1e-3).unwrap(), &surface, 1.0).is_empty());
    let (count, code, message) = resolved(found(1e-5, 0.1));
    assert_eq!((count, code), (1, WarningCode::Range));
    assert!(["0.1", "0.02", "unit"].iter().all(|part| message.contains(part)), "{message}");
    // J/m² and Pa next to sides of 1000 nm
    let surface = Surface::wave_2d(Grid::square(64, 1e3).unwrap(), 10.0, 2).unwrap();
    let of_work = |work: f64, modulus: f64| {
        let found = Warning::of_law::<f64>(&Jkr::new(work).unwrap(), &surface, modulus);
        found
            .iter()
            .map(short)
            .filter(|found| found.code == WarningCode::Work)
            .map(Warning::message)
            .collect::<Vec<_>>()
    };
    assert!(of_work(0.05, 70e9)[0].starts_with("w/E* is 7.14e-13, 7.14e-16 sides: check the units"));
    assert!(of_work(50.0, 1e-3)[0].starts_with("w/E* is 50000, 50 sides"));
    assert!(of_work(0.05, 70.0).is_empty() && of_work(0.0, 70e9).is_empty());
    assert!(found(0.0, 0.1).is_empty() && Warning::of_law::<f64>(&NoAdhesion, &surface, 1.0).is_empty());
}

#[test]
fn a_cycle_that_jumps_in_too_early_is_told() {
    let grid = Grid::square(64, 1.0).unwrap();
    let told = |law: &dyn AdhesionLaw<f64>, smooth| {
        Warning::of_cycle(law, &grid, 1.0, smooth).map(|warning| short(&warning).to_string())
    };
    // the width of the smoothed fall is 5 wΔx/(E* ρ), half of it beyond the range
    let blunt = |range: f64| told(&MaugisDugdale::new(1e-5, range).unwrap(), true);
    assert!(blunt(1e-3).unwrap().contains("reaches 39.1 % farther"), "{:?}", blunt(1e-3));
    assert_eq!(blunt(2e-3), None);
    assert_eq!(told(&MaugisDugdale::new(1e-5, 1e-3).unwrap(), false), None);
    // attraction next to contacts alone is as sudden as in the limit
    assert_eq!(told(&Jkr::new(1e-5).unwrap(), true), None);
    assert_eq!(told(&Exponential::new(1e-5, 1e-3).unwrap(), true), None);
    assert_eq!(told(&NoAdhesion, true), None);
}

#[test]
fn a_contact_pressure_above_the_modulus_is_told() {
    let grid = Grid::square(16, 1.0).unwrap();
    let surface = Surface::wave_2d(grid, 0.5, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 2.0).unwrap(), NoAdhesion).unwrap();
    let mut found = |pressure| {
        let solution = Solver::default().solve(&mut problem, Control::MeanPressure(pressure)).unwrap();
        Warning::of_solution(&solution, None)
    };
    assert!(found(0.01).is_empty());
    let warnings = found(3.0);
    assert_eq!((warnings.len(), warnings[0].code), (1, WarningCode::BeyondModulus));
    assert!(short(&warnings[0]).message().contains(" E*: "), "{}", warnings[0]);
}

#[test]
fn the_pull_off_is_as_wrong_as_the_warning_says() {
    let (grid, work) = (Grid::line(256, 1.0).unwrap(), 4.4e-5);
    let surface = Surface::wave(grid, 0.01, 1).unwrap();
    let exact = |work| exact::AdhesiveWavyLine::new(0.01, 1.0, 1.0, work).unwrap().pull_off().unwrap().mean_pressure();
    for (mu_rho, factor) in [(1.0, 1.17), (2.0, 3.49)] {
        let law = Exponential::new(work, (work / 256.0_f64).sqrt() / mu_rho).unwrap();
        let warnings = Warning::of_law::<f64>(&law, &surface, 1.0);
        let told = format!(" to {} w", if factor > 2.0 { "3.5" } else { "1.17" });
        assert!(warnings[0].message().contains(&told), "{}", warnings[0]);
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
        let preload = 0.3 * std::f64::consts::PI * 0.01;
        let found = PullOff::default().preload(Some(preload)).find(&mut Solver::default(), &mut problem).unwrap();
        let ratio = found.solution.report.mean_pressure / exact(factor * work);
        assert!((0.93..1.03).contains(&ratio), "{ratio}");
    }
}

#[test]
fn a_punch_reaches_the_edge_of_its_window_and_a_sphere_does_not() {
    let grid = Grid::square(32, 0.3).unwrap();
    let codes = |surface: &Surface, load: f64| {
        let mut problem = Problem::new(surface, Boussinesq::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
        let found = Solver::default().solve(&mut problem, Control::Force(load)).unwrap();
        Warning::of_solution(&found, None).iter().map(|warning| warning.code).collect::<Vec<_>>()
    };
    assert_eq!(codes(&Surface::from_fn(grid, |_, _| 0.0).unwrap(), 1e-4), [WarningCode::WindowEdge]);
    assert!(codes(&Surface::paraboloid(grid, 1.0).unwrap(), 1e-4).is_empty());
}
