//! Searches for the load of a contact fraction: what they find, what it costs, and what they say where there is none.

use asperity::*;
use oracles::{Checkpoint, check, rough, sphere};

/// Whether a contact fraction is within a node or 1 % of the wanted one.
fn is_near(report: &Report, fraction: f64, facing: usize) -> bool {
    let wanted = fraction * facing as f64;
    (report.contact_nodes as f64 - wanted).abs() <= (0.01 * wanted).max(1.0)
}

/// Searches for fractions one after the other; returns the solves and applications of all.
#[track_caller]
fn search<T: Real>(problem: &mut Problem<T>, fractions: &[f64]) -> (usize, usize) {
    let nodes = problem.grid().nodes();
    let mut solver = Solver::default();
    let mut search = ContactSearch::default();
    let (mut solves, mut applications) = (0, 0);
    for &fraction in fractions {
        let found = search.at(&mut solver, problem, fraction).unwrap();
        let report = &found.solution.report;
        assert!(found.reached && is_near(report, fraction, nodes), "{fraction}: {}", report.contact_fraction);
        check(&found.solution);
        solves += found.solves;
        applications += found.operator_applications;
    }
    (solves, applications)
}

#[test]
fn a_search_finds_every_fraction_in_a_few_solves() {
    let fractions = [0.01, 0.03, 0.1, 0.3, 0.6, 0.9, 0.99];
    let alone: Vec<_> =
        fractions.iter().map(|&fraction| search(&mut rough::<f64>(128, 32, NoAdhesion), &[fraction])).collect();
    let together = search(&mut rough::<f64>(128, 32, NoAdhesion), &fractions);
    assert!(alone.iter().all(|(solves, _)| *solves <= 5), "{alone:?}");
    // rounding, which differs between processors, may add an iteration to every other solve
    let alone = alone.iter().map(|(_, count)| count).sum::<usize>();
    assert!(together.0 <= 18 && together.1 <= 383 + together.0 && alone <= 358, "{together:?} {alone:?}");
    search(&mut rough::<f32>(64, 16, NoAdhesion), &[0.02, 0.5]);
    search(&mut sphere::<f64>(128, NoAdhesion), &[0.003, 0.05, 0.4]);
}

#[test]
fn with_adhesion_a_search_follows_the_gap() {
    let law = Exponential::new(2e-4, 4e-3).unwrap();
    let mut problem = rough::<f64>(128, 16, law);
    let rising = search(&mut problem, &[0.02, 0.1, 0.3, 0.7]);
    let falling = search(&mut problem, &[0.7, 0.3, 0.1, 0.02]);
    assert!(rising.0 <= 16 && falling.0 <= 16, "{rising:?} {falling:?}");
    // as tension holds them there
    let mut solver = Solver::default();
    let found = ContactSearch::default().at(&mut solver, &mut problem, 0.02).unwrap();
    assert!(matches!(found.solution.report.control, Control::MeanGap(gap) if gap > 0.0));
}

/// A sphere on a free half-space of n² nodes.
fn free_sphere(n: usize, law: impl AdhesionLaw<f64> + 'static) -> Problem<f64> {
    let grid = Grid::square(n, 1.0).unwrap();
    Problem::new(&Surface::paraboloid(grid, 2.0).unwrap(), Boussinesq::new(grid, 1.0).unwrap(), law).unwrap()
}

#[test]
fn a_free_tip_has_the_contact_that_hertz_gives() {
    let (mut problem, mut solver) = (free_sphere(96, NoAdhesion), Solver::default());
    let found = ContactSearch::default().at(&mut solver, &mut problem, 0.05).unwrap();
    assert!(found.reached && is_near(&found.solution.report, 0.05, 96 * 96), "{found:?}");
    // F = 4E*a³/3R, and a to half a node
    let radius = (0.05 / std::f64::consts::PI).sqrt();
    let expected = 4.0 * radius.powi(3) / 6.0;
    let force = found.solution.report.normal_force;
    assert!((force / expected - 1.0).abs() < 3.0 * 0.5 / 96.0 / radius, "{force} {expected}");

    let mut problem = free_sphere(96, MaugisDugdale::new(2e-4, 6e-3).unwrap());
    let found = ContactSearch::default().at(&mut solver, &mut problem, 0.05).unwrap();
    assert!(found.reached && is_near(&found.solution.report, 0.05, 96 * 96), "{found:?}");
    assert!(matches!(found.solution.report.control, Control::Approach(_)));
}

