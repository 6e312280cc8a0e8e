//! Sweeps: they find what single solves find, with less work, and can be continued.

use std::ops::ControlFlow;

use asperity::*;
use asperity_maps::surface_with_absent;
use ndarray::Array2;
use oracles::rough::rough as rough_surface;
use oracles::{Checkpoint, check, rough, sphere, swept};

fn gaps(values: &[f64]) -> Vec<Control> {
    values.iter().copied().map(Control::MeanGap).collect()
}

fn pressures(values: &[f64]) -> Vec<Control> {
    values.iter().copied().map(Control::MeanPressure).collect()
}

fn evenly(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| from + (to - from) * k as f64 / (count - 1) as f64).collect()
}

fn sweep<T: Real>(problem: &mut Problem<T>, loads: &[Control]) -> Vec<Solution<T>> {
    swept(&mut Sweep::default(), &mut Solver::default(), problem, loads)
}

fn applications<T: Real>(steps: &[Solution<T>]) -> usize {
    steps.iter().map(|solution| solution.report.operator_applications).sum()
}

/// Sweeps, compares with single solves, and returns the operator applications of both.
#[track_caller]
fn compare(problem: &mut Problem<f64>, loads: &[Control]) -> (usize, usize) {
    let steps = sweep(problem, loads);
    assert_eq!(steps.iter().map(|step| step.report.control).collect::<Vec<_>>(), loads);
    let mut cold = 0;
    for found in &steps {
        let control = found.report.control;
        check(found);
        assert_eq!(found.report.status, Status::Converged);
        let single = Solver::default().solve(problem, control).unwrap().report;
        cold += single.operator_applications;
        assert!((found.report.mean_gap - single.mean_gap).abs() <= 1e-5 * single.mean_gap);
        assert!(found.report.contact_nodes.abs_diff(single.contact_nodes) <= 3);
    }
    (applications(&steps), cold)
}

/// Takes no more applications, of the sweep and of single solves, than were counted, and what rounding, which differs
/// between processors, may add: an iteration for every other load.
#[track_caller]
fn takes(mut problem: Problem<f64>, loads: &[Control], (sweep, single): (usize, usize)) {
    let found = compare(&mut problem, loads);
    assert!(found.0 <= sweep + loads.len() && found.1 <= single + loads.len(), "{found:?} and not {sweep}, {single}");
}

#[test]
fn a_sweep_takes_fewer_applications_than_single_solves() {
    let bare = || rough::<f64>(128, 32, NoAdhesion);
    takes(bare(), &gaps(&evenly(0.02, 0.0125, 16)), (273, 412));
    takes(bare(), &pressures(&evenly(0.02, 0.095, 16)), (313, 532));
    let doubled: Vec<f64> = (0..7).map(|k| 0.005 * f64::from(1 << k)).collect();
    let halved: Vec<f64> = doubled.iter().rev().copied().collect();
    takes(bare(), &pressures(&doubled), (192, 218));
    takes(bare(), &pressures(&halved), (193, 225));
    // from loads that say little of the next ones
    takes(bare(), &pressures(&evenly(0.0, 0.05, 8)), (217, 274));
    takes(bare(), &pressures(&[1e-3, 1e-2, 1e-1]), (91, 91));
    takes(sphere(128, NoAdhesion), &gaps(&evenly(0.041, 0.039, 5)), (78, 123));
    let law = Exponential::new(2e-4, 2e-3).unwrap();
    takes(rough(128, 32, law), &pressures(&doubled), (229, 314));
    takes(rough(128, 32, law), &pressures(&halved), (228, 314));
    takes(rough(128, 32, law), &pressures(&evenly(0.0, 0.05, 8)), (239, 366));
    takes(rough(128, 32, law), &gaps(&[0.03, 0.02, 0.01, 0.005]), (111, 112));
}

#[test]
fn twenty_loads_take_two_thirds_of_the_applications_of_single_solves() {
    let law = Exponential::new(2e-5, 1e-3).unwrap();
    let evenly_in_logarithms: Vec<f64> = (0..20).map(|k| 1e-3 * 30f64.powf(f64::from(k) / 19.0)).collect();
    for (loads, bare, adhesive) in [
        (pressures(&evenly_in_logarithms), (402, 640), (433, 712)),
        (pressures(&evenly(1.5e-3, 0.03, 20)), (398, 658), (413, 722)),
        (gaps(&evenly(0.03, 0.01, 20)), (353, 520), (359, 538)),
    ] {
        takes(rough::<f64>(128, 16, NoAdhesion), &loads, bare);
        takes(rough(128, 16, law), &loads, adhesive);
    }
}

