//! How many operator applications solves take.

use super::*;

/// Operator applications to 1e-6, with the one that the problem itself takes.
fn applications(problem: &mut Problem<f64>, control: Control) -> usize {
    let report = solve(problem, control, 1e-6).report;
    assert_eq!(report.status, Status::Converged);
    report.operator_applications + 1
}

/// The cases with counted applications, on `n`² nodes.
fn counts(n: usize) -> Vec<(&'static str, usize)> {
    // where a grid is too coarse for waves of 64 periods it just resolves 63
    let shortest = if n < 256 { 63 } else { 64 };
    let hertz = applications(&mut sphere(n, NoAdhesion), Control::MeanGap(0.0398));
    let mut counts = vec![("Hertz", hertz)];
    // mean pressures that give about 3 and 40 % contact
    for (names, pressure, share) in
        [(["3 %, pressure", "3 %, gap"], 0.0125, 0.03), (["40 %, pressure", "40 %, gap"], 0.205, 0.4)]
    {
        let mut problem = rough::<f64>(n, shortest, NoAdhesion);
        let report = solve(&mut problem, Control::MeanPressure(pressure), 1e-6).report;
        assert!(n < 512 || (report.contact_fraction / share - 1.0).abs() < 0.1);
        counts.push((names[0], report.operator_applications + 1));
        counts.push((names[1], applications(&mut problem, Control::MeanGap(report.mean_gap))));
    }
    let mut problem = rough::<f64>(n, shortest, Exponential::new(1.42e-4, 2.9e-3).unwrap());
    counts.push(("exponential, gap", applications(&mut problem, Control::MeanGap(0.022))));
    counts.push(("exponential, loading", applications(&mut problem, Control::MeanPressure(0.0125))));
    counts
}

/// No case takes more than what was counted, and than `growth` times as many as on the coarser grid, the way down from
/// the wall alone to adhesion 1.2 times that. The test prints the counts, with `-- --nocapture`.
#[track_caller]
fn grows_little((coarse, fine): (usize, usize), counted: [usize; 7], growth: f64) {
    for ((coarse, (name, fine)), most) in counts(coarse).into_iter().zip(counts(fine)).zip(counted) {
        let grown = fine as f64 / coarse.1 as f64;
        let growth = if name.ends_with("loading") { 1.2 * growth } else { growth };
        println!("{name}: {} and {fine}", coarse.1);
        assert!(fine <= most + SLACK && grown <= growth, "{name}: {} and {fine}, {grown:.2} times", coarse.1);
    }
}

#[test]
fn contacts_take_few_applications() {
    grows_little((128, 512), [29, 35, 31, 33, 35, 33, 59], 1.35);
}

#[test]
fn finer_grids_take_hardly_more_applications() {
    grows_little((256, 1024), [32, 35, 33, 33, 33, 37, 67], 1.25);
}

#[test]
#[ignore = "takes minutes, and 1.5 GB"]
fn sixteen_times_finer_grids_take_hardly_more_applications() {
    grows_little((256, 4096), [35, 41, 33, 37, 37, 39, 63], 1.45);
}

#[test]
fn springs_take_about_as_many_applications_as_a_wall() {
    let (mut wall, mut springs, mut rounds) = (0, 0, 0);
    for pressure in [2e-3, 1e-2, 3e-2] {
        let mut problem = rough::<f64>(256, 32, NoAdhesion);
        let control = Control::MeanPressure(pressure);
        wall += applications(&mut problem, control);
        // a tenth of the stiffness of the stiffest wave, and all of it
        for stiffness in [40.0, 400.0] {
            let mut solver = Solver { settings: Settings::default(), constraint: Penalty::new(stiffness).unwrap() };
            let report = solver.solve(&mut problem, control).unwrap().report;
            assert_eq!(report.status, Status::Converged);
            springs += report.operator_applications + 1;
            let mut solver = Solver { settings: Settings::default(), constraint: Uzawa::new(stiffness).unwrap() };
            let report = solver.solve(&mut problem, control).unwrap().report;
            assert_eq!(report.status, Status::Converged);
            rounds += report.operator_applications + 1;
        }
    }
    println!("{wall}, {springs} and {rounds}");
    assert!(rounds as f64 <= 2.0 * 3.0 * wall as f64, "{wall} and {rounds}");
    assert!(springs as f64 <= 2.0 * 1.2 * wall as f64, "{wall} and {springs}");
}

#[test]
fn maugis_dugdale_takes_few_applications_and_hardly_more_on_finer_grids() {
    let count = |n| applications(&mut sphere(n, MaugisDugdale::new(1e-4, 2e-3).unwrap()), Control::MeanGap(0.0429));
    let (coarse, fine) = (count(128), count(512));
    assert!(fine <= 56 + SLACK && fine as f64 <= 1.5 * coarse as f64, "{coarse} {fine}");
}

#[test]
fn pressure_control_needs_no_more_from_a_touch_to_full_contact() {
    let mut problem = rough::<f64>(128, 32, NoAdhesion);
    let mut last = 0.0;
    for pressure in [1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.6, 1.0, 4.0] {
        let report = solve(&mut problem, Control::MeanPressure(pressure), 1e-6).report;
        assert_eq!(report.status, Status::Converged);
        assert!(report.operator_applications <= 60, "{pressure}: {}", report.operator_applications);
        assert!(report.contact_fraction > last);
        last = report.contact_fraction;
    }
    assert_eq!(last, 1.0);
}
