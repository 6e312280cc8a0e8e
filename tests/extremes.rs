//! Inputs at the edge: every one is solved, refused, or ended with the right status.

mod common;

use asperity::*;
use common::{check, solve};
use ndarray::Array2;

fn problem<L: AdhesionLaw<f64>>(
    shape: (usize, usize),
    lengths: (f64, f64),
    height: impl Fn(usize, usize) -> f64,
    law: L,
) -> Problem<f64, Westergaard<f64>, L> {
    let grid = Grid::new(shape, lengths).unwrap();
    let surface = Surface::new(grid, Array2::from_shape_fn(shape, |(i, j)| height(i, j))).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

fn checkerboard(i: usize, j: usize) -> f64 {
    0.1 * ((i + j) % 2) as f64
}

#[test]
fn flats_under_tension_hold_up_to_the_law_and_no_further() {
    let traction = 1e-4 / 2e-3;
    for shape in [(8, 8), (7, 5), (1, 1)] {
        let mut exponential = problem(shape, (1.0, 1.0), |_, _| 0.3, Exponential::new(1e-4, 2e-3).unwrap());
        let mut dugdale = problem(shape, (1.0, 1.0), |_, _| 0.3, MaugisDugdale::new(1e-4, 2e-3).unwrap());
        let mut bare = problem(shape, (1.0, 1.0), |_, _| 0.3, NoAdhesion);
        let held = Control::MeanPressure(-0.99 * traction);
        for solution in [solve(&mut exponential, held, 1e-6), solve(&mut dugdale, held, 1e-6)] {
            assert_eq!((solution.report.status, solution.report.contact_fraction), (Status::Converged, 1.0));
        }
        for load in [-1.1 * traction, -5.0] {
            let lost = Control::MeanPressure(load);
            assert_eq!(solve(&mut exponential, lost, 1e-6).report.status, Status::Detached);
            assert_eq!(solve(&mut dugdale, lost, 1e-6).report.status, Status::Detached);
            let solution = solve(&mut bare, lost, 1e-6);
            assert_eq!((solution.report.status, solution.report.load_error), (Status::Detached, 1.0));
            assert!(solution.pressure.iter().all(|p| p.abs() < 1e-12));
        }
        let pressed = solve(&mut bare, Control::MeanPressure(2.0), 1e-6);
        assert_eq!((pressed.report.status, pressed.report.contact_fraction), (Status::Converged, 1.0));
        assert!(pressed.pressure.iter().all(|&p| p == 2.0));
    }
}

#[test]
fn flats_at_a_gap_stay_there() {
    for shape in [(8, 8), (7, 5), (1, 9)] {
        let law = Exponential::new(1e-4, 2e-3).unwrap();
        let mut problem = problem(shape, (1.0, 1.0), |_, _| -3.7, law);
        let solution = solve(&mut problem, Control::MeanGap(1e-3), 1e-6);
        assert_eq!(solution.report.status, Status::Converged);
        assert!((solution.report.mean_pressure + law.traction(1e-3)).abs() < 1e-15);
    }
}

#[test]
fn pull_off_ends_detached_and_at_rest() {
    let grid = Grid::square(64, 1.0).unwrap();
    let sphere = Surface::paraboloid(grid, 0.5).unwrap();
    let law = Exponential::new(1e-3, 1e-2).unwrap();
    let mut problem = Problem::new(&sphere, Westergaard::<f64>::new(grid, 1.0).unwrap(), law).unwrap();
    // pull-off is between 1.5 and 2 times πwR
    let unit = std::f64::consts::PI * 1e-3 * 0.5;
    let held = solve(&mut problem, Control::MeanPressure(-1.5 * unit), 1e-7);
    assert_eq!(held.report.status, Status::Converged);
    assert!(held.report.contact_points > 0);
    for factor in [2.0, 3.0, 100.0] {
        let lost = solve(&mut problem, Control::MeanPressure(-factor * unit), 1e-7);
        assert_eq!((lost.report.status, lost.report.contact_points), (Status::Detached, 0));
        assert!(lost.report.iterations < 300 && lost.report.relative_error < 1e-6 && lost.report.mean_gap < 10.0);
    }
}

#[test]
fn sharp_surfaces_do_not_jam() {
    // peaks that a rounding's width keeps from landing; changes that are uniform but for rounding
    for (shape, load) in [((40, 24), 8.85e-3), ((101, 1), 16.1), ((12, 7), 9.0), ((2, 3), 1e-2)] {
        let mut problem = problem(shape, (1.0, 1.0), checkerboard, NoAdhesion);
        let report = solve(&mut problem, Control::MeanPressure(load), 1e-6).report;
        assert_eq!(report.status, Status::Converged, "{shape:?} {load}");
    }
    let wave = |i: usize, _: usize| 0.1 * (std::f64::consts::TAU * i as f64 / 31.0).cos();
    let mut problem = problem((31, 17), (3.0, 1.0), wave, NoAdhesion);
    assert_eq!(solve(&mut problem, Control::MeanPressure(3.05e-5), 1e-6).report.status, Status::Converged);
}

#[test]
fn a_spike_a_step_and_elongated_grids() {
    let spike = |i: usize, j: usize| f64::from(u8::from((i, j) == (3, 0)));
    let step = |i: usize, _: usize| if i < 5 { 0.0 } else { 0.2 };
    for shape in [(16, 16), (13, 7), (1, 16), (16, 1), (512, 3), (2, 2)] {
        for control in [Control::MeanGap(0.05), Control::MeanPressure(1e-3), Control::MeanPressure(0.5)] {
            if shape.0 > 3 {
                let mut problem = problem(shape, (1.0, 0.3), spike, NoAdhesion);
                assert_eq!(
                    solve(&mut problem, control, 1e-6).report.status,
                    Status::Converged,
                    "{shape:?} {control:?}"
                );
            }
            let mut problem = problem(shape, (1.0, 0.3), step, NoAdhesion);
            assert_eq!(solve(&mut problem, control, 1e-6).report.status, Status::Converged, "{shape:?} {control:?}");
        }
    }
}

#[test]
fn the_lightest_loads_are_not_certified_on_rounding() {
    for load in [1e-6, 1e-8, 1e-10, 1e-12] {
        let mut problem = common::rough::<f64, _>(64, 16, NoAdhesion);
        let solution = solve(&mut problem, Control::MeanPressure(load), 1e-6);
        let report = &solution.report;
        assert!(report.status == Status::Converged || report.relative_error > 1e-6);
        assert!(load < 1e-9 || report.status == Status::Converged, "{load} {}", report.status);
        assert!(report.contact_points >= 1);
    }
}

/// An exponential that fails beyond a gap.
struct Broken(f64);

impl AdhesionLaw<f64> for Broken {
    fn energy(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { -1e-4 * (-gap / 1e-2).exp() }
    }
    fn traction(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { 1e-2 * (-gap / 1e-2).exp() }
    }
    fn slope(&self, gap: f64) -> f64 {
        if gap > self.0 { f64::NAN } else { -(-gap / 1e-2).exp() }
    }
}

#[test]
fn a_law_that_fails_is_refused_or_never_called_converged() {
    let wave = |i: usize, _: usize| 0.02 * (std::f64::consts::TAU * i as f64 / 16.0).cos();
    let mut problem = problem((16, 16), (1.0, 1.0), wave, Broken(0.02));
    let error = Solver::default().solve(&mut problem, Control::MeanGap(0.03)).unwrap_err().to_string();
    assert!(error.contains("adhesive energy is NaN at a gap of 0.03"), "{error}");
    let control = Control::MeanGap(0.01);
    let solution = Solver::default().solve(&mut problem, control).unwrap();
    check(&solution, &Broken(f64::INFINITY), control);
    assert!(solution.report.status != Status::Converged || solution.gap.iter().all(|&g| g <= 0.02));
}

#[test]
fn controls_that_the_precision_cannot_hold_are_refused() {
    let grid = Grid::square(8, 1.0).unwrap();
    let surface = Surface::wave(grid, 0.01, 1).unwrap();
    let mut problem = Problem::new(&surface, Westergaard::<f32>::new(grid, 1.0).unwrap(), NoAdhesion).unwrap();
    assert!(Solver::default().solve(&mut problem, Control::MeanGap(1e300)).is_err());
    assert!(Solver::default().solve(&mut problem, Control::MeanPressure(-1e300)).is_err());
    // a gap that underflows is none
    let closed = Solver::default().solve(&mut problem, Control::MeanGap(1e-300)).unwrap();
    assert_eq!(closed.report.contact_fraction, 1.0);
}

/// A rough patch in units of one's own: lengths, heights and modulus, and the law at a share of the heights.
fn scaled<T: Real>(length: f64, height: f64, modulus: f64, offset: f64) -> Result<(Solution<T>, f64, f64)> {
    let grid = Grid::square(32, length)?;
    let wave = |i: usize, j: usize| {
        let (x, y) = (std::f64::consts::TAU * i as f64 / 32.0, std::f64::consts::TAU * j as f64 / 32.0);
        offset + height * (x.cos() + 0.6 * (y + 1.0).cos() + 0.3 * (2.0 * x + 3.0 * y).sin())
    };
    let surface = Surface::new(grid, Array2::from_shape_fn((32, 32), |(i, j)| wave(i, j)))?;
    let pressure = modulus * height / length;
    let law = Exponential::new(T::lit(0.02 * pressure * height), T::lit(0.2 * height))?;
    let mut problem = Problem::new(&surface, Westergaard::<T>::new(grid, modulus)?, law)?;
    let settings = Settings { tolerance: 1e-4, ..Settings::default() };
    let solution = Solver::new(settings).solve(&mut problem, Control::MeanPressure(0.8 * pressure))?;
    Ok((solution, height, pressure))
}

/// The same scene from atoms to mountains gives the same answer, or is refused by name.
fn scales<T: Real>(tolerance: f64) -> usize {
    let unit = scaled::<T>(1.0, 0.1, 1.0, 0.0).unwrap();
    assert_eq!(unit.0.report.status, Status::Converged);
    let mut refused = 0;
    for length in [1e-9, 1e-3, 1.0, 1e3] {
        for slope in [1e-6, 1e-3, 0.1] {
            for modulus in [1e-3, 1.0, 1e6, 1e12] {
                let case = format!("{length:e} {slope} {modulus:e}");
                let (solution, height, pressure) = match scaled::<T>(length, slope * length, modulus, 0.0) {
                    Ok(scaled) => scaled,
                    Err(error) => {
                        assert_eq!(error.to_string().lines().count(), 1, "{case}: {error}");
                        refused += 1;
                        continue;
                    }
                };
                let report = &solution.report;
                assert_eq!(report.status, Status::Converged, "{case}");
                let agree = |a: f64, b: f64| (a - b).abs() <= tolerance * b.abs();
                assert!(agree(report.mean_gap / height, unit.0.report.mean_gap / unit.1), "{case}");
                let (here, there) =
                    (report.mean_contact_pressure / pressure, unit.0.report.mean_contact_pressure / unit.2);
                assert!(agree(here, there), "{case} {here} {there}");
                let points = report.contact_points.abs_diff(unit.0.report.contact_points);
                assert!(points <= 8, "{case}: {points}");
            }
        }
    }
    refused
}

#[test]
fn from_nanometres_to_kilometres_the_answer_is_the_same() {
    assert_eq!(scales::<f64>(1e-3), 0);
    assert_eq!(scales::<f32>(1e-3), 0);
}

#[test]
fn products_beyond_the_range_of_the_precision_are_refused_or_never_called_converged() {
    for (length, height, modulus) in
        [(1e-30, 1.0, 1e30), (1e-9, 1e2, 1e38), (1e3, 1e-42, 1e-3), (1e30, 1e-12, 1e-30), (1.0, 1e-20, 1e-12)]
    {
        match scaled::<f32>(length, height, modulus, 0.0) {
            Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
            Ok((solution, ..)) => {
                let report = &solution.report;
                let finite = solution.gap.iter().chain(&solution.pressure).all(|x| x.is_finite());
                assert!(finite || report.status != Status::Converged, "{length:e} {height:e} {modulus:e}");
                assert!(report.iterations <= 2000);
            }
        }
    }
}

#[test]
fn a_datum_a_billion_heights_away_costs_the_digits_that_it_takes_and_no_more() {
    let near = scaled::<f64>(1.0, 0.1, 1.0, 0.0).unwrap().0;
    // a height of 0.1 at 1e8 keeps seven digits
    let far = scaled::<f64>(1.0, 0.1, 1.0, 1e8).unwrap().0;
    assert_eq!(far.report.status, Status::Converged);
    assert!((far.report.mean_gap - near.report.mean_gap).abs() <= 1e-4 * near.report.mean_gap);
    let (shape, grid) = ((2, 3), Grid::new((2, 3), (1.0, 1.0)).unwrap());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut heights = Array2::zeros(shape);
        heights[[1, 2]] = bad;
        let error = Surface::new(grid, heights).unwrap_err();
        assert!(matches!(error, Error::NotFinite { count: 1, first: (1, 2), .. }), "{error}");
    }
    let mut tiny = problem(shape, (1.0, 1.0), |i, j| [-0.0, 5e-324, 0.0][(i + j) % 3], NoAdhesion);
    for control in [Control::MeanGap(0.1), Control::MeanPressure(0.1)] {
        assert_eq!(solve(&mut tiny, control, 1e-6).report.status, Status::Converged, "{control:?}");
    }
    assert!(matches!(Grid::new((usize::MAX, 2), (1.0, 1.0)), Err(Error::Value { name: "number of nodes", .. })));
}