#[test]
fn a_sweep_that_is_kept_goes_on_bit_for_bit() {
    let loads = gaps(&evenly(0.03, 0.01, 6));
    let law = MaugisDugdale::new(1e-4, 4e-3).unwrap();
    goes_on(|| rough::<f64>(48, 12, NoAdhesion), &loads);
    goes_on(|| rough::<f32>(48, 12, NoAdhesion), &loads);
    goes_on(|| sphere::<f64>(48, law), &gaps(&evenly(0.045, 0.04, 6)));
}

/// From each load on, at a problem that is made anew.
fn goes_on<T: Real>(new: impl Fn() -> Problem<T>, loads: &[Control])
where
    Sweep<T>: Checkpoint,
{
    let all = sweep(&mut new(), loads);
    let (mut sweep, mut solver, mut problem) = (Sweep::default(), Solver::default(), new());
    for (k, &load) in loads.iter().enumerate() {
        let rest = swept(&mut sweep.read_again(), &mut Solver::default(), &mut new(), &loads[k..]);
        assert!(rest == all[k..], "{k}");
        assert_eq!(sweep.next(&mut solver, &mut problem, load).unwrap(), all[k]);
    }
}

/// A paraboloid with a little roughness.
fn tip(n: usize) -> Surface {
    let grid = Grid::square(n, 1.0).unwrap();
    let heights = Surface::paraboloid(grid, 2.0).unwrap().heights() + &(0.02 * rough_surface(grid, 12, 1).heights());
    Surface::new(grid, heights).unwrap()
}

#[test]
fn a_free_half_space_starts_as_it_is_beyond_its_window() {
    let surface = tip(64);
    let free = Boussinesq::<f64>::new(*surface.grid(), 1.0).unwrap();
    let mut problem = Problem::new(&surface, free, NoAdhesion).unwrap();
    let loads: Vec<_> = evenly(1e-3, 1.9e-3, 10).into_iter().map(Control::Force).collect();
    let steps = sweep(&mut problem, &loads);
    assert!(steps.iter().all(|solution| solution.report.status == Status::Converged));
    // each from the gap on the window alone, as long as it takes there
    let (mut solver, mut alone) = (Solver::default(), steps[0].report.operator_applications);
    for (k, &load) in loads.iter().enumerate().skip(1) {
        let start = Start::From(&steps[k - 1].gap);
        let found = solver.solve_with(&mut problem, load, start, |_| ControlFlow::Continue(())).unwrap();
        alone += found.report.operator_applications;
    }
    let taken = applications(&steps);
    // counted 197 and 273; rounding, which differs between processors, may add an iteration for every other load
    assert!(taken <= 197 + loads.len() && 10 * taken < 9 * alone, "{taken} and {alone}");
}

#[test]
fn a_sweep_goes_on_bit_for_bit_where_nodes_face_no_surface() {
    let surface = tip(32);
    let free = Boussinesq::<f64>::new(*surface.grid(), 1.0).unwrap();
    let hole = |(i, j)| (3..9).contains(&i) && (5..20).contains(&j);
    let absent = Array2::from_shape_fn((32, 32), |at| if hole(at) { f64::NAN } else { surface.heights()[at] });
    let absent = surface_with_absent(*surface.grid(), absent).unwrap();
    let periodic = Westergaard::<f64>::new(*surface.grid(), 1.0).unwrap();
    let law = Exponential::new(1e-4, 4e-3).unwrap();
    let loads: Vec<_> = evenly(1e-3, 4e-3, 5).into_iter().map(Control::Force).collect();
    goes_on(|| Problem::new(&surface, free.clone(), NoAdhesion).unwrap(), &loads);
    goes_on(|| Problem::new(&surface, free.clone(), law).unwrap(), &loads);
    goes_on(|| Problem::new(&absent, periodic.clone(), NoAdhesion).unwrap(), &loads);
}

