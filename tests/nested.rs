//! Nested grids: they find what the finest grid alone finds, with less work.

#[path = "common/rough.rs"]
mod rough;

use asperity::*;

fn solve<T: Real, L: AdhesionLaw<T>>(n: usize, law: L, control: Control, tolerance: f64) -> NestedSolution<T> {
    let surface = rough::rough(Grid::square(n, 1.0).unwrap(), 64, 1);
    let mut nested = Nested::new(Settings { tolerance, ..Settings::default() });
    let found = nested.solve(&surface, |grid| Westergaard::<T>::new(grid, 1.0), law, control).unwrap();
    assert_eq!(found.solution.report.status, Status::Converged);
    assert!(found.solution.report.relative_error <= tolerance && found.solution.report.load_error <= tolerance);
    found
}

#[test]
fn nested_grids_take_few_applications() {
    for (control, fine, coarse) in [
        (Control::MeanPressure(0.0132), 36.0, 18.0),
        (Control::MeanPressure(0.18), 36.0, 18.0),
        (Control::MeanGap(0.022), 36.0, 18.0),
        (Control::MeanGap(0.0044), 36.0, 18.0),
    ] {
        for (tolerance, most) in [(1e-6, fine), (1e-3, coarse)] {
            let taken = solve::<f64, _>(1024, NoAdhesion, control, tolerance).equivalent_applications();
            assert!(taken <= most, "{control:?} to {tolerance}: {taken}");
        }
    }
}

#[test]
fn nested_grids_find_what_the_finest_finds() {
    let surface = rough::rough(Grid::square(256, 1.0).unwrap(), 64, 1);
    let law = Exponential::new(1.42e-4, 2.9e-3).unwrap();
    for control in [Control::MeanPressure(0.0132), Control::MeanGap(0.022)] {
        let found = solve::<f64, _>(256, law, control, 1e-6).solution.report;
        let mut problem = Problem::new(&surface, Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap(), law).unwrap();
        let single = Solver::default().solve(&mut problem, control).unwrap().report;
        assert!((found.mean_gap / single.mean_gap - 1.0).abs() < 1e-5);
        assert!((found.mean_pressure / single.mean_pressure - 1.0).abs() < 1e-5);
        assert!(found.contact_points.abs_diff(single.contact_points) <= 3);
    }
}

#[test]
fn grids_that_do_not_resolve_adhesion_are_left_out() {
    let law = Exponential::new(1.42e-4, 1.42e-3).unwrap();
    let shapes: Vec<_> =
        solve::<f64, _>(512, law, Control::MeanGap(0.022), 1e-3).levels.iter().map(|l| l.shape).collect();
    assert_eq!(shapes, [(512, 512)]);
    let shapes: Vec<_> =
        solve::<f32, _>(256, NoAdhesion, Control::MeanGap(0.022), 1e-3).levels.iter().map(|l| l.shape).collect();
    assert_eq!(shapes, [(64, 64), (128, 128), (256, 256)]);
}