/// An exponential whose functions do not agree, or jump.
struct Odd(u8);

impl AdhesionLaw<f64> for Odd {
    fn energy(&self, gap: f64) -> f64 {
        -1e-4 * (-gap / 1e-2).exp() * if self.0 == 3 { -1.0 } else { 1.0 }
    }
    fn traction(&self, gap: f64) -> f64 {
        let good = 1e-2 * (-gap / 1e-2).exp();
        match self.0 {
            0 => -good,
            1 => 100.0 * good,
            // a traction that does not end
            2 => 1e-2,
            3 => -good,
            _ if gap > 0.01 => good + 1e-2,
            _ => good,
        }
    }
    fn slope(&self, gap: f64) -> f64 {
        if self.0 == 5 { 1e30 } else { -(-gap / 1e-2).exp() }
    }
}

#[test]
fn laws_that_contradict_themselves_end_and_keep_the_bookkeeping() {
    let wave = |i: usize, _: usize| 0.02 * (std::f64::consts::TAU * i as f64 / 16.0).cos();
    for kind in 0..6 {
        for control in
            [Control::MeanGap(0.015), Control::MeanGap(0.1), Control::MeanPressure(0.01), Control::MeanPressure(-2e-3)]
        {
            let mut problem = problem((16, 16), (1.0, 1.0), wave, Odd(kind));
            let solution = Solver::default().solve(&mut problem, control).unwrap();
            let report = &solution.report;
            assert!(report.iterations <= 2000 && solution.gap.iter().all(|g| g.is_finite() && *g >= 0.0), "{kind}");
            assert!(report.status != Status::Converged || report.relative_error <= 1e-6, "{kind} {control:?}");
        }
    }
}