#[test]
fn a_fraction_past_which_the_contact_jumps_is_not_claimed() {
    // the sides of a wave come into contact row by row, all nodes of a row at once
    let grid = Grid::new((32, 16), (1.0, 0.5)).unwrap();
    let ridge = Surface::from_fn(grid, |x, _| 0.02 * (std::f64::consts::TAU * x).cos()).unwrap();
    let mut problem = Problem::new(&ridge, Westergaard::<f64>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    let mut solver = Solver::default();
    let mut search = ContactSearch::default();
    let found = search.at(&mut solver, &mut problem, 0.25).unwrap();
    let fraction = found.solution.report.contact_fraction;
    assert!(!found.reached && found.solution.report.status == Status::Converged);
    let (below, above) = (found.below.unwrap(), found.above.unwrap());
    assert!(below < 0.25 && above > 0.25 && (above - below - 2.0 / 32.0).abs() < 1e-12, "{below} {above}");
    assert!(fraction == below || fraction == above);
    assert!(found.solves <= 40, "{}", found.solves);
    // it continues to one that there is
    assert!(search.at(&mut solver, &mut problem, above).unwrap().reached);
}

#[test]
fn a_jump_of_adhesion_is_told_from_its_side() {
    // a wave with a crest that snaps into contact, and off it
    let line = Grid::new((256, 1), (1.0, 1.0 / 256.0)).unwrap();
    let wave = Surface::from_fn(line, |x, _| 1e-3 * (std::f64::consts::TAU * x).cos()).unwrap();
    let law = Exponential::new(1e-4, 5e-4).unwrap();
    let mut problem = Problem::new(&wave, Westergaard::<f64>::new(line, 1.0).unwrap(), law).unwrap();
    for (branch, beyond) in [(None, 0.4..0.5), (Some(Branch::Unloading), 0.06..0.2)] {
        let mut solver = Solver::new(Settings::default().branch(branch));
        let mut search = ContactSearch::default();
        let found = search.at(&mut solver, &mut problem, 0.05).unwrap();
        let fraction = found.solution.report.contact_fraction;
        assert!(!found.reached && found.solution.report.status == Status::Converged, "{found:?}");
        assert!(found.below == Some(0.0) && found.above.is_some_and(|above| beyond.contains(&above)), "{found:?}");
        assert!(found.above == Some(fraction) || fraction == 0.0, "{fraction}");
        // next to the jump
        assert!(found.solution.report.mean_gap < 0.02, "{found:?}");
        // beyond it there are states again
        let found = search.at(&mut solver, &mut problem, 0.5).unwrap();
        assert!(found.reached && is_near(&found.solution.report, 0.5, 256), "{found:?}");
    }
}

#[test]
fn a_free_search_goes_on_from_the_whole_half_space() {
    let (mut problem, mut solver) = (free_sphere(64, NoAdhesion), Solver::default());
    let mut search = ContactSearch::default();
    let found = [0.02, 0.05, 0.1, 0.2, 0.4].map(|fraction| search.at(&mut solver, &mut problem, fraction).unwrap());
    assert!(found.iter().all(|found| found.reached));
    // 641 from the gap within the window alone, and 572 from all of it
    let applications: usize = found.iter().map(|found| found.operator_applications).sum();
    assert!(applications <= 600, "{applications}");
}

#[test]
fn a_search_that_is_kept_goes_on_bit_for_bit() {
    let fractions = [0.02, 0.05, 0.2];
    let law = Exponential::new(1e-4, 4e-3).unwrap();
    let grid = Grid::square(64, 1.0).unwrap();
    let surface = SelfAffine::default().k_l(2.0).k_s(16.0).surface(grid).unwrap();
    for (adhesive, free) in [(false, false), (true, false), (false, true), (true, true)] {
        let new = || {
            let law: Box<dyn AdhesionLaw<f64>> = if adhesive { Box::new(law) } else { Box::new(NoAdhesion) };
            let periodic = Westergaard::<f64>::new(grid, 1.0).unwrap();
            let body: Box<dyn ElasticOperator<f64>> =
                if free { Box::new(Boussinesq::<f64>::new(grid, 1.0).unwrap()) } else { Box::new(periodic) };
            Problem::new(&surface, body, law).unwrap()
        };
        let (mut solver, mut problem, mut search) = (Solver::default(), new(), ContactSearch::default());
        for fraction in fractions {
            let found = search.read_again().at(&mut Solver::default(), &mut new(), fraction).unwrap();
            let expected = search.at(&mut solver, &mut problem, fraction).unwrap();
            assert!(found.solution == expected.solution && found.solves == expected.solves, "{fraction}");
        }
    }
}

#[test]
fn what_cannot_be_searched_for_is_refused() {
    let mut problem = rough::<f64>(16, 6, NoAdhesion);
    let mut solver = Solver::default();
    for fraction in [0.0, 1.0, -0.1, 1.5, f64::NAN, 0.5 / 256.0] {
        let refused = ContactSearch::default().at(&mut solver, &mut problem, fraction);
        assert!(matches!(refused, Err(Error::Value { name: "contact fraction", .. })), "{fraction}");
    }
    let settings = Settings::default();
    let mut without = Solver { settings, constraint: NoWall };
    let law = Morse::new(1e-4, 4e-3).unwrap();
    let mut repelled = rough::<f64>(16, 6, law);
    let refused = ContactSearch::default().at(&mut without, &mut repelled, 0.1);
    assert!(matches!(refused, Err(Error::Unsuited { what: "contact-fraction", .. })));
    let flat = Surface::new(Grid::square(16, 1.0).unwrap(), ndarray::Array2::zeros((16, 16))).unwrap();
    let half_space = Westergaard::<f64>::new(*flat.grid(), 1.0).unwrap();
    let mut flat = Problem::new(&flat, half_space, NoAdhesion).unwrap();
    let refused = ContactSearch::default().at(&mut solver, &mut flat, 0.1);
    assert!(matches!(refused, Err(Error::Value { .. })));
    // a gap that was found on another grid
    let mut search = ContactSearch::default();
    search.at(&mut solver, &mut problem, 0.1).unwrap();
    let refused = search.at(&mut solver, &mut rough(32, 6, NoAdhesion), 0.2);
    assert!(matches!(refused, Err(Error::Shape { name: "gap of the search", .. })), "{refused:?}");
}