#[test]
fn sweeps_go_through_full_contact_and_back() {
    let mut problem = rough::<f64>(32, 8, NoAdhesion);
    for loads in [
        gaps(&[0.01, 0.0, 0.0, 0.005, 0.02, 0.0, 0.01]),
        pressures(&[0.1, 100.0, 100.0, 200.0, 0.1, 0.01, 50.0]),
        [gaps(&[0.01, 0.0]), pressures(&[0.1]), gaps(&[0.0, 0.01, 0.02]), pressures(&[100.0, 0.1])].concat(),
    ] {
        for solution in sweep(&mut problem, &loads) {
            let control = solution.report.control;
            assert_eq!(solution.report.status, Status::Converged, "{control:?}");
            let single = Solver::default().solve(&mut problem, control).unwrap().report;
            assert!((solution.report.mean_gap - single.mean_gap).abs() <= 1e-5 * single.mean_gap, "{control:?}");
            assert_eq!(solution.report.contact_fraction == 1.0, single.contact_fraction == 1.0, "{control:?}");
        }
    }
}

#[test]
fn a_sweep_with_adhesion_follows_its_branch() {
    let law = MaugisDugdale::new(1e-3, 1e-2).unwrap();
    let mut problem = sphere::<f64>(32, law);
    let pressed = pressures(&[1e-3, 0.0, -1e-3, -2e-2, -1e-3, 1e-3]);
    let steps = sweep(&mut problem, &pressed);
    let status: Vec<_> = steps.iter().map(|solution| solution.report.status).collect();
    let contact: Vec<_> = steps.iter().map(|solution| solution.report.contact_nodes).collect();
    // pulled apart by the fourth load, the surfaces do not come together again under the fifth
    assert_eq!(status[..3], [Status::Converged; 3]);
    assert_eq!(status[3..5], [Status::Detached; 2]);
    assert_eq!(status[5], Status::Converged);
    assert!(contact[2] > 0 && contact[4] == 0 && contact[5] > 0, "{contact:?}");
}

#[test]
fn every_constraint_can_be_swept() {
    let loads = pressures(&[0.02, 0.03, 0.045, 0.03]);
    let mut problem = rough::<f64>(48, 12, NoAdhesion);
    let exact = sweep(&mut problem, &loads);
    let settings = Settings::default();
    let mut penalty = Solver { settings, constraint: Penalty::new(5000.0).unwrap() };
    let mut uzawa = Solver { settings, constraint: Uzawa::new(500.0).unwrap() };
    let soft = swept(&mut Sweep::default(), &mut penalty, &mut problem, &loads);
    let hard = swept(&mut Sweep::default(), &mut uzawa, &mut problem, &loads);
    for (steps, allowed) in [(soft, 1e-2), (hard, 1e-4)] {
        for (found, exact) in steps.iter().zip(&exact) {
            assert_eq!(found.report.status, Status::Converged);
            assert!((found.report.mean_gap / exact.report.mean_gap - 1.0).abs() < allowed);
        }
    }
}

#[test]
fn bad_loads_and_problems_on_another_grid_are_refused() {
    let (mut solver, mut problem) = (Solver::default(), sphere::<f64>(16, NoAdhesion));
    let (mut sweep, load) = (Sweep::default(), Control::MeanGap(0.04));
    let first = sweep.next(&mut solver, &mut problem, load).unwrap();
    let kept = sweep.clone();
    let refused = sweep.next(&mut solver, &mut problem, Control::MeanGap(f64::NAN));
    assert!(matches!(refused, Err(Error::Value { name: "mean gap", .. })), "{refused:?}");
    let refused = sweep.next(&mut solver, &mut sphere(8, NoAdhesion), load);
    assert!(matches!(refused, Err(Error::Shape { name: "field of the sweep", .. })), "{refused:?}");
    // what is refused leaves a sweep where it is
    let next = |mut sweep: Sweep<f64>| sweep.next(&mut Solver::default(), &mut sphere(16, NoAdhesion), load).unwrap();
    assert_eq!(next(sweep), next(kept));
    let begun = Sweep::starting_from(first.gap);
    let mut sweep = begun.clone();
    let refused = sweep.next(&mut solver, &mut sphere(8, NoAdhesion), load);
    assert!(matches!(refused, Err(Error::Shape { name: "starting gap", .. })), "{refused:?}");
    assert_eq!(next(sweep), next(begun));
}