#[test]
fn adhesion_from_a_point_to_everywhere() {
    let wave = |i: usize, j: usize| 0.02 * (std::f64::consts::TAU * (i + 2 * j) as f64 / 16.0).cos();
    let mut last = 0.0;
    for share in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3] {
        for w in [0.0, 1e-9, 1e-5, 1e2] {
            let law = Exponential::new(w, share * 0.02).unwrap();
            let mut problem = problem((16, 16), (1.0, 1.0), wave, law);
            for control in [Control::MeanGap(0.015), Control::MeanPressure(0.05)] {
                let report = solve(&mut problem, control, 1e-6).report;
                assert!(report.iterations <= 2000);
                let expected = (w / 16.0).sqrt() / (share * 0.02);
                assert!(
                    (report.mu_rho - expected).abs() <= 1e-12 * expected && report.under_resolved == (expected > 0.5)
                );
                if expected < 0.3 {
                    assert_eq!(report.status, Status::Converged, "{share} {w} {control:?}");
                }
                if matches!(control, Control::MeanPressure(_)) && w == 1e2 && share >= 10.0 {
                    // full collapse
                    assert_eq!(report.contact_fraction, 1.0);
                }
                last = report.contact_fraction;
            }
        }
    }
    assert!(last > 0.0);
}

