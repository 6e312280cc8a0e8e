//! Inputs at the edge, in both precisions: every one is solved, refused, or ended with the right status.

mod properties;
mod regressions;
mod scales;

use asperity::*;
use ndarray::Array2;
use oracles::{check, solve};

type Boxed<T> = Box<dyn AdhesionLaw<T>>;

/// Runs themes as tests, in either precision.
macro_rules! in_both_precisions {
    ($($theme:ident),* $(,)?) => {
        mod single { $(#[test] fn $theme() { super::$theme::<f32>(); })* }
        mod double { $(#[test] fn $theme() { super::$theme::<f64>(); })* }
    };
}
use in_both_precisions;

in_both_precisions!(
    flats_under_tension_hold_up_to_the_law_and_no_further,
    flats_at_a_gap_stay_there,
    pull_off_ends_detached_and_at_rest,
    sharp_surfaces_do_not_jam,
    a_spike_a_step_and_elongated_grids,
    the_lightest_loads_are_not_certified_on_rounding,
    a_law_that_fails_is_refused_or_never_called_converged,
    laws_that_contradict_themselves_end_and_keep_the_bookkeeping,
    adhesion_from_a_point_to_everywhere,
    long_thin_grids_and_all_but_one_node,
);

/// A tolerance that either precision reaches, unless loads are light.
fn loose<T: Real>() -> f64 {
    (1e3 * T::epsilon().widen()).max(1e-6)
}

/// A tolerance that either precision reaches under a light load too: in `f32` the error of the pressure that rounding
/// leaves grows as the load falls (see the page `choosing`).
fn light<T: Real>() -> f64 {
    if T::NAME == "f32" { 1e-2 } else { 1e-6 }
}

/// Solves, and expects convergence.
#[track_caller]
fn solved<T: Real>(problem: &mut Problem<T>, control: Control, tolerance: f64) -> Report {
    let report = solve(problem, control, tolerance).report;
    assert_eq!(report.status, Status::Converged, "{control:?} {report:?}");
    report
}

fn exponential<T: Real>(w: f64, range: f64) -> Boxed<T> {
    Box::new(Exponential::new(w, range).unwrap())
}

fn maugis_dugdale<T: Real>(w: f64, range: f64) -> Boxed<T> {
    Box::new(MaugisDugdale::new(w, range).unwrap())
}

fn bare<T: Real>() -> Boxed<T> {
    Box::new(NoAdhesion)
}

fn problem<T: Real>(
    shape: (usize, usize),
    lengths: (f64, f64),
    height: impl Fn(usize, usize) -> f64,
    law: Boxed<T>,
) -> Problem<T> {
    let grid = Grid::new(shape, lengths).unwrap();
    let surface = Surface::new(grid, Array2::from_shape_fn(shape, |(i, j)| height(i, j))).unwrap();
    Problem::new(&surface, Westergaard::new(grid, 1.0).unwrap(), law).unwrap()
}

fn checkerboard(i: usize, j: usize) -> f64 {
    0.1 * ((i + j) % 2) as f64
}

fn flats_under_tension_hold_up_to_the_law_and_no_further<T: Real>() {
    let traction = 1e-4 / 2e-3;
    for shape in [(8, 8), (7, 5), (1, 1)] {
        let mut smooth = problem::<T>(shape, (1.0, 1.0), |_, _| 0.3, exponential(1e-4, 2e-3));
        let mut dugdale = problem::<T>(shape, (1.0, 1.0), |_, _| 0.3, maugis_dugdale(1e-4, 2e-3));
        let mut alone = problem::<T>(shape, (1.0, 1.0), |_, _| 0.3, bare());
        let held = Control::MeanPressure(-0.99 * traction);
        for solution in [solve(&mut smooth, held, loose::<T>()), solve(&mut dugdale, held, loose::<T>())] {
            assert_eq!((solution.report.status, solution.report.contact_fraction), (Status::Converged, 1.0));
        }
        for load in [-1.1 * traction, -5.0] {
            let lost = Control::MeanPressure(load);
            assert_eq!(solve(&mut smooth, lost, loose::<T>()).report.status, Status::Detached);
            assert_eq!(solve(&mut dugdale, lost, loose::<T>()).report.status, Status::Detached);
            let solution = solve(&mut alone, lost, loose::<T>());
            assert_eq!((solution.report.status, solution.report.load_error), (Status::Detached, 1.0));
            assert!(solution.pressure.iter().all(|p| p.widen().abs() < 1e4 * T::epsilon().widen()));
        }
        let pressed = solve(&mut alone, Control::MeanPressure(2.0), loose::<T>());
        assert_eq!((pressed.report.status, pressed.report.contact_fraction), (Status::Converged, 1.0));
        assert!(pressed.pressure.iter().all(|&p| p.widen() == 2.0));
    }
}

fn flats_at_a_gap_stay_there<T: Real>() {
    for shape in [(8, 8), (7, 5), (1, 9)] {
        let mut problem = problem::<T>(shape, (1.0, 1.0), |_, _| -3.7, exponential(1e-4, 2e-3));
        let solution = solve(&mut problem, Control::MeanGap(1e-3), loose::<T>());
        assert_eq!(solution.report.status, Status::Converged);
        assert!(
            (solution.report.mean_pressure + problem.law().traction(T::lit(1e-3)).widen()).abs()
                < 8.0 * T::epsilon().widen()
        );
    }
}

fn pull_off_ends_detached_and_at_rest<T: Real>() {
    let grid = Grid::square(64, 1.0).unwrap();
    let sphere = Surface::paraboloid(grid, 0.5).unwrap();
    let operator = Westergaard::<T>::new(grid, 1.0).unwrap();
    let mut problem = Problem::new(&sphere, operator, exponential(1e-3, 1e-2)).unwrap();
    let tolerance = (1e3 * T::epsilon().widen()).max(1e-7);
    // pull-off is between 1.5 and 2 times πwR
    let unit = std::f64::consts::PI * 1e-3 * 0.5;
    let held = solve(&mut problem, Control::MeanPressure(-1.5 * unit), tolerance);
    assert_eq!(held.report.status, Status::Converged);
    assert!(held.report.contact_nodes > 0);
    for factor in [2.0, 3.0, 100.0] {
        let lost = solve(&mut problem, Control::MeanPressure(-factor * unit), tolerance);
        assert_eq!((lost.report.status, lost.report.contact_nodes), (Status::Detached, 0));
        assert!(
            lost.report.iterations < 300
                && lost.report.relative_error < 10.0 * tolerance
                && lost.report.mean_gap < 10.0
        );
    }
}

fn sharp_surfaces_do_not_jam<T: Real>() {
    // peaks that a rounding's width keeps from landing; changes that are uniform but for rounding
    for (shape, load) in [((40, 24), 8.85e-3), ((101, 1), 16.1), ((12, 7), 9.0), ((2, 3), 1e-2)] {
        let mut problem = problem::<T>(shape, (1.0, 1.0), checkerboard, bare());
        solved(&mut problem, Control::MeanPressure(load), loose::<T>());
    }
    let wave = |i: usize, _: usize| 0.1 * (std::f64::consts::TAU * i as f64 / 31.0).cos();
    let mut problem = problem::<T>((31, 17), (3.0, 1.0), wave, bare());
    solved(&mut problem, Control::MeanPressure(3.05e-5), light::<T>());
}

fn a_spike_a_step_and_elongated_grids<T: Real>() {
    let spike = |i: usize, j: usize| f64::from(u8::from((i, j) == (3, 0)));
    let step = |i: usize, _: usize| if i < 5 { 0.0 } else { 0.2 };
    for shape in [(16, 16), (13, 7), (1, 16), (16, 1), (512, 3), (2, 2)] {
        for (control, tolerance) in [
            (Control::MeanGap(0.05), loose::<T>()),
            (Control::MeanPressure(1e-3), light::<T>()),
            (Control::MeanPressure(0.5), loose::<T>()),
        ] {
            if shape.0 > 3 {
                solved(&mut problem::<T>(shape, (1.0, 0.3), spike, bare()), control, tolerance);
            }
            solved(&mut problem::<T>(shape, (1.0, 0.3), step, bare()), control, tolerance);
        }
    }
}

fn the_lightest_loads_are_not_certified_on_rounding<T: Real>() {
    for load in [1e-6, 1e-8, 1e-10, 1e-12] {
        let mut problem = oracles::rough::<T>(64, 16, bare());
        let solution = solve(&mut problem, Control::MeanPressure(load), loose::<T>());
        let report = &solution.report;
        let missed = report.relative_error.max(report.load_error) > loose::<T>();
        assert!(report.status == Status::Converged || missed, "{load}: {report:?}");
        let lightest = if T::NAME == "f32" { 1e-3 } else { 1e-9 };
        assert!(load < lightest || report.status == Status::Converged, "{load} {}", report.status);
        // what f32 leaves of such a load need not hold a node in place
        assert!(report.contact_nodes >= 1 || (T::NAME == "f32" && report.status == Status::Stalled), "{load}");
    }
}

/// An exponential that fails beyond a gap.
struct Broken(f64);

impl Broken {
    fn share<T: Real>(&self, gap: T) -> T {
        if gap.widen() > self.0 { T::nan() } else { (gap / T::lit(-1e-2)).exp() }
    }
}

impl<T: Real> AdhesionLaw<T> for Broken {
    fn energy(&self, gap: T) -> T {
        self.share(gap) * T::lit(-1e-4)
    }
    fn traction(&self, gap: T) -> T {
        self.share(gap) * T::lit(1e-2)
    }
    fn slope(&self, gap: T) -> T {
        -self.share(gap)
    }
}

fn a_law_that_fails_is_refused_or_never_called_converged<T: Real>() {
    let wave = |i: usize, _: usize| 0.02 * (std::f64::consts::TAU * i as f64 / 16.0).cos();
    let mut problem = problem::<T>((16, 16), (1.0, 1.0), wave, Box::new(Broken(0.02)));
    let error = Solver::default().solve(&mut problem, Control::MeanGap(0.03)).unwrap_err().to_string();
    assert!(error.contains("adhesive energy is NaN at a gap of 0.0"), "{error}");
    let control = Control::MeanGap(0.01);
    let solution = Solver::default().solve(&mut problem, control).unwrap();
    // the solve ends with a gap just where the law ends: restoring its mean may take it beyond
    if solution.report.relative_error.is_finite() {
        check(&solution);
    }
    assert!(solution.report.status != Status::Converged || solution.gap.iter().all(|&g| g.widen() <= 0.02));
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

/// An exponential with functions that do not agree, or jump.
struct Odd(u8);

impl<T: Real> AdhesionLaw<T> for Odd {
    fn energy(&self, gap: T) -> T {
        T::lit(if self.0 == 3 { 1e-4 } else { -1e-4 }) * (gap / T::lit(-1e-2)).exp()
    }
    fn traction(&self, gap: T) -> T {
        let good = 1e-2 * (-gap.widen() / 1e-2).exp();
        T::lit(match self.0 {
            0 => -good,
            1 => 100.0 * good,
            // a traction that does not end
            2 => 1e-2,
            3 => -good,
            _ if gap.widen() > 0.01 => good + 1e-2,
            _ => good,
        })
    }
    fn slope(&self, gap: T) -> T {
        if self.0 == 5 { T::lit(1e30) } else { -(gap / T::lit(-1e-2)).exp() }
    }
}

fn laws_that_contradict_themselves_end_and_keep_the_bookkeeping<T: Real>() {
    let wave = |i: usize, _: usize| 0.02 * (std::f64::consts::TAU * i as f64 / 16.0).cos();
    for kind in 0..6 {
        for control in
            [Control::MeanGap(0.015), Control::MeanGap(0.1), Control::MeanPressure(0.01), Control::MeanPressure(-2e-3)]
        {
            let mut problem = problem::<T>((16, 16), (1.0, 1.0), wave, Box::new(Odd(kind)));
            let solution = Solver::default().solve(&mut problem, control).unwrap();
            let report = &solution.report;
            assert!(
                report.iterations <= 2000 && solution.gap.iter().all(|g| g.is_finite() && *g >= T::zero()),
                "{kind}"
            );
            assert!(
                report.status != Status::Converged || report.relative_error <= report.tolerance,
                "{kind} {control:?}"
            );
        }
    }
}

fn adhesion_from_a_point_to_everywhere<T: Real>() {
    let wave = |i: usize, j: usize| 0.02 * (std::f64::consts::TAU * (i + 2 * j) as f64 / 16.0).cos();
    let mut last = 0.0;
    for share in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3] {
        for w in [0.0, 1e-9, 1e-5, 1e2] {
            let mut problem = problem::<T>((16, 16), (1.0, 1.0), wave, exponential(w, share * 0.02));
            for control in [Control::MeanGap(0.015), Control::MeanPressure(0.05)] {
                let report = solve(&mut problem, control, loose::<T>()).report;
                assert!(report.iterations <= 2000);
                let expected = (w / 16.0).sqrt() / (share * 0.02);
                assert!(
                    (report.mu_rho - expected).abs() <= 8.0 * T::epsilon().widen() * expected
                        && report.under_resolved == (expected > 0.5)
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

fn long_thin_grids_and_all_but_one_node<T: Real>() {
    let mut thin = problem::<T>(
        (4096, 3),
        (1.0, 1e-3),
        |i, j| 1e-2 * (std::f64::consts::TAU * (i + 40 * j) as f64 / 4096.0).cos(),
        bare(),
    );
    for control in [Control::MeanGap(4e-3), Control::MeanPressure(1e-2)] {
        assert_eq!(solve(&mut thin, control, loose::<T>()).report.status, Status::Converged, "{control:?}");
    }
    // a pit in a plane: all but one node in contact, until it is pressed flat; a spike: one node alone
    let pit = |i: usize, j: usize| if (i, j) == (4, 6) { -0.1 } else { 0.0 };
    let mut pit = problem::<T>((9, 13), (1.0, 1.0), pit, bare());
    let report = solve(&mut pit, Control::MeanPressure(0.1), loose::<T>()).report;
    assert_eq!((report.status, report.contact_nodes), (Status::Converged, 9 * 13 - 1));
    assert_eq!(solve(&mut pit, Control::MeanPressure(1e2), loose::<T>()).report.contact_fraction, 1.0);
    let mut spike = problem::<T>((9, 13), (1.0, 1.0), |i, j| if (i, j) == (4, 6) { 0.1 } else { 0.0 }, bare());
    let report = solved(&mut spike, Control::MeanPressure(1e-5), light::<T>());
    assert_eq!(report.contact_nodes, 1);
}