#[test]
fn long_thin_grids_and_all_but_one_node() {
    let mut thin = problem(
        (4096, 3),
        (1.0, 1e-3),
        |i, j| 1e-2 * (std::f64::consts::TAU * (i + 40 * j) as f64 / 4096.0).cos(),
        NoAdhesion,
    );
    for control in [Control::MeanGap(4e-3), Control::MeanPressure(1e-2)] {
        assert_eq!(solve(&mut thin, control, 1e-6).report.status, Status::Converged, "{control:?}");
    }
    // a pit in a plane: all but one node in contact, until it is pressed flat; a spike: one node alone
    let pit = |i: usize, j: usize| if (i, j) == (4, 6) { -0.1 } else { 0.0 };
    let mut pit = problem((9, 13), (1.0, 1.0), pit, NoAdhesion);
    let report = solve(&mut pit, Control::MeanPressure(0.1), 1e-8).report;
    assert_eq!((report.status, report.contact_points), (Status::Converged, 9 * 13 - 1));
    assert_eq!(solve(&mut pit, Control::MeanPressure(1e2), 1e-8).report.contact_fraction, 1.0);
    let mut spike = problem((9, 13), (1.0, 1.0), |i, j| if (i, j) == (4, 6) { 0.1 } else { 0.0 }, NoAdhesion);
    let report = solve(&mut spike, Control::MeanPressure(1e-5), 1e-8).report;
    assert_eq!((report.status, report.contact_points), (Status::Converged, 1));
}

#[test]
fn constraints_that_let_gaps_be_negative_keep_a_mean_gap_of_zero() {
    let wave = |i: usize, j: usize| 0.02 * (std::f64::consts::TAU * (i + 2 * j) as f64 / 16.0).cos();
    for start in [None, Some(Array2::from_shape_fn((16, 16), |(i, _)| if i % 2 == 0 { 1e-3 } else { -1e-3 }))] {
        let mut problem = problem((16, 16), (1.0, 1.0), wave, NoAdhesion);
        let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(5000.0).unwrap() };
        let start = start.as_ref().map(|start| start.view());
        let go_on = |_: &Iteration| std::ops::ControlFlow::Continue(());
        let report = solver.solve_from(&mut problem, Control::MeanGap(0.0), start, go_on).unwrap().report;
        assert_eq!(report.status, Status::Converged);
        assert!(report.mean_gap.abs() < 1e-15 && report.min_gap < 0.0);
        // under a tension that nothing holds they part
        let lost = solver.solve(&mut problem, Control::MeanPressure(-1e-3)).unwrap().report;
        assert_eq!((lost.status, lost.contact_points), (Status::Detached, 0));
    }
}
